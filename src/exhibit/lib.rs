//! An exhibit: glTF model plus constraint sidecar, loaded, checked and resolved into one immutable value.
//!
//! Invariant: a value of type [`Exhibit`] is valid. Every index in it is in range, every mass is positive, every
//! joint connects what it names; the simulation checks nothing again.
//!
//! It reads files (an exhibit folder is all it reads), and reports everything that is wrong with them at once, each with file,
//! line and remedy. It never moves, draws or plays anything, and what it has built never changes: a changed folder becomes a
//! new [`Exhibit`].
//!
//! | module or type | holds |
//! |---|---|
//! | [`Exhibit`] | bodies, constraints, colliders, wind surfaces, instruments, labels, camera |
//! | [`load`], [`ids`], [`resolve()`] | reads a folder; lists the exhibits that can be found; finds one |
//! | [`Report`], [`Diagnostic`], [`codes`] | what is wrong, where, and what to do |
//! | [`sidecar`] | the tables of `exhibit.toml`, from which the JSON Schema is made |
//! | [`model`] | the glTF model: meshes, materials, nodes, animations, cameras |
//! | [`labels`] | label texts by language, and as a table for translators |
//!
//! ```
//! use std::path::Path;
//!
//! let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../exhibits/pendulum");
//! let pendulum = soffio_exhibit::load(&folder).expect("a shipped exhibit");
//! assert!(pendulum.bodies.iter().any(|body| body.name == "Pendulum"));
//! assert!(pendulum.warnings.is_empty());
//!
//! let report = soffio_exhibit::load(Path::new("no/such/folder")).expect_err("there is nothing");
//! assert!(!report.to_string().is_empty(), "it says what was looked for");
//! ```

use std::path::PathBuf;

use soffio_geometry::bodies::MassProperties;
use soffio_math::{DVec3, Pose};
use soffio_multibody::articulation::{Constraint, Limit, Spring};
use soffio_multibody::collision::{Collider, Exclusion, Pair};
use soffio_multibody::dynamics::{Drive, Integrator, Resistance, Solver, SurfacePair};
use soffio_multibody::procedural::Method;
use soffio_sound::InstrumentSpec;
use soffio_wind::breath::Law;
use soffio_wind::weather::Wind;
use soffio_wind::{Shelter, Surface};

pub mod clock;
pub mod codes;
pub mod diagnostic;
pub mod fit;
pub mod labels;
pub mod materials;
pub mod model;
mod pairs;
pub mod paths;
pub mod quantity;
mod resolve;
pub mod shape;
pub mod shapes;
pub mod sidecar;
mod source;
pub mod view;

pub use diagnostic::{Diagnostic, Location, Report, Severity};
pub use model::Model;
pub use paths::{ids, resolve, shelf};
pub use resolve::{load, plain};
pub use view::{Leeway, View};

/// File name of the sidecar in an exhibit folder.
pub const SIDECAR: &str = "exhibit.toml";

/// A validated exhibit. Immutable: hot reload builds a new one.
#[derive(Clone, Debug)]
pub struct Exhibit {
    /// Folder name and id.
    pub id: String,
    /// Where it was loaded from.
    pub folder: PathBuf,
    /// The glTF model.
    pub model: Model,
    /// World acceleration, m/s².
    pub gravity: DVec3,
    /// glTF camera node that the visitor looks through; `None` frames the bounds.
    pub camera_node: Option<usize>,
    /// Materials by name, as the sidecar has them.
    pub materials: Vec<Material>,
    /// What a pair of materials does that the combine rule (geometric mean) does not say.
    pub material_pairs: Vec<MaterialPair>,
    /// Moving bodies. Static nodes are not bodies.
    pub bodies: Vec<Body>,
    /// Joints.
    pub constraints: Vec<Constraint>,
    /// What stays within bounds: tilts, stops, slack cords, ratchets.
    pub limits: Vec<Limit>,
    /// Springs and dampers.
    pub springs: Vec<Spring>,
    /// Bodies that follow key frames or a path.
    pub drives: Vec<Drive>,
    /// Key frames of shapes, which the picture alone shows.
    pub shapes: Vec<shapes::ShapeTrack>,
    /// Length of one run, s; may be infinite.
    pub duration: f64,
    /// Does it gather itself from scattered parts when it comes on?
    pub gathers: bool,
    /// What moves it.
    pub motion: Motion,
    /// What hands may do to it.
    pub touch: Touch,
    /// Its hands, where it tells the time.
    pub clock: Option<clock::Clock>,
    /// How time is advanced.
    pub integrator: Integrator,
    /// Which linear solver finds the multipliers.
    pub solver: Solver,
    /// 1/ω₀ of the joints' stabiliser, s.
    pub stabilization_time: f64,
    /// Wires and cords: drawn as capsules, feel the wind, have mass.
    pub wires: Vec<Wire>,
    /// Collision shapes.
    pub colliders: Vec<Collider>,
    /// Pairs of bodies that never collide, sorted.
    pub excluded_pairs: Vec<Exclusion>,
    /// What feels the wind.
    pub wind_surfaces: Vec<Surface>,
    /// What stands in the wind's way.
    pub shelters: Vec<Shelter>,
    /// Winds that blow by themselves.
    pub winds: Vec<Wind>,
    /// What a breath is to this exhibit.
    pub breath: BreathTuning,
    /// How it comes to rest when nobody blows; `None`: by itself.
    pub calm: Option<Calm>,
    /// Level of all sounds, dB; their own gains hold it already.
    pub level_db: f64,
    /// Sounding bodies.
    pub instruments: Vec<InstrumentSpec>,
    /// Which motion plays which instrument.
    pub sounds: Vec<SoundBinding>,
    /// Attract mode.
    pub attract: Attract,
    /// Words by language.
    pub labels: Labels,
    /// Who made it, and whose rights it carries.
    pub credit: Credit,
    /// What is probably not meant so.
    pub warnings: Vec<Diagnostic>,
    /// Where the values come from, in the order of the file.
    pub origins: Vec<Origin>,
}

impl Exhibit {
    /// The warnings as a report with the sidecar's text, to be shown.
    pub fn warning_report(&self) -> Report {
        let file = self.folder.join(SIDECAR);
        let text = std::fs::read_to_string(&file).unwrap_or_default();
        Report::in_file(&file.display().to_string(), text.into(), self.warnings.clone())
    }
}

/// A resolved value and where it comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    /// What it belongs to: `body Boom`, `constraint boom-cup`.
    pub of: String,
    /// Name of the value.
    pub key: String,
    /// The value with its unit.
    pub value: String,
    /// `glTF`, `exhibit.toml:12`, or how it was derived.
    pub source: String,
}

impl Exhibit {
    /// What the surfaces of two colliders do to each other. Restitution and sliding friction are those of the pair of
    /// materials, or the geometric mean of both; resistances are those of the pair, or the sum of both, as each surface
    /// loses its own.
    pub fn surface_pair(&self, pair: Pair) -> SurfacePair {
        let [a, b] = [pair.a, pair.b].map(|collider| self.colliders[collider].material);
        let (x, y) = (&self.materials[a], &self.materials[b]);
        let own = self.material_pairs.iter().find(|p| p.pair == (a, b) || p.pair == (b, a));
        let restitution = own.and_then(|p| p.restitution).unwrap_or((x.restitution * y.restitution).sqrt());
        let friction = own.and_then(|p| p.dynamic_friction).unwrap_or((x.dynamic_friction * y.dynamic_friction).sqrt());
        let (r, s) = (&x.resistance, &y.resistance);
        let resistance = Resistance {
            rolling: own.and_then(|p| p.rolling_resistance).unwrap_or(r.rolling + s.rolling),
            spinning: own.and_then(|p| p.spin_resistance).unwrap_or(r.spinning + s.spinning),
        };
        SurfacePair { pair, restitution, friction, resistance }
    }
}

/// Physical material of a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Name in the sidecar.
    pub name: String,
    /// kg/m³.
    pub density: f64,
    /// Coulomb coefficient while sticking.
    pub static_friction: f64,
    /// Coulomb coefficient while sliding.
    pub dynamic_friction: f64,
    /// Coefficient of restitution.
    pub restitution: f64,
    /// Young's modulus, Pa.
    pub youngs_modulus: f64,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Installed loss factor η.
    pub loss_factor: f64,
    /// Its part in what resists rolling and spinning on it.
    pub resistance: Resistance,
}

/// Override of the combine rule for one pair of materials.
#[derive(Clone, Debug, PartialEq)]
pub struct MaterialPair {
    /// Indices of the two materials.
    pub pair: (usize, usize),
    /// Coefficient of restitution.
    pub restitution: Option<f64>,
    /// Coulomb coefficient while sliding.
    pub dynamic_friction: Option<f64>,
    /// Coulomb coefficient while sticking.
    pub static_friction: Option<f64>,
    /// Couple against rolling over the normal force, m.
    pub rolling_resistance: Option<f64>,
    /// Couple against spin about the normal over the normal force, m.
    pub spin_resistance: Option<f64>,
}

/// A moving rigid body.
#[derive(Clone, Debug)]
pub struct Body {
    /// Name of its glTF node.
    pub name: String,
    /// Index of its glTF node; descendants that are not bodies move with it.
    pub node: usize,
    /// Mass, centre, inertia in the node frame.
    pub properties: MassProperties,
    /// World pose of the node at reset.
    pub pose: Pose,
    /// Initial velocity of the centre of mass, m/s.
    pub velocity: DVec3,
    /// Initial angular velocity, world axes, rad/s.
    pub angular_velocity: DVec3,
    /// Linear damping rate, 1/s (air other than the wind surfaces' own).
    pub linear_damping: f64,
    /// Angular damping rate, 1/s.
    pub angular_damping: f64,
    /// Index of its material.
    pub material: usize,
}

/// A wire or cord that belongs to a body (or stands still).
#[derive(Clone, Debug)]
pub struct Wire {
    /// Unique in the exhibit.
    pub name: String,
    /// Index of the body that carries it; `None` stands still.
    pub body: Option<usize>,
    /// Polyline in the node frame of the body (world frame for `None`), m.
    pub points: Vec<DVec3>,
    /// m.
    pub radius: f64,
    /// Index of the physical material.
    pub material: usize,
    /// Linear RGB base colour.
    pub color: [f32; 3],
    /// 0 dielectric … 1 metal.
    pub metallic: f32,
    /// Perceptual roughness 0…1.
    pub roughness: f32,
}

/// What moves an exhibit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// The laws, and places where a step would take longer than this, s.
    Auto {
        /// s of processor time.
        budget: f64,
    },
    /// The laws always.
    Laws,
    /// Places always.
    Places(Method),
}

/// What hands may do to an exhibit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Touch {
    /// May visitors take it by the hand?
    pub permitted: bool,
    /// How strong a hand is, N.
    pub force: f64,
}

/// What a breath is to an exhibit, besides what the site's configuration says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BreathTuning {
    /// How it spreads.
    pub law: Law,
    /// Multiplies its force on top of the site's and the profile's gain.
    pub gain: f64,
    /// Diameter of the lips, m, where it is not the site's.
    pub lip_diameter: Option<f64>,
}

impl Default for BreathTuning {
    fn default() -> Self {
        Self { law: Law::default(), gain: 1.0, lip_diameter: None }
    }
}

/// How the gallery calms an exhibit that nobody blows at.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Calm {
    /// So long after the last breath or hand it begins, s.
    pub after: f64,
    /// Time constant with which free motion fades at first, s; a swing takes twice as long, and the calm grows firmer.
    pub time: f64,
}

/// Which motion of which body plays which instrument.
#[derive(Clone, Debug)]
pub struct SoundBinding {
    /// Unique in the exhibit.
    pub name: String,
    /// Index of the body.
    pub body: usize,
    /// What sets it off.
    pub on: SoundTrigger,
    /// Index into [`Exhibit::instruments`].
    pub instrument: usize,
    /// Node-frame axes of the two largest half extents and the centre, to place a hit on the body.
    pub frame: (DVec3, DVec3, DVec3),
    /// Index of the wire that the wind plays, where it is one: it hears only what blows across it.
    pub wire: Option<usize>,
    /// Key of the caption in the labels.
    pub caption: Option<String>,
}

/// What sets a sound off.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SoundTrigger {
    /// A hit on the body.
    Impact,
    /// What slides or rolls over the body.
    Slide,
    /// The wind at the body.
    Wind,
}

/// What the exhibit does when nobody is there.
#[derive(Clone, Debug, Default)]
pub struct Attract {
    /// Steps in time order; the script repeats after the last.
    pub steps: Vec<AttractStep>,
    /// Length of one round, s.
    pub duration: f64,
}

/// One step of the attract script.
#[derive(Clone, Debug)]
pub struct AttractStep {
    /// Seconds since the script began.
    pub at: f64,
    /// What happens.
    pub action: AttractAction,
}

/// What an attract step does.
#[derive(Clone, Debug)]
pub enum AttractAction {
    /// Shows a text of the labels by its key.
    Show(String),
    /// Plays a recorded breath: mono samples and their rate.
    Blow {
        /// Mono samples, full scale ±1.
        samples: std::sync::Arc<[f32]>,
        /// Hz.
        sample_rate: u32,
        /// Pointer in picture coordinates; `None` is the centre.
        aim: Option<[f64; 2]>,
    },
    /// Leads the camera round the work, to the right and up from where it stands, rad.
    Look([f64; 2]),
    /// Puts everything back to where it started.
    Reset,
}

/// Words by language.
#[derive(Clone, Debug, Default)]
pub struct Labels {
    /// Language code shown first.
    pub default_language: String,
    /// In the order of the file.
    pub languages: Vec<(String, Label)>,
}

impl Labels {
    /// The label in `language`, or in the default one.
    pub fn get(&self, language: &str) -> Option<&Label> {
        let find = |code: &str| self.languages.iter().find(|(c, _)| c == code).map(|(_, label)| label);
        find(language).or_else(|| find(&self.default_language)).or_else(|| self.languages.first().map(|(_, l)| l))
    }
}

/// Words of one language.
#[derive(Clone, Debug, Default)]
pub struct Label {
    /// Title of the work.
    pub title: String,
    /// Maker.
    pub maker: String,
    /// Wall text.
    pub body: String,
    /// What is to be seen, for those who cannot.
    pub alt: String,
    /// Texts by key (`invite`, …).
    pub text: Vec<(String, String)>,
    /// Captions of sounds by key.
    pub caption: Vec<(String, String)>,
}

/// Who made it, and whose rights it carries.
#[derive(Clone, Debug, Default)]
pub struct Credit {
    /// SPDX id of the model's licence.
    pub model_license: String,
    /// Who made the model.
    pub model_author: String,
    /// Rights notice shown with the label.
    pub notice: String,
    /// Sources of facts on the label.
    pub sources: Vec<String>,
}

//! The exhibit itself: all that its model and its sidecar say, resolved.

use std::path::PathBuf;

use super::behavior::{BreathTuning, Calm, Motion, SoundBinding, Touch};
use super::bodies::{Body, Material, MaterialPair, Wire};
use super::clock;
use super::diagnostic::{Diagnostic, Report};
use super::model::Model;
use super::paths::SIDECAR;
use super::presentation::{Attract, Credit, Labels};
use super::shapes;
use soffio_math::DVec3;
use soffio_multibody::articulation::{Constraint, Limit, Spring};
use soffio_multibody::collision::{Collider, Exclusion, Pair};
use soffio_multibody::dynamics::{Integrator, KinematicBody, RollingResistance, Solver, SurfacePair};
use soffio_sound::InstrumentSpec;
use soffio_wind::ambient::Wind;
use soffio_wind::{Shelter, Surface};

/// A validated exhibit. Immutable: hot reload builds a new one.
///
/// It has 37 fields, because it is the sidecar with every name resolved: about one field for each table of `exhibit.toml` and
/// key of its `[scene]`. It has no state; whoever simulates, draws or shows an exhibit reads the few fields it needs.
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
    pub drives: Vec<KinematicBody>,
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
        let resistance = RollingResistance {
            rolling: own.and_then(|p| p.rolling_resistance).unwrap_or(r.rolling + s.rolling),
            spinning: own.and_then(|p| p.spin_resistance).unwrap_or(r.spinning + s.spinning),
        };
        SurfacePair { pair, restitution, friction, resistance }
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

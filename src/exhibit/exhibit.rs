//! The resolved exhibit: model and sidecar with every name turned into an index.

use std::path::PathBuf;
use std::sync::Arc;

use super::behavior::{BreathTuning, IdleDampingSpec, Motion, SoundBinding, TouchPermission};
use super::bodies::{Body, Cord, Material, MaterialPair, Wire};
use super::chart::Chart;
use super::clock;
use super::diagnostic::{Diagnostic, Report};
use super::files;
use super::light::LightRig;
use super::model::Model;
use super::paths::SIDECAR;
use super::presentation::{Attract, Credit, Labels, TAKE};
use super::shape_tracks;
use super::signal::Signal;
use soffio_math::DVec3;
use soffio_multibody::articulation::{Constraint, Limit, Spring};
use soffio_multibody::collision::{Collider, ColliderPair, Exclusion};
use soffio_multibody::dynamics::{Integrator, KinematicBody, RollingResistance, Solver, SurfacePair};
use soffio_sound::{InstrumentSpec, Preset};
use soffio_wind::ambient::Wind;
use soffio_wind::{Shelter, Surface};

/// A validated exhibit. Immutable: hot reload builds a new one.
///
/// It has 42 fields: about one for each table of `exhibit.toml` and each key of its `[scene]`, with names resolved. It
/// has no state.
#[derive(Clone, Debug)]
pub struct Exhibit {
    /// Id: the folder's name unless the sidecar sets one.
    pub id: String,
    /// Folder that it was loaded from.
    pub folder: PathBuf,
    /// The glTF model.
    pub model: Model,
    /// The gallery's light on it.
    pub light: LightRig,
    /// Acceleration of gravity, world, m/s².
    pub gravity: DVec3,
    /// glTF node of the camera; `None` frames the bounds of the exhibit.
    pub camera_node: Option<usize>,
    /// Materials, in the order of the sidecar.
    pub materials: Vec<Material>,
    /// Material pairs that depart from the combine rule (geometric mean).
    pub material_pairs: Vec<MaterialPair>,
    /// Moving bodies. Static nodes are not bodies.
    pub bodies: Vec<Body>,
    /// Joints.
    pub constraints: Vec<Constraint>,
    /// Limits: tilts, stops, slack cords, ratchets.
    pub limits: Vec<Limit>,
    /// Springs and dampers.
    pub springs: Vec<Spring>,
    /// Kinematic bodies: their key frames or paths.
    pub drives: Vec<KinematicBody>,
    /// Animated scales and morph weights, which affect the picture alone.
    pub shapes: Vec<shape_tracks::ShapeTrack>,
    /// Duration of a run before the exhibit starts again, s; may be infinite.
    pub duration: f64,
    /// Does it play its assembly when it is shown?
    pub assembles: bool,
    /// How its motion is computed.
    pub motion: Motion,
    /// What visitors may do to it by touch.
    pub touch: TouchPermission,
    /// The hands, if it is a clock.
    pub clock: Option<clock::Clock>,
    /// Time integrator.
    pub integrator: Integrator,
    /// Linear solver of the constraint forces.
    pub solver: Solver,
    /// Time constant 1/ω₀ of the constraint stabilisation, s.
    pub stabilization_time: f64,
    /// Wires and cords: drawn as capsules, feel the wind, have mass.
    pub wires: Vec<Wire>,
    /// Cords that are drawn from body to body.
    pub cords: Vec<Cord>,
    /// Collision shapes.
    pub colliders: Vec<Collider>,
    /// Pairs of bodies that never collide, sorted.
    pub excluded_pairs: Vec<Exclusion>,
    /// Surfaces on which wind acts.
    pub wind_surfaces: Vec<Surface>,
    /// Bodies and meshes that block the wind.
    pub shelters: Vec<Shelter>,
    /// Winds other than the breath.
    pub winds: Vec<Wind>,
    /// How a breath acts on it.
    pub breath: BreathTuning,
    /// Idle damping; `None` leaves it to come to rest by itself.
    pub idle_damping: Option<IdleDampingSpec>,
    /// Level of all sounds, dB; already contained in the gains of the instruments.
    pub level_db: f64,
    /// Sounding bodies.
    pub instruments: Vec<InstrumentSpec>,
    /// Timbres of the exhibit's own folder, in the order of their names.
    pub own_timbres: Vec<Arc<Preset>>,
    /// Triggers of the sounds.
    pub sounds: Vec<SoundBinding>,
    /// Charts of what is measured.
    pub charts: Vec<Chart>,
    /// Signals, in the order of the file.
    pub signals: Vec<Signal>,
    /// Attract script.
    pub attract: Attract,
    /// Label texts by language.
    pub labels: Labels,
    /// Author, licence and rights notice.
    pub credit: Credit,
    /// Probable mistakes.
    pub warnings: Vec<Diagnostic>,
    /// Source of each value, in the order of the file.
    pub origins: Vec<Origin>,
}

impl Exhibit {
    /// Why it moves by dynamics alone; `None` where it moves by positions too.
    pub fn refusal(&self) -> Option<&'static str> {
        Motion::refusal(&self.constraints, &self.springs, &self.materials)
    }

    /// The warnings as a report with the sidecar's text, for display.
    pub fn warning_report(&self) -> Report {
        let file = self.folder.join(SIDECAR);
        let bytes = files::read_sidecar(&self.folder).unwrap_or_default();
        let text = String::from_utf8(bytes).unwrap_or_default();
        Report::in_file(&file.display().to_string(), text.into(), self.warnings.clone())
    }

    /// The invitation to the hand in a language, such as "Take its hand": the label's `take`, where touch is permitted.
    pub fn hand_invitation(&self, language: &str) -> Option<&str> {
        self.labels.get(language).filter(|_| self.touch.permitted)?.text(TAKE)
    }

    /// Contact properties of two colliders. Restitution and sliding friction are those of the material pair, or the
    /// geometric mean of both materials. Resistances are those of the pair, or the sum of both. The
    /// slip of a tyre is the greater one: of a tyre and a floor, the tyre's.
    pub fn surface_pair(&self, pair: ColliderPair) -> SurfacePair {
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
        SurfacePair { pair, restitution, friction, full_slip: x.full_slip.max(y.full_slip), resistance }
    }
}

/// A resolved value and its source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Origin {
    /// Owner of the value: `body Boom`, `constraint boom-cup`.
    pub of: String,
    /// Name of the value.
    pub key: String,
    /// The value with its unit.
    pub value: String,
    /// Source: `glTF`, `exhibit.toml:12`, or how the value was derived.
    pub source: String,
}

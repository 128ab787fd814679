//! The format "exhibit/1" as Rust types: what a curator can write in `exhibit.toml`. The JSON Schema is made from
//! these types (`soffio schema exhibit`), so the doc comments here are the help that an editor shows.
//!
//! Points are a child node's name or `[x, y, z]` in node space; glTF axes: metres, right-handed, +Y up. All objects
//! are closed; keys that begin with `x_` are ignored.

mod bodies;
mod combinations;
mod forces;
mod function;
mod joints;
mod surfaces;
mod timing;
mod wind;
mod words;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

use super::quantity::*;

pub use bodies::*;
pub use combinations::*;
pub use forces::*;
pub use function::*;
pub use joints::*;
pub use surfaces::*;
pub use timing::*;
pub use wind::*;
pub use words::*;

/// A name: lower-case letters, digits and hyphens.
type Name = String;

/// An exhibit: what a glTF model is made of, how it hangs together, sounds, and what is said about it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Sidecar {
    /// Format version: "exhibit/1".
    pub schema: String,
    /// The glTF or GLB file, a path inside the exhibit folder.
    pub model: String,
    /// Id of the exhibit; by default the folder's name.
    pub id: Option<Name>,
    /// The world around the sculpture.
    #[serde(default)]
    pub scene: Scene,
    /// How motion is computed.
    #[serde(default)]
    pub solver: Solver,
    /// What hands may do to it.
    #[serde(default)]
    pub touch: Touch,
    /// Its hands, where it tells the time.
    pub clock: Option<Clock>,
    /// Physical materials by name. A built-in name (steel, aluminium, lead, brass, copper, glass, beech, cherry, oak …)
    /// changes only the keys that stand here.
    #[serde(default)]
    pub material: BTreeMap<String, Material>,
    /// What a pair of materials does that the combine rule does not say.
    #[serde(default)]
    pub material_pair: Vec<MaterialPair>,
    /// Nodes that move as one, with what hangs below them.
    #[serde(default)]
    pub body: Vec<Body>,
    /// Wires and cords.
    #[serde(default)]
    pub wire: Vec<Wire>,
    /// Joints, one array per kind.
    #[serde(default)]
    pub constraint: Constraints,
    /// Collision shapes.
    #[serde(default)]
    pub collider: Vec<Collider>,
    /// What collides with what.
    #[serde(default)]
    pub collision: Collision,
    /// What feels the wind.
    #[serde(default)]
    pub wind_surface: Vec<WindSurface>,
    /// What a breath is to the exhibit, and what blows by itself.
    #[serde(default)]
    pub wind: Winds,
    /// Which motion of which body plays which sound.
    #[serde(default)]
    pub sound: Vec<Sound>,
    /// What happens when nobody is there.
    #[serde(default)]
    pub attract: Attract,
    /// Words by language.
    #[serde(default)]
    pub label: Label,
    /// Who made it, and whose rights it carries.
    #[serde(default)]
    pub credit: Credit,
}

/// The world around the sculpture.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Acceleration of gravity; by default [0, -9.81, 0] m/s².
    pub gravity: Option<[Acceleration; 3]>,
    /// A glTF camera node; without it the bounds are framed.
    pub camera: Option<String>,
    /// Level of all its sounds; `soffio loudness` finds the one that makes exhibits alike.
    #[serde(default)]
    pub level: Decibel,
    /// Length of one run: the exhibit then starts again; by default "inf".
    pub duration: Option<Until>,
    /// Does it gather itself from scattered parts when it comes on? By default true.
    pub gathers: Option<bool>,
}

/// How motion is computed.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Solver {
    /// What moves the figure.
    pub motion: MovedBy,
    /// With motion = "auto": longest step by the laws, processor time; by default 2.8 ms.
    pub budget: Option<Time>,
    /// How time is advanced.
    pub integrator: Integrator,
    /// Which linear solver finds the constraint forces.
    pub method: Method,
    /// How constraints that are open draw themselves together.
    pub stabilize: Stabilize,
    /// Lets constraints be open at the start: the figure assembles itself.
    pub assemble: bool,
}

/// What moves the figure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MovedBy {
    /// The laws, and places where the machine is too slow for them.
    #[default]
    Auto,
    /// The laws always.
    Dynamics,
    /// Places first, joint by joint: the classical procedural motion.
    Procedural,
    /// Places first, all joints at once.
    PositionBased,
}

/// What hands may do to the sculpture.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Touch {
    /// May visitors take it by the hand?
    pub permitted: bool,
    /// How strong a hand is; by default twice the weight of all that moves.
    pub force: Option<Force>,
}

/// The hands of a clock: the kiosk sets them to the local time, by hand and through the clock's own works.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Clock {
    /// Body of the minute hand; a clutch holds it on its arbor.
    pub hand: String,
    /// Axis about which it turns with the sun, in its node space.
    pub axis: [f64; 3],
    /// What the hands of the model show, as "10:50".
    pub shows: String,
    /// What stands otherwise at another hour: so much an hour.
    #[serde(default)]
    pub by_hour: Vec<Turning>,
    /// What stands otherwise when hours have been struck: so much a blow.
    #[serde(default)]
    pub by_blow: Vec<Turning>,
    /// Body that runs while it strikes; whoever sets the hands waits for it.
    pub strikes: Option<String>,
}

/// A body that is turned about an axis through its origin.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Turning {
    /// Which body.
    pub body: String,
    /// Axis, in its node space.
    pub axis: [f64; 3],
    /// By how much.
    pub turn: Angle,
}

impl Default for Touch {
    fn default() -> Self {
        Self { permitted: true, force: None }
    }
}

/// How time is advanced.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Integrator {
    /// Precise where that costs next to nothing, else Runge–Kutta.
    #[default]
    Auto,
    /// First order, one solve a step.
    Fast,
    /// Classical, fourth order.
    RungeKutta,
    /// Gauss–Legendre, sixth order: for clocks.
    Precise,
}

/// Which linear solver finds the constraint forces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// Linear in the number of bodies.
    #[default]
    Sparse,
    /// One dense matrix: the reference.
    Dense,
}

/// How constraints that are open draw themselves together: always critically damped.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Stabilize {
    /// Time constant; by default 40 ms.
    pub time_constant: Option<Time>,
}

/// A time that may never come.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Until {
    /// Seconds, or a text with a unit.
    Time(Time),
    /// "inf".
    Never(Never),
}

/// No end.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Never {
    /// Never.
    Inf,
}

impl Until {
    /// s; may be infinite.
    pub fn seconds(self) -> f64 {
        match self {
            Self::Time(time) => time.0,
            Self::Never(Never::Inf) => f64::INFINITY,
        }
    }
}

/// A physical material.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Material {
    /// Mass per volume.
    pub density: Option<Density>,
    /// Coulomb coefficient while sticking.
    #[schemars(range(min = 0.0))]
    pub static_friction: Option<f64>,
    /// Coulomb coefficient while sliding.
    #[schemars(range(min = 0.0))]
    pub dynamic_friction: Option<f64>,
    /// Coefficient of restitution, 0 … 1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub restitution: Option<f64>,
    /// Young's modulus.
    pub youngs_modulus: Option<Pressure>,
    /// Poisson's ratio, 0 … 0.5.
    #[schemars(range(min = 0.0, max = 0.5))]
    pub poisson: Option<f64>,
    /// Loss factor η of the hung part: T60 = 2.2/(η f).
    #[schemars(range(min = 0.0, max = 1.0))]
    pub loss_factor: Option<f64>,
    /// Rolling resistance: the couple against rolling over the normal force. Those of two surfaces add; without it nothing
    /// that rolls slows down.
    pub rolling_resistance: Option<Length>,
    /// Drilling friction: the couple against spin about the normal over the normal force. Those of two surfaces add.
    pub spin_resistance: Option<Length>,
}

/// Override of the combine rule (geometric mean; resistances add) for one pair of materials.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MaterialPair {
    /// The two materials.
    pub pair: [String; 2],
    /// Coefficient of restitution, 0 … 1.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub restitution: Option<f64>,
    /// Coulomb coefficient while sliding.
    #[schemars(range(min = 0.0))]
    pub dynamic_friction: Option<f64>,
    /// Coulomb coefficient while sticking.
    #[schemars(range(min = 0.0))]
    pub static_friction: Option<f64>,
    /// Rolling resistance of both together: the couple against rolling over the normal force.
    pub rolling_resistance: Option<Length>,
    /// Drilling friction of both together: the couple against spin about the normal over the normal force.
    pub spin_resistance: Option<Length>,
}

/// A point: the name of a node, or coordinates.
#[derive(Clone, Debug, PartialEq, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Point {
    /// A node's origin.
    Node(String),
    /// In node space.
    Position([Length; 3]),
}

/// A point of a node.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Attachment {
    /// glTF node; a node of no body stands still.
    pub node: String,
    /// A node below it, or [x, y, z] in node space; by default its origin.
    pub at: Option<Point>,
}

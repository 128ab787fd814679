//! The sidecar format "exhibit/1" as Rust types. The JSON Schema (`soffio schema exhibit`) is generated from these
//! types, so their doc comments are the help that an editor shows.
//!
//! Points are a child node's name or `[x, y, z]` in node space; glTF axes: metres, right-handed, +Y up. Unknown keys
//! are refused, except those that begin with `x_`, which are ignored, and old names ([`super::renamed`]), which cause a warning.

mod bodies;
mod chart;
mod combinations;
mod forces;
mod function;
mod joints;
mod sheet;
mod signal;
mod surfaces;
mod texts;
mod timing;
mod wind;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

use super::light::Side;
use super::quantity::*;

pub use bodies::*;
pub use chart::*;
pub use combinations::*;
pub use forces::*;
pub use function::*;
pub use joints::*;
pub use sheet::*;
pub use signal::*;
pub use surfaces::*;
pub use texts::*;
pub use timing::*;
pub use wind::*;

/// A name: lower-case letters, digits and hyphens.
type Name = String;

/// An exhibit: the materials, bodies, joints, sounds and texts of a glTF model.
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
    /// What visitors may do to it by touch.
    #[serde(default)]
    pub touch: Touch,
    /// Its hands, if it is a clock.
    pub clock: Option<Clock>,
    /// Physical materials by name. A built-in name (steel, aluminium, lead, brass, copper, glass, beech, cherry, oak …)
    /// needs only the keys that differ.
    #[serde(default)]
    pub material: BTreeMap<String, Material>,
    /// Pairs of materials that depart from the combine rule.
    #[serde(default)]
    pub material_pair: Vec<MaterialPair>,
    /// Moving bodies: nodes that move as one with the nodes below them.
    #[serde(default)]
    pub body: Vec<Body>,
    /// Wires and cords.
    #[serde(default)]
    pub wire: Vec<Wire>,
    /// Cords that are drawn from body to body.
    #[serde(default)]
    pub cord: Vec<Cord>,
    /// Thin sheets that bend: cloth.
    #[serde(default)]
    pub sheet: Vec<Sheet>,
    /// Joints, one array for each kind.
    #[serde(default)]
    pub constraint: Constraints,
    /// Collision shapes.
    #[serde(default)]
    pub collider: Vec<Collider>,
    /// Exceptions from collision.
    #[serde(default)]
    pub collision: Collision,
    /// Surfaces on which wind acts.
    #[serde(default)]
    pub wind_surface: Vec<WindSurface>,
    /// The gallery's light on the exhibit.
    #[serde(default)]
    pub light: Light,
    /// How a breath acts on the exhibit, and winds of its own.
    #[serde(default)]
    pub wind: Winds,
    /// Which motion of which body plays which sound.
    #[serde(default)]
    pub sound: Vec<Sound>,
    /// Numbers that it computes while it moves; springs follow them.
    #[serde(default)]
    pub signal: Vec<Signal>,
    /// Curves of what is measured, drawn on boards.
    #[serde(default)]
    pub chart: Vec<Chart>,
    /// What happens when nobody is there.
    #[serde(default)]
    pub attract: Attract,
    /// Label texts by language.
    #[serde(default)]
    pub label: Label,
    /// Author, licence and rights notice.
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
    /// Level of all its sounds; `soffio loudness` finds the one that makes exhibits equally loud.
    #[serde(default)]
    pub level: Decibel,
    /// Length of one run: the exhibit then starts again; by default "inf".
    pub duration: Option<Until>,
    /// Does it play an assembly animation when it is shown? By default true.
    pub assembly_animation: Option<bool>,
}

/// The gallery's light on the exhibit.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Light {
    /// Side of the key lamp as the visitor sees it; by default "left".
    pub side: Side,
    /// Brightness of the wall behind the exhibit, where white is 1: 0.1 to 0.8, by default 0.435.
    pub wall: Option<f64>,
    /// How many times as strong as the fill lamp the key lamp is: 1 to 20, by default 4.
    pub key_to_fill: Option<f64>,
}

/// How motion is computed.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Solver {
    /// How the motion is computed.
    pub motion: MovedBy,
    /// With motion = "auto": longest step of constrained dynamics, processor time; by default 2.8 ms.
    pub budget: Option<Time>,
    /// Time integrator.
    pub integrator: Integrator,
    /// Linear solver of the constraint forces.
    pub method: Method,
    /// How open constraints are closed (stabilisation).
    pub stabilize: Stabilize,
    /// Allows open constraints at the start: the mechanism closes them itself.
    pub assemble: bool,
}

/// How the motion is computed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum MovedBy {
    /// Constrained dynamics; position-based motion where the machine is too slow for them.
    #[default]
    Auto,
    /// Always constrained dynamics.
    Dynamics,
    /// Positions first, joint by joint: the classical procedural motion. Not for gears and breakable constraints.
    Procedural,
    /// Positions first, all joints at once. Not for gears and breakable constraints.
    PositionBased,
}

/// What visitors may do to the sculpture by touch or mouse.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Touch {
    /// May visitors grab and drag bodies?
    pub permitted: bool,
    /// Largest force of a grab; by default twice the weight of all moving bodies.
    pub force: Option<Force>,
    /// Lists of bodies: who drags one of a list drags all of it, by the same way. They stand alike at the start.
    pub together: Vec<Vec<String>>,
}

/// The hands of a clock: the kiosk sets them to the local time by turning the minute hand.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Clock {
    /// Body of the minute hand; a clutch holds it on its arbor.
    pub hand: String,
    /// Axis of its clockwise rotation, in its node space.
    pub axis: [f64; 3],
    /// What the hands of the model show, as "10:50".
    pub shows: String,
    /// Bodies that rotate by a fixed angle each hour.
    #[serde(default)]
    pub by_hour: Vec<Turning>,
    /// Bodies that rotate by a fixed angle at each strike of the bell.
    #[serde(default)]
    pub by_strike: Vec<Turning>,
    /// Body that moves while the clock strikes; setting the hands waits for it.
    pub strikes: Option<String>,
}

/// The rotation of a body about an axis through its origin.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Turning {
    /// Which body.
    pub body: String,
    /// Axis, in its node space.
    pub axis: [f64; 3],
    /// Angle.
    pub angle: Angle,
}

impl Default for Touch {
    fn default() -> Self {
        Self { permitted: true, force: None, together: Vec::new() }
    }
}

/// Time integrator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Integrator {
    /// Gauss–Legendre where it is cheap, else Runge–Kutta.
    #[default]
    Auto,
    /// First order, one evaluation a step.
    Fast,
    /// Classical, fourth order.
    RungeKutta,
    /// Gauss–Legendre, sixth order: for clocks.
    Precise,
}

/// Linear solver of the constraint forces.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Method {
    /// Sparse: its cost grows linearly with the number of bodies.
    #[default]
    Sparse,
    /// Dense: one matrix, the reference.
    Dense,
}

/// How open constraints are closed: critically damped (Baumgarte stabilisation).
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
    /// Seconds; may be infinite.
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
    /// Coulomb coefficient of static friction.
    #[schemars(range(min = 0.0))]
    pub static_friction: Option<f64>,
    /// Coulomb coefficient of sliding friction.
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
    /// Loss factor η of the mounted part: T60 = 2.2/(η f).
    #[schemars(range(min = 0.0, max = 1.0))]
    pub loss_factor: Option<f64>,
    /// Rolling resistance: torque against rolling over the normal force. The values of two surfaces add up; without it
    /// rolling bodies do not slow down.
    pub rolling_resistance: Option<Length>,
    /// Drilling friction: torque about the normal over the normal force. The values of two surfaces add up.
    pub spin_resistance: Option<Length>,
    /// Makes it a tyre: its friction grows with the slip (slip over rolling speed; sideways the tangent of the slip angle)
    /// and is full at this one, as in the brush model. 0.1 is a racing tyre, 0.3 a soft one. Without it a surface sticks
    /// until its friction is full.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub full_slip: Option<f64>,
    /// Finish of the bodies and parts of this material, which is how they look: oak, brass-brushed, paint … ; see `finish` of a
    /// body.
    pub finish: Option<String>,
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
    /// Coulomb coefficient of sliding friction.
    #[schemars(range(min = 0.0))]
    pub dynamic_friction: Option<f64>,
    /// Coulomb coefficient of static friction.
    #[schemars(range(min = 0.0))]
    pub static_friction: Option<f64>,
    /// Rolling resistance of both together: torque against rolling over the normal force.
    pub rolling_resistance: Option<Length>,
    /// Drilling friction of both together: torque about the normal over the normal force.
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
    /// glTF node; a node that belongs to no body is fixed.
    pub node: String,
    /// A node below it, or [x, y, z] in node space; by default its origin.
    pub at: Option<Point>,
}

//! Gears, ratchets, stops and springs.

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::quantity::*;
use super::*;

/// Two wheels mesh: their rotations stay in proportion (1 row), or within a backlash of it.
#[derive(Debug, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Gear {
    /// Unique name.
    pub name: Name,
    /// One wheel.
    pub a: Wheel,
    /// The other; both by teeth, or both by radius.
    pub b: Wheel,
    /// Internal gear: both wheels rotate in the same sense.
    #[serde(default)]
    pub internal: bool,
    /// Play between the teeth: a length along the pitch circle where the wheels have radii, an angle of wheel b where
    /// they have teeth. By default none.
    pub backlash: Option<Travel>,
    /// Node of the body that carries both axles; by default the world.
    pub frame: Option<String>,
    /// When it is active.
    #[serde(flatten)]
    pub timing: Timing,
}

/// A toothed wheel.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wheel {
    /// Node of the body.
    pub body: String,
    /// Its axle in node space.
    pub axis: [f64; 3],
    /// Number of teeth.
    #[schemars(range(min = 1))]
    pub teeth: Option<u32>,
    /// Radius of the pitch circle.
    pub radius: Option<Length>,
}

/// A weight hangs on a cord around a drum: its displacement follows the drum's rotation (1 row).
#[derive(Debug, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct GearWeight {
    /// Unique name.
    pub name: Name,
    /// The drum.
    pub gear: Drum,
    /// The weight.
    pub weight: CordWeight,
    /// Cords that carry the weight: 1 hangs directly, 2 in a pulley (half the displacement, twice the pull).
    #[serde(default = "one")]
    #[schemars(range(min = 1, max = 64))]
    pub pulleys: u32,
    /// Node of the body that carries the drum's axle; by default the world.
    pub frame: Option<String>,
    /// When it is active.
    #[serde(flatten)]
    pub timing: Timing,
}

fn one() -> u32 {
    1
}

/// A drum.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drum {
    /// Node of the body.
    pub body: String,
    /// Its axle in node space; a right-handed rotation about it pays the cord out.
    pub axis: [f64; 3],
    /// Radius to the middle of the cord.
    pub radius: Length,
}

/// A weight on a cord.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CordWeight {
    /// Node of the body.
    pub body: String,
    /// Where the cord is attached; by default the node's origin.
    pub at: Option<Point>,
    /// Direction of the displacement as the cord pays out; world axes, or those of `frame`.
    pub direction: [f64; 3],
}

/// A rotation about an axis: that of a named hinge, or of one body relative to another.
#[derive(Clone, Debug, Default, Deserialize, JsonSchema)]
#[serde(default)]
pub struct Axle {
    /// A hinge (for a ratchet also a slider).
    pub of: Option<String>,
    /// Instead of `of`: node of the body that rotates.
    pub body: Option<String>,
    /// With `body`: its axle in node space.
    pub axis: Option<[f64; 3]>,
    /// With `body`: node of the body that it rotates relative to; by default the world.
    pub frame: Option<String>,
}

/// A ratchet: a wheel rotates one way only, as a pawl on its teeth allows.
#[derive(Debug, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Ratchet {
    /// Unique name.
    pub name: Name,
    /// The rotation (or displacement), free where it grows.
    #[serde(flatten)]
    pub axle: Axle,
    /// Free the other way instead.
    #[serde(default)]
    pub reverse: bool,
    /// Number of teeth.
    #[schemars(range(min = 1))]
    pub teeth: Option<u32>,
    /// Instead of `teeth`: distance from tooth to tooth; without either it catches anywhere.
    pub pitch: Option<Travel>,
    /// Is it active at all? By default true.
    pub enabled: Option<bool>,
}

/// Two bodies rotate together until their friction slips: a minute hand on its arbor. It holds again when they come to
/// rest.
#[derive(Debug, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Clutch {
    /// Unique name.
    pub name: Name,
    /// The rotation that it holds.
    #[serde(flatten)]
    pub axle: Axle,
    /// Friction torque: the most it transmits, and what it transmits while it slips.
    pub torque: Torque,
    /// Is it active at all? By default true.
    pub enabled: Option<bool>,
}

/// Stops. Give `of`; or `a`, `b` and an `axis` or `direction`; or `a` and `b` alone for their distance.
#[derive(Debug, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Bounds {
    /// Unique name.
    pub name: Name,
    /// A hinge or slider whose rotation or displacement, from the start, is bounded.
    pub of: Option<String>,
    /// Instead of `of`: a point of the body that moves.
    pub a: Option<Attachment>,
    /// A point of the other body, or of a fixed node; by default the world.
    pub b: Option<Attachment>,
    /// Bounds the rotation of `a` about this axis of its node space, from the start.
    pub axis: Option<[f64; 3]>,
    /// Bounds the displacement of `a` along this direction in the space of `b`, from the start.
    pub direction: Option<[f64; 3]>,
    /// With `axis`: bounds by `max` the tilt of the axis from its direction in the model, instead of the rotation.
    #[serde(default)]
    pub tilt: bool,
    /// Least value.
    pub min: Option<Travel>,
    /// Greatest value.
    pub max: Option<Travel>,
    /// Coefficient of restitution at the bound, 0 … 1.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub restitution: f64,
    /// Is it active at all? By default true.
    pub enabled: Option<bool>,
}

/// A displacement or a rotation, whichever fits: a bare number is m or rad.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Travel {
    /// A number, m or rad.
    Bare(f64),
    /// A text with a unit of length.
    Way(Length),
    /// A text with a unit of angle.
    Turn(Angle),
}

impl Quantity for Travel {
    fn si(self) -> f64 {
        match self {
            Self::Bare(number) => number,
            Self::Way(way) => way.0,
            Self::Turn(turn) => turn.0,
        }
    }
}

/// A spring and damper between two points.
#[derive(Debug, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Spring {
    /// Unique name.
    pub name: Name,
    /// One end.
    pub a: Attachment,
    /// The other end.
    pub b: Attachment,
    /// Length without force; by default the length in the model.
    pub rest_length: Option<Function<Length>>,
    /// Instead of `rest_length`: the signal that gives it, m.
    pub follows: Option<String>,
    /// Force per length.
    pub stiffness: Function<Stiffness>,
    /// Force per speed.
    pub damping: Option<Function<Damping>>,
    /// When it is active.
    #[serde(flatten)]
    pub timing: Timing,
}

/// A spring and damper about an axis.
#[derive(Debug, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct TorsionSpring {
    /// Unique name.
    pub name: Name,
    /// The rotation.
    #[serde(flatten)]
    pub axle: Axle,
    /// Angle without torque, from the start; by default 0.
    pub rest_angle: Option<Function<Angle>>,
    /// Instead of `rest_angle`: the signal that gives it, rad.
    pub follows: Option<String>,
    /// Torque per angle.
    pub stiffness: Function<AngularStiffness>,
    /// Torque per angular velocity.
    pub damping: Option<Function<AngularDamping>>,
    /// When it is active.
    #[serde(flatten)]
    pub timing: Timing,
}

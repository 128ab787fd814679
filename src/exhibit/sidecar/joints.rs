//! Constraints: one array of tables for each kind. This file has the basic kinds; combined joints, forces, and the
//! timing that all kinds share have files of their own.

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::quantity::*;
use super::*;

/// Constraints, one array per kind.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct Constraints {
    /// Two points coincide (ball joint).
    pub point_to_point: Vec<PointToPoint>,
    /// A point of a body stays at a point of the world, of a node, or of a path.
    pub nail: Vec<Nail>,
    /// An axis of a body stays at a right (or given) angle to another.
    pub orientation: Vec<Orientation>,
    /// A point of a body stays in a plane, or at a height above it.
    pub point_on_plane: Vec<PointOnPlane>,
    /// Two gear wheels mesh.
    pub gear: Vec<Gear>,
    /// A weight hangs on a cord around a drum.
    pub gear_weight: Vec<GearWeight>,
    /// A wheel rotates one way only.
    pub ratchet: Vec<Ratchet>,
    /// Two bodies rotate together until the clutch slips.
    pub clutch: Vec<Clutch>,
    /// Constrains one more degree of freedom, or frees one.
    pub element: Vec<Element>,
    /// A spring and damper between two points.
    pub spring: Vec<Spring>,
    /// A spring and damper about an axis.
    pub torsion_spring: Vec<TorsionSpring>,
    /// Stops of a rotation, a displacement, a distance, or a tilt.
    pub limit: Vec<Bounds>,
    /// Rotates about one axis: a point and two orientations.
    pub hinge: Vec<Hinge>,
    /// Two crossed axes: a point and one orientation.
    pub universal: Vec<Universal>,
    /// Slides along one axis without rotating: two planes and three orientations.
    pub slider: Vec<Slider>,
    /// A point slides along a line: two planes.
    pub line: Vec<Line>,
    /// Joins two bodies rigidly: a point and three orientations.
    pub weld: Vec<Weld>,
    /// A rotor on its shaft: a point and two orientations.
    pub windmill: Vec<Hinge>,
}

/// What a point is nailed to.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Target {
    /// A fixed point of the world.
    World([Length; 3]),
    /// A node, or a point of it; a kinematic body makes it a moving nail.
    Node(Attachment),
    /// A path of its own in the world.
    Path {
        /// The path of the nail.
        path: Path,
    },
}

/// Friction of a pivot: a torque up to coefficient · load · radius.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Friction {
    /// Coulomb coefficient.
    #[schemars(range(min = 0.0))]
    pub coefficient: f64,
    /// Effective lever arm: 0.2–0.5 mm for a hook in a loop.
    pub radius: Length,
}

/// An axis of a body.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BodyAxis {
    /// Node of the body.
    pub body: String,
    /// Node space.
    pub axis: [f64; 3],
}

/// Largest tilt of an axis of the first body from an axis of the other, or of the world.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Tilt {
    /// Axis of the first body, node space.
    pub axis: [f64; 3],
    /// Axis of the world; by default the direction of `axis` in the model.
    pub world_axis: Option<[f64; 3]>,
    /// Axis of another body.
    pub other: Option<BodyAxis>,
    /// Largest angle between the two.
    pub max: Angle,
    /// Coefficient of restitution at the limit, 0 … 1.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub restitution: f64,
}

/// Ball joint: two points coincide (3 rows).
#[derive(Debug, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct PointToPoint {
    /// Unique name.
    pub name: Name,
    /// One point.
    pub a: Attachment,
    /// The other.
    pub b: Attachment,
    /// Friction of the pivot.
    pub friction: Option<Friction>,
    /// Tilt limit.
    pub limit: Option<Tilt>,
    /// When it is active.
    #[serde(flatten)]
    pub timing: Timing,
}

/// A point of a body stays at a point of the world, of a node, or of a path (3 rows).
#[derive(Debug, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Nail {
    /// Unique name.
    pub name: Name,
    /// Node of the body.
    pub body: String,
    /// A node below it, or [x, y, z] in node space; by default its origin.
    pub at: Option<Point>,
    /// [x, y, z] in the world, { node, at }, or { path = { points } }.
    pub to: Target,
    /// Friction of the pivot.
    pub friction: Option<Friction>,
    /// Tilt limit.
    pub limit: Option<Tilt>,
    /// When it is active.
    #[serde(flatten)]
    pub timing: Timing,
}

/// Two axes stay at a right angle, or at a given deviation from it (1 row). Give `world_axis` or `other`.
#[derive(Debug, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Orientation {
    /// Unique name.
    pub name: Name,
    /// Node of the body.
    pub body: String,
    /// Axis in its node space.
    pub body_axis: [f64; 3],
    /// Axis of the world.
    pub world_axis: Option<[f64; 3]>,
    /// Axis of another body.
    pub other: Option<BodyAxis>,
    /// Deviation of the first axis from the right angle towards the second; by default 0.
    pub angle: Option<Function<Angle>>,
    /// Friction of the pivot.
    pub friction: Option<Friction>,
    /// Tilt limit.
    pub limit: Option<Tilt>,
    /// When it is active.
    #[serde(flatten)]
    pub timing: Timing,
}

/// A point of a body stays in a plane, or at a height above it (1 row).
#[derive(Debug, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct PointOnPlane {
    /// Unique name.
    pub name: Name,
    /// Node of the body.
    pub body: String,
    /// A node below it, or [x, y, z] in node space; by default its origin.
    pub at: Option<Point>,
    /// The plane.
    pub plane: Plane,
    /// When it is active.
    #[serde(flatten)]
    pub timing: Timing,
}

/// A plane of a node or of the world.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plane {
    /// glTF node that carries it; without it the plane is fixed in the world.
    pub node: Option<String>,
    /// A point of the plane: a node below, or [x, y, z]; by default the node's origin.
    pub at: Option<Point>,
    /// Normal in node space (world axes without a node).
    pub normal: [f64; 3],
    /// Height of the point above the plane; by default its height in the model.
    pub offset: Option<Function<Length>>,
}

/// Constrains one more degree of freedom (`op = "add"`), or frees one of a named constraint (`"remove"`).
#[derive(Debug, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Element {
    /// Unique name.
    pub name: Name,
    /// A constraint: the one to be freed, or whose two bodies are to be constrained further.
    pub of: Option<String>,
    /// To add: node of the body to be constrained, where no constraint is named.
    pub body: Option<String>,
    /// To add: the constrained point, a node below the body, or [x, y, z]; by default its origin.
    pub at: Option<Point>,
    /// Adds a constraint, or removes one.
    pub op: Op,
    /// Which degree of freedom: translation along, or rotation about, an axis of the frame.
    pub dof: Dof,
    /// "world" (the default), "body", or { node = "…" }.
    #[serde(default)]
    pub frame: Frame,
    /// To add: displacement or rotation from the model's pose, m or rad; by default 0.
    pub value: Option<Function<Travel>>,
    /// When it is active.
    #[serde(flatten)]
    pub timing: Timing,
}

/// What an element does.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Op {
    /// Constrains one more degree of freedom.
    Add,
    /// Frees one.
    Remove,
}

/// A degree of freedom.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Dof {
    /// Translation along x.
    Tx,
    /// Translation along y.
    Ty,
    /// Translation along z.
    Tz,
    /// Rotation about x.
    Rx,
    /// Rotation about y.
    Ry,
    /// Rotation about z.
    Rz,
}

/// The axes of a degree of freedom.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Frame {
    /// "world" or "body".
    Word(FrameWord),
    /// The axes of a node.
    Node {
        /// glTF node.
        node: String,
    },
}

/// The axes of a degree of freedom.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum FrameWord {
    /// The world's.
    World,
    /// The body's own.
    Body,
}

impl Default for Frame {
    fn default() -> Self {
        Self::Word(FrameWord::World)
    }
}

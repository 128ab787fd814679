//! Combined joints: short forms of several basic constraints, expanded at load.

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::quantity::*;
use super::*;

/// A hinge or a windmill's rotor: a point and two orientations (5 rows) leave one rotation.
#[derive(Debug, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Hinge {
    /// Unique name.
    pub name: Name,
    /// Node of the body that turns.
    pub body: String,
    /// A node below it, or [x, y, z] in node space; by default its origin.
    pub at: Option<Point>,
    /// Axis in its node space.
    pub axis: [f64; 3],
    /// The other side: [x, y, z] in the world, { node, at }, or a path; by default the world, at the point's position
    /// in the model.
    pub to: Option<Target>,
    /// Stops, from the position at the start.
    pub limit: Option<AngleStops>,
    /// Friction of the pivot.
    pub friction: Option<Friction>,
    /// When it is active.
    #[serde(flatten)]
    pub timing: Timing,
}

/// Stops of a rotation, from the position at the start.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AngleStops {
    /// Least angle; by default none.
    pub min: Option<Angle>,
    /// Greatest angle; by default none.
    pub max: Option<Angle>,
    /// Coefficient of restitution at the stops, 0 … 1.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub restitution: f64,
}

/// Stops of a displacement, from the position at the start.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LengthStops {
    /// Least displacement; by default none.
    pub min: Option<Length>,
    /// Greatest displacement; by default none.
    pub max: Option<Length>,
    /// Coefficient of restitution at the stops, 0 … 1.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub restitution: f64,
}

/// Universal joint, two crossed axes that meet in a point: a point and one orientation (4 rows).
#[derive(Debug, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Universal {
    /// Unique name.
    pub name: Name,
    /// Node of the body.
    pub body: String,
    /// A node below it, or [x, y, z] in node space; by default its origin.
    pub at: Option<Point>,
    /// Axis of the cross in this body, node space.
    pub axis: [f64; 3],
    /// The other side; by default the world, at the point's position in the model.
    pub to: Option<Target>,
    /// Axis of the cross in the other body, in its node space (world axes without a node); at a right angle to `axis`.
    pub other_axis: [f64; 3],
    /// Friction of the pivot.
    pub friction: Option<Friction>,
    /// When it is active.
    #[serde(flatten)]
    pub timing: Timing,
}

/// Slides along one axis without rotating: two planes and three orientations (5 rows).
#[derive(Debug, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Slider {
    /// Unique name.
    pub name: Name,
    /// Node of the body that slides.
    pub body: String,
    /// A node below it, or [x, y, z] in node space; by default its origin.
    pub at: Option<Point>,
    /// Direction of the displacement in its node space.
    pub axis: [f64; 3],
    /// The guide; by default the world, at the point's position in the model.
    pub to: Option<Target>,
    /// Stops, from the position at the start.
    pub limit: Option<LengthStops>,
    /// When it is active.
    #[serde(flatten)]
    pub timing: Timing,
}

/// A point of a body slides along a line, and the body rotates freely: two planes (2 rows).
#[derive(Debug, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Line {
    /// Unique name.
    pub name: Name,
    /// Node of the body.
    pub body: String,
    /// A node below it, or [x, y, z] in node space; by default its origin.
    pub at: Option<Point>,
    /// A point of the line; by default the world, at the point's position in the model.
    pub to: Option<Target>,
    /// Direction of the line in the space of the node of `to` (world axes without a node).
    pub direction: [f64; 3],
    /// When it is active.
    #[serde(flatten)]
    pub timing: Timing,
}

/// Joins two bodies rigidly: a point and three orientations (6 rows).
#[derive(Debug, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Weld {
    /// Unique name.
    pub name: Name,
    /// Node of the body.
    pub body: String,
    /// A node below it, or [x, y, z] in node space; by default its origin.
    pub at: Option<Point>,
    /// The other side; by default the world, at the point's position in the model.
    pub to: Option<Target>,
    /// When it is active.
    #[serde(flatten)]
    pub timing: Timing,
}

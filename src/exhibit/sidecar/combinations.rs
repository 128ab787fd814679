//! Combinations: short forms of several basic constraints, expanded at load.

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::quantity::*;
use super::*;

/// A hinge or a windmill's rotor: a point and two orientations, one turn left (5 rows).
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
    /// What carries it: [x, y, z] in the world, { node, at }, or a path; by default the world, where it is at rest.
    pub to: Option<Target>,
    /// Stops, counted from the start.
    pub limit: Option<AngleStops>,
    /// Friction of the pivot.
    pub friction: Option<Friction>,
    /// When it acts.
    #[serde(flatten)]
    pub timing: Timing,
}

/// Stops of a turn, counted from the start.
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

/// Stops of a way, counted from the start.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LengthStops {
    /// Least way; by default none.
    pub min: Option<Length>,
    /// Greatest way; by default none.
    pub max: Option<Length>,
    /// Coefficient of restitution at the stops, 0 … 1.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub restitution: f64,
}

/// Two crossed axes meet in a point: a point and one orientation (4 rows).
#[derive(Debug, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Universal {
    /// Unique name.
    pub name: Name,
    /// Node of the body.
    pub body: String,
    /// A node below it, or [x, y, z] in node space; by default its origin.
    pub at: Option<Point>,
    /// Its axis of the cross, node space.
    pub axis: [f64; 3],
    /// What carries it; by default the world, where it is at rest.
    pub to: Option<Target>,
    /// The carrier's axis of the cross, in its node space (world axes without a node); at a right angle to `axis`.
    pub other_axis: [f64; 3],
    /// Friction of the pivot.
    pub friction: Option<Friction>,
    /// When it acts.
    #[serde(flatten)]
    pub timing: Timing,
}

/// Slides along one axis and does not turn: two planes and three orientations (5 rows).
#[derive(Debug, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Slider {
    /// Unique name.
    pub name: Name,
    /// Node of the body that slides.
    pub body: String,
    /// A node below it, or [x, y, z] in node space; by default its origin.
    pub at: Option<Point>,
    /// Direction of the way in its node space.
    pub axis: [f64; 3],
    /// What it slides on; by default the world, where it is at rest.
    pub to: Option<Target>,
    /// Stops, counted from the start.
    pub limit: Option<LengthStops>,
    /// When it acts.
    #[serde(flatten)]
    pub timing: Timing,
}

/// A point of a body slides along a line and turns freely: two planes (2 rows).
#[derive(Debug, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Line {
    /// Unique name.
    pub name: Name,
    /// Node of the body.
    pub body: String,
    /// A node below it, or [x, y, z] in node space; by default its origin.
    pub at: Option<Point>,
    /// A point of the line; by default the world, where it is at rest.
    pub to: Option<Target>,
    /// Direction of the line in the space of the node of `to` (world axes without a node).
    pub direction: [f64; 3],
    /// When it acts.
    #[serde(flatten)]
    pub timing: Timing,
}

/// Nothing moves: a point and three orientations (6 rows).
#[derive(Debug, Deserialize, JsonSchema)]
#[schemars(deny_unknown_fields)]
pub struct Weld {
    /// Unique name.
    pub name: Name,
    /// Node of the body.
    pub body: String,
    /// A node below it, or [x, y, z] in node space; by default its origin.
    pub at: Option<Point>,
    /// What it is welded to; by default the world, where it is at rest.
    pub to: Option<Target>,
    /// When it acts.
    #[serde(flatten)]
    pub timing: Timing,
}

//! Joints: one array of tables per kind, named as the field names them.

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::quantity::*;
use super::{Attachment, Name, Point};

/// Where a nail is driven in.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum NailTarget {
    /// A fixed point of the world.
    World([Length; 3]),
    /// A node, or a point of it.
    Node(Attachment),
}

/// Joints, one array per kind.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename_all = "kebab-case", default)]
pub struct Constraints {
    /// Two points coincide.
    pub point_to_point: Vec<PointToPoint>,
    /// A point of a body stays at a point of the world or of a node.
    pub nail: Vec<Nail>,
    /// An axis of a body stays perpendicular to another.
    pub orientation: Vec<Orientation>,
    /// A spring and damper between two points.
    pub spring: Vec<Spring>,
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

/// Largest tilt of an axis of the first body away from an axis of the other, or of the world.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Limit {
    /// Axis of the first body, node space.
    pub axis: [f64; 3],
    /// Axis of the world; the default is `axis` where it points at rest.
    pub world_axis: Option<[f64; 3]>,
    /// Axis of another body.
    pub other: Option<BodyAxis>,
    /// Largest angle between the two.
    pub max: Angle,
    /// Coefficient of restitution at the rim, 0 … 1.
    #[serde(default)]
    #[schemars(range(min = 0.0, max = 1.0))]
    pub restitution: f64,
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

/// Two points coincide (3 rows).
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
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
    pub limit: Option<Limit>,
}

/// A point of a body stays at a point of the world or of a node (3 rows).
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Nail {
    /// Unique name.
    pub name: Name,
    /// Node of the body.
    pub body: String,
    /// A node below it, or [x, y, z] in node space; by default its origin.
    pub at: Option<Point>,
    /// [x, y, z] in the world, or { node, at }.
    pub to: NailTarget,
    /// Friction of the pivot.
    pub friction: Option<Friction>,
    /// Tilt limit.
    pub limit: Option<Limit>,
}

/// Two axes stay perpendicular (1 row). Give `world_axis` or `other`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
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
    /// Friction of the pivot.
    pub friction: Option<Friction>,
    /// Tilt limit.
    pub limit: Option<Limit>,
}

/// A spring and damper between two points.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Spring {
    /// Unique name.
    pub name: Name,
    /// One end.
    pub a: Attachment,
    /// The other end.
    pub b: Attachment,
    /// Length without force; by default the length at rest.
    pub rest_length: Option<Length>,
    /// Force per length.
    pub stiffness: Stiffness,
    /// Force per speed.
    pub damping: Option<Damping>,
}

//! Where bodies touch: colliders, pairs, distances, time of impact.

use crate::math::DVec3;

/// A convex collision shape: the Minkowski sum of a convex core and a ball.
///
/// Spheres have a point for a core, capsules and wires a segment, sheet metal a flat polygon with half its
/// thickness as the radius: one distance routine serves them all, and thin plates keep a well-defined normal.
#[derive(Clone, Debug)]
pub struct Collider {
    /// Index of the moving body it belongs to; `None` stands still.
    pub body: Option<usize>,
    /// Corners of the core in the body's node frame (world frame where `body` is `None`), m.
    pub core: Vec<DVec3>,
    /// Radius of the ball, m.
    pub radius: f64,
    /// Index of the material.
    pub material: usize,
    /// Name of the glTF node, for messages and events.
    pub node: String,
}

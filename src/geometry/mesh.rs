//! Triangle meshes in a body's node frame.

use crate::math::DVec3;

/// Triangles in the node frame of a body, metres, counter-clockwise seen from outside.
#[derive(Clone, Debug, Default)]
pub struct TriangleMesh {
    /// Corner positions, m.
    pub positions: Vec<DVec3>,
    /// Three indices into `positions` per triangle.
    pub triangles: Vec<[u32; 3]>,
}

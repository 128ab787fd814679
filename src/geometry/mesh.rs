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

impl TriangleMesh {
    /// A ball around the mesh: the middle of its bounding box and the farthest corner, m.
    pub fn ball(&self) -> (DVec3, f64) {
        let low = self.positions.iter().fold(DVec3::INFINITY, |low, &p| low.min(p));
        let high = self.positions.iter().fold(DVec3::NEG_INFINITY, |high, &p| high.max(p));
        let center = 0.5 * (low + high);
        (center, self.positions.iter().fold(0.0, |r: f64, p| r.max(p.distance(center))))
    }
}

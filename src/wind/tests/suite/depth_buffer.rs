//! The source's visibility test: an ID buffer (item buffer) drawn from the vertex of the cone. Each triangle is drawn into a
//! square picture with the number of its body; a patch is visible where the picture shows its body.
//!
//! With z the depth along the axis and (u, v) = (x, y)/z on the picture plane, 1/z is linear in u and v over a triangle.
//! This code shares nothing with the hierarchies and rays of the library.

use soffio_geometry::TriangleMesh;
use soffio_math::{DVec3, Pose, tangents};
use soffio_wind::breath::Breath;

/// A picture of body numbers with a depth buffer.
pub struct IdBuffer {
    size: usize,
    half_width: f64,
    eye: DVec3,
    axes: [DVec3; 3],
    /// (1/z, number of the body) of the nearest surface.
    pixels: Vec<(f64, u32)>,
}

/// Value of an empty pixel.
const NOTHING: u32 = u32::MAX;

impl IdBuffer {
    /// A picture of `size` × `size` pixels that reaches `half_width` (a tangent) to each side of the axis.
    pub fn new(breath: &Breath, size: usize, half_width: f64) -> Self {
        let (t, b) = tangents(breath.direction);
        let axes = [t, b, breath.direction];
        Self { size, half_width, eye: breath.vertex(), axes, pixels: vec![(0.0, NOTHING); size * size] }
    }

    /// (column, row, 1/z) of a point of the world, in pixels.
    fn project(&self, point: DVec3) -> [f64; 3] {
        let from = point - self.eye;
        let [x, y, z] = self.axes.map(|axis| from.dot(axis));
        let pixel = |u: f64| (0.5 + 0.5 * u / (z * self.half_width)) * self.size as f64;
        [pixel(x), pixel(y), 1.0 / z]
    }

    /// Draws a mesh that lies wholly before the eye.
    pub fn draw(&mut self, id: u32, mesh: &TriangleMesh, pose: &Pose) {
        for corners in mesh.corners() {
            let [a, b, c] = corners.map(|p| self.project(pose.point(p)));
            let edge =
                |p: [f64; 3], q: [f64; 3], x: f64, y: f64| (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0]);
            let area = edge(a, b, c[0], c[1]);
            if area == 0.0 {
                continue;
            }
            let range = |k: usize| {
                let low = a[k].min(b[k]).min(c[k]).floor().clamp(0.0, self.size as f64);
                let high = a[k].max(b[k]).max(c[k]).ceil().clamp(0.0, self.size as f64);
                low as usize..high as usize
            };
            let (columns, rows) = (range(0), range(1));
            for row in rows {
                for column in columns.clone() {
                    let (x, y) = (column as f64 + 0.5, row as f64 + 0.5);
                    let shares = [edge(b, c, x, y) / area, edge(c, a, x, y) / area, edge(a, b, x, y) / area];
                    if shares.iter().any(|s| *s < 0.0) {
                        continue;
                    }
                    let near = shares[0] * a[2] + shares[1] * b[2] + shares[2] * c[2];
                    let pixel = &mut self.pixels[row * self.size + column];
                    if near > pixel.0 {
                        *pixel = (near, id);
                    }
                }
            }
        }
    }

    /// Number of the nearest body in the direction of a point, if any.
    pub fn seen_at(&self, point: DVec3) -> Option<u32> {
        let [column, row, _] = self.project(point);
        let id = self.pixels.get(row as usize * self.size + column as usize)?.1;
        (id != NOTHING).then_some(id)
    }
}

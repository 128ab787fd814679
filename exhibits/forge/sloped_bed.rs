//! A rectangular bed that sinks towards its middle, with a wall on each side: balls and wheels on it come together again.

use soffio_math::{DQuat, DVec2, DVec3};

use soffio_authoring::glb::Scene;
use soffio_authoring::outline::Polygon;
use soffio_authoring::solid::Solid;

/// Outward directions of the sides: left, right, back, front.
const SIDES: [DVec2; 4] = [DVec2::new(-1.0, 0.0), DVec2::new(1.0, 0.0), DVec2::new(0.0, -1.0), DVec2::new(0.0, 1.0)];

/// A bed of four slopes.
pub struct SlopedBed {
    /// Half lengths between the walls along x and z, m.
    pub half: DVec2,
    /// Height of its middle above the ground, m.
    pub height: f64,
    /// Height of its edge above its middle, m.
    pub rise: f64,
}

impl SlopedBed {
    /// The rectangle between the walls, its sides moved outwards, m.
    pub fn rectangle(&self, out: f64) -> Polygon {
        let (x, y) = (self.half.x + out, self.half.y + out);
        [(-x, -y), (x, -y), (x, y), (-x, y)].map(|(x, y)| DVec2::new(x, y)).into()
    }

    /// Normal of the slope on the side `out`.
    fn normal(&self, out: DVec2) -> DVec3 {
        DVec3::new(-out.x * self.rise / self.half.x, 1.0, -out.y * self.rise / self.half.y).normalize()
    }

    /// Height of the middle of a ball of this radius that lies on the bed at (x, z), m; of the bed itself for a radius of 0.
    pub fn above(&self, at: DVec2, radius: f64) -> f64 {
        let above = |out: &DVec2| {
            let n = self.normal(*out);
            self.height + (radius - n.x * at.x - n.z * at.y) / n.y
        };
        SIDES.iter().map(above).fold(0.0, f64::max)
    }

    /// Adds the nodes of the planes of slopes and walls, left, right, back and front, Y out of each.
    pub fn write_planes(&self, scene: &mut Scene, names: [[&str; 2]; 4]) {
        let y_to = |normal: DVec3| DQuat::from_rotation_arc(DVec3::Y, normal);
        for ([slope, wall], out) in names.into_iter().zip(SIDES) {
            let edge = DVec3::new(out.x * self.half.x, self.height + self.rise, out.y * self.half.y);
            scene.node(slope, None, self.height * DVec3::Y, y_to(self.normal(out)));
            scene.node(wall, None, edge, y_to(-DVec3::new(out.x, 0.0, out.y)));
        }
    }

    /// The bed as a solid, `thickness` m at its edge.
    pub fn solid(&self, thickness: f64) -> Solid {
        let mut solid = Solid::default();
        let corner = |x: f64, z: f64, y: f64| DVec3::new(x * self.half.x, y, z * self.half.y);
        let ring = [(-1.0, 1.0), (1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)];
        let mut face = |corners: &[DVec3]| {
            let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize();
            let base = solid.positions.len() as u32;
            solid.positions.extend(corners);
            solid.normals.extend(corners.iter().map(|_| normal));
            solid.triangles.extend((2..corners.len() as u32).map(|k| [base, base + k - 1, base + k]));
        };
        let (top, bottom) = (self.height + self.rise, self.height + self.rise - thickness);
        for k in 0..4 {
            let ((x, z), (u, w)) = (ring[k], ring[(k + 1) % 4]);
            face(&[corner(x, z, top), corner(u, w, top), self.height * DVec3::Y]);
            face(&[corner(x, z, bottom), corner(u, w, bottom), corner(u, w, top), corner(x, z, top)]);
        }
        face(&[3, 2, 1, 0].map(|k: usize| corner(ring[k].0, ring[k].1, bottom)));
        solid
    }
}

//! Where the visitor looks from.

use crate::math::DVec3;

/// A perspective camera in the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// m.
    pub eye: DVec3,
    /// Point looked at, m; the breath is aimed at the plane through it that faces the eye.
    pub target: DVec3,
    /// Unit, roughly upwards.
    pub up: DVec3,
    /// Vertical field of view, rad.
    pub fovy: f64,
}

impl super::Exhibit {
    /// The camera for a picture of this aspect (width / height): the sidecar's camera node, widened where the
    /// picture is narrower than the camera was made for, or a frame around the bounds.
    pub fn view(&self, _aspect: f64) -> View {
        View { eye: DVec3::new(0.0, 0.3, 1.2), target: DVec3::new(0.0, 0.3, 0.0), up: DVec3::Y, fovy: 0.6 }
    }
}

impl View {
    /// The ray through a point of the picture: origin (m) and unit direction.
    pub fn ray(&self, at: [f64; 2], aspect: f64) -> (DVec3, DVec3) {
        let forward = (self.target - self.eye).normalize();
        let right = forward.cross(self.up).normalize();
        let up = right.cross(forward);
        let tan = crate::math::sin(0.5 * self.fovy) / crate::math::cos(0.5 * self.fovy);
        let (x, y) = ((2.0 * at[0] - 1.0) * tan * aspect, (1.0 - 2.0 * at[1]) * tan);
        (self.eye, (forward + x * right + y * up).normalize())
    }
}

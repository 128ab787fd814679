//! The camera: view rays through the filter of a pixel.
//!
//! The filter is a tent two pixels wide, the one that the live picture's files are reduced with. Both pictures are
//! then equally sharp. Offsets are drawn with the density of the tent instead of weighted with it, so that pixels are
//! independent. The inverse of its distribution has a closed form.

use glam::{Vec2, Vec3};

use super::super::FrameInput;

/// A pinhole camera.
pub(super) struct Camera {
    /// World, m.
    pub eye: Vec3,
    /// Direction through the picture's top left corner, and from one pixel to the next.
    corner: Vec3,
    steps: [Vec3; 2],
}

impl Camera {
    /// The camera of a frame: d = f + (2x − 1) a t r + (1 − 2y) t u, as [`soffio_exhibit::View`].
    pub fn new(frame: &FrameInput) -> Self {
        let (width, height) = (f64::from(frame.size.0), f64::from(frame.size.1));
        let (right, up, forward) = frame.view.axes();
        let t = (0.5 * frame.view.fovy).tan();
        let (right, up) = (right * (t * width / height), up * t);
        Self {
            eye: frame.view.eye.as_vec3(),
            corner: (forward - right + up).as_vec3(),
            steps: [(right * (2.0 / width)).as_vec3(), (up * (-2.0 / height)).as_vec3()],
        }
    }

    /// Unit direction through a point of a pixel's filter, drawn by the first two numbers.
    pub fn direction(&self, (x, y): (u32, u32), [u, v, ..]: [f32; 4]) -> Vec3 {
        let at = Vec2::new(x as f32 + 0.5 + tent(u), y as f32 + 0.5 + tent(v));
        (self.corner + self.steps[0] * at.x + self.steps[1] * at.y).normalize()
    }
}

/// Offset with the density of a tent, −1 … 1 pixels.
fn tent(u: f32) -> f32 {
    if u < 0.5 { (2.0 * u).sqrt() - 1.0 } else { 1.0 - (2.0 - 2.0 * u).sqrt() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use soffio_exhibit::View;

    #[test]
    fn rays_are_those_of_the_view_and_the_filter_is_a_tent() {
        // Single precision of a unit vector, and of a mean of a thousand midpoints.
        const ROUNDING: f32 = 1e-6;
        const MIDPOINTS: f32 = 1e-4;
        let view = View { eye: DVec3::new(1.0, 2.0, 3.0), target: DVec3::new(0.2, 1.5, -1.0), up: DVec3::Y, fovy: 0.7 };
        let size = (64, 36);
        let frame = FrameInput { poses: &[], dust: &[], curves: &[], view, size, exposure: 1.0, time: 0.0 };
        let camera = Camera::new(&frame);
        // In the middle of the tent the offset is 0.
        let d = camera.direction((10, 30), [0.5; 4]);
        let exact = view.ray([10.5 / 64.0, 30.5 / 36.0], 64.0 / 36.0).1.as_vec3();
        assert!(d.distance(exact) < ROUNDING, "{d} {exact}");
        // ∫ x² (1 − |x|) dx = 1/6.
        let variance = (0..1000).map(|i| tent((i as f32 + 0.5) / 1000.0)).map(|x| x * x).sum::<f32>() / 1000.0;
        assert!((variance - 1.0 / 6.0).abs() < MIDPOINTS && tent(0.0) == -1.0, "{variance}");
    }
}

//! From motion to sound: where things are heard, where on a body they are, and how the wind sounds.

use crate::exhibit::{Exhibit, SoundBinding, View};
use crate::math::DVec3;
use crate::sound::{SoundCommand, WindSound};

/// The visitor's ears, at the camera.
#[derive(Clone, Copy, Debug)]
pub struct Listener {
    eye: DVec3,
    right: DVec3,
}

impl Listener {
    /// Ears of a visitor who looks through this view.
    pub fn new(view: &View) -> Self {
        let forward = (view.target - view.eye).normalize();
        Self { eye: view.eye, right: forward.cross(view.up).normalize() }
    }

    /// Pan (−1 left … 1 right) and distance (m) of a point.
    pub fn place(&self, point: DVec3) -> (f32, f32) {
        let from = point - self.eye;
        // The sine of the angle to the side, spread so that the picture's edges come from the loudspeakers.
        let side = from.dot(self.right) / from.length().max(1e-3);
        ((2.0 * side).clamp(-1.0, 1.0) as f32, from.length() as f32)
    }
}

/// A point of a body's node frame as coordinates along the two half extents of its sound, −1…1.
pub fn place_on(exhibit: &Exhibit, sound: &SoundBinding, local: DVec3) -> [f32; 2] {
    let (first, second, center) = sound.frame;
    let half = exhibit.instruments[sound.instrument].body.half_extents;
    let along = |axis: DVec3, half: f64| ((local - center).dot(axis) / half.max(1e-6)).clamp(-1.0, 1.0) as f32;
    [along(first, half[0]), along(second, half[1])]
}

/// The wind as it is heard: the speed of the air where the breath is aimed.
pub fn wind(sample: u64, air: f64, gust: f64, target: DVec3, listener: &Listener) -> SoundCommand {
    let (pan, _) = listener.place(target);
    SoundCommand::Wind(WindSound { sample, speed: air as f32, gust: gust as f32, direction: 0.0, pan })
}

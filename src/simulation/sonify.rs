//! Sonification: position of sounds about the listener and on a body.

use soffio_exhibit::{Exhibit, ImpactFrame, SoundBinding, View};
use soffio_math::{DVec3, atan2};

/// Pan per sine of the angle to the side, so that sounds at the picture's edges come from the outputs.
const PAN_SPREAD: f64 = 2.0;

/// Position of a sound about the listener.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoundPosition {
    /// −1 left … 1 right.
    pub pan: f32,
    /// Distance of the listener, m.
    pub distance: f32,
}

/// The visitor as a listener, at the camera.
#[derive(Clone, Copy, Debug)]
pub struct AudioListener {
    /// World, m.
    position: DVec3,
    /// Unit.
    right: DVec3,
    /// Horizontal.
    ahead: DVec3,
}

impl AudioListener {
    /// At the camera of this view.
    pub fn new(view: &View) -> Self {
        let forward = (view.target - view.eye).normalize();
        let right = forward.cross(view.up).normalize();
        Self { position: view.eye, right, ahead: view.up.cross(right) }
    }

    /// Direction of a flow seen from above: 0 away from the visitor, positive to the right, rad.
    pub fn direction(&self, flow: DVec3) -> f32 {
        atan2(flow.dot(self.right), flow.dot(self.ahead)) as f32
    }

    /// Pan and distance of a point (world, m).
    pub fn locate(&self, point: DVec3) -> SoundPosition {
        let from = point - self.position;
        let sine = from.dot(self.right) / from.length().max(1e-3);
        SoundPosition { pan: (PAN_SPREAD * sine).clamp(-1.0, 1.0) as f32, distance: from.length() as f32 }
    }
}

/// A point of a body's node frame as coordinates along the two half extents of its sound, −1…1.
pub fn strike_position(exhibit: &Exhibit, sound: &SoundBinding, local: DVec3) -> [f32; 2] {
    let ImpactFrame { longest: first, middle: second, center } = sound.frame;
    let half = exhibit.instruments[sound.instrument].body.half_extents;
    let along = |axis: DVec3, half: f64| ((local - center).dot(axis) / half.max(1e-6)).clamp(-1.0, 1.0) as f32;
    [along(first, half[0]), along(second, half[1])]
}

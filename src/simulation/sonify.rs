//! From motion to sound: which impact strikes which instrument, where on the body, and how the wind is heard.

use super::event::Event;
use crate::bodies::RigidBody;
use crate::dynamics::Impact;
use crate::exhibit::{Exhibit, SoundTrigger, View};
use crate::math::DVec3;
use crate::sound::{SoundCommand, Strike, WindSound};

/// Impacts softer than this make no sound, N s: a milligram at walking pace.
const SILENT: f64 = 1e-7;

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
    fn place(&self, point: DVec3) -> (f32, f32) {
        let from = point - self.eye;
        // The sine of the angle to the side, spread so that the picture's edges come from the loudspeakers.
        let side = from.dot(self.right) / from.length().max(1e-3);
        ((2.0 * side).clamp(-1.0, 1.0) as f32, from.length() as f32)
    }
}

/// Strikes of an impact: each of the two bodies that has a sound for it.
pub fn strikes(
    exhibit: &Exhibit,
    event: &Event,
    impact: &Impact,
    bodies: &[RigidBody],
    listener: &Listener,
    out: &mut Vec<SoundCommand>,
) {
    if impact.impulse < SILENT {
        return;
    }
    let (pan, distance) = listener.place(event.point);
    for body in event.bodies.into_iter().flatten() {
        for sound in exhibit.sounds.iter().filter(|s| s.body == body && s.on == SoundTrigger::Impact) {
            let (first, second, center) = sound.frame;
            let local = bodies[body].pose().inverse_point(event.point) - center;
            let half = exhibit.instruments[sound.instrument].body.half_extents;
            let along = |axis: DVec3, half: f64| (local.dot(axis) / half.max(1e-6)).clamp(-1.0, 1.0) as f32;
            out.push(SoundCommand::Strike(Strike {
                sample: event.sample,
                instrument: sound.instrument as u16,
                impulse: impact.impulse as f32,
                speed: impact.speed as f32,
                mass: impact.mass as f32,
                position: [along(first, half[0]), along(second, half[1])],
                pan,
                distance,
            }));
        }
    }
}

/// The wind as it is heard: the speed of the air where the breath is aimed.
pub fn wind(sample: u64, air: f64, gust: f64, target: DVec3, listener: &Listener) -> SoundCommand {
    let (pan, _) = listener.place(target);
    SoundCommand::Wind(WindSound { sample, speed: air as f32, gust: gust as f32, direction: 0.0, pan })
}

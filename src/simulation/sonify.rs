//! Sonification: position of sounds about the listener and on a body, and the sound of the wind.

use soffio_exhibit::{Exhibit, ImpactFrame, SoundBinding, SoundTrigger, View};
use soffio_geometry::bodies::RigidBody;
use soffio_math::{DVec3, atan2};
use soffio_sound::{SoundCommand, WindExposure, WindSound};

/// Least change of a wire's wind exposure that is sent.
const EXPOSURE_STEP: f32 = 0.01;
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

/// Sound of the wind with this air velocity (m/s) and relative gust.
pub fn wind(sample: u64, velocity: DVec3, gust: f64, pan: f32, listener: &AudioListener) -> SoundCommand {
    let direction = atan2(velocity.dot(listener.right), velocity.dot(listener.ahead)) as f32;
    SoundCommand::Wind(WindSound { sample, speed: velocity.length() as f32, gust: gust as f32, direction, pan })
}

/// A wire with an aeolian tone.
#[derive(Clone)]
struct WireSound {
    /// Index of the exhibit's sound.
    sound: usize,
    /// Wind exposure as last sent.
    sent: f32,
}

/// All wires of an exhibit with an aeolian tone.
#[derive(Clone)]
pub struct WireSounds(Vec<WireSound>);

impl WireSounds {
    /// The exhibit's, fully exposed.
    pub fn new(exhibit: &Exhibit) -> Self {
        let is_aeolian = |(_, sound): &(usize, &SoundBinding)| sound.on == SoundTrigger::Wind && sound.wire.is_some();
        let sounds = exhibit.sounds.iter().enumerate().filter(is_aeolian);
        Self(sounds.map(|(sound, _)| WireSound { sound, sent: 1.0 }).collect())
    }

    /// Sends the wind exposure of each wire in this air velocity (m/s) where it has changed.
    pub fn update(
        &mut self,
        sample: u64,
        velocity: DVec3,
        exhibit: &Exhibit,
        bodies: &[RigidBody],
        out: &mut Vec<SoundCommand>,
    ) {
        let Some(flow) = velocity.try_normalize() else { return };
        for WireSound { sound, sent } in &mut self.0 {
            let binding = &exhibit.sounds[*sound];
            let Some(wire) = binding.wire.map(|wire| &exhibit.wires[wire]) else { continue };
            let flow = wire.body.map_or(flow, |body| bodies[body].pose().inverse_vector(flow));
            let share = wind_exposure(&wire.points, flow) as f32;
            if (share - *sent).abs() > EXPOSURE_STEP {
                *sent = share;
                let instrument = binding.instrument as u16;
                out.push(SoundCommand::WindExposure(WindExposure { sample, instrument, share }));
            }
        }
    }
}

/// Mean sine of the angle between a polyline and a unit vector: Σ l |sin| / Σ l.
fn wind_exposure(points: &[DVec3], flow: DVec3) -> f64 {
    let pieces = points.windows(2).map(|ends| ends[1] - ends[0]);
    let (crossed, length) = pieces
        .fold((0.0, 0.0), |(crossed, length), piece| (crossed + piece.cross(flow).length(), length + piece.length()));
    if length > 0.0 { (crossed / length).min(1.0) } else { 1.0 }
}

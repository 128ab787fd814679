//! From motion to sound: where things are heard, where on a body they are, and how the wind sounds.

use soffio_exhibit::{Exhibit, SoundBinding, SoundTrigger, View};
use soffio_geometry::bodies::RigidBody;
use soffio_math::{DVec3, atan2};
use soffio_sound::{Across, SoundCommand, WindSound};

/// A wire that hears so much more or less of the wind is told, as a part of it.
const TURNED: f32 = 0.01;

/// The visitor's ears, at the camera.
#[derive(Clone, Copy, Debug)]
pub struct Listener {
    eye: DVec3,
    right: DVec3,
    /// Level.
    ahead: DVec3,
}

impl Listener {
    /// Ears of a visitor who looks through this view.
    pub fn new(view: &View) -> Self {
        let forward = (view.target - view.eye).normalize();
        let right = forward.cross(view.up).normalize();
        Self { eye: view.eye, right, ahead: view.up.cross(right) }
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

/// The wind as it is heard: the air where the breath is aimed, m/s.
pub fn wind(sample: u64, air: DVec3, gust: f64, target: DVec3, listener: &Listener) -> SoundCommand {
    let (pan, _) = listener.place(target);
    let direction = atan2(air.dot(listener.right), air.dot(listener.ahead)) as f32;
    SoundCommand::Wind(WindSound { sample, speed: air.length() as f32, gust: gust as f32, direction, pan })
}

/// Wires that sing, and what part of the wind each was last told to hear.
#[derive(Clone)]
pub struct Wires(Vec<(usize, f32)>);

impl Wires {
    /// The exhibit's; none was told anything.
    pub fn new(exhibit: &Exhibit) -> Self {
        let sings = |(_, sound): &(usize, &SoundBinding)| sound.on == SoundTrigger::Wind && sound.wire.is_some();
        Self(exhibit.sounds.iter().enumerate().filter(sings).map(|(i, _)| (i, 1.0)).collect())
    }

    /// Tells each what part of the wind blows across it now, where that has changed.
    pub fn turn(
        &mut self,
        (sample, air): (u64, DVec3),
        exhibit: &Exhibit,
        bodies: &[RigidBody],
        out: &mut Vec<SoundCommand>,
    ) {
        let Some(flow) = air.try_normalize() else { return };
        for (sound, told) in &mut self.0 {
            let binding = &exhibit.sounds[*sound];
            let Some(wire) = binding.wire.map(|wire| &exhibit.wires[wire]) else { continue };
            let flow = wire.body.map_or(flow, |body| bodies[body].pose().inverse_vector(flow));
            let share = across(&wire.points, flow) as f32;
            if (share - *told).abs() > TURNED {
                *told = share;
                let instrument = binding.instrument as u16;
                out.push(SoundCommand::Across(Across { sample, instrument, share }));
            }
        }
    }
}

/// Part of a flow along a unit vector that crosses a polyline, piece by piece: Σ l |sin| / Σ l.
fn across(points: &[DVec3], flow: DVec3) -> f64 {
    let pieces = points.windows(2).map(|ends| ends[1] - ends[0]);
    let (crossed, length) = pieces
        .fold((0.0, 0.0), |(crossed, length), piece| (crossed + piece.cross(flow).length(), length + piece.length()));
    if length > 0.0 { (crossed / length).min(1.0) } else { 1.0 }
}

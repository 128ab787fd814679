//! The air at each sound that follows it, as commands.
//!
//! A sound of wind surfaces follows the even wind that would be as loud ([`soffio_wind::air_noise`]): breath, fans, draughts,
//! turbulence, and the surfaces' own motion through the air. A wire follows the wind across it: with the velocity v of the air at the
//! middle of each of its pieces, relative to the wire, the direction e and the length l of the piece,
//!
//! ```text
//! U = (Σ l |v × e|⁶ / Σ l)^(1/6)
//! ```
//!
//! A command is sent when the air has changed enough to be heard.

use super::air::{AimedBreath, Air};
use super::sonify::AudioListener;
use soffio_exhibit::{AirAt, Exhibit};
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_sound::{SoundCommand, WindSound};
use soffio_wind::air_noise::AirNoise;

/// Speed below which air makes no sound, m/s: 60 dB below a breath of 1 m/s at the sculpture.
const SILENT: f64 = 0.1;
/// Least change that is sent: of the speed in m/s, of gust, direction and pan in their units. 1 % of a wind of 1 m/s is 0.5 dB.
const LEAST_CHANGE: f32 = 0.01;

/// One sound that follows the air.
#[derive(Clone)]
struct AirSound {
    /// Index of the exhibit's sound.
    sound: usize,
    /// Area of the surfaces, m².
    area: f64,
    /// Last sent.
    sent: Option<WindSound>,
}

/// All sounds of an exhibit that follow the air.
#[derive(Clone)]
pub(crate) struct AirSounds(Vec<AirSound>);

impl AirSounds {
    /// The exhibit's, in calm air.
    pub fn new(exhibit: &Exhibit, air: &Air) -> Self {
        let follow = exhibit.sounds.iter().enumerate().filter_map(|(sound, binding)| {
            let area = match binding.follows.air.as_ref()? {
                AirAt::Surfaces(surfaces) => surfaces.iter().map(|&surface| air.wind.area(surface)).sum(),
                AirAt::Wire(_) => 0.0,
            };
            Some(AirSound { sound, area, sent: None })
        });
        Self(follow.collect())
    }

    /// Forgets what was sent: the synth has silenced all.
    pub fn reset(&mut self) {
        self.0.iter_mut().for_each(|sound| sound.sent = None);
    }

    /// Sends the air of this moment where it has changed.
    pub fn update(
        &mut self,
        sample: u64,
        air: &Air,
        breath: &AimedBreath,
        bodies: &[RigidBody],
        listener: &AudioListener,
        out: &mut Vec<SoundCommand>,
    ) {
        for AirSound { sound, area, sent } in &mut self.0 {
            let binding = &breath.exhibit.sounds[*sound];
            let (noise, area) = match &binding.follows.air {
                Some(AirAt::Surfaces(surfaces)) => {
                    let noise = surfaces.iter().map(|&surface| air.wind.noise()[surface]);
                    (noise.fold(AirNoise::default(), AirNoise::plus), *area)
                }
                Some(AirAt::Wire(wire)) => wire_noise(*wire, air, breath, bodies),
                None => continue,
            };
            let speed = noise.speed(area);
            let speed = if speed < SILENT { 0.0 } else { speed as f32 };
            let place = listener.locate(noise.place().unwrap_or(bodies[binding.body].position));
            let now = WindSound {
                sample,
                instrument: binding.instrument as u16,
                speed,
                gust: air.report.gust as f32,
                direction: listener.direction(noise.flow),
                pan: place.pan,
                distance: place.distance,
            };
            if changes(sent.as_ref(), &now) {
                *sent = Some(now);
                out.push(SoundCommand::Wind(now));
            }
        }
    }
}

/// Whether air is heard differently from what was sent.
fn changes(sent: Option<&WindSound>, now: &WindSound) -> bool {
    let Some(sent) = sent else { return now.speed > 0.0 };
    if now.speed == 0.0 || sent.speed == 0.0 {
        return now.speed != sent.speed;
    }
    let pairs = [
        (sent.speed, now.speed),
        (sent.gust, now.gust),
        (sent.direction, now.direction),
        (sent.pan, now.pan),
        (sent.distance, now.distance),
    ];
    pairs.iter().any(|(before, after)| (after - before).abs() > LEAST_CHANGE)
}

/// Noise of the air across a wire, with its length in place of an area, m.
fn wire_noise(wire: usize, air: &Air, breath: &AimedBreath, bodies: &[RigidBody]) -> (AirNoise, f64) {
    let wire = &breath.exhibit.wires[wire];
    let jet = breath.jet(&air.jet_front);
    let body = wire.body.map(|body| &bodies[body]);
    let world = |point: DVec3| body.map_or(point, |body| body.pose().point(point));
    let moves = |point: DVec3| {
        body.map_or(DVec3::ZERO, |body| body.velocity + body.angular_velocity.cross(point - body.position))
    };
    let (mut noise, mut length) = (AirNoise::default(), 0.0);
    for ends in wire.points.windows(2) {
        let [a, b] = [world(ends[0]), world(ends[1])];
        let (middle, way) = (0.5 * (a + b), b - a);
        let Some(along) = way.try_normalize() else { continue };
        // The sound is that of the wind on the sculpture: a gain of the force is its square root on the speed.
        let breath_air =
            jet.as_ref().map_or(DVec3::ZERO, |jet| jet.gain.sqrt() * air.wind.breath_velocity(jet, middle));
        let wind = breath_air + air.wind.directed_velocity(None, middle) + air.wind.undirected_velocity(middle);
        let velocity = wind - moves(middle);
        let across = velocity - velocity.dot(along) * along;
        let square = across.length_squared();
        let power = way.length() * square * square * square;
        noise = noise.plus(AirNoise { power, moment: power * middle, flow: power * across });
        length += way.length();
    }
    (noise, length)
}

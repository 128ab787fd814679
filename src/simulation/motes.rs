//! Dust in the air: specks that drift, and are carried and lit where a breath passes, so that wind can be seen.

use super::snapshot::Mote;
use crate::math::{DVec3, exp, tangents};
use crate::noise::{Random, perlin3};
use crate::wind::jet::{Jet, SPREAD};

/// Specks in the room.
const COUNT: usize = 120;
/// Half-width of the cube they float in around the view's target, m.
const ROOM: f64 = 0.5;
/// A speck takes on the air's velocity within this time, s.
const CARRIED: f64 = 0.03;
/// Drift of the room's air that carries dust (not sculptures), m/s.
const DRIFT: f64 = 0.012;
/// Steps between two looks at that drift.
const DRIFT_STEPS: usize = 24;
/// Lives end after this long, s: in the room, and in a breath.
const LIFE: (f64, f64) = (9.0, 1.1);
/// Rest brightness of dust in still air, and the speed (m/s) at which it is fully lit.
const FAINT: f64 = 0.05;
const LIT: f64 = 0.8;
/// Share of the specks that a breath takes with it.
const IN_BREATH: usize = COUNT * 4 / 5;

#[derive(Clone, Copy)]
struct Speck {
    position: DVec3,
    velocity: DVec3,
    /// Of the room's air where it is, m/s.
    drift: DVec3,
    age: f64,
    life: f64,
}

/// The room's dust.
pub struct Motes {
    specks: Vec<Speck>,
    random: Random,
    center: DVec3,
    time: f64,
    step: usize,
}

impl Motes {
    /// Dust around a point of the world.
    pub fn new(center: DVec3, seed: u64) -> Self {
        let mut random = Random::new(seed);
        let specks = (0..COUNT)
            .map(|_| {
                let mut speck = in_room(&mut random, center);
                speck.age = random.unit() * speck.life;
                speck
            })
            .collect();
        Self { specks, random, center, time: 0.0, step: 0 }
    }

    /// Lets the air carry the dust for `dt` seconds; `air` is the breath's velocity at a point.
    pub fn advance(&mut self, jet: Option<&Jet>, air: impl Fn(DVec3) -> DVec3, dt: f64) {
        self.time += dt;
        self.step += 1;
        let share = 1.0 - exp(-dt / CARRIED);
        for (index, speck) in self.specks.iter_mut().enumerate() {
            // The room's air changes slowly: each speck asks it now and then, in turn.
            if (index + self.step).is_multiple_of(DRIFT_STEPS) {
                let at = speck.position / 0.2 + DVec3::splat(0.1 * self.time);
                speck.drift = DVec3::new(perlin3(at, 11), perlin3(at, 12), perlin3(at, 13)) * DRIFT;
            }
            speck.velocity = speck.velocity.lerp(air(speck.position) + speck.drift, share);
            speck.position += dt * speck.velocity;
            speck.age += dt;
            let in_breath = jet.filter(|_| index < IN_BREATH);
            // A breath draws dust in at once; without one, a speck lives its life.
            let dull = in_breath.is_some() && speck.life > LIFE.1 && speck.velocity.length() < 0.05;
            if speck.age > speck.life || dull {
                *speck = match in_breath {
                    Some(jet) => in_jet(&mut self.random, jet),
                    None => in_room(&mut self.random, self.center),
                };
            }
        }
    }

    /// What is seen of the dust.
    pub fn view(&self) -> impl Iterator<Item = Mote> {
        self.specks.iter().map(|speck| {
            let phase = (speck.age / speck.life).clamp(0.0, 1.0);
            let fade = 4.0 * phase * (1.0 - phase);
            let lit = (speck.velocity.length() / LIT).min(1.0);
            Mote {
                position: speck.position.as_vec3().to_array(),
                velocity: speck.velocity.as_vec3().to_array(),
                brightness: ((FAINT + (1.0 - FAINT) * lit) * fade) as f32,
            }
        })
    }
}

fn in_room(random: &mut Random, center: DVec3) -> Speck {
    let offset = DVec3::new(random.signed(), random.signed(), random.signed()) * ROOM;
    let life = LIFE.0 * random.range(0.6, 1.4);
    Speck { position: center + offset, velocity: DVec3::ZERO, drift: DVec3::ZERO, age: 0.0, life }
}

/// Somewhere in the core of the jet, from a hand before the lips to past the sculpture.
fn in_jet(random: &mut Random, jet: &Jet) -> Speck {
    let x = random.range(0.08, 0.75);
    let (t, b) = tangents(jet.direction);
    let across = (t * random.signed() + b * random.signed()) * (SPREAD * x);
    let position = jet.mouth + x * jet.direction + across;
    Speck {
        position,
        velocity: jet.velocity(position),
        drift: DVec3::ZERO,
        age: 0.0,
        life: LIFE.1 * random.range(0.5, 1.0),
    }
}

//! Dust in the air: specks that every wind carries with it, lit where they are fast, so that wind can be seen.
//!
//! A speck follows the air at its place within a few hundredths of a second, and settles in still air's own slow drift.
//! Their number is constant: a speck that has lived its life, or was carried too far, comes back elsewhere in the room,
//! or in the breath where there is one. It fades out before and in after, and so is never seen to jump.

use soffio_math::noise::{Random, perlin3_vector};
use soffio_math::{DVec3, exp, tangents};
use soffio_wind::breath::Breath;

/// Specks in the room.
const COUNT: usize = 120;
/// Half-width of the cube they float in around the view's target, m.
const ROOM: f64 = 0.5;
/// A speck carried farther than this from the view's target comes back, m.
const REACH: f64 = 1.2;
/// A speck takes on the air's velocity within this time, s.
const CARRIED: f64 = 0.03;
/// Drift of the room's air that carries dust (not sculptures), m/s.
const DRIFT: f64 = 0.012;
const DRIFT_SEED: u64 = 11;
/// A speck slower than this shows nothing of a breath, m/s.
const DULL: f64 = 0.05;
/// Steps between two looks at that drift.
const DRIFT_STEPS: usize = 24;
/// Lives end after this long, s: in the room, and in a breath.
const LIFE: (f64, f64) = (9.0, 1.1);
/// Rest brightness of dust in still air, and the speed (m/s) at which it is fully lit.
const FAINT: f64 = 0.05;
const LIT: f64 = 0.8;
/// Share of the specks that a breath takes with it.
const IN_BREATH: usize = COUNT * 4 / 5;

/// A speck of dust that shows the wind.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mote {
    /// World, m.
    pub position: [f32; 3],
    /// World, m/s.
    pub velocity: [f32; 3],
    /// 0 invisible … 1 bright.
    pub brightness: f32,
}

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
#[derive(Clone)]
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

    /// Leaves the air clean.
    pub fn leave(&mut self) {
        self.specks.clear();
    }

    /// Lets the air carry the dust for `dt` seconds. Its velocity at a point is that of the `streams` (breath, fans,
    /// draughts) and of the air that the room `stirs`, which changes slowly. The breath, where there is one, draws specks
    /// into itself.
    pub fn advance(
        &mut self,
        breath: Option<&Breath>,
        streams: impl Fn(DVec3) -> DVec3,
        stirs: impl Fn(DVec3) -> DVec3,
        dt: f64,
    ) {
        self.time += dt;
        self.step += 1;
        if self.specks.is_empty() {
            return;
        }
        let share = 1.0 - exp(-dt / CARRIED);
        for (index, speck) in self.specks.iter_mut().enumerate() {
            // Each speck asks for the room's air now and then, in turn.
            if (index + self.step).is_multiple_of(DRIFT_STEPS) {
                let at = speck.position / 0.2 + DVec3::splat(0.1 * self.time);
                speck.drift = perlin3_vector(at, DRIFT_SEED) * DRIFT + stirs(speck.position);
            }
            speck.velocity = speck.velocity.lerp(streams(speck.position) + speck.drift, share);
            speck.position += dt * speck.velocity;
            speck.age += dt;
            let in_breath = breath.filter(|_| index < IN_BREATH);
            // A breath draws dust in at once; without one, a speck lives its life.
            let dull = in_breath.is_some() && speck.life > LIFE.1 && speck.velocity.length() < DULL;
            let gone = speck.position.distance_squared(self.center) > REACH * REACH;
            if speck.age > speck.life || dull || gone {
                *speck = match in_breath {
                    Some(breath) => in_stream(&mut self.random, breath),
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

/// Somewhere in the core of the breath, from a hand before the lips to past the sculpture.
fn in_stream(random: &mut Random, breath: &Breath) -> Speck {
    let x = random.range(0.08, 0.75);
    let (t, b) = tangents(breath.direction);
    let across = (t * random.signed() + b * random.signed()) * breath.half_width(x);
    let position = breath.mouth + x * breath.direction + across;
    Speck {
        position,
        velocity: breath.velocity(position),
        drift: DVec3::ZERO,
        age: 0.0,
        life: LIFE.1 * random.range(0.5, 1.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_wind::breath::Law;

    const DT: f64 = 1.0 / 240.0;
    const SEED: u64 = 4;

    fn still(_: DVec3) -> DVec3 {
        DVec3::ZERO
    }

    #[test]
    fn every_speck_goes_with_the_air() {
        // A vortex: after some time constants each speck has the velocity of the air where it is, but for its own drift
        // and for what the air changes within the time constant.
        let vortex = |p: DVec3| DVec3::Y.cross(p) * 0.5 + DVec3::Y * 0.1;
        let mut motes = Motes::new(DVec3::ZERO, SEED);
        for _ in 0..60 {
            motes.advance(None, vortex, still, DT);
        }
        let lag = CARRIED * 0.5 * 0.5 * REACH;
        let young = |speck: &&Speck| speck.age > 8.0 * CARRIED;
        let mut seen = 0;
        for speck in motes.specks.iter().filter(young) {
            let off = speck.velocity.distance(vortex(speck.position));
            assert!(off < 2.0 * DRIFT + lag, "seed {SEED}: {off} m/s off the air");
            seen += 1;
        }
        assert!(seen > COUNT / 2, "{seen} specks");
        let before: Vec<(DVec3, f64)> = motes.specks.iter().map(|s| (s.position, s.age)).collect();
        motes.advance(None, vortex, still, DT);
        for (speck, (position, age)) in motes.specks.iter().zip(before) {
            if speck.age > age {
                assert!((speck.position - position - DT * speck.velocity).length() < 1e-12);
            }
        }
    }

    #[test]
    fn what_the_room_stirs_carries_dust_too() {
        let mut motes = Motes::new(DVec3::ZERO, SEED);
        for _ in 0..2 * DRIFT_STEPS {
            motes.advance(None, still, |_| DVec3::X * 0.2, DT);
        }
        let mean = motes.specks.iter().map(|s| s.velocity.x).sum::<f64>() / COUNT as f64;
        assert!((mean - 0.2).abs() < 0.03, "seed {SEED}: {mean} m/s");
    }

    #[test]
    fn none_is_lost_however_the_wind_blows() {
        let mut motes = Motes::new(DVec3::X, SEED);
        let breath = Breath {
            mouth: DVec3::new(1.0, 0.0, 0.5),
            direction: DVec3::NEG_Z,
            lip_diameter: 0.01,
            speed: 17.0,
            law: Law::Jet,
        };
        for step in 0..2400 {
            let blows = Some(&breath).filter(|_| step / 240 % 2 == 0);
            motes.advance(blows, |p| DVec3::X * 0.8 + blows.map_or(DVec3::ZERO, |b| b.velocity(p)), still, DT);
            assert_eq!(motes.specks.len(), COUNT);
            for mote in motes.view() {
                let far = DVec3::from(mote.position.map(f64::from)).distance(DVec3::X);
                assert!(far <= REACH + 1e-6, "seed {SEED}: {far} m off in step {step}");
                assert!((0.0..=1.0).contains(&mote.brightness));
            }
        }
    }

    #[test]
    fn a_breath_is_seen_at_once() {
        let mut motes = Motes::new(DVec3::ZERO, SEED);
        let breath =
            Breath { mouth: DVec3::Z * 0.5, direction: DVec3::NEG_Z, lip_diameter: 0.01, speed: 9.0, law: Law::Jet };
        for _ in 0..24 {
            motes.advance(Some(&breath), |p| breath.velocity(p), still, DT);
        }
        let carried = motes.specks.iter().filter(|s| s.velocity.length() > 0.2).count();
        assert!(carried > COUNT / 4, "seed {SEED}: {carried} specks show the breath after a tenth of a second");
    }
}

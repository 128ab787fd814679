//! The winds that blow by themselves: fans, draughts, gusts, and the room's own air.
//!
//! A wind has a kind (where it blows), a speed that is a function of time, and a rhythm (how it comes and goes). With
//! U its speed now, s the way along its direction from where it begins, r the distance from its axis:
//!
//! ```text
//! fan      the jet of `breath.rs` from a disc of the fan's diameter
//! draught  v = U everywhere, or U exp(−ln 2 (2 r/width)²) downstream of its place
//! room     v = U N(x, t), aimless: N is a sum of three octaves of vector noise with a root mean square of 1,
//!          the k-th 2^k times as fine, 2^(−k/3) as fast and 2^(2k/3) as quick: the −5/3 of turbulence
//! ```
//!
//! Rhythms act on the speed with the time t' = t − s/U_c at which the air left (U_c the wind's greatest speed), so that
//! gusts and puffs travel downstream:
//!
//! ```text
//! even     1
//! gusty    1 + strength · n(t'),  |n| ≤ 1 three octaves of noise, the slowest of the given period
//! puffs    one in every `every` seconds, at a seeded moment, of a seeded 50 … 100 % of the speed: sin²(π (t' − t₀)/lasts)
//! ```
//!
//! All is a function of place, time and seed: nothing is remembered from step to step.

use super::breath::{Breath, Law};
use soffio_math::Function;
use soffio_math::noise::{Perlin1, hash_words, perlin3_vector};
use soffio_math::{DVec3, PI, exp, sin};

/// A wind that blows by itself.
#[derive(Clone, Debug, PartialEq)]
pub struct Wind {
    /// Unique in the exhibit.
    pub name: String,
    /// Where it blows.
    pub kind: WindKind,
    /// U, m/s, by the seconds since the exhibit's reset: at the fan, on the draught's axis, root mean square of a room.
    pub speed: Function,
    /// How it comes and goes.
    pub rhythm: Rhythm,
}

/// Where a wind blows.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WindKind {
    /// From a round disc.
    Fan {
        /// Centre of the disc, world, m.
        at: DVec3,
        /// Unit.
        direction: DVec3,
        /// m.
        diameter: f64,
    },
    /// One way.
    Draught {
        /// Unit.
        direction: DVec3,
        /// Where it comes in (world, m) and how wide it is (m, where it is half as fast); `None`: everywhere.
        place: Option<(DVec3, f64)>,
    },
    /// Aimlessly, everywhere.
    Room {
        /// Size of the largest eddies, m.
        scale: f64,
        /// Time in which they change, s.
        period: f64,
        /// Seed of the eddies.
        seed: u64,
    },
}

/// How a wind comes and goes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Rhythm {
    /// It does not.
    #[default]
    Even,
    /// Stronger and weaker.
    Gusty {
        /// Greatest departure from the speed, as a share of it, 0 … 1.
        strength: f64,
        /// Of the slowest change, s.
        period: f64,
        /// Seed.
        seed: u64,
    },
    /// In separate puffs.
    Puffs {
        /// s: one puff in each such time.
        every: f64,
        /// s, at most `every`.
        lasts: f64,
        /// Seed.
        seed: u64,
    },
}

/// Octaves of a spectrum.
const OCTAVES: usize = 3;
/// 2^(−1/3): speed of an octave over that of the one before it.
const FALL: f64 = 0.793_700_525_984_099_7;
/// 2^(2/3): how much quicker an octave changes.
const QUICKER: f64 = 1.587_401_051_968_199_5;
/// Root mean square of the room's octaves before they are scaled to 1 (a test measures it).
const ROOM_RMS: f64 = 0.666;
/// The way in which eddies pass through a place: oblique to the lattice of the noise. Unit.
const PASSING: DVec3 = DVec3::new(0.602, 0.437, 0.669);
/// Within a ball whose radius is this part of the largest eddies the air is taken for the same.
const ALIKE: f64 = 0.2;
/// Least speed at which gusts travel, m/s: a wind that hardly blows does not carry them at all.
const SLOWEST: f64 = 0.05;

/// A function's greatest key, or mean and amplitude together.
fn greatest(function: &Function) -> f64 {
    match function {
        Function::Constant(value) => value.abs(),
        Function::Keys { keys, .. } => keys.iter().fold(0.0, |most, key| key.1.abs().max(most)),
        Function::Wave { mean, amplitude, .. } => mean.abs() + amplitude.abs(),
    }
}

/// The wind's speed over its function, at the time t' = `left` at which air left; `gusts` are its octaves of noise.
fn beat(rhythm: &Rhythm, gusts: &[Perlin1; OCTAVES], left: f64) -> f64 {
    match *rhythm {
        Rhythm::Even => 1.0,
        Rhythm::Gusty { strength, period, .. } => {
            let (mut sum, mut whole, mut share, mut pace) = (0.0, 0.0, 1.0, 1.0 / period);
            for gust in gusts {
                sum += share * gust.at(left * pace);
                whole += share;
                share *= FALL;
                pace *= 2.0;
            }
            1.0 + strength * sum / whole
        }
        Rhythm::Puffs { every, lasts, seed } => {
            let round = (left / every).floor();
            let unit =
                |word: u64| (hash_words(&[seed, round as i64 as u64, word]) >> 11) as f64 * (1.0 / (1u64 << 53) as f64);
            let since = left - round * every - unit(0) * (every - lasts);
            if (0.0..lasts).contains(&since) {
                let s = sin(PI * since / lasts);
                (0.5 + 0.5 * unit(1)) * s * s
            } else {
                0.0
            }
        }
    }
}

/// The room's air at a point and time over its speed: root mean square 1.
fn eddies(point: DVec3, time: f64, scale: f64, period: f64, seed: u64) -> DVec3 {
    let (mut sum, mut share, mut fine, mut pace) = (DVec3::ZERO, 1.0 / ROOM_RMS, 1.0 / scale, time / period);
    for octave in 0..OCTAVES {
        sum += share * perlin3_vector(fine * point + pace * PASSING, hash_words(&[seed, octave as u64]));
        share *= FALL;
        fine *= 2.0;
        pace *= QUICKER;
    }
    sum
}

/// The jet of a fan.
fn fan(at: DVec3, direction: DVec3, diameter: f64, speed: f64) -> Breath {
    Breath { mouth: at, direction, lip_diameter: diameter, speed, law: Law::Jet }
}

/// From where a wind comes to a point: what stands in that way shelters it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Upwind {
    /// From a place, world, m.
    Place(DVec3),
    /// From afar, unit, against the wind.
    Afar(DVec3),
}

/// All winds of an exhibit, and how fast they are now.
#[derive(Clone, Debug, Default)]
pub struct Weather {
    winds: Vec<Wind>,
    /// U of each, m/s, and U_c.
    speeds: Vec<(f64, f64)>,
    /// Octaves of each one's gusts.
    gusts: Vec<[Perlin1; OCTAVES]>,
    time: f64,
}

impl Weather {
    /// These winds, before anything blows.
    pub fn new(winds: &[Wind]) -> Self {
        let speeds = winds.iter().map(|wind| (0.0, greatest(&wind.speed).max(SLOWEST))).collect();
        let gusts = winds.iter().map(|wind| {
            let seed = if let Rhythm::Gusty { seed, .. } = wind.rhythm { seed } else { 0 };
            std::array::from_fn(|octave| Perlin1::new(hash_words(&[seed, octave as u64])))
        });
        Self { winds: winds.to_vec(), speeds, gusts: gusts.collect(), time: 0.0 }
    }

    /// Looks up what blows at a time, s since the exhibit's reset.
    pub fn turn_to(&mut self, time: f64) {
        self.time = time;
        for (wind, speed) in self.winds.iter().zip(&mut self.speeds) {
            speed.0 = wind.speed.at(time).value.max(0.0);
        }
    }

    /// s since the exhibit's reset.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Number of winds.
    pub fn len(&self) -> usize {
        self.winds.len()
    }

    /// Is the air at rest for ever?
    pub fn is_empty(&self) -> bool {
        self.winds.is_empty()
    }

    /// The aimless winds are nearly the same all over a ball of this radius, m.
    pub fn alike(&self) -> f64 {
        let scale = |wind: &Wind| match wind.kind {
            WindKind::Room { scale, .. } => ALIKE * scale,
            _ => f64::INFINITY,
        };
        self.winds.iter().map(scale).fold(f64::INFINITY, f64::min)
    }

    /// From where a wind comes; `None`: from all sides, so that nothing shelters from it.
    pub fn upwind(&self, index: usize) -> Option<Upwind> {
        match self.winds[index].kind {
            WindKind::Fan { at, .. } => Some(Upwind::Place(at)),
            WindKind::Draught { direction, .. } => Some(Upwind::Afar(-direction)),
            WindKind::Room { .. } => None,
        }
    }

    /// May a wind be felt somewhere in this ball (m)? Where it says no, the air is still.
    pub fn reaches(&self, index: usize, center: DVec3, radius: f64) -> bool {
        self.speeds[index].0 > 0.0
            && match self.winds[index].kind {
                WindKind::Fan { at, direction, diameter } => fan(at, direction, diameter, 0.0).reaches(center, radius),
                WindKind::Draught { direction, place: Some((at, _)) } => (center - at).dot(direction) > -radius,
                WindKind::Draught { place: None, .. } | WindKind::Room { .. } => true,
            }
    }

    /// Velocity at a point of the winds that come from all sides, m/s.
    pub fn stirs(&self, point: DVec3) -> DVec3 {
        (0..self.len()).filter(|&index| self.upwind(index).is_none()).map(|index| self.air(index, point)).sum()
    }

    /// Velocity of a wind at a point, m/s.
    pub fn air(&self, index: usize, point: DVec3) -> DVec3 {
        let (wind, (speed, carried)) = (&self.winds[index], self.speeds[index]);
        if speed <= 0.0 {
            return DVec3::ZERO;
        }
        let beat = |way: f64| beat(&wind.rhythm, &self.gusts[index], self.time - way / carried);
        match wind.kind {
            WindKind::Fan { at, direction, diameter } => {
                let jet = fan(at, direction, diameter, speed);
                let Some((x, share)) = jet.share(point) else { return DVec3::ZERO };
                jet.flow_direction(point) * (speed * share * beat(x))
            }
            WindKind::Draught { direction, place: None } => direction * (speed * beat(point.dot(direction))),
            WindKind::Draught { direction, place: Some((at, width)) } => {
                let from = point - at;
                let along = from.dot(direction);
                if along <= 0.0 {
                    return DVec3::ZERO;
                }
                let off = 4.0 * (from - along * direction).length_squared() / (width * width);
                let share = exp(-std::f64::consts::LN_2 * off);
                direction * (speed * share * beat(along))
            }
            WindKind::Room { scale, period, seed } => speed * beat(0.0) * eddies(point, self.time, scale, period, seed),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_math::noise::Random;

    fn weather(kind: WindKind, speed: f64, rhythm: Rhythm) -> Weather {
        Weather::new(&[Wind { name: "wind".into(), kind, speed: speed.into(), rhythm }])
    }

    const EAST: WindKind = WindKind::Draught { direction: DVec3::X, place: None };

    fn at(weather: &mut Weather, time: f64, point: DVec3) -> DVec3 {
        weather.turn_to(time);
        (0..weather.len()).map(|index| weather.air(index, point)).sum()
    }

    #[test]
    fn the_rooms_air_has_its_speed_and_no_way_of_its_own() {
        // 40,000 independent places and times: the root mean square is good to a per cent.
        const STATISTICS: f64 = 0.03;
        const SEED: u64 = 9;
        let mut random = Random::new(SEED);
        let mut room = weather(WindKind::Room { scale: 0.6, period: 5.0, seed: 2 }, 0.1, Rhythm::Even);
        let (mut square, mut mean, n) = (0.0, DVec3::ZERO, 40_000);
        for _ in 0..n {
            let point = DVec3::new(random.signed(), random.signed(), random.signed()) * 30.0;
            let v = at(&mut room, random.range(0.0, 1e4), point);
            square += v.length_squared() / f64::from(n);
            mean += v / f64::from(n);
        }
        let rms = square.sqrt();
        assert!((rms / 0.1 - 1.0).abs() < STATISTICS, "seed {SEED}: {rms} m/s rms");
        assert!(mean.length() < STATISTICS * 0.1, "seed {SEED}: drifts by {mean}");
    }

    #[test]
    fn the_rooms_air_changes_smoothly() {
        let mut room = weather(WindKind::Room { scale: 0.6, period: 5.0, seed: 2 }, 0.1, Rhythm::Even);
        let here = at(&mut room, 3.0, DVec3::ZERO);
        // The finest eddies are 150 mm wide and change within 2 s: a millimetre and a step are little.
        assert!(here.distance(at(&mut room, 3.0, DVec3::X * 1e-3)) < 2e-3);
        assert!(here.distance(at(&mut room, 3.0 + 1.0 / 240.0, DVec3::ZERO)) < 2e-3);
        assert!(here.distance(at(&mut room, 3.0, DVec3::X * 0.6)) > 1e-3, "half a metre on it is another");
    }

    #[test]
    fn a_gust_stays_within_its_strength_and_travels_with_the_air() {
        let mut gusty = weather(EAST, 2.0, Rhythm::Gusty { strength: 0.4, period: 3.0, seed: 7 });
        let (mut least, mut most): (f64, f64) = (f64::INFINITY, 0.0);
        for i in 0..20_000 {
            let v = at(&mut gusty, 0.05 * f64::from(i), DVec3::ZERO).x;
            (least, most) = (least.min(v), most.max(v));
        }
        assert!(least >= 2.0 * 0.6 && most <= 2.0 * 1.4, "{least} … {most} m/s");
        assert!(most - least > 0.8, "it comes and goes: {least} … {most} m/s");
        // Three metres downstream the same air is one and a half seconds later.
        const ROUNDING: f64 = 1e-9;
        let (here, there) = (at(&mut gusty, 5.0, DVec3::ZERO), at(&mut gusty, 6.5, DVec3::X * 3.0));
        assert!((here - there).length() < ROUNDING, "{here} and {there}");
    }

    #[test]
    fn puffs_come_once_in_their_time_and_last_as_long_as_they_should() {
        const STEP: f64 = 1e-3;
        let mut puffs = weather(EAST, 1.0, Rhythm::Puffs { every: 5.0, lasts: 1.0, seed: 3 });
        for round in 0..20 {
            let speeds: Vec<f64> = (0..5000)
                .map(|i| at(&mut puffs, 5.0 * f64::from(round) + STEP * f64::from(i), DVec3::ZERO).x)
                .collect();
            let blowing = STEP * speeds.iter().filter(|v| **v > 0.0).count() as f64;
            assert!((blowing - 1.0).abs() < 3.0 * STEP, "blows for {blowing} s in round {round}");
            let most = speeds.iter().fold(0.0, |m: f64, v| m.max(*v));
            assert!((0.499..=1.0).contains(&most), "{most} m/s");
        }
    }

    #[test]
    fn a_fan_and_a_draught_blow_where_they_are() {
        const ROUNDING: f64 = 1e-12;
        let kind = WindKind::Fan { at: DVec3::ZERO, direction: DVec3::Z, diameter: 0.2 };
        let mut fan = weather(kind, 3.0, Rhythm::Even);
        // U₀ as far as six diameters, then 6 U₀ d/x; still behind it.
        assert!((at(&mut fan, 0.0, DVec3::Z * 1.0).z - 3.0).abs() < ROUNDING);
        assert!((at(&mut fan, 0.0, DVec3::Z * 2.4).z - 1.5).abs() < ROUNDING);
        assert_eq!(at(&mut fan, 0.0, DVec3::Z * -0.1), DVec3::ZERO);
        let kind = WindKind::Draught { direction: DVec3::X, place: Some((DVec3::Y, 0.5)) };
        let mut door = weather(kind, 1.0, Rhythm::Even);
        assert!((at(&mut door, 0.0, DVec3::new(4.0, 1.0, 0.0)).x - 1.0).abs() < ROUNDING);
        assert!((at(&mut door, 0.0, DVec3::new(4.0, 1.0, 0.25)).x - 0.5).abs() < ROUNDING);
        assert_eq!(at(&mut door, 0.0, DVec3::new(-1.0, 1.0, 0.0)), DVec3::ZERO);
    }

    #[test]
    fn a_speed_may_change_with_time() {
        let speed =
            Function::Keys { keys: vec![(0.0, 0.0), (2.0, 1.0)], interpolation: Default::default(), repeat: false };
        let wind = Wind { name: "dawn".into(), kind: EAST, speed, rhythm: Rhythm::Even };
        let mut weather = Weather::new(&[wind]);
        assert_eq!(at(&mut weather, 0.0, DVec3::ZERO), DVec3::ZERO);
        assert_eq!(at(&mut weather, 3.0, DVec3::ZERO), DVec3::X);
    }

    #[test]
    fn a_wind_blows_only_within_its_reach() {
        const SEED: u64 = 13;
        let mut random = Random::new(SEED);
        let fan = WindKind::Fan { at: DVec3::ZERO, direction: DVec3::Z, diameter: 0.1 };
        let door = WindKind::Draught { direction: DVec3::X, place: Some((DVec3::Y, 0.5)) };
        for (kind, speed) in [(fan, 1.0), (door, 1.0), (EAST, 0.0)] {
            let mut weather = weather(kind, speed, Rhythm::Even);
            weather.turn_to(0.0);
            let mut out = 0;
            for _ in 0..2000 {
                let mut any = |size: f64| DVec3::new(random.signed(), random.signed(), random.signed()) * size;
                let (center, beside) = (any(2.0), any(0.3));
                if !weather.reaches(0, center, beside.length()) {
                    out += 1;
                    let air = [center, center + beside, center - beside].map(|point| weather.air(0, point));
                    assert_eq!(air, [DVec3::ZERO; 3], "seed {SEED}, {kind:?} about {center}");
                }
            }
            assert!(out > 400 && (out < 2000 || speed == 0.0), "{kind:?}: {out} of 2000 are out of reach");
        }
    }
}

//! Ambient winds: fans, draughts and turbulence, steady, gusty or in puffs.
//!
//! A wind has a kind (its velocity field), a speed as a function of time, and a modulation. With U its present speed, s the
//! distance along its direction from its start, r the distance from its axis:
//!
//! ```text
//! fan         the jet of `breath.rs` from a disc of the fan's diameter
//! draught     v = U everywhere, or U exp(−ln 2 (2 r/width)²) downstream of its inlet
//! turbulence  v = U N(x, t), undirected: N is a sum of three octaves of vector noise with a root mean square of 1,
//!             the k-th 2^k times as fine, 2^(−k/3) as fast and 2^(2k/3) as quick: Kolmogorov's −5/3 spectrum
//! ```
//!
//! The modulation multiplies the speed. It is a function of t' = t − s/U_c, the time at which the air left, with U_c the
//! wind's greatest speed, so that gusts and puffs travel downstream (Taylor's frozen turbulence):
//!
//! ```text
//! steady   1
//! gusty    1 + strength · n(t'),  |n| ≤ 1 three octaves of noise, the slowest of the given period
//! puffs    one in every `interval` seconds, at a seeded time t₀, of a seeded 50 … 100 % of the speed:
//!          sin²(π (t' − t₀)/duration)
//! ```
//!
//! All winds are functions of position, time and seed, without state.

use super::breath::{Breath, JetPoint, SpreadLaw};
use soffio_math::Function;
use soffio_math::noise::{Perlin1, hash_words, perlin3_vector};
use soffio_math::{DVec3, PI, exp, sin};

/// One ambient wind.
#[derive(Clone, Debug, PartialEq)]
pub struct Wind {
    /// Name, unique in the exhibit.
    pub name: String,
    /// Its velocity field.
    pub kind: WindKind,
    /// U, m/s, over the seconds since the exhibit's reset: at the fan, on the draught's axis, root mean square of turbulence.
    pub speed: Function,
    /// Change of its speed beside that function.
    pub modulation: Modulation,
}

/// Velocity field of a wind.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WindKind {
    /// A round jet from a disc.
    Fan {
        /// Centre of the disc, world, m.
        at: DVec3,
        /// Direction of the jet, unit.
        direction: DVec3,
        /// Diameter of the disc, m.
        diameter: f64,
    },
    /// Parallel flow.
    Draught {
        /// Direction of the flow, unit.
        direction: DVec3,
        /// Where it enters; `None`: it is everywhere.
        inlet: Option<Inlet>,
    },
    /// Undirected turbulence, everywhere.
    Turbulence {
        /// Size of the largest eddies, m.
        scale: f64,
        /// Time in which they change, s.
        period: f64,
        /// Seed of the eddies.
        seed: u64,
    },
}

/// Where a draught enters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Inlet {
    /// Centre of the inlet, world, m.
    pub center: DVec3,
    /// Width of the draught at the inlet, m: full width at half of the speed on its axis.
    pub width: f64,
}

/// Change of a wind's speed over time, beside its speed function.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Modulation {
    /// None.
    #[default]
    Steady,
    /// Gusts.
    Gusty {
        /// Greatest departure from the speed, as a share of it, 0 … 1.
        strength: f64,
        /// Of the slowest change, s.
        period: f64,
        /// Seed.
        seed: u64,
    },
    /// Separate puffs with still air between.
    Puffs {
        /// Interval that holds one puff, s.
        interval: f64,
        /// Length of a puff, s, at most `interval`.
        duration: f64,
        /// Seed.
        seed: u64,
    },
}

/// Octaves of the spectra of gusts and turbulence: the forces of finer eddies cancel over a plate.
const OCTAVES: usize = 3;
/// 2^(−1/3): amplitude of an octave over that of the one before (Kolmogorov).
const OCTAVE_GAIN: f64 = 0.793_700_525_984_099_7;
/// 2^(2/3): rate of change of an octave over that of the one before (Kolmogorov).
const OCTAVE_RATE: f64 = 1.587_401_051_968_199_5;
/// Root mean square of the octaves of turbulence before they are scaled to 1. Measured; a test checks it.
const OCTAVES_RMS: f64 = 0.666;
/// Unit direction in which the noise of turbulence is traversed over time: oblique to its lattice.
const NOISE_DIRECTION: DVec3 = DVec3::new(0.602, 0.437, 0.669);
/// Radius within which turbulence is sampled once, as a share of its largest eddies: within it the speed hardly varies.
const UNIFORM_SHARE: f64 = 0.2;
/// Least speed at which gusts travel, m/s: slower winds would delay them without bound.
const MIN_CONVECTION_SPEED: f64 = 0.05;

/// Upper bound of a speed function: its greatest key, or its mean and amplitude together.
fn peak_speed(function: &Function) -> f64 {
    match function {
        Function::Constant(value) => value.abs(),
        Function::Keys { keys, .. } => keys.iter().fold(0.0, |most, key| key.1.abs().max(most)),
        Function::Wave { mean, amplitude, .. } => mean.abs() + amplitude.abs(),
        Function::Given { value, .. } => value.abs(),
    }
}

/// Factor of the speed of air that left at time t' = `left` (s); `gusts` are the octaves of noise.
fn modulation_at(modulation: &Modulation, gusts: &[Perlin1; OCTAVES], left: f64) -> f64 {
    match *modulation {
        Modulation::Steady => 1.0,
        Modulation::Gusty { strength, period, .. } => {
            let (mut sum, mut total, mut weight, mut rate) = (0.0, 0.0, 1.0, 1.0 / period);
            for gust in gusts {
                sum += weight * gust.at(left * rate);
                total += weight;
                weight *= OCTAVE_GAIN;
                rate *= 2.0;
            }
            1.0 + strength * sum / total
        }
        Modulation::Puffs { interval, duration, seed } => {
            let number = (left / interval).floor();
            let unit = |word: u64| {
                (hash_words(&[seed, number as i64 as u64, word]) >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
            };
            let since = left - number * interval - unit(0) * (interval - duration);
            if (0.0..duration).contains(&since) {
                let s = sin(PI * since / duration);
                (0.5 + 0.5 * unit(1)) * s * s
            } else {
                0.0
            }
        }
    }
}

/// N(x, t): turbulence of root mean square 1 at a point (world, m) and time (s).
fn turbulence(point: DVec3, time: f64, scale: f64, period: f64, seed: u64) -> DVec3 {
    let (mut sum, mut weight, mut frequency, mut phase) = (DVec3::ZERO, 1.0 / OCTAVES_RMS, 1.0 / scale, time / period);
    for octave in 0..OCTAVES {
        let noise = perlin3_vector(frequency * point + phase * NOISE_DIRECTION, hash_words(&[seed, octave as u64]));
        sum += weight * noise;
        weight *= OCTAVE_GAIN;
        frequency *= 2.0;
        phase *= OCTAVE_RATE;
    }
    sum
}

/// The jet of a fan.
fn fan(at: DVec3, direction: DVec3, diameter: f64, speed: f64) -> Breath {
    Breath { mouth: at, direction, lip_diameter: diameter, speed, law: SpreadLaw::Jet }
}

/// Origin of a directed wind as seen from a point: occluders between the two give shelter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum WindOrigin {
    /// A point of the world, m.
    Point(DVec3),
    /// Infinitely far in this direction: unit, against the wind.
    Direction(DVec3),
}

/// Present speeds of one wind.
#[derive(Clone, Copy, Debug)]
struct WindSpeed {
    /// U, m/s.
    now: f64,
    /// U_c: speed at which its gusts travel, m/s.
    convection: f64,
}

/// All ambient winds of an exhibit at one time.
#[derive(Clone, Debug, Default)]
pub struct AmbientWind {
    winds: Vec<Wind>,
    speeds: Vec<WindSpeed>,
    /// Octaves of each wind's gusts.
    gusts: Vec<[Perlin1; OCTAVES]>,
    time: f64,
}

impl AmbientWind {
    /// These winds, before [`Self::set_time`] still.
    pub fn new(winds: &[Wind]) -> Self {
        let speed = |wind: &Wind| WindSpeed { now: 0.0, convection: peak_speed(&wind.speed).max(MIN_CONVECTION_SPEED) };
        let gusts = winds.iter().map(|wind| {
            let seed = if let Modulation::Gusty { seed, .. } = wind.modulation { seed } else { 0 };
            std::array::from_fn(|octave| Perlin1::new(hash_words(&[seed, octave as u64])))
        });
        Self { winds: winds.to_vec(), speeds: winds.iter().map(speed).collect(), gusts: gusts.collect(), time: 0.0 }
    }

    /// Evaluates all speeds at a time, s since the exhibit's reset.
    pub fn set_time(&mut self, time: f64) {
        self.time = time;
        for (wind, speed) in self.winds.iter().zip(&mut self.speeds) {
            speed.now = wind.speed.at(time).value.max(0.0);
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

    /// Whether there are no winds at all.
    pub fn is_empty(&self) -> bool {
        self.winds.is_empty()
    }

    /// Radius within which the undirected winds may be sampled once, m; infinite without any.
    pub fn uniform_radius(&self) -> f64 {
        let radius = |wind: &Wind| match wind.kind {
            WindKind::Turbulence { scale, .. } => UNIFORM_SHARE * scale,
            _ => f64::INFINITY,
        };
        self.winds.iter().map(radius).fold(f64::INFINITY, f64::min)
    }

    /// Origin of a wind; `None` for undirected ones, from which nothing shelters.
    pub fn wind_origin(&self, index: usize) -> Option<WindOrigin> {
        match self.winds[index].kind {
            WindKind::Fan { at, .. } => Some(WindOrigin::Point(at)),
            WindKind::Draught { direction, .. } => Some(WindOrigin::Direction(-direction)),
            WindKind::Turbulence { .. } => None,
        }
    }

    /// Whether a wind may reach a ball (world, m). Conservative: where it is false, the wind's velocity is 0.
    pub fn intersects_ball(&self, index: usize, center: DVec3, radius: f64) -> bool {
        self.speeds[index].now > 0.0
            && match self.winds[index].kind {
                WindKind::Fan { at, direction, diameter } => {
                    fan(at, direction, diameter, 0.0).intersects_ball(center, radius)
                }
                WindKind::Draught { direction, inlet: Some(inlet) } => (center - inlet.center).dot(direction) > -radius,
                WindKind::Draught { inlet: None, .. } | WindKind::Turbulence { .. } => true,
            }
    }

    /// Sum of the undirected winds at a point (world, m), m/s.
    pub fn undirected_velocity(&self, point: DVec3) -> DVec3 {
        (0..self.len())
            .filter(|&index| self.wind_origin(index).is_none())
            .map(|index| self.velocity(index, point))
            .sum()
    }

    /// Velocity of one wind at a point (world, m), without shelter, m/s.
    pub fn velocity(&self, index: usize, point: DVec3) -> DVec3 {
        let (wind, WindSpeed { now: speed, convection }) = (&self.winds[index], self.speeds[index]);
        if speed <= 0.0 {
            return DVec3::ZERO;
        }
        let modulation =
            |along: f64| modulation_at(&wind.modulation, &self.gusts[index], self.time - along / convection);
        match wind.kind {
            WindKind::Fan { at, direction, diameter } => {
                let jet = fan(at, direction, diameter, speed);
                let Some(JetPoint { distance, speed_ratio }) = jet.relative_speed(point) else { return DVec3::ZERO };
                jet.flow_direction(point) * (speed * speed_ratio * modulation(distance))
            }
            WindKind::Draught { direction, inlet: None } => direction * (speed * modulation(point.dot(direction))),
            WindKind::Draught { direction, inlet: Some(Inlet { center, width }) } => {
                let from = point - center;
                let along = from.dot(direction);
                if along <= 0.0 {
                    return DVec3::ZERO;
                }
                let off = 4.0 * (from - along * direction).length_squared() / (width * width);
                let share = exp(-std::f64::consts::LN_2 * off);
                direction * (speed * share * modulation(along))
            }
            WindKind::Turbulence { scale, period, seed } => {
                speed * modulation(0.0) * turbulence(point, self.time, scale, period, seed)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_math::noise::Random;

    fn ambient(kind: WindKind, speed: f64, modulation: Modulation) -> AmbientWind {
        AmbientWind::new(&[Wind { name: "wind".into(), kind, speed: speed.into(), modulation }])
    }

    /// A wind along x without an inlet.
    const EAST: WindKind = WindKind::Draught { direction: DVec3::X, inlet: None };

    fn at(wind: &mut AmbientWind, time: f64, point: DVec3) -> DVec3 {
        wind.set_time(time);
        (0..wind.len()).map(|index| wind.velocity(index, point)).sum()
    }

    #[test]
    fn turbulence_has_its_speed_and_no_mean() {
        // 40,000 independent places and times: the root mean square is good to a per cent.
        const STATISTICS: f64 = 0.03;
        const SEED: u64 = 9;
        let mut random = Random::new(SEED);
        let mut air = ambient(WindKind::Turbulence { scale: 0.6, period: 5.0, seed: 2 }, 0.1, Modulation::Steady);
        let (mut square, mut mean, n) = (0.0, DVec3::ZERO, 40_000);
        for _ in 0..n {
            let point = DVec3::new(random.signed(), random.signed(), random.signed()) * 30.0;
            let v = at(&mut air, random.range(0.0, 1e4), point);
            square += v.length_squared() / f64::from(n);
            mean += v / f64::from(n);
        }
        let rms = square.sqrt();
        assert!((rms / 0.1 - 1.0).abs() < STATISTICS, "seed {SEED}: {rms} m/s rms");
        assert!(mean.length() < STATISTICS * 0.1, "seed {SEED}: mean {mean}");
    }

    #[test]
    fn turbulence_changes_smoothly() {
        let mut air = ambient(WindKind::Turbulence { scale: 0.6, period: 5.0, seed: 2 }, 0.1, Modulation::Steady);
        let here = at(&mut air, 3.0, DVec3::ZERO);
        // The finest eddies are 150 mm wide and change within 2 s: a millimetre and a step are little.
        assert!(here.distance(at(&mut air, 3.0, DVec3::X * 1e-3)) < 2e-3);
        assert!(here.distance(at(&mut air, 3.0 + 1.0 / 240.0, DVec3::ZERO)) < 2e-3);
        assert!(here.distance(at(&mut air, 3.0, DVec3::X * 0.6)) > 1e-3, "half a metre away it differs");
    }

    #[test]
    fn a_gust_stays_within_its_strength_and_travels_with_the_air() {
        let mut gusty = ambient(EAST, 2.0, Modulation::Gusty { strength: 0.4, period: 3.0, seed: 7 });
        let (mut least, mut most): (f64, f64) = (f64::INFINITY, 0.0);
        for i in 0..20_000 {
            let v = at(&mut gusty, 0.05 * f64::from(i), DVec3::ZERO).x;
            (least, most) = (least.min(v), most.max(v));
        }
        assert!(least >= 2.0 * 0.6 && most <= 2.0 * 1.4, "{least} … {most} m/s");
        assert!(most - least > 0.8, "it varies: {least} … {most} m/s");
        // The same air arrives three metres downstream one and a half seconds later.
        const ROUNDING: f64 = 1e-9;
        let (here, there) = (at(&mut gusty, 5.0, DVec3::ZERO), at(&mut gusty, 6.5, DVec3::X * 3.0));
        assert!((here - there).length() < ROUNDING, "{here} and {there}");
    }

    #[test]
    fn each_interval_has_one_puff_of_the_given_duration() {
        const STEP: f64 = 1e-3;
        let mut puffs = ambient(EAST, 1.0, Modulation::Puffs { interval: 5.0, duration: 1.0, seed: 3 });
        for number in 0..20 {
            let speeds: Vec<f64> = (0..5000)
                .map(|i| at(&mut puffs, 5.0 * f64::from(number) + STEP * f64::from(i), DVec3::ZERO).x)
                .collect();
            let blowing = STEP * speeds.iter().filter(|v| **v > 0.0).count() as f64;
            assert!((blowing - 1.0).abs() < 3.0 * STEP, "blows for {blowing} s in interval {number}");
            let most = speeds.iter().fold(0.0, |m: f64, v| m.max(*v));
            assert!((0.499..=1.0).contains(&most), "{most} m/s");
        }
    }

    #[test]
    fn a_fan_and_a_draught_have_their_velocity_fields() {
        const ROUNDING: f64 = 1e-12;
        let kind = WindKind::Fan { at: DVec3::ZERO, direction: DVec3::Z, diameter: 0.2 };
        let mut fan = ambient(kind, 3.0, Modulation::Steady);
        // U₀ up to six diameters, then 6 U₀ d/x; 0 behind the fan.
        assert!((at(&mut fan, 0.0, DVec3::Z * 1.0).z - 3.0).abs() < ROUNDING);
        assert!((at(&mut fan, 0.0, DVec3::Z * 2.4).z - 1.5).abs() < ROUNDING);
        assert_eq!(at(&mut fan, 0.0, DVec3::Z * -0.1), DVec3::ZERO);
        let kind = WindKind::Draught { direction: DVec3::X, inlet: Some(Inlet { center: DVec3::Y, width: 0.5 }) };
        let mut door = ambient(kind, 1.0, Modulation::Steady);
        assert!((at(&mut door, 0.0, DVec3::new(4.0, 1.0, 0.0)).x - 1.0).abs() < ROUNDING);
        assert!((at(&mut door, 0.0, DVec3::new(4.0, 1.0, 0.25)).x - 0.5).abs() < ROUNDING);
        assert_eq!(at(&mut door, 0.0, DVec3::new(-1.0, 1.0, 0.0)), DVec3::ZERO);
    }

    #[test]
    fn a_speed_changes_with_time() {
        let speed =
            Function::Keys { keys: vec![(0.0, 0.0), (2.0, 1.0)], interpolation: Default::default(), repeat: false };
        let rising = Wind { name: "dawn".into(), kind: EAST, speed, modulation: Modulation::Steady };
        let mut wind = AmbientWind::new(&[rising]);
        assert_eq!(at(&mut wind, 0.0, DVec3::ZERO), DVec3::ZERO);
        assert_eq!(at(&mut wind, 3.0, DVec3::ZERO), DVec3::X);
    }

    #[test]
    fn a_wind_is_still_outside_the_balls_that_it_intersects() {
        const SEED: u64 = 13;
        let mut random = Random::new(SEED);
        let fan = WindKind::Fan { at: DVec3::ZERO, direction: DVec3::Z, diameter: 0.1 };
        let door = WindKind::Draught { direction: DVec3::X, inlet: Some(Inlet { center: DVec3::Y, width: 0.5 }) };
        for (kind, speed) in [(fan, 1.0), (door, 1.0), (EAST, 0.0)] {
            let mut wind = ambient(kind, speed, Modulation::Steady);
            wind.set_time(0.0);
            let mut out = 0;
            for _ in 0..2000 {
                let mut any = |size: f64| DVec3::new(random.signed(), random.signed(), random.signed()) * size;
                let (center, beside) = (any(2.0), any(0.3));
                if !wind.intersects_ball(0, center, beside.length()) {
                    out += 1;
                    let air = [center, center + beside, center - beside].map(|point| wind.velocity(0, point));
                    assert_eq!(air, [DVec3::ZERO; 3], "seed {SEED}, {kind:?} about {center}");
                }
            }
            assert!(out > 400 && (out < 2000 || speed == 0.0), "{kind:?}: {out} of 2000 balls are outside");
        }
    }
}

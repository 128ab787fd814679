//! Wind noise of a capsule: a shot noise of eddies that the air carries past it.
//!
//! Eddies of all sizes are born at random places across the flow and drift with the local speed. An eddy of size l that
//! passes a capsule at the distance b leaves one smooth pulse in the speed that the capsule feels:
//!
//! ```text
//! u(t) = Σ_i a_i G(b_i / R_i) φ((t − t_i) U / T_i)       φ(x) = (1 − x²)⁴ and G(q) = (1 − q²)² for |x|, q < 1
//! T_i  = 2.83 l,   R_i = 2.4 l                           both resemble Gaussians of the standard deviation l
//! a_i² ~ u'² κ⁵ / (1 + κ²)^(17/6),   κ = L / l            power of an octave of sizes, von Kármán's spectrum
//! a_i² → a_i² / (1 + (d / l)²)ⁿ                           the port of the size d averages over smaller eddies
//! p(t) = ½ ρ (U + u) |U + u|                              stagnation pressure, whose fluctuation is ρ U u to first order
//! ```
//!
//! | symbol | meaning | unit |
//! |---|---|---|
//! | u' | fluctuation of the speed, RMS | m/s |
//! | L | von Kármán's length, 1.34 times the integral scale | m |
//! | d, n | size of the port with its screen, and steepness of its average | m, 1 |
//!
//! So the spectrum is flat below U / (2π L). Above it falls as f^(−5/3), and by f^(−2n) more above U / (2π d). One eddy passes both of
//! two capsules if it is wide enough, each at its own time: their coherence follows from geometry.
//!
//! A place with a low speed sees as many eddies as its neighbour with the highest speed, for longer; its a is less by √(U / U_max).
//!
//! References: Strasberg, JASA 66 (1979) and 83 (1988); Morgan and Raspet, JASA 92 (1992); Raspet, Webster and Dillion, JASA 119
//! (2006) and 123 (2008); van den Berg, JASA 119 (2006). Von Kármán, PNAS 34 (1948), for the spectrum. Rice, Bell Syst. Tech. J. 23
//! (1944), for shot noise (Campbell's theorem gives its power).

use soffio_math::noise::Random;
use soffio_math::{DVec3, exp, ln, pow};

use crate::jet::STEPS_A_SECOND;

/// ρ, density of air at 20 °C, kg/m³.
pub const DENSITY: f64 = 1.2;
/// Half the length of a pulse over l.
const PULSE: f64 = 2.83;
/// Radius within which an eddy is felt, over l.
const REACH: f64 = 2.4;
/// Pulses of an octave of sizes that begin within the time l / U: enough for a kurtosis below 4 in one octave.
const CROWDING: f64 = 2.0;
/// ∫ φ² over l: 2.83 · 0.599.
const PULSE_POWER: f64 = 1.694;
/// Mean of G² over the circle of the radius R.
const REACH_POWER: f64 = 0.2;
/// Largest eddies over L.
const LARGEST: f64 = 3.0;
/// Octaves of sizes whose power is counted, from the largest ones on.
const OCTAVES: usize = 24;
/// Power of an octave over the whole below which it is left out: −85 dB.
const NEGLIGIBLE: f64 = 3e-9;
/// Sizes within an octave.
const SIZES: usize = 8;
/// Spread of the speeds with which eddies drift: the large ones carry the small ones.
const DRIFT: f64 = 0.2;
/// Speed below which nothing is felt, m/s.
const STILL_M_S: f64 = 0.03;

/// Average of a capsule's port and screen over small eddies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Port {
    /// d, m.
    pub size: f64,
    /// n: 1 for a mean over an area, 2 where eddies are also deflected around a body (Hunt, J. Fluid Mech. 61, 1973).
    pub steepness: f64,
}

/// Air at one capsule, one value a millisecond.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LocalAir {
    /// U, mean speed, m/s.
    pub speed: Vec<f64>,
    /// u', RMS of the fluctuation, m/s.
    pub fluctuation: Vec<f64>,
}

/// Eddies of one flow that passes one or two capsules.
#[derive(Clone, Debug)]
pub struct Eddies<'a> {
    /// L, m.
    pub length: f64,
    /// Share of the power, beside von Kármán's, of the largest octave, 1.5 to 3 L: structures as wide as a whole jet.
    pub large: f64,
    /// Port of the capsules.
    pub port: Port,
    /// Places of the capsules: x along the flow, y and z across, m.
    pub places: &'a [DVec3],
    /// Air at each capsule.
    pub air: &'a [LocalAir],
}

/// Eddies of one octave of sizes.
struct Octave {
    /// l of each size, m.
    sizes: [f64; SIZES],
    /// a over u' of each size.
    strengths: [f64; SIZES],
    /// Geometric mean of the sizes, m.
    middle: f64,
}

impl Eddies<'_> {
    /// Octaves that matter at a speed (m/s) and a sample rate (Hz).
    fn octaves(&self, fastest: f64, rate: f64) -> Vec<Octave> {
        let power = |size: f64| {
            let wave = self.length / size;
            let square = wave * wave;
            square * square * wave / pow(1.0 + square, 17.0 / 6.0)
        };
        let felt = |size: f64| {
            let ratio = self.port.size / size;
            exp(-self.port.steepness * ln(1.0 + ratio * ratio))
        };
        let ratios: [f64; SIZES] = std::array::from_fn(|i| pow(2.0, (i as f64 + 0.5) / SIZES as f64 - 0.5));
        let middles: Vec<f64> = (0..OCTAVES).map(|i| LARGEST * self.length * pow(2.0, -0.5 - i as f64)).collect();
        let whole: f64 = middles.iter().map(|size| power(*size)).sum();
        let pulse = REACH_POWER * PULSE_POWER * CROWDING;
        let share = |size: f64| {
            let large = if size > 0.5 * LARGEST * self.length { self.large } else { 0.0 };
            large + (1.0 - self.large) * power(size) / whole
        };
        let octave = |middle: f64| {
            let sizes = ratios.map(|ratio| ratio * middle);
            let strengths = sizes.map(|size| (share(size) * felt(size) / pulse * middle / size).sqrt());
            Octave { sizes, strengths, middle }
        };
        let matters = |middle: &f64| {
            share(*middle) * felt(*middle) > NEGLIGIBLE && PULSE * middle / fastest.max(STILL_M_S) * rate > 1.0
        };
        middles.into_iter().filter(matters).map(octave).collect()
    }

    /// u(t) at each capsule, m/s, at a sample rate (Hz).
    pub fn velocities(&self, rate: f64, random: &mut Random) -> Vec<Vec<f64>> {
        let steps = self.air.iter().map(|air| air.speed.len()).max().unwrap_or(0);
        let samples = (steps as f64 / STEPS_A_SECOND * rate).round() as usize;
        let mut out = vec![vec![0.0; samples]; self.air.len()];
        let fast: Vec<f64> =
            (0..steps).map(|step| self.air.iter().map(|air| air.speed[step]).fold(0.0, f64::max)).collect();
        let fastest = fast.iter().copied().fold(0.0, f64::max);
        for octave in self.octaves(fastest, rate) {
            for home in 0..self.air.len() {
                let mut due = random.unit();
                for (step, speed) in fast.iter().enumerate().filter(|(_, speed)| **speed > STILL_M_S) {
                    due -= CROWDING * speed / (STEPS_A_SECOND * octave.middle);
                    while due < 0.0 {
                        due += 2.0 * random.unit();
                        let at = step as f64 + random.unit();
                        self.pass(&octave, home, (at, *speed), rate, &mut out, random);
                    }
                }
            }
        }
        out
    }

    /// Adds the pulses of one eddy near the capsule `home`, at a time (ms) with the highest speed then (m/s).
    fn pass(
        &self,
        octave: &Octave,
        home: usize,
        (at, fast): (f64, f64),
        rate: f64,
        out: &mut [Vec<f64>],
        random: &mut Random,
    ) {
        let word = random.word();
        let (size, strength) = (octave.sizes[word as usize % SIZES], octave.strengths[word as usize % SIZES]);
        // Uniform, of unit variance.
        let strength = strength * random.signed() * 3.0_f64.sqrt();
        let drift = 1.0 + DRIFT * ((word >> 32) as f64 / f64::from(1_u32 << 31) - 1.0);
        let (mut beside, mut above) = (random.signed(), random.signed());
        while beside * beside + above * above >= 1.0 {
            (beside, above) = (random.signed(), random.signed());
        }
        let reach = REACH * size;
        let place = self.places[home];
        let (y, z) = (place.y + reach * beside, place.z + reach * above);
        let apart = |capsule: usize| {
            let (dy, dz) = (self.places[capsule].y - y, self.places[capsule].z - z);
            (dy * dy + dz * dz) / (reach * reach)
        };
        // An eddy near an earlier capsule is one of that capsule's.
        if (0..home).any(|capsule| apart(capsule) < 1.0) {
            return;
        }
        for (capsule, out) in out.iter_mut().enumerate() {
            let far = apart(capsule);
            if far >= 1.0 {
                continue;
            }
            let at = at + STEPS_A_SECOND * (self.places[capsule].x - place.x) / fast;
            let step = at.max(0.0) as usize;
            let air = &self.air[capsule];
            let (Some(&speed), Some(&fluctuation)) = (air.speed.get(step), air.fluctuation.get(step)) else { continue };
            if speed < STILL_M_S || fluctuation <= 0.0 {
                continue;
            }
            let gain = strength * fluctuation * (1.0 - far) * (1.0 - far) * (speed / fast).sqrt();
            add_pulse(out, at / STEPS_A_SECOND * rate, PULSE * size / (speed * drift) * rate, gain);
        }
    }
}

/// Adds a (1 − x²)⁴ with x = (i − middle) / half to the samples.
fn add_pulse(out: &mut [f64], middle: f64, half: f64, gain: f64) {
    let from = ((middle - half).ceil().max(0.0) as usize).min(out.len());
    let until = ((middle + half).ceil().max(0.0) as usize).clamp(from, out.len());
    let scale = 1.0 / half;
    let mut x = (from as f64 - middle) * scale;
    for y in &mut out[from..until] {
        let rest = (1.0 - x * x).max(0.0);
        let square = rest * rest;
        *y += gain * square * square;
        x += scale;
    }
}

/// p(t) of a mean speed (m/s, one value a millisecond) and its fluctuation (m/s, at a sample rate in Hz), Pa.
pub fn pressure(speed: &[f64], fluctuation: &[f64], rate: f64) -> Vec<f64> {
    let per_sample = STEPS_A_SECOND / rate;
    let at = |i: usize| {
        let step = i as f64 * per_sample;
        let (k, part) = (step as usize, step.fract());
        let now = speed.get(k).copied().unwrap_or(0.0);
        now + part * (speed.get(k + 1).copied().unwrap_or(now) - now)
    };
    fluctuation
        .iter()
        .enumerate()
        .map(|(i, u)| {
            let felt = at(i) + u;
            0.5 * DENSITY * felt * felt.abs()
        })
        .collect()
}

//! A microphone: from pressure in pascals to samples of full scale ±1.
//!
//! ```text
//! pressure → overload of the capsule → high-pass → gain, noise → [gain control] → [noise suppression] → offset → full scale
//! ```
//!
//! The high-pass is a Butterworth filter of order 1 to 4 by the bilinear transform. Capsules clip at 115 to 130 dB of sound (MEMS data
//! sheets call it the acoustic overload point). Telephones and headsets have corners of 80 to 200 Hz, bare capsules 20 Hz.

use soffio_fourier::{Complex, real_forward, real_inverse};
use soffio_math::noise::{Random, hash_words};
use soffio_math::{PI, cos, db_to_amplitude, exp, sin, tanh};

use crate::filters::white;

/// Pressure of 0 dB of sound, Pa.
const HEARING_PA: f64 = 2e-5;
/// Largest differences of two capsules of a kind: sensitivity, dB; high-pass corner, relative.
pub const UNLIKE: (f64, f64) = (1.5, 0.1);
/// Largest gain of a gain control over the microphone's own, and the RMS that it aims at.
const AGC: (f64, f64) = (8.0, 0.18);
/// Time constants of a gain control, down and up, s.
const AGC_S: (f64, f64) = (0.015, 0.5);
/// Frame of the noise suppression, s, and its least gain.
const SUPPRESSION: (f64, f64) = (0.032, 0.15);
/// Share of each frame in the noise suppression's smooth power: a time constant of 0.1 s.
const SMOOTHING: f64 = 0.15;
/// Rise of the noise suppression's floor, a frame: 3 dB a second.
const FLOOR_RISE: f64 = 1.011;

/// RMS of a level, Pa, dB of sound.
pub fn pascals(level_db: f64) -> f64 {
    HEARING_PA * db_to_amplitude(level_db)
}

/// A microphone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Microphone {
    /// Corner of the high-pass, Hz.
    pub high_pass_hz: f64,
    /// Order of the high-pass, 0 to 4.
    pub order: usize,
    /// Peak pressure of full scale, Pa.
    pub full_scale_pa: f64,
    /// Peak pressure at which the capsule itself clips, before its high-pass, Pa.
    pub overload_pa: f64,
    /// Clips softly instead of hard.
    pub soft: bool,
    /// Self-noise, dB of sound.
    pub noise_db: f64,
    /// Constant offset of the samples.
    pub offset: f64,
    /// Automatic gain control.
    pub gain_control: bool,
    /// Noise suppression, as in headsets and meeting software.
    pub suppression: bool,
}

impl Default for Microphone {
    /// A gooseneck microphone whose gain drives a hard breath at 10 cm to full scale, 112 dB of sound.
    fn default() -> Self {
        Self {
            high_pass_hz: 40.0,
            order: 2,
            full_scale_pa: 11.0,
            overload_pa: 80.0,
            soft: false,
            noise_db: 30.0,
            offset: 0.0,
            gain_control: false,
            suppression: false,
        }
    }
}

impl Microphone {
    /// A random microphone without gain control or noise suppression.
    pub fn random(random: &mut Random) -> Self {
        let corners = [20.0, 30.0, 45.0, 60.0, 80.0, 110.0, 150.0, 200.0];
        Self {
            high_pass_hz: corners[(random.unit() * 8.0) as usize],
            order: 1 + (random.unit() * 3.0) as usize,
            full_scale_pa: std::f64::consts::SQRT_2 * pascals(random.range(98.0, 118.0)),
            overload_pa: std::f64::consts::SQRT_2 * pascals(random.range(118.0, 132.0)),
            soft: random.unit() < 0.3,
            noise_db: random.range(22.0, 38.0),
            offset: if random.unit() < 0.3 { random.range(-0.02, 0.02) } else { 0.0 },
            gain_control: false,
            suppression: false,
        }
    }

    /// The same microphone with another gain, dB.
    pub fn with_gain(self, db: f64) -> Self {
        Self { full_scale_pa: self.full_scale_pa / db_to_amplitude(db), ..self }
    }

    /// The same kind of microphone with a second capsule's deviations.
    pub fn second(self, seed: u64) -> Self {
        let mut random = Random::new(hash_words(&[seed, 0x7477_696e]));
        let louder = db_to_amplitude(random.range(-UNLIKE.0, UNLIKE.0));
        let higher = 1.0 + random.range(-UNLIKE.1, UNLIKE.1);
        let full_scale_pa = self.full_scale_pa / louder;
        Self { full_scale_pa, high_pass_hz: higher * self.high_pass_hz, ..self }
    }

    /// What its high-pass leaves of a pressure, Pa; no noise, no clipping.
    pub fn high_passed(&self, pressure: &[f64], rate: f64) -> Vec<f64> {
        let mut out = pressure.to_vec();
        for section in sections(self.order, self.high_pass_hz, rate) {
            section.filter(&mut out);
        }
        out
    }

    /// Samples of a pressure (Pa) at a sample rate (Hz).
    pub fn record(&self, pressure: &[f64], rate: f64, seed: u64) -> Vec<f32> {
        let felt: Vec<f64> = pressure.iter().map(|p| p.clamp(-self.overload_pa, self.overload_pa)).collect();
        let hiss = white(felt.len(), &mut Random::new(hash_words(&[seed, 0x6869_7373])));
        let (gain, noise) = (1.0 / self.full_scale_pa, pascals(self.noise_db));
        let mut out = self.high_passed(&felt, rate);
        out.iter_mut().zip(&hiss).for_each(|(y, n)| *y = gain * (*y + noise * n));
        if self.gain_control {
            control(&mut out, rate);
        }
        if self.suppression {
            out = suppressed(&out, rate);
        }
        let rail = |x: f64| if self.soft { tanh(x) } else { x.clamp(-1.0, 1.0) };
        out.iter().map(|x| rail(x + self.offset) as f32).collect()
    }
}

/// A filter section y = b₀ x + b₁ x' + b₂ x'' − a₁ y' − a₂ y''.
struct Section {
    b: [f64; 3],
    a: [f64; 2],
}

impl Section {
    /// Runs over the samples (transposed direct form II).
    fn filter(&self, samples: &mut [f64]) {
        let (mut s1, mut s2) = (0.0, 0.0);
        for x in samples {
            let y = self.b[0] * *x + s1;
            s1 = self.b[1] * *x - self.a[0] * y + s2;
            s2 = self.b[2] * *x - self.a[1] * y;
            *x = y;
        }
    }
}

/// Sections of a Butterworth high-pass.
fn sections(order: usize, corner_hz: f64, rate: f64) -> Vec<Section> {
    let angle = PI * corner_hz / rate;
    let warped = sin(angle) / cos(angle);
    let pair = |k: usize| {
        // Poles in pairs at the angles (2k + 1) π / (2 order) from the imaginary axis.
        let damping = 2.0 * sin(PI * (2 * k + 1) as f64 / (2 * order) as f64);
        let scale = 1.0 / (1.0 + damping * warped + warped * warped);
        let a = [2.0 * (warped * warped - 1.0) * scale, (1.0 - damping * warped + warped * warped) * scale];
        Section { b: [scale, -2.0 * scale, scale], a }
    };
    let mut out: Vec<Section> = (0..order / 2).map(pair).collect();
    if order % 2 == 1 {
        let scale = 1.0 / (1.0 + warped);
        out.push(Section { b: [scale, -scale, 0.0], a: [(warped - 1.0) * scale, 0.0] });
    }
    out
}

/// The gain follows an average power, fast down and slow up.
fn control(samples: &mut [f64], rate: f64) {
    let (down, up) = (exp(-1.0 / (AGC_S.0 * rate)), exp(-1.0 / (AGC_S.1 * rate)));
    let mut followed = 1e-4;
    for x in samples {
        let square = *x * *x;
        let keep = if square > followed { down } else { up };
        followed = keep * followed + (1.0 - keep) * square;
        *x *= (AGC.1 / (followed + 1e-9_f64).sqrt()).min(AGC.0);
    }
}

/// Wiener's filter against the least power of the past in each bin (Boll, IEEE Trans. ASSP 27, 1979), with overlap-add.
fn suppressed(samples: &[f64], rate: f64) -> Vec<f64> {
    let hop = (0.5 * SUPPRESSION.0 * rate) as usize;
    let frame = 2 * hop;
    let (forward, back) = (real_forward(frame), real_inverse(frame));
    let window: Vec<f64> = (0..frame).map(|i| sin(PI * (i as f64 + 0.5) / frame as f64)).collect();
    let (mut smooth, mut floor) = (vec![0.0; hop + 1], vec![f64::INFINITY; hop + 1]);
    let mut out = vec![0.0; samples.len()];
    let mut bins = vec![Complex::ZERO; hop + 1];
    for start in (0..samples.len().saturating_sub(frame)).step_by(hop) {
        let mut part: Vec<f64> = samples[start..start + frame].iter().zip(&window).map(|(x, w)| x * w).collect();
        // Lengths agree by construction.
        if forward.process(&mut part, &mut bins).is_err() {
            return out;
        }
        for (bin, (smooth, floor)) in bins.iter_mut().zip(smooth.iter_mut().zip(&mut floor)) {
            let power = bin.norm_sqr();
            *smooth = if start == 0 { power } else { *smooth + SMOOTHING * (power - *smooth) };
            *floor = smooth.max(1e-18).min(*floor * FLOOR_RISE);
            // The least of the smooth power of noise lies about 4 dB below its mean.
            *bin *= (1.0 - 2.5 * *floor / smooth.max(1e-18)).max(SUPPRESSION.1) / frame as f64;
        }
        (bins[0].im, bins[hop].im) = (0.0, 0.0);
        if back.process(&mut bins, &mut part).is_err() {
            return out;
        }
        out[start..].iter_mut().zip(part.iter().zip(&window)).for_each(|(y, (x, w))| *y += x * w);
    }
    out
}

/// Another sample rate (Hz) by a windowed sinc, whose corner is the lower one of both rates.
pub fn resampled(samples: &[f32], from: u32, to: u32) -> Vec<f32> {
    /// Zero crossings of the sinc on each side.
    const SIDE: usize = 12;
    /// Fractions of a sample with a filter of their own.
    const PHASES: usize = 64;
    if from == to {
        return samples.to_vec();
    }
    let ratio = f64::from(from) / f64::from(to);
    let wide = ratio.max(1.0);
    let half = (SIDE as f64 * wide).ceil() as usize;
    let filter = |phase: usize| -> Vec<f64> {
        let taps = (0..2 * half).map(|i| {
            let x = (i as f64 - (half as f64 - 1.0) - phase as f64 / PHASES as f64) / wide;
            let window = 0.5 + 0.5 * cos(PI * (x / SIDE as f64).clamp(-1.0, 1.0));
            let angle = 0.94 * PI * x;
            window * if angle.abs() < 1e-9 { 0.94 } else { 0.94 * sin(angle) / angle } / wide
        });
        taps.collect()
    };
    let filters: Vec<Vec<f64>> = (0..=PHASES).map(filter).collect();
    let count = (samples.len() as f64 / ratio) as usize;
    let at = |i: usize| {
        let t = i as f64 * ratio;
        let (k, phase) = (t as usize, (t.fract() * PHASES as f64).round() as usize);
        let first = k as isize - (half as isize - 1);
        let sum = filters[phase].iter().enumerate().map(|(j, tap)| {
            let index = first + j as isize;
            usize::try_from(index).ok().and_then(|i| samples.get(i)).map_or(0.0, |x| f64::from(*x) * tap)
        });
        sum.sum::<f64>() as f32
    };
    (0..count).map(at).collect()
}

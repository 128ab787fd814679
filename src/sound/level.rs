//! A-weighted level, and its mean over a day (LAeq).
//!
//! The weighting is that of IEC 61672-1: zeros at 0, poles at 20.6 (two), 107.7, 737.9 and 12,194 Hz (two), 0 dB at 1 kHz. Here
//! each pole is a first-order section by the bilinear transform; the result is within the standard's class 1 for 44.1 and
//! 48 kHz (at 16 kHz it is low by 6 dB, where −16 dB are allowed).
//!
//! ```text
//! L = 10 log₁₀ (mean of (l² + r²)/2 over ½)     0 dB: a sine of 1 kHz at full scale on both sides
//! LAeq = S + L                                  S: what a sound meter shows for that sine at the visitor's ear
//! ```
//!
//! It is an estimate: the speaker's own colour and the room are in S alone.

use soffio_math::{PI, amplitude_to_db, sincos, sqrt};

/// Poles of the A-weighting's high-passes, Hz (IEC 61672-1, annex E).
const HIGH_PASSES: [f64; 4] = [20.598_997, 20.598_997, 107.652_65, 737.862_23];
/// Poles of the A-weighting's low-passes, Hz (IEC 61672-1, annex E).
const LOW_PASSES: [f64; 2] = [12_194.217; 2];
/// Number of first-order sections in all.
const SECTION_COUNT: usize = HIGH_PASSES.len() + LOW_PASSES.len();

/// One section: y = b (x ± x₁) − a y₁.
#[derive(Clone, Copy, Debug)]
struct FirstOrderSection {
    b: f64,
    sign: f64,
    a: f64,
}

impl FirstOrderSection {
    fn magnitude(&self, frequency: f64, sample_rate: f64) -> f64 {
        let (s, c) = sincos(2.0 * PI * frequency / sample_rate);
        let square = |x: f64| (1.0 + x * c) * (1.0 + x * c) + x * x * s * s;
        self.b.abs() * sqrt(square(self.sign) / square(self.a))
    }
}

/// The A-weighting of a stereo signal.
#[derive(Clone, Debug)]
pub struct AWeighting {
    sections: [FirstOrderSection; SECTION_COUNT],
    states: [[f64; SECTION_COUNT]; 2],
    gain: f64,
}

impl AWeighting {
    /// At this rate, Hz.
    pub fn new(sample_rate: f64) -> Self {
        let section = |i: usize| {
            let high = i < HIGH_PASSES.len();
            let pole = if high { HIGH_PASSES[i] } else { LOW_PASSES[i - HIGH_PASSES.len()] };
            let w = PI * pole / sample_rate;
            let norm = 1.0 / (1.0 + w);
            let (b, sign) = if high { (norm, -1.0) } else { (w * norm, 1.0) };
            FirstOrderSection { b, sign, a: (w - 1.0) * norm }
        };
        let sections = std::array::from_fn(section);
        let mut weighting = Self { sections, states: [[0.0; SECTION_COUNT]; 2], gain: 1.0 };
        weighting.gain = 1.0 / weighting.magnitude(1000.0, sample_rate);
        weighting
    }

    /// Amplitude ratio at a frequency, Hz.
    pub fn magnitude(&self, frequency: f64, sample_rate: f64) -> f64 {
        self.gain * self.sections.iter().map(|section| section.magnitude(frequency, sample_rate)).product::<f64>()
    }

    /// Power of a frame, (l² + r²)/2, weighted: ½ on the mean for a sine of 1 kHz at full scale on both sides. Real-time.
    pub fn power(&mut self, frame: [f32; 2]) -> f64 {
        let mut power = 0.0;
        for (x, states) in frame.into_iter().zip(&mut self.states) {
            let mut x = f64::from(x) * self.gain;
            for (section, state) in self.sections.iter().zip(states) {
                let y = section.b * x + *state;
                *state = section.b * section.sign * x - section.a * y;
                if state.abs() < 1e-20 {
                    *state = 0.0;
                }
                x = y;
            }
            power += 0.5 * x * x;
        }
        power
    }
}

/// Level of a mean power of [`AWeighting::power`], dB of a full-scale sine.
pub fn weighted_level(power: f64) -> f64 {
    0.5 * amplitude_to_db(power / 0.5)
}

/// What a visitor and a guard are exposed to: the mean of the last minute and of the day.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Exposure {
    minute: f64,
    energy: f64,
    seconds: f64,
    day: u64,
}

/// Time constant of the short mean, s: the minute in which staff judge a level.
const MINUTE: f64 = 60.0;

impl Exposure {
    /// Adds a mean power over some seconds of a day; a new day restarts the mean.
    pub fn note(&mut self, power: f64, seconds: f64, day: u64) {
        if !(power.is_finite() && power >= 0.0 && seconds > 0.0) {
            return;
        }
        if day != self.day {
            *self = Self { minute: self.minute, day, ..Self::default() };
        }
        self.minute += (power - self.minute) * (1.0 - soffio_math::exp(-seconds / MINUTE));
        self.energy += power * seconds;
        self.seconds += seconds;
    }

    /// Of the last minute or so, dB of a full-scale sine; −∞ for silence.
    pub fn minute(&self) -> f64 {
        weighted_level(self.minute)
    }

    /// Of the day so far, dB of a full-scale sine; −∞ for silence.
    pub fn day(&self) -> f64 {
        weighted_level(self.energy / self.seconds.max(1e-9))
    }
}

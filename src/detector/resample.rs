//! Streaming sample-rate conversion to 8 kHz by a windowed-sinc kernel.
//!
//! All later stages work on 8 kHz samples, so the microphone's rate (8–192 kHz) cannot change a decision. Breath is strongest below
//! 200 Hz, and the harmonics of voices lie below 3 kHz.
//!
//! Symbols: R input rate, F = 8000 Hz output rate, H half length of the kernel in input samples.
//! The kernel is a low pass at f_c = 3500 Hz under a Hann window (J. O. Smith, "Digital Audio Resampling"):
//!
//! ```text
//! h(t) = (2 f_c / R) · sinc(2 f_c t / R) · cos²(π t / (2 H)),   |t| < H
//! y(k) = Σ_j x(n − j) · h(j − φ − H),   φ ∈ [0, 1): distance of the output instant before sample n
//! ```
//!
//! φ is kept as an integer numerator over F, so the output instants never drift.
//! Invariant: outputs depend on the samples alone, never on how they were cut into blocks.

use soffio_math::{PI, cos, sin};
use zeroize::Zeroize;

/// The internal rate, Hz.
pub const INTERNAL_RATE: u32 = 8000;
/// Cut-off of the kernel, Hz: the features end at 3.4 kHz.
const CUTOFF_HZ: f64 = 3500.0;
/// Half length of the kernel, s: its transition band is about 1 kHz wide.
const HALF_LENGTH_S: f64 = 0.002;
/// Tabulated phases per input sample; between them the kernel is interpolated linearly (error below −70 dB).
const PHASES: usize = 32;

/// Streaming resampler of one channel.
#[derive(Clone, Debug)]
pub struct Resampler {
    rate: u32,
    /// Numerator of φ over [`INTERNAL_RATE`].
    phase: u32,
    taps: usize,
    /// `PHASES + 1` rows of `taps` coefficients.
    kernel: Vec<f64>,
    /// The last `taps` samples, twice, so that any run of them is contiguous.
    history: Vec<f64>,
    next: usize,
    /// Consecutive zeros; a history of only zeros needs no sum.
    zeros: usize,
}

impl Resampler {
    /// A resampler from `rate` Hz (raised to 8 kHz if lower) to [`INTERNAL_RATE`].
    pub fn new(rate: u32) -> Self {
        let rate = rate.max(INTERNAL_RATE);
        let half = (HALF_LENGTH_S * f64::from(rate)).ceil();
        let taps = 2 * half as usize + 1;
        let bandwidth = 2.0 * CUTOFF_HZ / f64::from(rate);
        let mut kernel = Vec::with_capacity((PHASES + 1) * taps);
        for row in 0..=PHASES {
            let fraction = row as f64 / PHASES as f64;
            let start = kernel.len();
            // Oldest sample first, as in the history.
            for j in (0..taps).rev() {
                let t = j as f64 - fraction - half;
                let x = PI * bandwidth * t;
                let sinc = if x.abs() < 1e-9 { 1.0 } else { sin(x) / x };
                let window = if t.abs() < half { cos(0.5 * PI * t / half) } else { 0.0 };
                kernel.push(sinc * window * window);
            }
            // Unit gain at 0 Hz in every row, so that a constant input leaves no ripple.
            let sum: f64 = kernel[start..].iter().sum();
            kernel[start..].iter_mut().for_each(|h| *h /= sum);
        }
        Self { rate, phase: 0, taps, kernel, history: vec![0.0; 2 * taps], next: 0, zeros: taps }
    }

    /// Takes one input sample; returns an output sample where one falls due.
    pub fn push(&mut self, sample: f64) -> Option<f64> {
        self.zeros = if sample == 0.0 { self.zeros + 1 } else { 0 };
        self.history[self.next] = sample;
        self.history[self.next + self.taps] = sample;
        self.next = (self.next + 1) % self.taps;
        self.phase += INTERNAL_RATE;
        if self.phase < self.rate {
            return None;
        }
        self.phase -= self.rate;
        if self.zeros >= self.taps {
            return Some(0.0);
        }
        let position = f64::from(self.phase) / f64::from(INTERNAL_RATE) * PHASES as f64;
        let row = (position.floor() as usize).min(PHASES - 1);
        let blend = position - row as f64;
        let (near, far) = self.kernel[row * self.taps..(row + 2) * self.taps].split_at(self.taps);
        let recent = &self.history[self.next..self.next + self.taps];
        let (a, b) = (dot(recent, near), dot(recent, far));
        Some(a + blend * (b - a))
    }
}

impl Drop for Resampler {
    /// Overwrites the last samples.
    fn drop(&mut self) {
        self.history.zeroize();
    }
}

/// Sum of products in eight sums side by side, which the compiler vectorises.
fn dot(x: &[f64], h: &[f64]) -> f64 {
    let ((xs, x), (hs, h)) = (x.as_chunks::<8>(), h.as_chunks::<8>());
    let mut sums = [0.0; 8];
    for (x, h) in xs.iter().zip(hs) {
        for i in 0..8 {
            sums[i] += x[i] * h[i];
        }
    }
    sums.iter().sum::<f64>() + x.iter().zip(h).map(|(x, h)| x * h).sum::<f64>()
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_math::amplitude_to_db;

    /// Gain of a tone, measured over a second, dB.
    fn gain(rate: u32, hz: f64) -> f64 {
        let mut resampler = Resampler::new(rate);
        let tone = |i: u32| sin(2.0 * PI * hz * f64::from(i) / f64::from(rate));
        let out: Vec<f64> =
            (0..2 * rate).filter_map(|i| resampler.push(tone(i))).skip(INTERNAL_RATE as usize).collect();
        amplitude_to_db((2.0 * out.iter().map(|x| x * x).sum::<f64>() / out.len() as f64).sqrt())
    }

    #[test]
    fn tones_of_any_rate_pass_below_3_khz_and_aliases_are_stopped() {
        /// Ripple of the kernel's pass band, dB.
        const RIPPLE_DB: f64 = 0.5;
        for rate in [8_000, 11_025, 16_000, 44_100, 48_000, 96_000] {
            for hz in [20.0, 200.0, 1000.0, 3000.0] {
                assert!(gain(rate, hz).abs() < RIPPLE_DB, "{hz} Hz at {rate}: {} dB", gain(rate, hz));
            }
            // The alias of 5 kHz lies at 3 kHz, that of 7.9 kHz at 100 Hz.
            for hz in [5000.0, 7900.0].into_iter().filter(|hz| *hz < 0.45 * f64::from(rate)) {
                assert!(gain(rate, hz) < -40.0, "{hz} Hz at {rate}: {} dB", gain(rate, hz));
            }
        }
    }
}

//! Streaming sample-rate conversion to 8 kHz by windowed-sinc kernels: one for the subband below 4 kHz, one for that above.
//!
//! All later stages work on 8 kHz samples, so the microphone's rate (8–192 kHz) cannot change a decision. Breath is strongest below
//! 200 Hz, and the harmonics of voices lie below 3 kHz. Above that a breath still hisses while a crowd is quiet, so dual
//! microphones use that subband too ([`super::high_band`]).
//!
//! Symbols: R input rate, F = 8000 Hz output rate, H half length of the kernel in input samples.
//! The kernel is a low pass at f_c = 3500 Hz under a Hann window (J. O. Smith, "Digital Audio Resampling"):
//!
//! ```text
//! h(t) = (2 f_c / R) · sinc(2 f_c t / R) · cos²(π t / (2 H)),   |t| < H
//! y(k) = Σ_j x(n − j) · h(j − φ − H),   φ ∈ [0, 1): distance of the output instant before sample n
//! ```
//!
//! The kernel of the high band is a low pass at f_c = 1650 Hz modulated to f₀ = 5650 Hz, h(t) · 2 cos(2π f₀ t / R). It passes 4.4 to
//! 7 kHz, which 8 kHz samples represent at 1 to 3.6 kHz, in reverse: f lies at F − f (bandpass sampling; Vaughan, Scott and White,
//! IEEE Trans. Signal Process. 39, 1991). Its gain is 20 dB, since ambient noise and voices fall towards high frequencies.
//!
//! φ is kept as an integer numerator over F, so the output instants never drift.
//! Invariant: outputs depend on the samples alone, never on how they were cut into blocks.

use soffio_math::{PI, cos, db_to_amplitude, sin};

/// The internal rate, Hz.
pub const INTERNAL_RATE: u32 = 8000;
/// Cut-off of the kernel, Hz: the features end at 3.4 kHz.
const CUTOFF_HZ: f64 = 3500.0;
/// Cut-off of the high band's kernel before modulation, Hz.
const HIGH_BAND_CUTOFF_HZ: f64 = 1650.0;
/// Centre of the high band, Hz.
const HIGH_BAND_CENTRE_HZ: f64 = 5650.0;
/// Gain of the high band, dB.
pub const HIGH_BAND_GAIN_DB: f64 = 20.0;
/// Lowest sample rate with a high band, Hz.
const HIGH_BAND_MIN_RATE: u32 = 16000;
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
    /// A resampler from `rate` Hz (raised to 8 kHz if lower) to [`INTERNAL_RATE`], for the subband below 4 kHz.
    pub fn new(rate: u32) -> Self {
        Self::with_kernel(rate, CUTOFF_HZ, |_| 1.0)
    }

    /// A resampler for the high band, 4.4 to 7 kHz: in reverse at 1 to 3.6 kHz, 20 dB louder; silent below a rate of 16 kHz.
    pub fn high_band(rate: u32) -> Self {
        let gain = if rate < HIGH_BAND_MIN_RATE { 0.0 } else { 2.0 * db_to_amplitude(HIGH_BAND_GAIN_DB) };
        Self::with_kernel(rate, HIGH_BAND_CUTOFF_HZ, |seconds| gain * cos(2.0 * PI * HIGH_BAND_CENTRE_HZ * seconds))
    }

    /// A low pass with a modulation over time, s.
    fn with_kernel(rate: u32, cutoff_hz: f64, modulation: impl Fn(f64) -> f64) -> Self {
        let rate = rate.max(INTERNAL_RATE);
        let half = (HALF_LENGTH_S * f64::from(rate)).ceil();
        let taps = 2 * half as usize + 1;
        let bandwidth = 2.0 * cutoff_hz / f64::from(rate);
        let mut kernel = Vec::with_capacity((PHASES + 1) * taps);
        for row in 0..=PHASES {
            let fraction = row as f64 / PHASES as f64;
            let start = kernel.len();
            for j in 0..taps {
                let t = j as f64 - fraction - half;
                let x = PI * bandwidth * t;
                let sinc = if x.abs() < 1e-9 { 1.0 } else { sin(x) / x };
                let window = if t.abs() < half { cos(0.5 * PI * t / half) } else { 0.0 };
                kernel.push(sinc * window * window);
            }
            // Unit gain at 0 Hz in every row, so that a constant input leaves no ripple.
            let sum: f64 = kernel[start..].iter().sum();
            for (j, h) in kernel[start..].iter_mut().enumerate() {
                *h = *h / sum * modulation((j as f64 - fraction - half) / f64::from(rate));
            }
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
        // `recent[0]` is the oldest sample; the kernel's j counts back from the newest.
        let recent = &self.history[self.next..self.next + self.taps];
        let (mut a, mut b) = (0.0, 0.0);
        for ((x, h), g) in recent.iter().rev().zip(near).zip(far) {
            a += x * h;
            b += x * g;
        }
        Some(a + blend * (b - a))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_math::{amplitude_to_db, sin};

    /// Gain, dB, and output frequency, Hz, of a tone, measured over a second.
    fn response(mut resampler: Resampler, rate: u32, hz: f64) -> (f64, f64) {
        let tone = |i: u32| sin(2.0 * PI * hz * f64::from(i) / f64::from(rate));
        let out: Vec<f64> =
            (0..2 * rate).filter_map(|i| resampler.push(tone(i))).skip(INTERNAL_RATE as usize).collect();
        let square = out.iter().map(|x| x * x).sum::<f64>() / out.len() as f64;
        let crossings = out.windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count();
        (amplitude_to_db((2.0 * square).sqrt()), 0.5 * crossings as f64)
    }

    #[test]
    fn the_high_band_is_reversed_and_raised_and_the_rest_is_stopped() {
        /// Loss at the edges of the kernel, dB.
        const LESS_DB: f64 = 2.0;
        /// Error of the count: one crossing at either end of a second.
        const COUNTED_HZ: f64 = 1.5;
        for rate in [16_000, 44_100, 48_000, 96_000] {
            for hz in [4600.0, 5650.0, 6700.0] {
                let (level, at) = response(Resampler::high_band(rate), rate, hz);
                assert!((level - HIGH_BAND_GAIN_DB).abs() < LESS_DB, "{hz} Hz at {rate}: {level:.1} dB");
                assert!((at - (8000.0 - hz)).abs() < COUNTED_HZ, "{hz} Hz at {rate} comes out at {at}");
            }
            for hz in [200.0, 1000.0, 2500.0, 3300.0] {
                let (level, _) = response(Resampler::high_band(rate), rate, hz);
                assert!(level < HIGH_BAND_GAIN_DB - 40.0, "{hz} Hz at {rate}: {level:.1} dB");
            }
        }
        assert!(response(Resampler::high_band(11_025), 11_025, 5000.0).0 < -200.0, "there is none");
    }
}

//! One internal rate for every microphone: a streaming windowed-sinc resampler to 8 kHz.
//!
//! Everything after this file works on 8 kHz samples, so a microphone's rate (8–192 kHz) cannot change a decision.
//! Breath lives below 200 Hz, voices are told by their harmonics below 3 kHz: nothing needed is lost.
//!
//! Symbols: R input rate, F = 8000 Hz output rate, H half length of the kernel in input samples.
//! The kernel is a low pass at f_c = 3500 Hz under a Hann window (J. O. Smith, "Digital Audio Resampling"):
//!
//! ```text
//! h(t) = (2 f_c / R) · sinc(2 f_c t / R) · cos²(π t / (2 H)),   |t| < H
//! y(k) = Σ_j x(n − j) · h(j − φ − H),   φ ∈ [0, 1): how long before sample n the output instant lies
//! ```
//!
//! φ is kept as an integer numerator over F, so the output instants never drift.
//! Invariant: outputs depend on the samples alone, never on how they were cut into blocks.

use crate::math::{PI, cos, sin};

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
    /// The last `taps` samples, twice, so that a run of them is always contiguous.
    history: Vec<f64>,
    next: usize,
    /// Zeros in a row; a history of nothing but zeros needs no sum.
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
            for j in 0..taps {
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

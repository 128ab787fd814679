//! Short-time Fourier transform: power spectra of the microphone and of the loudspeaker's reference signal.
//!
//! A frame is the last 48 ms at 8 kHz, every 8 ms. Its window is asymmetric: half a Hann window of 72 ms, then half of one of
//! 24 ms. New samples count 8 ms sooner than under a symmetric window, with a main lobe of the same width. Two real signals share
//! one complex transform, with z = x + i r:
//!
//! ```text
//! X_k = (Z_k + Z*_{N−k}) / 2,      R_k = (Z_k − Z*_{N−k}) / (2 i)
//! ```
//!
//! Powers are one-sided and scaled so that their sum is the mean square of the frame (Parseval):
//! P_k = 2 |X_k|² / (N Σ w²), full scale ±1.
//!
//! The transform is planned once with scalar kernels: vector kernels differ between processors in the last bit.

use std::sync::Arc;

use soffio_fourier::{Complex, Fft, forward};

use super::resample::INTERNAL_RATE;
use soffio_math::{PI, cos};
use zeroize::Zeroize;

/// Length of a frame, internal samples (48 ms: three periods of the lowest voice).
const WINDOW: usize = 384;
/// Samples before the window's maximum.
const RISING: usize = 288;
/// Internal samples between frames (8 ms).
const HOP: usize = 64;
/// Length of the transform.
pub const TRANSFORM: usize = 512;
/// Bins of a power spectrum; bin k lies at k · 15.625 Hz.
pub const BINS: usize = TRANSFORM / 2;
/// Time between frames, s.
pub const FRAME_S: f64 = HOP as f64 / INTERNAL_RATE as f64;

/// A one-sided power spectrum.
pub type Power = [f64; BINS];

/// One sample of all signals at the internal rate.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sample {
    /// First capsule.
    pub left: f64,
    /// Second capsule; the first one again where there is only one.
    pub right: f64,
    /// Signal of the loudspeaker.
    pub reference: f64,
}

/// Framing and transform of the signals.
#[derive(Clone)]
pub struct Framer {
    transform: Arc<dyn Fft<f64>>,
    window: [f64; WINDOW],
    /// The last `WINDOW` samples, a ring.
    ring: [Sample; WINDOW],
    next: usize,
    until_frame: usize,
    buffer: Vec<Complex<f64>>,
    scratch: Vec<Complex<f64>>,
    /// Factor from squared amplitude to power.
    pub scale: f64,
    /// Samples until the reference signal has left the window.
    reference_samples: usize,
    /// Power spectrum of the last frame, mean of both capsules.
    pub microphone: Power,
    /// Power spectrum of the loudspeaker's reference signal in the last frame.
    pub reference: Power,
    /// Complex spectra of both capsules.
    pub channels: [[Complex<f64>; BINS]; 2],
}

impl std::fmt::Debug for Framer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Framer").field("until_frame", &self.until_frame).finish_non_exhaustive()
    }
}

impl Framer {
    /// Plans the transform and the window.
    pub(crate) fn new() -> Self {
        let transform = forward(TRANSFORM);
        let window: [f64; WINDOW] = std::array::from_fn(|i| {
            let t = i as f64 + 0.5 - RISING as f64;
            let half = if t < 0.0 { RISING } else { WINDOW - RISING };
            0.5 + 0.5 * cos(PI * t / half as f64)
        });
        let scratch = vec![Complex::default(); transform.get_inplace_scratch_len()];
        let energy: f64 = window.iter().map(|w| w * w).sum();
        Self {
            transform,
            window,
            ring: [Sample::default(); WINDOW],
            next: 0,
            until_frame: HOP,
            buffer: vec![Complex::default(); TRANSFORM],
            scratch,
            scale: 2.0 / (TRANSFORM as f64 * energy),
            reference_samples: 0,
            microphone: [0.0; BINS],
            reference: [0.0; BINS],
            channels: [[Complex::default(); BINS]; 2],
        }
    }

    /// Takes one internal sample; true where a new frame is ready.
    pub fn push(&mut self, sample: Sample) -> bool {
        self.ring[self.next] = sample;
        self.next = (self.next + 1) % WINDOW;
        self.reference_samples =
            if sample.reference == 0.0 { self.reference_samples.saturating_sub(1) } else { WINDOW };
        self.until_frame -= 1;
        if self.until_frame > 0 {
            return false;
        }
        self.until_frame = HOP;
        self.transform(|s| Complex::new(s.left, s.right));
        for k in 1..BINS {
            let (z, mirror) = (self.buffer[k], self.buffer[TRANSFORM - k].conj());
            let (left, right) = (0.5 * (z + mirror), Complex::new(0.0, -0.5) * (z - mirror));
            self.channels[0][k] = left;
            self.channels[1][k] = right;
            self.microphone[k] = 0.5 * self.scale * (left.norm_sqr() + right.norm_sqr());
        }
        if self.reference_samples > 0 {
            self.transform(|s| Complex::new(s.reference, 0.0));
            for k in 1..BINS {
                self.reference[k] = self.scale * self.buffer[k].norm_sqr();
            }
        } else {
            self.reference = [0.0; BINS];
        }
        true
    }

    fn transform(&mut self, signal: impl Fn(&Sample) -> Complex<f64>) {
        let (newer, older) = self.ring.split_at(self.next);
        for ((z, x), w) in self.buffer.iter_mut().zip(older.iter().chain(newer)).zip(&self.window) {
            *z = signal(x) * w;
        }
        self.buffer[WINDOW..].fill(Complex::default());
        self.transform.process_with_scratch(&mut self.buffer, &mut self.scratch);
    }
}

impl Drop for Framer {
    /// Overwrites the last samples, and the spectra from which they could be restored.
    fn drop(&mut self) {
        for sample in &mut self.ring {
            sample.left.zeroize();
            sample.right.zeroize();
        }
        for z in self.buffer.iter_mut().chain(&mut self.scratch).chain(self.channels.as_flattened_mut()) {
            z.re.zeroize();
            z.im.zeroize();
        }
    }
}

/// Sum of the powers in the bins `low..high`.
pub fn band(power: &Power, low: usize, high: usize) -> f64 {
    power[low..high].iter().sum()
}

//! Power spectra of the microphone and of the kiosk's own output, frame by frame.
//!
//! A frame is the last 48 ms at 8 kHz, taken every 8 ms, under a window that rises slowly and falls fast: half a Hann
//! window of 72 ms, then half of one of 24 ms. What is new counts 8 ms sooner than under a symmetric window, and the
//! main lobe is as wide. Two real signals share one complex transform: with z = x + i r,
//!
//! ```text
//! X_k = (Z_k + Z*_{N−k}) / 2,      R_k = (Z_k − Z*_{N−k}) / (2 i)
//! ```
//!
//! Powers are one-sided and scaled so that their sum is the mean square of the frame (Parseval):
//! P_k = 2 |X_k|² / (N Σ w²), full scale ±1.
//!
//! The transform is planned once with the scalar kernels: vector kernels differ between processors in the last bit.

use std::sync::Arc;

use soffio_fourier::{Complex, Fft, forward};

use super::resample::INTERNAL_RATE;
use soffio_math::{PI, cos, ln};

/// Length of a frame, internal samples (48 ms: three periods of the lowest voice).
const WINDOW: usize = 384;
/// Of these, how many lie before the window's top.
const RISING: usize = 288;
/// Internal samples between frames (8 ms).
const HOP: usize = 64;
/// Length of the transform.
pub const TRANSFORM: usize = 512;
/// Bins of a power spectrum; bin k lies at k · 15.625 Hz.
pub const BINS: usize = TRANSFORM / 2;
/// Sum of squares of a frame that is silent.
const SILENT: f64 = 1e-20;
/// Time between frames, s.
pub const FRAME_S: f64 = HOP as f64 / INTERNAL_RATE as f64;

/// A one-sided power spectrum.
pub type Power = [f64; BINS];

/// One internal sample of everything.
#[derive(Clone, Copy, Debug, Default)]
pub struct Sample {
    /// First capsule.
    pub left: f64,
    /// Second capsule; the first again where there is one only.
    pub right: f64,
    /// What the kiosk played.
    pub own: f64,
}

/// Cuts the signals into frames and transforms them.
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
    /// Power of a square amplitude.
    pub scale: f64,
    /// Samples until the own output has left the window.
    sounding: usize,
    /// Spectrum of the microphone in the last frame: of the mean of both capsules.
    pub microphone: Power,
    /// Spectrum of the kiosk's own output in the last frame.
    pub own: Power,
    /// Amplitudes of both capsules.
    pub capsules: [[Complex<f64>; BINS]; 2],
    /// How peaked the treble of the last 8 ms is: logarithm of its kurtosis over that of Gaussian noise.
    pub peakedness: f64,
    treble: Treble,
}

/// Moments of the second difference since the last frame: of noise it is as Gaussian as the noise, of voices, creaks and
/// rattles it shows each pulse.
#[derive(Clone, Copy, Debug, Default)]
struct Treble {
    before: [f64; 2],
    square: f64,
    fourth: f64,
}

impl Treble {
    fn push(&mut self, x: f64) {
        let difference = x - 2.0 * self.before[0] + self.before[1];
        self.before = [x, self.before[0]];
        let square = difference * difference;
        self.square += square;
        self.fourth += square * square;
    }

    /// ln(n Σd⁴ / (3 (Σd²)²)); 0 of silence. The next frame begins.
    fn take(&mut self) -> f64 {
        let Self { square, fourth, .. } = std::mem::replace(self, Self { before: self.before, ..Self::default() });
        if square < SILENT { 0.0 } else { ln(HOP as f64 * fourth / (3.0 * square * square)) }
    }
}

impl std::fmt::Debug for Framer {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Framer").field("until_frame", &self.until_frame).finish_non_exhaustive()
    }
}

impl Framer {
    /// Plans the transform.
    pub fn new() -> Self {
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
            sounding: 0,
            microphone: [0.0; BINS],
            own: [0.0; BINS],
            capsules: [[Complex::default(); BINS]; 2],
            peakedness: 0.0,
            treble: Treble::default(),
        }
    }

    /// Takes one internal sample; true where a new frame is ready.
    pub fn push(&mut self, sample: Sample) -> bool {
        self.ring[self.next] = sample;
        self.treble.push(0.5 * (sample.left + sample.right));
        self.next = (self.next + 1) % WINDOW;
        self.sounding = if sample.own == 0.0 { self.sounding.saturating_sub(1) } else { WINDOW };
        self.until_frame -= 1;
        if self.until_frame > 0 {
            return false;
        }
        self.until_frame = HOP;
        self.peakedness = self.treble.take();
        self.transform(|s| Complex::new(s.left, s.right));
        for k in 1..BINS {
            let (z, mirror) = (self.buffer[k], self.buffer[TRANSFORM - k].conj());
            let (left, right) = (0.5 * (z + mirror), Complex::new(0.0, -0.5) * (z - mirror));
            self.capsules[0][k] = left;
            self.capsules[1][k] = right;
            self.microphone[k] = 0.25 * self.scale * (left + right).norm_sqr();
        }
        if self.sounding > 0 {
            self.transform(|s| Complex::new(s.own, 0.0));
            for k in 1..BINS {
                self.own[k] = self.scale * self.buffer[k].norm_sqr();
            }
        } else {
            self.own = [0.0; BINS];
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

/// Sum of the powers in the bins `low..high`.
pub fn band(power: &Power, low: usize, high: usize) -> f64 {
    power[low..high].iter().sum()
}

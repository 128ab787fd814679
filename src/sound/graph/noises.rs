//! Coloured noise.
//!
//! **Pink**: white noise through poles and zeros that alternate on a logarithmic scale (Oustaloup's recursion): between
//! them the gain falls by 20 dB per decade over half of the way, 10 on average. With one pole every two octaves the
//! ripple is below 0.5 dB.
//!
//! **Slow** noise is a function of time, so that all voices feel the same gust. Where all its octaves are below a quarter
//! of the control rate it is read on the grid and glides; otherwise it is read at each sample, up to fs/8.

use super::block::CONTROL_PERIOD;
use super::state::{OperatorState, PINK};
use crate::gusts::multifractal;
use crate::timbre::{Noise, NoiseKind};
use soffio_math::noise::{hash, perlin1};
use soffio_math::{PI, exp, ln};

/// Ratio of one pole's frequency to the next: two octaves, for a ripple below 0.5 dB. The lowest is at 20 Hz at 48 kHz.
const APART: f64 = 4.0;
/// Frequency of the lowest pole over the sample rate: 20 Hz at 48 kHz, the lower end of hearing.
const LOWEST: f64 = 20.0 / 48_000.0;
/// Gain that brings the noise to the power of white noise: 1/√ of the mean of |H|², which is 1 at 0 Hz.
const MAKE_UP: f64 = 14.2;

/// White noise made pink.
pub(super) struct Pink {
    /// Pole, zero and gain at 0 Hz of each section.
    sections: [[f64; 3]; PINK],
}

impl Pink {
    /// The pink filter's poles and zeros.
    pub fn new() -> Self {
        let mut corner = LOWEST;
        let sections = std::array::from_fn(|_| {
            let (pole, zero) = (exp(-2.0 * PI * corner), exp(-4.0 * PI * corner));
            corner *= APART;
            [pole, zero, (1.0 - pole) / (1.0 - zero)]
        });
        Self { sections }
    }

    /// Renders a block of pink noise.
    pub fn render(&self, state: &mut OperatorState, out: &mut [f32]) {
        for y in out {
            let mut x = MAKE_UP * state.random.signed();
            for ([pole, zero, gain], memory) in self.sections.iter().zip(&mut state.pink) {
                // (1 − z q⁻¹)/(1 − p q⁻¹)
                let passed = x + *memory;
                *memory = pole * passed - zero * x;
                x = gain * passed;
            }
            *y = x as f32;
        }
    }
}

/// Noise that is a function of time.
pub(super) struct Slow {
    fractal: bool,
    base: f64,
    octaves: u32,
    roughness: f64,
}

impl Slow {
    /// The slow noise of a checked node.
    pub fn new(noise: &Noise) -> Self {
        let &Noise { base, octaves, roughness, .. } = noise;
        Self { fractal: noise.kind == NoiseKind::Multifractal, base, octaves, roughness }
    }

    /// Octaves below a rate in Hz.
    fn octaves_below(&self, rate: f64) -> u32 {
        let octaves = ln((rate / self.base).max(1.0)) / ln(2.0);
        self.octaves.min(1 + octaves as u32)
    }

    fn at(&self, t: f64, octaves: u32, seed: u64) -> f64 {
        if self.fractal {
            return multifractal(t * self.base, octaves, self.roughness, seed);
        }
        let falling = libm::exp2(-self.roughness);
        let (mut sum, mut weight, mut rate) = (0.0, 1.0, self.base);
        for octave in 0..octaves {
            sum += weight * perlin1(t * rate, hash(seed ^ u64::from(octave)));
            weight *= falling;
            rate *= 2.0;
        }
        sum
    }

    /// Whether it must be read at each sample.
    fn is_fast(&self, sample_rate: f64) -> bool {
        self.octaves_below(0.25 * sample_rate / CONTROL_PERIOD as f64) < self.octaves
    }

    /// Starts the noise of a voice at `time`, s.
    pub fn begin(&self, state: &mut OperatorState, seed: u64, time: f64, sample_rate: f64) {
        if self.is_fast(sample_rate) {
            (state.place, state.step) = (time, 1.0 / sample_rate);
        } else {
            state.value = self.at(time, self.octaves, seed);
        }
        (state.seed, state.octaves) = (seed, self.octaves_below(0.125 * sample_rate));
    }

    /// Sets the change per sample up to the next control point; `time` in s.
    pub fn control(&self, state: &mut OperatorState, seed: u64, time: f64, sample_rate: f64) {
        if self.is_fast(sample_rate) {
            state.place = time;
        } else {
            let next = self.at(time + CONTROL_PERIOD as f64 / sample_rate, self.octaves, seed);
            state.change = (next - state.value) / CONTROL_PERIOD as f64;
        }
    }

    /// Renders a block of slow noise.
    pub fn render(&self, state: &mut OperatorState, out: &mut [f32]) {
        for y in out {
            if state.step > 0.0 {
                state.value = self.at(state.place, state.octaves, state.seed);
                state.place += state.step;
            }
            *y = state.value as f32;
            state.value += state.change;
        }
    }
}

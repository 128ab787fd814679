//! Inputs of the network, a vector per frame of 8 ms, independent of the microphone's gain.
//!
//! Air at a capsule is noise of low frequency: turbulence that is swept past at the local speed U has a flat spectrum below
//! U/(2π L), L being the size of the large eddies, and falls steeply above (`../training/generator`). Where a microphone has a high-pass,
//! only the flank is left. Lips add a hiss above 400 Hz. Between two capsules turbulence is incoherent and sound is not.
//! So for each band the network sees:
//!
//! | inputs | meaning |
//! |---|---|
//! | rise | level over the noise floor, without the loudspeaker's echo |
//! | shape | level relative to the loudest band: the same at any distance from the floor |
//! | strangeness | the rise relative to the usual spread of this room |
//! | periodicity | largest autocorrelation at 80–400 Hz: voices and music |
//! | echo | share of the loudspeaker's echo in the rumble |
//! | two capsules | 1, or 0 with one: then all inputs after it are 0 |
//! | incoherent rise | the same rise of the incoherent power of wide bands |
//! | incoherent strangeness | the same, relative to its spread |
//! | decorrelation | 1 − γ² of wide bands |
//!
//! Decibels are compressed, tanh(r/R): 25 dB over the floor say no more than 60, which only a microphone that is silent in between
//! has.

use super::bands::{BANDS, EDGES, RUMBLE, WIDE, WIDE_EDGES, power_to_db, powers};
use super::noise_floor::Floor;
use super::coherence::Coherence;
use super::spectrum::{Framer, Power, TRANSFORM};
use soffio_math::{PI, cos, tanh};

/// Number of inputs.
pub const COUNT: usize = 3 * BANDS + 3 + 3 * WIDE;
/// Inputs that describe the shape of the spectrum.
pub const SHAPE: std::ops::Range<usize> = BANDS..2 * BANDS;
/// Inputs of the network for one frame.
pub type Inputs = [f32; COUNT];

/// Smallest power of a band (−78 dBFS): below it lies a converter's own noise.
const MIN_POWER: f64 = 1.6e-8;
/// Part of the predicted echo that may remain after subtraction, and its part that two capsules do not share.
const RESIDUE: f64 = 0.03;
/// Bins that may carry harmonics of a voice, 94–1000 Hz.
const HARMONICS: std::ops::Range<usize> = 6..64;
/// Lags of 400 Hz and 80 Hz, internal samples.
const PITCH_LAGS: std::ops::Range<usize> = 20..100;
const LAGS: usize = PITCH_LAGS.end - PITCH_LAGS.start;
/// R of the compression of a rise, dB. How far a sound rises says how near and how loud it is, not what it is.
const RISE_DB: f64 = 20.0;
/// R of the compression of the shape, dB.
const SHAPE_DB: f64 = 30.0;
/// R of the compression of strangeness.
const STRANGE: f64 = 8.0;
/// Smallest spread, dB: the scatter of noise in a wide band.
const MIN_SPREAD_DB: f64 = 1.5;

/// Extractor of the inputs, with the floors that they refer to.
#[derive(Clone, Debug)]
pub struct Features {
    /// Floor of the bands.
    pub floor: Floor<BANDS>,
    /// Floor of the incoherent power of the wide bands.
    pub incoherent_floor: Floor<WIDE>,
    coherence: Coherence,
    /// cos(2π k τ / N) for each bin k of the harmonics, and each lag τ.
    cosines: Vec<[f32; LAGS]>,
}

/// Measurements of one frame.
#[derive(Clone, Copy, Debug)]
pub struct Frame {
    /// Inputs of the network.
    pub inputs: Inputs,
    /// Levels of the bands without the echo, dB of full scale.
    pub levels: [f64; BANDS],
    /// Largest rise of a band, dB.
    pub rise_db: f64,
    /// Share of the echo in the rumble, 0 … 1.
    pub echo: f64,
    /// Periodicity, 0 … 1.
    pub periodicity: f32,
}

impl Features {
    /// An extractor that knows no floor yet.
    pub fn new() -> Self {
        Self {
            floor: Floor::new(),
            incoherent_floor: Floor::new(),
            coherence: Coherence::new(),
            cosines: HARMONICS
                .map(|k| {
                    let turn = |lag: usize| 2.0 * PI * (k * (PITCH_LAGS.start + lag)) as f64 / TRANSFORM as f64;
                    std::array::from_fn(|lag| cos(turn(lag)) as f32)
                })
                .collect(),
        }
    }

    /// Measures a frame; `echo` is the predicted power of the loudspeaker's echo, and `stereo` says that there are two capsules.
    pub fn push(&mut self, framer: &Framer, echo: &Power, stereo: bool) -> Frame {
        let [power, echo_power]: [[f64; BANDS]; 2] = [&framer.microphone, echo].map(|p| powers(p, &EDGES));
        let levels: [f64; BANDS] = std::array::from_fn(|b| {
            power_to_db((power[b] - echo_power[b]).max(RESIDUE * echo_power[b]).max(0.0) + MIN_POWER)
        });
        self.floor.learn(&levels);
        let mut inputs = [0.0; COUNT];
        let mut rise_db = 0.0_f64;
        let loudest = levels.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        for (b, level) in levels.iter().enumerate() {
            let rise = self.floor.rise(b, *level);
            rise_db = rise_db.max(rise);
            inputs[b] = compressed(rise, RISE_DB);
            inputs[BANDS + b] = compressed(level - loudest, SHAPE_DB);
            inputs[2 * BANDS + b] = compressed(rise / self.floor.spread(b).max(MIN_SPREAD_DB), STRANGE);
        }
        let sum = |of: &[f64; BANDS]| of[RUMBLE].iter().sum::<f64>();
        let share = (sum(&echo_power) / (sum(&power) + MIN_POWER)).min(1.0);
        let periodicity = self.periodicity(&framer.microphone);
        inputs[3 * BANDS..3 * BANDS + 2].copy_from_slice(&[periodicity, share as f32]);
        if stereo {
            inputs[3 * BANDS + 2] = 1.0;
            self.compare(framer, &powers(echo, &WIDE_EDGES), &mut inputs[3 * BANDS + 3..]);
        }
        Frame { inputs, levels, rise_db, echo: share, periodicity }
    }

    /// Inputs of two capsules.
    fn compare(&mut self, framer: &Framer, echo: &[f64; WIDE], inputs: &mut [f32]) {
        let parts = self.coherence.push(&framer.channels, framer.scale);
        let levels: [f64; WIDE] =
            std::array::from_fn(|b| power_to_db((parts[b].0 - RESIDUE * echo[b]).max(0.0) + MIN_POWER));
        self.incoherent_floor.learn(&levels);
        for b in 0..WIDE {
            let rise = self.incoherent_floor.rise(b, levels[b]);
            inputs[b] = compressed(rise, RISE_DB);
            inputs[WIDE + b] = compressed(rise / self.incoherent_floor.spread(b).max(MIN_SPREAD_DB), STRANGE);
            inputs[2 * WIDE + b] = parts[b].1 as f32;
        }
    }

    /// Highest peak of the autocorrelation of 94–1000 Hz at the lags of 80–400 Hz, 0 … 1. The square root of the spectrum whitens
    /// it, so that coloured noise does not look like a pitch (Tolonen and Karjalainen, IEEE Trans. Speech Audio Process. 8, 2000).
    /// r(τ) = Σ_k √P_k cos(2π k τ / N) (Wiener–Khinchin).
    fn periodicity(&self, power: &Power) -> f32 {
        let mut total = MIN_POWER as f32;
        let mut correlation = [0.0; LAGS];
        for (cosines, p) in self.cosines.iter().zip(&power[HARMONICS]) {
            let amplitude = p.sqrt() as f32;
            total += amplitude;
            correlation.iter_mut().zip(cosines).for_each(|(sum, cosine)| *sum += amplitude * cosine);
        }
        let peak = correlation.into_iter().fold(0.0, f32::max);
        (peak / total).clamp(0.0, 1.0)
    }
}

/// R tanh(x/R), over R: −1 … 1.
fn compressed(x: f64, range: f64) -> f32 {
    tanh(x / range) as f32
}

//! Statistical modes: random partials for bodies with too many to distinguish, such as wood, drums and sheet metal.
//!
//! One frequency falls evenly into each of N equal parts of the band (in hertz or in octaves). The decay is
//! c = c₀ + c₂ ω², through the two T60 given, each multiplied by s^u with u even in ±1. Levels fall by the tilt and are
//! Rayleigh's, as the sum of many shapes has them; their squares sum to 1. The shape of each is a wave of the
//! direction and phase of chance, with as many half waves along the body as its frequency over the lowest allows.

use super::limits::T60_DECAYS;
use super::mode::Mode;
use super::shape::Shape;
use crate::timbre::{Drawn, Modal, Spacing};
use soffio_math::noise::{Random, hash_words};
use soffio_math::{PI, exp, ln, pow, sincos};

/// Partials of a draw, ascending.
pub(super) fn partials(drawn: &Drawn, modal: &Modal) -> Vec<Mode> {
    let count = modal.partials;
    let mut random = Random::new(hash_words(&[drawn.seed, count as u64]));
    let [c_low, c_high] = drawn.t60.map(|t60| T60_DECAYS / t60);
    let slope = (c_high - c_low) / (drawn.high * drawn.high - drawn.low * drawn.low);
    let mut modes: Vec<Mode> = (0..count)
        .map(|i| {
            let share = (i as f64 + random.unit()) / count as f64;
            let frequency = match drawn.spacing {
                Spacing::Even => drawn.low + share * (drawn.high - drawn.low),
                Spacing::Octaves => drawn.low * pow(drawn.high / drawn.low, share),
            };
            let spread = exp(random.signed() * ln(drawn.t60_spread));
            let decay = (c_low + slope * (frequency * frequency - drawn.low * drawn.low)) * spread;
            let octaves = ln(frequency / drawn.low) / ln(2.0);
            let level = pow(10.0, drawn.tilt * octaves / 20.0) * (-2.0 * ln(1.0 - random.unit())).sqrt();
            let waves = (frequency / drawn.low).sqrt();
            let (s, c) = sincos(PI * random.signed());
            let shape = Shape::Wave([waves * c, waves * s], PI * random.signed());
            Mode { frequency, decay, amplitude: level, shape }
        })
        .collect();
    let power: f64 = modes.iter().map(|mode| mode.amplitude * mode.amplitude).sum();
    let scale = 1.0 / power.sqrt().max(1e-12);
    modes.iter_mut().for_each(|mode| mode.amplitude *= scale);
    modes
}

//! Noises and simple filters that the sounds are made of. Deterministic, on whole buffers.

use soffio_math::noise::Random;
use soffio_math::{PI, cos, exp, ln};

/// Normal deviates of unit variance (Box and Muller 1958).
pub fn gaussian(count: usize, random: &mut Random) -> Vec<f64> {
    (0..count).map(|_| (-2.0 * ln(1.0 - random.unit())).sqrt() * cos(2.0 * PI * random.unit())).collect()
}

/// White noise of unit variance, nearly normal: the sum of four uniform deviates of 16 bits (Irwin and Hall 1927). Ten
/// times as fast as [`gaussian`], for hours of noise that are filtered anyway.
pub fn white(count: usize, random: &mut Random) -> Vec<f64> {
    let sum = |w: u64| (0..4).map(|i| (w >> (16 * i) & 0xffff) as f64).sum::<f64>();
    // Mean of the sum 2 · 65535, variance 4 · (65536² − 1)/12.
    (0..count).map(|_| (sum(random.word()) - 131_070.0) * (3.0_f64.sqrt() / 65_536.0)).collect()
}

/// `order` one-pole low passes in a row, −6 dB an octave each above `corner_hz`.
pub fn low_passed(mut samples: Vec<f64>, rate: f64, corner_hz: f64, order: usize) -> Vec<f64> {
    let keep = exp(-2.0 * PI * corner_hz / rate);
    for _ in 0..order {
        let mut state = 0.0;
        for x in &mut samples {
            state = *x + keep * (state - *x);
            *x = state;
        }
    }
    samples
}

/// `order` one-pole high passes in a row.
pub fn high_passed(mut samples: Vec<f64>, rate: f64, corner_hz: f64, order: usize) -> Vec<f64> {
    let keep = exp(-2.0 * PI * corner_hz / rate);
    for _ in 0..order {
        let mut low = 0.0;
        for x in &mut samples {
            low = *x + keep * (low - *x);
            *x -= low;
        }
    }
    samples
}

/// One signal below a corner and another one above it: of the same signal twice, that signal.
pub fn parted(below: Vec<f64>, above: Vec<f64>, rate: f64, corner_hz: f64) -> Vec<f64> {
    let (below, above) = (low_passed(below, rate, corner_hz, 1), high_passed(above, rate, corner_hz, 1));
    below.iter().zip(&above).map(|(b, a)| b + a).collect()
}

/// A two-pole resonance at `centre_hz` of the given bandwidth, unit gain at its peak (nearly).
pub fn resonance(samples: &[f64], rate: f64, centre_hz: f64, bandwidth_hz: f64) -> Vec<f64> {
    let radius = exp(-PI * bandwidth_hz / rate);
    let (a, b) = (2.0 * radius * cos(2.0 * PI * centre_hz / rate), radius * radius);
    let gain = (1.0 - radius) * (1.0 - a + b).abs().sqrt().max(1e-3);
    let (mut y1, mut y2) = (0.0, 0.0);
    samples
        .iter()
        .map(|x| {
            let y = gain * x + a * y1 - b * y2;
            (y2, y1) = (y1, y);
            y
        })
        .collect()
}

/// Mean square.
pub fn power(samples: &[f64]) -> f64 {
    samples.iter().map(|x| x * x).sum::<f64>() / samples.len().max(1) as f64
}

/// Scaled to unit RMS.
pub fn normalised(mut samples: Vec<f64>) -> Vec<f64> {
    let scale = 1.0 / power(&samples).sqrt().max(1e-12);
    samples.iter_mut().for_each(|x| *x *= scale);
    samples
}

/// Scaled to a peak of 1.
pub fn peaked(mut samples: Vec<f64>) -> Vec<f64> {
    let top = samples.iter().fold(1e-12, |m: f64, x| m.max(x.abs()));
    samples.iter_mut().for_each(|x| *x /= top);
    samples
}

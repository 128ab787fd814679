//! Sample-rate conversion between the sound card's 48 kHz and the 16 kHz of the synthetic sound, block by block.
//!
//! One windowed-sinc low pass serves both directions (Hann, 48 taps, corner 7.2 kHz): it prevents aliasing when decimating, and removes
//! images when interpolating.

use soffio_math::{PI, cos, sin};

/// 48 kHz over 16 kHz.
pub const RATIO: usize = 3;
/// Taps of the low pass, at 48 kHz.
const TAPS: usize = 16 * RATIO;
/// Corner of the low pass, relative to 48 kHz.
const CORNER: f64 = 0.15;

/// Coefficients of the low pass, with unit gain at 0 Hz.
fn low_pass() -> [f64; TAPS] {
    let middle = 0.5 * (TAPS as f64 - 1.0);
    let mut taps = std::array::from_fn(|i| {
        let x = 2.0 * PI * CORNER * (i as f64 - middle);
        let hann = 0.5 - 0.5 * cos(2.0 * PI * (i as f64 + 0.5) / TAPS as f64);
        hann * sin(x) / x
    });
    let sum: f64 = taps.iter().sum();
    taps.iter_mut().for_each(|tap| *tap /= sum);
    taps
}

/// Decimator from 48 kHz to 16 kHz.
#[derive(Clone)]
pub struct Decimator {
    taps: [f64; TAPS],
    history: [f64; TAPS],
}

impl Decimator {
    /// A converter in silence.
    pub fn new() -> Self {
        Self { taps: low_pass(), history: [0.0; TAPS] }
    }

    /// Converts a block to a third as many samples; its length must be a multiple of three.
    pub fn convert(&mut self, fine: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut out = Vec::new();
        for (i, x) in fine.enumerate() {
            self.history.rotate_right(1);
            self.history[0] = x;
            if i % RATIO == RATIO - 1 {
                out.push(self.taps.iter().zip(&self.history).map(|(tap, x)| tap * x).sum());
            }
        }
        out
    }
}

/// Interpolator from 16 kHz to 48 kHz.
#[derive(Clone)]
pub struct Interpolator {
    taps: [f64; TAPS],
    history: [f64; TAPS / RATIO],
}

impl Interpolator {
    /// A converter in silence.
    pub fn new() -> Self {
        Self { taps: low_pass(), history: [0.0; TAPS / RATIO] }
    }

    /// Converts a block to three times as many samples.
    pub fn convert(&mut self, coarse: impl Iterator<Item = f64>) -> Vec<f64> {
        let mut out = Vec::new();
        for x in coarse {
            self.history.rotate_right(1);
            self.history[0] = x;
            for phase in 0..RATIO {
                let taps = self.taps.iter().skip(phase).step_by(RATIO);
                out.push(RATIO as f64 * taps.zip(&self.history).map(|(tap, x)| tap * x).sum::<f64>());
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tone_survives_both_directions_and_aliasing_is_removed() {
        // Ripple of the window, and the corner's slope at 1 kHz.
        const RIPPLE: f64 = 0.01;
        // Beyond the corner by a third of an octave and more.
        const STOPPED: f64 = 0.01;
        let tone = |hz: f64| (0..4800).map(move |i| sin(2.0 * PI * hz * f64::from(i) / 48_000.0));
        let rms = |samples: &[f64]| {
            let settled = &samples[samples.len() / 4..];
            (settled.iter().map(|x| x * x).sum::<f64>() / settled.len() as f64).sqrt()
        };
        let half = 0.5_f64.sqrt();
        let coarse = Decimator::new().convert(tone(1000.0));
        assert_eq!(coarse.len(), 1600);
        assert!((rms(&coarse) / half - 1.0).abs() < RIPPLE, "{}", rms(&coarse));
        let fine = Interpolator::new().convert(coarse.into_iter());
        assert_eq!(fine.len(), 4800);
        assert!((rms(&fine) / half - 1.0).abs() < RIPPLE, "{}", rms(&fine));
        assert!(rms(&Decimator::new().convert(tone(10_000.0))) < STOPPED * half);
    }
}

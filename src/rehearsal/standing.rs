//! How far a breath stands above the house: told beside each visit, so that a breath that was not heard can be told from one
//! that nobody could have heard.
//!
//! ```text
//! s_B = 10 lg Σ_B |B_k|² / Σ_B |H_k|²     B, H: spectra of the breath's first 0.3 s, and of all else in that time, under Hann's window
//! ```
//!
//! in the two bands that the ear lives by, the rumble of 31–203 Hz and the hiss of 406–3400 Hz. Both as the air brings them to
//! the first capsule, before it adds its corner and its noise. Two capsules hear rumble that lies below the house, down to what
//! they have in common of it; hiss they both hear the same.

use realfft::{RealFftPlanner, num_complex::Complex};

use super::judge::{FPS, SOON};
use crate::math::{PI, cos, decibels};
use crate::offline::ear::RATE;

/// Bands, Hz: rumble, hiss.
const BANDS_HZ: [(f64, f64); 2] = [(31.0, 203.0), (406.0, 3400.0)];
/// What is looked at: as much as there is to be seen of an answer in time.
const SAMPLES: usize = RATE as usize * SOON / FPS as usize;
/// Keeps quotients finite.
const NOTHING: f64 = 1e-30;

/// What arrives from an onset on, of breath and of all else.
#[derive(Clone, Debug, Default)]
pub struct Standing {
    /// First sample.
    from: u64,
    breath: Vec<f64>,
    rest: Vec<f64>,
}

impl Standing {
    /// Nothing yet, from a time of the day on, s.
    pub fn at(onset: f64) -> Self {
        let from = (onset * f64::from(RATE)).round().max(0.0) as u64;
        Self { from, ..Self::default() }
    }

    /// Takes in a block that begins at a sample of the day: what of it is breath, and all else.
    pub fn hear(&mut self, begins: u64, breath: &[f64], rest: &[f64]) {
        let skipped = self.from.saturating_sub(begins).min(breath.len() as u64) as usize;
        let room = SAMPLES - self.breath.len();
        self.breath.extend(breath[skipped..].iter().take(room));
        self.rest.extend(rest[skipped..].iter().take(room));
    }

    /// s of rumble and of hiss, dB; `None` before all of it is there.
    pub fn above_db(&self) -> Option<[f64; 2]> {
        if self.breath.len() < SAMPLES {
            return None;
        }
        let (breath, rest) = (spectrum(&self.breath), spectrum(&self.rest));
        let power = |spectrum: &[Complex<f64>], (low, high): (f64, f64)| {
            let bin = |hz: f64| (hz * SAMPLES as f64 / f64::from(RATE)).round() as usize;
            spectrum[bin(low)..bin(high)].iter().map(Complex::norm_sqr).sum::<f64>() + NOTHING
        };
        Some(BANDS_HZ.map(|band| 0.5 * decibels(power(&breath, band) / power(&rest, band))))
    }
}

fn spectrum(samples: &[f64]) -> Vec<Complex<f64>> {
    let transform = RealFftPlanner::new().plan_fft_forward(samples.len());
    let hann = |i: usize| 0.5 - 0.5 * cos(2.0 * PI * i as f64 / samples.len() as f64);
    let mut windowed: Vec<f64> = samples.iter().enumerate().map(|(i, x)| hann(i) * x).collect();
    let mut out = transform.make_output_vec();
    // Lengths agree by construction.
    if transform.process(&mut windowed, &mut out).is_err() {
        debug_assert!(false, "spectrum and samples differ in length");
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::noise::Random;
    use crate::wind::generate::filter::white;

    #[test]
    fn it_tells_how_far_one_noise_lies_above_another() {
        // Powers of a few dozen bins of noise scatter by this much, dB.
        const SCATTER_DB: f64 = 2.5;
        let mut random = Random::new(7);
        let (breath, rest) = (white(2 * SAMPLES, &mut random), white(2 * SAMPLES, &mut random));
        let quiet: Vec<f64> = rest.iter().map(|x| 0.1 * x).collect();
        let mut standing = Standing::at(0.05);
        // It begins amid a block.
        for (k, (breath, rest)) in breath.chunks(160).zip(quiet.chunks(160)).enumerate() {
            assert!(standing.above_db().is_none() || 160 * k >= SAMPLES);
            standing.hear(160 * k as u64, breath, rest);
        }
        for above in standing.above_db().expect("all is there") {
            assert!((above - 20.0).abs() < SCATTER_DB, "{above} dB");
        }
    }
}

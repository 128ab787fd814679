//! How far a breath stands above the house: told beside each visit, so that a breath that was not heard can be told from one
//! that nobody could have heard.
//!
//! ```text
//! s_B = 10 lg Σ_B |B_k|² / Σ_B |H_k|²     B, H: spectra of the breath's first 0.3 s, and of all else in that time, under Hann's window
//! ```
//!
//! in the two bands that the ear lives by, the rumble of 31–203 Hz and the hiss of 406–3400 Hz. Both as the air brings them to
//! the first capsule, before it adds its corner and its noise. Two capsules hear rumble that lies below the house, as far as that
//! is the same at both: so the rumble of their difference is told as well. Hiss they both hear the same.

use serde::Serialize;
use soffio_fourier::{Complex, real_forward};

use super::judge::{FPS, SOON};
use soffio_math::{PI, cos, decibels};
use soffio_soundscape::RATE;

/// Bands, Hz.
const RUMBLE_HZ: (f64, f64) = (31.0, 203.0);
const HISS_HZ: (f64, f64) = (406.0, 3400.0);
/// What is looked at: as much as there is to be seen of an answer in time.
const SAMPLES: usize = RATE as usize * SOON / FPS as usize;
/// Keeps quotients finite.
const NOTHING: f64 = 1e-30;

/// How far a breath stands above all else, dB.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Above {
    /// Rumble at the first capsule.
    pub rumble: f64,
    /// Hiss at the first capsule.
    pub hiss: f64,
    /// Rumble of what differs between two capsules; null where there is one.
    pub difference: Option<f64>,
}

/// What arrives from an onset on: of breath, and of all else.
#[derive(Clone, Debug, Default)]
struct Arrived {
    breath: Vec<f64>,
    rest: Vec<f64>,
}

/// What arrives at each capsule from an onset on.
#[derive(Clone, Debug, Default)]
pub struct Standing {
    /// First sample.
    from: u64,
    capsules: Vec<Arrived>,
}

impl Standing {
    /// Nothing yet, from a time of the day on, s.
    pub fn at(onset: f64) -> Self {
        let from = (onset * f64::from(RATE)).round().max(0.0) as u64;
        Self { from, ..Self::default() }
    }

    /// Takes in a block of a capsule, the first is 0, that begins at a sample of the day: what of it is breath, and all else.
    pub fn hear(&mut self, capsule: usize, begins: u64, breath: &[f64], rest: &[f64]) {
        if self.capsules.len() <= capsule {
            self.capsules.resize_with(capsule + 1, Arrived::default);
        }
        let arrived = &mut self.capsules[capsule];
        let skipped = self.from.saturating_sub(begins).min(breath.len() as u64) as usize;
        let room = SAMPLES - arrived.breath.len();
        arrived.breath.extend(breath[skipped..].iter().take(room));
        arrived.rest.extend(rest[skipped..].iter().take(room));
    }

    /// s of rumble, of hiss and of what differs; `None` before all of it is there.
    pub fn above_db(&self) -> Option<Above> {
        let all_there = self.capsules.iter().all(|arrived| arrived.breath.len() == SAMPLES);
        let first = self.capsules.first().filter(|_| all_there)?;
        let difference = |second: &Arrived| {
            let of = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<f64>>();
            above(&of(&first.breath, &second.breath), &of(&first.rest, &second.rest), RUMBLE_HZ)
        };
        let [rumble, hiss] = [RUMBLE_HZ, HISS_HZ].map(|band| above(&first.breath, &first.rest, band));
        Some(Above { rumble, hiss, difference: self.capsules.get(1).map(difference) })
    }
}

/// s_B, dB.
fn above(breath: &[f64], rest: &[f64], (low, high): (f64, f64)) -> f64 {
    let bin = |hz: f64| (hz * SAMPLES as f64 / f64::from(RATE)).round() as usize;
    let power =
        |samples: &[f64]| spectrum(samples)[bin(low)..bin(high)].iter().map(Complex::norm_sqr).sum::<f64>() + NOTHING;
    0.5 * decibels(power(breath) / power(rest))
}

fn spectrum(samples: &[f64]) -> Vec<Complex<f64>> {
    let transform = real_forward(samples.len());
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
    use soffio_detector::generate::filter::white;
    use soffio_math::noise::Random;

    #[test]
    fn it_tells_how_far_a_breath_lies_above_the_house_and_what_differs_of_it_above_what_differs_of_the_house() {
        // Powers of a few dozen bins of noise scatter by this much, dB.
        const SCATTER_DB: f64 = 2.5;
        let mut random = Random::new(7);
        let mut noise = |gain: f64| -> Vec<f64> { white(2 * SAMPLES, &mut random).iter().map(|x| gain * x).collect() };
        // Two breaths that know nothing of each other, and a house that is nearly the same at both.
        let (house, own) = (noise(0.1), noise(0.001));
        let second: Vec<f64> = house.iter().zip(&own).map(|(x, y)| x + y).collect();
        let capsules = [(noise(1.0), house), (noise(1.0), second)];
        let mut standing = Standing::at(0.05);
        // It begins amid a block.
        for from in (0..2 * SAMPLES).step_by(160) {
            assert!(standing.above_db().is_none() || from >= SAMPLES);
            for (number, (breath, rest)) in capsules.iter().enumerate() {
                standing.hear(number, from as u64, &breath[from..from + 160], &rest[from..from + 160]);
            }
        }
        let Above { rumble, hiss, difference } = standing.above_db().expect("all is there");
        for (above, expected) in [(Some(rumble), 20.0), (Some(hiss), 20.0), (difference, 63.0)] {
            assert!(above.is_some_and(|above| (above - expected).abs() < SCATTER_DB), "{above:?} dB, not {expected}");
        }
    }
}

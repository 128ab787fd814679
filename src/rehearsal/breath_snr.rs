//! Signal-to-noise ratio (SNR) of a breath at the microphone. It shows whether a missed breath could be detected at all.
//!
//! ```text
//! s_B = 10 lg Σ_B |B_k|² / Σ_B |H_k|²     B, H: spectra of the breath's first 0.3 s, and of all other sound in that time, with a Hann window
//! ```
//!
//! The bands are those of the detector: rumble of 31–203 Hz and hiss of 406–3400 Hz. Both are taken in the air at the first capsule,
//! before its corner and its noise. Two capsules can detect rumble below the crowd's, where the crowd's is the same at both. So the
//! SNR of the rumble of their difference is given as well; hiss is the same at both.

use serde::Serialize;
use soffio_fourier::{Complex, real_forward};

use super::scorer::{FPS, SOON};
use soffio_math::{PI, amplitude_to_db, cos};
use soffio_soundscape::RATE;

/// Band of the rumble, Hz.
const RUMBLE_HZ: (f64, f64) = (31.0, 203.0);
/// Band of the hiss, Hz.
const HISS_HZ: (f64, f64) = (406.0, 3400.0);
/// Length of the analysis, samples: 0.3 s, the time in which a response counts.
const SAMPLES: usize = RATE as usize * SOON / FPS as usize;
/// Keeps quotients finite.
const EPSILON: f64 = 1e-30;

/// Signal-to-noise ratio of a breath, dB.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct BreathSnr {
    /// Rumble at the first capsule.
    pub rumble: f64,
    /// Hiss at the first capsule.
    pub hiss: f64,
    /// Rumble of the difference of two capsules; null with one capsule.
    pub difference: Option<f64>,
}

/// Breath and other sound at one capsule.
#[derive(Clone, Debug, Default)]
struct Channel {
    breath: Vec<f64>,
    rest: Vec<f64>,
}

/// Meter of the signal-to-noise ratio after an onset.
#[derive(Clone, Debug, Default)]
pub struct SnrMeter {
    /// First sample.
    from: u64,
    channels: Vec<Channel>,
}

impl SnrMeter {
    /// A meter that starts at a time of the day, s.
    pub fn at(onset: f64) -> Self {
        let from = (onset * f64::from(RATE)).round().max(0.0) as u64;
        Self { from, ..Self::default() }
    }

    /// Takes a block of a capsule (the first is 0) that begins at the sample `begins` of the day: its breath, and all other sound.
    pub fn push(&mut self, capsule: usize, begins: u64, breath: &[f64], rest: &[f64]) {
        if self.channels.len() <= capsule {
            self.channels.resize_with(capsule + 1, Channel::default);
        }
        let channel = &mut self.channels[capsule];
        let skipped = self.from.saturating_sub(begins).min(breath.len() as u64) as usize;
        let missing = SAMPLES - channel.breath.len();
        channel.breath.extend(breath[skipped..].iter().take(missing));
        channel.rest.extend(rest[skipped..].iter().take(missing));
    }

    /// The signal-to-noise ratio; `None` before all samples have arrived.
    pub fn snr_db(&self) -> Option<BreathSnr> {
        let is_complete = self.channels.iter().all(|channel| channel.breath.len() == SAMPLES);
        let first = self.channels.first().filter(|_| is_complete)?;
        let difference = |second: &Channel| {
            let of = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a - b).collect::<Vec<f64>>();
            band_snr_db(&of(&first.breath, &second.breath), &of(&first.rest, &second.rest), RUMBLE_HZ)
        };
        let [rumble, hiss] = [RUMBLE_HZ, HISS_HZ].map(|band| band_snr_db(&first.breath, &first.rest, band));
        Some(BreathSnr { rumble, hiss, difference: self.channels.get(1).map(difference) })
    }
}

/// s_B, the signal-to-noise ratio in a band, dB.
fn band_snr_db(breath: &[f64], rest: &[f64], (low, high): (f64, f64)) -> f64 {
    let bin = |hz: f64| (hz * SAMPLES as f64 / f64::from(RATE)).round() as usize;
    let power =
        |samples: &[f64]| spectrum(samples)[bin(low)..bin(high)].iter().map(Complex::norm_sqr).sum::<f64>() + EPSILON;
    0.5 * amplitude_to_db(power(breath) / power(rest))
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
    use soffio_math::noise::Random;
    use soffio_soundscape::filters::white;

    #[test]
    fn it_measures_a_breath_in_a_crowd_and_the_difference_of_both() {
        // Scatter of the power of a few dozen bins of noise.
        const SCATTER_DB: f64 = 2.5;
        let mut random = Random::new(7);
        let mut noise = |gain: f64| -> Vec<f64> { white(2 * SAMPLES, &mut random).iter().map(|x| gain * x).collect() };
        // Two uncorrelated breaths, and a crowd that is nearly the same at both capsules.
        let (crowd, own) = (noise(0.1), noise(0.001));
        let second: Vec<f64> = crowd.iter().zip(&own).map(|(x, y)| x + y).collect();
        let capsules = [(noise(1.0), crowd), (noise(1.0), second)];
        let mut meter = SnrMeter::at(0.05);
        // The onset lies within a block.
        for from in (0..2 * SAMPLES).step_by(160) {
            assert!(meter.snr_db().is_none() || from >= SAMPLES);
            for (number, (breath, rest)) in capsules.iter().enumerate() {
                meter.push(number, from as u64, &breath[from..from + 160], &rest[from..from + 160]);
            }
        }
        let BreathSnr { rumble, hiss, difference } = meter.snr_db().expect("all samples");
        for (snr, expected) in [(Some(rumble), 20.0), (Some(hiss), 20.0), (difference, 63.0)] {
            assert!(snr.is_some_and(|snr| (snr - expected).abs() < SCATTER_DB), "{snr:?} dB, not {expected}");
        }
    }
}

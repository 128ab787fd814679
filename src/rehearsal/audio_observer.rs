//! Audio observer: detects the sound of wind in the loudspeaker's output, by the median of its power spectrum.
//!
//! Only wind counts, not the parts that it makes sound: dozens of moons that strike each other, with their reverberation, are as dense
//! as noise. So the observer analyses the difference between the loudspeaker's output and its output in still air.
//!
//! Wind is noise, while vibrating bodies make tones; and it is sustained, while a click is short. The median of a band's power
//! spectrum ignores tones, since they fill few of its bins. Noise of mean power p per bin has the median p ln 2 (its powers are
//! exponentially distributed):
//!
//! ```text
//! noise = median / ln 2 · bins                 wind = noise above −60 dB of full scale in 6 of 7 frames in a row
//! ```
//!
//! Frames are 43 ms long and overlap by half. The wind of a gentle breath lies at −50 dB, that of a strong one at −30 dB.

use std::sync::Arc;

use soffio_fourier::{RealToComplex, real_forward};

use super::blocks::SAMPLE_RATE_HZ;
use soffio_math::{PI, cos, db_to_amplitude};

/// Length of a frame, samples.
const FRAME: usize = 2048;
/// Distance between frames, samples.
const HOP: usize = 1024;
/// Band in which wind is strongest, Hz.
const BAND_HZ: (f64, f64) = (150.0, 800.0);
/// Level from which noise counts as wind, dB of full scale.
const WIND_DBFS: f64 = -60.0;
/// Length of a wind, frames.
const LASTS: u32 = 7;
/// Number of these frames that may be without wind.
const OTHERWISE: u32 = 1;
/// Share of the power that a Hann window keeps.
const HANN: f64 = 0.375;

/// Detector of wind in the loudspeaker's output.
pub struct AudioObserver {
    transform: Arc<dyn RealToComplex<f64>>,
    window: Vec<f64>,
    pending: Vec<f64>,
    /// One bit per frame, the newest lowest: 1 for wind.
    frames: u32,
    is_wind: bool,
    /// Number of samples so far.
    sample: u64,
}

impl AudioObserver {
    /// An observer in silence.
    pub fn new() -> Self {
        let hann = |i: usize| 0.5 - 0.5 * cos(2.0 * PI * i as f64 / FRAME as f64);
        Self {
            transform: real_forward(FRAME),
            window: (0..FRAME).map(hann).collect(),
            pending: vec![0.0; FRAME - HOP],
            frames: 0,
            is_wind: false,
            sample: 0,
        }
    }

    /// Takes a block (stereo) and the same block in still air; returns the times at which wind begins, s.
    pub fn push(&mut self, played: &[f32], still: &[f32]) -> Vec<f64> {
        let mut begins = Vec::new();
        for ([left, right], [l, r]) in played.as_chunks::<2>().0.iter().zip(still.as_chunks::<2>().0) {
            self.pending.push(0.5 * (f64::from(*left) - f64::from(*l) + f64::from(*right) - f64::from(*r)));
            self.sample += 1;
            if self.pending.len() == FRAME {
                let loud = db_to_amplitude(WIND_DBFS);
                self.frames = self.frames << 1 | u32::from(self.noise() > loud * loud);
                self.pending.drain(..HOP);
                let last = self.frames & ((1 << LASTS) - 1);
                let is_wind = last.count_ones() + OTHERWISE >= LASTS || self.is_wind && last != 0;
                if is_wind && !self.is_wind {
                    let frames = (32 - last.leading_zeros()).saturating_sub(1) as usize;
                    let began = self.sample.saturating_sub((FRAME + frames * HOP) as u64);
                    begins.push(began as f64 / f64::from(SAMPLE_RATE_HZ));
                }
                self.is_wind = is_wind;
            }
        }
        begins
    }

    /// Power of the noise in the band, full scale 1.
    fn noise(&self) -> f64 {
        let mut frame: Vec<f64> = self.pending.iter().zip(&self.window).map(|(x, w)| x * w).collect();
        let mut spectrum = self.transform.make_output_vec();
        // Lengths agree by construction.
        if self.transform.process(&mut frame, &mut spectrum).is_err() {
            return 0.0;
        }
        let bin = |hz: f64| (hz * FRAME as f64 / f64::from(SAMPLE_RATE_HZ)).round() as usize;
        let mut band: Vec<f64> = spectrum[bin(BAND_HZ.0)..bin(BAND_HZ.1)].iter().map(|z| z.norm_sqr()).collect();
        band.sort_by(f64::total_cmp);
        let mean = band[band.len() / 2] / std::f64::consts::LN_2;
        // Parseval; half of the power lies at negative frequencies.
        2.0 * mean * band.len() as f64 / (HANN * FRAME as f64 * FRAME as f64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_math::noise::Random;
    use soffio_math::{exp, sin};
    use soffio_soundscape::filters::{gaussian, low_passed, normalised};

    const RATE: f64 = SAMPLE_RATE_HZ as f64;

    fn begins(sound: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        begins_beside(sound, |_, _| 0.0)
    }

    /// Times at which wind begins, given the sound in still air.
    fn begins_beside(sound: impl Fn(f64, f64) -> f64, still: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        let noise = normalised(low_passed(gaussian(8 * SAMPLE_RATE_HZ as usize, &mut Random::new(2)), RATE, 400.0, 1));
        let mut observer = AudioObserver::new();
        let stereo = |sound: &dyn Fn(f64, f64) -> f64| -> Vec<f32> {
            let samples = noise.iter().enumerate().map(|(i, n)| sound(i as f64 / RATE, *n) as f32);
            samples.flat_map(|x| [x, x]).collect()
        };
        let (played, still) = (stereo(&sound), stereo(&still));
        played.chunks(960).zip(still.chunks(960)).flat_map(|(block, still)| observer.push(block, still)).collect()
    }

    #[test]
    fn sound_as_dense_as_noise_is_no_wind_and_wind_in_it_is_detected() {
        let ringing = |t: f64, n: f64| 0.01 * n * exp(-(t - 1.0).max(0.0) / 2.0);
        assert!(!begins(ringing).is_empty(), "alone it resembles wind");
        assert!(begins_beside(ringing, ringing).is_empty(), "it would sound in still air too");
        let gust = |t: f64| if (5.0..6.0).contains(&t) { 0.004 } else { 0.0 };
        let begins = begins_beside(|t, n| ringing(t, n) + gust(t) * n, ringing);
        assert_eq!(begins.len(), 1, "{begins:?}");
        assert!((begins[0] - 5.0).abs() < 0.05, "{begins:?}");
    }

    #[test]
    fn wind_is_detected_when_it_begins_and_chimes_and_clicks_are_not() {
        /// Length of a frame, s.
        const ABOUT: f64 = 0.05;
        let chime = |t: f64| [523.0, 1444.0, 2830.0].iter().map(|f| 0.1 * sin(2.0 * PI * f * t)).sum::<f64>();
        assert!(begins(|t, _| chime(t)).is_empty(), "a chime");
        let click = |t: f64, n: f64| 0.3 * n * exp(-(t % 1.0) / 0.01);
        assert!(begins(click).is_empty(), "clicks");
        let gust = |t: f64| if (2.0..3.0).contains(&t) || (5.0..5.4).contains(&t) { 0.004 } else { 0.0 };
        for (name, begins) in
            [("alone", begins(|t, n| gust(t) * n)), ("in a chime", begins(|t, n| gust(t) * n + chime(t)))]
        {
            assert_eq!(begins.len(), 2, "{name}: {begins:?}");
            assert!((begins[0] - 2.0).abs() < ABOUT && (begins[1] - 5.0).abs() < ABOUT, "{name}: {begins:?}");
        }
    }
}

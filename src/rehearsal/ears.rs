//! What an onlooker hears of an answer: the rushing of wind, in what leaves the loudspeaker.
//!
//! Only wind counts, and not what the wind has set ringing: dozens of moons that strike each other, and the room in which they
//! ring on, are as dense as noise. So what is listened to is what the loudspeaker plays beyond what it would play in still air.
//!
//! A breath that is answered is heard as wind: noise, where what rings is tones, and lasting, where a click is
//! over at once. The median of a band's power spectrum knows no tones, since they fill few of its bins. Noise of mean power
//! p a bin has the median p ln 2 (its powers are exponentially distributed), so
//!
//! ```text
//! noise = median / ln 2 · bins                 wind = noise above −60 dB of full scale in 6 of 7 frames in a row
//! ```
//!
//! with frames of 43 ms, half of each new. A gentle breath's wind lies at −50 dB, a strong one's at −30 dB.

use std::sync::Arc;

use soffio_fourier::{RealToComplex, real_forward};

use super::blocks::SAMPLE_RATE_HZ;
use soffio_math::{PI, cos, from_decibels};

/// Samples of a frame, and how many are new.
const FRAME: usize = 2048;
const HOP: usize = 1024;
/// The band in which wind rushes most, Hz.
const BAND_HZ: (f64, f64) = (150.0, 800.0);
/// Noise from here on is heard as wind, dB of full scale.
const WIND_DBFS: f64 = -60.0;
/// So many frames in a row, of which one may be otherwise.
const LASTS: u32 = 7;
const OTHERWISE: u32 = 1;
/// A Hann window keeps this part of the power.
const HANN: f64 = 0.375;

/// The onlooker's ears.
pub struct Ears {
    transform: Arc<dyn RealToComplex<f64>>,
    window: Vec<f64>,
    waiting: Vec<f64>,
    /// The last frames, the newest in the lowest bit: was it wind?
    frames: u32,
    rushes: bool,
    /// Samples heard.
    sample: u64,
}

impl Ears {
    /// In silence.
    pub fn new() -> Self {
        let hann = |i: usize| 0.5 - 0.5 * cos(2.0 * PI * i as f64 / FRAME as f64);
        Self {
            transform: real_forward(FRAME),
            window: (0..FRAME).map(hann).collect(),
            waiting: vec![0.0; FRAME - HOP],
            frames: 0,
            rushes: false,
            sample: 0,
        }
    }

    /// Hears a block (stereo) beside the one that would be played in still air. The times at which wind begins to rush, s.
    pub fn hear(&mut self, played: &[f32], still: &[f32]) -> Vec<f64> {
        let mut begins = Vec::new();
        for ([left, right], [l, r]) in played.as_chunks::<2>().0.iter().zip(still.as_chunks::<2>().0) {
            self.waiting.push(0.5 * (f64::from(*left) - f64::from(*l) + f64::from(*right) - f64::from(*r)));
            self.sample += 1;
            if self.waiting.len() == FRAME {
                let loud = from_decibels(WIND_DBFS);
                self.frames = self.frames << 1 | u32::from(self.noise() > loud * loud);
                self.waiting.drain(..HOP);
                let last = self.frames & ((1 << LASTS) - 1);
                let rushes = last.count_ones() + OTHERWISE >= LASTS || self.rushes && last != 0;
                if rushes && !self.rushes {
                    let frames = (32 - last.leading_zeros()).saturating_sub(1) as usize;
                    let began = self.sample.saturating_sub((FRAME + frames * HOP) as u64);
                    begins.push(began as f64 / f64::from(SAMPLE_RATE_HZ));
                }
                self.rushes = rushes;
            }
        }
        begins
    }

    /// Power of the noise in the band, full scale 1.
    fn noise(&self) -> f64 {
        let mut frame: Vec<f64> = self.waiting.iter().zip(&self.window).map(|(x, w)| x * w).collect();
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
    use soffio_detector::generate::filter::{gaussian, low_passed, normalised};
    use soffio_math::noise::Random;
    use soffio_math::{exp, sin};

    const RATE: f64 = SAMPLE_RATE_HZ as f64;

    fn begins(sound: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        begins_beside(sound, |_, _| 0.0)
    }

    /// The same, beside what would be played in still air.
    fn begins_beside(sound: impl Fn(f64, f64) -> f64, still: impl Fn(f64, f64) -> f64) -> Vec<f64> {
        let noise = normalised(low_passed(gaussian(8 * SAMPLE_RATE_HZ as usize, &mut Random::new(2)), RATE, 400.0, 1));
        let mut ears = Ears::new();
        let stereo = |sound: &dyn Fn(f64, f64) -> f64| -> Vec<f32> {
            let samples = noise.iter().enumerate().map(|(i, n)| sound(i as f64 / RATE, *n) as f32);
            samples.flat_map(|x| [x, x]).collect()
        };
        let (played, still) = (stereo(&sound), stereo(&still));
        played.chunks(960).zip(still.chunks(960)).flat_map(|(block, still)| ears.hear(block, still)).collect()
    }

    #[test]
    fn what_rings_as_dense_as_noise_is_no_wind_and_wind_in_it_is_heard() {
        let ringing = |t: f64, n: f64| 0.01 * n * exp(-(t - 1.0).max(0.0) / 2.0);
        assert!(!begins(ringing).is_empty(), "by itself nothing tells it from wind");
        assert!(begins_beside(ringing, ringing).is_empty(), "it would ring in still air too");
        let gust = |t: f64| if (5.0..6.0).contains(&t) { 0.004 } else { 0.0 };
        let heard = begins_beside(|t, n| ringing(t, n) + gust(t) * n, ringing);
        assert_eq!(heard.len(), 1, "{heard:?}");
        assert!((heard[0] - 5.0).abs() < 0.05, "{heard:?}");
    }

    #[test]
    fn wind_is_heard_when_it_begins_and_chimes_and_clicks_are_not() {
        /// A frame before, a frame after.
        const ABOUT: f64 = 0.05;
        let chime = |t: f64| [523.0, 1444.0, 2830.0].iter().map(|f| 0.1 * sin(2.0 * PI * f * t)).sum::<f64>();
        assert!(begins(|t, _| chime(t)).is_empty(), "a chime");
        let click = |t: f64, n: f64| 0.3 * n * exp(-(t % 1.0) / 0.01);
        assert!(begins(click).is_empty(), "clicks");
        let gust = |t: f64| if (2.0..3.0).contains(&t) || (5.0..5.4).contains(&t) { 0.004 } else { 0.0 };
        for (name, heard) in
            [("alone", begins(|t, n| gust(t) * n)), ("in a chime", begins(|t, n| gust(t) * n + chime(t)))]
        {
            assert_eq!(heard.len(), 2, "{name}: {heard:?}");
            assert!((heard[0] - 2.0).abs() < ABOUT && (heard[1] - 5.0).abs() < ABOUT, "{name}: {heard:?}");
        }
    }
}

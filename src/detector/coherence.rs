//! Magnitude coherence of two capsules: a breath near by is one coherent wave, a crowd's noise is diffuse.
//!
//! An off-axis breath reaches the microphone only as broadband noise, as applause, rain, paper and crowds do. But lips are about
//! 10 cm away, well within the critical distance of the room (0.057 √(V/T60), Kuttruff, *Room Acoustics*: a metre in the gallery).
//! So both capsules receive the same direct wave:
//!
//! ```text
//! C = Σ_B |Σ_{k∈B} ⟨L_k R*_k⟩|        γ = C / Σ_B √(Σ_{k∈B} ⟨|L_k|²⟩ Σ_{k∈B} ⟨|R_k|²⟩)        bands B of 172 Hz, ⟨·⟩ of 64 ms
//! ```
//!
//! The sums go over regions of the spectrum. γ is 1 for a single wave from any direction: across one band the 6 cm between capsules
//! turn its phase by at most a thirtieth of a turn. A diffuse field leaves sin(k d)/(k d) (at 2.7 kHz 0.25 for 5 cm, 0.67 for 3 cm)
//! and a few tenths by chance. C is the coherent power. For a crowd it is some decibels below the total power, and the hiss of lips
//! rises above it by as much more.

use soffio_fourier::Complex;

use super::dual_mic::CrossSpectrum;
use super::features::{MIN_FLOOR, RESIDUE, blend, power_to_db};
use super::noise_floor::FloorWeights;
use super::spectrum::{BINS, Power};

/// Bins of a band.
pub const BAND_WIDTH: usize = 11;
/// First bin (406 Hz) and last bands of the regions below 4 kHz: 406–922 Hz, to 1.95 kHz, to 3.4 kHz.
pub const LOW_SUBBAND: (usize, [usize; 3]) = (26, [3, 9, 17]);
/// Time constant of the spectra, s.
const MEMORY_S: f64 = 0.064;
/// Keeps quotients finite.
const EPSILON: f64 = 1e-30;

/// Coherence of two capsules in several regions of the spectrum.
#[derive(Clone, Debug)]
pub struct Coherence<const REGIONS: usize> {
    first: usize,
    /// Number of bands before the end of each region.
    ends: [usize; REGIONS],
    bins: Vec<CrossSpectrum>,
    /// Noise floor of the coherent power.
    noise_floor: [f64; REGIONS],
    learnt: u64,
    /// 1 − γ of each region.
    pub decorrelation: [f64; REGIONS],
    /// Rise of the coherent power over its noise floor, dB.
    pub rise_db: [f64; REGIONS],
}

impl<const REGIONS: usize> Coherence<REGIONS> {
    /// No coherence yet, over regions given by their first bin and the number of bands before each one's end.
    pub fn new((first, ends): (usize, [usize; REGIONS])) -> Self {
        let bands = ends.last().map_or(0, |end| *end);
        Self {
            first,
            ends,
            bins: vec![CrossSpectrum::default(); BAND_WIDTH * bands],
            noise_floor: [0.0; REGIONS],
            learnt: 0,
            decorrelation: [1.0; REGIONS],
            rise_db: [0.0; REGIONS],
        }
    }

    /// Takes one frame of both capsules and the power of the echo in it. `scale` converts squared amplitudes to power, and `learn`
    /// is false during a breath.
    pub fn push(&mut self, [l, r]: &[[Complex<f64>; BINS]; 2], echo: &Power, learn: bool, scale: f64) {
        let weight = blend(MEMORY_S);
        self.learnt += u64::from(learn);
        let weights = FloorWeights::nth(self.learnt);
        let mut from = 0;
        for (region, until) in self.ends.into_iter().enumerate() {
            let (mut coherent, mut total) = (0.0, EPSILON);
            for band in from..until {
                let mut sum = CrossSpectrum::default();
                for i in BAND_WIDTH * band..BAND_WIDTH * (band + 1) {
                    self.bins[i].push(weight, l[self.first + i], r[self.first + i]);
                    sum.add(&self.bins[i]);
                }
                coherent += sum.cross.norm();
                total += sum.scale();
            }
            self.decorrelation[region] = (1.0 - coherent / total).max(EPSILON);
            let (power, noise_floor) = (scale * coherent, &mut self.noise_floor[region]);
            let echo = echo[self.first + BAND_WIDTH * from..self.first + BAND_WIDTH * until].iter().sum::<f64>();
            from = until;
            self.rise_db[region] =
                power_to_db(((power - echo).max(0.0) + MIN_FLOOR) / (*noise_floor + RESIDUE * echo + MIN_FLOOR));
            if learn {
                weights.update(noise_floor, power, MIN_FLOOR);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_math::noise::Random;
    use soffio_math::{PI, cos, sin};

    fn noise(random: &mut Random) -> Complex<f64> {
        Complex::new(random.signed(), random.signed())
    }

    /// 1 − γ of the highest region after two seconds.
    fn decorrelation(mut frame: impl FnMut(usize, &mut Random) -> [Complex<f64>; 2]) -> f64 {
        let (mut coherence, mut random) = (Coherence::new(LOW_SUBBAND), Random::new(5));
        for _ in 0..250 {
            let mut pair = [[Complex::default(); BINS]; 2];
            for k in 1..BINS {
                [pair[0][k], pair[1][k]] = frame(k, &mut random);
            }
            coherence.push(&pair, &[0.0; BINS], true, 1.0);
        }
        coherence.decorrelation[2]
    }

    /// A wave from the side: 6 cm later at the second capsule, which is 1.5 dB louder and has some noise of its own.
    fn lips(k: usize, random: &mut Random) -> [Complex<f64>; 2] {
        let (l, late) = (noise(random), 2.0 * PI * 15.625 * k as f64 * 0.06 / 343.0);
        [l, 1.19 * l * Complex::new(cos(late), -sin(late)) + 0.1 * noise(random)]
    }

    /// Noise of which half the power is common to both capsules.
    fn crowd(random: &mut Random) -> [Complex<f64>; 2] {
        let coherent = noise(random);
        [coherent + noise(random), coherent + noise(random)]
    }

    #[test]
    fn lips_are_coherent_and_a_crowd_is_diffuse() {
        let [lips, crowd] = [decorrelation(lips), decorrelation(|_, random| crowd(random))];
        // The noise of the capsule is 0.01 of 1.42; the phase turn within a band costs another hundredth.
        assert!(lips < 0.03, "{lips}");
        assert!((0.3..0.6).contains(&crowd), "{crowd}");
    }

    #[test]
    fn lips_in_a_crowd_rise_above_its_coherent_power() {
        /// Scatter of the crowd's power, dB.
        const SCATTERS: f64 = 2.0;
        let (mut coherence, mut random) = (Coherence::new(LOW_SUBBAND), Random::new(6));
        let mut rise = |blows: bool| {
            let mut mean = 0.0;
            for _ in 0..250 {
                let mut pair = [[Complex::default(); BINS]; 2];
                for k in 1..BINS {
                    let ([l, r], [a, b]) = (crowd(&mut random), lips(k, &mut random));
                    let much = if blows { 2.0 } else { 0.0 };
                    (pair[0][k], pair[1][k]) = (l + much * a, r + much * b);
                }
                coherence.push(&pair, &[0.0; BINS], !blows, 1e-4);
                mean += coherence.rise_db[2] / 250.0;
            }
            mean
        };
        // A crowd of power 2 has a coherent half; lips add 4 to it: 10 lg 5, while the total power rises by 10 lg 3.
        let [_, _, without, with] = [false, false, false, true].map(&mut rise);
        assert!((with - without - 7.0).abs() < SCATTERS, "{with} after {without}");
    }
}

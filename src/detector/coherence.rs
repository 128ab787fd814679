//! Incoherent power of two capsules: the part of each capsule's signal that the other one does not explain.
//!
//! A sound wave reaches both capsules alike, only delayed. Turbulence does not: its eddies are as small as the distance of the
//! capsules, so each capsule has its own. With the cross spectra of a few frames and bins (Bendat and Piersol, *Random Data*,
//! section 6.1):
//!
//! ```text
//! I = ½ (S₁₁ − |S₁₂|²/S₂₂ + S₂₂ − |S₁₂|²/S₁₁) = ½ (S₁₁ + S₂₂) (1 − γ²),   γ² = |S₁₂|²/(S₁₁ S₂₂)
//! ```
//!
//! I does not depend on the capsules' sensitivities, and air at one capsule alone leaves all of its power. γ² of n independent
//! estimates is biased by 1/n, which lowers I of turbulence by a few decibels at most. Bins are summed over no more than 172 Hz: across
//! that width the 10 cm between two capsules turn the phase by a twentieth of a turn.

use soffio_fourier::Complex;

use super::bands::{WIDE, WIDE_EDGES, blend};
use super::spectrum::BINS;

/// Time constant of the cross spectra, s.
const MEMORY_S: f64 = 0.064;
/// Most bins in a sum.
const WIDTH: usize = 11;
/// Keeps quotients finite, power.
const EPSILON: f64 = 1e-30;

/// Averaged auto and cross power of a bin.
#[derive(Clone, Copy, Debug, Default)]
struct CrossSpectrum {
    first: f64,
    second: f64,
    cross: Complex<f64>,
}

/// Cross spectra of two capsules.
#[derive(Clone, Debug)]
pub struct Coherence {
    bins: Vec<CrossSpectrum>,
}

impl Coherence {
    /// Nothing is known yet.
    pub fn new() -> Self {
        Self { bins: vec![CrossSpectrum::default(); BINS] }
    }

    /// Takes one frame of both capsules; returns the incoherent power and 1 − γ² of each wide band. `scale` converts squared amplitudes to
    /// power.
    pub fn push(&mut self, [first, second]: &[[Complex<f64>; BINS]; 2], scale: f64) -> [(f64, f64); WIDE] {
        let weight = blend(MEMORY_S);
        for ((bin, a), b) in self.bins.iter_mut().zip(first).zip(second) {
            bin.first += weight * (a.norm_sqr() - bin.first);
            bin.second += weight * (b.norm_sqr() - bin.second);
            bin.cross += weight * (a * b.conj() - bin.cross);
        }
        std::array::from_fn(|band| {
            let (mut incoherent, mut total) = (0.0, EPSILON);
            for part in self.bins[WIDE_EDGES[band]..WIDE_EDGES[band + 1]].chunks(WIDTH) {
                let mut sum = CrossSpectrum::default();
                for bin in part {
                    sum.first += bin.first;
                    sum.second += bin.second;
                    sum.cross += bin.cross;
                }
                let coherence = sum.cross.norm_sqr() / (sum.first * sum.second).max(EPSILON * EPSILON);
                let power = 0.5 * (sum.first + sum.second);
                incoherent += power * (1.0 - coherence.min(1.0));
                total += power;
            }
            (scale * incoherent, incoherent / total)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_math::noise::Random;
    use soffio_math::{PI, sincos};

    /// Mean incoherent share of each wide band over two seconds.
    fn share(mut frame: impl FnMut(usize, [Complex<f64>; 2]) -> [Complex<f64>; 2]) -> [f64; WIDE] {
        const FRAMES: usize = 250;
        let (mut coherence, mut random) = (Coherence::new(), Random::new(5));
        let mut noise = || Complex::new(random.signed(), random.signed());
        let mut mean = [0.0; WIDE];
        for _ in 0..FRAMES {
            let mut pair = [[Complex::default(); BINS]; 2];
            for k in 1..BINS {
                [pair[0][k], pair[1][k]] = frame(k, [noise(), noise()]);
            }
            let parts = coherence.push(&pair, 1.0);
            mean.iter_mut().zip(parts).for_each(|(mean, part)| *mean += part.1 / FRAMES as f64);
        }
        mean
    }

    #[test]
    fn turbulence_is_incoherent_and_a_wave_is_not_however_the_capsules_differ() {
        // 10 cm between capsules, along the wave; the second one is 6 dB less sensitive.
        let delayed = |k: usize| {
            let (sin, cos) = sincos(-2.0 * PI * 15.625 * k as f64 * 0.1 / 343.0);
            0.5 * Complex::new(cos, sin)
        };
        let wave = share(|k, [sound, _]| [sound, delayed(k) * sound]);
        assert!(wave.iter().all(|share| *share < 0.02), "{wave:.3?}");
        let eddies = share(|_, [one, other]| [one, other]);
        assert!(eddies.iter().all(|share| *share > 0.7), "{eddies:.3?}");
        let at_one_capsule = share(|k, [sound, air]| [sound + 10.0 * air, delayed(k) * sound]);
        assert!(at_one_capsule.iter().all(|share| *share > 0.7), "{at_one_capsule:.3?}");
    }
}

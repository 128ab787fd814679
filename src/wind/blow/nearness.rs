//! Near or far: hiss at the lips is one wave from one place, a crowd's comes from everywhere.
//!
//! A stream beside the microphone is heard by its hiss alone, and so is many another thing: applause, rain, paper, a school class.
//! Lips are a hand's breadth before the microphone, much nearer than the distance at which a room answers as loudly as the source
//! (0.057 √(V/T60), Kuttruff, *Room Acoustics*: a metre in the gallery), so that whatever capsules differ in, they hear the same
//! of it:
//!
//! ```text
//! γ = Σ_B |Σ_{k∈B} ⟨L_k R*_k⟩| / Σ_B √(Σ_{k∈B} ⟨|L_k|²⟩ Σ_{k∈B} ⟨|R_k|²⟩)       bands B of 172 Hz from 2 to 3.4 kHz, ⟨·⟩ of 64 ms
//! ```
//!
//! 1 for one wave, from wherever it comes: over a band's width the 6 cm between capsules turn it by a thirtieth of a turn at the most.
//! Of sound from everywhere sin(k d)/(k d) is left (at 2.7 kHz 0.25 of 5 cm, 0.67 of 3 cm), and a few tenths of chance. What is not the same, 1 − γ, is
//! of the room what it is; of hiss that rises by r dB it is 10^(−r/10) of that at most. It speaks where hiss has risen and rumble
//! has not:
//!
//! ```text
//! ℓ_sum ← ℓ_sum − clamp(0.6 (10 lg (1 − γ) + 12.5), −2, 4)
//! ```

use rustfft::num_complex::Complex;

use super::capsules::{Pair, part};
use super::features::{blend, decibels};
use super::spectrum::BINS;

/// First bin, 2 kHz; bands, and bins of each.
const FIRST: usize = 128;
const BANDS: usize = 8;
const WIDTH: usize = 11;
/// Memory, s.
const MEMORY_S: f64 = 0.064;
/// 1 − γ of which nothing can be said, dB, log-odds for each dB below, and what it may say, against and for.
const NEUTRAL_DB: f64 = -12.5;
const SLOPE_DB: f64 = 0.6;
const SAYS: (f64, f64) = (-4.0, 2.0);
/// Rise of the hiss from which it begins to count, and counts in full, dB; and of the rumble from which it no longer does.
const HISS_DB: (f64, f64) = (6.0, 12.0);
const RUMBLE_DB: (f64, f64) = (4.0, 10.0);
/// Keeps quotients finite.
const NOTHING: f64 = 1e-30;

/// How much of the treble is the same wave at two capsules.
#[derive(Clone, Debug)]
pub struct Nearness {
    bins: [Pair; BANDS * WIDTH],
    /// 1 − γ.
    apart: f64,
}

impl Nearness {
    /// Nothing heard yet.
    pub fn new() -> Self {
        Self { bins: [Pair::default(); BANDS * WIDTH], apart: 1.0 }
    }

    /// Takes one frame of both capsules.
    pub fn push(&mut self, [l, r]: &[[Complex<f64>; BINS]; 2]) {
        let weight = blend(MEMORY_S);
        let (mut same, mut all) = (0.0, NOTHING);
        for (band, bins) in self.bins.chunks_exact_mut(WIDTH).enumerate() {
            let mut sum = Pair::default();
            for (k, pair) in bins.iter_mut().enumerate() {
                let k = FIRST + WIDTH * band + k;
                pair.push(weight, l[k], r[k]);
                sum.add(pair);
            }
            same += sum.cross.norm();
            all += sum.scale();
        }
        self.apart = (1.0 - same / all).max(NOTHING);
    }

    /// What it adds to the log-odds of half the sum, whose hiss and whose rumble have risen so far over the room, dB.
    pub fn of_sum(&self, hiss_db: f64, rumble_db: f64) -> f64 {
        let weight = part(hiss_db, HISS_DB) * (1.0 - part(rumble_db, RUMBLE_DB));
        weight * (SLOPE_DB * (NEUTRAL_DB - decibels(self.apart))).clamp(SAYS.0, SAYS.1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{PI, cos, sin};
    use crate::noise::Random;

    fn noise(random: &mut Random) -> Complex<f64> {
        Complex::new(random.signed(), random.signed())
    }

    /// Log-odds of hiss that has risen by 20 dB, heard for two seconds.
    fn says(mut frame: impl FnMut(usize, &mut Random) -> [Complex<f64>; 2]) -> f64 {
        let (mut nearness, mut random) = (Nearness::new(), Random::new(5));
        for _ in 0..250 {
            let mut pair = [[Complex::default(); BINS]; 2];
            for k in 1..BINS {
                [pair[0][k], pair[1][k]] = frame(k, &mut random);
            }
            nearness.push(&pair);
        }
        assert_eq!(nearness.of_sum(20.0, 15.0), 0.0, "rumble speaks for itself");
        assert_eq!(nearness.of_sum(3.0, 0.0), 0.0, "nothing has risen");
        nearness.of_sum(20.0, 0.0)
    }

    #[test]
    fn one_wave_speaks_for_lips_and_many_speak_against() {
        // From the side, 6 cm later at the second capsule, which is 1.5 dB louder and hisses a little itself.
        let late = |k: usize| 2.0 * PI * 15.625 * k as f64 * 0.06 / 343.0;
        let lips = says(|k, random| {
            let l = noise(random);
            [l, 1.19 * l * Complex::new(cos(late(k)), -sin(late(k))) + 0.1 * noise(random)]
        });
        assert!(lips > 1.0, "{lips}");
        // Half of it is the same.
        let crowd = says(|_, random| {
            let same = noise(random);
            [same + noise(random), same + noise(random)]
        });
        assert!(crowd < -2.0, "{crowd}");
    }
}

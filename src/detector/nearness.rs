//! Near or far: hiss at the lips is one wave from one place, a crowd's comes from everywhere.
//!
//! A stream beside the microphone is heard by its hiss alone, and so is many another thing: applause, rain, paper, a school class.
//! Lips are a hand's breadth before the microphone, much nearer than the distance at which a room answers as loudly as the source
//! (0.057 √(V/T60), Kuttruff, *Room Acoustics*: a metre in the gallery), so that whatever capsules differ in, they hear the same
//! of it:
//!
//! ```text
//! C = Σ_B |Σ_{k∈B} ⟨L_k R*_k⟩|        γ = C / Σ_B √(Σ_{k∈B} ⟨|L_k|²⟩ Σ_{k∈B} ⟨|R_k|²⟩)        bands B of 172 Hz, ⟨·⟩ of 64 ms
//! ```
//!
//! over regions of the treble. γ is 1 for one wave, from wherever it comes: over a band's width the 6 cm between capsules turn
//! it by a thirtieth of a turn at the most. Of sound from everywhere sin(k d)/(k d) is left (at 2.7 kHz 0.25 of 5 cm, 0.67 of 3 cm),
//! and a few tenths of chance. C is the power of what is one wave: a crowd has less of it than of all power by some decibels, and
//! by so much more hiss of lips rises above it.

use soffio_fourier::Complex;

use super::capsules::Pair;
use super::features::{QUIETEST, RESIDUE, blend, decibels};
use super::room::Weight;
use super::spectrum::{BINS, Power};

/// Bins of a band.
pub const WIDTH: usize = 11;
/// First bin of the lower half, 406 Hz; and the bands that end its regions, 406–922 Hz, to 1.95 kHz, to 3.4 kHz.
pub const LOWER: (usize, [usize; 3]) = (26, [3, 9, 17]);
/// Memory, s.
const MEMORY_S: f64 = 0.064;
/// Keeps quotients finite.
const NOTHING: f64 = 1e-30;

/// How much of the treble is the same wave at two capsules, in so many regions.
#[derive(Clone, Debug)]
pub struct Nearness<const REGIONS: usize> {
    first: usize,
    /// Bands before the end of each region.
    ends: [usize; REGIONS],
    bins: Vec<Pair>,
    /// Power that is one wave in a room where nobody blows.
    room: [f64; REGIONS],
    learnt: u64,
    /// 1 − γ of each region.
    pub apart: [f64; REGIONS],
    /// How far what is one wave has risen above the room's, dB.
    pub rise_db: [f64; REGIONS],
}

impl<const REGIONS: usize> Nearness<REGIONS> {
    /// Nothing heard yet of regions that begin at a bin and end after so many bands each.
    pub fn new((first, ends): (usize, [usize; REGIONS])) -> Self {
        let bands = ends.last().map_or(0, |end| *end);
        Self {
            first,
            ends,
            bins: vec![Pair::default(); WIDTH * bands],
            room: [0.0; REGIONS],
            learnt: 0,
            apart: [1.0; REGIONS],
            rise_db: [0.0; REGIONS],
        }
    }

    /// Takes one frame of both capsules, of which `own` is explained by the kiosk itself; `scale` is power of square amplitude,
    /// and `learn` is false while somebody blows.
    pub fn push(&mut self, [l, r]: &[[Complex<f64>; BINS]; 2], own: &Power, learn: bool, scale: f64) {
        let weight = blend(MEMORY_S);
        self.learnt += u64::from(learn);
        let of_room = Weight::nth(self.learnt);
        let mut from = 0;
        for (region, until) in self.ends.into_iter().enumerate() {
            let (mut same, mut all) = (0.0, NOTHING);
            for band in from..until {
                let mut sum = Pair::default();
                for i in WIDTH * band..WIDTH * (band + 1) {
                    self.bins[i].push(weight, l[self.first + i], r[self.first + i]);
                    sum.add(&self.bins[i]);
                }
                same += sum.cross.norm();
                all += sum.scale();
            }
            self.apart[region] = (1.0 - same / all).max(NOTHING);
            let (heard, room) = (scale * same, &mut self.room[region]);
            let own = own[self.first + WIDTH * from..self.first + WIDTH * until].iter().sum::<f64>();
            from = until;
            self.rise_db[region] = decibels(((heard - own).max(0.0) + QUIETEST) / (*room + RESIDUE * own + QUIETEST));
            if learn {
                of_room.learn(room, heard, QUIETEST);
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

    /// 1 − γ of the highest region, heard for two seconds.
    fn apart(mut frame: impl FnMut(usize, &mut Random) -> [Complex<f64>; 2]) -> f64 {
        let (mut nearness, mut random) = (Nearness::new(LOWER), Random::new(5));
        for _ in 0..250 {
            let mut pair = [[Complex::default(); BINS]; 2];
            for k in 1..BINS {
                [pair[0][k], pair[1][k]] = frame(k, &mut random);
            }
            nearness.push(&pair, &[0.0; BINS], true, 1.0);
        }
        nearness.apart[2]
    }

    /// From the side, 6 cm later at the second capsule, which is 1.5 dB louder and hisses a little itself.
    fn lips(k: usize, random: &mut Random) -> [Complex<f64>; 2] {
        let (l, late) = (noise(random), 2.0 * PI * 15.625 * k as f64 * 0.06 / 343.0);
        [l, 1.19 * l * Complex::new(cos(late), -sin(late)) + 0.1 * noise(random)]
    }

    /// Half of it is the same.
    fn crowd(random: &mut Random) -> [Complex<f64>; 2] {
        let same = noise(random);
        [same + noise(random), same + noise(random)]
    }

    #[test]
    fn lips_are_one_wave_and_a_crowd_is_many() {
        let [lips, crowd] = [apart(lips), apart(|_, random| crowd(random))];
        // Its own noise is 0.01 of 1.42, and of a band's width the delay turns away another hundredth.
        assert!(lips < 0.03, "{lips}");
        assert!((0.3..0.6).contains(&crowd), "{crowd}");
    }

    #[test]
    fn lips_amid_a_crowd_rise_above_what_of_it_is_one_wave() {
        /// The crowd's own powers scatter by this much, dB.
        const SCATTERS: f64 = 2.0;
        let (mut nearness, mut random) = (Nearness::new(LOWER), Random::new(6));
        let mut rise = |blows: bool| {
            let mut mean = 0.0;
            for _ in 0..250 {
                let mut pair = [[Complex::default(); BINS]; 2];
                for k in 1..BINS {
                    let ([l, r], [a, b]) = (crowd(&mut random), lips(k, &mut random));
                    let much = if blows { 2.0 } else { 0.0 };
                    (pair[0][k], pair[1][k]) = (l + much * a, r + much * b);
                }
                nearness.push(&pair, &[0.0; BINS], !blows, 1e-4);
                mean += nearness.rise_db[2] / 250.0;
            }
            mean
        };
        // Of a crowd of power 2 a half is one wave; lips add 4 to that: 10 lg 5, where all power rises by 10 lg 3.
        let [_, _, without, with] = [false, false, false, true].map(&mut rise);
        assert!((with - without - 7.0).abs() < SCATTERS, "{with} after {without}");
    }
}

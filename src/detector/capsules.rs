//! Two capsules: wind is another eddy at each of them, sound is the same wave at both.
//!
//! What differs between them is wind, then, and what is the same in both is a crowd, a knock on the table, the kiosk
//! itself. So the ear listens twice: to half the sum of both, as it would to one capsule, and to a spectrum that below
//! 400 Hz, where centimetres are little to a wave of metres, is that of half their difference:
//!
//! ```text
//! P_k = ¼ |L_k − g_k R_k|²          g_k = c_k/|c_k| · √(⟨|L_k|²⟩/⟨|R_k|²⟩),   c_k = ⟨L_k R*_k⟩
//! ```
//!
//! ⟨·⟩ a leaky mean of 4 s in which nobody blows: g is how the two capsules differ for good, in gain and corner, learnt
//! where both hear the same (a coherence of 0.7), as their own noise knows nothing of it. Every frame counts alike there,
//! |L_k|² + |R_k|² = 1: one loud puff, which is other eddies at each of them, would else outweigh all that both have heard
//! the same, and turn g into any number. Eddies that know nothing of each other (Corcos 1963: beyond a few millimetres
//! nothing is left) keep the power that half the sum of both has, on which the ear is trained. A plane wave from along the
//! line between capsules d apart keeps sin²(k d/2): of 6 cm, −19 dB at 200 Hz, and less below.
//!
//! Rumble that a crowd drowns in the sum rises out of the difference; a stream beside the microphone, of which there is
//! the hiss alone, is heard in the sum. How much of what is heard differs speaks for itself:
//!
//! ```text
//! δ = Σ_k ⟨|L_k − g_k R_k|²⟩ / Σ_k (⟨|L_k|²⟩ + |g_k|² ⟨|R_k|²⟩)      over 47–250 Hz, ⟨·⟩ of 64 ms; 1 for wind
//! ```
//!
//! A puff of p or b into the microphone is wind too, and one may follow another. So it is told for how long the difference has
//! stood near its peak, up to 140 ms. Breath wavers by 10 dB and more while it towers over the room, so near is less than a third
//! of its rise away, or 8 dB; and a moment below takes twice as long off what it has stood. What all of it says together is
//! learnt ([`super::pair`]).
//!
//! One capsule copied into two channels is coherent in everything it hears, and a channel that is dead, or hears only
//! itself, in nothing. So there are two capsules only once both have heard the same below 400 Hz while the treble, above
//! it, told them apart: there centimetres, reverberation and each capsule's own noise leave less than 0.97 of
//! two capsules' coherence.

use soffio_fourier::Complex;

use super::decision::LEAST_RISE_DB;
use super::features::blend;
use super::spectrum::{BINS, FRAME_S, Power};
use soffio_math::from_decibels;

/// Bins of the difference, 16–406 Hz, those of δ, 47–250 Hz, and those that tell two channels apart, 400–3400 Hz.
const DIFFERENCE: std::ops::Range<usize> = 1..26;
const LOW: std::ops::Range<usize> = 3..17;
const TREBLE: std::ops::Range<usize> = 26..218;
/// Memories of δ, of the treble's coherence, and of how the capsules differ, s.
const SHARE_S: f64 = 0.064;
const TREBLE_S: f64 = 0.5;
const MATCH_S: f64 = 4.0;
/// How much of what is the same at both may be left in the difference, dB: what g has not learnt.
const LEFT_DB: f64 = -13.0;
/// It begins to last, and lasts, when the difference has stood for so long above the room, s, and no farther below its peak,
/// dB, or by this share of its rise: the puff of a p or b is wind as well, and dies away.
const PUFF_S: (f64, f64) = (0.06, 0.14);
const PUFF_DB: f64 = 8.0;
const PUFF_SHARE: f64 = 0.35;
/// What it has stood is lost so much faster than it is won.
const LOSES: f64 = 2.0;
/// Coherence of the treble above which two channels are one capsule.
const ONE_CAPSULE: f64 = 0.97;
/// Coherence, over [`MATCH_S`], from which two channels have heard the same (every frame counts alike, so of noise it is that of
/// 0.85 of their powers' coherence); nothing is said of it before so long, s: frames overlap, and within a few of them whatever
/// is heard is alike.
const SAME: f64 = 0.7;
const ENOUGH_S: f64 = 1.0;
/// Power of one channel over the other's below which it is dead.
const DEAD: f64 = 1e-4;

/// Keeps quotients finite.
const NOTHING: f64 = 1e-30;

/// Leaky means of one bin of both channels: powers and cross spectrum.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Pair {
    left: f64,
    right: f64,
    pub cross: Complex<f64>,
}

impl Pair {
    pub fn push(&mut self, weight: f64, l: Complex<f64>, r: Complex<f64>) {
        self.left += weight * (l.norm_sqr() - self.left);
        self.right += weight * (r.norm_sqr() - self.right);
        self.cross += weight * (l * r.conj() - self.cross);
    }

    /// Sums of both.
    pub fn add(&mut self, other: &Self) {
        self.left += other.left;
        self.right += other.right;
        self.cross += other.cross;
    }

    /// √(⟨|L|²⟩⟨|R|²⟩): what |c| is where both hear the same.
    pub fn scale(&self) -> f64 {
        (self.left * self.right).sqrt()
    }

    /// What takes the right to the left, where both hear the same wave.
    fn gain(&self) -> Option<Complex<f64>> {
        let length = self.cross.norm();
        (length > SAME * self.scale()).then(|| self.cross / length * (self.left / self.right).sqrt())
    }
}

/// What two capsules tell.
#[derive(Clone, Debug)]
pub struct Capsules {
    /// The room as both hear it, over [`MATCH_S`], and what takes the right to the left.
    matched: [Pair; DIFFERENCE.end],
    gains: [Complex<f64>; DIFFERENCE.end],
    learnt: u64,
    treble: [Pair; BINS],
    /// Power that differs, and power in all, of the low band.
    differs: [f64; 2],
    /// They have heard the same, and the treble has told them apart.
    apart: bool,
    /// For how long the low band of the difference has stood above its room and near its peak, s.
    lasts: f64,
    /// δ of the last frame; `None` where there is one capsule.
    pub share: Option<f64>,
    /// The microphone's spectrum with the low end of half the difference.
    pub difference: Power,
}

impl Capsules {
    /// Nothing heard yet.
    pub fn new() -> Self {
        Self {
            matched: [Pair::default(); DIFFERENCE.end],
            gains: [Complex::new(1.0, 0.0); DIFFERENCE.end],
            learnt: 0,
            treble: [Pair::default(); BINS],
            differs: [0.0; 2],
            apart: false,
            lasts: 0.0,
            share: None,
            difference: [0.0; BINS],
        }
    }

    /// Takes one frame of both capsules, and the `microphone` that is half their sum; `scale` is power of square amplitude, and
    /// `learn` is false while somebody blows.
    pub fn push(&mut self, [l, r]: &[[Complex<f64>; BINS]; 2], learn: bool, scale: f64, microphone: &Power) {
        if learn {
            self.learnt += 1;
            let weight = blend(MATCH_S).max(1.0 / self.learnt as f64);
            for k in DIFFERENCE {
                // However loud it is.
                let one = 1.0 / (l[k].norm_sqr() + r[k].norm_sqr() + NOTHING).sqrt();
                self.matched[k].push(weight, one * l[k], one * r[k]);
                let gain = self.matched[k].gain().filter(|_| self.has_heard_enough());
                self.gains[k] = gain.unwrap_or(self.gains[k]);
            }
        }
        let gains = self.gains;
        let difference = |k: usize| (l[k] - gains[k] * r[k]).norm_sqr();
        let power = |k: usize| l[k].norm_sqr() + (gains[k] * r[k]).norm_sqr();
        let weight = blend(SHARE_S);
        self.differs[0] += weight * (LOW.map(difference).sum::<f64>() - self.differs[0]);
        self.differs[1] += weight * (LOW.map(power).sum::<f64>() - self.differs[1]);
        self.share = self.are_two(l, r, learn).then(|| self.differs[0] / self.differs[1].max(NOTHING));
        self.difference = *microphone;
        DIFFERENCE.for_each(|k| self.difference[k] = 0.25 * scale * difference(k));
    }

    /// What of `own`, the kiosk's own sound in half the sum, is left in half the difference at most.
    pub fn left_of(&self, own: &Power) -> Power {
        let left = from_decibels(2.0 * LEFT_DB);
        std::array::from_fn(|k| if DIFFERENCE.contains(&k) { left * own[k] } else { own[k] })
    }

    /// Has it heard the room for long enough to tell chance from what both capsules share?
    fn has_heard_enough(&self) -> bool {
        self.learnt as f64 * FRAME_S >= ENOUGH_S
    }

    /// Are there two capsules, and do both live? That there are is found out while nobody blows: another room is learnt then.
    fn are_two(&mut self, l: &[Complex<f64>; BINS], r: &[Complex<f64>; BINS], learn: bool) -> bool {
        let (mut together, mut scale, mut left, mut right) = (0.0, NOTHING, NOTHING, NOTHING);
        for k in TREBLE {
            let pair = &mut self.treble[k];
            pair.push(blend(TREBLE_S), l[k], r[k]);
            together += pair.cross.norm();
            scale += pair.scale();
            left += pair.left;
            right += pair.right;
        }
        let sum = |of: fn(&Pair) -> f64| self.matched[LOW].iter().map(of).sum::<f64>();
        let same = sum(|pair| pair.cross.norm()) > SAME * sum(Pair::scale);
        let balance = left / right;
        self.apart |= learn && self.has_heard_enough() && same && together / scale < ONE_CAPSULE;
        self.apart && balance > DEAD && balance < 1.0 / DEAD
    }

    /// Notes how far the low band of the difference has risen above the room, and how far it has fallen from its peak, dB.
    pub fn note(&mut self, rise_db: f64, fall_db: f64) {
        let stands = rise_db > LEAST_RISE_DB && fall_db < PUFF_DB.max(PUFF_SHARE * rise_db);
        let more = if stands { FRAME_S } else { -LOSES * FRAME_S };
        self.lasts = (self.lasts + more).clamp(0.0, PUFF_S.1);
    }

    /// Whether it has lasted longer than the puff of a p or b, 0 … 1.
    pub fn lasting(&self) -> f64 {
        part(self.lasts, PUFF_S)
    }
}

/// How far a number has come between two others, 0 … 1.
fn part(x: f64, (from, to): (f64, f64)) -> f64 {
    ((x - from) / (to - from)).clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_math::noise::Random;
    use soffio_math::{PI, cos, sin};

    /// Frames of half a minute.
    const FRAMES: usize = 3750;

    /// Power of the low band of half the sum and of half the difference, over the second half; and the last δ.
    fn heard(mut frame: impl FnMut(usize, &mut Random) -> [Complex<f64>; 2]) -> (f64, f64, Option<f64>) {
        let (mut capsules, mut random) = (Capsules::new(), Random::new(7));
        let (mut sum, mut low) = (0.0, 0.0);
        for i in 0..FRAMES {
            let mut pair = [[Complex::default(); BINS]; 2];
            let mut microphone: Power = [0.0; BINS];
            for k in 1..BINS {
                let [l, r] = frame(k, &mut random);
                (pair[0][k], pair[1][k]) = (l, r);
                microphone[k] = 0.25 * (l + r).norm_sqr();
            }
            let before: f64 = microphone[LOW].iter().sum();
            capsules.push(&pair, true, 1.0, &microphone);
            capsules.note(10.0, 0.0);
            if i > FRAMES / 2 {
                sum += before;
                low += capsules.difference[LOW].iter().sum::<f64>();
            }
        }
        (sum, low, capsules.share)
    }

    fn noise(random: &mut Random) -> Complex<f64> {
        Complex::new(random.signed(), random.signed())
    }

    #[test]
    fn a_wave_is_taken_away_and_eddies_stay() {
        // A wave along a line of 6 cm that comes from either end, a right capsule 1.5 dB louder.
        let wave = |k: usize, random: &mut Random| {
            let late = 2.0 * PI * 15.625 * k as f64 * 0.06 / 343.0 * if random.unit() < 0.5 { 1.0 } else { -1.0 };
            let l = noise(random);
            [l, 1.19 * l * Complex::new(cos(late), -sin(late))]
        };
        let (sum, low, share) = heard(wave);
        // sin²(k d/2) at 250 Hz is 0.018, and nothing of the band has more.
        assert!(low < 0.018 * sum, "{low} of {sum}");
        assert!(share.is_some_and(|share| share < 0.018), "{share:?}");
        let (sum, low, share) = heard(|_, random| {
            // A wave in eddies; the treble has them as well: otherwise these were no two capsules.
            let same = noise(random);
            [same + 0.4 * noise(random), same + 0.4 * noise(random)]
        });
        // Of what is the same in both nothing remains, of the eddies all: 0.5 · 0.16 of 1 + 0.5 · 0.16.
        assert!((low / sum - 0.08 / 1.08).abs() < 0.02, "{}", low / sum);
        // Of one of them 0.16 of 1.16 differs.
        assert!(share.is_some_and(|share| (share / (0.16 / 1.16) - 1.0).abs() < 0.3), "{share:?}");
    }

    #[test]
    fn puffs_that_follow_each_other_never_last() {
        let mut capsules = Capsules::new();
        let mut puff = |frames: usize, pause: usize| {
            (0..frames).for_each(|_| capsules.note(20.0, 0.0));
            let lasting = capsules.lasting();
            (0..pause).for_each(|_| capsules.note(20.0, PUFF_DB));
            (lasting, capsules.lasting())
        };
        // Of 56 ms each, half as long apart, and then a breath of 0.2 s that falters for a moment.
        (0..9).for_each(|_| assert_eq!(puff(7, 4), (0.0, 0.0)));
        let (lasting, falters) = puff(25, 2);
        assert!(lasting == 1.0 && (0.5..1.0).contains(&falters), "{falters}");
    }

    #[test]
    fn breath_that_wavers_far_above_the_room_lasts_and_a_puff_that_dies_does_not() {
        let mut capsules = Capsules::new();
        (0..18).for_each(|i| capsules.note(45.0, if i % 2 == 0 { 0.0 } else { 14.0 }));
        assert_eq!(capsules.lasting(), 1.0);
        (0..7).for_each(|_| capsules.note(45.0, 20.0));
        assert!(capsules.lasting() < 0.5, "{}", capsules.lasting());
    }

    #[test]
    fn one_capsule_in_two_channels_and_a_dead_one_are_one() {
        let copied = |_: usize, random: &mut Random| {
            let l = noise(random);
            [l, 0.5 * l]
        };
        let silent = |_: usize, random: &mut Random| [noise(random), Complex::default()];
        assert_eq!((heard(copied).2, heard(silent).2), (None, None));
        // Two that have nothing in common have not shown that they hear one room, though frames overlap: each is eight times
        // nearly the same one.
        let mut last = [[Complex::default(); 2]; BINS];
        let strangers = heard(|k, random| {
            last[k] = last[k].map(|z| 0.875 * z + 0.125 * noise(random));
            last[k]
        });
        assert_eq!(strangers.2, None);
    }

    #[test]
    fn a_puff_teaches_nothing_of_how_the_capsules_differ() {
        /// dB.
        const LOUDER: f64 = 60.0;
        /// Of the gain, which a twentieth of all frames turns by this much at most.
        const TURNED: f64 = 0.1;
        let (mut capsules, mut random) = (Capsules::new(), Random::new(11));
        // Frames overlap: within a puff the eddies stay nearly the same.
        let puff: Vec<[Complex<f64>; 2]> = (0..BINS).map(|_| [(); 2].map(|()| noise(&mut random))).collect();
        for i in 0..1000 {
            let mut pair = [[Complex::default(); BINS]; 2];
            for k in 1..BINS {
                let wave = noise(&mut random);
                let frame = if (600..625).contains(&i) {
                    puff[k].map(|z| from_decibels(LOUDER) * z)
                } else {
                    // What the treble tells them apart by.
                    [wave, wave].map(|z| z + 0.3 * noise(&mut random))
                };
                (pair[0][k], pair[1][k]) = (frame[0], frame[1]);
            }
            capsules.push(&pair, true, 1.0, &[0.0; BINS]);
        }
        assert!(capsules.share.is_some());
        for k in DIFFERENCE {
            assert!((capsules.gains[k] - 1.0).norm() < TURNED, "{} of bin {k}", capsules.gains[k]);
        }
    }
}

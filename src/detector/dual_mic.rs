//! Dual microphone: wind noise is uncorrelated between two capsules, sound is coherent, so their difference isolates wind.
//!
//! The detector analyses two spectra. Half the sum is that of one capsule. The second one is half the difference below 400 Hz,
//! where the wavelength is metres and the spacing centimetres:
//!
//! ```text
//! P_k = ¼ |L_k − g_k R_k|²          g_k = c_k/|c_k| · √(⟨|L_k|²⟩/⟨|R_k|²⟩),   c_k = ⟨L_k R*_k⟩
//! ```
//!
//! ⟨·⟩ is an exponential average of 4 s without breath. g matches the capsules in gain and phase. It is learnt where both are
//! coherent (0.7), since their own noise says nothing about it. Each frame is normalised, |L_k|² + |R_k|² = 1. Otherwise one loud
//! puff, which is uncorrelated, would outweigh all coherent sound and spoil g.
//!
//! Turbulence is uncorrelated beyond a few millimetres (Corcos 1963). Its difference therefore keeps the power that half the sum
//! has, on which the network is trained. A plane wave along the line between capsules d apart keeps sin²(k d/2): −19 dB at 200 Hz
//! for 6 cm, and less below.
//!
//! So rumble that a crowd masks in the sum rises in the difference; an off-axis breath, which is only hiss, shows in the sum. The
//! share of the difference is a feature of its own:
//!
//! ```text
//! δ = Σ_k ⟨|L_k − g_k R_k|²⟩ / Σ_k (⟨|L_k|²⟩ + |g_k|² ⟨|R_k|²⟩)      over 47–250 Hz, ⟨·⟩ of 64 ms; 1 for wind
//! ```
//!
//! A plosive puff (p or b) is wind too, and puffs may follow each other. So another feature is the time, up to 140 ms, for which
//! the difference has stayed near its peak. Breath varies by 10 dB and more far above the noise floor. *Near* therefore means
//! within 8 dB, or within 35 % of the rise; time below counts twice against it. The dual-microphone model weighs all of these
//! ([`super::dual_mic_model`]).
//!
//! One capsule copied into two channels is coherent everywhere, and a dead channel nowhere. Two capsules are recognised once both
//! are coherent below 400 Hz and less than 0.97 coherent above it: there the spacing, reverberation and noise decorrelate them.

use soffio_fourier::Complex;

use super::decision::MIN_RISE_DB;
use super::features::blend;
use super::spectrum::{BINS, FRAME_S, Power};
use soffio_math::db_to_amplitude;

/// Bins of the difference, 16–406 Hz.
const DIFFERENCE: std::ops::Range<usize> = 1..26;
/// Bins of δ, 47–250 Hz.
const LOW: std::ops::Range<usize> = 3..17;
/// Bins that show whether there are two capsules, 406–3400 Hz.
const MIDDLE: std::ops::Range<usize> = 26..218;
/// Time constant of δ, s.
const RATIO_S: f64 = 0.064;
/// Time constant of the coherence of the middle band, s.
const MIDDLE_S: f64 = 0.5;
/// Time constant of the match between the capsules, s.
const MATCH_S: f64 = 4.0;
/// Largest residual of coherent sound in the difference, dB, from the error of g.
const ECHO_REJECTION_DB: f64 = -13.0;
/// Time near the peak from which the difference counts as sustained, and as fully sustained, s.
const PUFF_S: (f64, f64) = (0.06, 0.14);
/// Largest distance below the peak, dB.
const PUFF_DB: f64 = 8.0;
/// Largest distance below the peak, as a share of the rise, where that is more.
const PUFF_SHARE: f64 = 0.35;
/// Sustained time is lost this many times as fast as it is gained.
const LOSS_RATIO: f64 = 2.0;
/// Coherence of the middle band above which two channels are the same capsule.
const MONO_COHERENCE: f64 = 0.97;
/// Coherence over [`MATCH_S`] from which two channels receive the same sound. Frames are normalised, so for noise it corresponds
/// to a coherence of power of 0.85.
const MATCH_COHERENCE: f64 = 0.7;
/// Shortest time over which a match counts, s: frames overlap, so a few of them are coherent in any case.
const MIN_MATCH_S: f64 = 1.0;
/// Power ratio of the channels below which one of them is dead.
const DEAD_RATIO: f64 = 1e-4;

/// Keeps quotients finite.
const EPSILON: f64 = 1e-30;

/// Averaged powers and cross-spectrum of one bin of two channels.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct CrossSpectrum {
    left: f64,
    right: f64,
    pub cross: Complex<f64>,
}

impl CrossSpectrum {
    pub fn push(&mut self, weight: f64, l: Complex<f64>, r: Complex<f64>) {
        self.left += weight * (l.norm_sqr() - self.left);
        self.right += weight * (r.norm_sqr() - self.right);
        self.cross += weight * (l * r.conj() - self.cross);
    }

    /// Adds another bin.
    pub fn add(&mut self, other: &Self) {
        self.left += other.left;
        self.right += other.right;
        self.cross += other.cross;
    }

    /// √(⟨|L|²⟩⟨|R|²⟩): equals |c| for coherent channels.
    pub fn scale(&self) -> f64 {
        (self.left * self.right).sqrt()
    }

    /// Factor from the right channel to the left one; `None` where they are not coherent.
    fn gain(&self) -> Option<Complex<f64>> {
        let length = self.cross.norm();
        (length > MATCH_COHERENCE * self.scale()).then(|| self.cross / length * (self.left / self.right).sqrt())
    }
}

/// Analysis of two capsules.
#[derive(Clone, Debug)]
pub struct DualMic {
    /// Normalised spectra over [`MATCH_S`].
    matched: [CrossSpectrum; DIFFERENCE.end],
    /// g of each bin.
    gains: [Complex<f64>; DIFFERENCE.end],
    learnt: u64,
    middle: [CrossSpectrum; BINS],
    /// Power of the difference and total power of the low band.
    powers: [f64; 2],
    /// Two capsules have been recognised.
    is_dual: bool,
    /// Time for which the low band of the difference has stayed above the noise floor and near its peak, s.
    sustained_s: f64,
    /// δ of the last frame; `None` with one capsule.
    pub difference_ratio: Option<f64>,
    /// Power spectrum of the microphone, below 406 Hz that of half the difference.
    pub difference: Power,
}

impl DualMic {
    /// An analysis that has not recognised two capsules yet.
    pub fn new() -> Self {
        Self {
            matched: [CrossSpectrum::default(); DIFFERENCE.end],
            gains: [Complex::new(1.0, 0.0); DIFFERENCE.end],
            learnt: 0,
            middle: [CrossSpectrum::default(); BINS],
            powers: [0.0; 2],
            is_dual: false,
            sustained_s: 0.0,
            difference_ratio: None,
            difference: [0.0; BINS],
        }
    }

    /// Takes one frame of both capsules and the `microphone` spectrum of half their sum. `scale` converts squared amplitudes to
    /// power, and `learn` is false during a breath.
    pub fn push(&mut self, [l, r]: &[[Complex<f64>; BINS]; 2], learn: bool, scale: f64, microphone: &Power) {
        if learn {
            self.learnt += 1;
            let weight = blend(MATCH_S).max(1.0 / self.learnt as f64);
            for k in DIFFERENCE {
                // Each frame has the same weight, whatever its level.
                let one = 1.0 / (l[k].norm_sqr() + r[k].norm_sqr() + EPSILON).sqrt();
                self.matched[k].push(weight, one * l[k], one * r[k]);
                let gain = self.matched[k].gain().filter(|_| self.is_matched());
                self.gains[k] = gain.unwrap_or(self.gains[k]);
            }
        }
        let gains = self.gains;
        let difference = |k: usize| (l[k] - gains[k] * r[k]).norm_sqr();
        let power = |k: usize| l[k].norm_sqr() + (gains[k] * r[k]).norm_sqr();
        let weight = blend(RATIO_S);
        self.powers[0] += weight * (LOW.map(difference).sum::<f64>() - self.powers[0]);
        self.powers[1] += weight * (LOW.map(power).sum::<f64>() - self.powers[1]);
        self.difference_ratio = self.detect_dual(l, r, learn).then(|| self.powers[0] / self.powers[1].max(EPSILON));
        self.difference = *microphone;
        DIFFERENCE.for_each(|k| self.difference[k] = 0.25 * scale * difference(k));
    }

    /// Upper bound of the echo in half the difference, from the `echo` in half the sum.
    pub fn residual_echo(&self, echo: &Power) -> Power {
        let left = db_to_amplitude(2.0 * ECHO_REJECTION_DB);
        std::array::from_fn(|k| if DIFFERENCE.contains(&k) { left * echo[k] } else { echo[k] })
    }

    /// True once the match has had enough time to exceed chance coherence.
    fn is_matched(&self) -> bool {
        self.learnt as f64 * FRAME_S >= MIN_MATCH_S
    }

    /// True where both channels are live, different capsules. They are recognised outside breaths only.
    fn detect_dual(&mut self, l: &[Complex<f64>; BINS], r: &[Complex<f64>; BINS], learn: bool) -> bool {
        let (mut coherent, mut scale, mut left, mut right) = (0.0, EPSILON, EPSILON, EPSILON);
        for k in MIDDLE {
            let bin = &mut self.middle[k];
            bin.push(blend(MIDDLE_S), l[k], r[k]);
            coherent += bin.cross.norm();
            scale += bin.scale();
            left += bin.left;
            right += bin.right;
        }
        let sum = |of: fn(&CrossSpectrum) -> f64| self.matched[LOW].iter().map(of).sum::<f64>();
        let same = sum(|bin| bin.cross.norm()) > MATCH_COHERENCE * sum(CrossSpectrum::scale);
        let balance = left / right;
        self.is_dual |= learn && self.is_matched() && same && coherent / scale < MONO_COHERENCE;
        self.is_dual && balance > DEAD_RATIO && balance < 1.0 / DEAD_RATIO
    }

    /// Updates the sustained time with the rise of the difference's low band over the noise floor and its fall from the peak, dB.
    pub fn track_puff(&mut self, rise_db: f64, fall_db: f64) {
        let stands = rise_db > MIN_RISE_DB && fall_db < PUFF_DB.max(PUFF_SHARE * rise_db);
        let more = if stands { FRAME_S } else { -LOSS_RATIO * FRAME_S };
        self.sustained_s = (self.sustained_s + more).clamp(0.0, PUFF_S.1);
    }

    /// Degree to which the difference has lasted longer than a plosive puff, 0 … 1.
    pub fn sustained(&self) -> f64 {
        part(self.sustained_s, PUFF_S)
    }
}

/// Position of a number between two others, 0 … 1.
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

    /// Power of the low band of half the sum and of half the difference, over the last 15 s; and the last δ.
    fn analysed(mut frame: impl FnMut(usize, &mut Random) -> [Complex<f64>; 2]) -> (f64, f64, Option<f64>) {
        let (mut dual_mic, mut random) = (DualMic::new(), Random::new(7));
        let (mut sum, mut low) = (0.0, 0.0);
        for i in 0..FRAMES {
            let mut spectra = [[Complex::default(); BINS]; 2];
            let mut microphone: Power = [0.0; BINS];
            for k in 1..BINS {
                let [l, r] = frame(k, &mut random);
                (spectra[0][k], spectra[1][k]) = (l, r);
                microphone[k] = 0.25 * (l + r).norm_sqr();
            }
            let before: f64 = microphone[LOW].iter().sum();
            dual_mic.push(&spectra, true, 1.0, &microphone);
            dual_mic.track_puff(10.0, 0.0);
            if i > FRAMES / 2 {
                sum += before;
                low += dual_mic.difference[LOW].iter().sum::<f64>();
            }
        }
        (sum, low, dual_mic.difference_ratio)
    }

    fn noise(random: &mut Random) -> Complex<f64> {
        Complex::new(random.signed(), random.signed())
    }

    #[test]
    fn a_wave_cancels_and_turbulence_stays() {
        // A wave along a line of 6 cm, from either end; the right capsule is 1.5 dB louder.
        let wave = |k: usize, random: &mut Random| {
            let late = 2.0 * PI * 15.625 * k as f64 * 0.06 / 343.0 * if random.unit() < 0.5 { 1.0 } else { -1.0 };
            let l = noise(random);
            [l, 1.19 * l * Complex::new(cos(late), -sin(late))]
        };
        let (sum, low, difference_ratio) = analysed(wave);
        // sin²(k d/2) is 0.018 at 250 Hz and less below.
        assert!(low < 0.018 * sum, "{low} of {sum}");
        assert!(difference_ratio.is_some_and(|ratio| ratio < 0.018), "{difference_ratio:?}");
        let (sum, low, difference_ratio) = analysed(|_, random| {
            // A wave with turbulence; the middle band has it too, otherwise two capsules would not be recognised.
            let same = noise(random);
            [same + 0.4 * noise(random), same + 0.4 * noise(random)]
        });
        // The common part cancels and the turbulence stays: 0.5 · 0.16 of 1 + 0.5 · 0.16.
        assert!((low / sum - 0.08 / 1.08).abs() < 0.02, "{}", low / sum);
        // Of each capsule's power, 0.16 of 1.16 differs.
        assert!(
            difference_ratio.is_some_and(|ratio| (ratio / (0.16 / 1.16) - 1.0).abs() < 0.3),
            "{difference_ratio:?}"
        );
    }

    #[test]
    fn puffs_that_follow_each_other_never_last() {
        let mut dual_mic = DualMic::new();
        let mut puff = |frames: usize, pause: usize| {
            (0..frames).for_each(|_| dual_mic.track_puff(20.0, 0.0));
            let lasting = dual_mic.sustained();
            (0..pause).for_each(|_| dual_mic.track_puff(20.0, PUFF_DB));
            (lasting, dual_mic.sustained())
        };
        // Puffs of 56 ms with half as long pauses, then a breath of 0.2 s that falters for a moment.
        (0..9).for_each(|_| assert_eq!(puff(7, 4), (0.0, 0.0)));
        let (lasting, falters) = puff(25, 2);
        assert!(lasting == 1.0 && (0.5..1.0).contains(&falters), "{falters}");
    }

    #[test]
    fn breath_that_varies_far_above_the_noise_floor_lasts_and_a_decaying_puff_does_not() {
        let mut dual_mic = DualMic::new();
        (0..18).for_each(|i| dual_mic.track_puff(45.0, if i % 2 == 0 { 0.0 } else { 14.0 }));
        assert_eq!(dual_mic.sustained(), 1.0);
        (0..7).for_each(|_| dual_mic.track_puff(45.0, 20.0));
        assert!(dual_mic.sustained() < 0.5, "{}", dual_mic.sustained());
    }

    #[test]
    fn one_capsule_in_two_channels_and_a_dead_one_are_one() {
        let copied = |_: usize, random: &mut Random| {
            let l = noise(random);
            [l, 0.5 * l]
        };
        let silent = |_: usize, random: &mut Random| [noise(random), Complex::default()];
        assert_eq!((analysed(copied).2, analysed(silent).2), (None, None));
        // Uncorrelated channels are not recognised, although frames overlap: each is nearly the same as the last one, eight times.
        let mut last = [[Complex::default(); 2]; BINS];
        let strangers = analysed(|k, random| {
            last[k] = last[k].map(|z| 0.875 * z + 0.125 * noise(random));
            last[k]
        });
        assert_eq!(strangers.2, None);
    }

    #[test]
    fn a_puff_does_not_change_the_match_of_the_capsules() {
        /// Level of the puff over the ambient noise, dB.
        const LOUDER: f64 = 60.0;
        /// Largest error of the gain; the puff is a twentieth of all frames.
        const TURNED: f64 = 0.1;
        let (mut dual_mic, mut random) = (DualMic::new(), Random::new(11));
        // Frames overlap: within a puff the turbulence stays nearly the same.
        let puff: Vec<[Complex<f64>; 2]> = (0..BINS).map(|_| [(); 2].map(|()| noise(&mut random))).collect();
        for i in 0..1000 {
            let mut spectra = [[Complex::default(); BINS]; 2];
            for k in 1..BINS {
                let wave = noise(&mut random);
                let frame = if (600..625).contains(&i) {
                    puff[k].map(|z| db_to_amplitude(LOUDER) * z)
                } else {
                    // Noise by which the middle band shows two capsules.
                    [wave, wave].map(|z| z + 0.3 * noise(&mut random))
                };
                (spectra[0][k], spectra[1][k]) = (frame[0], frame[1]);
            }
            dual_mic.push(&spectra, true, 1.0, &[0.0; BINS]);
        }
        assert!(dual_mic.difference_ratio.is_some());
        for k in DIFFERENCE {
            assert!((dual_mic.gains[k] - 1.0).norm() < TURNED, "{} of bin {k}", dual_mic.gains[k]);
        }
    }
}

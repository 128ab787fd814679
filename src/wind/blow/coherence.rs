//! Two capsules: wind is another eddy at each of them, sound is the same wave at both.
//!
//! ```text
//! γ = Σ_k |⟨L_k R*_k⟩| / Σ_k √(⟨|L_k|²⟩ ⟨|R_k|²⟩)      over 47–250 Hz, ⟨·⟩ a leaky mean of 64 ms
//! ```
//!
//! (magnitude coherence; Corcos 1963 for turbulence: beyond a few millimetres nothing of it is left.) Of noise that is independent at the
//! capsules some 0.45 remains, since the mean is short; of sound from anywhere in a room more than 0.9, as centimetres
//! are nothing to a wave of metres. The evidence it gives is added to the log-odds, in so far as the low band has risen:
//!
//! ```text
//! ℓ ← ℓ + clamp(12 (0.7 − γ), −6, 2)
//! ```
//!
//! One capsule copied into two channels is coherent in everything it hears, and a channel that is dead in nothing. So
//! the evidence counts only while the treble, above 400 Hz, tells the channels apart: there centimetres, reverberation and each
//! capsule's own noise leave less than 0.97 of two capsules' coherence.

use rustfft::num_complex::Complex;

use super::features::blend;
use super::spectrum::BINS;

/// Bins 47–250 Hz, and 400–3400 Hz.
const LOW: std::ops::Range<usize> = 3..17;
const TREBLE: std::ops::Range<usize> = 26..218;
/// Memories of the means, s.
const MEMORY_S: (f64, f64) = (0.064, 0.5);
/// Coherence at which it says nothing, and log-odds for each unit below.
const NEUTRAL: f64 = 0.7;
const SLOPE: f64 = 12.0;
/// Log-odds that it may say, against and for breath.
const SAYS: (f64, f64) = (-6.0, 2.0);
/// Coherence of the treble above which two channels are one capsule.
const ONE_CAPSULE: f64 = 0.97;
/// Power of one channel over the other's below which it is dead.
const DEAD: f64 = 1e-4;

/// Keeps quotients finite.
const NOTHING: f64 = 1e-30;

/// Coherence of two capsules.
#[derive(Clone, Debug)]
pub struct Coherence {
    left: [f64; BINS],
    right: [f64; BINS],
    cross: [Complex<f64>; BINS],
    /// γ of the last frame, 0 … 1; `None` where there is one capsule.
    pub value: Option<f64>,
}

impl Coherence {
    /// Nothing heard yet.
    pub fn new() -> Self {
        Self { left: [0.0; BINS], right: [0.0; BINS], cross: [Complex::default(); BINS], value: None }
    }

    /// Takes one frame of both capsules.
    pub fn push(&mut self, capsules: &[[Complex<f64>; BINS]; 2]) {
        let [l, r] = capsules;
        let (low, _) = self.mean(LOW, blend(MEMORY_S.0), l, r);
        let (treble, balance) = self.mean(TREBLE, blend(MEMORY_S.1), l, r);
        let two = treble < ONE_CAPSULE && balance > DEAD && balance < 1.0 / DEAD;
        self.value = two.then_some(low);
    }

    /// Follows a band; its coherence, and the power of the left over that of the right.
    fn mean(
        &mut self,
        bins: std::ops::Range<usize>,
        weight: f64,
        l: &[Complex<f64>; BINS],
        r: &[Complex<f64>; BINS],
    ) -> (f64, f64) {
        let (mut together, mut scale, mut left, mut right) = (0.0, NOTHING, NOTHING, NOTHING);
        for k in bins {
            self.left[k] += weight * (l[k].norm_sqr() - self.left[k]);
            self.right[k] += weight * (r[k].norm_sqr() - self.right[k]);
            self.cross[k] += weight * (l[k] * r[k].conj() - self.cross[k]);
            together += self.cross[k].norm_sqr().sqrt();
            scale += (self.left[k] * self.right[k]).sqrt();
            left += self.left[k];
            right += self.right[k];
        }
        ((together / scale).min(1.0), left / right)
    }

    /// What it adds to the log-odds, where the low band has risen by `rise_db` over the room.
    pub fn log_odds(&self, rise_db: f64) -> f64 {
        let weight = ((rise_db - 4.0) / 6.0).clamp(0.0, 1.0);
        self.value.map_or(0.0, |gamma| weight * (SLOPE * (NEUTRAL - gamma)).clamp(SAYS.0, SAYS.1))
    }
}

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
//! One capsule copied into two channels is coherent whatever it hears. It is known by its difference, which is nothing.

use rustfft::num_complex::Complex;

use super::features::blend;
use super::spectrum::BINS;

/// Bins 47–250 Hz.
const BAND: std::ops::Range<usize> = 3..17;
/// Memory of the mean, s.
const MEMORY_S: f64 = 0.064;
/// Coherence at which it says nothing, and log-odds for each unit below.
const NEUTRAL: f64 = 0.7;
const SLOPE: f64 = 12.0;
/// Log-odds that it may say, against and for breath.
const SAYS: (f64, f64) = (-6.0, 2.0);
/// Power of the difference over that of the sum below which two channels are one capsule.
const ONE_CAPSULE: f64 = 1e-5;

/// Coherence of two capsules.
#[derive(Clone, Debug)]
pub struct Coherence {
    left: [f64; BINS],
    right: [f64; BINS],
    cross: [Complex<f64>; BINS],
    /// Leaky powers of the sum and of the difference, all bins.
    sum: f64,
    difference: f64,
    /// γ of the last frame, 0 … 1; `None` where there is one capsule.
    pub value: Option<f64>,
}

impl Coherence {
    /// Nothing heard yet.
    pub fn new() -> Self {
        Self {
            left: [0.0; BINS],
            right: [0.0; BINS],
            cross: [Complex::default(); BINS],
            sum: 0.0,
            difference: 0.0,
            value: None,
        }
    }

    /// Takes one frame of both capsules.
    pub fn push(&mut self, capsules: &[[Complex<f64>; BINS]; 2]) {
        let [l, r] = capsules;
        let weight = blend(MEMORY_S);
        let (mut sum, mut difference, mut together, mut scale) = (0.0, 0.0, 0.0, 1e-30);
        for (l, r) in l.iter().zip(r).skip(1) {
            sum += (l + r).norm_sqr();
            difference += (l - r).norm_sqr();
        }
        for k in BAND {
            self.left[k] += weight * (l[k].norm_sqr() - self.left[k]);
            self.right[k] += weight * (r[k].norm_sqr() - self.right[k]);
            self.cross[k] += weight * (l[k] * r[k].conj() - self.cross[k]);
            together += self.cross[k].norm();
            scale += (self.left[k] * self.right[k]).sqrt();
        }
        self.sum += blend(1.0) * (sum - self.sum);
        self.difference += blend(1.0) * (difference - self.difference);
        self.value = (self.difference > ONE_CAPSULE * self.sum).then(|| (together / scale).min(1.0));
    }

    /// What it adds to the log-odds, where the low band has risen by `rise_db` over the room.
    pub fn log_odds(&self, rise_db: f64) -> f64 {
        let weight = ((rise_db - 4.0) / 6.0).clamp(0.0, 1.0);
        self.value.map_or(0.0, |gamma| weight * (SLOPE * (NEUTRAL - gamma)).clamp(SAYS.0, SAYS.1))
    }
}

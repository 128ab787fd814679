//! The model that weighs the features: a small network of two layers, bounded everywhere.
//!
//! ```text
//! x_i = clamp((f_i − m_i) / s_i, ±3),   h = σ(A x + a),   g = σ(B h + b),   ℓ = C · g + c,   σ(z) = z / (1 + |z|)
//! ```
//!
//! ℓ is the log-odds of breath in one frame. σ needs no transcendental and never saturates to a number that cannot be
//! left again in training. Trained by `soffio breath train`, which writes [`super::table`].

use super::features::{COUNT, Features};

/// Width of the first layer.
pub const FIRST: usize = 64;
/// Width of the second layer.
pub const SECOND: usize = 24;
/// Parameters that are trained.
pub const PARAMETERS: usize = FIRST * (COUNT + 1) + SECOND * (FIRST + 1) + SECOND + 1;
/// Standardised features are cut here: what was never met in training says no more than the farthest that was.
const FARTHEST: f64 = 3.0;

/// All numbers of the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Mean and deviation of each feature, m and s.
    pub scale: [[f64; 2]; COUNT],
    /// Aᵀ row by row, then a; Bᵀ, b; C, c.
    pub weights: [f64; PARAMETERS],
}

/// Values of the layers at one frame: what training differentiates.
#[derive(Clone, Debug)]
pub struct Layers {
    /// Standardised features x.
    pub input: [f64; COUNT],
    /// h.
    pub first: [f64; FIRST],
    /// g.
    pub second: [f64; SECOND],
    /// ℓ.
    pub log_odds: f64,
}

/// Where Bᵀ, and C, begin among the weights.
pub const B: usize = FIRST * (COUNT + 1);
/// See [`B`].
pub const C: usize = B + SECOND * (FIRST + 1);

impl Model {
    /// Log-odds of breath.
    pub fn log_odds(&self, features: &Features) -> f64 {
        self.layers(&self.standardised(features)).log_odds
    }

    /// x of the features.
    pub fn standardised(&self, features: &Features) -> [f64; COUNT] {
        std::array::from_fn(|i| ((features[i] - self.scale[i][0]) / self.scale[i][1]).clamp(-FARTHEST, FARTHEST))
    }

    /// All layers at standardised features.
    pub fn layers(&self, input: &[f64; COUNT]) -> Layers {
        let first = affine(&self.weights[..B], input).map(bend);
        let second = affine(&self.weights[B..C], &first).map(bend);
        let [log_odds] = affine(&self.weights[C..], &second);
        Layers { input: *input, first, second, log_odds }
    }
}

/// Wᵀ x + w, of which the rows of W come first and w last: column by column, so that the sums go on side by side.
fn affine<const N: usize, const M: usize>(weights: &[f64], x: &[f64; N]) -> [f64; M] {
    let (rows, rest) = weights.as_chunks::<M>();
    debug_assert!(rows.len() == N + 1 && rest.is_empty());
    let mut sum = rows[N];
    for (row, x) in rows.iter().zip(x) {
        for (s, w) in sum.iter_mut().zip(row) {
            *s += w * x;
        }
    }
    sum
}

fn bend(z: f64) -> f64 {
    z / (1.0 + z.abs())
}

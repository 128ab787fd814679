//! Neural networks of the detector: multilayer perceptrons with two hidden layers and softsign activations, bounded everywhere.
//!
//! ```text
//! x_i = clamp((f_i − m_i) / s_i, ±3),   h = σ(A x + a),   g = σ(B h + b),   ℓ = C · g + c,   σ(z) = z / (1 + |z|)
//! ```
//!
//! ℓ is the log-odds of breath in one frame. Softsign σ needs no transcendental function, and its gradient never vanishes in
//! training. One network weighs the features of one spectrum ([`Model`]), another those of a dual microphone
//! ([`super::dual_mic_model`]). `soffio-training train` trains them and writes `table.rs` and `dual_mic_table.rs`.

use std::borrow::Cow;

use super::features;

/// Network over the features of one spectrum.
pub type Model = Network<{ features::COUNT }, 64, 24>;

/// Limit of standardised inputs: values beyond those of the training count as the largest of those.
const INPUT_LIMIT: f64 = 3.0;

/// Weights of a network with `IN` inputs and hidden layers of `FIRST` and `SECOND` cells.
#[derive(Clone, Debug, PartialEq)]
pub struct Network<const IN: usize, const FIRST: usize, const SECOND: usize> {
    /// Mean and deviation of each input, m and s.
    pub scale: [[f64; 2]; IN],
    /// Aᵀ row by row, then a; Bᵀ, b; C, c: [`Self::PARAMETERS`] weights.
    pub weights: Cow<'static, [f64]>,
}

/// Values of all layers for one frame; training differentiates them.
#[derive(Clone, Debug)]
pub struct Layers<const IN: usize, const FIRST: usize, const SECOND: usize> {
    /// Standardised inputs x.
    pub input: [f64; IN],
    /// h.
    pub first: [f64; FIRST],
    /// g.
    pub second: [f64; SECOND],
    /// ℓ.
    pub log_odds: f64,
}

impl<const IN: usize, const FIRST: usize, const SECOND: usize> Network<IN, FIRST, SECOND> {
    /// Index of Bᵀ among the weights.
    pub const B: usize = FIRST * (IN + 1);
    /// Index of C among the weights.
    pub const C: usize = Self::B + SECOND * (FIRST + 1);
    /// Parameters that are trained.
    pub const PARAMETERS: usize = Self::C + SECOND + 1;

    /// Log-odds of breath.
    pub fn log_odds(&self, inputs: &[f64; IN]) -> f64 {
        self.layers(&self.standardised(inputs)).log_odds
    }

    /// x of the inputs.
    pub fn standardised(&self, inputs: &[f64; IN]) -> [f64; IN] {
        std::array::from_fn(|i| ((inputs[i] - self.scale[i][0]) / self.scale[i][1]).clamp(-INPUT_LIMIT, INPUT_LIMIT))
    }

    /// All layers at standardised inputs.
    pub fn layers(&self, input: &[f64; IN]) -> Layers<IN, FIRST, SECOND> {
        let first = affine(&self.weights[..Self::B], input).map(softsign);
        let second = affine(&self.weights[Self::B..Self::C], &first).map(softsign);
        let [log_odds] = affine(&self.weights[Self::C..], &second);
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

fn softsign(z: f64) -> f64 {
    z / (1.0 + z.abs())
}

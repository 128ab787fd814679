//! The additive logistic model that weighs the features, and its coefficients.
//!
//! Each feature acts through a broken line with two knees, so that "enough is enough" and "only beyond" can be said:
//!
//! ```text
//! log-odds = bias + Σ_i ( w_i0 x_i + w_i1 max(0, x_i − k_i0) + w_i2 max(0, x_i − k_i1) )
//! ```
//!
//! Trained by `tests/suite/blow/train.rs`, which prints this table; its data are the labelled recordings under
//! `../shared/breath` and breaths from [`crate::wind::generate`].

use super::features::{COUNT, Features};

/// Coefficients of one feature.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Line {
    /// Where the slope changes.
    pub knees: [f64; 2],
    /// Slope from the start, and what is added to it at each knee; log-odds per unit of the feature.
    pub slopes: [f64; 3],
}

impl Line {
    /// The three basis functions at `x`.
    pub fn basis(knees: &[f64; 2], x: f64) -> [f64; 3] {
        [x, (x - knees[0]).max(0.0), (x - knees[1]).max(0.0)]
    }
}

/// Coefficients of the whole model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Model {
    /// Log-odds where all lines are 0.
    pub bias: f64,
    /// One line per feature.
    pub lines: [Line; COUNT],
}

impl Model {
    /// Log-odds of breath.
    pub fn log_odds(&self, features: &Features) -> f64 {
        let line = |(line, &x): (&Line, &f64)| -> f64 {
            Line::basis(&line.knees, x).iter().zip(&line.slopes).map(|(b, s)| b * s).sum()
        };
        self.bias + self.lines.iter().zip(features).map(line).sum::<f64>()
    }
}

/// A line, short for the table.
const fn line(knees: [f64; 2], slopes: [f64; 3]) -> Line {
    Line { knees, slopes }
}

/// The trained model.
#[rustfmt::skip]
pub const TRAINED: Model = Model {
    bias: 4.436,
    lines: [
        line([1.261, 3.145], [-0.482, -4.471, 1.432]), // rise of the low band over the room, 10 dB
        line([0.508, 2.492], [3.953, 1.213, -1.275]), // the same less twice the room's unrest, 10 dB
        line([-0.243, -0.081], [0.558, -0.135, -0.506]), // share of the low band in the excess, 10 dB
        line([-0.635, -0.005], [0.674, -0.932, 0.310]), // 31–94 Hz over 94–203 Hz, 10 dB
        line([-0.911, -0.389], [1.156, -0.427, -1.131]), // 203–406 Hz over the low band, 10 dB
        line([-1.374, -0.631], [0.414, -1.094, 0.106]), // 406–1625 Hz over the low band, 10 dB
        line([-1.171, -0.674], [1.583, 0.212, -2.566]), // 1625–3400 Hz over 406–1625 Hz, 10 dB
        line([0.166, 0.276], [-0.120, 0.758, 0.510]), // periodicity of the excess, 80–400 Hz
        line([-0.891, -0.158], [0.255, 0.008, -1.548]), // flatness of the low band, 10 dB
        line([-2.000, -0.500], [0.203, 0.203, -0.715]), // flatness of 406–1625 Hz, 10 dB
        line([0.127, 0.590], [1.043, 0.954, -4.271]), // fall from the peak of the last 0.2 s, 10 dB
        line([-0.197, 0.219], [0.293, 0.261, -0.837]), // climb of the low band in the last 48 ms, 10 dB
        line([0.606, 1.902], [-0.060, -1.561, 1.227]), // rise of 406–1625 Hz over the room, 10 dB
        line([-0.289, -0.093], [3.806, 3.885, -1.689]), // flatness of the low band over 80 ms, 10 dB
    ],
};

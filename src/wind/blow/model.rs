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
    bias: 2.946,
    lines: [
        line([1.349, 3.000], [-1.966, -4.798, 0.000]), // rise of the low band over the room, 10 dB
        line([0.570, 2.500], [4.272, 1.890, 0.000]), // the same less twice the room's unrest, 10 dB
        line([-0.247, -0.083], [0.381, -0.467, -1.030]), // share of the low band in the excess, 10 dB
        line([-0.714, -0.056], [0.522, -0.420, 0.206]), // 31–94 Hz over 94–203 Hz, 10 dB
        line([-0.877, -0.361], [0.977, -0.179, -1.356]), // 203–406 Hz over the low band, 10 dB
        line([-1.372, -0.688], [-0.450, -0.547, -2.091]), // 406–1625 Hz over the low band, 10 dB
        line([-1.121, -0.675], [0.885, 1.073, -2.995]), // 1625–3400 Hz over 406–1625 Hz, 10 dB
        line([0.165, 0.258], [-1.239, -0.254, 0.287]), // periodicity of the excess, 80–400 Hz
        line([-0.679, -0.157], [-0.031, 0.671, -0.160]), // flatness of the low band, 10 dB
        line([-2.000, -0.440], [0.090, 0.090, -2.517]), // flatness of 406–1625 Hz, 10 dB
        line([0.112, 0.530], [1.903, 1.397, -4.696]), // fall from the peak of the last 0.2 s, 10 dB
        line([0.076, 0.121], [0.718, -1.615, -3.365]), // change of the low band from frame to frame, 10 dB
        line([0.773, 2.176], [0.613, -0.744, 0.617]), // rise of 406–1625 Hz over the room, 10 dB
        line([-0.245, -0.094], [6.740, 4.483, 0.114]), // flatness of the low band over 80 ms, 10 dB
    ],
};

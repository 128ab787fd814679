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
    bias: 4.860,
    lines: [
        line([1.255, 3.000], [-0.503, -4.973, 0.000]), // rise of the low band over the room, 10 dB
        line([0.491, 2.471], [3.479, 2.034, 0.208]), // the same less twice the room's unrest, 10 dB
        line([-0.243, -0.081], [0.059, -0.410, -0.596]), // share of the low band in the excess, 10 dB
        line([-0.636, -0.005], [0.689, -0.973, 0.395]), // 31–94 Hz over 94–203 Hz, 10 dB
        line([-0.910, -0.389], [1.202, -0.737, -1.206]), // 203–406 Hz over the low band, 10 dB
        line([-1.375, -0.632], [0.365, -1.506, 0.207]), // 406–1625 Hz over the low band, 10 dB
        line([-1.176, -0.676], [1.600, 0.169, -2.647]), // 1625–3400 Hz over 406–1625 Hz, 10 dB
        line([0.167, 0.276], [-0.127, 0.697, 0.445]), // periodicity of the excess, 80–400 Hz
        line([-0.900, -0.158], [0.274, -0.048, -1.755]), // flatness of the low band, 10 dB
        line([-2.000, -0.505], [0.191, 0.191, -0.388]), // flatness of 406–1625 Hz, 10 dB
        line([0.126, 0.589], [1.188, 0.530, -3.996]), // fall from the peak of the last 0.2 s, 10 dB
        line([0.052, 0.083], [0.485, -0.497, -1.256]), // roughness of the low band's level (second difference), 10 dB
        line([0.605, 1.874], [0.166, -1.635, 1.205]), // rise of 406–1625 Hz over the room, 10 dB
        line([-0.290, -0.093], [3.823, 4.047, -1.568]), // flatness of the low band over 80 ms, 10 dB
    ],
};

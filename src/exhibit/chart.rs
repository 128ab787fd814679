//! Charts of an exhibit: boards on which curves show what is measured.

use soffio_math::Pose;

/// A board with curves of the last seconds: time runs to the right, the scale is logarithmic.
#[derive(Clone, Debug, PartialEq)]
pub struct Chart {
    /// Name, unique in the exhibit.
    pub name: String,
    /// Lower left corner of the board in the world; x points to the right, y up.
    pub pose: Pose,
    /// Width and height, m.
    pub size: [f64; 2],
    /// Values at the lower and the upper edge, m, the first above zero and below the second.
    pub range: [f64; 2],
    /// Time from the left edge to the right one, s.
    pub seconds: f64,
    /// Radius of the line, m.
    pub radius: f32,
    /// The curves.
    pub curves: Vec<Curve>,
}

impl Chart {
    /// Height on the board of a value, 0 at its lower edge … 1 at its upper one, where values beyond stay too.
    pub fn height(&self, value: f64) -> f64 {
        let [low, high] = self.range;
        let value = value.clamp(low, high);
        soffio_math::ln(value / low) / soffio_math::ln(high / low)
    }
}

/// A curve of a chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// What it shows.
    pub measured: Measured,
    /// Linear colour.
    pub color: [f32; 3],
}

/// What a curve shows.
#[derive(Clone, Debug, PartialEq)]
pub enum Measured {
    /// The greatest error of these constraints, m.
    JointError {
        /// Index of the body that was named.
        body: usize,
        /// Indices of the constraints.
        constraints: Vec<usize>,
    },
    /// How far a body's centre of mass is from where that of its like is, each from its own start, m.
    Departure {
        /// Index of the body.
        body: usize,
        /// Index of the body that it is compared with.
        like: usize,
    },
}

//! Signals: numbers that an exhibit computes while it moves, for its voluntary motion.

use soffio_math::DVec3;
use soffio_math::expression::Expression;

/// Names of the numbers that every expression knows, before those of the signals: the time since the reset, s, and the speed of the
/// breath at the lips, m/s.
pub const GIVEN: [&str; 2] = ["time", "breath"];

/// A number that is computed once a step.
#[derive(Clone, Debug, PartialEq)]
pub struct Signal {
    /// Name, unique in the exhibit.
    pub name: String,
    /// Where it comes from.
    pub source: SignalSource,
    /// Springs whose rest length or rest angle it is, m or rad.
    pub springs: Vec<usize>,
}

/// Where a signal comes from.
#[derive(Clone, Debug, PartialEq)]
pub enum SignalSource {
    /// An expression of [`GIVEN`] numbers and of all signals, of which those after it, and itself, are a step old.
    Value(Expression),
    /// The integral over time of such an expression, from 0.
    Rate(Expression),
    /// Speed of the air at a body's centre of mass along a direction of the world, m/s.
    Wind {
        /// Index of the body.
        body: usize,
        /// Unit direction.
        direction: DVec3,
    },
    /// Way of a body's centre of mass since the start along a direction of the world, m.
    Way {
        /// Index of the body.
        body: usize,
        /// Unit direction.
        direction: DVec3,
    },
}

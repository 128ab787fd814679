//! Signals: numbers that an exhibit computes at the beginning of each step, and gives to the springs that follow them.
//!
//! A value is evaluated; a rate r is integrated, s ← s + r Δt. A spring's rest stays in a step; the signal's
//! rate since the step before acts through the spring's damping.

use super::motion::Motion;
use super::rate::DT;
use soffio_exhibit::Exhibit;
use soffio_exhibit::signal::{GIVEN, Signal, SignalSource};
use soffio_math::DVec3;

/// Values of all signals.
#[derive(Clone, Debug)]
pub(crate) struct Signals {
    /// Those of [`GIVEN`], then those of the exhibit's signals.
    values: Vec<f64>,
    /// Centres of mass at the start, m.
    starts: Vec<DVec3>,
    /// Whether no step has been yet.
    fresh: bool,
}

impl Signals {
    /// At the exhibit's start.
    pub fn new(exhibit: &Exhibit) -> Self {
        Self {
            values: vec![0.0; GIVEN.len() + exhibit.signals.len()],
            starts: exhibit.bodies.iter().map(|body| body.pose.point(body.properties.center)).collect(),
            fresh: true,
        }
    }

    /// Computes the signals `elapsed` seconds after the reset, for a breath of this speed at the lips (m/s), and gives them to the
    /// springs. `air` is the velocity of the air at a point, m/s.
    pub fn advance(
        &mut self,
        signals: &[Signal],
        (elapsed, breath): (f64, f64),
        air: impl Fn(DVec3) -> DVec3,
        motion: &mut Motion,
    ) {
        self.values[..GIVEN.len()].copy_from_slice(&[elapsed, breath]);
        for (index, signal) in signals.iter().enumerate() {
            let own = GIVEN.len() + index;
            let before = self.values[own];
            let position = |body: usize| motion.dynamics.bodies[body].position;
            let value = match &signal.source {
                SignalSource::Value(expression) => expression.evaluate(&self.values),
                SignalSource::Rate(expression) => before + DT * expression.evaluate(&self.values),
                SignalSource::Wind { body, direction } => air(position(*body)).dot(*direction),
                SignalSource::Way { body, direction } => (position(*body) - self.starts[*body]).dot(*direction),
            };
            let value = if value.is_finite() { value } else { before };
            self.values[own] = value;
            let rate = if self.fresh { 0.0 } else { (value - before) / DT };
            signal.springs.iter().for_each(|&spring| motion.give_rest(spring, value, rate));
        }
        self.fresh = false;
    }

    /// Present value of a signal by its index in the exhibit.
    pub fn value(&self, signal: usize) -> f64 {
        self.values[GIVEN.len() + signal]
    }
}

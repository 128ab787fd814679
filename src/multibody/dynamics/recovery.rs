//! Validation of the bodies' numbers, and recovery from diverged ones.

use crate::articulation::lane_blocks::{BlockBodies, State};
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_math::lanes::One;

/// Faster than this is invalid, m/s and rad/s. Diverging numbers multiply in each step and exceed any bound within a few. Real
/// motion stays below: the tip of a whip with all the energy of its fall reaches a few hundred m/s, and a body of a millimetre
/// at 100 m/s spins at 10⁵ rad/s.
const SPEED_LIMIT: f64 = 1_000.0;
const SPIN_LIMIT: f64 = 100_000.0;

/// The state that bodies are put back to.
#[derive(Clone)]
pub(super) struct Recovery {
    /// At the beginning of the last step.
    before: Vec<State<f64>>,
    /// The bodies have not changed since they were validated.
    validated: bool,
}

impl Recovery {
    /// For so many bodies.
    pub fn new(bodies: usize) -> Self {
        Self { before: vec![State::default(); bodies], validated: false }
    }

    /// The bodies have changed and must be validated again.
    pub fn invalidate(&mut self) {
        self.validated = false;
    }

    /// Stores the state at the beginning of a step.
    pub fn begin_step(&mut self, bodies: &[RigidBody]) {
        self.validated = false;
        for (before, body) in self.before.iter_mut().zip(bodies) {
            *before = State::of(One(0), |_| body);
        }
    }

    /// Puts all bodies back to the beginning of the step, at rest, if one is invalid. Returns the first invalid body.
    pub fn recover(&mut self, bodies: &mut [RigidBody]) -> Option<usize> {
        if std::mem::replace(&mut self.validated, true) {
            return None;
        }
        let fault = bodies.iter().position(|body| !is_valid(body))?;
        // An invalid body has already pulled at its neighbours, so all are put back.
        for (body, before) in bodies.iter_mut().zip(&self.before) {
            before.put(One(0), &BlockBodies::first(0), std::slice::from_mut(body));
            (body.velocity, body.angular_velocity) = (DVec3::ZERO, DVec3::ZERO);
        }
        Some(fault)
    }
}

fn is_valid(body: &RigidBody) -> bool {
    // NaN fails every comparison.
    body.velocity.length_squared() < SPEED_LIMIT * SPEED_LIMIT
        && body.angular_velocity.length_squared() < SPIN_LIMIT * SPIN_LIMIT
        && body.is_finite()
}

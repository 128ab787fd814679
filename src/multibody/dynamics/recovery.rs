//! Numbers that run away: found, and the figure put back.

use crate::articulation::quads::{Members, State};
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_math::lanes::One;

/// Faster than this is not a sculpture but a fault, m/s and rad/s. Numbers that run away grow manifold in each step and
/// are past any bound within a few; what really moves stays below: the tip of a whip that has all the energy of its fall
/// is of a few hundred m/s, and a part of a millimetre that goes at 100 m/s turns at 10⁵ rad/s.
const SPEED_LIMIT: f64 = 1_000.0;
const SPIN_LIMIT: f64 = 100_000.0;

/// What a figure is put back to.
#[derive(Clone)]
pub(super) struct Recovery {
    /// Where the last step began.
    before: Vec<State<f64>>,
    /// Nothing has moved or set bodies since their numbers were looked at.
    validated: bool,
}

impl Recovery {
    /// For so many bodies.
    pub fn new(bodies: usize) -> Self {
        Self { before: vec![State::default(); bodies], validated: false }
    }

    /// Bodies move or are set: their numbers are to be looked at again.
    pub fn invalidate(&mut self) {
        self.validated = false;
    }

    /// Notes where a step begins.
    pub fn begin_step(&mut self, bodies: &[RigidBody]) {
        self.validated = false;
        for (before, body) in self.before.iter_mut().zip(bodies) {
            *before = State::of(One(0), |_| body);
        }
    }

    /// Puts all bodies back to where the step began, at rest, if one has bad numbers. Returns the first such body.
    pub fn restore(&mut self, bodies: &mut [RigidBody]) -> Option<usize> {
        if std::mem::replace(&mut self.validated, true) {
            return None;
        }
        let fault = bodies.iter().position(|body| !is_valid(body))?;
        // One bad body has already pulled at its neighbours: the whole figure goes back.
        for (body, before) in bodies.iter_mut().zip(&self.before) {
            before.put(One(0), &Members::first(0), std::slice::from_mut(body));
            (body.velocity, body.angular_velocity) = (DVec3::ZERO, DVec3::ZERO);
        }
        Some(fault)
    }
}

fn is_valid(body: &RigidBody) -> bool {
    // What is no number is below nothing.
    body.velocity.length_squared() < SPEED_LIMIT * SPEED_LIMIT
        && body.angular_velocity.length_squared() < SPIN_LIMIT * SPIN_LIMIT
        && body.is_finite()
}

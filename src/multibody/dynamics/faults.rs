//! Numbers that run away: found, told, and the figure put back.

use super::{Dynamics, Known};
use crate::articulation::quads::Members;
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_math::lanes::One;

/// Faster than this is not a sculpture but a fault, m/s and rad/s. Numbers that run away grow manifold in each step and
/// are past any bound within a few; what really moves stays below: the tip of a whip that has all the energy of its fall
/// is of a few hundred m/s, and a part of a millimetre that goes at 100 m/s turns at 10⁵ rad/s.
const SPEED_LIMIT: f64 = 1_000.0;
const SPIN_LIMIT: f64 = 100_000.0;

impl Dynamics {
    /// Puts the figure back to where the last step began if a body has bad numbers; says which one was the first. A step
    /// begins with it: whoever looks at the bodies before that, and may have set them, calls it himself.
    pub fn mend(&mut self) -> Option<usize> {
        self.fault = None;
        self.restore_bad_bodies();
        self.fault
    }

    /// Puts bodies with bad numbers back to where the step began, at rest. Returns how many.
    pub(super) fn restore_bad_bodies(&mut self) -> usize {
        let sane = |body: &RigidBody| {
            // What is no number is below nothing.
            body.velocity.length_squared() < SPEED_LIMIT * SPEED_LIMIT
                && body.angular_velocity.length_squared() < SPIN_LIMIT * SPIN_LIMIT
                && body.is_finite()
        };
        if std::mem::replace(&mut self.sane, true) {
            return 0;
        }
        let bad = self.bodies.iter().filter(|body| !sane(body)).count();
        if bad > 0 {
            self.fault = self.fault.or(self.bodies.iter().position(|body| !sane(body)));
            // One bad body has already pulled at its neighbours: the whole figure goes back.
            for (body, before) in self.bodies.iter_mut().zip(&self.before_step) {
                before.put(One(0), &Members::first(0), std::slice::from_mut(body));
                (body.velocity, body.angular_velocity) = (DVec3::ZERO, DVec3::ZERO);
            }
            self.loads.fill(0.0);
            self.wake_all();
            self.system.begin_trains(&self.bodies);
            self.contacts.forget(&self.bodies);
            self.run.end();
            (self.fourth_step, self.stride) = (None, f64::INFINITY);
            self.known = Known::Nothing;
        }
        bad
    }
}

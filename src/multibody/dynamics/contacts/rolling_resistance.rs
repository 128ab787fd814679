//! What resists the turning of surfaces that rest on each other: rolling resistance and drilling friction.
//!
//! Surfaces give way, so that what rolls must climb what it has pressed in, and what spins rubs over a small patch
//! instead of a point. Both are couples C in proportion to the normal force N. With ω the relative angular velocity, n the
//! normal, and two lengths b and d of the pair of surfaces,
//!
//! ```text
//! rolling     |C_T| ≤ b N     ω_T = 0 below the bound, C_T = −b N ω_T/|ω_T| on it
//! drilling    |C_n| ≤ d N     ω_n = 0 below the bound, C_n = −d N sign ω_n on it
//! ```
//!
//! which are Coulomb's laws of turning. b is how far N stands ahead of the centre; a round patch of radius a under Hertz's
//! pressure p = 3N/(2π a²) √(1 − ρ²/a²) that slides with the coefficient μ has d = ∫ μ p ρ dA/N = 3π μ a/16. A ball of radius
//! r and inertia k m r² that rolls on a level then slows down by b g/(r (1 + k)), 5/7 b g/r where it is solid, and stands
//! still; a ball that spins in place loses d g/(k r²) of its spin a second.
//!
//! In the contact problem a couple is a touch of its own, slave to the normal impulse of its point.

use super::contact::{Contact, RollingResistance, Twist};
use super::contact_problem::ContactProblem;
use super::jacobian_row::rolling_resistance_rows;

impl ContactProblem {
    /// Adds the couple of the touch at `of`, a point of a pair of these bodies.
    pub(super) fn push_twist(&mut self, of: usize, bodies: [Option<usize>; 2], resistance: RollingResistance) {
        let Contact { source, point, normal, .. } = self.contacts[of];
        // Nothing is moved out of it: it has no gap to speak of.
        let mut contact = Contact::new(source, point, normal, f64::INFINITY, 0.0);
        contact.twist = Some(Twist { of, resistance });
        self.push(contact, &rolling_resistance_rows(normal, bodies));
    }
}

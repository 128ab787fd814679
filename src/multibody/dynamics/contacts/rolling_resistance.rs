//! Rolling resistance and drilling friction: couples against the relative rotation of two surfaces in contact.
//!
//! Soft surfaces resist rolling, because a ball climbs the dent that it presses, and spin, because it rubs over a small patch.
//! Both couples C are bounded in proportion to the normal force N. With ω the relative angular velocity, n the normal, and
//! two lengths b and d of the pair of surfaces,
//!
//! ```text
//! rolling     |C_T| ≤ b N     ω_T = 0 below the bound, C_T = −b N ω_T/|ω_T| on it
//! drilling    |C_n| ≤ d N     ω_n = 0 below the bound, C_n = −d N sign ω_n on it
//! ```
//!
//! These are Coulomb's laws for rotation. b is how far N stands ahead of the centre. A round patch of radius a under Hertz's
//! pressure p = 3N/(2π a²) √(1 − ρ²/a²) that slides with the coefficient μ has d = ∫ μ p ρ dA/N = 3π μ a/16.
//!
//! A ball of radius r and inertia k m r² on a level then slows down by b g/(r (1 + k)), 5/7 b g/r where it is solid, and
//! stops. A ball that spins in place loses d g/(k r²) of its angular velocity a second.

use super::contact::{Contact, ContactKind, RollingResistance};
use super::contact_problem::ContactProblem;
use super::jacobian_row::rolling_resistance_rows;

impl ContactProblem {
    /// Adds the rolling resistance of the contact point at index `point`, of a pair of these bodies.
    pub(super) fn push_rolling_resistance(
        &mut self,
        point: usize,
        bodies: [Option<usize>; 2],
        resistance: RollingResistance,
    ) {
        let of = self.contacts[point];
        let Some(pair) = of.point_pair() else { return };
        let contact = Contact::without_gap(ContactKind::Rolling { pair, point, resistance }, of.point, of.normal);
        self.push(contact, &rolling_resistance_rows(of.normal, bodies));
    }
}

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

use super::problem::Problem;
use super::row::twist_rows;
use super::touch::{LOCKED, ROUNDING, Resistance, Touch, Twist};
use soffio_math::{DVec2, DVec3};

impl Problem {
    /// Adds the couple of the touch at `of`, a point of a pair of these bodies.
    pub(super) fn push_twist(&mut self, of: usize, bodies: [Option<usize>; 2], resistance: Resistance) {
        let Touch { source, point, normal, .. } = self.touches[of];
        // Nothing is moved out of it: it has no gap to speak of.
        let mut touch = Touch::new(source, point, normal, f64::INFINITY, 0.0);
        touch.twist = Some(Twist { of, resistance });
        self.push(touch, &twist_rows(normal, bodies));
    }

    /// What the couple of a touch may be at most, about the normal and across it, N m s.
    pub(super) fn twist_bounds(&self, twist: &Twist) -> DVec2 {
        let Resistance { rolling, spinning } = twist.resistance;
        self.touches[twist.of].impulse.x.max(0.0) * DVec2::new(spinning, rolling)
    }

    /// Lets a couple satisfy its own laws, all else as it is. Answers the largest change of its velocities, rad/s.
    pub(super) fn turn(&mut self, index: usize, twist: &Twist) -> f64 {
        let touch = &self.touches[index];
        let (p, u, k) = (touch.impulse, self.velocity(touch), &touch.k);
        let most = self.twist_bounds(twist);
        let stuck = p - touch.step * u;
        let free = |k: f64| k > LOCKED;
        let impulse = if free(k.x_axis.x) && free(touch.tangential) && within(stuck, most) {
            stuck
        } else {
            let spin = if free(k.x_axis.x) { p.x - u.x / k.x_axis.x } else { 0.0 };
            let roll = if free(touch.tangential) { (p - u / touch.tangential).with_x(0.0) } else { DVec3::ZERO };
            bounded(roll.with_x(spin), most)
        };
        self.set(index, impulse)
    }

    /// Which parts of a couple are below their bounds, so that it holds what would turn: spin, rolling.
    pub(super) fn holds(&self, touch: &Touch, twist: &Twist) -> [bool; 2] {
        let (p, most) = (touch.impulse, self.twist_bounds(twist) * (1.0 - ROUNDING));
        [p.x.abs() < most.x, across(p) < most.y]
    }

    /// A couple brought back within its bounds.
    pub(super) fn bounded_twist(&self, twist: &Twist, impulse: DVec3) -> DVec3 {
        bounded(impulse, self.twist_bounds(twist))
    }
}

fn across(p: DVec3) -> f64 {
    DVec2::new(p.y, p.z).length()
}

fn within(p: DVec3, most: DVec2) -> bool {
    p.x.abs() <= most.x && across(p) <= most.y
}

fn bounded(p: DVec3, most: DVec2) -> DVec3 {
    let roll = DVec2::new(p.y, p.z).clamp_length_max(most.y);
    DVec3::new(p.x.clamp(-most.x, most.x), roll.x, roll.y)
}

//! Compulsive rotation and translation: the source's rule that brings two bodies together at a joint (method 3.2,
//! 3.3), in a form that does not depend on the step.
//!
//! O₁ stays with its joint point c₁; O₂, with its centre x₂ and joint point c₂, is brought there. r = c₂ − x₂ is its
//! arm and s = c₁ − c₂ the displacement of its joint point:
//!
//! ```text
//! A = (r × s)/|r × s|      ψ = ∠(r, r + s)      θ = ψ |r|²/(|r|² + h)      h = c I₂/m₂,   I₂ = A·I A
//! T = (E − R) r + s        which is r + s = R r + T
//! ```
//!
//! The source has θ = φ exp(−h/(|r||s|)) with φ = ∠(r, s). Its θ is between 0 and φ, grows with arm and displacement, and shrinks
//! with inertia; so does ours, since ψ grows from 0 to φ with |s|. But the exponential falls faster than any power of s: in a short step
//! it is 0, and gravity turns nothing. The source derives its form from rotational dynamics: an imaginary force at c₂ that moves it by s
//! turns the body by θ = (m₂/I₂)|r × s|. Ours is that for short arms, and for all arms the θ of least kinetic energy,
//!
//! ```text
//! min ½ m₂ |T − …|² + ½ I₂ θ²:     θ = |r × s|/(|r|² + I₂/m₂)       with c = 1, to first order in s
//! ```
//!
//! which is linear in s: twice as many steps of half the way turn as much. c > 1 turns less, c < 1 more.
//!
//! Two free bodies both move to the point c, in inverse proportion to their masses,
//!
//! ```text
//! m₁ (c₁ − c) = m₂ (c − c₂)        c = (m₁ c₁ + m₂ c₂)/(m₁ + m₂)
//! ```
//!
//! θ is limited to [`MAX_ROTATION`] in one sweep, or a body would tumble between two hands that push.

use soffio_math::{DMat3, DVec3, atan2};

/// Largest rotation of a body in one sweep, rad.
pub const MAX_ROTATION: f64 = 0.5;

/// A body with its loads: a rigid body of the same shape, with each load as a point mass at its joint. So a beam with two loads
/// balances where they do, and a load may swing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Group {
    /// Mass of all, kg.
    pub mass: f64,
    /// Centre of mass, m.
    pub center: DVec3,
    /// Moment of inertia about it, world axes, kg m².
    pub inertia: DMat3,
}

impl Group {
    /// The same group with a point mass (kg) at a point (m) more: the parallel-axis theorem, with the reduced mass of both.
    pub fn with_load(self, mass: f64, point: DVec3) -> Self {
        let sum = self.mass + mass;
        let apart = point - self.center;
        let reduced = self.mass * mass / sum;
        let along = DMat3::from_cols(apart * apart.x, apart * apart.y, apart * apart.z);
        Self {
            mass: sum,
            center: self.center + apart * (mass / sum),
            inertia: self.inertia + (DMat3::from_diagonal(DVec3::splat(apart.length_squared())) - along) * reduced,
        }
    }
}

/// Compulsive rotation θ A of the module's head (rad) of a group whose joint point has the arm r (m) and the displacement s (m), with the
/// control c.
pub fn compulsive_rotation(r: DVec3, s: DVec3, control: f64, inertia: &DMat3, mass: f64) -> DVec3 {
    let w = angle_vector(r, r + s).clamp_length_max(MAX_ROTATION);
    let Some(axis) = w.try_normalize() else { return DVec3::ZERO };
    let h = control * axis.dot(*inertia * axis) / mass;
    let arm_squared = r.length_squared();
    w * (arm_squared / (arm_squared + h))
}

/// Compulsive translation T of the module's head, m, for a body rotated by R.
pub fn compulsive_translation(r: DVec3, s: DVec3, rotation: &DMat3) -> DVec3 {
    r - *rotation * r + s
}

/// Point at which two free bodies join: the mean of their joint points, weighted by mass.
pub fn common_point((m1, c1): (f64, DVec3), (m2, c2): (f64, DVec3)) -> DVec3 {
    (m1 * c1 + m2 * c2) / (m1 + m2)
}

/// Axis times angle from one direction to another, rad; zero where they are parallel.
fn angle_vector(from: DVec3, to: DVec3) -> DVec3 {
    let across = from.cross(to);
    let sine = across.length();
    // Parallel directions have no preferred axis, and need none.
    if sine <= f64::MIN_POSITIVE { DVec3::ZERO } else { across * (atan2(sine, from.dot(to)) / sine) }
}

//! Compulsive rotation and translation: the source's rule that brings two bodies together at a joint (method 3.2,
//! 3.3).
//!
//! O₁ stays with its joint point c₁; O₂, with its centre x₂ and joint point c₂, is brought there. r = c₂ − x₂ is its
//! arm and s = c₁ − c₂ the displacement of its joint point:
//!
//! ```text
//! A = (r × s)/|r × s|      φ = ∠(r, s)      θ = φ exp(−h/(|r||s|))      h = c I₂/m₂,   I₂ = A·I A
//! T = (E − R) r + s        which is r + s = R r + T
//! ```
//!
//! The longer arm and displacement, the closer θ is to φ; the more inertia, the less O₂ rotates (h has the unit m²).
//! Two free bodies both move to the point c, in inverse proportion to their masses,
//!
//! ```text
//! m₁ (c₁ − c) = m₂ (c − c₂)        c = (m₁ c₁ + m₂ c₂)/(m₁ + m₂)
//! ```
//!
//! A load behind O₂ counts in m₂, not in I₂ (method 3.4: a group has the shape of its first body and the mass of
//! all). So a body with a large load rotates into the pull instead of being carried along.
//!
//! Small displacements rotate nothing by this rule, so sweeps from several fixed bodies would oscillate for ever.
//! From the second sweep on a body *aims*: it rotates by the angle from r to r + s, which keeps its centre on the
//! line of its arm, times |r|²/(|r|² + I₂/m₂). A wheel held at its centre does not rotate. That angle never exceeds
//! φ, and vanishes with s. It is limited to [`MAX_AIM_ROTATION`] in one sweep, or a body would tumble between two
//! hands that push.

use soffio_math::{DMat3, DVec3, atan2, exp};

/// Largest rotation of an aiming body in one sweep, rad.
pub const MAX_AIM_ROTATION: f64 = 0.5;

/// Rule for the rotation of a body whose joint point is pulled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum RotationRule {
    /// The source's θ with the control c (no unit; 0 rotates by all of φ).
    Compulsive(f64),
    /// Aims r towards r + s.
    Aim,
}

/// Rotation vector (rad) of a body with this arm (m), displacement (m), inertia (kg m², world axes) and mass (kg).
pub fn rotation_vector(rotation_rule: RotationRule, r: DVec3, s: DVec3, inertia: &DMat3, mass: f64) -> DVec3 {
    match rotation_rule {
        RotationRule::Compulsive(control) => compulsive_rotation(r, s, control, inertia, mass),
        RotationRule::Aim => {
            let w = angle_vector(r, r + s).clamp_length_max(MAX_AIM_ROTATION);
            let Some(axis) = w.try_normalize() else { return DVec3::ZERO };
            let (arm_squared, gyration) = (r.length_squared(), axis.dot(*inertia * axis) / mass);
            w * (arm_squared / (arm_squared + gyration))
        }
    }
}

/// Compulsive rotation θ A of the module's head, rad.
pub fn compulsive_rotation(r: DVec3, s: DVec3, control: f64, inertia: &DMat3, mass: f64) -> DVec3 {
    let Some(axis) = r.cross(s).try_normalize() else { return DVec3::ZERO };
    let h = control * axis.dot(*inertia * axis) / mass;
    angle_vector(r, s) * exp(-h / (r.length() * s.length()))
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

//! The source's rule for two objects: compulsive rotation and translation (method 3.2, 3.3).
//!
//! O₁ stays with its joint point c₁; O₂, with its centre x₂ and joint point c₂, is brought there. r = c₂ − x₂ is its
//! arm and s = c₁ − c₂ the way that its joint point has to go:
//!
//! ```text
//! A = (r × s)/|r × s|      φ = ∠(r, s)      θ = φ exp(−h/(|r||s|))      h = c I₂/m₂,   I₂ = A·I A
//! T = (E − R) r + s        which is r + s = R r + T
//! ```
//!
//! The longer arm and way, the nearer θ comes to φ; the more inertia, the less it turns (h has the unit m²). With two
//! free objects both go to the point c that moves each in inverse proportion to its mass,
//!
//! ```text
//! m₁ (c₁ − c) = m₂ (c − c₂)        c = (m₁ c₁ + m₂ c₂)/(m₁ + m₂)
//! ```
//!
//! A heavier load behind O₂ is in m₂ and not in I₂ (method 3.4: the group has the shape of its first body and the mass
//! of all), so that a body with much behind it turns into the pull instead of being carried along.
//!
//! Small ways turn nothing by this rule, so passes from several fixed objects would push the rest to and fro for ever.
//! From the second pass on a body *reaches*: it turns by the angle from r to r + s, at which its centre would stay on the
//! line of its arm, times |r|²/(|r|² + I₂/m₂), as a wheel that is held by its centre has no reason to turn. That angle
//! never exceeds φ, and vanishes with s; in one pass a body reaches by [`LONGEST_REACH`] at most, or it would turn end over
//! end between two hands that push.

use soffio_math::{DMat3, DVec3, atan2, exp};

/// Longest turn of a body that reaches, rad.
pub const LONGEST_REACH: f64 = 0.5;

/// How far a body turns when its joint point is pulled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Turning {
    /// The source's θ with the control c (no unit; 0 turns by all of φ).
    Compulsive(f64),
    /// From r towards r + s.
    Reach,
}

/// Rotation vector θ A (rad) of a body with this arm, way, inertia (kg m², world axes) and mass (kg).
pub fn turn(turning: Turning, r: DVec3, s: DVec3, inertia: &DMat3, mass: f64) -> DVec3 {
    match turning {
        Turning::Compulsive(control) => compulsive_rotation(r, s, control, inertia, mass),
        Turning::Reach => {
            let w = angle_vector(r, r + s).clamp_length_max(LONGEST_REACH);
            let Some(axis) = w.try_normalize() else { return DVec3::ZERO };
            let (square, gyration) = (r.length_squared(), axis.dot(*inertia * axis) / mass);
            w * (square / (square + gyration))
        }
    }
}

/// θ A of the file's head.
pub fn compulsive_rotation(r: DVec3, s: DVec3, control: f64, inertia: &DMat3, mass: f64) -> DVec3 {
    let Some(axis) = r.cross(s).try_normalize() else { return DVec3::ZERO };
    let h = control * axis.dot(*inertia * axis) / mass;
    angle_vector(r, s) * exp(-h / (r.length() * s.length()))
}

/// T of the file's head, for a body that is turned by R.
pub fn compulsive_translation(r: DVec3, s: DVec3, rotation: &DMat3) -> DVec3 {
    r - *rotation * r + s
}

/// The point at which two free objects join.
pub fn common_point((m1, c1): (f64, DVec3), (m2, c2): (f64, DVec3)) -> DVec3 {
    (m1 * c1 + m2 * c2) / (m1 + m2)
}

/// Axis times angle from one direction to another, rad; zero where they lie along one line.
fn angle_vector(from: DVec3, to: DVec3) -> DVec3 {
    let across = from.cross(to);
    let sine = across.length();
    // Along one line no axis is better than another, and none is asked for.
    if sine <= f64::MIN_POSITIVE { DVec3::ZERO } else { across * (atan2(sine, from.dot(to)) / sine) }
}

//! Orientation (1 row): T · N held, T and N directions fixed in two bodies, or one in the world.
//!
//! The cosine c = T·N itself makes a poor error when it is large (its Jacobian vanishes where T and N meet), so the
//! row holds the angle of T above the plane across N:
//!
//! ```text
//! C = asin c − f(t)         c = T·N         s = |T×N| = √(1 − c²)         e = (T×N)/s
//! ċ = (ω_T×T)·N + T·(ω_N×N) = (T×N)·(ω_T − ω_N)
//! Ċ = ċ/s − ḟ               J_T = (0, e), J_N = −(0, e)
//! c̈ = (T×N)·(ω̇_T − ω̇_N) + b     b = (ω_T×(ω_T×T))·N + T·(ω_N×(ω_N×N)) + 2 (ω_T×T)·(ω_N×N)
//! J̇ẋ = b/s + c ċ²/s³
//! ```
//!
//! At C = 0 this is the source's row. Far from it a transition between two axes runs as one critically damped turn,
//! where the cosine would make it fast near the end and stuck at the start. Where T and N coincide, any axis across
//! them is as good for this row; the one is taken that the rows beside it leave free.

use super::{BodyStates, JacobianRow, negated};
use crate::articulation::Axis;
use soffio_math::Function;
use soffio_math::spatial::vec6;
use soffio_math::{DVec3, atan2, tangents};

/// Below this sine the axes coincide, rad.
const COINCIDE: f64 = 1e-6;

/// The axis e about which a row turns T against N; `None` where they coincide.
pub fn axis(scene: &BodyStates, a: &Axis, b: &Axis) -> Option<DVec3> {
    let across = scene.direction(a).n.cross(scene.direction(b).n);
    (across.length() > COINCIDE).then(|| across.normalize())
}

/// The row. `held` is an axis about which T is held by another row, asked where T and N coincide.
#[inline(always)]
pub fn row(
    scene: &BodyStates,
    a: &Axis,
    b: &Axis,
    angle: &Function,
    held_axis: impl FnOnce() -> Option<DVec3>,
) -> JacobianRow {
    let f = angle.at(scene.time);
    let (t, n) = (scene.direction(a), scene.direction(b));
    let (dt, dn) = (t.spin.cross(t.n), n.spin.cross(n.n));
    let (c, across) = (t.n.dot(n.n), t.n.cross(n.n));
    let s = across.length();
    let (e, bias) = if s > COINCIDE {
        let dc = dt.dot(n.n) + t.n.dot(dn);
        let b = t.spin.cross(dt).dot(n.n) + t.n.dot(n.spin.cross(dn)) + 2.0 * dt.dot(dn);
        (across / s, b / s + c * dc * dc / (s * s * s))
    } else {
        let free = held_axis().and_then(|held_axis| t.n.cross(held_axis).try_normalize());
        (free.unwrap_or_else(|| tangents(t.n).0), 0.0)
    };
    let j = vec6(DVec3::ZERO, e);
    JacobianRow {
        a: j,
        b: negated(j),
        value: atan2(c, s) - f.value,
        prescribed_rate: f.rate,
        bias: bias - f.acceleration,
        length: false,
    }
}

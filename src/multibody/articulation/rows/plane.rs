//! Point-on-plane (1 row): C = N · (P − S) − f(t), N and S fixed in one body (or the world, or a driven body).
//!
//! ```text
//! d = P − S       Ṅ = ω_s×N       Ṡ = v_s + ω_s×r_s
//! Ċ = N·(Ṗ − Ṡ) + (ω_s×N)·d − ḟ
//!   = N·(v_p + ω_p×r_p) − N·v_s − ω_s·(r_s×N + d×N) − ḟ
//! J_p = (N, r_p×N)          J_s = −(N, (r_s + d)×N)              the plane's body feels the force at P itself
//! J̇ẋ = N·(ω_p×(ω_p×r_p) − ω_s×(ω_s×r_s)) + 2 (ω_s×N)·(Ṗ − Ṡ) + (ω_s×(ω_s×N))·d
//! ```
//!
//! Two planes make a line; three, with f a function of time, carry a point along any path.

use super::{BodyStates, JacobianRow, at, negated};
use crate::articulation::{Anchor, Axis};
use soffio_math::DVec3;
use soffio_math::Function;

/// C alone.
pub fn value(scene: &BodyStates, point: &Anchor, plane: &Anchor, normal: DVec3, offset: &Function) -> f64 {
    let n = scene.direction(&Axis { body: plane.body, direction: normal }).n;
    n.dot(scene.place(point) - scene.place(plane)) - offset.at(scene.time).value
}

/// The row.
#[inline(always)]
pub fn row(scene: &BodyStates, point: &Anchor, plane: &Anchor, normal: DVec3, offset: &Function) -> JacobianRow {
    let f = offset.at(scene.time);
    let (p, s) = (scene.point(point), scene.point(plane));
    let n = scene.direction(&Axis { body: plane.body, direction: normal });
    let d = p.position - s.position;
    let dn = n.spin.cross(n.n);
    let bias = n.n.dot(p.centripetal - s.centripetal) + 2.0 * dn.dot(p.velocity - s.velocity) + n.spin.cross(dn).dot(d);
    JacobianRow {
        a: at(n.n, p.arm),
        b: negated(at(n.n, s.arm + d)),
        value: n.n.dot(d) - f.value,
        prescribed_rate: f.rate,
        bias: bias - f.acceleration,
        length: true,
    }
}

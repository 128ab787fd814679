//! Point-to-point (3 rows, e = x, y, z of the world): C = (x₁ + r₁) − (x₂ + r₂).
//!
//! ```text
//! Ċ = v₁ + ω₁×r₁ − v₂ − ω₂×r₂            e·(ω×r) = (r×e)·ω, so J₁ = (e, r₁×e), J₂ = −(e, r₂×e)
//! J̇ẋ = ω₁×(ω₁×r₁) − ω₂×(ω₂×r₂)
//! ```
//!
//! A nail is the same with the world for the second body; a moving nail, with a driven body.

use super::{BodyStates, JacobianRow, at, negated};
use crate::articulation::Anchor;
use soffio_math::DVec3;

/// The three rows.
#[inline(always)]
pub fn rows(scene: &BodyStates, a: &Anchor, b: &Anchor) -> [JacobianRow; 3] {
    let (p, q) = (scene.point(a), scene.point(b));
    let (c, bias) = (p.position - q.position, p.centripetal - q.centripetal);
    std::array::from_fn(|k| {
        let e = DVec3::AXES[k];
        JacobianRow {
            a: at(e, p.arm),
            b: negated(at(e, q.arm)),
            value: c[k],
            prescribed_rate: 0.0,
            bias: bias[k],
            length: true,
        }
    })
}

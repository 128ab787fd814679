//! Quadratic aerodynamic drag of patches in a relative wind, in SIMD blocks of four.
//!
//! With v the relative wind, n the outward normal of a patch (or the direction of a wire), v_n = (v·n) n and v_t = v − v_n,
//!
//! ```text
//! F = k |v_n| v_n + k_t |v_t| v_t
//! ```
//!
//! where k and k_t are ½ ρ A times a gain and a drag coefficient, which [`force`](super::force) gives for each kind of
//! patch. k of a one-sided patch is 0 on its lee. Velocities and forces are in the body's node frame, and moments about its origin.
//!
//! | symbol | here | unit |
//! |---|---|---|
//! | n | `axis` | 1 |
//! | k | `windward`, `leeward` | N s²/m² |
//! | k_t | `across` | N s²/m² |

use fearless_simd::prelude::*;
use fearless_simd::{Simd, SimdBase, f64x4};

use super::breath::AIR_DENSITY;
use super::patches::{Patch, PatchKind};
use soffio_math::lanes::{All, Four, Lanes, V3, WIDTH};
use soffio_math::{DVec3, PI};

/// Drag coefficients of a surface.
#[derive(Clone, Copy)]
pub(super) struct DragCoefficients {
    /// C_D.
    pub normal: f64,
    /// C_f.
    pub tangential: f64,
    /// Multiplies the force.
    pub gain: f64,
}

/// Drag coefficients along a patch's axis and across it.
#[derive(Clone, Copy)]
pub(super) struct AxisDrag {
    /// Coefficient along the axis.
    pub along: f64,
    /// Coefficient across the axis.
    pub across: f64,
}

impl DragCoefficients {
    /// The coefficients with respect to the axis of a patch of this kind.
    pub fn of(&self, kind: PatchKind) -> AxisDrag {
        match kind {
            PatchKind::OneSided | PatchKind::TwoSided => AxisDrag { along: self.normal, across: self.tangential },
            PatchKind::Wire => AxisDrag { along: PI * self.tangential, across: self.normal },
        }
    }
}

/// Four patches of one surface; the force in a lane without a patch is 0.
#[derive(Clone)]
pub(super) struct PatchBlock {
    point: V3<Four>,
    axis: V3<Four>,
    windward: Four,
    leeward: Four,
    across: Four,
    /// Areas, m²; 0 in a lane without a patch.
    area: Four,
}

impl PatchBlock {
    /// Of at most four patches.
    pub fn new(patches: &[Patch], coefficients: &DragCoefficients) -> Self {
        let four = |number: &dyn Fn(&Patch) -> f64| Four(std::array::from_fn(|k| patches.get(k).map_or(0.0, number)));
        let three = |vector: &dyn Fn(&Patch) -> DVec3| {
            V3::new(four(&|p| vector(p).x), four(&|p| vector(p).y), four(&|p| vector(p).z))
        };
        let pressure = |patch: &Patch| 0.5 * AIR_DENSITY * patch.area * coefficients.gain;
        let along = |patch: &Patch| pressure(patch) * coefficients.of(patch.kind).along;
        Self {
            point: three(&|patch| patch.point),
            axis: three(&|patch| patch.axis),
            windward: four(&along),
            leeward: four(&|patch| if patch.kind == PatchKind::OneSided { 0.0 } else { along(patch) }),
            across: four(&|patch| pressure(patch) * coefficients.of(patch.kind).across),
            area: four(&|patch| patch.area),
        }
    }

    /// Velocities of the patches, m/s, from the velocity of the frame's origin (m/s) and its angular velocity (rad/s).
    #[inline(always)]
    pub fn velocities<S: Simd>(&self, simd: S, origin: DVec3, spin: DVec3) -> V3<f64x4<S>> {
        all(simd, origin) + all(simd, spin).cross(self.point.get(All(simd)))
    }

    /// Drag in the relative winds `v` (m/s), N; at most `most` kg/(m² s) of a patch's area times its wind.
    #[inline(always)]
    pub fn drag<S: Simd>(&self, simd: S, v: V3<f64x4<S>>, most: f64) -> V3<f64x4<S>> {
        let lanes = All(simd);
        let force = self.unbounded_drag(simd, v);
        let bound = lanes.get(&self.area) * f64x4::splat(simd, most);
        let (square, bound_square) = (force.dot(force), bound * bound * v.dot(v));
        let one = f64x4::splat(simd, 1.0);
        let share = square.simd_gt(bound_square).select((bound_square / square).sqrt(), one);
        force * share
    }

    #[inline(always)]
    fn unbounded_drag<S: Simd>(&self, simd: S, v: V3<f64x4<S>>) -> V3<f64x4<S>> {
        let lanes = All(simd);
        let axis = self.axis.get(lanes);
        let along = v.dot(axis);
        let across = v - axis * along;
        let strength = along.simd_lt(0.0).select(lanes.get(&self.windward), lanes.get(&self.leeward));
        axis * (strength * along.abs() * along) + across * (lanes.get(&self.across) * across.dot(across).sqrt())
    }

    /// A |v|⁶ in the relative winds `v` (m/s), m² (m/s)⁶, and the same times the patches' points.
    #[inline(always)]
    pub fn noise<S: Simd>(&self, simd: S, v: V3<f64x4<S>>) -> (f64x4<S>, V3<f64x4<S>>) {
        let lanes = All(simd);
        let square = v.dot(v);
        let power = lanes.get(&self.area) * square * square * square;
        (power, self.point.get(lanes) * power)
    }

    /// Moments of forces at the patches about the frame's origin, N m.
    #[inline(always)]
    pub fn moments<S: Simd>(&self, simd: S, forces: V3<f64x4<S>>) -> V3<f64x4<S>> {
        self.point.get(All(simd)).cross(forces)
    }
}

/// The same vector in all lanes.
#[inline(always)]
pub(super) fn all<S: Simd>(simd: S, v: DVec3) -> V3<f64x4<S>> {
    by_lane(simd, |_| v)
}

/// A vector for each lane.
#[inline(always)]
pub(super) fn by_lane<S: Simd>(simd: S, vector: impl Fn(usize) -> DVec3) -> V3<f64x4<S>> {
    let v: [DVec3; WIDTH] = [vector(0), vector(1), vector(2), vector(3)];
    let lanes = All(simd);
    V3::new(lanes.gather(|k| v[k].x), lanes.gather(|k| v[k].y), lanes.gather(|k| v[k].z))
}

/// The vector of lane `k`.
#[inline(always)]
pub(super) fn lane<S: Simd>(v: &V3<f64x4<S>>, k: usize) -> DVec3 {
    DVec3::new(v.x[k], v.y[k], v.z[k])
}

/// Pairwise sum over the lanes.
#[inline(always)]
pub(super) fn sum<S: Simd>(v: &V3<f64x4<S>>) -> DVec3 {
    (lane(v, 0) + lane(v, 1)) + (lane(v, 2) + lane(v, 3))
}

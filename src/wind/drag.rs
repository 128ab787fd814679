//! Drag of patches in a relative wind, four patches side by side.
//!
//! With v the wind past a patch, n its outward normal (of a wire its direction), v_n = (v·n) n and v_t = v − v_n,
//!
//! ```text
//! F = k |v_n| v_n + k_t |v_t| v_t
//! ```
//!
//! where k and k_t are ½ ρ A times a gain and the drag coefficients that [`force`](super::force) gives for each kind of
//! patch; k of a side is 0 on its lee. Velocities and forces are in the body's node frame, and moments about its origin.
//!
//! | symbol | here | unit |
//! |---|---|---|
//! | n | `axis` | 1 |
//! | k | `windward`, `leeward` | N s²/m² |
//! | k_t | `across` | N s²/m² |

use fearless_simd::prelude::*;
use fearless_simd::{Simd, f64x4};

use super::breath::AIR_DENSITY;
use super::patches::{Face, Patch};
use soffio_math::lanes::{All, Four, Lanes, V3, WIDTH};
use soffio_math::{DVec3, PI};

/// How air drags at a surface.
#[derive(Clone, Copy)]
pub(super) struct Coefficients {
    /// C_D and C_f.
    pub normal: f64,
    pub tangential: f64,
    /// Multiplies the force.
    pub gain: f64,
}

impl Coefficients {
    /// Drag coefficients along a patch's axis and across it.
    pub fn of(&self, face: Face) -> (f64, f64) {
        match face {
            Face::Side | Face::Sheet => (self.normal, self.tangential),
            Face::Wire => (PI * self.tangential, self.normal),
        }
    }
}

/// Four patches of one surface; lanes that have none feel nothing.
#[derive(Clone)]
pub(super) struct Quad {
    point: V3<Four>,
    axis: V3<Four>,
    windward: Four,
    leeward: Four,
    across: Four,
}

impl Quad {
    /// Of at most four patches.
    pub fn new(patches: &[Patch], coefficients: &Coefficients) -> Self {
        let four = |number: &dyn Fn(&Patch) -> f64| Four(std::array::from_fn(|k| patches.get(k).map_or(0.0, number)));
        let three = |vector: &dyn Fn(&Patch) -> DVec3| {
            V3::new(four(&|p| vector(p).x), four(&|p| vector(p).y), four(&|p| vector(p).z))
        };
        let pressure = |patch: &Patch| 0.5 * AIR_DENSITY * patch.area * coefficients.gain;
        let along = |patch: &Patch| pressure(patch) * coefficients.of(patch.face).0;
        Self {
            point: three(&|patch| patch.point),
            axis: three(&|patch| patch.axis),
            windward: four(&along),
            leeward: four(&|patch| if patch.face == Face::Side { 0.0 } else { along(patch) }),
            across: four(&|patch| pressure(patch) * coefficients.of(patch.face).1),
        }
    }

    /// The patches' own velocities, m/s, of a frame whose origin moves like this and which spins like this, rad/s.
    #[inline(always)]
    pub fn velocities<S: Simd>(&self, simd: S, origin: DVec3, spin: DVec3) -> V3<f64x4<S>> {
        all(simd, origin) + all(simd, spin).cross(self.point.get(All(simd)))
    }

    /// Drag in these relative winds (m/s), N.
    #[inline(always)]
    pub fn drag<S: Simd>(&self, simd: S, v: V3<f64x4<S>>) -> V3<f64x4<S>> {
        let lanes = All(simd);
        let axis = self.axis.get(lanes);
        let along = v.dot(axis);
        let across = v - axis * along;
        let strength = along.simd_lt(0.0).select(lanes.get(&self.windward), lanes.get(&self.leeward));
        axis * (strength * along.abs() * along) + across * (lanes.get(&self.across) * across.dot(across).sqrt())
    }

    /// Moments of forces at the patches, N m.
    #[inline(always)]
    pub fn moments<S: Simd>(&self, simd: S, forces: V3<f64x4<S>>) -> V3<f64x4<S>> {
        self.point.get(All(simd)).cross(forces)
    }
}

/// One vector for all lanes.
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

/// The vector of one lane.
#[inline(always)]
pub(super) fn lane<S: Simd>(v: &V3<f64x4<S>>, k: usize) -> DVec3 {
    DVec3::new(v.x[k], v.y[k], v.z[k])
}

/// Sum of the four, by pairs.
#[inline(always)]
pub(super) fn sum<S: Simd>(v: &V3<f64x4<S>>) -> DVec3 {
    (lane(v, 0) + lane(v, 1)) + (lane(v, 2) + lane(v, 3))
}

//! Articulated-body elimination of a ball-joint body, in 3×3 blocks, for one body or four lanes.
//!
//! Let c be the body, p its parent, r and s the arms from their centres of mass to the common point, (A, B, C) c's
//! articulated inertia (`soffio_math::spatial`). With u the acceleration of the point instead of the centre's, ω̇
//! unchanged,
//!
//! ```text
//! v̇ = u + [r]× ω̇,   τ' = τ − r × f:    [ f + λ ]   [ A   Q  ] [ u ]      Q = B + A [r]×
//!                                       [ τ'    ] = [ Qᵀ  C' ] [ ω̇ ]      C' = C − ([r]× B)ᵀ − [r]× Q
//! ω̇ = C'⁻¹ τ' − Lᵀ u                          L = Q C'⁻¹
//! λ = N u − (f − L τ')                        N = A − L Qᵀ
//! ```
//!
//! N is the effective mass at the point. The joint requires u = g + (v̇_p + ω̇_p × s), so the parent's terms become
//!
//! ```text
//! A_p += N      B_p += −N [s]×      C_p += −[s]× N [s]×
//! f_p += w      τ_p += s × w        w = f − L τ' − N g
//! ```
//!
//! This is the general elimination of `tree.rs` for the rows J_c = `(E, −r×)`; nothing larger than 3×3 is inverted. A
//! test compares the two.

use soffio_math::lanes::{Four, Lanes, Real, V3};
use soffio_math::spatial::SpatialVector;
use soffio_math::spatial::{Articulated, M3, Sym3};

/// Arms of a ball joint.
#[derive(Clone, Copy, Debug, Default)]
pub struct Arms<T> {
    /// r: from the body's centre of mass to the point, world axes, m.
    pub own: V3<T>,
    /// s: from the parent's centre of mass to the point, world axes, m.
    pub parent: V3<T>,
}

/// Factor of a ball-joint body.
#[derive(Clone, Copy, Debug, Default)]
pub struct BallElimination<T> {
    /// Arms r and s.
    pub arms: Arms<T>,
    /// C'⁻¹.
    inverse_inertia: Sym3<T>,
    /// L.
    force_per_torque: M3<T>,
    /// N.
    effective_mass: Sym3<T>,
}

/// Kinematic errors and loads of the ball joints of one lane block, as seen from the children.
#[derive(Clone, Copy, Debug, Default)]
pub struct BallJointBlock {
    /// C at the last evaluation.
    pub value: V3<Four>,
    /// J̇ẋ there.
    pub bias: V3<Four>,
    /// g, for [`JointTarget::Given`].
    pub wanted: V3<Four>,
    /// τ' of the inward sweep.
    pub torque: V3<Four>,
    /// w of the inward sweep, then λ.
    pub force: V3<Four>,
}

/// Right-hand side g of the ball joints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum JointTarget {
    /// Close the position error: g = −C.
    ClosePosition,
    /// Zero relative acceleration: g = −J̇ẋ.
    ZeroAcceleration,
    /// g = 0.
    Zero,
    /// g as set by `BallJoints::set_targets` or `BallJoints::target_zero_rate`.
    Given,
}

impl<T: Real> BallElimination<T> {
    /// Factors a body with this articulated inertia.
    #[inline(always)]
    pub fn factor(arms: Arms<T>, mass: &Articulated<T>) -> Self {
        let r = arms.own;
        let b = &mass.b;
        let y = mass.a.mul_skew(r);
        let q = M3 { x: b.x + y.x, y: b.y + y.y, z: b.z + y.z };
        // Entry (i, j) of C' needs component j of r × b_i and component i of r × q_j.
        let (bx, by, bz) = (r.cross(b.x), r.cross(b.y), r.cross(b.z));
        let (qx, qy, qz) = (r.cross(q.x), r.cross(q.y), r.cross(q.z));
        let spin = Sym3 {
            d: mass.c.d - V3::new(bx.x + qx.x, by.y + qy.y, bz.z + qz.z),
            o: mass.c.o - V3::new(by.z + qz.y, bx.z + qz.x, bx.y + qy.x),
        };
        let inverse_inertia = spin.inverse();
        let (gx, gy, gz) = (inverse_inertia.x(), inverse_inertia.y(), inverse_inertia.z());
        let force_per_torque = M3 { x: q.mul(gx), y: q.mul(gy), z: q.mul(gz) };
        let taken = Sym3::product(&force_per_torque, &q);
        let effective_mass = Sym3 { d: mass.a.d - taken.d, o: mass.a.o - taken.o };
        Self { arms, inverse_inertia, force_per_torque, effective_mass }
    }

    /// Contribution to the parent's articulated inertia.
    #[inline(always)]
    pub fn load(&self) -> Articulated<T> {
        let (n, s) = (self.effective_mass, self.arms.parent);
        let y = n.mul_skew(s);
        // −[s]× N [s]×, column by column s × (−y).
        let b = M3 { x: -y.x, y: -y.y, z: -y.z };
        let (x, y, z) = (y.x, y.y, y.z);
        let c = Sym3 {
            d: -V3::new(s.cross(x).x, s.cross(y).y, s.cross(z).z),
            o: -V3::new(s.cross(y).z, s.cross(x).z, s.cross(x).y),
        };
        Articulated { a: n, b, c }
    }

    /// Inward step: from the wrench `b` on the body and the required `g`, returns τ' and the force w on the parent's
    /// point.
    #[inline(always)]
    pub fn inward(&self, b: SpatialVector<T>, g: V3<T>) -> (V3<T>, V3<T>) {
        let torque = b.angular - self.arms.own.cross(b.linear);
        (torque, b.linear - self.force_per_torque.mul(torque) - self.effective_mass.mul(g))
    }

    /// Wrench on the parent about its centre of mass of a force at the point.
    #[inline(always)]
    pub fn wrench(&self, w: V3<T>) -> SpatialVector<T> {
        SpatialVector { linear: w, angular: self.arms.parent.cross(w) }
    }

    /// Outward step: the body's acceleration and λ from the parent's acceleration, `g`, τ' and w.
    #[inline(always)]
    pub fn outward(
        &self,
        g: V3<T>,
        (torque, w): (V3<T>, V3<T>),
        parent: SpatialVector<T>,
    ) -> (SpatialVector<T>, V3<T>) {
        let carried = parent.linear + parent.angular.cross(self.arms.parent);
        let lambda = self.effective_mass.mul(carried) - w;
        let u = g + carried;
        let angular = self.inverse_inertia.mul(torque) - self.force_per_torque.transposed_mul(u);
        (SpatialVector { linear: u - angular.cross(self.arms.own), angular }, lambda)
    }
}

impl BallJointBlock {
    /// g for a target.
    #[inline(always)]
    pub fn wanted<L: Lanes>(&self, lanes: L, wanted: JointTarget) -> V3<L::T> {
        match wanted {
            JointTarget::ClosePosition => -self.value.get(lanes),
            JointTarget::ZeroAcceleration => -self.bias.get(lanes),
            JointTarget::Zero => {
                let zero = lanes.gather(|_| 0.0);
                V3 { x: zero, y: zero, z: zero }
            }
            JointTarget::Given => self.wanted.get(lanes),
        }
    }
}

impl Arms<Four> {
    /// Reads.
    #[inline(always)]
    pub fn get<L: Lanes>(&self, lanes: L) -> Arms<L::T> {
        Arms { own: self.own.get(lanes), parent: self.parent.get(lanes) }
    }

    /// Writes.
    #[inline(always)]
    pub fn put<L: Lanes>(&mut self, lanes: L, arms: &Arms<L::T>) {
        self.own.put(lanes, arms.own);
        self.parent.put(lanes, arms.parent);
    }
}

impl BallElimination<Four> {
    /// Reads.
    #[inline(always)]
    pub fn get<L: Lanes>(&self, lanes: L) -> BallElimination<L::T> {
        BallElimination {
            arms: self.arms.get(lanes),
            inverse_inertia: self.inverse_inertia.get(lanes),
            force_per_torque: self.force_per_torque.get(lanes),
            effective_mass: self.effective_mass.get(lanes),
        }
    }

    /// Writes all but the arms, which the evaluation has set.
    #[inline(always)]
    pub fn put_factor<L: Lanes>(&mut self, lanes: L, ball_joint: &BallElimination<L::T>) {
        self.inverse_inertia.put(lanes, &ball_joint.inverse_inertia);
        self.force_per_torque.put(lanes, &ball_joint.force_per_torque);
        self.effective_mass.put(lanes, &ball_joint.effective_mass);
    }
}

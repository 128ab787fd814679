//! Elimination of a body that hangs by one point: the commonest joint, in 3×3 blocks.
//!
//! Let c be the body, p its parent, r and s the arms from their centres of mass to the common point, (A, B, C) c's
//! articulated mass (`spatial.rs`). With u the acceleration of the point instead of the centre's, ω̇ unchanged,
//!
//! ```text
//! v̇ = u + [r]× ω̇,   τ' = τ − r × f:    [ f + λ ]   [ A   Q  ] [ u ]      Q = B + A [r]×
//!                                       [ τ'    ] = [ Qᵀ  C' ] [ ω̇ ]      C' = C − ([r]× B)ᵀ − [r]× Q
//! ω̇ = C'⁻¹ τ' − Lᵀ u                          L = Q C'⁻¹
//! λ = N u − (f − L τ')                        N = A − L Qᵀ
//! ```
//!
//! N is the mass that the point feels. The joint asks u = g + (v̇_p + ω̇_p × s), so the parent is left with
//!
//! ```text
//! A_p += N      B_p += −N [s]×      C_p += −[s]× N [s]×
//! f_p += w      τ_p += s × w        w = f − L τ' − N g
//! ```
//!
//! This is the general elimination of `tree.rs` for the rows J_c = `(E, −r×)`; here nothing larger than 3×3 is
//! inverted. A test holds the two against each other.

use super::block::{Vec6, angular, linear, vec6};
use super::spatial::{Articulated, Sym3};
use crate::math::{DMat3, DVec3};

/// Factor of one such body.
#[derive(Clone, Copy, Debug)]
pub struct Ball {
    /// r: from the body's centre of mass to the point, world axes, m.
    pub arm: DVec3,
    /// s: from the parent's centre of mass to the point, world axes, m; unused under the world.
    pub parent_arm: DVec3,
    /// C'⁻¹.
    free: Sym3,
    /// L.
    lever: DMat3,
    /// N.
    point_mass: Sym3,
}

impl Default for Ball {
    fn default() -> Self {
        let none = Sym3::default();
        Self { arm: DVec3::ZERO, parent_arm: DVec3::ZERO, free: none, lever: DMat3::ZERO, point_mass: none }
    }
}

impl Ball {
    /// Eliminates the body of this articulated mass.
    #[inline]
    pub fn factor(&mut self, mass: &Articulated) {
        let r = self.arm;
        let q = mass.b + mass.a.mul_skew(r);
        // Entry (i, j) of C' needs component j of r × b_i and component i of r × q_j.
        let (b, n) = (&mass.b, &q);
        let cross_x = |v: DVec3| r.y * v.z - r.z * v.y;
        let cross_y = |v: DVec3| r.z * v.x - r.x * v.z;
        let cross_z = |v: DVec3| r.x * v.y - r.y * v.x;
        let spin = Sym3 {
            d: mass.c.d
                - DVec3::new(
                    cross_x(b.x_axis) + cross_x(n.x_axis),
                    cross_y(b.y_axis) + cross_y(n.y_axis),
                    cross_z(b.z_axis) + cross_z(n.z_axis),
                ),
            o: mass.c.o
                - DVec3::new(
                    cross_z(b.y_axis) + cross_y(n.z_axis),
                    cross_z(b.x_axis) + cross_x(n.z_axis),
                    cross_y(b.x_axis) + cross_x(n.y_axis),
                ),
        };
        self.free = spin.inverse();
        let (gx, gy, gz) = (self.free.x(), self.free.y(), self.free.z());
        self.lever = DMat3::from_cols(q * gx, q * gy, q * gz);
        let l = &self.lever;
        let entry =
            |i: usize, j: usize| l.x_axis[i] * q.x_axis[j] + l.y_axis[i] * q.y_axis[j] + l.z_axis[i] * q.z_axis[j];
        self.point_mass = Sym3 {
            d: mass.a.d - DVec3::new(entry(0, 0), entry(1, 1), entry(2, 2)),
            o: mass.a.o - DVec3::new(entry(1, 2), entry(2, 0), entry(0, 1)),
        };
    }

    /// Leaves the parent with what it feels of the body.
    #[inline]
    pub fn load(&self, parent: &mut Articulated) {
        let (n, s) = (&self.point_mass, self.parent_arm);
        let y = n.mul_skew(s);
        parent.a.add(n);
        parent.b -= y;
        // −[s]× N [s]×, column by column s × (−y).
        let (x, z) = (y.x_axis, y.z_axis);
        let y = y.y_axis;
        parent.c.d -= DVec3::new(s.y * x.z - s.z * x.y, s.z * y.x - s.x * y.z, s.x * z.y - s.y * z.x);
        parent.c.o -= DVec3::new(s.x * y.y - s.y * y.x, s.x * x.y - s.y * x.x, s.z * x.x - s.x * x.z);
    }

    /// Towards the root: the wrench `b` on the body and the wanted `g` become the force w on the parent's point.
    #[inline]
    pub fn up(&self, b: &Vec6, g: DVec3) -> DVec3 {
        let f = linear(b);
        let torque = angular(b) - self.arm.cross(f);
        f - self.lever * torque - self.point_mass.mul(g)
    }

    /// Wrench on the parent of a force at the point.
    #[inline]
    pub fn wrench(&self, w: DVec3) -> Vec6 {
        vec6(w, self.parent_arm.cross(w))
    }

    /// Towards the leaves: the body's acceleration and λ from the parent's `a`, the body's own `b`, `g` and w.
    #[inline]
    pub fn down(&self, b: &Vec6, g: DVec3, w: DVec3, parent: Option<&Vec6>) -> (Vec6, DVec3) {
        let carried = parent.map_or(DVec3::ZERO, |a| linear(a) + angular(a).cross(self.parent_arm));
        let lambda = self.point_mass.mul(carried) - w;
        let u = g + carried;
        let torque = angular(b) - self.arm.cross(linear(b));
        let l = &self.lever;
        let turn = self.free.mul(torque) - DVec3::new(l.x_axis.dot(u), l.y_axis.dot(u), l.z_axis.dot(u));
        (vec6(u - turn.cross(self.arm), turn), lambda)
    }
}

//! Symmetric blocks: the mass of a body, and of all that hangs on it, as three 3×3 matrices.
//!
//! ```text
//! [ f ]   [ A  B ] [ v̇ ]        A, C symmetric, about the centre of mass, world axes
//! [ τ ] = [ Bᵀ C ] [ ω̇ ]        alone: A = m E, B = 0, C = I
//! ```

use super::block::{Mat6, Vec6};
use crate::math::{DMat3, DQuat, DVec3};

/// Symmetric 3×3 matrix.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sym3 {
    /// Diagonal: xx, yy, zz.
    pub d: DVec3,
    /// Off the diagonal: yz, zx, xy.
    pub o: DVec3,
}

impl Sym3 {
    /// s E.
    pub fn splat(s: f64) -> Self {
        Self { d: DVec3::splat(s), o: DVec3::ZERO }
    }

    /// The symmetric part of what a matrix holds on and below its diagonal.
    pub fn lower(m: &DMat3) -> Self {
        Self { d: DVec3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z), o: DVec3::new(m.y_axis.z, m.x_axis.z, m.x_axis.y) }
    }

    /// All nine entries.
    pub fn full(&self) -> DMat3 {
        DMat3::from_cols(self.x(), self.y(), self.z())
    }

    /// First column.
    #[inline]
    pub fn x(&self) -> DVec3 {
        DVec3::new(self.d.x, self.o.z, self.o.y)
    }

    /// Second column.
    #[inline]
    pub fn y(&self) -> DVec3 {
        DVec3::new(self.o.z, self.d.y, self.o.x)
    }

    /// Third column.
    #[inline]
    pub fn z(&self) -> DVec3 {
        DVec3::new(self.o.y, self.o.x, self.d.z)
    }

    /// Matrix times vector.
    #[inline]
    pub fn mul(&self, v: DVec3) -> DVec3 {
        self.x() * v.x + self.y() * v.y + self.z() * v.z
    }

    /// Matrix times `[r]×`, column by column: S (r × e).
    #[inline]
    pub fn mul_skew(&self, r: DVec3) -> DMat3 {
        let (x, y, z) = (self.x(), self.y(), self.z());
        DMat3::from_cols(y * r.z - z * r.y, z * r.x - x * r.z, x * r.y - y * r.x)
    }

    /// Inverse by cofactors; the matrix is positive definite.
    #[inline]
    pub fn inverse(&self) -> Self {
        let (d, o) = (self.d, self.o);
        let cd = DVec3::new(d.y * d.z - o.x * o.x, d.z * d.x - o.y * o.y, d.x * d.y - o.z * o.z);
        let co = DVec3::new(o.y * o.z - d.x * o.x, o.z * o.x - d.y * o.y, o.x * o.y - d.z * o.z);
        let determinant = d.x * cd.x + o.z * co.z + o.y * co.y;
        let s = 1.0 / determinant;
        Self { d: cd * s, o: co * s }
    }

    /// Sum.
    #[inline]
    pub fn add(&mut self, other: &Self) {
        self.d += other.d;
        self.o += other.o;
    }

    /// R S Rᵀ.
    #[inline]
    pub fn rotated(&self, r: &DMat3) -> Self {
        // T = R S, then the six entries of T Rᵀ that matter.
        let t = DMat3::from_cols(*r * self.x(), *r * self.y(), *r * self.z());
        let entry =
            |i: usize, j: usize| t.x_axis[i] * r.x_axis[j] + t.y_axis[i] * r.y_axis[j] + t.z_axis[i] * r.z_axis[j];
        Self {
            d: DVec3::new(entry(0, 0), entry(1, 1), entry(2, 2)),
            o: DVec3::new(entry(1, 2), entry(2, 0), entry(0, 1)),
        }
    }
}

/// Mass of a body with what hangs on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Articulated {
    /// A.
    pub a: Sym3,
    /// B.
    pub b: DMat3,
    /// C.
    pub c: Sym3,
}

impl Articulated {
    /// Nothing.
    pub const ZERO: Self =
        Self { a: Sym3 { d: DVec3::ZERO, o: DVec3::ZERO }, b: DMat3::ZERO, c: Sym3 { d: DVec3::ZERO, o: DVec3::ZERO } };

    /// A body on which nothing hangs: mass (kg) and world inertia (kg m²).
    #[inline]
    pub fn alone(mass: f64, inertia: &Sym3) -> Self {
        Self { a: Sym3::splat(mass), b: DMat3::ZERO, c: *inertia }
    }

    /// As one matrix.
    pub fn matrix(&self) -> Mat6 {
        let (a, c) = (self.a.full(), self.c.full());
        std::array::from_fn(|i| {
            std::array::from_fn(|j| match (i < 3, j < 3) {
                (true, true) => a.col(j)[i],
                (true, false) => self.b.col(j - 3)[i],
                (false, true) => self.b.col(i - 3)[j],
                (false, false) => c.col(j - 3)[i - 3],
            })
        })
    }

    /// += u vᵀ, where the sum of all such terms is symmetric.
    pub fn add_outer(&mut self, u: &Vec6, v: &Vec6) {
        let (ul, ua) = (super::block::linear(u), super::block::angular(u));
        let (vl, va) = (super::block::linear(v), super::block::angular(v));
        self.a.d += ul * vl;
        self.a.o += DVec3::new(ul.z * vl.y, ul.z * vl.x, ul.y * vl.x);
        self.b += DMat3::from_cols(ul * va.x, ul * va.y, ul * va.z);
        self.c.d += ua * va;
        self.c.o += DVec3::new(ua.z * va.y, ua.z * va.x, ua.y * va.x);
    }
}

/// J M⁻¹ Jᵀ: what the bodies of one row answer to it, each alone; driven ones do not give way.
pub fn response(parts: &[(usize, Vec6)], driven: &[bool], masses: &[f64], inertias: &[Sym3]) -> f64 {
    let free = parts.iter().filter(|(body, _)| !driven[*body]);
    let of_one = |(body, j): &(usize, Vec6)| {
        let (force, torque) = (super::block::linear(j), super::block::angular(j));
        force.length_squared() / masses[*body] + torque.dot(inertias[*body].inverse().mul(torque))
    };
    free.map(of_one).sum()
}

/// Rotation matrix of a unit quaternion.
#[inline]
pub fn matrix(q: DQuat) -> DMat3 {
    DMat3::from_quat(q)
}

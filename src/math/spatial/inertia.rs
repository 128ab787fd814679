//! 3×3 matrices and articulated-body inertias, for one body or for four lanes.

use super::{Mat6, Vec6, inverse};
use crate::DMat3;
use crate::lanes::{Four, Lanes, Real, V3};

/// A 3×3 matrix by its columns.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct M3<T> {
    /// First column.
    pub x: V3<T>,
    /// Second column.
    pub y: V3<T>,
    /// Third column.
    pub z: V3<T>,
}

/// Symmetric 3×3 matrix.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sym3<T = f64> {
    /// Diagonal: xx, yy, zz.
    pub d: V3<T>,
    /// Off the diagonal: yz, zx, xy.
    pub o: V3<T>,
}

/// Mass of a body with its children.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Articulated<T = f64> {
    /// A.
    pub a: Sym3<T>,
    /// B.
    pub b: M3<T>,
    /// C.
    pub c: Sym3<T>,
}

impl<T: Real> M3<T> {
    /// Of the rotation by a unit quaternion (x, y, z, w).
    #[inline(always)]
    pub fn of_rotation(q: V3<T>, w: T) -> Self {
        let one = w.all(1.0);
        let twice = q + q;
        let (xx, yy, zz) = (q.x * twice.x, q.y * twice.y, q.z * twice.z);
        let (xy, xz, yz) = (q.x * twice.y, q.x * twice.z, q.y * twice.z);
        let (wx, wy, wz) = (w * twice.x, w * twice.y, w * twice.z);
        Self {
            x: V3::new(one - (yy + zz), xy + wz, xz - wy),
            y: V3::new(xy - wz, one - (xx + zz), yz + wx),
            z: V3::new(xz + wy, yz - wx, one - (xx + yy)),
        }
    }

    /// Matrix times vector.
    #[inline(always)]
    pub fn mul(&self, v: V3<T>) -> V3<T> {
        self.x * v.x + self.y * v.y + self.z * v.z
    }

    /// Transposed matrix times vector.
    #[inline(always)]
    pub fn transposed_mul(&self, v: V3<T>) -> V3<T> {
        V3::new(self.x.dot(v), self.y.dot(v), self.z.dot(v))
    }
}

impl<T: Real> Sym3<T> {
    /// First column.
    #[inline(always)]
    pub fn x(&self) -> V3<T> {
        V3::new(self.d.x, self.o.z, self.o.y)
    }

    /// Second column.
    #[inline(always)]
    pub fn y(&self) -> V3<T> {
        V3::new(self.o.z, self.d.y, self.o.x)
    }

    /// Third column.
    #[inline(always)]
    pub fn z(&self) -> V3<T> {
        V3::new(self.o.y, self.o.x, self.d.z)
    }

    /// Matrix times vector.
    #[inline(always)]
    pub fn mul(&self, v: V3<T>) -> V3<T> {
        self.x() * v.x + self.y() * v.y + self.z() * v.z
    }

    /// Matrix times `[r]×`, column by column: S (r × e).
    #[inline(always)]
    pub fn mul_skew(&self, r: V3<T>) -> M3<T> {
        let (x, y, z) = (self.x(), self.y(), self.z());
        M3 { x: y * r.z - z * r.y, y: z * r.x - x * r.z, z: x * r.y - y * r.x }
    }

    /// Inverse by cofactors; the matrix is positive definite.
    #[inline(always)]
    pub fn inverse(&self) -> Self {
        let (d, o) = (self.d, self.o);
        let cd = V3::new(d.y * d.z - o.x * o.x, d.z * d.x - o.y * o.y, d.x * d.y - o.z * o.z);
        let co = V3::new(o.y * o.z - d.x * o.x, o.z * o.x - d.y * o.y, o.x * o.y - d.z * o.z);
        let determinant = d.x * cd.x + o.z * co.z + o.y * co.y;
        let s = d.x.all(1.0) / determinant;
        Self { d: cd * s, o: co * s }
    }

    /// The symmetric product of two matrices: what it holds on and below its diagonal, T Rᵀ.
    #[inline(always)]
    pub fn product(t: &M3<T>, r: &M3<T>) -> Self {
        Self {
            d: t.x.times(r.x) + t.y.times(r.y) + t.z.times(r.z),
            o: V3::new(
                t.x.y * r.x.z + t.y.y * r.y.z + t.z.y * r.z.z,
                t.x.z * r.x.x + t.y.z * r.y.x + t.z.z * r.z.x,
                t.x.x * r.x.y + t.y.x * r.y.y + t.z.x * r.z.y,
            ),
        }
    }

    /// R S Rᵀ.
    #[inline(always)]
    pub fn rotated(&self, r: &M3<T>) -> Self {
        Self::product(&M3 { x: r.mul(self.x()), y: r.mul(self.y()), z: r.mul(self.z()) }, r)
    }
}

/// Room for the 21 numbers of an [`Articulated`], in whole vectors of four.
pub const NUMBERS: usize = 24;

impl<T: Real> Articulated<T> {
    /// A body on which nothing hangs: mass (kg) and world inertia (kg m²).
    #[inline(always)]
    pub fn alone(mass: T, inertia: Sym3<T>) -> Self {
        let zero = mass.all(0.0);
        let none = V3::new(zero, zero, zero);
        let a = Sym3 { d: V3::new(mass, mass, mass), o: none };
        Self { a, b: M3 { x: none, y: none, z: none }, c: inertia }
    }

    /// All numbers; the last ones are 0.
    #[inline(always)]
    pub fn numbers(&self) -> [T; NUMBERS] {
        let (a, b, c) = (&self.a, &self.b, &self.c);
        let zero = a.d.x.all(0.0);
        [
            a.d.x, a.d.y, a.d.z, a.o.x, a.o.y, a.o.z, b.x.x, b.x.y, b.x.z, b.y.x, b.y.y, b.y.z, b.z.x, b.z.y, b.z.z,
            c.d.x, c.d.y, c.d.z, c.o.x, c.o.y, c.o.z, zero, zero, zero,
        ]
    }

    /// From its numbers.
    #[inline(always)]
    pub fn of_numbers(n: &[T; NUMBERS]) -> Self {
        Self {
            a: Sym3 { d: V3::new(n[0], n[1], n[2]), o: V3::new(n[3], n[4], n[5]) },
            b: M3 { x: V3::new(n[6], n[7], n[8]), y: V3::new(n[9], n[10], n[11]), z: V3::new(n[12], n[13], n[14]) },
            c: Sym3 { d: V3::new(n[15], n[16], n[17]), o: V3::new(n[18], n[19], n[20]) },
        }
    }
}

impl Sym3 {
    /// The symmetric part of what a matrix holds on and below its diagonal.
    #[inline]
    pub fn lower(m: &DMat3) -> Self {
        Self { d: V3::new(m.x_axis.x, m.y_axis.y, m.z_axis.z), o: V3::new(m.y_axis.z, m.x_axis.z, m.x_axis.y) }
    }
}

impl Articulated {
    /// The inertia as one 6 × 6 matrix.
    #[inline(always)]
    pub fn matrix(&self) -> Mat6 {
        let columns = |x: V3<f64>, y: V3<f64>, z: V3<f64>| [x, y, z].map(|c| [c.x, c.y, c.z]);
        let a = columns(self.a.x(), self.a.y(), self.a.z());
        let b = columns(self.b.x, self.b.y, self.b.z);
        let c = columns(self.c.x(), self.c.y(), self.c.z());
        std::array::from_fn(|i| {
            std::array::from_fn(|j| match (i < 3, j < 3) {
                (true, true) => a[j][i],
                (true, false) => b[j - 3][i],
                (false, true) => b[i - 3][j],
                (false, false) => c[j - 3][i - 3],
            })
        })
    }

    /// From one matrix, which is symmetric.
    #[inline(always)]
    pub fn of_matrix(m: &Mat6) -> Self {
        let column = |j: usize| V3::new(m[0][j], m[1][j], m[2][j]);
        Self {
            a: Sym3 { d: V3::new(m[0][0], m[1][1], m[2][2]), o: V3::new(m[1][2], m[0][2], m[0][1]) },
            b: M3 { x: column(3), y: column(4), z: column(5) },
            c: Sym3 { d: V3::new(m[3][3], m[4][4], m[5][5]), o: V3::new(m[4][5], m[3][5], m[3][4]) },
        }
    }

    /// Inverse of the matrix of a body on which nothing hangs: its two blocks by themselves.
    #[inline(always)]
    pub fn inverse_alone(&self) -> Mat6 {
        let [[a]] = inverse(&[[self.a.d.x]]);
        let c = inverse(&[self.c.x(), self.c.y(), self.c.z()].map(|c| [c.x, c.y, c.z]));
        let mut out = [[0.0; 6]; 6];
        for i in 0..3 {
            out[i][i] = a;
            out[3 + i][3..].copy_from_slice(&c[i]);
        }
        out
    }

    /// u vᵀ, where the sum of all such terms is symmetric.
    #[inline(always)]
    pub fn outer(u: &Vec6, v: &Vec6) -> Self {
        let (ul, ua) = (V3::new(u[0], u[1], u[2]), V3::new(u[3], u[4], u[5]));
        let (vl, va) = (V3::new(v[0], v[1], v[2]), V3::new(v[3], v[4], v[5]));
        Self {
            a: Sym3 { d: ul.times(vl), o: V3::new(ul.z * vl.y, ul.z * vl.x, ul.y * vl.x) },
            b: M3 { x: ul * va.x, y: ul * va.y, z: ul * va.z },
            c: Sym3 { d: ua.times(va), o: V3::new(ua.z * va.y, ua.z * va.x, ua.y * va.x) },
        }
    }
}

impl M3<Four> {
    /// Reads.
    #[inline(always)]
    pub fn get<L: Lanes>(&self, lanes: L) -> M3<L::T> {
        M3 { x: self.x.get(lanes), y: self.y.get(lanes), z: self.z.get(lanes) }
    }

    /// Writes.
    #[inline(always)]
    pub fn put<L: Lanes>(&mut self, lanes: L, m: &M3<L::T>) {
        self.x.put(lanes, m.x);
        self.y.put(lanes, m.y);
        self.z.put(lanes, m.z);
    }
}

impl Sym3<Four> {
    /// Reads.
    #[inline(always)]
    pub fn get<L: Lanes>(&self, lanes: L) -> Sym3<L::T> {
        Sym3 { d: self.d.get(lanes), o: self.o.get(lanes) }
    }

    /// Writes.
    #[inline(always)]
    pub fn put<L: Lanes>(&mut self, lanes: L, m: &Sym3<L::T>) {
        self.d.put(lanes, m.d);
        self.o.put(lanes, m.o);
    }
}

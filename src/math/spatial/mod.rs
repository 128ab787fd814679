//! Spatial algebra: six-vectors, and the symmetric blocks of a body's mass (Featherstone, *Rigid Body Dynamics
//! Algorithms*, 2008, chapter 2).
//!
//! A body's six coordinates are its linear (x, y, z) and angular (x, y, z) parts, about the centre of mass, world axes.
//! The mass of a body, and of all that hangs on it, is three 3×3 matrices:
//!
//! ```text
//! [ f ]   [ A  B ] [ v̇ ]        A, C symmetric
//! [ τ ] = [ Bᵀ C ] [ ω̇ ]        alone: A = m E, B = 0, C = I
//! ```
//!
//! [`M3`], [`Sym3`] and [`Articulated`] serve one body or four side by side ([`lanes`](crate::lanes)).

mod inertia;
pub mod row_blocks;
mod vector;

use crate::{DMat3, DQuat, DVec3};

pub use inertia::{Articulated, M3, NUMBERS, Sym3};
pub use vector::SpatialVector;

/// A spatial vector: linear part, then angular part.
pub type Vec6 = [f64; 6];
/// A 6 × 6 matrix that acts on [`Vec6`], row by row.
pub type Mat6 = [[f64; 6]; 6];

/// Adds a force that acts `arm` beside the centre of mass.
#[inline]
pub fn add_wrench(sum: &mut Vec6, arm: DVec3, force: DVec3) {
    let wrench = vec6(force, arm.cross(force));
    for k in 0..6 {
        sum[k] += wrench[k];
    }
}

/// A six-vector from its linear and angular parts.
#[inline(always)]
pub fn vec6(linear: DVec3, angular: DVec3) -> Vec6 {
    [linear.x, linear.y, linear.z, angular.x, angular.y, angular.z]
}

/// Linear part.
#[inline(always)]
pub fn linear(v: &Vec6) -> DVec3 {
    DVec3::new(v[0], v[1], v[2])
}

/// Angular part.
#[inline(always)]
pub fn angular(v: &Vec6) -> DVec3 {
    DVec3::new(v[3], v[4], v[5])
}

/// a · b.
#[inline(always)]
pub fn dot(a: &Vec6, b: &Vec6) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3] + a[4] * b[4] + a[5] * b[5]
}

/// y += s x.
#[inline(always)]
pub fn add_scaled(y: &mut Vec6, s: f64, x: &Vec6) {
    for k in 0..6 {
        y[k] += s * x[k];
    }
}

/// Matrix times vector.
#[inline(always)]
pub fn mul(m: &Mat6, v: &Vec6) -> Vec6 {
    [dot(&m[0], v), dot(&m[1], v), dot(&m[2], v), dot(&m[3], v), dot(&m[4], v), dot(&m[5], v)]
}

/// Inverse of a symmetric positive definite N×N matrix by Cholesky: A = L Lᵀ, A⁻¹ = L⁻ᵀ L⁻¹.
///
/// Contract: `a` is positive definite (a mass matrix plus positive semi-definite joint terms always is). Numbers that
/// are none come out as none: they are looked for after each step.
#[inline(always)]
pub fn inverse<const N: usize>(a: &[[f64; N]; N]) -> [[f64; N]; N] {
    let mut l = *a;
    // L in the lower triangle.
    for j in 0..N {
        let mut d = l[j][j];
        for k in 0..j {
            d -= l[j][k] * l[j][k];
        }
        let d = d.sqrt();
        l[j][j] = d;
        let inv = 1.0 / d;
        for i in j + 1..N {
            let mut s = l[i][j];
            for k in 0..j {
                s -= l[i][k] * l[j][k];
            }
            l[i][j] = s * inv;
        }
    }
    // L⁻¹, lower triangle.
    let mut x = [[0.0; N]; N];
    for j in 0..N {
        x[j][j] = 1.0 / l[j][j];
        for i in j + 1..N {
            let mut s = 0.0;
            for k in j..i {
                s -= l[i][k] * x[k][j];
            }
            x[i][j] = s / l[i][i];
        }
    }
    // A⁻¹ = L⁻ᵀ L⁻¹.
    let mut out = [[0.0; N]; N];
    for i in 0..N {
        for j in 0..=i {
            let mut s = 0.0;
            for k in i..N {
                s += x[k][i] * x[k][j];
            }
            out[i][j] = s;
            out[j][i] = s;
        }
    }
    out
}

/// Rotation matrix of a unit quaternion.
#[inline]
pub fn matrix(q: DQuat) -> DMat3 {
    DMat3::from_quat(q)
}

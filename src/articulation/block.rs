//! Six-vectors and small dense blocks: what the tree factor is made of.
//!
//! A body's six coordinates are its linear (x, y, z) and angular (x, y, z) parts, world axes. A joint has at most
//! [`MAX_ROWS`] rows; blocks are stored at full size and used up to `rows`, so nothing here allocates.

use crate::math::DVec3;

/// Linear part, then angular part.
pub type Vec6 = [f64; 6];
/// Six by six, row by row.
pub type Mat6 = [[f64; 6]; 6];

/// Most rows of one joint: six that can be held, three more that repeat some of them (while one set of rows takes
/// over from another), and three of friction.
pub const MAX_ROWS: usize = 12;
/// One number per row of a joint.
pub type RowVec = [f64; MAX_ROWS];
/// One six-vector per row of a joint.
pub type RowBlock = [Vec6; MAX_ROWS];
/// Rows by rows, lower triangle.
pub type RowSquare = [[f64; MAX_ROWS]; MAX_ROWS];

/// Writes code out for each number of rows that joints often have, so that its loops are straight lines: a universal joint
/// has four rows, a hinge five, a weld six.
macro_rules! for_rows {
    ($rows:expr, $n:ident => $code:expr) => {
        match $rows {
            3 => {
                let $n = 3;
                $code
            }
            4 => {
                let $n = 4;
                $code
            }
            5 => {
                let $n = 5;
                $code
            }
            6 => {
                let $n = 6;
                $code
            }
            rows => {
                let $n = rows.min($crate::articulation::block::MAX_ROWS);
                $code
            }
        }
    };
}
pub(super) use for_rows;

/// Adds a force that acts `arm` beside the centre of mass.
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

/// A pivot below this share of its row's own stiffness says that the row repeats earlier ones.
const REDUNDANT: f64 = 1e-12;

/// Inverse of the leading `n`×`n` block of a symmetric positive semi-definite matrix, in place, both triangles; only
/// the lower one is read. A row that repeats earlier ones gets zeros, so that its multiplier comes out 0; bit j of the
/// answer says so.
#[inline(always)]
pub fn pseudo_inverse(m: &mut RowSquare, n: usize) -> u32 {
    for_rows!(n, n => pseudo_inverse_of(m, n))
}

#[inline(always)]
fn pseudo_inverse_of(m: &mut RowSquare, n: usize) -> u32 {
    let mut redundant = 0;
    // m = L Lᵀ in the lower triangle, inverse pivots on the diagonal.
    for j in 0..n {
        let diagonal = m[j][j];
        let mut d = diagonal;
        for k in 0..j {
            d -= m[j][k] * m[j][k];
        }
        let held = d > REDUNDANT * diagonal;
        let inv = if held { 1.0 / d.sqrt() } else { 0.0 };
        redundant |= u32::from(!held) << j;
        m[j][j] = inv;
        for i in j + 1..n {
            let mut s = m[i][j];
            for k in 0..j {
                s -= m[i][k] * m[j][k];
            }
            m[i][j] = s * inv;
        }
    }
    // L⁻¹, in place.
    for j in 0..n {
        for i in j + 1..n {
            let mut s = 0.0;
            for k in j..i {
                s -= m[i][k] * m[k][j];
            }
            m[i][j] = s * m[i][i];
        }
    }
    // L⁻ᵀ L⁻¹ into the upper triangle, column by column: entry (i, j), i ≤ j, needs only rows from j down.
    for i in 0..n {
        for j in i..n {
            let mut s = 0.0;
            for k in j..n {
                // Row k of L⁻¹; its part above the diagonal is not yet overwritten for k ≥ j.
                s += m[k][i] * m[k][j];
            }
            m[i][j] = s;
        }
    }
    for i in 0..n {
        for j in 0..i {
            m[i][j] = m[j][i];
        }
    }
    redundant
}

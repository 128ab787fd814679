//! Small dense blocks of rows: what the tree factor is made of.
//!
//! A joint has at most [`MAX_ROWS`] rows; blocks are stored at full size and used up to `rows`, so nothing here
//! allocates.

use super::Vec6;

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
#[macro_export]
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
                let $n = rows.min($crate::spatial::row_blocks::MAX_ROWS);
                $code
            }
        }
    };
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
        let independent = d > REDUNDANT * diagonal;
        let inv = if independent { 1.0 / d.sqrt() } else { 0.0 };
        redundant |= u32::from(!independent) << j;
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

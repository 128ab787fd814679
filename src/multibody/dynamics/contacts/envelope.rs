//! Envelope (skyline) LU factorization: elements lie between the first of each row or column and the diagonal.
//!
//! A = L U with a symmetric envelope: row i of A begins where column i does. L (ones on its diagonal) fills no element before the
//! first of A's row, nor U before the first of A's column, so the work grows with the square of their lengths (A. George, J. Liu,
//! Computer Solution of Large Sparse Positive Definite Systems, 1981, for the symmetric case). Both are stored so that every sum
//! runs over two contiguous slices. Sums run in four lanes that are added in a fixed order: the same bits on every processor.

use fearless_simd::{Level, Simd, dispatch};

/// Lanes of a sum.
const LANES: usize = 4;
/// A smaller pivot than this fraction of its diagonal element is rounding, and is replaced by this fraction.
const MIN_PIVOT: f64 = 1e-12;

/// A matrix, then its factor in the same place.
#[derive(Clone, Debug, Default)]
pub(super) struct Envelope {
    /// First column of each row, and where its elements begin.
    first: Vec<usize>,
    at: Vec<usize>,
    /// Rows up to the diagonal, then L; the diagonal element is unused.
    lower: Vec<f64>,
    /// Columns down to the diagonal, then U with its diagonal inverted.
    upper: Vec<f64>,
}

/// A row from some column on and the column from the row of that index on, both up to the diagonal.
pub(super) struct Lines<'a> {
    /// Elements of the row left of the diagonal.
    pub row: &'a mut [f64],
    /// Elements of the column down to the diagonal.
    pub column: &'a mut [f64],
}

impl Envelope {
    /// Capacity for so many rows of about this length.
    pub fn with_capacity(rows: usize, length: usize) -> Self {
        let numbers = || Vec::with_capacity(rows * length);
        Self { first: Vec::with_capacity(rows), at: Vec::with_capacity(rows + 1), lower: numbers(), upper: numbers() }
    }

    /// Begins a zero matrix whose rows and columns start at these indices.
    pub fn begin(&mut self, first: impl Iterator<Item = usize>) {
        self.first.clear();
        self.at.clear();
        let mut at = 0;
        for (row, first) in first.enumerate() {
            self.first.push(first);
            self.at.push(at);
            at += row - first + 1;
        }
        self.at.push(at);
        for numbers in [&mut self.lower, &mut self.upper] {
            numbers.clear();
            numbers.resize(at, 0.0);
        }
    }

    /// The row and column `index` from the element `from` on.
    #[inline(always)]
    pub fn from(&mut self, index: usize, from: usize) -> Lines<'_> {
        let all = self.at[index] + from - self.first[index]..self.at[index + 1];
        Lines { row: &mut self.lower[all.clone()], column: &mut self.upper[all] }
    }

    /// Factors the matrix in place.
    pub fn factor(&mut self) {
        dispatch!(Level::new(), simd => simd.vectorize(
            #[inline(always)]
            || self.factor_rows(),
        ));
    }

    #[inline(always)]
    fn factor_rows(&mut self) {
        for i in 0..self.first.len() {
            let (lower, row) = self.lower.split_at_mut(self.at[i]);
            let (upper, column) = self.upper.split_at_mut(self.at[i]);
            let begin = self.first[i];
            let last = i - begin;
            for j in begin..i {
                let from = self.first[j].max(begin);
                let (own, theirs) = (from - begin..j - begin, self.at[j] + from - self.first[j]..self.at[j + 1] - 1);
                column[j - begin] -= dot(&column[own.clone()], &lower[theirs.clone()]);
                row[j - begin] = (row[j - begin] - dot(&row[own], &upper[theirs])) * upper[self.at[j + 1] - 1];
            }
            let diagonal = column[last];
            let pivot = diagonal - dot(&row[..last], &column[..last]);
            let least = MIN_PIVOT * diagonal.abs();
            column[last] = if pivot.abs() < least { least } else { pivot }.recip();
        }
    }

    /// Solves L U x = x in place.
    pub fn solve(&self, x: &mut [f64]) {
        for i in 0..self.first.len() {
            let own = &self.lower[self.at[i]..self.at[i + 1] - 1];
            x[i] -= dot(own, &x[self.first[i]..i]);
        }
        for i in (0..self.first.len()).rev() {
            let column = &self.upper[self.at[i]..self.at[i + 1]];
            let (own, diagonal) = column.split_at(column.len() - 1);
            let value = x[i] * diagonal[0];
            x[i] = value;
            for (x, u) in x[self.first[i]..i].iter_mut().zip(own) {
                *x -= u * value;
            }
        }
    }
}

/// Σ aᵢ bᵢ.
#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut lanes = [0.0; LANES];
    let (whole_a, whole_b) = (a.chunks_exact(LANES), b.chunks_exact(LANES));
    let remainder: f64 = whole_a.remainder().iter().zip(whole_b.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in whole_a.zip(whole_b) {
        for lane in 0..LANES {
            lanes[lane] += a[lane] * b[lane];
        }
    }
    (lanes[0] + lanes[1]) + (lanes[2] + lanes[3]) + remainder
}

#[cfg(test)]
mod tests {
    use super::*;
    use soffio_math::noise::Random;

    #[test]
    fn solving_inverts_the_product_with_the_full_matrix() {
        /// Rounding of some hundred numbers.
        const ROUNDED: f64 = 1e-12;
        let first = [0, 0, 1, 0, 2, 4, 3, 6];
        let n = first.len();
        let mut random = Random::new(5);
        let mut whole = vec![vec![0.0; n]; n];
        let mut envelope = Envelope::default();
        envelope.begin(first.into_iter());
        for row in 0..n {
            for column in first[row]..=row {
                let (below, above) = (random.signed(), random.signed());
                whole[row][column] = below;
                whole[column][row] = above;
                if row == column {
                    whole[row][row] = 4.0;
                }
                let lines = envelope.from(row, column);
                (lines.row[0], lines.column[0]) = (whole[row][column], whole[column][row]);
            }
        }
        let x: Vec<f64> = (0..n).map(|_| random.signed()).collect();
        let mut b: Vec<f64> = whole.iter().map(|row| row.iter().zip(&x).map(|(a, x)| a * x).sum()).collect();
        envelope.factor();
        envelope.solve(&mut b);
        for (found, x) in b.iter().zip(&x) {
            assert!((found - x).abs() < ROUNDED, "{found}, not {x}");
        }
    }
}

//! The symmetric eigenproblem K x = λ M x of small dense matrices.
//!
//! Cholesky M = L Lᵀ turns it into the ordinary problem C v = λ v with C = L⁻¹ K L⁻ᵀ and x = L⁻ᵀ v, which cyclic
//! Jacobi rotations solve (Golub and Van Loan, "Matrix Computations", 8.5). That is slow for large matrices, but short,
//! unconditionally stable and accurate for small eigenvalues too. Only the four operations and square roots: the same
//! bits everywhere.
//!
//! A function of the basis that is nearly a sum of those before it (its pivot vanishes) is left out: it adds nothing but
//! rounding.
//!
//! Invariant: vectors come out M-normalised, xᵀ M x = 1, in ascending order of λ.

use fearless_simd::{Level, dispatch};

/// A dense square matrix, row by row.
#[derive(Clone, Debug)]
pub(super) struct Matrix {
    n: usize,
    entries: Vec<f64>,
}

impl Matrix {
    /// All zero.
    pub fn zero(n: usize) -> Self {
        Self { n, entries: vec![0.0; n * n] }
    }

    /// Row `i`.
    pub fn row_mut(&mut self, i: usize) -> &mut [f64] {
        &mut self.entries[i * self.n..(i + 1) * self.n]
    }

    /// Rows `p` and `q`, the later one second.
    fn rows_mut(&mut self, p: usize, q: usize) -> (&mut [f64], &mut [f64]) {
        let (before, from) = self.entries.split_at_mut(q * self.n);
        (&mut before[p * self.n..(p + 1) * self.n], &mut from[..self.n])
    }

    fn at(&self, i: usize, j: usize) -> f64 {
        self.entries[i * self.n + j]
    }

    fn set(&mut self, i: usize, j: usize, value: f64) {
        self.entries[i * self.n + j] = value;
    }
}

/// Most sweeps of Jacobi rotations; convergence is quadratic, ten are plenty for the sizes here.
const SWEEPS: usize = 24;

/// A pivot below this share of its diagonal element is rounding; half the digits of a double stay good.
const DEPENDENT: f64 = 1e-9;

/// Eigenvalues and M-normalised eigenvectors of K x = λ M x; only the lower triangles are read. As many as there are
/// independent functions; each vector has the length of the whole basis.
pub(super) fn generalised(stiffness: &Matrix, mass: &Matrix) -> Vec<(f64, Vec<f64>)> {
    let (kept, lower) = cholesky(mass);
    let n = kept.len();
    // C = L⁻¹ K L⁻ᵀ: solve L Y = K column by column, then L Z = Yᵀ; Z = C because K is symmetric.
    let mut full = Matrix::zero(n);
    for (i, &from) in kept.iter().enumerate() {
        for (j, &to) in kept.iter().enumerate().take(i + 1) {
            full.set(i, j, stiffness.at(from, to));
            full.set(j, i, stiffness.at(from, to));
        }
    }
    let half = forward(&lower, &full);
    let mut c = forward(&lower, &transpose(&half));
    let mut vectors = dispatch!(Level::new(), _simd => jacobi(&mut c));
    let mut pairs: Vec<(f64, Vec<f64>)> = (0..n)
        .map(|k| {
            let mut whole = vec![0.0; mass.n];
            for (&i, x) in kept.iter().zip(backward(&lower, vectors.row_mut(k))) {
                whole[i] = x;
            }
            (c.at(k, k), whole)
        })
        .collect();
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    pairs
}

/// The independent rows of `m`, in order, and the Cholesky factor of the matrix they make.
fn cholesky(m: &Matrix) -> (Vec<usize>, Matrix) {
    let mut kept: Vec<usize> = Vec::with_capacity(m.n);
    let mut rows: Vec<Vec<f64>> = Vec::with_capacity(m.n);
    for i in 0..m.n {
        let mut row: Vec<f64> = Vec::with_capacity(kept.len() + 1);
        for (&j, other) in kept.iter().zip(&rows) {
            let sum = m.at(i, j) - row.iter().zip(other).map(|(a, b)| a * b).sum::<f64>();
            row.push(sum / other[row.len()]);
        }
        let pivot = m.at(i, i) - row.iter().map(|a| a * a).sum::<f64>();
        if pivot > DEPENDENT * m.at(i, i) {
            row.push(pivot.sqrt());
            kept.push(i);
            rows.push(row);
        }
    }
    let mut lower = Matrix::zero(kept.len());
    for (i, row) in rows.iter().enumerate() {
        lower.row_mut(i)[..row.len()].copy_from_slice(row);
    }
    (kept, lower)
}

/// L⁻¹ B.
fn forward(l: &Matrix, b: &Matrix) -> Matrix {
    let n = l.n;
    let mut x = b.clone();
    for i in 0..n {
        for k in 0..i {
            let factor = l.at(i, k);
            let (above, row) = x.rows_mut(k, i);
            row.iter_mut().zip(above).for_each(|(x, above)| *x -= factor * *above);
        }
        let pivot = l.at(i, i);
        x.row_mut(i).iter_mut().for_each(|v| *v /= pivot);
    }
    x
}

/// L⁻ᵀ v.
fn backward(l: &Matrix, v: &[f64]) -> Vec<f64> {
    let mut x = v.to_vec();
    for i in (0..l.n).rev() {
        let sum: f64 = (i + 1..l.n).map(|k| l.at(k, i) * x[k]).sum();
        x[i] = (x[i] - sum) / l.at(i, i);
    }
    x
}

fn transpose(m: &Matrix) -> Matrix {
    let mut t = Matrix::zero(m.n);
    for i in 0..m.n {
        for j in 0..m.n {
            t.set(j, i, m.at(i, j));
        }
    }
    t
}

/// Diagonalises `c` in place; the rows of the answer are the eigenvectors.
#[inline(always)]
fn jacobi(c: &mut Matrix) -> Matrix {
    let n = c.n;
    let mut v = Matrix::zero(n);
    for i in 0..n {
        v.set(i, i, 1.0);
    }
    for _ in 0..SWEEPS {
        let off: f64 = (0..n).flat_map(|i| (0..i).map(move |j| (i, j))).map(|(i, j)| c.at(i, j) * c.at(i, j)).sum();
        let diagonal: f64 = (0..n).map(|i| c.at(i, i) * c.at(i, i)).sum();
        if off <= 1e-30 * diagonal {
            break;
        }
        for p in 0..n {
            for q in p + 1..n {
                rotate(c, &mut v, p, q);
            }
        }
    }
    v
}

/// One rotation in the plane (p, q) that makes c_pq zero: t = tan θ is the smaller root of t² + 2τt − 1 = 0.
#[inline(always)]
fn rotate(c: &mut Matrix, v: &mut Matrix, p: usize, q: usize) {
    let n = c.n;
    let apq = c.at(p, q);
    if apq == 0.0 {
        return;
    }
    let tau = (c.at(q, q) - c.at(p, p)) / (2.0 * apq);
    let t = if tau >= 0.0 { 1.0 / (tau + (1.0 + tau * tau).sqrt()) } else { -1.0 / (-tau + (1.0 + tau * tau).sqrt()) };
    let cos = 1.0 / (1.0 + t * t).sqrt();
    let sin = t * cos;
    for row in c.entries.chunks_exact_mut(n) {
        let (a, b) = (row[p], row[q]);
        row[p] = cos * a - sin * b;
        row[q] = sin * a + cos * b;
    }
    for matrix in [c, v] {
        let (first, second) = matrix.rows_mut(p, q);
        for (a, b) in first.iter_mut().zip(second) {
            (*a, *b) = (cos * *a - sin * *b, sin * *a + cos * *b);
        }
    }
}

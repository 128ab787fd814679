//! Dense Cholesky factor of a symmetric positive semi-definite matrix, A = L Lᵀ, without redundant rows.
//!
//! A pivot far below its row's own scale shows that the row depends on others: it gets 0, so that its unknown is 0
//! and the other rows share the load. (The row's own diagonal is no scale: where a tree already holds the row, that
//! is rounding too.) Nothing allocates after [`Cholesky::with_room`].

/// The factor; its diagonal holds the inverse pivots.
#[derive(Clone, Debug)]
pub struct Cholesky {
    n: usize,
    entries: Vec<f64>,
    /// Scale of each row: its diagonal without coupling to others.
    alone: Vec<f64>,
    redundant: Vec<bool>,
    tolerance: f64,
}

impl Cholesky {
    /// Room for `most` rows. A pivot below `tolerance` times its row's scale counts as 0.
    pub fn with_room(most: usize, tolerance: f64) -> Self {
        Self { n: 0, entries: vec![0.0; most * most], alone: vec![0.0; most], redundant: vec![false; most], tolerance }
    }

    /// Begins a matrix of `n` rows.
    pub fn begin(&mut self, n: usize) {
        self.n = n;
    }

    /// Entry of the lower triangle, j ≤ i, before [`Cholesky::factor`].
    #[inline(always)]
    pub fn entry(&mut self, i: usize, j: usize) -> &mut f64 {
        &mut self.entries[i * self.n + j]
    }

    /// Sets a row's scale (its diagonal without coupling to others), before [`Cholesky::factor`].
    pub fn measure(&mut self, row: usize, alone: f64) {
        self.alone[row] = alone;
    }

    /// Factors in place.
    #[inline(always)]
    pub fn factor(&mut self) {
        let n = self.n;
        for j in 0..n {
            let (done, below_rows) = self.entries.split_at_mut((j + 1) * n);
            let row = &mut done[j * n..];
            let diagonal = row[j];
            let d = diagonal - row[..j].iter().map(|x| x * x).sum::<f64>();
            let independent = d > self.tolerance * self.alone[j].max(diagonal);
            let pivot = if independent { 1.0 / d.sqrt() } else { 0.0 };
            self.redundant[j] = !independent;
            row[j] = pivot;
            for below in below_rows.chunks_exact_mut(n).take(n - j - 1) {
                let s = below[j] - below[..j].iter().zip(&row[..j]).map(|(x, y)| x * y).sum::<f64>();
                below[j] = s * pivot;
            }
        }
    }

    /// Whether a row was redundant at the last factorisation.
    pub fn is_redundant(&self, row: usize) -> bool {
        self.redundant[row]
    }

    /// Solves L Lᵀ x = x in place.
    #[inline(always)]
    pub fn solve(&self, x: &mut [f64]) {
        let (n, l) = (self.n, &self.entries);
        for i in 0..n {
            x[i] = (0..i).fold(x[i], |s, k| s - l[i * n + k] * x[k]) * l[i * n + i];
        }
        for i in (0..n).rev() {
            x[i] = (i + 1..n).fold(x[i], |s, k| s - l[k * n + i] * x[k]) * l[i * n + i];
        }
    }
}

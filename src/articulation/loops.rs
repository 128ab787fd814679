//! Closed loops: the rows that a tree cannot hold, by a small dense system (Baraff 1996, second half).
//!
//! Let H be the tree's system and G the rows of the joints that close loops. Their multipliers μ obey
//!
//! ```text
//! S μ = g − G a₀        S = G R + Γ        R = H⁻¹ Gᵀ (one tree solve per row)        a = a₀ + R μ
//! ```
//!
//! with a₀ the tree's own answer. The cost is O(k n + k³) for k loop rows. Rows that repeat others (a planar
//! four-bar of hinges has three) get the multiplier 0, as in the tree.

use super::block::{MAX_ROWS, RowVec, Vec6, add_scaled, dot};
use super::tree::{JointRows, Link, Tree};

/// A pivot below this share of its row's own stiffness says that the row repeats earlier ones. Loop rows pass
/// through a whole tree solve, so more is rounded off than within one joint.
const REDUNDANT: f64 = 1e-9;

/// The loop rows of a figure and their factor.
#[derive(Clone, Debug)]
pub struct Loops {
    joints: Vec<(usize, Link)>,
    /// (index into `joints`, row) of each loop row at the last factorisation.
    rows: Vec<(usize, usize)>,
    /// R, a column of body responses per loop row, and the tree multipliers that belong to it.
    response: Vec<Vec<Vec6>>,
    multipliers: Vec<Vec<RowVec>>,
    /// Lower Cholesky factor of S with inverse pivots on the diagonal, row by row.
    factor: Vec<f64>,
    mu: Vec<f64>,
    scratch: Vec<Vec6>,
    no_motion: Vec<RowVec>,
}

impl Loops {
    /// Room for the loop joints of `tree`.
    pub fn new(bodies: usize, links: &[Link], tree: &Tree) -> Self {
        let most = tree.loops().len() * MAX_ROWS;
        Self {
            joints: tree.loops().iter().map(|&joint| (joint, links[joint])).collect(),
            rows: Vec::with_capacity(most),
            response: vec![vec![[0.0; 6]; bodies]; most],
            multipliers: vec![vec![[0.0; MAX_ROWS]; links.len()]; most],
            factor: vec![0.0; most * most],
            mu: vec![0.0; most],
            scratch: vec![[0.0; 6]; bodies],
            no_motion: vec![[0.0; MAX_ROWS]; links.len()],
        }
    }

    /// Factors S for the rows; the tree must have been factored with them.
    pub fn factor(&mut self, tree: &Tree, rows: &[JointRows]) {
        self.rows.clear();
        for (index, &(joint, link)) in self.joints.iter().enumerate() {
            for row in 0..rows[joint].rows {
                let k = self.rows.len();
                self.rows.push((index, row));
                self.scratch.fill([0.0; 6]);
                self.scratch[link.a] = rows[joint].a[row];
                if let Some(b) = link.b {
                    self.scratch[b] = rows[joint].b[row];
                }
                let (response, multipliers) = (&mut self.response[k], &mut self.multipliers[k]);
                tree.solve(rows, &mut self.scratch, &self.no_motion, response, multipliers);
            }
        }
        let n = self.rows.len();
        for k in 0..n {
            for l in 0..=k {
                self.factor[k * n + l] = self.row_dot(rows, k, &self.response[l]);
            }
            let (index, row) = self.rows[k];
            self.factor[k * n + k] += rows[self.joints[index].0].compliance[row];
        }
        for j in 0..n {
            let diagonal = self.factor[j * n + j];
            let d = (0..j).fold(diagonal, |d, k| d - self.factor[j * n + k] * self.factor[j * n + k]);
            let pivot = if d > REDUNDANT * diagonal { 1.0 / d.sqrt() } else { 0.0 };
            self.factor[j * n + j] = pivot;
            for i in j + 1..n {
                let s = (0..j).fold(self.factor[i * n + j], |s, k| s - self.factor[i * n + k] * self.factor[j * n + k]);
                self.factor[i * n + j] = s * pivot;
            }
        }
    }

    /// Corrects the tree's answer so that the loop rows hold too.
    pub fn correct(&mut self, rows: &[JointRows], g: &[RowVec], a: &mut [Vec6], lambda: &mut [RowVec]) {
        let n = self.rows.len();
        for k in 0..n {
            let (index, row) = self.rows[k];
            self.mu[k] = g[self.joints[index].0][row] - self.row_dot(rows, k, a);
        }
        let (l, mu) = (&self.factor, &mut self.mu);
        for i in 0..n {
            mu[i] = (0..i).fold(mu[i], |s, k| s - l[i * n + k] * mu[k]) * l[i * n + i];
        }
        for i in (0..n).rev() {
            mu[i] = (i + 1..n).fold(mu[i], |s, k| s - l[k * n + i] * mu[k]) * l[i * n + i];
        }
        for k in 0..n {
            for (ai, response) in a.iter_mut().zip(&self.response[k]) {
                add_scaled(ai, self.mu[k], response);
            }
            for (li, response) in lambda.iter_mut().zip(&self.multipliers[k]) {
                for row in 0..MAX_ROWS {
                    li[row] += self.mu[k] * response[row];
                }
            }
        }
        for k in 0..n {
            let (index, row) = self.rows[k];
            lambda[self.joints[index].0][row] = self.mu[k];
        }
    }

    /// Loop row k times the bodies' coordinates.
    fn row_dot(&self, rows: &[JointRows], k: usize, a: &[Vec6]) -> f64 {
        let (index, row) = self.rows[k];
        let (joint, link) = self.joints[index];
        dot(&rows[joint].a[row], &a[link.a]) + link.b.map_or(0.0, |b| dot(&rows[joint].b[row], &a[b]))
    }
}

//! Dense reference solver: Cholesky of the Schur complement of all rows.
//!
//! ```text
//! (J M⁻¹ Jᵀ + Γ) λ = g − J M⁻¹ b          a = M⁻¹ (b + Jᵀ λ)
//! ```
//!
//! Pivots of redundant rows are left out. O(rows³): for tests and for articulations of a few bodies.

use super::cholesky::Cholesky;
use super::lane_blocks::LaneBlocks;
use super::loops::{LoopRow, STABILISING_COMPLIANCE};
use soffio_math::spatial::Articulated;
use soffio_math::spatial::{Mat6, Vec6, add_scaled, dot, inverse, mul};

/// Least pivot, relative to the row's uncoupled effective inverse mass; below it the row repeats earlier ones.
const REDUNDANT: f64 = 1e-11;

/// Factor of the dense system, of rows given as [`LoopRow`]s.
#[derive(Clone, Debug)]
pub struct Dense {
    /// All possible rows, of joints and couplings.
    pub rows: Vec<LoopRow>,
    kinematic: Vec<bool>,
    inverse: Vec<Mat6>,
    active: Vec<usize>,
    factor: Cholesky,
    mu: Vec<f64>,
}

impl Dense {
    /// Room for these rows.
    pub fn new(rows: Vec<LoopRow>, kinematic: &[bool]) -> Self {
        let n = rows.len();
        Self {
            kinematic: kinematic.to_vec(),
            inverse: vec![[[0.0; 6]; 6]; kinematic.len()],
            active: Vec::with_capacity(n),
            factor: Cholesky::with_room(n, REDUNDANT),
            mu: vec![0.0; n],
            rows,
        }
    }

    /// Whether this row was redundant at the last factorisation.
    pub fn is_redundant(&self, row: usize) -> bool {
        self.active.iter().position(|&r| r == row).is_some_and(|k| self.factor.is_redundant(k))
    }

    /// Factors J M⁻¹ Jᵀ + Γ for the active rows. `stabilising`: some rows are being closed by stabilisation, so all
    /// rows get [`STABILISING_COMPLIANCE`].
    pub fn factor(&mut self, lane_blocks: &LaneBlocks, stabilising: bool) {
        for (body, inverted) in self.inverse.iter_mut().enumerate() {
            *inverted = inverse(&Articulated::alone(lane_blocks.mass(body), lane_blocks.inertia(body)).matrix());
        }
        self.active.clear();
        self.active.extend((0..self.rows.len()).filter(|&row| self.rows[row].active));
        let n = self.active.len();
        self.factor.begin(n);
        for i in 0..n {
            for j in 0..=i {
                let (r, s) = (&self.rows[self.active[i]], &self.rows[self.active[j]]);
                let mut sum = 0.0;
                for (body, block) in &r.parts {
                    for (other, against) in &s.parts {
                        if body == other && !self.kinematic[*body] {
                            sum += dot(block, &mul(&self.inverse[*body], against));
                        }
                    }
                }
                *self.factor.entry(i, j) = sum;
            }
            let alone = *self.factor.entry(i, i);
            self.factor.measure(i, alone);
            *self.factor.entry(i, i) += if stabilising { STABILISING_COMPLIANCE * alone } else { 0.0 };
            let row = &self.rows[self.active[i]];
            for (l, gamma) in row.compliance[..=row.place].iter().enumerate() {
                *self.factor.entry(i, i - row.place + l) += gamma;
            }
        }
        self.factor.factor();
    }

    /// Solves for `a` and `lambda`; the `a` of kinematic bodies is an input.
    pub fn solve(&mut self, b: &mut [Vec6], g: &[f64], a: &mut [Vec6], lambda: &mut [f64]) {
        for body in (0..b.len()).filter(|&body| !self.kinematic[body]) {
            a[body] = mul(&self.inverse[body], &b[body]);
        }
        let n = self.active.len();
        for k in 0..n {
            let row = &self.rows[self.active[k]];
            self.mu[k] = g[row.at] - row.parts.iter().map(|(body, block)| dot(block, &a[*body])).sum::<f64>();
        }
        self.factor.solve(&mut self.mu[..n]);
        for k in 0..n {
            let row = &self.rows[self.active[k]];
            lambda[row.at] = self.mu[k];
            for (body, block) in &row.parts {
                if !self.kinematic[*body] {
                    add_scaled(&mut b[*body], self.mu[k], block);
                }
            }
        }
        for body in (0..b.len()).filter(|&body| !self.kinematic[body]) {
            a[body] = mul(&self.inverse[body], &b[body]);
        }
    }
}

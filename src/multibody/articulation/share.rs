//! Rows that carry a part of the force that would hold them: the Γ of a share s.
//!
//! Let K be the effective inverse mass of the rows of one joint whose share is below 1: what the figure answers to
//! their force when all other rows hold. Held alone they would carry λ_hard = K⁻¹ e for a wanted e; with
//!
//! ```text
//! Γ = D K D       D = diag √(1/s − 1)
//! (K + Γ) λ = e   so that λ = s λ_hard where all have the share s
//! ```
//!
//! whatever hangs on either side, in either solver, in any axes. D is 0 for a whole row and grows without bound as s
//! falls to 0: the row fades from hard to absent. Rows of one joint that cross (s and 1 − s) morph into each other.
//!
//! K comes from the factor in which all rows are hard: with b = 0 and g = e_k the solve gives λ = column k of
//! (J M⁻¹ Jᵀ)⁻¹, and its block among the joint's rows is K⁻¹. Where a row repeats others that is 0; such a row takes
//! the K of its own two bodies instead. All this happens only while something fades.

use super::System;
use super::block::{MAX_ROWS, RowSquare, RowVec, pseudo_inverse};
use super::system::PROJECTION_REACH;

impl System {
    /// Rows that act and are too far from closed for projection, at the last evaluation, each with the pull ω₀² |C| of the
    /// stabiliser that draws it together, m/s² or rad/s²; `time` is the figure's own 1/ω₀, s.
    pub fn open_rows(&self, time: f64) -> impl Iterator<Item = (usize, f64)> {
        let acting = self.lean_rows().filter(|&row| self.states()[row].share > 0.0);
        acting.filter_map(move |row| {
            let state = &self.states()[row];
            let time = self.constraints()[state.constraint].stabilization_time.unwrap_or(time);
            (state.value.abs() > PROJECTION_REACH).then(|| (row, state.value.abs() / (time * time)))
        })
    }

    /// Gives rows of a share below 1 their Γ, from the factor in which they are hard. The right-hand sides are used.
    pub(super) fn soften(&mut self) {
        for joint in 0..self.joints().len() {
            let (at, hard) = (self.joints()[joint].at, self.joints()[joint].hard);
            self.soften_among(at, hard);
        }
        let mut coupling = 0;
        while let Some(at) = self.coupling_row(coupling) {
            self.soften_among(at, 1);
            coupling += 1;
        }
        self.b.fill([0.0; 6]);
        self.g.fill(0.0);
    }

    /// The same for those of `count` rows from `at` on that need it.
    fn soften_among(&mut self, at: usize, count: usize) {
        let (mut rows, mut n) = ([0; MAX_ROWS], 0);
        for row in at..at + count {
            let share = self.states()[row].share;
            if share > 0.0 && share < 1.0 {
                rows[n] = row;
                n += 1;
            }
        }
        if n == 0 {
            return;
        }
        let rows = &rows[..n];
        let mut k: RowSquare = [[0.0; MAX_ROWS]; MAX_ROWS];
        let mut d: RowVec = [0.0; MAX_ROWS];
        for (j, &row) in rows.iter().enumerate() {
            let share = self.states()[row].share;
            d[j] = (1.0 / share - 1.0).sqrt();
            self.b.fill([0.0; 6]);
            self.a.fill([0.0; 6]);
            self.g.fill(0.0);
            self.g[row] = 1.0;
            self.solve();
            for i in j..n {
                k[i][j] = self.lambda[rows[i]];
            }
        }
        pseudo_inverse(&mut k, n);
        for (j, &row) in rows.iter().enumerate() {
            if k[j][j] <= 0.0 {
                k[j][j] = self.response(row);
            }
        }
        self.set_compliance(rows, &k, &d);
    }
}

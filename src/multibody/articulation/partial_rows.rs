//! Constraint force mixing for partially active rows: the compliance Γ of an activation s.
//!
//! K is the effective inverse mass of a joint's rows whose activation is below 1, with all other rows held. Fully
//! active, they would carry λ_hard = K⁻¹ e for a wanted e. With
//!
//! ```text
//! Γ = D K D       D = diag √(1/s − 1)
//! (K + Γ) λ = e   so that λ = s λ_hard where all have the share s
//! ```
//!
//! this holds for any bodies on either side, in either solver, in any axes. D is 0 for a fully active row and grows
//! without bound as s falls to 0: the row fades from hard to absent. Rows of one joint whose activations cross (s and
//! 1 − s) morph into each other.
//!
//! K comes from the factor in which all rows are hard: with b = 0 and g = e_k the solve gives λ = column k of (J M⁻¹
//! Jᵀ)⁻¹, and its block among the joint's rows is K⁻¹. Where a row repeats others that is 0; such a row uses the K of
//! its own two bodies instead. This work is done only while some activation is between 0 and 1.

use super::System;
use super::system::PROJECTION_LIMIT;
use soffio_math::spatial::row_blocks::{MAX_ROWS, RowSquare, RowVec, pseudo_inverse};

impl System {
    /// Active rows that are too far from closed for projection, at the last evaluation, each with the Baumgarte pull
    /// ω₀² |C|, m/s² or rad/s²; `time` is the articulation's 1/ω₀, s.
    pub fn open_rows(&self, time: f64) -> impl Iterator<Item = (usize, f64)> {
        let acting = self.rows_without_trains().filter(|&row| self.states()[row].activation > 0.0);
        acting.filter_map(move |row| {
            let state = &self.states()[row];
            let time = self.constraints()[state.constraint].stabilization_time.unwrap_or(time);
            (state.value.abs() > PROJECTION_LIMIT).then(|| (row, state.value.abs() / (time * time)))
        })
    }

    /// Sets Γ of the rows with an activation below 1, from the factor in which they are hard. Overwrites the
    /// right-hand sides.
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

    /// Does so among `count` rows from `at` on.
    fn soften_among(&mut self, at: usize, count: usize) {
        let (mut rows, mut n) = ([0; MAX_ROWS], 0);
        for row in at..at + count {
            let activation = self.states()[row].activation;
            if activation > 0.0 && activation < 1.0 {
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
            let activation = self.states()[row].activation;
            d[j] = (1.0 / activation - 1.0).sqrt();
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
                k[j][j] = self.uncoupled_inverse_mass(row);
            }
        }
        self.set_compliance(rows, &k, &d);
    }
}

//! Reduced-coordinate response of gear trains to impulses that act on nothing else.
//!
//! A row J outside the joints that touches only bodies of trains (and kinematic ones) has a coefficient f along each
//! train's coordinate. Its response is
//!
//! ```text
//! q̇ = f/m + Σ μ g/m        S μ = −Σ g f/m        g those of the rows of loops, S their system (`loops/`)
//! ```
//!
//! since trains have no children in the tree. Contacts of a clock are of this kind.

use super::System;
use soffio_math::spatial::Vec6;

/// Coefficients f of a row's bodies, each with its train.
pub type TrainRow<const N: usize> = [Option<(usize, f64)>; N];

impl System {
    /// Coefficients of a row on trains; `None` where it touches any other free body.
    pub fn train_row<const N: usize>(&self, ends: &[Option<(usize, Vec6)>; N]) -> Option<TrainRow<N>> {
        let is_free = |body: usize| !self.kinematic[body] && !self.factor.trains.has(body);
        if self.factor.trains.is_empty() || ends.iter().flatten().any(|(body, _)| is_free(*body)) {
            return None;
        }
        Some(ends.each_ref().map(|end| end.as_ref().and_then(|part| self.factor.trains.row_coefficient(part))))
    }

    /// Finds the response of all trains to a unit impulse of such a row, joints held, with the present factor.
    pub fn respond_to_train_row<const N: usize>(&mut self, row: &TrainRow<N>) {
        self.factor.trains.respond(row.iter().flatten().copied());
        self.factor.loops.correct_trains(&mut self.factor.trains);
    }

    /// Velocity of such a row by that response.
    pub fn train_row_rate<const N: usize>(&self, row: &TrainRow<N>) -> f64 {
        row.iter().flatten().map(|(train, f)| f * self.factor.trains.rate(*train)).sum()
    }
}

//! Impulses that only trains feel: how these answer in their own coordinates, without a solve for every body.
//!
//! A row J outside the joints that touches nothing but bodies of trains (and what is driven, which gives way to nothing) has
//! an f along each train's coordinate, and is answered by
//!
//! ```text
//! q̇ = f/m + Σ μ g/m        S μ = −Σ g f/m        g those of the rows of loops, S their system (`loops/`)
//! ```
//!
//! since nothing hangs on a train in the tree. What contacts ask of a clock is of this kind.

use super::System;
use soffio_math::spatial::Vec6;

/// f of a row's ends, each with its train.
pub type Geared<const N: usize> = [Option<(usize, f64)>; N];

impl System {
    /// What a row pushes of trains; `None` where it touches anything else that gives way.
    pub fn geared<const N: usize>(&self, ends: &[Option<(usize, Vec6)>; N]) -> Option<Geared<N>> {
        let gives_way = |body: usize| !self.driven[body] && !self.factor.trains.has(body);
        if self.factor.trains.is_empty() || ends.iter().flatten().any(|(body, _)| gives_way(*body)) {
            return None;
        }
        Some(ends.each_ref().map(|end| end.as_ref().and_then(|part| self.factor.trains.share(part))))
    }

    /// Finds the answer of all trains to a unit impulse of such a row, joints held, by the factor at hand.
    pub fn answer_geared<const N: usize>(&mut self, row: &Geared<N>) {
        self.factor.trains.answer(row.iter().flatten().copied());
        self.factor.loops.correct_trains(&mut self.factor.trains);
    }

    /// The velocity of such a row by that answer.
    pub fn geared_rate<const N: usize>(&self, row: &Geared<N>) -> f64 {
        row.iter().flatten().map(|(train, f)| f * self.factor.trains.rate(*train)).sum()
    }
}

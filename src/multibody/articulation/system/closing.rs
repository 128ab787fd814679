//! Closing joints by position alone, for motion that is solved in places and not in forces.
//!
//! One Newton step on C with the tree's factor, least in kinetic energy:
//!
//! ```text
//! M δ = Jᵀ λ        J δ = C* − C
//! ```
//!
//! where C* is what a row may keep: nothing if it is a joint that was closed, and (a figure that gathers) a share
//! exp(−Δt/τ) of what it was if it was far open.

use super::System;
use super::joint::PROJECTION_REACH;
use crate::articulation::ball::Wanted;
use crate::articulation::trains::Asked;
use soffio_math::exp;
use soffio_math::spatial::Vec6;

impl System {
    /// Counts every acting row as one that projection closes, however far it is open; what acts in part stays loose.
    pub fn take_up(&mut self) {
        self.rows.tell_values(&self.factor);
        self.rows.gathering = false;
        for state in &mut self.rows.states {
            state.gathers = state.share < 1.0;
        }
    }

    /// Solves for the displacement after which each row is open by `left` (m or rad) and no more, to first order.
    pub fn solve_closing(&mut self, left: &[f64]) {
        self.b.fill([0.0; 6]);
        self.solve_closing_under(left);
    }

    /// The same where `b` pushes, kg m and kg m² rad.
    pub fn solve_closing_under(&mut self, left: &[f64]) {
        self.factor.asked = Asked::Place;
        self.rows.tell_values(&self.factor);
        self.still();
        for ((g, state), left) in self.g.iter_mut().zip(&self.rows.states).zip(left) {
            *g = if state.gathers { 0.0 } else { left - state.value };
        }
        self.solve();
    }

    /// Answer to a push, joints held, in `a` of the bodies on these ways to their roots ([`System::ways`]) at least.
    pub fn respond(&mut self, ways: &[usize], push: impl Iterator<Item = (usize, Vec6)>) {
        let alone = self.factor.outside().is_empty() && self.factor.trains.is_empty() && self.factor.dense.is_none();
        if !alone {
            self.b.fill([0.0; 6]);
        }
        for &body in ways {
            (self.b[body], self.a[body]) = ([0.0; 6], [0.0; 6]);
        }
        for (body, block) in push {
            self.push_impulse(body, &block, 1.0);
        }
        if !alone {
            return self.solve_impulse();
        }
        for &body in ways.iter().rev() {
            self.factor.tree.up(body, &mut self.b, None, &mut self.lambda);
        }
        for &body in ways {
            self.factor.tree.down(body, &self.b, Wanted::Nothing, &mut self.lambda, &mut self.a);
        }
    }

    /// Bodies on the ways from these to their roots, roots first; `ways` has room for all.
    pub fn ways(&self, from: impl Iterator<Item = usize>, on: &mut [bool], ways: &mut Vec<usize>) {
        self.factor.tree.paths_into(from, on, ways);
    }

    /// Largest |C − left| of the acting rows at the last evaluation, m or rad. What acts in part does not count.
    pub fn open_by(&mut self, left: &[f64]) -> f64 {
        self.rows.tell_values(&self.factor);
        let joints = self.rows.joints.iter().flat_map(|joint| joint.at..joint.at + joint.hard);
        let couplings = self.rows.couplings.iter().filter(|c| self.activity.share(c.constraint) > 0.0).map(|c| c.at);
        let open = |worst: f64, row: usize| {
            let state = &self.rows.states[row];
            if state.share < 1.0 { worst } else { worst.max((state.value - left[row]).abs()) }
        };
        joints.chain(couplings).fold(0.0, open)
    }

    /// What of each row is to be left open after `dt` seconds, m or rad: nothing of what is closed, and of what is far
    /// open (a figure that gathers) as much as a decay with its time constant leaves. From the last evaluation.
    pub fn leave_open(&mut self, dt: f64, time_constant: f64, left: &mut [f64]) {
        self.rows.tell_values(&self.factor);
        for (left, state) in left.iter_mut().zip(&self.rows.states) {
            let own = self.rows.constraints[state.constraint].stabilization_time.unwrap_or(time_constant);
            let far = state.value.abs() > PROJECTION_REACH;
            *left = if far { state.value * exp(-dt / own) } else { 0.0 };
        }
    }

    /// C (m or rad) and the row of each coupling that acts, by the bodies it touches.
    pub fn coupled(&self) -> impl Iterator<Item = (f64, &[(usize, Vec6)])> {
        let rows = self.factor.outside();
        let acting = self.rows.couplings.iter().filter(|c| self.activity.share(c.constraint) == 1.0);
        acting.map(|c| (self.rows.states[c.at].value, &rows[c.outside].parts[..]))
    }
}

//! Position-level joint closure: one Newton step on the constraint errors, for position-based motion.
//!
//! The step is the one of least kinetic energy:
//!
//! ```text
//! M δ = Jᵀ λ        J δ = C* − C
//! ```
//!
//! where C* is a row's target error: 0 for a closed joint, and exp(−Δt/τ) of its present error for a joint that is
//! being assembled.

use super::System;
use super::joint::PROJECTION_LIMIT;
use crate::articulation::ball_elimination::JointTarget;
use crate::articulation::trains::SolveKind;
use soffio_math::exp;
use soffio_math::spatial::Vec6;

impl System {
    /// Lets projection close every fully active row, however open it is; partially active rows stay free.
    pub fn include_open_rows(&mut self) {
        self.rows.write_values(&self.factor);
        self.rows.stabilising = false;
        for state in &mut self.rows.states {
            state.stabilised = state.activation < 1.0;
        }
    }

    /// Solves for the displacement after which each row's error is its target (m or rad), to first order.
    pub fn solve_closing(&mut self, targets: &[f64]) {
        self.b.fill([0.0; 6]);
        self.solve_closing_under(targets);
    }

    /// The same with the impulses `b`, kg m and kg m² rad.
    pub fn solve_closing_under(&mut self, targets: &[f64]) {
        self.factor.solve_kind = SolveKind::Place;
        self.rows.write_values(&self.factor);
        self.hold_kinematic();
        for ((g, state), targets) in self.g.iter_mut().zip(&self.rows.states).zip(targets) {
            *g = if state.stabilised { 0.0 } else { targets - state.value };
        }
        self.solve();
    }

    /// Response to impulses, joints held, in `a`, at least for the bodies on these root paths
    /// ([`System::root_paths`]).
    pub fn respond(&mut self, paths: &[usize], push: impl Iterator<Item = (usize, Vec6)>) {
        let alone = self.factor.outside().is_empty() && self.factor.trains.is_empty() && self.factor.dense.is_none();
        if !alone {
            self.b.fill([0.0; 6]);
        }
        for &body in paths {
            (self.b[body], self.a[body]) = ([0.0; 6], [0.0; 6]);
        }
        for (body, block) in push {
            self.push_impulse(body, &block, 1.0);
        }
        if !alone {
            return self.solve_impulse();
        }
        for &body in paths.iter().rev() {
            self.factor.tree.inward(body, &mut self.b, None, &mut self.lambda);
        }
        for &body in paths {
            self.factor.tree.outward(body, &self.b, JointTarget::Zero, &mut self.lambda, &mut self.a);
        }
    }

    /// Bodies on the paths from these to their roots, roots first; `paths` has capacity for all bodies.
    pub fn root_paths(&self, from: impl Iterator<Item = usize>, on: &mut [bool], paths: &mut Vec<usize>) {
        self.factor.tree.paths_into(from, on, paths);
    }

    /// Largest |C − target| of the fully active rows at the last evaluation, m or rad.
    pub fn largest_residual(&mut self, targets: &[f64]) -> f64 {
        self.rows.write_values(&self.factor);
        let joints = self.rows.joints.iter().flat_map(|joint| joint.at..joint.at + joint.hard);
        let couplings =
            self.rows.couplings.iter().filter(|c| self.activity.activation(c.constraint) > 0.0).map(|c| c.at);
        let open = |worst: f64, row: usize| {
            let state = &self.rows.states[row];
            if state.activation < 1.0 { worst } else { worst.max((state.value - targets[row]).abs()) }
        };
        joints.chain(couplings).fold(0.0, open)
    }

    /// Target errors after `dt` seconds, m or rad: 0 for closed rows, and for open ones an exponential decay with
    /// their time constant (s). From the last evaluation.
    pub fn decay_targets(&mut self, dt: f64, time_constant: f64, targets: &mut [f64]) {
        self.rows.write_values(&self.factor);
        for (targets, state) in targets.iter_mut().zip(&self.rows.states) {
            let own = self.rows.constraints[state.constraint].stabilization_time.unwrap_or(time_constant);
            let far = state.value.abs() > PROJECTION_LIMIT;
            *targets = if far { state.value * exp(-dt / own) } else { 0.0 };
        }
    }

    /// C (m or rad) and the row of each fully active coupling, by the bodies it touches.
    pub fn coupled(&self) -> impl Iterator<Item = (f64, &[(usize, Vec6)])> {
        let rows = self.factor.outside();
        let acting = self.rows.couplings.iter().filter(|c| self.activity.activation(c.constraint) == 1.0);
        acting.map(|c| (self.rows.states[c.at].value, &rows[c.outside].parts[..]))
    }
}

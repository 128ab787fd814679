//! Queries of a system: rows, errors, loads. For breaking, friction, tests and staff.

use super::System;
use super::joint::{Joint, PROJECTION_LIMIT, RowState};
use crate::articulation::rows::{BodyStates, coupling, orientation, plane};
use crate::articulation::{Constraint, ConstraintKind, Load};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::matrix;
use soffio_math::spatial::{Vec6, angular, linear, vec6};
use soffio_math::{DMat3, DVec3};

impl System {
    /// The joint that a row belongs to.
    fn joint_of(&self, row: usize) -> Option<&Joint> {
        self.rows.joints.iter().find(|joint| (joint.at..joint.at + joint.rows).contains(&row))
    }

    /// World arms of a ball joint.
    fn arms_of(&self, joint: &Joint) -> Option<(DVec3, DVec3)> {
        joint.ball_joint_body.map_or(joint.arms, |body| Some(self.factor.tree.arms(body)))
    }

    /// J of one row as blocks of its bodies (for tests and reports).
    pub fn jacobian(&self, row: usize) -> Vec<(usize, Vec6)> {
        if let Some(joint) = self.joint_of(row) {
            let k = row - joint.at;
            let (a, b) = match (self.arms_of(joint), joint.block) {
                (Some((r, s)), _) => {
                    let e = DVec3::AXES[k];
                    (vec6(e, r.cross(e)), vec6(-e, -s.cross(e)))
                }
                (None, Some(block)) => (self.rows.blocks[block].a[k], self.rows.blocks[block].b[k]),
                (None, None) => return Vec::new(),
            };
            return [Some((joint.link.a, a)), joint.link.b.map(|body| (body, b))].into_iter().flatten().collect();
        }
        let coupling = self.rows.couplings.iter().find(|coupling| coupling.at == row);
        coupling.map_or(Vec::new(), |coupling| self.factor.outside()[coupling.outside].parts.clone())
    }

    /// Γ between two rows at the last factorisation.
    pub fn compliance(&self, row: usize, other: usize) -> f64 {
        let (low, high) = (row.min(other), row.max(other));
        if let Some(joint) = self.rows.joints.iter().find(|joint| (joint.at..joint.at + joint.rows).contains(&low)) {
            let inside = high < joint.at + joint.rows && joint.arms.is_none();
            let block = joint.block.filter(|_| inside);
            return block.map_or(0.0, |block| self.rows.blocks[block].compliance[high - joint.at][low - joint.at]);
        }
        let coupling = self.rows.couplings.iter().find(|coupling| coupling.at == row && row == other);
        coupling.map_or(0.0, |coupling| self.factor.outside()[coupling.outside].compliance[0])
    }

    /// Active rows, as indices into `g` and `lambda`.
    pub fn acting_rows(&self) -> Vec<usize> {
        let mut rows: Vec<usize> = self.rows.joints.iter().flat_map(|joint| joint.at..joint.at + joint.rows).collect();
        rows.extend(self.rows.couplings.iter().filter(|c| self.activity.activation(c.constraint) > 0.0).map(|c| c.at));
        rows
    }

    /// Redundant rows at the last factorisation: (constraint, row's index).
    pub fn redundant_rows(&self) -> Vec<(usize, usize)> {
        let mut out = Vec::new();
        let outside = |index: usize| match &self.factor.dense {
            Some(dense) => dense.is_redundant(index),
            None => self.factor.loops.is_redundant(index),
        };
        let mut child_of = vec![None; self.rows.joints.len()];
        for &body in self.factor.tree.order() {
            if let Some(joint) = self.factor.tree.joint_of(body) {
                child_of[joint] = Some(body);
            }
        }
        for (index, joint) in self.rows.joints.iter().enumerate() {
            for k in 0..joint.rows {
                let repeats = match (joint.outside, child_of[index]) {
                    (Some(first), _) => outside(first + k),
                    (None, Some(body)) => self.factor.tree.redundant(body) >> k & 1 == 1,
                    (None, None) => false,
                };
                if repeats {
                    out.push((self.rows.states[joint.at + k].constraint, joint.at + k));
                }
            }
        }
        let acting = self.rows.couplings.iter().filter(|coupling| self.activity.activation(coupling.constraint) > 0.0);
        for coupling in acting.filter(|coupling| outside(coupling.outside)) {
            out.push((coupling.constraint, coupling.at));
        }
        out
    }

    /// Capacity of the factors of closed loops, which determines the cost of their elimination.
    pub fn loop_factor_len(&self) -> usize {
        self.factor.loops.numbers()
    }

    /// Largest |C| of any hard row of the last evaluation (m or rad).
    pub fn largest_error(&self) -> f64 {
        self.largest_of(self.rows.joints.iter())
    }

    /// The same without rows inside gear trains, which constrained dynamics does not evaluate.
    pub fn largest_error_without_trains(&self) -> f64 {
        self.largest_of(self.rows.joints.iter().filter(|joint| !joint.in_train))
    }

    fn largest_of<'a>(&'a self, joints: impl Iterator<Item = &'a Joint>) -> f64 {
        joints
            .filter(|joint| joint.ball_joint_body.is_none())
            .flat_map(|joint| &self.rows.states[joint.at..joint.at + joint.hard])
            .fold(self.factor.ball_joints.largest(&self.factor.tree), |worst, state| worst.max(state.value.abs()))
    }

    /// Largest position error at these bodies' state, m: gaps of points, heights over planes, slip of couplings.
    pub fn largest_gap(&self, bodies: &[RigidBody]) -> f64 {
        let mut frames = vec![DMat3::IDENTITY; bodies.len()];
        self.largest_length(bodies, false, &mut frames).max(self.sleep_state.gap)
    }

    /// The same among sleeping constraints or among all others; `frames` is scratch, a matrix a body.
    pub(super) fn largest_length(&self, bodies: &[RigidBody], sleeps: bool, frames: &mut [DMat3]) -> f64 {
        for (body, frame) in frames.iter_mut().enumerate().filter(|(body, _)| self.sleep_state.bodies[*body] == sleeps)
        {
            *frame = matrix(bodies[body].rotation);
        }
        let scene = BodyStates { bodies, frames, time: self.activity.time() };
        let is_length = |c: &Constraint| !matches!(c.kind, ConstraintKind::Orientation { .. });
        let selected =
            |index: &usize| self.sleep_state.constraints[*index] == sleeps && is_length(&self.rows.constraints[*index]);
        (0..self.rows.constraints.len()).filter(selected).map(|index| self.gap(index, &scene)).fold(0.0, f64::max)
    }

    /// Largest error of these constraints at these bodies' state, m, of orientations rad; 0 for those not fully active or still
    /// reclosing. `frames` is scratch, a matrix a body.
    pub fn largest_gap_of(&self, constraints: &[usize], bodies: &[RigidBody], frames: &mut [DMat3]) -> f64 {
        frames.iter_mut().zip(bodies).for_each(|(frame, body)| *frame = matrix(body.rotation));
        let scene = BodyStates { bodies, frames, time: self.activity.time() };
        constraints.iter().fold(0.0, |largest: f64, &index| largest.max(self.gap(index, &scene)))
    }

    /// Error of each constraint at these bodies' state: m, of an orientation rad. 0 for those not fully active or
    /// still reclosing.
    pub fn gaps(&self, bodies: &[RigidBody]) -> Vec<f64> {
        let frames: Vec<DMat3> = bodies.iter().map(|body| matrix(body.rotation)).collect();
        let scene = BodyStates { bodies, frames: &frames, time: self.activity.time() };
        (0..self.rows.constraints.len()).map(|index| self.gap(index, &scene)).collect()
    }

    fn gap(&self, index: usize, scene: &BodyStates) -> f64 {
        if self.activity.activation(index) < 1.0 || self.activity.is_reclosing(index) {
            return 0.0;
        }
        match &self.rows.constraints[index].kind {
            ConstraintKind::PointToPoint { a, b } => scene.place(a).distance(scene.place(b)),
            ConstraintKind::PointOnPlane { point, plane, normal, offset } => {
                plane::value(scene, point, plane, *normal, offset).abs()
            }
            ConstraintKind::Orientation { a, b, angle } => orientation::row(scene, a, b, angle, || None).value.abs(),
            ConstraintKind::Coupling { .. } => {
                let own = self.rows.couplings.iter().find(|coupling| coupling.constraint == index);
                own.map_or(0.0, |own| (coupling::value(scene, &own.terms) - own.offset).abs())
            }
        }
    }

    /// Writes the force of each joint's length rows in the last force solve into `loads`, N. Joints of sleeping
    /// bodies and of gear trains keep their entries.
    pub fn record_joint_loads(&self, loads: &mut [f64]) {
        self.factor.ball_joints.record_joint_loads(&self.factor.tree, &self.sleep_state.bodies, loads);
        for &index in &self.rows.general_joints[..self.rows.outside_trains] {
            let joint = &self.rows.joints[index];
            if !self.sleep_state.bodies[joint.link.a] {
                let lengths = (joint.at..joint.at + joint.hard).filter(|&row| self.rows.states[row].length);
                loads[index] = lengths.fold(0.0, |sum, row| sum + self.lambda[row] * self.lambda[row]).sqrt();
            }
        }
    }

    /// World arms from a joint's bodies to its point at the last evaluation, m; for stiffness estimates.
    pub fn arms(&self, joint: usize) -> (DVec3, DVec3) {
        let joint = &self.rows.joints[joint];
        if let Some(arms) = self.arms_of(joint) {
            return arms;
        }
        // The arm of a length row (e, r × e) is at least |r × e|: three rows of a point give r.
        let Some(block) = joint.block else { return (DVec3::ZERO, DVec3::ZERO) };
        let rows = &self.rows.blocks[block];
        let longest = |blocks: &[Vec6]| {
            let mut best = DVec3::ZERO;
            for k in (0..joint.hard).filter(|&k| self.rows.states[joint.at + k].length) {
                let arm = linear(&blocks[k]).cross(angular(&blocks[k]));
                if arm.length_squared() > best.length_squared() {
                    best = arm;
                }
            }
            best
        };
        (longest(&rows.a), longest(&rows.b))
    }

    /// Whether a constraint is closed, or nearly enough for projection.
    pub fn is_closed(&self, constraint: usize) -> bool {
        let apart = |state: &RowState| state.constraint == constraint && state.stabilised;
        let active = self.rows.joints.iter().flat_map(|joint| &self.rows.states[joint.at..joint.at + joint.hard]);
        !active.chain(self.rows.couplings.iter().map(|c| &self.rows.states[c.at])).any(apart)
    }

    /// Load of a constraint in the last solve. The stabiliser's pull on open rows is no load.
    pub fn constraint_load(&self, constraint: usize) -> Load {
        let (mut force, mut torque) = (0.0, 0.0);
        let joints = self.rows.joints.iter().filter(|joint| joint.constraints.contains(&constraint));
        let of_joint = |joint: &'_ Joint| {
            let ball_joints = joint.ball_joint_body.map(|body| self.factor.tree.force(body).to_array());
            let at = joint.at;
            (0..joint.hard)
                .map(move |k| (at + k, ball_joints.map_or_else(|| self.lambda[at + k], |ball_joints| ball_joints[k])))
        };
        let couplings = self.rows.couplings.iter().filter(|c| c.constraint == constraint).map(|c| c.at);
        let couplings =
            couplings.filter(|_| self.activity.activation(constraint) > 0.0).map(|at| (at, self.lambda[at]));
        let own = |&(row, _): &(usize, f64)| {
            let state = &self.rows.states[row];
            state.constraint == constraint && state.value.abs() <= PROJECTION_LIMIT
        };
        for (row, lambda) in joints.flat_map(of_joint).chain(couplings).filter(own) {
            let square = lambda * lambda;
            if self.rows.states[row].length { force += square } else { torque += square }
        }
        Load { force: force.sqrt(), torque: torque.sqrt() }
    }
}

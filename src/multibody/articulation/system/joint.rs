//! Joints: all constraints between one pair of bodies, their rows at a configuration, and the rows' states.

use std::collections::BTreeMap;

use crate::articulation::activity::Activity;
use crate::articulation::loops::LoopRow;
use crate::articulation::rows::{BodyStates, JacobianRow, friction, orientation, plane, point};
use crate::articulation::topology::Link;
use crate::articulation::tree::JointRows;
use crate::articulation::{Anchor, Constraint, ConstraintKind};
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_math::spatial::row_blocks::MAX_ROWS;
use soffio_math::spatial::vec6;

/// Error above which a row is closed by stabilisation instead of projection, m or rad.
pub(in crate::articulation) const PROJECTION_LIMIT: f64 = 1e-4;
/// Most hard rows of a joint; three of friction may follow.
const MAX_HARD_ROWS: usize = MAX_ROWS - 3;

/// All constraints between one pair of bodies.
#[derive(Clone, Debug)]
pub struct Joint {
    /// The pair.
    pub link: Link,
    /// Indices of its constraints.
    pub constraints: Vec<usize>,
    /// Where its numbers begin in `g`, `lambda` and the other lists of rows.
    pub at: usize,
    /// Most rows that it can have at once.
    pub(super) capacity: usize,
    /// Rows at the last evaluation, friction included.
    pub rows: usize,
    /// Number of hard rows, the first ones.
    pub hard: usize,
    /// Of a ball joint: its point from the two bodies' centres of mass in their node axes (in the world for the
    /// world), m.
    pub(super) point: Option<(DVec3, DVec3)>,
    /// World arms of a hard ball joint at the last evaluation; those of `ball_joint_body` are in the tree.
    pub(super) arms: Option<(DVec3, DVec3)>,
    /// Child body, where it is always a ball joint.
    pub(super) ball_joint_body: Option<usize>,
    /// Index of its row block, where it can be more than a ball joint.
    pub(super) block: Option<usize>,
    /// First of its rows outside the tree, where it is in a loop or the solver is dense.
    pub(super) outside: Option<usize>,
    /// Whether it is inside a gear train.
    pub(super) in_train: bool,
}

/// State of one scalar constraint row, C = q(x) − f(t), beside its Jacobian blocks.
#[derive(Clone, Copy, Debug, Default)]
pub struct RowState {
    /// C, the error of the row, m or rad.
    pub value: f64,
    /// ḟ, rate of a prescribed motion, m/s or rad/s.
    pub(super) prescribed_rate: f64,
    /// J̇ẋ − f̈, the part of the row's acceleration without J ẍ, m/s² or rad/s².
    pub(in crate::articulation) bias: f64,
    /// Whether C is a length (else an angle).
    pub(super) length: bool,
    /// Index of its constraint.
    pub(in crate::articulation) constraint: usize,
    /// Activation of its constraint, 0 … 1.
    pub(in crate::articulation) activation: f64,
    /// Whether stabilisation closes it: it is far from closed, or partially active.
    pub(in crate::articulation) stabilised: bool,
}

impl RowState {
    /// Sets the state from an evaluated row.
    #[inline(always)]
    pub(super) fn set(&mut self, row: &JacobianRow, constraint: usize, activation: f64) {
        let stabilised = self.stabilised;
        let JacobianRow { value, prescribed_rate, bias, length, .. } = *row;
        *self = Self { value, prescribed_rate, bias, length, constraint, activation, stabilised };
    }
}

impl Joint {
    /// Evaluates this joint's rows.
    #[inline(always)]
    pub(super) fn evaluate(
        &mut self,
        scene: &BodyStates,
        constraints: &[Constraint],
        activity: &Activity,
        blocks: &mut [JointRows],
        states: &mut [RowState],
    ) {
        self.arms = None;
        if let (Some((p, q)), None) = (self.point, self.outside)
            && activity.activation(self.constraints[0]) == 1.0
        {
            let a = &scene.bodies[self.link.a];
            let r = scene.frames[self.link.a] * p;
            let rotational_velocity = a.angular_velocity.cross(r);
            let (mut c, mut bias) = (a.position + r, a.angular_velocity.cross(rotational_velocity));
            let mut s = DVec3::ZERO;
            if let Some(index) = self.link.b {
                let b = &scene.bodies[index];
                s = scene.frames[index] * q;
                c -= b.position + s;
                bias -= b.angular_velocity.cross(b.angular_velocity.cross(s));
            } else {
                c -= q;
            }
            for k in 0..3 {
                let state = &mut states[self.at + k];
                (state.value, state.prescribed_rate, state.bias) = (c[k], 0.0, bias[k]);
                (state.length, state.constraint, state.activation) = (true, self.constraints[0], 1.0);
            }
            (self.rows, self.hard) = (3, 3);
            self.arms = Some((r, s));
            return;
        }
        let Some(block) = self.block else { return };
        let rows = &mut blocks[block];
        rows.rows = 0;
        rows.harden();
        for i in 0..self.constraints.len() {
            let index = self.constraints[i];
            let activation = activity.activation(index);
            if activation <= 0.0 {
                continue;
            }
            let constraint = &constraints[index];
            let own = constraint.link().is_some_and(|(a, _)| a == Some(self.link.a));
            let mut push = |row: JacobianRow| {
                let k = rows.rows;
                if k == MAX_HARD_ROWS {
                    // Six rows hold all six DOFs: more can only repeat.
                    return;
                }
                (rows.a[k], rows.b[k]) = if own { (row.a, row.b) } else { (row.b, row.a) };
                states[self.at + k].set(&row, index, activation);
                rows.rows = k + 1;
            };
            match &constraint.kind {
                ConstraintKind::PointToPoint { a, b } => point::rows(scene, a, b).into_iter().for_each(&mut push),
                ConstraintKind::PointOnPlane { point, plane, normal, offset } => {
                    push(plane::row(scene, point, plane, *normal, offset));
                }
                ConstraintKind::Orientation { a, b, angle } => {
                    let others = || self.constraints.iter().filter(|&&c| c != index && activity.activation(c) > 0.0);
                    let held_axis = || others().find_map(|&c| orientation_axis(scene, &constraints[c]));
                    push(orientation::row(scene, a, b, angle, held_axis));
                }
                ConstraintKind::Coupling { .. } => {}
            }
        }
        (self.rows, self.hard) = (rows.rows, rows.rows);
    }

    /// Adds friction rows after the hard ones.
    pub(super) fn add_friction(
        &mut self,
        constraints: &[Constraint],
        bodies: &[RigidBody],
        load: f64,
        h: f64,
        blocks: &mut [JointRows],
        states: &mut [RowState],
    ) {
        let Some(block) = self.block else { return };
        if !self.constraints.iter().any(|&index| constraints[index].friction.is_some()) {
            return;
        }
        let rows = &mut blocks[block];
        if let Some((r, s)) = self.arms.take() {
            rows.harden();
            rows.rows = 3;
            for (k, e) in DVec3::AXES.into_iter().enumerate() {
                (rows.a[k], rows.b[k]) = (vec6(e, r.cross(e)), vec6(-e, -s.cross(e)));
            }
        }
        let spin = |body: Option<usize>| body.map_or(DVec3::ZERO, |b| bodies[b].angular_velocity);
        let rate = (spin(Some(self.link.a)) - spin(self.link.b)).length();
        for &index in &self.constraints {
            let Some(pivot) = constraints[index].friction else { continue };
            for row in friction::rows() {
                let k = rows.rows;
                if k == self.capacity {
                    break;
                }
                (rows.a[k], rows.b[k]) = (row.a, row.b);
                rows.soft = true;
                rows.compliance[k] = [0.0; MAX_ROWS];
                rows.compliance[k][k] = friction::compliance(pivot.coefficient * load * pivot.radius, rate, h);
                // It has no position error; another row may have been at this index before.
                states[self.at + k] = RowState { constraint: index, activation: 1.0, ..RowState::default() };
                rows.rows = k + 1;
            }
        }
        self.rows = rows.rows;
    }

    /// Copies the rows for the dense solver.
    #[inline(always)]
    pub(super) fn write_outside(&self, blocks: &[JointRows], outside: &mut [LoopRow]) {
        let (Some(block), Some(first)) = (self.block, self.outside) else { return };
        let rows = &blocks[block];
        for (k, row) in outside[first..first + self.capacity].iter_mut().enumerate() {
            row.active = k < rows.rows;
            row.parts[0].1 = rows.a[k];
            if let Some(second) = row.parts.get_mut(1) {
                second.1 = rows.b[k];
            }
            row.compliance = rows.compliance[k];
        }
    }
}

/// Groups constraints by the pair of bodies they connect; also returns the number of rows.
pub(super) fn joints(constraints: &[Constraint]) -> (Vec<Joint>, usize) {
    let mut joints: Vec<Joint> = Vec::new();
    let mut of_pair: BTreeMap<(usize, Option<usize>), usize> = BTreeMap::new();
    for (index, constraint) in constraints.iter().enumerate() {
        let link = match constraint.link() {
            Some((Some(a), b)) => Link { a, b },
            Some((None, Some(b))) => Link { a: b, b: None },
            _ => continue,
        };
        let turned = link.b.map(|b| (b, Some(link.a)));
        let known = of_pair.get(&(link.a, link.b)).or_else(|| turned.and_then(|pair| of_pair.get(&pair)));
        if let Some(&joint) = known {
            joints[joint].constraints.push(index);
        } else {
            of_pair.insert((link.a, link.b), joints.len());
            joints.push(Joint {
                link,
                constraints: vec![index],
                at: 0,
                capacity: 0,
                rows: 0,
                hard: 0,
                point: None,
                arms: None,
                ball_joint_body: None,
                block: None,
                outside: None,
                in_train: false,
            });
        }
    }
    let mut at = 0;
    for joint in &mut joints {
        joint.at = at;
        joint.capacity = capacity(joint, constraints);
        at += joint.capacity;
    }
    (joints, at)
}

/// Axis that an orientation holds.
fn orientation_axis(scene: &BodyStates, constraint: &Constraint) -> Option<DVec3> {
    match &constraint.kind {
        ConstraintKind::Orientation { a, b, .. } => orientation::axis(scene, a, b),
        _ => None,
    }
}

/// Both points of a ball joint, as in [`Joint::point`].
pub(super) fn lone_point(joint: &Joint, constraints: &[Constraint], bodies: &[RigidBody]) -> Option<(DVec3, DVec3)> {
    let [index] = joint.constraints[..] else { return None };
    let ConstraintKind::PointToPoint { a, b } = &constraints[index].kind else { return None };
    let local = |anchor: &Anchor| anchor.point - anchor.body.map_or(DVec3::ZERO, |i| bodies[i].properties.center);
    let own = a.body == Some(joint.link.a);
    Some(if own { (local(a), local(b)) } else { (local(b), local(a)) })
}

/// Most rows that a joint can have at once.
fn capacity(joint: &Joint, constraints: &[Constraint]) -> usize {
    let each = |&index: &usize| constraints[index].row_count() + 3 * usize::from(constraints[index].friction.is_some());
    joint.constraints.iter().map(each).sum::<usize>().min(MAX_ROWS)
}

/// Whether it is always a hard ball joint without friction.
pub(super) fn is_only_point(constraint: &Constraint) -> bool {
    matches!(constraint.kind, ConstraintKind::PointToPoint { .. })
        && constraint.schedule.is_always()
        && constraint.breaking.is_none()
        && constraint.friction.is_none()
}

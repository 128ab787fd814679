//! Closure of one joint by moving one body: the source's rule, then Newton's method on the remaining rows.
//!
//! A joint may have any rows: points, planes, orientations, in any number. In this order
//!
//! 1. orientations: the least rotation that closes them;
//! 2. the first point or plane: compulsive rotation, without the component about the axes e that the
//!    orientations hold (w − Σ (w·ê) ê), and compulsive translation; for a plane s = −C N. Where one axis alone is free, arm and
//!    displacement across it count;
//! 3. all rows together, and the pair's violated limits (method 3.5: an angle beyond its limit is put back to it):
//!    Newton steps on the body's six coordinates, of least kinetic energy, with M of the body's group,
//!
//! ```text
//! K = J M⁻¹ Jᵀ        δ = −M⁻¹ Jᵀ K⁻¹ C
//! ```
//!
//! A ball joint is exact after the second. Redundant rows count once
//! (`soffio_math::spatial::row_blocks::pseudo_inverse`).

use super::two_body_rule::{self, Group};
use crate::articulation::rows::{BodyStates, JacobianRow, orientation, plane, point};
use crate::articulation::{Anchor, ConstraintKind, Joint, System};
use crate::dynamics::Contacts;
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::matrix;
use soffio_math::spatial::row_blocks::pseudo_inverse;
use soffio_math::spatial::row_blocks::{MAX_ROWS, RowBlock, RowSquare, RowVec};
use soffio_math::spatial::{Vec6, add_scaled, angular, dot, linear, vec6};
use soffio_math::{DMat3, DVec3};

/// Error below which rows are closed, m or rad.
const CLOSED: f64 = 1e-13;
/// Most Newton steps for one joint. A joint that can be closed takes three or four.
const MAX_NEWTON_STEPS: usize = 12;
/// Largest rotation in one of them, rad: beyond it the linearisation is poor.
const MAX_ROTATION: f64 = 0.7;

/// Bodies during a relaxation.
pub(super) struct Configuration<'a> {
    /// All bodies.
    pub bodies: &'a mut [RigidBody],
    /// Rotation matrices of the bodies.
    pub frames: &'a mut [DMat3],
    /// The joints.
    pub system: &'a System,
    /// Contacts and limits.
    pub contacts: &'a Contacts,
    /// Target error of each row, m or rad.
    pub targets: &'a [f64],
    /// Control c of the compulsive rotation.
    pub control: f64,
}

/// Rows of a joint with their blocks on one body.
struct BodyRows {
    count: usize,
    blocks: RowBlock,
    values: RowVec,
}

impl BodyRows {
    fn none() -> Self {
        Self { count: 0, blocks: [[0.0; 6]; MAX_ROWS], values: [0.0; MAX_ROWS] }
    }

    fn push(&mut self, block: &Vec6, value: f64) {
        if self.count < MAX_ROWS {
            (self.blocks[self.count], self.values[self.count]) = (*block, value);
            self.count += 1;
        }
    }

    /// Largest value.
    fn open(&self) -> f64 {
        self.values[..self.count].iter().fold(0.0, |most: f64, value| most.max(value.abs()))
    }

    /// δ of the module's head.
    fn least(&self, inverse_mass: f64, inverse_inertia: &DMat3) -> Vec6 {
        let n = self.count;
        let mut pushed = [[0.0; 6]; MAX_ROWS];
        for (pushed, block) in pushed[..n].iter_mut().zip(&self.blocks) {
            *pushed = vec6(inverse_mass * linear(block), *inverse_inertia * angular(block));
        }
        let mut k: RowSquare = [[0.0; MAX_ROWS]; MAX_ROWS];
        for i in 0..n {
            for j in 0..=i {
                k[i][j] = dot(&self.blocks[i], &pushed[j]);
            }
        }
        pseudo_inverse(&mut k, n);
        let mut delta = [0.0; 6];
        for (i, pushed) in pushed[..n].iter().enumerate() {
            let lambda: f64 = (0..n).map(|j| -k[i][j] * self.values[j]).sum();
            add_scaled(&mut delta, lambda, pushed);
        }
        delta
    }
}

impl Configuration<'_> {
    /// Moves a body by a displacement of its centre (m) and a rotation vector (rad).
    pub fn displace(&mut self, body: usize, displacement: DVec3, rotation: DVec3) {
        self.bodies[body].displace(displacement, rotation);
        self.frames[body] = matrix(self.bodies[body].rotation);
    }

    /// World inertia of a body, kg m².
    pub fn inertia(&self, body: usize) -> DMat3 {
        let frame = self.frames[body];
        frame * self.bodies[body].properties.inertia * frame.transpose()
    }

    fn scene(&self) -> BodyStates<'_> {
        BodyStates { bodies: self.bodies, frames: self.frames, time: self.system.activity.time() }
    }

    /// The body alone, as a group.
    pub fn alone(&self, body: usize) -> Group {
        let state = &self.bodies[body];
        Group { mass: state.properties.mass, center: state.position, inertia: self.inertia(body) }
    }

    /// Moves the point `at` of a body (m) by s with the rule, as the head of its group; it does not rotate about `fixed_axes`.
    pub fn pull(&mut self, body: usize, (at, s): (DVec3, DVec3), group: &Group, fixed_axes: &[DVec3]) {
        let without_fixed = |v: DVec3| fixed_axes.iter().fold(v, |v, axis| v - v.dot(*axis) * *axis);
        // A body that rotates about one axis alone takes the components across that axis.
        let free_axis = if let [e, f] = *fixed_axes { Some(e.cross(f)) } else { None };
        let across = |v: DVec3| free_axis.map_or(v, |axis| v - v.dot(axis) * axis);
        let r = at - group.center;
        let rotation_vector =
            two_body_rule::compulsive_rotation(across(r), across(s), self.control, &group.inertia, group.mass);
        let rotation_vector = without_fixed(rotation_vector);
        let rotation = matrix(soffio_math::rotation(rotation_vector));
        let arm = at - self.bodies[body].position;
        self.displace(body, two_body_rule::compulsive_translation(arm, s, &rotation), rotation_vector);
    }

    /// Closes a joint by moving the body `own`, the head of its group; `limits` are those between the joint's bodies.
    pub fn close(&mut self, joint: usize, own: usize, group: &Group, limits: &[usize]) {
        let system = self.system;
        let joint = &system.joints()[joint];
        let arm = self.bodies[own].position - group.center;
        let (mut fixed_axes, axes) = ([DVec3::ZERO; 3], self.close_orientations(joint, own, (group, arm)));
        let mut count = 0;
        for axis in axes {
            let mut axis = axis;
            for known in &fixed_axes[..count] {
                axis -= axis.dot(*known) * *known;
            }
            if let Some(axis) = axis.try_normalize().filter(|_| axis.length_squared() > 1e-6) {
                fixed_axes[count] = axis;
                count += 1;
            }
        }
        if let Some(pull) = self.first_pull(joint, own) {
            self.pull(own, pull, group, &fixed_axes[..count]);
        }
        let lone = limits.is_empty() && joint.constraints.len() == 1;
        if lone && matches!(system.constraints()[joint.constraints[0]].kind, ConstraintKind::PointToPoint { .. }) {
            return;
        }
        for _ in 0..MAX_NEWTON_STEPS {
            let mut rows = self.rows(joint, own, |_| true);
            for &bound in limits {
                let (gap, ends) = self.contacts.bound(bound, self.bodies);
                let block = ends.iter().flatten().find(|(body, _)| *body == own);
                if let Some((_, block)) = block.filter(|_| gap < -CLOSED) {
                    rows.push(block, gap);
                }
            }
            if !self.newton(own, (group, arm), rows) {
                break;
            }
        }
    }

    /// Rotates a body so that the joint's orientations close; returns their axes.
    fn close_orientations(&mut self, joint: &Joint, own: usize, group: (&Group, DVec3)) -> [DVec3; 3] {
        let angles = |kind: &ConstraintKind| matches!(kind, ConstraintKind::Orientation { .. });
        let mut axes = [DVec3::ZERO; 3];
        for _ in 0..MAX_NEWTON_STEPS {
            let rows = self.rows(joint, own, angles);
            for (axis, block) in axes.iter_mut().zip(&rows.blocks[..rows.count]) {
                *axis = angular(block);
            }
            if !self.newton(own, group, rows) {
                break;
            }
        }
        axes
    }

    /// One Newton step on the head of a group, whose centre lies at `arm` from the group's; false if all rows are closed.
    fn newton(&mut self, own: usize, (group, arm): (&Group, DVec3), mut rows: BodyRows) -> bool {
        if rows.open() <= CLOSED {
            return false;
        }
        // The blocks about the group's centre: a rotation moves the body's centre by ω × arm.
        for block in &mut rows.blocks[..rows.count] {
            *block = vec6(linear(block), angular(block) + arm.cross(linear(block)));
        }
        let delta = rows.least(1.0 / group.mass, &group.inertia.inverse());
        let (displacement, rotation) = (linear(&delta), angular(&delta));
        let shorter = (MAX_ROTATION / rotation.length()).min(1.0);
        let displacement = displacement + rotation.cross(arm);
        self.displace(own, shorter * displacement, shorter * rotation);
        true
    }

    /// Fully active constraints of a joint, each with the index of its first row.
    fn acting<'j>(&self, joint: &'j Joint) -> impl Iterator<Item = (usize, usize)> + use<'j, '_> {
        let system = self.system;
        let mut at = joint.at;
        joint.constraints.iter().filter_map(move |&index| {
            let activation = system.activity.activation(index);
            let first = at;
            at += if activation > 0.0 { system.constraints()[index].row_count() } else { 0 };
            (activation == 1.0).then_some((index, first))
        })
    }

    /// Fully active rows of a joint, of the wanted kinds, with their blocks on one body.
    fn rows(&self, joint: &Joint, own: usize, wanted: impl Fn(&ConstraintKind) -> bool) -> BodyRows {
        let (system, scene) = (self.system, self.scene());
        let mut rows = BodyRows::none();
        for (index, mut at) in self.acting(joint) {
            let constraint = &system.constraints()[index];
            if !wanted(&constraint.kind) {
                continue;
            }
            let first = constraint.link().is_some_and(|(a, _)| a == Some(own));
            let mut push = |row: &JacobianRow| {
                rows.push(if first { &row.a } else { &row.b }, row.value - self.targets[at]);
                at += 1;
            };
            match &constraint.kind {
                ConstraintKind::PointToPoint { a, b } => point::rows(&scene, a, b).iter().for_each(push),
                ConstraintKind::PointOnPlane { point, plane, normal, offset } => {
                    push(&plane::row(&scene, point, plane, *normal, offset));
                }
                ConstraintKind::Orientation { a, b, angle } => {
                    let fixed_axes = || {
                        let others = self.acting(joint).filter(|&(other, _)| other != index);
                        let axis = |(other, _): (usize, usize)| match &system.constraints()[other].kind {
                            ConstraintKind::Orientation { a, b, .. } => orientation::axis(&scene, a, b),
                            _ => None,
                        };
                        others.filter_map(axis).next()
                    };
                    push(&orientation::row(&scene, a, b, angle, fixed_axes));
                }
                ConstraintKind::Coupling { .. } => {}
            }
        }
        rows
    }

    /// Point of one of the joint's bodies at its first point or plane, m, and its displacement there, m.
    pub fn first_pull(&self, joint: &Joint, own: usize) -> Option<(DVec3, DVec3)> {
        let (system, scene) = (self.system, self.scene());
        let pull = |(index, at): (usize, usize)| match &system.constraints()[index].kind {
            ConstraintKind::PointToPoint { a, b } => {
                // C = a − b.
                let kept = DVec3::new(self.targets[at], self.targets[at + 1], self.targets[at + 2]);
                let (mine, other, kept): (&Anchor, &Anchor, DVec3) =
                    if a.body == Some(own) { (a, b, kept) } else { (b, a, -kept) };
                let at = scene.point(mine).position;
                Some((at, scene.point(other).position - at + kept))
            }
            ConstraintKind::PointOnPlane { point, plane, normal, offset } => {
                let row = plane::row(&scene, point, plane, *normal, offset);
                // The plane's body is pulled where the point is.
                let sign = if point.body == Some(own) { -1.0 } else { 1.0 };
                let displacement = sign * (row.value - self.targets[at]);
                Some((scene.point(point).position, displacement * linear(&row.a)))
            }
            _ => None,
        };
        self.acting(joint).find_map(pull)
    }

    /// Moves the bodies of one row by the displacement of least kinetic energy that changes its value by `change`.
    pub fn spread(&mut self, ends: impl Iterator<Item = (usize, Vec6)> + Clone, change: f64) {
        let system = self.system;
        let free = ends.filter(|(body, _)| !system.kinematic()[*body]);
        let pushed = |configuration: &Self, body: usize, block: &Vec6| {
            let inverse = configuration.inertia(body).inverse();
            (linear(block) / configuration.bodies[body].properties.mass, inverse * angular(block))
        };
        let effective_inverse_mass: f64 = free
            .clone()
            .map(|(body, block)| {
                let (displacement, rotation) = pushed(self, body, &block);
                displacement.dot(linear(&block)) + rotation.dot(angular(&block))
            })
            .sum();
        if effective_inverse_mass <= 0.0 {
            return;
        }
        let lambda = change / effective_inverse_mass;
        for (body, block) in free {
            let (displacement, rotation) = pushed(self, body, &block);
            self.displace(body, lambda * displacement, lambda * rotation);
        }
    }
}

//! One joint closed by moving one body, the other fixed: the source's rule first, then what it leaves open.
//!
//! The joint's rows may be any of the library's: points, planes, orientations, in any number. In this order
//!
//! 1. orientations: the least turn that closes them;
//! 2. the first point or plane: compulsive rotation, of which the orientations leave only what turns about none of the
//!    axes e that they hold (w − Σ (w·ê) ê), and compulsive translation; for a plane s = −C N;
//! 3. all rows together, and those limits of the pair that are passed (method 3.5: an angle beyond its limit is put back
//!    to it): Newton's steps on the body's six coordinates, least in its kinetic energy,
//!
//! ```text
//! K = J M⁻¹ Jᵀ        δ = −M⁻¹ Jᵀ K⁻¹ C
//! ```
//!
//! A joint of one point is exact after the second. Rows that repeat others count once (`block::pseudo_inverse`).

use super::rule::{self, Turning};
use crate::articulation::block::pseudo_inverse;
use crate::articulation::block::{MAX_ROWS, RowBlock, RowSquare, RowVec};
use crate::articulation::rows::{Row, Scene, orientation, plane, point};
use crate::articulation::{Anchor, ConstraintKind, Joint, System};
use crate::dynamics::Contacts;
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::matrix;
use soffio_math::spatial::{Vec6, add_scaled, angular, dot, linear, vec6};
use soffio_math::{DMat3, DVec3};

/// Rows nearer to closed than this are closed, m or rad.
const CLOSED: f64 = 1e-13;
/// Newton's steps for one joint at most. A joint that can be closed is so after three or four.
const MOST_STEPS: usize = 12;
/// Largest turn in one of them, rad: farther out a tangent says little.
const LONGEST_TURN: f64 = 0.7;

/// Bodies on their way to where the joints hold.
pub(super) struct Stage<'a> {
    pub bodies: &'a mut [RigidBody],
    /// Their rotations.
    pub frames: &'a mut [DMat3],
    pub system: &'a System,
    pub contacts: &'a Contacts,
    /// What each row may keep open, m or rad.
    pub left: &'a [f64],
}

/// Rows as one body sees them.
struct Rows {
    count: usize,
    blocks: RowBlock,
    values: RowVec,
}

impl Rows {
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

    /// δ of the file's head.
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

impl Stage<'_> {
    /// Moves a body by a displacement of its centre (m) and a rotation vector (rad).
    pub fn displace(&mut self, body: usize, way: DVec3, turn: DVec3) {
        self.bodies[body].displace(way, turn);
        self.frames[body] = matrix(self.bodies[body].rotation);
    }

    /// World inertia of a body, kg m².
    pub fn inertia(&self, body: usize) -> DMat3 {
        let frame = self.frames[body];
        frame * self.bodies[body].properties.inertia * frame.transpose()
    }

    fn scene(&self) -> Scene<'_> {
        Scene { bodies: self.bodies, frames: self.frames, time: self.system.activity.time() }
    }

    /// Brings the joint point of a body, at the arm r, along s by the rule; `held` are axes it may not turn about.
    pub fn pull(&mut self, body: usize, (r, s): (DVec3, DVec3), (turning, mass): (Turning, f64), held: &[DVec3]) {
        let mut turn = rule::turn(turning, r, s, &self.inertia(body), mass);
        for axis in held {
            turn -= turn.dot(*axis) * *axis;
        }
        let rotation = matrix(soffio_math::rotation(turn));
        self.displace(body, rule::compulsive_translation(r, s, &rotation), turn);
    }

    /// Closes a joint by moving the body `own`; `mass` is that of its group, `bounds` the limits between the two.
    pub fn close(&mut self, joint: usize, own: usize, (turning, mass): (Turning, f64), bounds: &[usize]) {
        let system = self.system;
        let joint = &system.joints()[joint];
        let (mut held, axes) = ([DVec3::ZERO; 3], self.turn_to(joint, own));
        let mut count = 0;
        for axis in axes {
            let mut axis = axis;
            for known in &held[..count] {
                axis -= axis.dot(*known) * *known;
            }
            if let Some(axis) = axis.try_normalize().filter(|_| axis.length_squared() > 1e-6) {
                held[count] = axis;
                count += 1;
            }
        }
        if let Some((r, s)) = self.first_pull(joint, own) {
            self.pull(own, (r, s), (turning, mass), &held[..count]);
        }
        let lone = bounds.is_empty() && joint.constraints.len() == 1;
        if lone && matches!(system.constraints()[joint.constraints[0]].kind, ConstraintKind::PointToPoint { .. }) {
            return;
        }
        for _ in 0..MOST_STEPS {
            let mut rows = self.rows(joint, own, |_| true);
            for &bound in bounds {
                let (gap, ends) = self.contacts.bound(bound, self.bodies);
                let block = ends.iter().flatten().find(|(body, _)| *body == own);
                if let Some((_, block)) = block.filter(|_| gap < -CLOSED) {
                    rows.push(block, gap);
                }
            }
            if !self.newton(own, &rows) {
                break;
            }
        }
    }

    /// Turns a body so that the orientations of a joint close; their axes then.
    fn turn_to(&mut self, joint: &Joint, own: usize) -> [DVec3; 3] {
        let angles = |kind: &ConstraintKind| matches!(kind, ConstraintKind::Orientation { .. });
        let mut axes = [DVec3::ZERO; 3];
        for _ in 0..MOST_STEPS {
            let rows = self.rows(joint, own, angles);
            for (axis, block) in axes.iter_mut().zip(&rows.blocks[..rows.count]) {
                *axis = angular(block);
            }
            if !self.newton(own, &rows) {
                break;
            }
        }
        axes
    }

    /// One step of Newton's on a body; false where nothing is open.
    fn newton(&mut self, own: usize, rows: &Rows) -> bool {
        if rows.open() <= CLOSED {
            return false;
        }
        let delta = rows.least(1.0 / self.bodies[own].properties.mass, &self.inertia(own).inverse());
        let (way, turn) = (linear(&delta), angular(&delta));
        let shorter = (LONGEST_TURN / turn.length()).min(1.0);
        self.displace(own, shorter * way, shorter * turn);
        true
    }

    /// The constraints of a joint that act, with the place of the first row of each; what acts in part is left alone.
    fn acting<'j>(&self, joint: &'j Joint) -> impl Iterator<Item = (usize, usize)> + use<'j, '_> {
        let system = self.system;
        let mut at = joint.at;
        joint.constraints.iter().filter_map(move |&index| {
            let share = system.activity.share(index);
            let first = at;
            at += if share > 0.0 { system.constraints()[index].row_count() } else { 0 };
            (share == 1.0).then_some((index, first))
        })
    }

    /// The acting rows of a joint as one of its bodies sees them, of some kinds.
    fn rows(&self, joint: &Joint, own: usize, wanted: impl Fn(&ConstraintKind) -> bool) -> Rows {
        let (system, scene) = (self.system, self.scene());
        let mut rows = Rows::none();
        for (index, mut at) in self.acting(joint) {
            let constraint = &system.constraints()[index];
            if !wanted(&constraint.kind) {
                continue;
            }
            let first = constraint.link().is_some_and(|(a, _)| a == Some(own));
            let mut push = |row: &Row| {
                rows.push(if first { &row.a } else { &row.b }, row.value - self.left[at]);
                at += 1;
            };
            match &constraint.kind {
                ConstraintKind::PointToPoint { a, b } => point::rows(&scene, a, b).iter().for_each(push),
                ConstraintKind::PointOnPlane { point, plane, normal, offset } => {
                    push(&plane::row(&scene, point, plane, *normal, offset));
                }
                ConstraintKind::Orientation { a, b, angle } => {
                    let held = || {
                        let others = self.acting(joint).filter(|&(other, _)| other != index);
                        let axis = |(other, _): (usize, usize)| match &system.constraints()[other].kind {
                            ConstraintKind::Orientation { a, b, .. } => orientation::axis(&scene, a, b),
                            _ => None,
                        };
                        others.filter_map(axis).next()
                    };
                    push(&orientation::row(&scene, a, b, angle, held));
                }
                ConstraintKind::Coupling { .. } => {}
            }
        }
        rows
    }

    /// Arm and way of the first point or plane of a joint, for one of its bodies.
    pub fn first_pull(&self, joint: &Joint, own: usize) -> Option<(DVec3, DVec3)> {
        let (system, scene) = (self.system, self.scene());
        let center = self.bodies[own].position;
        let pull = |(index, at): (usize, usize)| match &system.constraints()[index].kind {
            ConstraintKind::PointToPoint { a, b } => {
                // C = a − b.
                let kept = DVec3::new(self.left[at], self.left[at + 1], self.left[at + 2]);
                let (mine, other, kept): (&Anchor, &Anchor, DVec3) =
                    if a.body == Some(own) { (a, b, kept) } else { (b, a, -kept) };
                let at = scene.point(mine).position;
                Some((at - center, scene.point(other).position - at + kept))
            }
            ConstraintKind::PointOnPlane { point, plane, normal, offset } => {
                let row = plane::row(&scene, point, plane, *normal, offset);
                // The plane's body is pulled where the point is.
                let sign = if point.body == Some(own) { -1.0 } else { 1.0 };
                let way = sign * (row.value - self.left[at]);
                Some((scene.point(point).position - center, way * linear(&row.a)))
            }
            _ => None,
        };
        self.acting(joint).find_map(pull)
    }

    /// Moves the bodies of one row by the least that changes its value by `change`.
    pub fn spread(&mut self, ends: impl Iterator<Item = (usize, Vec6)> + Clone, change: f64) {
        let system = self.system;
        let free = ends.filter(|(body, _)| !system.driven()[*body]);
        let pushed = |stage: &Self, body: usize, block: &Vec6| {
            let inverse = stage.inertia(body).inverse();
            (linear(block) / stage.bodies[body].properties.mass, inverse * angular(block))
        };
        let answers: f64 = free
            .clone()
            .map(|(body, block)| {
                let (way, turn) = pushed(self, body, &block);
                way.dot(linear(&block)) + turn.dot(angular(&block))
            })
            .sum();
        if answers <= 0.0 {
            return;
        }
        let lambda = change / answers;
        for (body, block) in free {
            let (way, turn) = pushed(self, body, &block);
            self.displace(body, lambda * way, lambda * turn);
        }
    }
}

//! All constraints between one pair of bodies: their rows at a configuration, and the numbers of each row.

use std::collections::BTreeMap;

use crate::articulation::activity::Activity;
use crate::articulation::block::MAX_ROWS;
use crate::articulation::hang::Link;
use crate::articulation::loops::LoopRow;
use crate::articulation::rows::{Row, Scene, friction, orientation, plane, point};
use crate::articulation::tree::JointRows;
use crate::articulation::{Anchor, Constraint, ConstraintKind};
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_math::spatial::vec6;

/// Joints farther apart than this are drawn together by the stabiliser, not snapped by projection, m or rad.
pub(in crate::articulation) const PROJECTION_REACH: f64 = 1e-4;
/// Most held rows of a pair of bodies, twice over; three of friction may come after them.
const HELD: usize = MAX_ROWS - 3;

/// All constraints between one pair of bodies.
#[derive(Clone, Debug)]
pub struct Joint {
    /// The pair.
    pub link: Link,
    /// Indices of its constraints.
    pub constraints: Vec<usize>,
    /// Where its numbers begin in `g`, `lambda` and the other lists of rows.
    pub at: usize,
    /// Most rows that it can have.
    pub(super) capacity: usize,
    /// Rows at the last evaluation, friction included.
    pub rows: usize,
    /// Of those, rows that are held.
    pub hard: usize,
    /// Where it is one point: that point from the two bodies' centres of mass in their node axes (in the world for
    /// the world), m.
    pub(super) point: Option<(DVec3, DVec3)>,
    /// World arms of the two bodies where it is one point, hard, at the last evaluation; the tree has those of `hangs`.
    pub(super) arms: Option<(DVec3, DVec3)>,
    /// The body that hangs by it, where it is always one point.
    pub(super) hangs: Option<usize>,
    /// Its block rows, where it is ever more than a point.
    pub(super) block: Option<usize>,
    /// First of its rows among those outside the tree, where it is in a loop (or the solver is dense).
    pub(super) outside: Option<usize>,
    /// Is it a train's own?
    pub(super) in_train: bool,
}

/// Numbers of a row beside its blocks.
#[derive(Clone, Copy, Debug, Default)]
pub struct RowState {
    /// C, m or rad.
    pub value: f64,
    /// ḟ.
    pub(super) feed: f64,
    /// J̇ẋ − f̈.
    pub(in crate::articulation) bias: f64,
    /// Is C a length?
    pub(super) length: bool,
    /// Constraint that it belongs to.
    pub(in crate::articulation) constraint: usize,
    /// Share of the force that would hold it.
    pub(in crate::articulation) share: f64,
    /// Is it drawn together by the stabiliser: far from closed, or held in part only?
    pub(in crate::articulation) gathers: bool,
}

impl RowState {
    /// Takes over a row's numbers.
    #[inline(always)]
    pub(super) fn set(&mut self, row: &Row, constraint: usize, share: f64) {
        let gathers = self.gathers;
        let Row { value, feed, bias, length, .. } = *row;
        *self = Self { value, feed, bias, length, constraint, share, gathers };
    }
}

impl Joint {
    /// Fills this joint's rows for the scene.
    #[inline(always)]
    pub(super) fn evaluate(
        &mut self,
        scene: &Scene,
        constraints: &[Constraint],
        activity: &Activity,
        blocks: &mut [JointRows],
        states: &mut [RowState],
    ) {
        self.arms = None;
        if let (Some((p, q)), None) = (self.point, self.outside)
            && activity.share(self.constraints[0]) == 1.0
        {
            let a = &scene.bodies[self.link.a];
            let r = scene.frames[self.link.a] * p;
            let turn = a.angular_velocity.cross(r);
            let (mut c, mut bias) = (a.position + r, a.angular_velocity.cross(turn));
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
                (state.value, state.feed, state.bias) = (c[k], 0.0, bias[k]);
                (state.length, state.constraint, state.share) = (true, self.constraints[0], 1.0);
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
            let share = activity.share(index);
            if share <= 0.0 {
                continue;
            }
            let constraint = &constraints[index];
            let own = constraint.link().is_some_and(|(a, _)| a == Some(self.link.a));
            let mut push = |row: Row| {
                let k = rows.rows;
                if k == HELD {
                    // Six rows hold all there is to hold: more can only repeat.
                    return;
                }
                (rows.a[k], rows.b[k]) = if own { (row.a, row.b) } else { (row.b, row.a) };
                states[self.at + k].set(&row, index, share);
                rows.rows = k + 1;
            };
            match &constraint.kind {
                ConstraintKind::PointToPoint { a, b } => point::rows(scene, a, b).into_iter().for_each(&mut push),
                ConstraintKind::PointOnPlane { point, plane, normal, offset } => {
                    push(plane::row(scene, point, plane, *normal, offset));
                }
                ConstraintKind::Orientation { a, b, angle } => {
                    let others = || self.constraints.iter().filter(|&&c| c != index && activity.share(c) > 0.0);
                    let held = || others().find_map(|&c| orientation_axis(scene, &constraints[c]));
                    push(orientation::row(scene, a, b, angle, held));
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
                // It holds no place, and where it stands another row may have stood before.
                states[self.at + k] = RowState { constraint: index, share: 1.0, ..RowState::default() };
                rows.rows = k + 1;
            }
        }
        self.rows = rows.rows;
    }

    /// Copies the rows to where the dense solver reads them.
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

/// Groups constraints by the pair of bodies they connect; also how many numbers their rows need.
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
                hangs: None,
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

/// The axis about which an orientation holds its bodies.
fn orientation_axis(scene: &Scene, constraint: &Constraint) -> Option<DVec3> {
    match &constraint.kind {
        ConstraintKind::Orientation { a, b, .. } => orientation::axis(scene, a, b),
        _ => None,
    }
}

/// Both ends of a joint that is one point, as [`Joint::point`] has them.
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

/// Is it a point at all times, and nothing more?
pub(super) fn is_only_point(constraint: &Constraint) -> bool {
    matches!(constraint.kind, ConstraintKind::PointToPoint { .. })
        && constraint.schedule.is_always()
        && constraint.breaking.is_none()
        && constraint.friction.is_none()
}

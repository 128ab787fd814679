//! Construction of a system: splits joints between the tree, loops and gear trains, and places their rows.

use std::ops::Range;

use fearless_simd::Level;

use super::factor::Factor;
use super::joint::{Joint, RowState, is_only_point, joints, lone_point};
use super::rows::{Coupling, Rows};
use super::sleep_state::SleepState;
use super::{LinearSolver, System};
use crate::articulation::activity::Activity;
use crate::articulation::ball_joints::BallJoints;
use crate::articulation::dense::Dense;
use crate::articulation::lane_blocks::LaneBlocks;
use crate::articulation::loops::biconnected::{Component, Graph};
use crate::articulation::loops::{LoopRow, Loops, Span};
use crate::articulation::rows::coupling::Gauge;
use crate::articulation::topology::Link;
use crate::articulation::trains::{SolveKind, Trains};
use crate::articulation::tree::{JointRows, Tree};
use crate::articulation::{Constraint, ConstraintKind, DisjointSets};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::row_blocks::MAX_ROWS;
use soffio_math::{DMat3, DVec3};

impl System {
    pub(super) fn with(
        level: Level,
        bodies: &[RigidBody],
        kinematic: &[bool],
        constraints: &[Constraint],
        (method, trains): (LinearSolver, Trains),
    ) -> Self {
        let n = bodies.len();
        let (mut joints, count) = joints(constraints);
        let points = always_points(&joints, constraints, method);
        for joint in &mut joints {
            joint.in_train = joint.constraints.iter().all(|&constraint| trains.owns(constraint));
        }
        let links: Vec<Link> = joints.iter().map(|joint| joint.link).collect();
        let at: Vec<usize> = joints.iter().map(|joint| joint.at).collect();
        let train: Vec<Option<usize>> = (0..n).map(|body| trains.of(body)).collect();
        let graph = Graph { kinematic, train: &train };
        let components = components(&graph, &joints, constraints, &trains);
        let islands = islands(kinematic, constraints);
        let tree = Tree::new(level, &graph, &links, (&at, &points), components, &islands);
        let mut outside = Vec::new();
        let blocks = place_rows(&mut joints, (constraints, bodies), (&tree, &points), method, &mut outside);
        let (couplings, count) = couplings((constraints, bodies), &trains, count, &mut outside);
        for &body in tree.order() {
            if let Some(joint) = tree.joint_of(body).filter(|&joint| points[joint]) {
                joints[joint].ball_joint_body = Some(body);
            }
        }
        let ball_joints = BallJoints::new(&tree, |body| ends(&tree, &joints, body));
        let (loops, dense) = match method {
            LinearSolver::Sparse => (Loops::new(outside, &tree, &spans(&joints, &couplings), &trains), None),
            LinearSolver::Dense => (Loops::default(), Some(Dense::new(outside, kinematic))),
        };
        let lane_blocks = LaneBlocks::new(level, tree.block_bodies(), bodies);
        let rows = Rows::new((constraints, n), joints, couplings, (blocks, count), &trains);
        Self {
            activity: Activity::new(constraints),
            sleep_state: SleepState::new(n, constraints.len()),
            rows,
            factor: Factor { tree, ball_joints, loops, dense, trains, solve_kind: SolveKind::Impulse },
            lane_blocks,
            kinematic: kinematic.to_vec(),
            b: vec![[0.0; 6]; n],
            g: vec![0.0; count],
            a: vec![[0.0; 6]; n],
            lambda: vec![0.0; count],
        }
    }
}

impl Rows {
    /// Rows of joints and couplings with `count` numbers, for `n` bodies; not evaluated yet.
    fn new(
        (constraints, n): (&[Constraint], usize),
        mut joints: Vec<Joint>,
        couplings: Vec<Coupling>,
        (blocks, count): (Vec<JointRows>, usize),
        trains: &Trains,
    ) -> Self {
        let general_joints = (0..joints.len()).filter(|&joint| joints[joint].ball_joint_body.is_none());
        let (mut general_joints, of_trains): (Vec<usize>, Vec<usize>) =
            general_joints.partition(|&joint| !joints[joint].in_train);
        let outside_trains = general_joints.len();
        general_joints.extend(of_trains);
        let rows = |ball_joints: bool| {
            let joints =
                joints.iter().filter(move |joint| !joint.in_train && (ball_joints || joint.ball_joint_body.is_none()));
            let couplings = couplings.iter().filter(|c| !trains.owns(c.constraint)).map(|c| c.at..c.at + 1);
            merged(joints.map(|joint| joint.at..joint.at + joint.capacity).chain(couplings))
        };
        let (rows_without_trains, general_rows) = (rows(true), rows(false));
        let solve_kind = !(general_joints.is_empty() && couplings.is_empty());
        let is_lean = |constraint: usize| !trains.owns(constraint);
        let of_rows = |&body: &usize| {
            let acts_on = |constraint: &usize| constraints[*constraint].kind.acts_on(body);
            let joints = general_joints[..outside_trains].iter().flat_map(|&joint| &joints[joint].constraints);
            joints.chain(couplings.iter().map(|c| &c.constraint).filter(|c| is_lean(**c))).any(acts_on)
        };
        let framed = if solve_kind { (0..n).filter(of_rows).collect() } else { Vec::new() };
        let mut states = vec![RowState::default(); count];
        for joint in joints.iter_mut().filter(|joint| joint.ball_joint_body.is_some()) {
            (joint.rows, joint.hard) = (3, 3);
            for state in &mut states[joint.at..joint.at + 3] {
                (state.length, state.constraint, state.activation) = (true, joint.constraints[0], 1.0);
            }
        }
        Self {
            constraints: constraints.to_vec(),
            joints,
            general_joints,
            outside_trains,
            rows_without_trains,
            general_rows,
            couplings,
            blocks,
            states,
            frames: vec![DMat3::IDENTITY; if solve_kind { n } else { 0 }],
            framed,
            stabilising: false,
            values_valid: false,
        }
    }
}

/// Whether each joint is always a ball joint.
fn always_points(joints: &[Joint], constraints: &[Constraint], method: LinearSolver) -> Vec<bool> {
    let is_point = |joint: &Joint| match joint.constraints[..] {
        [only] => method == LinearSolver::Sparse && is_only_point(&constraints[only]),
        _ => false,
    };
    joints.iter().map(is_point).collect()
}

/// Sets of bodies connected by constraints.
fn islands(kinematic: &[bool], constraints: &[Constraint]) -> DisjointSets {
    let mut groups = DisjointSets::new(kinematic.len());
    for constraint in constraints {
        groups.join_all((0..kinematic.len()).filter(|&body| !kinematic[body] && constraint.kind.acts_on(body)));
    }
    groups
}

/// Biconnected components of the graph of joints and couplings, without the rows inside gear trains.
fn components(graph: &Graph, joints: &[Joint], constraints: &[Constraint], trains: &Trains) -> Vec<Component> {
    let links: Vec<Option<Link>> = joints.iter().map(|joint| (!joint.in_train).then_some(joint.link)).collect();
    let touched = |(index, constraint): (usize, &Constraint)| match &constraint.kind {
        ConstraintKind::Coupling { .. } if trains.owns(index) => Some(Vec::new()),
        ConstraintKind::Coupling { terms } => {
            Some(terms.iter().flat_map(|term| <[_; 2]>::from(term.measure.bodies())).collect())
        }
        _ => None,
    };
    let couplings: Vec<Vec<Option<usize>>> = constraints.iter().enumerate().filter_map(touched).collect();
    graph.components(&links, &couplings)
}

/// Rows outside the tree of each joint, then of each coupling.
fn spans(joints: &[Joint], couplings: &[Coupling]) -> Vec<Span> {
    let of_joint = |joint: &Joint| {
        joint.outside.map_or(Span::default(), |first| Span { first, count: joint.capacity, block: joint.block })
    };
    let of_couplings = couplings.iter().map(|coupling| Span { first: coupling.outside, count: 1, block: None });
    joints.iter().map(of_joint).chain(of_couplings).collect()
}

/// Places the rows of each joint: in a block of its own, and among those outside the tree. Returns the blocks.
fn place_rows(
    joints: &mut [Joint],
    (constraints, bodies): (&[Constraint], &[RigidBody]),
    (tree, points): (&Tree, &[bool]),
    method: LinearSolver,
    outside: &mut Vec<LoopRow>,
) -> Vec<JointRows> {
    let mut blocks = Vec::new();
    for (index, joint) in joints.iter_mut().enumerate() {
        joint.point = lone_point(joint, constraints, bodies);
        let closes = !tree.is_bridge(index) && !joint.in_train;
        if closes || method == LinearSolver::Dense {
            joint.outside = Some(outside.len());
            let parts: Vec<_> = [Some(joint.link.a), joint.link.b].into_iter().flatten().collect();
            for k in 0..joint.capacity {
                outside.push(blank_row(joint.at + k, k, &parts, false));
            }
        }
        if !points[index] || closes {
            joint.block = Some(blocks.len());
            blocks.push(JointRows::default());
        }
    }
    blocks
}

/// Couplings with their numbers from `count` on; also returns the new count.
fn couplings(
    (constraints, bodies): (&[Constraint], &[RigidBody]),
    trains: &Trains,
    mut count: usize,
    outside: &mut Vec<LoopRow>,
) -> (Vec<Coupling>, usize) {
    let mut couplings = Vec::new();
    for (index, constraint) in constraints.iter().enumerate() {
        let ConstraintKind::Coupling { terms } = &constraint.kind else { continue };
        let terms: Vec<_> = terms.iter().map(|t| (Gauge::new(t.measure, bodies), t.coefficient)).collect();
        let mut parts: Vec<usize> = Vec::new();
        for body in terms.iter().flat_map(|(gauge, _)| [gauge.bodies().0, gauge.bodies().1]).flatten() {
            if !parts.contains(&body) {
                parts.push(body);
            }
        }
        couplings.push(Coupling { constraint: index, at: count, terms, offset: 0.0, outside: outside.len() });
        outside.push(blank_row(count, 0, &parts, trains.owns(index)));
        count += 1;
    }
    (couplings, count)
}

/// Ball joint of a body, if it is always one: its index, and its points on the body and on the parent.
fn ends(tree: &Tree, joints: &[Joint], body: usize) -> Option<(usize, (DVec3, DVec3))> {
    let index = tree.joint_of(body).filter(|&joint| joints[joint].ball_joint_body == Some(body))?;
    let joint = &joints[index];
    joint.point.map(|(a, b)| (index, if joint.link.a == body { (a, b) } else { (b, a) }))
}

/// Merges adjacent ranges.
fn merged(ranges: impl Iterator<Item = Range<usize>>) -> Vec<Range<usize>> {
    let mut out: Vec<Range<usize>> = Vec::new();
    for range in ranges {
        match out.last_mut() {
            Some(last) if last.end == range.start => last.end = range.end,
            _ => out.push(range),
        }
    }
    out
}

fn blank_row(at: usize, place: usize, bodies: &[usize], train_internal: bool) -> LoopRow {
    let parts = bodies.iter().map(|&body| (body, [0.0; 6])).collect();
    LoopRow { at, active: false, parts, place, compliance: [0.0; MAX_ROWS], train_internal }
}

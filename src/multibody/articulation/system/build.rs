//! The figure at its start: which joints there are, which of them are the tree's, a loop's or a train's, where their rows lie.

use std::ops::Range;

use fearless_simd::Level;

use super::factor::Factor;
use super::joint::{Joint, RowState, is_only_point, joints, lone_point};
use super::rows::{Coupling, Rows};
use super::sleepers::Sleepers;
use super::{Method, System};
use crate::articulation::activity::Activity;
use crate::articulation::block::MAX_ROWS;
use crate::articulation::dense::Dense;
use crate::articulation::hang::Link;
use crate::articulation::hung::Hung;
use crate::articulation::loops::graph::{Component, Graph};
use crate::articulation::loops::{LoopRow, Loops, Span};
use crate::articulation::quads::Quads;
use crate::articulation::rows::coupling::Gauge;
use crate::articulation::trains::{Asked, Trains};
use crate::articulation::tree::{JointRows, Tree};
use crate::articulation::{Constraint, ConstraintKind, Groups};
use soffio_geometry::bodies::RigidBody;
use soffio_math::{DMat3, DVec3};

impl System {
    pub(super) fn with(
        level: Level,
        bodies: &[RigidBody],
        driven: &[bool],
        constraints: &[Constraint],
        (method, trains): (Method, Trains),
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
        let graph = Graph { driven, train: &train };
        let components = components(&graph, &joints, constraints, &trains);
        let islands = islands(driven, constraints);
        let tree = Tree::new(level, &graph, &links, (&at, &points), components, &islands);
        let mut outside = Vec::new();
        let blocks = place_rows(&mut joints, (constraints, bodies), (&tree, &points), method, &mut outside);
        let (couplings, count) = couplings((constraints, bodies), &trains, count, &mut outside);
        for &body in tree.order() {
            if let Some(joint) = tree.joint_of(body).filter(|&joint| points[joint]) {
                joints[joint].hangs = Some(body);
            }
        }
        let hung = Hung::new(&tree, |body| ends(&tree, &joints, body));
        let (loops, dense) = match method {
            Method::Sparse => (Loops::new(outside, &tree, &spans(&joints, &couplings), &trains), None),
            Method::Dense => (Loops::default(), Some(Dense::new(outside, driven))),
        };
        let quads = Quads::new(level, tree.members(), bodies);
        let rows = Rows::new((constraints, n), joints, couplings, (blocks, count), &trains);
        Self {
            activity: Activity::new(constraints),
            sleepers: Sleepers::new(n, constraints.len()),
            rows,
            factor: Factor { tree, hung, loops, dense, trains, asked: Asked::Impulse },
            quads,
            driven: driven.to_vec(),
            b: vec![[0.0; 6]; n],
            g: vec![0.0; count],
            a: vec![[0.0; 6]; n],
            lambda: vec![0.0; count],
        }
    }
}

impl Rows {
    /// Those of so many numbers, of a figure of `n` bodies; not evaluated yet.
    fn new(
        (constraints, n): (&[Constraint], usize),
        mut joints: Vec<Joint>,
        couplings: Vec<Coupling>,
        (blocks, count): (Vec<JointRows>, usize),
        trains: &Trains,
    ) -> Self {
        let various = (0..joints.len()).filter(|&joint| joints[joint].hangs.is_none());
        let (mut various, of_trains): (Vec<usize>, Vec<usize>) = various.partition(|&joint| !joints[joint].in_train);
        let outside_trains = various.len();
        various.extend(of_trains);
        let rows = |hung: bool| {
            let joints = joints.iter().filter(move |joint| !joint.in_train && (hung || joint.hangs.is_none()));
            let couplings = couplings.iter().filter(|c| !trains.owns(c.constraint)).map(|c| c.at..c.at + 1);
            merged(joints.map(|joint| joint.at..joint.at + joint.capacity).chain(couplings))
        };
        let (lean, aside) = (rows(true), rows(false));
        let asked = !(various.is_empty() && couplings.is_empty());
        let is_lean = |constraint: usize| !trains.owns(constraint);
        let of_rows = |&body: &usize| {
            let touches = |constraint: &usize| constraints[*constraint].kind.touches(body);
            let joints = various[..outside_trains].iter().flat_map(|&joint| &joints[joint].constraints);
            joints.chain(couplings.iter().map(|c| &c.constraint).filter(|c| is_lean(**c))).any(touches)
        };
        let framed = if asked { (0..n).filter(of_rows).collect() } else { Vec::new() };
        let mut states = vec![RowState::default(); count];
        for joint in joints.iter_mut().filter(|joint| joint.hangs.is_some()) {
            (joint.rows, joint.hard) = (3, 3);
            for state in &mut states[joint.at..joint.at + 3] {
                (state.length, state.constraint, state.share) = (true, joint.constraints[0], 1.0);
            }
        }
        Self {
            constraints: constraints.to_vec(),
            joints,
            various,
            outside_trains,
            lean,
            aside,
            couplings,
            blocks,
            states,
            frames: vec![DMat3::IDENTITY; if asked { n } else { 0 }],
            framed,
            gathering: false,
            told: false,
        }
    }
}

/// Which joints are never anything but a point.
fn always_points(joints: &[Joint], constraints: &[Constraint], method: Method) -> Vec<bool> {
    let is_point = |joint: &Joint| match joint.constraints[..] {
        [only] => method == Method::Sparse && is_only_point(&constraints[only]),
        _ => false,
    };
    joints.iter().map(is_point).collect()
}

/// Bodies that constraints put together.
fn islands(driven: &[bool], constraints: &[Constraint]) -> Groups {
    let mut groups = Groups::new(driven.len());
    for constraint in constraints {
        groups.join_all((0..driven.len()).filter(|&body| !driven[body] && constraint.kind.touches(body)));
    }
    groups
}

/// The components of the graph of joints and couplings, without what trains hold themselves.
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

/// Which rows outside the tree are each joint's, then each coupling's.
fn spans(joints: &[Joint], couplings: &[Coupling]) -> Vec<Span> {
    let of_joint = |joint: &Joint| {
        joint.outside.map_or(Span::default(), |first| Span { first, count: joint.capacity, block: joint.block })
    };
    let of_couplings = couplings.iter().map(|coupling| Span { first: coupling.outside, count: 1, block: None });
    joints.iter().map(of_joint).chain(of_couplings).collect()
}

/// Says where the rows of each joint are: in a block of its own, and among those outside the tree. Returns the blocks.
fn place_rows(
    joints: &mut [Joint],
    (constraints, bodies): (&[Constraint], &[RigidBody]),
    (tree, points): (&Tree, &[bool]),
    method: Method,
    outside: &mut Vec<LoopRow>,
) -> Vec<JointRows> {
    let mut blocks = Vec::new();
    for (index, joint) in joints.iter_mut().enumerate() {
        joint.point = lone_point(joint, constraints, bodies);
        let closes = !tree.is_bridge(index) && !joint.in_train;
        if closes || method == Method::Dense {
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

/// The constraints that couple turns and ways, their numbers from `count` on; returns also how many numbers there are then.
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

/// The joint by which a body hangs, where it is one point always, and both ends of it: the body's and its parent's.
fn ends(tree: &Tree, joints: &[Joint], body: usize) -> Option<(usize, (DVec3, DVec3))> {
    let index = tree.joint_of(body).filter(|&joint| joints[joint].hangs == Some(body))?;
    let joint = &joints[index];
    joint.point.map(|(a, b)| (index, if joint.link.a == body { (a, b) } else { (b, a) }))
}

/// Ranges that follow each other as one.
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

fn blank_row(at: usize, place: usize, bodies: &[usize], held: bool) -> LoopRow {
    let parts = bodies.iter().map(|&body| (body, [0.0; 6])).collect();
    LoopRow { at, active: false, parts, place, compliance: [0.0; MAX_ROWS], held }
}

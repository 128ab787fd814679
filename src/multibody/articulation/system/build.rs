//! The figure at its start: which joints there are, which of them are the tree's, a loop's or a train's, where their rows lie.

use std::ops::Range;

use fearless_simd::Level;

use super::couplings::Coupling;
use super::joint::{RowState, is_only_point, joints, lone_point};
use super::{Method, System};
use crate::articulation::activity::Activity;
use crate::articulation::block::MAX_ROWS;
use crate::articulation::dense::Dense;
use crate::articulation::hung::Hung;
use crate::articulation::loops::{LoopRow, Loops};
use crate::articulation::quads::Quads;
use crate::articulation::rows::coupling::Gauge;
use crate::articulation::trains::{Asked, Trains};
use crate::articulation::tree::{JointRows, Link, Tree};
use crate::articulation::{Constraint, ConstraintKind, Groups};
use soffio_geometry::bodies::RigidBody;
use soffio_math::DMat3;

impl System {
    pub(super) fn with(
        level: Level,
        bodies: &[RigidBody],
        driven: &[bool],
        constraints: &[Constraint],
        (method, trains): (Method, Trains),
    ) -> Self {
        let (mut joints, mut count) = joints(constraints);
        let links: Vec<Link> = joints.iter().map(|joint| joint.link).collect();
        let at: Vec<usize> = joints.iter().map(|joint| joint.at).collect();
        let points: Vec<bool> = joints
            .iter()
            .map(|joint| method == Method::Sparse && joint.constraints.iter().all(|&c| is_only_point(&constraints[c])))
            .zip(&joints)
            .map(|(all, joint)| all && joint.constraints.len() == 1)
            .collect();
        for joint in &mut joints {
            joint.in_train = joint.constraints.iter().all(|&constraint| trains.owns(constraint));
        }
        // To the tree a train is ground that moves.
        let given: Vec<bool> = (0..bodies.len()).map(|body| driven[body] || trains.has(body)).collect();
        let mut groups = Groups::new(bodies.len());
        for constraint in constraints {
            groups.join_all((0..bodies.len()).filter(|&body| !driven[body] && constraint.kind.touches(body)));
        }
        let tree = Tree::new(level, &given, &links, (&at, &points), &groups);
        let mut blocks = Vec::new();
        let mut outside: Vec<LoopRow> = Vec::new();
        for (index, joint) in joints.iter_mut().enumerate() {
            joint.point = lone_point(joint, constraints, bodies);
            let closes = tree.loops().contains(&index) && !joint.in_train;
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
        let (loop_rows, dense) = match method {
            Method::Sparse => (outside, None),
            Method::Dense => (Vec::new(), Some(Dense::new(outside, driven))),
        };
        let n = bodies.len();
        for &body in tree.order() {
            if let Some(joint) = tree.joint_of(body).filter(|&joint| points[joint] && !given[body]) {
                joints[joint].hangs = Some(body);
            }
        }
        let ends = |body: usize| {
            let joint = tree.joint_of(body).map(|joint| &joints[joint]).filter(|joint| joint.hangs == Some(body))?;
            joint.point.map(|(a, b)| if joint.link.a == body { (a, b) } else { (b, a) })
        };
        let hung = Hung::new(&tree, ends);
        let various = (0..joints.len()).filter(|&joint| joints[joint].hangs.is_none());
        let (mut various, of_trains): (Vec<usize>, Vec<usize>) = various.partition(|&joint| !joints[joint].in_train);
        let outside_trains = various.len();
        various.extend(of_trains);
        let of_joints = joints.iter().filter(|joint| !joint.in_train).map(|joint| joint.at..joint.at + joint.capacity);
        let of_couplings = couplings.iter().filter(|c| !trains.owns(c.constraint)).map(|c| c.at..c.at + 1);
        let rows = merged(of_joints.chain(of_couplings));
        let numbers = |joint: usize| joints[joint].at..joints[joint].at + joints[joint].capacity;
        let loops = Loops::new(loop_rows, (&tree, &trains), driven, (count, numbers));
        let asked = !(various.is_empty() && couplings.is_empty());
        let lean = |constraint: usize| !trains.owns(constraint);
        let of_rows = |&body: &usize| {
            let touches = |constraint: &usize| constraints[*constraint].kind.touches(body);
            let joints = various[..outside_trains].iter().flat_map(|&joint| &joints[joint].constraints);
            joints.chain(couplings.iter().map(|c| &c.constraint).filter(|c| lean(**c))).any(touches)
        };
        let framed = if asked { (0..bodies.len()).filter(of_rows).collect() } else { Vec::new() };
        let mut states = vec![RowState::default(); count];
        for joint in joints.iter_mut().filter(|joint| joint.hangs.is_some()) {
            (joint.rows, joint.hard) = (3, 3);
            for state in &mut states[joint.at..joint.at + 3] {
                (state.length, state.constraint, state.share) = (true, joint.constraints[0], 1.0);
            }
        }
        Self {
            gathering: false,
            activity: Activity::new(constraints),
            loops,
            outside_trains,
            rows,
            trains,
            asked: Asked::Impulse,
            constraints: constraints.to_vec(),
            joints,
            couplings,
            blocks,
            states,
            quads: Quads::new(level, tree.members(), bodies),
            tree,
            hung,
            told: false,
            whole: true,
            various,
            dense,
            frames: vec![DMat3::IDENTITY; if asked { n } else { 0 }],
            framed,
            driven: driven.to_vec(),
            asleep: vec![false; n],
            still: Vec::with_capacity(n),
            idle: vec![false; constraints.len()],
            asleep_gap: 0.0,
            lent: vec![DMat3::IDENTITY; n],
            b: vec![[0.0; 6]; n],
            g: vec![0.0; count],
            a: vec![[0.0; 6]; n],
            lambda: vec![0.0; count],
        }
    }
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
    LoopRow { at, active: false, parts, place, compliance: [0.0; MAX_ROWS], held, alone: 0.0 }
}

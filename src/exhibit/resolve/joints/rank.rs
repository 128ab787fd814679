//! Rank of the constraint Jacobian: finds redundant and contradictory rows.
//!
//! A row of J acts on the twists (v at one common point c, ω) of the freely moving bodies. Kinematic bodies and the
//! world are on the right side of J v = r, with r the rate that the row requires. Lengths are in units of the
//! mechanism's size L, so that v/L is comparable with ω.
//!
//! The rows are orthogonalised one by one (Gram–Schmidt, twice). A row without a remainder is redundant; where the same
//! combination of the rates r has a remainder at some time, it is contradictory. Joints of a tree are tested one by
//! one; only loops are tested together.
//!
//! Rows that act at different times are tested separately, for each set that acts at once.

use super::super::super::codes;
use super::super::super::diagnostic::Diagnostic;
use super::super::context::Context;
use soffio_math::{DVec3, cos};
use soffio_multibody::articulation::{Anchor, Constraint, ConstraintKind, Measure};
use soffio_multibody::dynamics::KinematicBody;

/// Sine of the angle below which a row is in the span of the others: single-precision files give 10⁻⁷.
const DEPENDENT: f64 = 1e-6;
/// Largest relative difference of equal rates.
const SAME_RATE: f64 = 1e-4;
/// Most rows of a loop that are tested: the cost grows with the cube.
const MAX_ROWS: usize = 600;
/// Times at which rates are compared, s: enough to distinguish any two functions.
const TIMES: [f64; 8] = [0.0, 0.31, 0.83, 1.37, 2.29, 3.71, 5.93, 9.61];

/// A row: blocks of the freely moving bodies, and its rate r at [`TIMES`].
struct ConstraintRow {
    constraint: usize,
    blocks: Vec<(usize, [DVec3; 2])>,
    rates: [f64; TIMES.len()],
}

/// A problem of a row.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Finding {
    Redundant,
    Contradicts,
}

impl Context<'_> {
    /// Warns of redundant rows and reports contradictory ones.
    pub(in super::super) fn check_rank(&mut self, constraints: &[Constraint], drives: &[KinematicBody]) {
        let mut reported: Vec<Vec<usize>> = Vec::new();
        for active in active_sets(constraints) {
            let rows = self.rows(constraints, &active, drives);
            for component in components(&rows, self.body_nodes.len()) {
                let members: Vec<&ConstraintRow> = component.iter().map(|&i| &rows[i]).collect();
                let found = dependent(&members);
                let mut key: Vec<usize> = found.iter().map(|&(row, _)| members[row].constraint).collect();
                key.dedup();
                if found.is_empty() || reported.contains(&key) {
                    continue;
                }
                self.report_dependent_rows(constraints, &members, &found);
                reported.push(key);
            }
        }
    }

    fn report_dependent_rows(
        &mut self,
        constraints: &[Constraint],
        members: &[&ConstraintRow],
        found: &[(usize, Finding)],
    ) {
        let names = |wanted: Finding| {
            let mut names: Vec<(&str, usize)> = Vec::new();
            for &(row, _) in found.iter().filter(|(_, finding)| *finding == wanted) {
                let name = constraints[members[row].constraint].name.as_str();
                match names.last_mut() {
                    Some((last, count)) if *last == name => *count += 1,
                    _ => names.push((name, 1)),
                }
            }
            names
        };
        let shown = |(name, count): &(&str, usize)| match count {
            1 => format!("\"{name}\""),
            n => format!("\"{name}\" ({n} rows)"),
        };
        let others = |without: &[(&str, usize)]| {
            let mut names: Vec<&str> = members.iter().map(|row| constraints[row.constraint].name.as_str()).collect();
            names.dedup();
            names.retain(|name| !without.iter().any(|(other, _)| other == name));
            names.join(", ")
        };
        for (finding, code, what, help) in [
            (
                Finding::Contradicts,
                codes::CONTRADICTORY,
                ["contradicts other constraints", "contradict other constraints"],
                "two constraints prescribe different motions of the same freedom: remove one, or give both the same motion",
            ),
            (
                Finding::Redundant,
                codes::REDUNDANT,
                [
                    "is redundant: other constraints already do the same",
                    "are redundant: other constraints already do the same",
                ],
                "the solver leaves such rows out; a universal instead of a hinge, or a line instead of a slider, closes \
                 a ring without them",
            ),
        ] {
            let names = names(finding);
            let Some((first, _)) = names.first() else { continue };
            let list = names.iter().map(shown).collect::<Vec<_>>().join(", ");
            let label = format!("together with: {}", others(&names));
            let place = self.place(first);
            let what = what[usize::from(names.len() > 1)];
            self.report(&place, Diagnostic::new(code, format!("{list} {what}")).label(label).help(help));
        }
    }

    /// The rows of the active constraints, at the poses of the model.
    fn rows(&self, constraints: &[Constraint], active: &[usize], drives: &[KinematicBody]) -> Vec<ConstraintRow> {
        let moving = |body: Option<usize>| body.filter(|&b| drives.iter().any(|drive| drive.body == b));
        let points: Vec<DVec3> = self.poses.iter().map(|pose| pose.position).collect();
        let center = points.iter().sum::<DVec3>() / points.len().max(1) as f64;
        let size = points.iter().map(|p| p.distance(center)).fold(0.0, f64::max);
        let size = if size > 0.0 { size } else { 1.0 };
        let mut rows = Vec::new();
        for &index in active {
            // Each side: body, force direction, moment; and the rate of the constraint itself.
            let mut push = |sides: &[(Option<usize>, DVec3, DVec3)], own: &dyn Fn(f64) -> f64| {
                let mut row = ConstraintRow { constraint: index, blocks: Vec::new(), rates: TIMES.map(own) };
                for &(body, force, moment) in sides {
                    if let Some(kinematic_body) = moving(body) {
                        for (rate, t) in row.rates.iter_mut().zip(TIMES) {
                            *rate -= kinematic_rate(drives, kinematic_body, t, center, force, moment);
                        }
                    } else if let Some(body) = body {
                        let block = [force, moment / size];
                        match row.blocks.iter_mut().find(|(other, _)| *other == body) {
                            Some((_, sum)) => *sum = [sum[0] + block[0], sum[1] + block[1]],
                            None => row.blocks.push((body, block)),
                        }
                    }
                }
                rows.push(row);
            };
            let arm = |anchor: &Anchor| self.reference_position(anchor) - center;
            match &constraints[index].kind {
                ConstraintKind::PointToPoint { a, b } => {
                    for e in DVec3::AXES {
                        let moment = arm(a).cross(e);
                        push(&[(a.body, e, moment), (b.body, -e, -moment)], &|_| 0.0);
                    }
                }
                ConstraintKind::PointOnPlane { point, plane, normal, offset } => {
                    let n = self.pose_of(plane.body).vector(*normal);
                    let moment = arm(point).cross(n);
                    push(&[(point.body, n, moment), (plane.body, -n, -moment)], &|t| offset.at(t).rate);
                }
                ConstraintKind::Orientation { a, b, angle } => {
                    let (t, n) = (self.pose_of(a.body).vector(a.direction), self.pose_of(b.body).vector(b.direction));
                    let j = t.cross(n);
                    let rate = |t: f64| cos(angle.at(t).value) * angle.at(t).rate;
                    push(&[(a.body, DVec3::ZERO, j), (b.body, DVec3::ZERO, -j)], &rate);
                }
                ConstraintKind::Coupling { terms } => {
                    let mut sides = Vec::new();
                    for term in terms {
                        let (body, against, force, moment) = match &term.measure {
                            Measure::Angle { axis, frame } => {
                                let n = self.pose_of(axis.body).vector(axis.direction);
                                (axis.body, *frame, DVec3::ZERO, n)
                            }
                            Measure::Displacement { point, direction } => {
                                let u = self.pose_of(direction.body).vector(direction.direction);
                                (point.body, direction.body, u, arm(point).cross(u))
                            }
                        };
                        let c = term.coefficient;
                        sides.extend([(body, c * force, c * moment), (against, -c * force, -c * moment)]);
                    }
                    push(&sides, &|_| 0.0);
                }
            }
        }
        rows
    }
}

/// J v of a kinematic body at a time.
fn kinematic_rate(drives: &[KinematicBody], body: usize, t: f64, center: DVec3, force: DVec3, moment: DVec3) -> f64 {
    let Some(drive) = drives.iter().find(|drive| drive.body == body) else { return 0.0 };
    let now = drive.motion.at(t);
    let at_center = now.velocity + now.angular_velocity.cross(center - now.pose.position);
    force.dot(at_center) + moment.dot(now.angular_velocity)
}

/// The sets of constraints that are fully active at the same time.
fn active_sets(constraints: &[Constraint]) -> Vec<Vec<usize>> {
    let mut times = vec![0.0];
    for schedule in constraints.iter().map(|c| &c.schedule) {
        // Just after each window is fully active.
        times.extend(schedule.windows.iter().map(|w| w.start.max(0.0) + schedule.ramp_in));
    }
    times.sort_by(f64::total_cmp);
    times.dedup();
    let mut sets: Vec<Vec<usize>> = Vec::new();
    for t in times {
        // A trigger can come at any time: such a constraint counts as active in its windows.
        let full = |c: &Constraint| c.schedule.activation(t, c.schedule.trigger.map(|_| 0.0)) >= 1.0;
        let set: Vec<usize> = (0..constraints.len()).filter(|&i| full(&constraints[i])).collect();
        if !sets.contains(&set) {
            sets.push(set);
        }
    }
    sets
}

/// Rows that must be tested together: those of one joint of a tree, and those of the loops.
fn components(rows: &[ConstraintRow], bodies: usize) -> Vec<Vec<usize>> {
    let mut edges: Vec<(Vec<usize>, Vec<usize>)> = Vec::new();
    for (i, row) in rows.iter().enumerate() {
        let mut ends: Vec<usize> = row.blocks.iter().map(|(body, _)| *body).collect();
        ends.sort_unstable();
        match edges.iter_mut().find(|(other, _)| *other == ends) {
            Some((_, members)) => members.push(i),
            None => edges.push((ends, vec![i])),
        }
    }
    let mut out = Vec::new();
    // A body with one joint left is a leaf: its joint is tested alone and removed.
    loop {
        let mut joints = vec![0_usize; bodies];
        edges.iter().flat_map(|(ends, _)| ends).for_each(|&body| joints[body] += 1);
        let leaf = edges.iter().position(|(ends, _)| ends.iter().any(|&body| joints[body] == 1));
        match leaf {
            Some(edge) => out.push(edges.remove(edge).1),
            None => break,
        }
    }
    // Loops without a common body are tested separately.
    while let Some((mut ends, mut members)) = edges.pop() {
        while let Some(next) = edges.iter().position(|(other, _)| other.iter().any(|body| ends.contains(body))) {
            let (more, rows) = edges.remove(next);
            ends.extend(more);
            members.extend(rows);
        }
        members.sort_unstable();
        if members.len() <= MAX_ROWS {
            out.push(members);
        }
    }
    out
}

/// The rows that depend on earlier ones.
fn dependent(rows: &[&ConstraintRow]) -> Vec<(usize, Finding)> {
    let mut bodies: Vec<usize> = rows.iter().flat_map(|row| row.blocks.iter().map(|(body, _)| *body)).collect();
    bodies.sort_unstable();
    bodies.dedup();
    let columns = 6 * bodies.len();
    // Each basis vector carries its rates behind its own components.
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut found = Vec::new();
    for (index, row) in rows.iter().enumerate() {
        let mut line = vec![0.0; columns + TIMES.len()];
        for (body, [force, moment]) in &row.blocks {
            let at = 6 * bodies.partition_point(|other| other < body);
            line[at..at + 3].copy_from_slice(&force.to_array());
            line[at + 3..at + 6].copy_from_slice(&moment.to_array());
        }
        line[columns..].copy_from_slice(&row.rates);
        let dot = |u: &[f64], v: &[f64]| u[..columns].iter().zip(&v[..columns]).map(|(a, b)| a * b).sum::<f64>();
        let size = dot(&line, &line).sqrt();
        let fastest = row.rates.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
        for _ in 0..2 {
            for e in &basis {
                let along = dot(&line, e);
                line.iter_mut().zip(e).for_each(|(x, e)| *x -= along * e);
            }
        }
        let left = dot(&line, &line).sqrt();
        if left > DEPENDENT * size {
            line.iter_mut().for_each(|x| *x /= left);
            basis.push(line);
            continue;
        }
        let strife = line[columns..].iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
        let finding = if strife > SAME_RATE * fastest.max(1e-3) { Finding::Contradicts } else { Finding::Redundant };
        found.push((index, finding));
    }
    found
}

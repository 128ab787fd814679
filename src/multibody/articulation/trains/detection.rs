//! Detection of gear trains: bodies with one DOF, and the ratios in which couplings tie them.

use super::{Freedom, Train, Trains, Wheel};
use crate::articulation::{Anchor, Axis, Constraint, ConstraintKind, Measure, Term};
use soffio_geometry::bodies::RigidBody;
use soffio_math::Function;
use soffio_math::spatial::{angular, linear};
use soffio_math::{DMat3, DVec3, Pose};

/// Directions that differ by less than this are one, rad.
const SAME: f64 = 1e-9;
/// Points that differ by less than this are one, m.
const CLOSED: f64 = 1e-6;

impl Trains {
    /// The trains among bodies that stand like this, where there is any coupling.
    pub fn new(bodies: &[RigidBody], kinematic: &[bool], constraints: &[Constraint]) -> Self {
        let none = Self { own: vec![false; constraints.len()], ..Self::default() };
        if !constraints.iter().any(|c| matches!(c.kind, ConstraintKind::Coupling { .. })) {
            return none;
        }
        let holds = |body: usize| -> Vec<usize> {
            let of = |c: &Constraint| match c.link() {
                Some((Some(a), None)) => a == body,
                Some((None, Some(b))) => b == body,
                _ => false,
            };
            (0..constraints.len()).filter(|&c| of(&constraints[c])).collect()
        };
        let grounded: Vec<bool> = (0..bodies.len()).map(|body| kinematic[body] || !holds(body).is_empty()).collect();
        // Whatever else is joined to it must not hang on it.
        let carries = |body: usize| {
            constraints.iter().filter_map(Constraint::link).any(|link| match link {
                (Some(a), Some(b)) if a == body => !grounded[b],
                (Some(a), Some(b)) if b == body => !grounded[a],
                _ => false,
            })
        };
        let free: Vec<Option<Freedom>> = (0..bodies.len())
            .map(|body| {
                let constraints_of_body = holds(body);
                let plain = constraints_of_body.iter().all(|&c| always(&constraints[c]));
                if kinematic[body] || !plain || carries(body) {
                    None
                } else {
                    freedom(body, &constraints_of_body, bodies, constraints)
                }
            })
            .collect();
        let geared = Geared::new(bodies, constraints, &free);
        let mut all = Self { of_body: vec![None; bodies.len()], own: geared.own, ..Self::default() };
        for group in &geared.groups {
            all.add_train(group, &free, bodies);
        }
        for &Wheel { body, .. } in &all.wheels {
            holds(body).into_iter().for_each(|c| all.own[c] = true);
        }
        (all.awake_wheels, all.awake_trains) = ((0..all.wheels.len()).collect(), (0..all.trains.len()).collect());
        all
    }

    /// Adds a train: its bodies, each with the ratio to the first.
    fn add_train(&mut self, group: &[(usize, f64)], free: &[Option<Freedom>], bodies: &[RigidBody]) {
        let revolute = |body: usize| matches!(free[body], Some(Freedom::Revolute { .. }));
        let (fastest, most) = group.iter().copied().filter(|&(body, _)| revolute(body)).fold(group[0], |best, next| {
            let better = !revolute(best.0) || next.1.abs() > best.1.abs();
            if better { next } else { best }
        });
        let train = self.trains.len();
        let (mut mass, mut leader) = (0.0, 0);
        for &(body, ratio) in group {
            let Some(freedom) = free[body] else { continue };
            let (state, properties) = (&bodies[body], &bodies[body].properties);
            let start = Pose { rotation: state.rotation, position: state.position };
            let ratio = ratio / most;
            let (arm, cycle) = match freedom {
                Freedom::Revolute { pivot, .. } => {
                    let arm = start.rotation.conjugate() * (start.position - pivot);
                    (arm, denominator(ratio).unwrap_or(i64::MAX))
                }
                Freedom::Prismatic(_) => (DVec3::ZERO, i64::MAX),
            };
            let (twist, prescribed) = ([0.0; 6], [0.0; 6]);
            let mut wheel = Wheel { body, train, ratio, cycle, freedom, arm, origin: start, start, twist, prescribed };
            wheel.twist = wheel.along(start.rotation * arm);
            let (v, w) = (linear(&wheel.twist), angular(&wheel.twist));
            mass += ratio * ratio * (properties.mass * v.length_squared() + w.dot(state.inertia_world() * w));
            if body == fastest {
                leader = self.wheels.len();
            }
            self.of_body[body] = Some(self.wheels.len());
            self.wheels.push(wheel);
        }
        self.trains.push(Train { mass, leader, angle: 0.0, revolutions: 0, rate: 0.0, source_ratio: f64::INFINITY });
    }
}

/// What couplings tie.
struct Geared {
    /// Bodies of each train, each with the ratio of its coordinate to that of the first.
    groups: Vec<Vec<(usize, f64)>>,
    /// Whether each constraint is a coupling that ties them.
    own: Vec<bool>,
}

impl Geared {
    /// A coupling either ties a free body to a train or closes a ring and stays a row.
    fn new(bodies: &[RigidBody], constraints: &[Constraint], free: &[Option<Freedom>]) -> Self {
        let ties: Vec<(usize, [(usize, f64); 2])> = (0..constraints.len())
            .filter(|&c| always(&constraints[c]))
            .filter_map(|c| Some((c, tie(&constraints[c], free, bodies)?)))
            .collect();
        let mut visited = vec![false; bodies.len()];
        let mut own = vec![false; constraints.len()];
        let mut groups: Vec<Vec<(usize, f64)>> = Vec::new();
        for &(_, [(first, _), _]) in &ties {
            if std::mem::replace(&mut visited[first], true) {
                continue;
            }
            let mut group = vec![(first, 1.0)];
            let mut head = 0;
            while let Some(&(body, ratio)) = group.get(head) {
                head += 1;
                for &(index, [a, b]) in &ties {
                    let (here, there) = if a.0 == body { (a, b) } else { (b, a) };
                    if here.0 == body && !std::mem::replace(&mut visited[there.0], true) {
                        own[index] = true;
                        group.push((there.0, -ratio * here.1 / there.1));
                    }
                }
            }
            groups.push(group);
        }
        // A wheel that turns alone is one too: it costs a division as well.
        if !groups.is_empty() {
            let alone = (0..bodies.len()).filter(|&body| free[body].is_some() && !visited[body]);
            groups.extend(alone.map(|body| vec![(body, 1.0)]));
        }
        Self { groups, own }
    }
}

/// The denominator of a ratio of whole numbers: of the first convergent of its continued fraction that is the ratio but for
/// rounding. Where no small one is, none.
fn denominator(ratio: f64) -> Option<i64> {
    /// Products of some ratios of teeth.
    const ROUNDING: f64 = 16.0 * f64::EPSILON;
    /// A ratio that is none of teeth comes so near to one with a larger denominator only.
    const LARGEST: f64 = 1e6;
    let (mut remainder, mut above, mut below) = (ratio.abs(), [0.0, 1.0], [1.0, 0.0]);
    loop {
        let whole = remainder.floor();
        above = [above[1], whole * above[1] + above[0]];
        below = [below[1], whole * below[1] + below[0]];
        if below[1].is_nan() || below[1] > LARGEST {
            return None;
        }
        if (above[1] / below[1] - ratio.abs()).abs() <= ROUNDING * ratio.abs() {
            return Some(below[1] as i64);
        }
        remainder = 1.0 / (remainder - whole);
    }
}

/// Does it always act, whatever it carries, without friction?
fn always(constraint: &Constraint) -> bool {
    let Constraint { schedule, breaking, friction, slips, .. } = constraint;
    schedule.is_always() && breaking.is_none() && friction.is_none() && slips.is_none()
}

/// The one twist that these constraints leave a body on the world: those of a hinge, or of a slider.
fn freedom(
    body: usize,
    constraints_of_body: &[usize],
    bodies: &[RigidBody],
    constraints: &[Constraint],
) -> Option<Freedom> {
    let state = &bodies[body];
    let frame = DMat3::from_quat(state.rotation);
    let point = |anchor: &Anchor| anchor.body.map_or(anchor.point, |_| state.pose().point(anchor.point));
    let direction = |axis: &Axis| axis.body.map_or(axis.direction, |_| frame * axis.direction);
    let is_zero = |function: &Function| matches!(function, Function::Constant(value) if *value == 0.0);
    let (mut points, mut planes, mut own, mut across) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for &index in constraints_of_body {
        match &constraints[index].kind {
            ConstraintKind::PointToPoint { a, b } => {
                let (p, q) = (point(a), point(b));
                if p.distance(q) > CLOSED {
                    return None;
                }
                points.push(if a.body.is_some() { q } else { p });
            }
            ConstraintKind::PointOnPlane { point: p, plane, normal, offset } => {
                let (height, fixed) = ((point(p) - point(plane)).dot(*normal), plane.body.is_none());
                if !fixed || !matches!(offset, Function::Constant(o) if (height - o).abs() < CLOSED) {
                    return None;
                }
                planes.push(*normal);
            }
            ConstraintKind::Orientation { a, b, angle } => {
                let (t, n) = (direction(a), direction(b));
                if !is_zero(angle) || b.body.is_some() || t.dot(n).abs() > SAME {
                    return None;
                }
                own.push(t);
                across.push(n);
            }
            ConstraintKind::Coupling { .. } => return None,
        }
    }
    let along = across.first()?.cross(*across.get(1)?).try_normalize()?;
    let one = |v: &DVec3| v.cross(along).length() < SAME;
    // The axle's own direction is held across two of the world: it points along what is across both.
    if !one(&own[0]) || !one(&own[1]) {
        return None;
    }
    match (&points[..], planes.len(), own.len()) {
        ([pivot], 0, 2) => Some(Freedom::Revolute { about: along, pivot: *pivot }),
        ([], 2, 3) => {
            let square = planes.iter().all(|normal| normal.dot(along).abs() < SAME);
            let apart = planes[0].dot(planes[1]).abs() < SAME && own[2].dot(along).abs() < SAME;
            (square && apart).then_some(Freedom::Prismatic(along))
        }
        _ => None,
    }
}

/// The two bodies that a coupling ties, each with what its coordinate counts.
fn tie(constraint: &Constraint, free: &[Option<Freedom>], bodies: &[RigidBody]) -> Option<[(usize, f64); 2]> {
    let ConstraintKind::Coupling { terms } = &constraint.kind else { return None };
    let of = |term: &Term| match term.measure {
        Measure::Angle { axis, frame: None } => {
            let body = axis.body?;
            let Some(Freedom::Revolute { about, .. }) = free[body] else { return None };
            let cosine = (bodies[body].rotation * axis.direction).dot(about);
            (cosine.abs() > 1.0 - SAME).then_some((body, term.coefficient * cosine.signum()))
        }
        Measure::Displacement { point, direction } if direction.body.is_none() => {
            let body = point.body?;
            let Some(Freedom::Prismatic(axis)) = free[body] else { return None };
            Some((body, term.coefficient * direction.direction.dot(axis)))
        }
        _ => None,
    };
    let [a, b] = &terms[..] else { return None };
    let (a, b) = (of(a)?, of(b)?);
    (a.0 != b.0 && a.1 != 0.0 && b.1 != 0.0).then_some([a, b])
}

#[cfg(test)]
mod tests {
    use super::denominator;

    #[test]
    fn ratios_of_teeth_come_round() {
        for (above, below, round) in
            [(1, 1, 1), (12, 60, 5), (-7, 3, 3), (78 * 80, 6 * 7, 7), (6 * 6 * 8, 78 * 80 * 77, 5005)]
        {
            let found = denominator(f64::from(above) / f64::from(below)).expect("a ratio of whole numbers");
            assert_eq!(found, round, "{above}/{below}");
        }
        assert_eq!(denominator(std::f64::consts::PI), None);
        assert_eq!(denominator(f64::NAN), None);
    }
}

//! Joints: anchors and axes in body frames, and the checks that a solver relies on.

use super::super::codes;
use super::super::diagnostic::Diagnostic;
use super::super::sidecar::{self, Attachment, BodyAxis, Friction, NailTarget};
use super::Context;
use super::bodies::meters;
use super::colliders::Pair;
use crate::articulation::{
    Anchor, Axis, Constraint, ConstraintKind, Function, Limit, LimitKind, PivotFriction, Schedule, Spring, SpringKind,
};
use crate::math::{DVec3, PI, cos};

/// Points of a joint may be this far apart at rest, m: single-precision files of a few metres, and drawing by hand.
const APART: f64 = 1e-4;
/// Axes of an orientation may be this far from perpendicular at rest: 0.1°.
const OBLIQUE: f64 = 0.1 * PI / 180.0;
/// Most constraints of an exhibit.
const MAX_CONSTRAINTS: usize = 4096;

impl Context<'_> {
    /// All constraints that could be resolved, in the order of the kinds and of the file.
    pub(super) fn constraints(&mut self) -> (Vec<Constraint>, Vec<Limit>) {
        let sidecar = self.sidecar;
        let given = &sidecar.constraint;
        let mut out: (Vec<Constraint>, Vec<Limit>) = Default::default();
        for (i, joint) in given.point_to_point.iter().enumerate() {
            let at = format!("/constraint/point-to-point/{i}");
            let a = self.attachment(&joint.a, &format!("{at}/a"), &joint.name);
            let b = self.attachment(&joint.b, &format!("{at}/b"), &joint.name);
            if let (Some(a), Some(b)) = (a, b) {
                let kind = ConstraintKind::PointToPoint { a, b };
                self.push(&mut out, &joint.name, kind, joint.friction, joint.limit.as_ref(), &joint.a.node, &at);
            }
        }
        for (i, joint) in given.nail.iter().enumerate() {
            let at = format!("/constraint/nail/{i}");
            let used_for = format!("constraint \"{}\"", joint.name);
            let node = self.node(&joint.body, &format!("{at}/body"), &used_for);
            let a = node.and_then(|node| self.point(node, joint.at.as_ref(), &format!("{at}/at"), &used_for));
            let b = match &joint.to {
                NailTarget::World(p) => Some(Anchor { body: None, point: DVec3::from(p.map(|x| x.0)) }),
                NailTarget::Node(to) => self.attachment(to, &format!("{at}/to"), &joint.name),
            };
            if let (Some(a), Some(b)) = (a, b) {
                let kind = ConstraintKind::PointToPoint { a, b };
                self.push(&mut out, &joint.name, kind, joint.friction, joint.limit.as_ref(), &joint.body, &at);
            }
        }
        for (i, joint) in given.orientation.iter().enumerate() {
            let at = format!("/constraint/orientation/{i}");
            let a = self.body_axis(
                &joint.body,
                joint.body_axis,
                &format!("{at}/body"),
                &format!("{at}/body_axis"),
                &joint.name,
            );
            let b = self.second_axis(joint.world_axis, joint.other.as_ref(), &at, &joint.name);
            if let (Some(a), Some(b)) = (a, b) {
                let kind = ConstraintKind::Orientation { a, b, angle: Function::default() };
                self.push(&mut out, &joint.name, kind, joint.friction, joint.limit.as_ref(), &joint.body, &at);
            }
        }
        if out.0.len() > MAX_CONSTRAINTS {
            let message = format!("{} constraints; the limit is {MAX_CONSTRAINTS}", out.0.len());
            self.report("/constraint", Diagnostic::new(codes::MODEL_LIMIT, message));
        }
        out
    }

    fn attachment(&mut self, given: &Attachment, at: &str, name: &str) -> Option<Anchor> {
        let used_for = format!("constraint \"{name}\"");
        let node = self.node(&given.node, &format!("{at}/node"), &used_for)?;
        self.point(node, given.at.as_ref(), &format!("{at}/at"), &used_for)
    }

    fn body_axis(&mut self, body: &str, axis: [f64; 3], at_body: &str, at_axis: &str, name: &str) -> Option<Axis> {
        let node = self.node(body, at_body, &format!("constraint \"{name}\""))?;
        self.axis(node, axis, at_axis)
    }

    /// The axis given as `world_axis` or `other`; `None` where a problem was reported.
    fn second_axis(&mut self, world: Option<[f64; 3]>, other: Option<&BodyAxis>, at: &str, name: &str) -> Option<Axis> {
        match (world, other) {
            (Some(axis), None) => {
                let unit = self.unit(DVec3::from(axis), &format!("{at}/world_axis"));
                unit.map(|direction| Axis { body: None, direction })
            }
            (None, Some(other)) => {
                let place = format!("{at}/other");
                self.body_axis(&other.body, other.axis, &format!("{place}/body"), &format!("{place}/axis"), name)
            }
            _ => {
                let message = format!("constraint \"{name}\" needs world_axis or other, one of them");
                self.report(at, Diagnostic::new(codes::MISSING_KEY, message).help("add world_axis = [0, 1, 0]"));
                None
            }
        }
    }

    #[expect(clippy::too_many_arguments, reason = "the parts that the three kinds of joint have in common")]
    fn push(
        &mut self,
        out: &mut (Vec<Constraint>, Vec<Limit>),
        name: &str,
        kind: ConstraintKind,
        friction: Option<Friction>,
        limit: Option<&sidecar::Limit>,
        first: &str,
        at: &str,
    ) {
        self.unique(name, out.0.iter().any(|c| c.name == name), &format!("{at}/name"));
        let (a, b) = ends(&kind);
        if a == b {
            let message = format!("constraint \"{name}\" joins {} to itself", self.body_name(a));
            let message =
                if a.is_none() { format!("constraint \"{name}\" joins two things that stand still") } else { message };
            let help = "one of the two must be a [[body]] that moves";
            self.report(at, Diagnostic::new(codes::BOTH_STATIC, message).help(help));
            return;
        }
        self.check_rest(&kind, name, at);
        let friction = friction.map(|f| PivotFriction {
            coefficient: f.coefficient,
            radius: self.not_negative(f.radius.0, &format!("{at}/friction/radius")),
        });
        let tilt_limit = limit.and_then(|limit| self.tilt_limit(limit, first, b, &format!("{at}/limit"), name));
        let of = format!("constraint {name}");
        let shown = match &kind {
            ConstraintKind::PointToPoint { a, b } => {
                format!(
                    "{} at {} to {} at {}",
                    self.body_name(a.body),
                    meters(a.point),
                    self.body_name(b.body),
                    meters(b.point)
                )
            }
            ConstraintKind::Orientation { a, b, .. } => format!(
                "{} axis {} perpendicular to {} axis {}",
                self.body_name(a.body),
                a.direction,
                self.body_name(b.body),
                b.direction
            ),
            _ => String::new(),
        };
        self.trace(&of, "joins", shown, at, "");
        if let Some(f) = friction {
            self.trace(
                &of,
                "friction",
                format!("μ {}, r {} m", f.coefficient, f.radius),
                &format!("{at}/friction"),
                "",
            );
        }
        if let Some(Limit { kind: LimitKind::Tilt { max, .. }, .. }) = &tilt_limit {
            self.trace(&of, "limit", format!("{:.2}°", max * 180.0 / PI), &format!("{at}/limit"), "");
        }
        out.1.extend(tilt_limit);
        out.0.push(Constraint { friction, ..Constraint::new(name, kind) });
    }

    /// Holds the constraint at rest? What does not would be torn together in the first step.
    fn check_rest(&mut self, kind: &ConstraintKind, name: &str, at: &str) {
        match kind {
            ConstraintKind::PointToPoint { a, b } => {
                let gap = self.at_rest(a).distance(self.at_rest(b));
                if gap > APART {
                    let message = format!("the two points of \"{name}\" are {:.2} mm apart at rest", gap * 1e3);
                    let label = format!("{} and {}", meters(self.at_rest(a)), meters(self.at_rest(b)));
                    let help =
                        format!("move one of the two nodes; up to {} mm is taken as meant together", APART * 1e3);
                    self.report(at, Diagnostic::new(codes::APART, message).label(label).help(help));
                }
            }
            ConstraintKind::Orientation { a, b, .. } => {
                let (t, n) = (self.pose_of(a.body).vector(a.direction), self.pose_of(b.body).vector(b.direction));
                let off = crate::math::asin(t.dot(n).clamp(-1.0, 1.0)).abs();
                if off > OBLIQUE {
                    let message =
                        format!("the two axes of \"{name}\" are {:.2}° from perpendicular at rest", off * 180.0 / PI);
                    self.report(
                        at,
                        Diagnostic::new(codes::NOT_PERPENDICULAR, message).label(format!("{t} and {n} in the world")),
                    );
                }
            }
            _ => {}
        }
    }

    fn tilt_limit(
        &mut self,
        limit: &sidecar::Limit,
        first: &str,
        second: Option<usize>,
        at: &str,
        name: &str,
    ) -> Option<Limit> {
        let a = self.body_axis(first, limit.axis, at, &format!("{at}/axis"), name)?;
        let b = if limit.world_axis.is_none() && limit.other.is_none() {
            let world = self.pose_of(a.body).vector(a.direction);
            Axis { body: second, direction: self.pose_of(second).inverse_vector(world) }
        } else {
            self.second_axis(limit.world_axis, limit.other.as_ref(), at, name)?
        };
        let angle = limit.max.0;
        if !(angle > 0.0 && angle < PI) {
            let problem = Diagnostic::new(
                codes::RANGE,
                format!("a tilt limit of {:.1}° limits nothing, or all", angle * 180.0 / PI),
            );
            self.report(&format!("{at}/max"), problem.help("give an angle between 0 and 180 deg"));
            return None;
        }
        let (u, v) = (self.pose_of(a.body).vector(a.direction), self.pose_of(b.body).vector(b.direction));
        if u.dot(v) < cos(angle) {
            let problem =
                Diagnostic::new(codes::RANGE, format!("constraint \"{name}\" is beyond its tilt limit at rest"));
            self.report(&format!("{at}/max"), problem.help("turn the axis round, or allow more"));
        }
        Some(Limit {
            name: name.to_owned(),
            kind: LimitKind::Tilt { a, b, max: angle },
            restitution: limit.restitution,
        })
    }

    /// Springs and dampers.
    pub(super) fn springs(&mut self) -> Vec<Spring> {
        let sidecar = self.sidecar;
        let mut out: Vec<Spring> = Vec::new();
        for (i, given) in sidecar.constraint.spring.iter().enumerate() {
            let at = format!("/constraint/spring/{i}");
            self.unique(&given.name, out.iter().any(|s| s.name == given.name), &format!("{at}/name"));
            let a = self.attachment(&given.a, &format!("{at}/a"), &given.name);
            let b = self.attachment(&given.b, &format!("{at}/b"), &given.name);
            let (Some(a), Some(b)) = (a, b) else { continue };
            if a.body == b.body {
                let message = format!("spring \"{}\" has both ends on {}", given.name, self.body_name(a.body));
                self.report(&at, Diagnostic::new(codes::BOTH_STATIC, message));
                continue;
            }
            let length = self.at_rest(&a).distance(self.at_rest(&b));
            let spring = Spring {
                name: given.name.clone(),
                kind: SpringKind::Linear { a, b },
                rest: self.not_negative(given.rest_length.map_or(length, |l| l.0), &format!("{at}/rest_length")).into(),
                stiffness: self.not_negative(given.stiffness.0, &format!("{at}/stiffness")).into(),
                damping: self.not_negative(given.damping.map_or(0.0, |d| d.0), &format!("{at}/damping")).into(),
                schedule: Schedule::default(),
                breaking: None,
            };
            let of = format!("spring {}", given.name);
            self.trace(
                &of,
                "rest_length",
                format!("{} m", spring.rest.at(0.0).value),
                &format!("{at}/rest_length"),
                "derived: length at rest",
            );
            self.trace(
                &of,
                "stiffness",
                format!("{} N/m", spring.stiffness.at(0.0).value),
                &format!("{at}/stiffness"),
                "",
            );
            self.trace(
                &of,
                "damping",
                format!("{} N s/m", spring.damping.at(0.0).value),
                &format!("{at}/damping"),
                "default",
            );
            out.push(spring);
        }
        out
    }

    /// The bodies and the world, joined by constraints, must form a forest, and no two rows between the same two
    /// bodies may hold the same freedom: the tree factor of the solver has then full rank.
    pub(super) fn check_topology(&mut self, constraints: &[Constraint]) {
        let mut groups: Vec<(Pair, Vec<&Constraint>)> = Vec::new();
        for constraint in constraints {
            let (a, b) = ends(&constraint.kind);
            let pair = (a.min(b), a.max(b));
            match groups.iter_mut().find(|(other, _)| *other == pair) {
                Some((_, members)) => members.push(constraint),
                None => groups.push((pair, vec![constraint])),
            }
        }
        // Kruskal: an edge whose ends are connected already closes a loop.
        let mut tree: Vec<(Option<usize>, Option<usize>, &str)> = Vec::new();
        for ((a, b), members) in &groups {
            let name = &members[0].name;
            if let Some(path) = path(&tree, *a, *b) {
                let ring = path.into_iter().chain([name.as_str()]).collect::<Vec<_>>();
                let message = format!("constraint \"{name}\" closes a loop: {}", ring.join(", "));
                let help = "joints must form a tree; take one away, or hold the last one by a spring";
                self.report(&self.place(name), Diagnostic::new(codes::LOOP, message).help(help));
            } else {
                tree.push((*a, *b, name));
            }
            self.check_rank(members);
        }
    }

    /// Reports the first constraint of a pair of bodies whose rows depend on those before it.
    fn check_rank(&mut self, members: &[&Constraint]) {
        /// Sine of the angle below which a row lies in the span of the others.
        const DEPENDENT: f64 = 1e-6;
        let center = members.iter().find_map(|c| match &c.kind {
            ConstraintKind::PointToPoint { a, .. } => Some(self.at_rest(a)),
            _ => None,
        });
        // Lengths against angles: scaled by the arms at hand, so that the test does not depend on the unit.
        let mut arms = 0.0_f64;
        for constraint in members {
            if let (ConstraintKind::PointToPoint { a, .. }, Some(c)) = (&constraint.kind, center) {
                arms = arms.max(self.at_rest(a).distance(c));
            }
        }
        let scale = if arms > 0.0 { 1.0 / arms } else { 1.0 };
        let mut basis: Vec<[DVec3; 2]> = Vec::new();
        for constraint in members {
            let rows: Vec<[DVec3; 2]> = match &constraint.kind {
                ConstraintKind::PointToPoint { a, .. } => {
                    let arm = center.map_or(DVec3::ZERO, |c| self.at_rest(a) - c) * scale;
                    DVec3::AXES.map(|e| [e, arm.cross(e)]).to_vec()
                }
                ConstraintKind::Orientation { a, b, .. } => {
                    let (t, n) = (self.pose_of(a.body).vector(a.direction), self.pose_of(b.body).vector(b.direction));
                    vec![[DVec3::ZERO, t.cross(n)]]
                }
                _ => Vec::new(),
            };
            for row in rows {
                let dot = |u: &[DVec3; 2], v: &[DVec3; 2]| u[0].dot(v[0]) + u[1].dot(v[1]);
                let size = dot(&row, &row).sqrt();
                let rest = basis.iter().fold(row, |r, e| {
                    let along = dot(&r, e);
                    [r[0] - e[0] * along, r[1] - e[1] * along]
                });
                let length = dot(&rest, &rest).sqrt();
                if length <= DEPENDENT * size || size == 0.0 {
                    let name = &constraint.name;
                    let names: Vec<&str> = members.iter().map(|c| c.name.as_str()).collect();
                    let message = format!("constraint \"{name}\" holds again what others hold already");
                    let label = format!("between the same two bodies: {}", names.join(", "));
                    let help = "a hinge is a nail and two orientations (5 freedoms); two points on one line share one";
                    self.report(
                        &self.place(name),
                        Diagnostic::new(codes::OVER_CONSTRAINED, message).label(label).help(help),
                    );
                    return;
                }
                basis.push(rest.map(|part| part / length));
            }
        }
    }

    /// Where a constraint of this name stands in the sidecar.
    fn place(&self, name: &str) -> String {
        let kinds = self.source.value.get("constraint").and_then(|c| c.as_object());
        for (kind, list) in kinds.into_iter().flatten() {
            let index = list
                .as_array()
                .and_then(|l| l.iter().position(|c| c.get("name").and_then(|n| n.as_str()) == Some(name)));
            if let Some(index) = index {
                return format!("/constraint/{kind}/{index}");
            }
        }
        "/constraint".to_owned()
    }
}

/// The two bodies of a constraint.
pub(super) fn ends(kind: &ConstraintKind) -> (Option<usize>, Option<usize>) {
    match kind {
        ConstraintKind::PointToPoint { a, b } => (a.body, b.body),
        ConstraintKind::Orientation { a, b, .. } => (a.body, b.body),
        ConstraintKind::PointOnPlane { point, plane, .. } => (point.body, plane.body),
        ConstraintKind::Coupling { .. } => (None, None),
    }
}

/// Names of the edges between two ends in a forest; `None` where they are not connected.
fn path<'n>(
    tree: &[(Option<usize>, Option<usize>, &'n str)],
    from: Option<usize>,
    to: Option<usize>,
) -> Option<Vec<&'n str>> {
    let mut waiting = vec![(from, usize::MAX, Vec::new())];
    while let Some((here, came_by, names)) = waiting.pop() {
        if here == to {
            return Some(names);
        }
        for (edge, &(a, b, name)) in tree.iter().enumerate() {
            let next = if a == here {
                b
            } else if b == here {
                a
            } else {
                continue;
            };
            if edge != came_by {
                waiting.push((next, edge, names.iter().copied().chain([name]).collect()));
            }
        }
    }
    None
}

//! Resolves joints: constraint tables to rows between bodies.
//!
//! Each kind has a function here or in a submodule that finds its anchors and axes. It adds rows under the table's name
//! (`axle`), or, for a combined joint, under names of its parts (`axle/nail`, `axle/across-1`). Reference values come
//! from the poses of the model; the rows are checked at the start poses.

mod checks;
mod combinations;
mod elements;
mod functions;
mod gears;
mod limits;
pub(super) mod pairs;
mod points;
mod rank;
mod schedule;
mod sheets;
mod springs;

use super::super::codes;
use super::super::diagnostic::{Diagnostic, quoted, similar_names};
use super::super::sidecar::Friction;
use super::bodies::meters;
use super::context::Context;
pub(super) use functions::interpolation;

use soffio_multibody::articulation::{
    Axis, Breaking, Constraint, ConstraintKind, Limit, Measure, PivotFriction, Schedule, Spring,
};

/// Most constraints of an exhibit.
const MAX_CONSTRAINTS: usize = 4096;

/// Results of the constraint tables.
#[derive(Default)]
pub(super) struct Joints {
    /// Constraints of the solver, in the order of the tables.
    pub constraints: Vec<Constraint>,
    /// Limits of joint coordinates, distances and tilts.
    pub limits: Vec<Limit>,
    /// Springs, with their dampers.
    pub springs: Vec<Spring>,
    /// Free coordinates of hinges and sliders, for tables that refer to them with `of`.
    free: Vec<(String, Measure)>,
    names: Vec<String>,
    /// Names of inactive constraints; tables may still refer to them.
    disabled: Vec<String>,
}

/// Common properties of the rows of one table.
struct Header<'n> {
    name: &'n str,
    /// JSON pointer of the table.
    at: &'n str,
    schedule: Schedule,
    breaking: Option<Breaking>,
    stabilization_time: Option<f64>,
}

impl Context<'_> {
    /// All constraints, limits and springs that could be resolved, in the order of the kinds and of the file.
    pub(super) fn joints(&mut self) -> Joints {
        let sidecar = self.sidecar;
        let given = &sidecar.constraint;
        let mut out = Joints::default();
        self.each("point-to-point", &given.point_to_point, &mut out, Self::point_to_point);
        self.each("nail", &given.nail, &mut out, Self::nail);
        self.each("orientation", &given.orientation, &mut out, Self::orientation);
        self.each("point-on-plane", &given.point_on_plane, &mut out, Self::point_on_plane);
        self.each("hinge", &given.hinge, &mut out, |this, hinge, at, out| this.hinge(hinge, "nail", at, out));
        self.each("universal", &given.universal, &mut out, Self::universal);
        self.each("slider", &given.slider, &mut out, Self::slider);
        self.each("line", &given.line, &mut out, Self::line);
        self.each("weld", &given.weld, &mut out, Self::weld);
        self.each("windmill", &given.windmill, &mut out, |this, hinge, at, out| this.hinge(hinge, "point", at, out));
        self.each("gear", &given.gear, &mut out, Self::gear);
        self.each("gear-weight", &given.gear_weight, &mut out, Self::gear_weight);
        self.each("clutch", &given.clutch, &mut out, Self::clutch);
        self.each("element", &given.element, &mut out, Self::element);
        self.each("ratchet", &given.ratchet, &mut out, Self::ratchet);
        self.each("limit", &given.limit, &mut out, Self::bounds);
        self.each("spring", &given.spring, &mut out, Self::spring);
        self.each("torsion-spring", &given.torsion_spring, &mut out, Self::torsion_spring);
        self.join_sheets(&mut out);
        let acts = |name: &str| !out.disabled.iter().any(|disabled| disabled == name);
        out.constraints.retain(|constraint| acts(constraint.group()));
        out.limits.retain(|limit| acts(&limit.name));
        out.springs.retain(|spring| acts(&spring.name));
        if out.constraints.len() > MAX_CONSTRAINTS {
            let message = format!("{} constraints; the limit is {MAX_CONSTRAINTS}", out.constraints.len());
            let problem = Diagnostic::new(codes::MODEL_LIMIT, message);
            self.report("/constraint", problem.help("join bodies that do not move against each other"));
        }
        out
    }

    fn each<T>(&mut self, kind: &str, list: &[T], out: &mut Joints, resolve: fn(&mut Self, &T, &str, &mut Joints)) {
        for (i, one) in list.iter().enumerate() {
            resolve(self, one, &format!("/constraint/{kind}/{i}"), out);
        }
    }

    /// Registers a name; reports a duplicate.
    fn name(&mut self, name: &str, at: &str, out: &mut Joints) {
        self.unique(name, out.names.iter().any(|taken| taken == name), &format!("{at}/name"));
        out.names.push(name.to_owned());
    }

    /// Registers a table that is switched off.
    fn enable(&mut self, name: &str, enabled: Option<bool>, at: &str, out: &mut Joints) {
        if enabled == Some(false) {
            self.record_origin(
                &format!("constraint {name}"),
                "enabled",
                "false: it is not active".into(),
                &format!("{at}/enabled"),
                "",
            );
            out.disabled.push(name.to_owned());
        }
    }

    /// Reports bodies that cannot be joined: one of the two must be a body that moves freely.
    fn joinable(&mut self, a: Option<usize>, b: Option<usize>, name: &str, at: &str) -> bool {
        let given = |body: Option<usize>| body.is_none_or(|body| self.is_kinematic(body));
        let message = if a == b && a.is_some() {
            format!("constraint \"{name}\" joins {} to itself", self.body_name(a))
        } else if given(a) && given(b) {
            format!("constraint \"{name}\" joins two nodes that are fixed or kinematic")
        } else {
            return true;
        };
        let help = "one of the two must be a [[body]] that moves freely";
        self.report(at, Diagnostic::new(codes::BOTH_STATIC, message).help(help));
        false
    }

    /// Adds one constraint: the table's own (`part` empty) or a part of a combined joint.
    fn push(
        &mut self,
        out: &mut Joints,
        header: &Header,
        part: &str,
        kind: ConstraintKind,
        friction: Option<PivotFriction>,
    ) {
        let name = if part.is_empty() { header.name.to_owned() } else { format!("{}/{part}", header.name) };
        // A constraint that acts later may be open until then.
        let schedule = &header.schedule;
        let start_position = schedule.windows.is_empty() || schedule.windows.iter().any(|window| window.start <= 0.0);
        if start_position && schedule.trigger.is_none() {
            self.check_rest(&kind, &name, header.at);
        }
        let of = format!("constraint {name}");
        let source = if part.is_empty() { "" } else { "part of the combined joint" };
        let place = if part.is_empty() { header.at } else { "/-" };
        let shown = self.shown(&kind);
        self.record_origin(&of, "holds", shown, place, source);
        if let Some(f) = friction {
            let value = format!("μ {}, r {} m", f.coefficient, f.radius);
            self.record_origin(&of, "friction", value, &format!("{}/friction", header.at), "");
        }
        out.constraints.push(Constraint {
            name,
            kind,
            schedule: header.schedule.clone(),
            breaking: header.breaking,
            friction,
            slips: None,
            stabilization_time: header.stabilization_time,
        });
    }

    /// Records the parts of a combined joint, and when the table's rows act and break.
    fn record_header_origins(&mut self, header: &Header, kind: &str, out: &Joints, first: usize) {
        let of = format!("constraint {}", header.name);
        let parts: Vec<&str> = out.constraints[first..].iter().map(|c| c.name.as_str()).collect();
        if parts.iter().any(|name| name.contains('/')) {
            let rows: usize = out.constraints[first..].iter().map(|c| rows_of(&c.kind)).sum();
            self.record_origin(&of, kind, format!("{rows} rows: {}", parts.join(", ")), header.at, "");
        }
        self.record_timing_origins(&of, header);
    }

    fn friction(&mut self, given: Option<Friction>, at: &str) -> Option<PivotFriction> {
        given.map(|f| PivotFriction {
            coefficient: f.coefficient,
            radius: self.not_negative(f.radius.0, &format!("{at}/friction/radius")),
        })
    }

    /// The free coordinate of the hinge or slider named `of`.
    fn free_measure(&mut self, of: &str, at: &str, out: &Joints) -> Option<Measure> {
        if let Some((_, measure)) = out.free.iter().find(|(name, _)| name == of) {
            return Some(*measure);
        }
        let names: Vec<&str> = out.free.iter().map(|(name, _)| name.as_str()).collect();
        self.unknown_constraint(of, "hinge or slider", &names, at);
        None
    }

    fn unknown_constraint(&mut self, of: &str, what: &str, names: &[&str], at: &str) {
        let likely = similar_names(of, names.iter().copied());
        let help = match (likely.is_empty(), names.is_empty()) {
            (false, _) => format!("did you mean {}?", quoted(&likely)),
            (true, false) => format!("there are {}", quoted(names)),
            (true, true) => format!("there is no {what} in this file"),
        };
        let message = format!("no {what} named \"{of}\"");
        self.report(at, Diagnostic::new(codes::UNKNOWN_CONSTRAINT, message).help(help));
    }

    /// A constraint as text.
    fn shown(&self, kind: &ConstraintKind) -> String {
        let axis = |a: &Axis| format!("{} axis {}", self.body_name(a.body), a.direction);
        match kind {
            ConstraintKind::PointToPoint { a, b } => {
                let (one, other) = (self.body_name(a.body), self.body_name(b.body));
                format!("{one} at {} to {other} at {}", meters(a.point), meters(b.point))
            }
            ConstraintKind::PointOnPlane { point, plane, normal, offset } => format!(
                "{} at {} in the plane of {} through {} with normal {normal}, {} above it",
                self.body_name(point.body),
                meters(point.point),
                self.body_name(plane.body),
                meters(plane.point),
                functions::shown(offset, "m")
            ),
            ConstraintKind::Orientation { a, b, angle } if angle.is_constant() && angle.at(0.0).value == 0.0 => {
                format!("{} perpendicular to {}", axis(a), axis(b))
            }
            ConstraintKind::Orientation { a, b, angle } => {
                format!("{}, {} from perpendicular to {}", axis(a), functions::shown(angle, "rad"), axis(b))
            }
            ConstraintKind::Coupling { terms } => {
                let term = |t: &soffio_multibody::articulation::Term| {
                    format!("{} · {}", t.coefficient, self.shown_measure(&t.measure))
                };
                format!("{} = const", terms.iter().map(term).collect::<Vec<_>>().join(" + "))
            }
        }
    }

    /// A rotation or displacement as text.
    fn shown_measure(&self, measure: &Measure) -> String {
        match measure {
            Measure::Angle { axis, frame } => format!(
                "rotation of {} about {} relative to {}",
                self.body_name(axis.body),
                axis.direction,
                self.body_name(*frame)
            ),
            Measure::Displacement { point, direction } => format!(
                "displacement of {} along {} of {}",
                self.body_name(point.body),
                direction.direction,
                self.body_name(direction.body)
            ),
        }
    }

    /// Location of a constraint, or of its combined joint, in the sidecar.
    pub(super) fn place(&self, name: &str) -> String {
        let name = name.split('/').next().unwrap_or(name);
        let kinds = self.source.value.get("constraint").and_then(|c| c.as_object());
        for (kind, list) in kinds.into_iter().flatten() {
            let index = list
                .as_array()
                .and_then(|l| l.iter().position(|c| c.get("name").and_then(|n| n.as_str()) == Some(name)));
            if let Some(index) = index {
                return format!("/constraint/{kind}/{index}");
            }
        }
        let sheet = self.sidecar.sheet.iter().position(|sheet| sheet.name == name);
        sheet.map_or_else(|| "/constraint".to_owned(), |entry| format!("/sheet/{entry}"))
    }
}

/// How many rows a constraint has.
fn rows_of(kind: &ConstraintKind) -> usize {
    match kind {
        ConstraintKind::PointToPoint { .. } => 3,
        ConstraintKind::PointOnPlane { .. } | ConstraintKind::Orientation { .. } | ConstraintKind::Coupling { .. } => 1,
    }
}

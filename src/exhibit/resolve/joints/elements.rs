//! Elements: one more degree of freedom constrained, or one freed.
//!
//! With d the axis of the degree of freedom in the model: a translation is constrained by the plane N = d through the
//! point. A rotation is constrained by the orientation T ⟂ N with T × N = d, T fixed in the body and N in its
//! counterpart, so that T·N = sin(angle) for a right-handed rotation of the body. To free a translation, the point
//! constraint is split into three planes along the frame's axes, one of which is inactive while the element acts.

use super::super::super::codes;
use super::super::super::diagnostic::Diagnostic;
use super::super::super::sidecar::{self, Dof, Frame, FrameWord, Op};
use super::super::context::Context;
use super::{Header, Joints};
use soffio_math::Function;
use soffio_math::{DMat3, DVec3, tangents};
use soffio_multibody::articulation::{Anchor, Axis, Constraint, ConstraintKind};

/// A row constrains a rotation where its axis is this near to the rotation's (cosine).
const ALONG: f64 = 0.999;

/// Index of the axis, and whether the freedom is a rotation.
fn axis_of(dof: Dof) -> (usize, bool) {
    match dof {
        Dof::Tx => (0, false),
        Dof::Ty => (1, false),
        Dof::Tz => (2, false),
        Dof::Rx => (0, true),
        Dof::Ry => (1, true),
        Dof::Rz => (2, true),
    }
}

impl Context<'_> {
    pub(super) fn element(&mut self, given: &sidecar::Element, at: &str, out: &mut Joints) {
        let header = self.header(&given.name, &given.timing, at, out);
        match given.op {
            Op::Add => self.add_element(given, &header, out),
            Op::Remove => self.remove_element(given, &header, out),
        }
    }

    /// Indices of the rows that `of` names: one constraint, or all parts of a combination.
    fn named(&mut self, of: &str, at: &str, out: &Joints) -> Option<Vec<usize>> {
        let hits = |name: &str| name == of || name.split('/').next() == Some(of);
        let found: Vec<usize> = (0..out.constraints.len()).filter(|&i| hits(&out.constraints[i].name)).collect();
        if found.is_empty() {
            let mut names: Vec<&str> = out.constraints.iter().map(Constraint::group).collect();
            names.dedup();
            self.unknown_constraint(of, "constraint", &names, &format!("{at}/of"));
            return None;
        }
        Some(found)
    }

    /// World axes of the frame in the model, and the body that carries it.
    fn frame(&mut self, frame: &Frame, body: Option<usize>, header: &Header) -> Option<(DMat3, Option<usize>)> {
        match frame {
            Frame::Word(FrameWord::World) => Some((DMat3::IDENTITY, None)),
            Frame::Word(FrameWord::Body) => Some((DMat3::from_quat(self.pose_of(body).rotation), body)),
            Frame::Node { node } => {
                let place = format!("{}/frame/node", header.at);
                let node = self.node(node, &place, &format!("element \"{}\"", header.name))?;
                let axes = DMat3::from_mat4(self.model.nodes[node].world);
                let unit = |v: DVec3| self.unit(v, &place);
                let [x, y, z] = [axes.x_axis, axes.y_axis, axes.z_axis].map(unit);
                Some((DMat3::from_cols(x?, y?, z?), self.owner[node]))
            }
        }
    }

    fn add_element(&mut self, given: &sidecar::Element, header: &Header, out: &mut Joints) {
        let at = header.at;
        // The constrained point and its counterpart: those of the constraint, or the body's and the frame's.
        let (point, against) = match (&given.of, &given.body) {
            (Some(of), None) => {
                let Some(found) = self.named(of, at, out) else { return };
                let Some((a, b)) = found.iter().find_map(|&i| ends(&out.constraints[i].kind)) else { return };
                (a, Some(b.body))
            }
            (None, Some(body)) => {
                let Some(point) = self.point_of(body, given.at.as_ref(), at, header.name) else { return };
                (point, None)
            }
            _ => {
                let message = format!("element \"{}\" needs either `of` or `body`", header.name);
                let help = "of = \"axle\" constrains the two bodies of that constraint further; body = \"Wheel\" constrains one body";
                self.report(at, Diagnostic::new(codes::MISSING_KEY, message).help(help));
                return;
            }
        };
        let Some((axes, carrier)) = self.frame(&given.frame, point.body, header) else { return };
        // Axes that the body itself carries constrain it relative to the world.
        let own = carrier == point.body;
        let against = against.unwrap_or(if own { None } else { carrier });
        if !self.joinable(point.body, against, header.name, at) {
            return;
        }
        let (index, turn) = axis_of(given.dof);
        let d = axes.col(index);
        let value = given.value.as_ref().map_or(Function::default(), |f| self.function(f, &format!("{at}/value")));
        let local = |this: &Self, body, v| this.pose_of(body).inverse_vector(v);
        let kind = if turn {
            let t = tangents(d).0;
            let a = Axis { body: point.body, direction: local(self, point.body, t) };
            let b = Axis { body: against, direction: local(self, against, d.cross(t)) };
            ConstraintKind::Orientation { a, b, angle: value }
        } else {
            let place = self.reference_position(&point);
            let there = Anchor { body: against, point: self.pose_of(against).inverse_point(place) };
            if own {
                // The plane moves with the body, and the fixed point lies below it by as much as the body rises.
                let normal = local(self, point.body, -d);
                ConstraintKind::PointOnPlane { point: there, plane: point, normal, offset: value }
            } else {
                let normal = local(self, against, d);
                ConstraintKind::PointOnPlane { point, plane: there, normal, offset: value }
            }
        };
        let first = out.constraints.len();
        self.push(out, header, "", kind, None);
        self.record_header_origins(header, "", out, first);
    }

    fn remove_element(&mut self, given: &sidecar::Element, header: &Header, out: &mut Joints) {
        let at = header.at;
        let Some(of) = &given.of else {
            let message = format!("element \"{}\" frees nothing: `of` is missing", header.name);
            self.report(at, Diagnostic::new(codes::MISSING_KEY, message).help("of = \"axle\" names a constraint"));
            return;
        };
        if header.schedule.trigger.is_some() || header.breaking.is_some() {
            let message = format!("element \"{}\" can have windows, but no trigger and no break", header.name);
            let help = "leave trigger and break out; the constraint itself can have them";
            self.report(at, Diagnostic::new(codes::WINDOW, message).help(help));
            return;
        }
        let Some(found) = self.named(of, at, out) else { return };
        let body = ends(&out.constraints[found[0]].kind).and_then(|(a, _)| a.body);
        let Some((axes, carrier)) = self.frame(&given.frame, body, header) else { return };
        let (index, turn) = axis_of(given.dof);
        let row = if turn {
            self.turn_row(&found, axes.col(index), out)
        } else {
            self.split_point(&found, axes, index, carrier, out)
        };
        let Some(row) = row else {
            let dof = format!("{:?}", given.dof).to_lowercase();
            let message = format!("\"{of}\" does not constrain {dof} by a row of its own");
            let help = "choose a frame with an axis along the freedom; `soffio explain` shows the rows";
            self.report(&format!("{at}/dof"), Diagnostic::new(codes::NOT_HELD, message).help(help));
            return;
        };
        let freed = &mut out.constraints[row];
        let both = freed.schedule.period.zip(header.schedule.period).is_some_and(|(a, b)| a != b);
        if both || (freed.schedule.period.is_some() != header.schedule.period.is_some() && !freed.schedule.is_always())
        {
            let message = format!("the windows of \"{}\" and of \"{}\" repeat differently", header.name, freed.name);
            let help = "give both the same period, or only the element";
            self.report(&format!("{at}/period"), Diagnostic::new(codes::WINDOW, message).help(help));
            return;
        }
        freed.schedule = freed.schedule.without(&header.schedule);
        let (name, windows) = (freed.name.clone(), freed.schedule.windows.clone());
        let spans = windows.iter().map(|w| format!("{} to {} s", w.start, w.end)).collect::<Vec<_>>().join(", ");
        let source = format!("without element {}", header.name);
        self.record_origin(&format!("constraint {name}"), "window", spans, "/-", &source);
        self.record_origin(&format!("constraint {}", header.name), "frees", name, at, "");
        self.record_timing_origins(&format!("constraint {}", header.name), header);
    }

    /// The orientation row that constrains the rotation about `d`.
    fn turn_row(&self, found: &[usize], d: DVec3, out: &Joints) -> Option<usize> {
        let along = |&i: &usize| match &out.constraints[i].kind {
            ConstraintKind::Orientation { a, b, .. } => {
                let (t, n) = (self.pose_of(a.body).vector(a.direction), self.pose_of(b.body).vector(b.direction));
                t.cross(n).normalize_or_zero().dot(d).abs()
            }
            _ => 0.0,
        };
        found.iter().copied().find(|i| along(i) > ALONG)
    }

    /// The plane that constrains the translation along axis `index`; a point constraint is split into three planes for
    /// it.
    fn split_point(
        &mut self,
        found: &[usize],
        axes: DMat3,
        index: usize,
        carrier: Option<usize>,
        out: &mut Joints,
    ) -> Option<usize> {
        let d = axes.col(index);
        let plane = found.iter().copied().find(|&i| match &out.constraints[i].kind {
            ConstraintKind::PointOnPlane { plane, normal, .. } => {
                self.pose_of(plane.body).vector(*normal).dot(d).abs() > ALONG
            }
            _ => false,
        });
        if plane.is_some() {
            return plane;
        }
        let point =
            found.iter().copied().find(|&i| matches!(out.constraints[i].kind, ConstraintKind::PointToPoint { .. }))?;
        let whole = out.constraints[point].clone();
        let ConstraintKind::PointToPoint { a, b } = whole.kind else { return None };
        // The planes move with the frame's own body where it is one of the two, else with the second.
        let (held, carrying) = if carrier == a.body { (b, a) } else { (a, b) };
        let parts = ["tx", "ty", "tz"].into_iter().enumerate().map(|(k, part)| {
            let normal = self.pose_of(carrying.body).inverse_vector(axes.col(k));
            let kind =
                ConstraintKind::PointOnPlane { point: held, plane: carrying, normal, offset: Function::default() };
            // Friction belongs to the pivot, not to each of its planes.
            let friction = whole.friction.filter(|_| k == 0);
            Constraint { name: format!("{}/{part}", whole.name), kind, friction, ..whole.clone() }
        });
        let parts: Vec<Constraint> = parts.collect();
        let source = format!("split from {}", whole.name);
        for part in &parts {
            let shown = self.shown(&part.kind);
            self.record_origin(&format!("constraint {}", part.name), "holds", shown, "/-", &source);
        }
        out.constraints.splice(point..=point, parts);
        Some(point + index)
    }
}

/// The two anchors of a constraint.
fn ends(kind: &ConstraintKind) -> Option<(Anchor, Anchor)> {
    let origin = |body| Anchor { body, point: DVec3::ZERO };
    match kind {
        ConstraintKind::PointToPoint { a, b } => Some((*a, *b)),
        ConstraintKind::PointOnPlane { point, plane, .. } => Some((*point, *plane)),
        ConstraintKind::Orientation { a, b, .. } => Some((origin(a.body), origin(b.body))),
        ConstraintKind::Coupling { .. } => None,
    }
}

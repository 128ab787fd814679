//! Combined joints, expanded into basic constraints.
//!
//! With h the axis of the first body and (t₁, t₂, h) a right-handed frame fixed in the second in the model:
//!
//! ```text
//! hinge, windmill   point                    h ⟂ t₁   h ⟂ t₂
//! universal         point                    h ⟂ k              k the second body's axis of the cross
//! slider            planes ⟂ t₁, t₂          h ⟂ t₁   h ⟂ t₂   t₁ ⟂ t₂
//! line              planes ⟂ t₁, t₂          about the line's direction
//! weld              point                    x ⟂ y    y ⟂ z    z ⟂ x
//! ```

use super::super::super::codes;
use super::super::super::diagnostic::Diagnostic;
use super::super::super::sidecar::{self, Point, Target};
use super::super::context::Context;
use super::{Header, Joints};
use soffio_math::Function;
use soffio_math::{DVec3, tangents};
use soffio_multibody::articulation::{Anchor, Axis, ConstraintKind, Limit, LimitKind, Measure};

impl Context<'_> {
    pub(super) fn hinge(&mut self, given: &sidecar::Hinge, point: &str, at: &str, out: &mut Joints) {
        let header = self.header(&given.name, &given.timing, at, out);
        let Some((a, b)) = self.pivot(&given.body, given.at.as_ref(), given.to.as_ref(), &header) else { return };
        let Some(axis) = self.own_axis(&given.body, given.axis, &header) else { return };
        let (friction, first) = (self.friction(given.friction, at), out.constraints.len());
        self.push(out, &header, point, ConstraintKind::PointToPoint { a, b }, friction);
        self.across(out, &header, axis, b.body);
        self.record_header_origins(&header, if point == "nail" { "hinge" } else { "windmill" }, out, first);
        let measure = Measure::Angle { axis, frame: b.body };
        if let Some(stops) = given.limit {
            let range = (stops.min.map(|x| x.0), stops.max.map(|x| x.0), stops.restitution);
            self.stops(out, &header, measure, range);
        }
        out.free.push((given.name.clone(), measure));
    }

    pub(super) fn universal(&mut self, given: &sidecar::Universal, at: &str, out: &mut Joints) {
        let header = self.header(&given.name, &given.timing, at, out);
        let Some((a, b)) = self.pivot(&given.body, given.at.as_ref(), given.to.as_ref(), &header) else { return };
        let Some(axis) = self.own_axis(&given.body, given.axis, &header) else { return };
        let Some(other) = self.target_axis(given.to.as_ref(), given.other_axis, b, "other_axis", &header) else {
            return;
        };
        let (friction, first) = (self.friction(given.friction, at), out.constraints.len());
        self.push(out, &header, "nail", ConstraintKind::PointToPoint { a, b }, friction);
        self.push(out, &header, "cross", perpendicular(axis, other), None);
        self.record_header_origins(&header, "universal", out, first);
    }

    pub(super) fn slider(&mut self, given: &sidecar::Slider, at: &str, out: &mut Joints) {
        let header = self.header(&given.name, &given.timing, at, out);
        let Some((a, b)) = self.pivot(&given.body, given.at.as_ref(), given.to.as_ref(), &header) else { return };
        let Some(axis) = self.own_axis(&given.body, given.axis, &header) else { return };
        let first = out.constraints.len();
        let direction_world = self.pose_of(a.body).vector(axis.direction);
        self.planes(out, &header, (a, b), direction_world);
        self.across(out, &header, axis, b.body);
        let (t, n) = tangents(direction_world);
        let fixed = |this: &Self, body, v| Axis { body, direction: this.pose_of(body).inverse_vector(v) };
        let about = perpendicular(fixed(self, a.body, t), fixed(self, b.body, n));
        self.push(out, &header, "about", about, None);
        self.record_header_origins(&header, "slider", out, first);
        let measure = Measure::Displacement { point: a, direction: fixed(self, b.body, direction_world) };
        if let Some(stops) = given.limit {
            let range = (stops.min.map(|x| x.0), stops.max.map(|x| x.0), stops.restitution);
            self.stops(out, &header, measure, range);
        }
        out.free.push((given.name.clone(), measure));
    }

    pub(super) fn line(&mut self, given: &sidecar::Line, at: &str, out: &mut Joints) {
        let header = self.header(&given.name, &given.timing, at, out);
        let Some((a, b)) = self.pivot(&given.body, given.at.as_ref(), given.to.as_ref(), &header) else { return };
        let Some(axis) = self.target_axis(given.to.as_ref(), given.direction, b, "direction", &header) else { return };
        let first = out.constraints.len();
        let direction_world = self.pose_of(axis.body).vector(axis.direction);
        self.planes(out, &header, (a, b), direction_world);
        self.record_header_origins(&header, "line", out, first);
    }

    pub(super) fn weld(&mut self, given: &sidecar::Weld, at: &str, out: &mut Joints) {
        let header = self.header(&given.name, &given.timing, at, out);
        let Some((a, b)) = self.pivot(&given.body, given.at.as_ref(), given.to.as_ref(), &header) else { return };
        let first = out.constraints.len();
        self.push(out, &header, "nail", ConstraintKind::PointToPoint { a, b }, None);
        for (part, [t, n]) in
            [("about-z", [DVec3::X, DVec3::Y]), ("about-x", [DVec3::Y, DVec3::Z]), ("about-y", [DVec3::Z, DVec3::X])]
        {
            let fixed = |body, v| Axis { body, direction: self.pose_of(body).inverse_vector(v) };
            let kind = perpendicular(fixed(a.body, t), fixed(b.body, n));
            self.push(out, &header, part, kind, None);
        }
        self.record_header_origins(&header, "weld", out, first);
    }

    /// The point of the body and its counterpart; `None` where a problem was reported.
    fn pivot(
        &mut self,
        body: &str,
        point: Option<&Point>,
        to: Option<&Target>,
        header: &Header,
    ) -> Option<(Anchor, Anchor)> {
        let a = self.point_of(body, point, header.at, header.name);
        let b = match to {
            Some(to) => self.target(to, &format!("{}/to", header.at), header.name),
            None => a.map(|a| Anchor { body: None, point: self.reference_position(&a) }),
        };
        let (a, b) = a.zip(b)?;
        self.joinable(a.body, b.body, header.name, header.at).then_some((a, b))
    }

    fn own_axis(&mut self, body: &str, axis: [f64; 3], header: &Header) -> Option<Axis> {
        let places = (format!("{}/body", header.at), format!("{}/axis", header.at));
        self.body_axis(body, axis, &places.0, &places.1, header.name)
    }

    /// A direction in the space of the target's node, fixed in the body that the node belongs to.
    fn target_axis(
        &mut self,
        to: Option<&Target>,
        direction: [f64; 3],
        carrier: Anchor,
        key: &str,
        header: &Header,
    ) -> Option<Axis> {
        let place = format!("{}/{key}", header.at);
        match self.target_node(to, &format!("{}/to", header.at), header.name) {
            Some(node) => self.axis(node, direction, &place),
            None => {
                let world = self.unit(DVec3::from(direction), &place)?;
                let direction = self.pose_of(carrier.body).inverse_vector(world);
                Some(Axis { body: carrier.body, direction })
            }
        }
    }

    /// Two orientations that keep `axis` in its model direction relative to `other`.
    fn across(&mut self, out: &mut Joints, header: &Header, axis: Axis, other: Option<usize>) {
        let (t, n) = tangents(self.pose_of(axis.body).vector(axis.direction));
        for (part, direction) in [("across-1", t), ("across-2", n)] {
            let b = Axis { body: other, direction: self.pose_of(other).inverse_vector(direction) };
            self.push(out, header, part, perpendicular(axis, b), None);
        }
    }

    /// Two planes through `b` along `direction_world` (world, in the model) that keep `a` on a line.
    fn planes(&mut self, out: &mut Joints, header: &Header, (a, b): (Anchor, Anchor), direction_world: DVec3) {
        let (t, n) = tangents(direction_world);
        for (part, normal) in [("plane-1", t), ("plane-2", n)] {
            let normal = self.pose_of(b.body).inverse_vector(normal);
            let kind = ConstraintKind::PointOnPlane { point: a, plane: b, normal, offset: Function::default() };
            self.push(out, header, part, kind, None);
        }
    }

    /// Adds the stops of a hinge or slider: (least, greatest, restitution).
    fn stops(
        &mut self,
        out: &mut Joints,
        header: &Header,
        measure: Measure,
        (min, max, restitution): (Option<f64>, Option<f64>, f64),
    ) {
        let place = format!("{}/limit", header.at);
        let (min, max) = (min.unwrap_or(f64::NEG_INFINITY), max.unwrap_or(f64::INFINITY));
        if !self.check_range((min, max), Some(0.0), &place, header.name) {
            return;
        }
        let shown = super::limits::range_shown(&measure, min, max);
        self.record_origin(&format!("constraint {}", header.name), "limit", shown, &place, "");
        let kind = LimitKind::Range { measure, min, max };
        out.limits.push(Limit { name: header.name.to_owned(), kind, restitution });
    }

    /// Reports a range that is empty, infinite, or does not contain its start.
    pub(super) fn check_range(&mut self, (min, max): (f64, f64), start: Option<f64>, at: &str, name: &str) -> bool {
        let problem = if min == f64::NEG_INFINITY && max == f64::INFINITY {
            (codes::MISSING_KEY, format!("\"{name}\" has no bounds"), "give min, max, or both")
        } else if min >= max {
            (codes::RANGE, format!("the bounds of \"{name}\" are empty: {min} to {max}"), "min must be below max")
        } else if start.is_some_and(|start| start < min || start > max) {
            let help = "rotations and displacements count from the start, where they are 0";
            (codes::RANGE, format!("\"{name}\" starts outside its bounds {min} to {max}"), help)
        } else {
            return true;
        };
        self.report(at, Diagnostic::new(problem.0, problem.1).help(problem.2));
        false
    }
}

/// T ⟂ N: the two axes stay perpendicular.
pub(super) fn perpendicular(a: Axis, b: Axis) -> ConstraintKind {
    ConstraintKind::Orientation { a, b, angle: Function::default() }
}

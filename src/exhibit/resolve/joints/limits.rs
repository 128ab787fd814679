//! Resolves limits: tilts, stops, distances, ratchets.

use super::super::super::codes;
use super::super::super::diagnostic::Diagnostic;
use super::super::super::sidecar::{self, Travel};
use super::super::context::Context;
use super::Joints;
use soffio_math::{DVec3, PI, cos};
use soffio_multibody::articulation::{Anchor, Axis, Limit, LimitKind, Measure};

const DEGREES: f64 = 180.0 / PI;

/// A range as text.
pub(super) fn range_shown(measure: &Measure, min: f64, max: f64) -> String {
    match measure {
        Measure::Angle { .. } => format!("{:.2}° to {:.2}°", min * DEGREES, max * DEGREES),
        Measure::Displacement { .. } => format!("{min} to {max} m"),
    }
}

impl Context<'_> {
    /// The tilt limit that a point, nail or orientation carries.
    pub(super) fn tilt_limit(
        &mut self,
        limit: &sidecar::Tilt,
        first: &str,
        second: Option<usize>,
        at: &str,
        name: &str,
    ) -> Option<Limit> {
        let a = self.body_axis(first, limit.axis, at, &format!("{at}/axis"), name)?;
        let b = if limit.world_axis.is_none() && limit.other.is_none() {
            self.pointing(a, second)
        } else {
            self.second_axis(limit.world_axis, limit.other.as_ref(), at, name)?
        };
        self.tilt(name, a, b, limit.max.0, limit.restitution, at)
    }

    /// The axis in its model direction, fixed in another body.
    fn pointing(&self, axis: Axis, other: Option<usize>) -> Axis {
        let world = self.pose_of(axis.body).vector(axis.direction);
        Axis { body: other, direction: self.pose_of(other).inverse_vector(world) }
    }

    fn tilt(&mut self, name: &str, a: Axis, b: Axis, max: f64, restitution: f64, at: &str) -> Option<Limit> {
        if !(max > 0.0 && max < PI) {
            let message = format!("a tilt limit of {:.1}° is out of range", max * DEGREES);
            let problem = Diagnostic::new(codes::RANGE, message);
            self.report(&format!("{at}/max"), problem.help("give an angle between 0 and 180 deg"));
            return None;
        }
        let (u, v) = (self.start_of(a.body).vector(a.direction), self.start_of(b.body).vector(b.direction));
        if u.dot(v) < cos(max) && !self.assembles() {
            let message = format!("constraint \"{name}\" exceeds its tilt limit at the start");
            let problem = Diagnostic::new(codes::RANGE, message);
            self.report(&format!("{at}/max"), problem.help("reverse the axis, or allow more"));
        }
        self.record_origin(&format!("constraint {name}"), "limit", format!("{:.2}°", max * DEGREES), at, "");
        Some(Limit { name: name.to_owned(), kind: LimitKind::Tilt { a, b, max }, restitution })
    }

    pub(super) fn bounds(&mut self, given: &sidecar::Bounds, at: &str, out: &mut Joints) {
        self.name(&given.name, at, out);
        self.enable(&given.name, given.enabled, at, out);
        let name = &given.name;
        if let Some(of) = &given.of {
            if let Some(measure) = self.free_measure(of, &format!("{at}/of"), out) {
                self.range(given, measure, at, out);
            }
            return;
        }
        let a = given.a.as_ref().and_then(|a| self.attachment(a, &format!("{at}/a"), name));
        let b = match &given.b {
            Some(b) => self.attachment(b, &format!("{at}/b"), name),
            None => Some(Anchor { body: None, point: DVec3::ZERO }),
        };
        let (Some(a), Some(b)) = (a, b) else {
            if given.a.is_none() {
                let problem = Diagnostic::new(codes::MISSING_KEY, format!("limit \"{name}\" needs of, or a"));
                self.report(at, problem.help("of = \"arbor\" bounds a hinge or slider; a and b two bodies"));
            }
            return;
        };
        if !self.joinable(a.body, b.body, name, at) {
            return;
        }
        let node = given.a.as_ref().map_or("", |a| a.node.as_str());
        match (given.axis, given.direction) {
            (Some(axis), None) => {
                let place = format!("{at}/axis");
                let Some(axis) = self.body_axis(node, axis, &format!("{at}/a/node"), &place, name) else { return };
                if given.tilt {
                    let max = self.bound(given.max, f64::INFINITY, true, &format!("{at}/max"), name);
                    let Some(max) = max else { return };
                    let limit = self.tilt(name, axis, self.pointing(axis, b.body), max, given.restitution, at);
                    out.limits.extend(limit);
                } else {
                    self.range(given, Measure::Angle { axis, frame: b.body }, at, out);
                }
            }
            (None, Some(direction)) => {
                let place = format!("{at}/direction");
                let direction = match &given.b {
                    Some(b) => self.body_axis(&b.node, direction, &format!("{at}/b/node"), &place, name),
                    None => {
                        let unit = self.unit(DVec3::from(direction), &place);
                        unit.map(|direction| Axis { body: None, direction })
                    }
                };
                let Some(direction) = direction else { return };
                self.range(given, Measure::Displacement { point: a, direction }, at, out);
            }
            (None, None) => self.distance(given, a, b, at, out),
            (Some(_), Some(_)) => {
                let problem =
                    Diagnostic::new(codes::WRONG_SHAPE, format!("limit \"{name}\" has an axis and a direction"));
                self.report(
                    at,
                    problem.help("an axis bounds a rotation, a direction a displacement; give one of them"),
                );
            }
        }
    }

    fn range(&mut self, given: &sidecar::Bounds, measure: Measure, at: &str, out: &mut Joints) {
        let turn = matches!(measure, Measure::Angle { .. });
        let min = self.bound(given.min, f64::NEG_INFINITY, turn, &format!("{at}/min"), &given.name);
        let max = self.bound(given.max, f64::INFINITY, turn, &format!("{at}/max"), &given.name);
        let (Some(min), Some(max)) = (min, max) else { return };
        if self.check_range((min, max), Some(0.0), at, &given.name) {
            let shown = format!("{}: {}", self.shown_measure(&measure), range_shown(&measure, min, max));
            self.record_origin(&format!("limit {}", given.name), "bounds", shown, at, "");
            let kind = LimitKind::Range { measure, min, max };
            out.limits.push(Limit { name: given.name.clone(), kind, restitution: given.restitution });
        }
    }

    fn distance(&mut self, given: &sidecar::Bounds, a: Anchor, b: Anchor, at: &str, out: &mut Joints) {
        let min = self.bound(given.min, 0.0, false, &format!("{at}/min"), &given.name);
        let max = self.bound(given.max, f64::INFINITY, false, &format!("{at}/max"), &given.name);
        let (Some(min), Some(max)) = (min, max) else { return };
        let min = self.not_negative(min, &format!("{at}/min"));
        let least = if min == 0.0 { f64::NEG_INFINITY } else { min };
        if !self.check_range((least, max), None, at, &given.name) {
            return;
        }
        // A cord drawn taut in the model can be slightly too long.
        let slack = super::checks::APART;
        let length = self.start_position(&a).distance(self.start_position(&b));
        if !self.assembles() && !(min - slack..=max + slack).contains(&length) {
            let message = format!("the points of \"{}\" are {length:.4} m apart, outside {min} to {max} m", given.name);
            let help = "move one of the two nodes, or the bounds";
            self.report(at, Diagnostic::new(codes::RANGE, message).help(help));
        }
        let shown = format!("distance {min} to {max} m ({length:.6} m at the start)");
        self.record_origin(&format!("limit {}", given.name), "bounds", shown, at, "");
        let kind = LimitKind::Distance { a, b, min, max };
        out.limits.push(Limit { name: given.name.clone(), kind, restitution: given.restitution });
    }

    /// A bound of a rotation or a displacement; reports a length in place of an angle, and the reverse.
    pub(super) fn bound(
        &mut self,
        given: Option<Travel>,
        otherwise: f64,
        turn: bool,
        at: &str,
        name: &str,
    ) -> Option<f64> {
        match given {
            None => Some(otherwise),
            Some(Travel::Bare(value)) => Some(value),
            Some(Travel::Turn(angle)) if turn => Some(angle.0),
            Some(Travel::Way(way)) if !turn => Some(way.0),
            Some(_) => {
                let (is, wanted) = if turn { ("a length", "an angle") } else { ("an angle", "a length") };
                let message = format!("\"{name}\" is bounded by {is}, but needs {wanted}");
                let help = if turn { "write it as \"12 deg\"" } else { "write it as \"12 mm\"" };
                self.report(at, Diagnostic::new(codes::WRONG_TYPE, message).help(help));
                None
            }
        }
    }

    pub(super) fn ratchet(&mut self, given: &sidecar::Ratchet, at: &str, out: &mut Joints) {
        self.name(&given.name, at, out);
        self.enable(&given.name, given.enabled, at, out);
        let Some(mut measure) = self.turn(&given.axle, &given.name, at, out) else { return };
        if given.reverse {
            match &mut measure {
                Measure::Angle { axis, .. } => axis.direction = -axis.direction,
                Measure::Displacement { direction, .. } => direction.direction = -direction.direction,
            }
        }
        let is_turn = matches!(measure, Measure::Angle { .. });
        let pitch = match (given.teeth, given.pitch) {
            (Some(teeth), None) if is_turn => 2.0 * PI / f64::from(teeth),
            (Some(_), _) => {
                let problem =
                    Diagnostic::new(codes::WRONG_SHAPE, format!("ratchet \"{}\" needs its pitch", given.name));
                self.report(at, problem.help("give a wheel either teeth or a pitch, and a rack a pitch"));
                return;
            }
            (None, pitch) => {
                let place = format!("{at}/pitch");
                let Some(pitch) = self.bound(pitch, 0.0, is_turn, &place, &given.name) else { return };
                self.not_negative(pitch, &place)
            }
        };
        let shown =
            format!("{} grows; pitch {pitch} {}", self.shown_measure(&measure), if is_turn { "rad" } else { "m" });
        self.record_origin(&format!("limit {}", given.name), "ratchet", shown, at, "");
        let kind = LimitKind::Ratchet { measure, pitch };
        out.limits.push(Limit { name: given.name.clone(), kind, restitution: 0.0 });
    }

    /// The rotation or displacement that `of` names, or the rotation of a body about an axis of a frame.
    pub(super) fn turn(&mut self, axle: &sidecar::Axle, name: &str, at: &str, out: &Joints) -> Option<Measure> {
        match (&axle.of, &axle.body, axle.axis) {
            (Some(of), None, None) => self.free_measure(of, &format!("{at}/of"), out),
            (None, Some(body), Some(axis)) => {
                let axis = self.body_axis(body, axis, &format!("{at}/body"), &format!("{at}/axis"), name)?;
                let frame = self.carrier(axle.frame.as_ref(), at, name)?;
                self.joinable(axis.body, frame, name, at).then_some(Measure::Angle { axis, frame })
            }
            _ => {
                let message = format!("\"{name}\" needs of, or body and axis");
                let help = "of = \"arbor\" names a hinge or slider";
                self.report(at, Diagnostic::new(codes::MISSING_KEY, message).help(help));
                None
            }
        }
    }
}

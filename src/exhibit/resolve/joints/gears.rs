//! Resolves gears and drums with cords, and checks whether gear trains can turn.
//!
//! Two wheels on parallel axles obey r₁ φ₁ ± r₂ φ₂ = const, with + where they rotate oppositely (external teeth, axes
//! that point the same way). Around a ring of gears the ratios must multiply to 1.

use super::super::super::codes;
use super::super::super::diagnostic::Diagnostic;
use super::super::super::sidecar::{self, Wheel};
use super::super::context::Context;
use super::{Header, Joints};
use soffio_math::DVec3;
use soffio_multibody::articulation::{Axis, Constraint, ConstraintKind, Limit, LimitKind, Measure, Term};

/// Axles that are further than this from parallel (cosine) are bevel gears, which are not checked.
const PARALLEL: f64 = 0.99;
/// Tolerance of the radii, as a fraction of the axles' distance: gears have some play.
const PLAY: f64 = 0.02;
/// Components below this are rounding of a single-precision file.
const UPRIGHT: f64 = 1e-3;
/// Tolerance of the ratio around a ring: tooth counts are exact, radii are typed with a few digits.
const RATIO: f64 = 1e-6;

impl Context<'_> {
    pub(super) fn gear(&mut self, given: &sidecar::Gear, at: &str, out: &mut Joints) {
        let header = self.header(&given.name, &given.timing, at, out);
        let frame = self.carrier(given.frame.as_ref(), at, &given.name);
        let a = self.wheel(&given.a, &format!("{at}/a"), &given.name);
        let b = self.wheel(&given.b, &format!("{at}/b"), &given.name);
        let (Some(frame), Some((a, size_a, teeth_a)), Some((b, size_b, teeth_b))) = (frame, a, b) else { return };
        if teeth_a != teeth_b {
            let message = format!("gear \"{}\" has teeth on one side and a radius on the other", given.name);
            let problem = Diagnostic::new(codes::WRONG_SHAPE, message);
            self.report(at, problem.help("give both by teeth, or both by radius"));
            return;
        }
        if !self.joinable(a.body, b.body, &given.name, at) {
            return;
        }
        let (u, v) = (self.pose_of(a.body).vector(a.direction), self.pose_of(b.body).vector(b.direction));
        let cosine = u.dot(v);
        let opposed = if cosine < -PARALLEL { -1.0 } else { 1.0 };
        let sense = if given.internal { -opposed } else { opposed };
        let term = |axis, coefficient| Term { measure: Measure::Angle { axis, frame }, coefficient };
        let place = format!("{at}/backlash");
        let Some(play) = self.bound(given.backlash, 0.0, teeth_a, &place, &given.name) else { return };
        if self.not_negative(play, &place) > 0.0 {
            // An angle of wheel b where sizes are teeth, a length on the pitch circle where they are radii.
            let unit = if teeth_a { size_b } else { 1.0 };
            let terms = [term(a, size_a / unit), term(b, sense * size_b / unit)];
            self.loose_gear(&header, LimitKind::Play { terms, play }, out);
        } else {
            let kind = ConstraintKind::Coupling { terms: vec![term(a, size_a), term(b, sense * size_b)] };
            let first = out.constraints.len();
            self.push(out, &header, "", kind, None);
            self.record_header_origins(&header, "", out, first);
        }
        if !teeth_a && cosine.abs() > PARALLEL {
            let wanted = if given.internal { (size_a - size_b).abs() } else { size_a + size_b };
            self.check_distance((a.body, b.body), u, wanted, &given.name, at, out);
        }
    }

    /// A gear with backlash: its teeth touch on either flank, without bounce.
    fn loose_gear(&mut self, header: &Header, kind: LimitKind, out: &mut Joints) {
        let Header { name, at, .. } = header;
        if !header.schedule.is_always() || header.breaking.is_some() || header.stabilization_time.is_some() {
            let message = format!("gear \"{name}\" has backlash together with a window, trigger, break or stabilize");
            let help =
                "a gear with backlash is always active: leave out backlash, or window, trigger, break and stabilize";
            self.report(at, Diagnostic::new(codes::WRONG_SHAPE, message).help(help));
            return;
        }
        if let LimitKind::Play { terms: [a, b], play } = &kind {
            let [one, other] = [a, b].map(|t| format!("{} · {}", t.coefficient, self.shown_measure(&t.measure)));
            let shown = format!("{one} + {other} within ± {}", 0.5 * play);
            self.record_origin(&format!("constraint {name}"), "holds", shown, at, "");
        }
        out.limits.push(Limit { name: (*name).to_owned(), kind, restitution: 0.0 });
    }

    /// The axle of a wheel, its size, and whether that is a number of teeth.
    fn wheel(&mut self, given: &Wheel, at: &str, name: &str) -> Option<(Axis, f64, bool)> {
        let axis = self.body_axis(&given.body, given.axis, &format!("{at}/body"), &format!("{at}/axis"), name)?;
        match (given.teeth, given.radius) {
            (Some(teeth), None) => Some((axis, f64::from(teeth), true)),
            (None, Some(radius)) => Some((axis, self.positive(radius.0, &format!("{at}/radius")), false)),
            _ => {
                let message = format!("a wheel of \"{name}\" needs either teeth or a radius");
                self.report(at, Diagnostic::new(codes::MISSING_KEY, message).help("add teeth = 42"));
                None
            }
        }
    }

    /// Warns where the distance of two axles along `along` does not match the radii.
    fn check_distance(
        &mut self,
        (a, b): (Option<usize>, Option<usize>),
        along: DVec3,
        wanted: f64,
        name: &str,
        at: &str,
        out: &Joints,
    ) {
        // A wheel rotates about its constrained point, else about its own origin.
        let place = |body: Option<usize>| {
            let held = out.constraints.iter().find_map(|c| match &c.kind {
                ConstraintKind::PointToPoint { a, .. } if a.body == body => Some(*a),
                ConstraintKind::PointToPoint { b, .. } if b.body == body => Some(*b),
                _ => None,
            });
            held.map_or(self.pose_of(body).position, |anchor| self.reference_position(&anchor))
        };
        let distance = (place(a) - place(b)).reject_from_normalized(along).length();
        if (distance - wanted).abs() > PLAY * wanted.max(distance) {
            let (is, should) = (distance * 1e3, wanted * 1e3);
            let message = format!("the axles of \"{name}\" are {is:.2} mm apart, but its radii require {should:.2} mm");
            let help = "the wheels overlap or do not touch; they still turn together";
            self.report(at, Diagnostic::new(codes::GEAR_DISTANCE, message).help(help));
        }
    }

    pub(super) fn clutch(&mut self, given: &sidecar::Clutch, at: &str, out: &mut Joints) {
        self.name(&given.name, at, out);
        self.enable(&given.name, given.enabled, at, out);
        let Some(measure) = self.turn(&given.axle, &given.name, at, out) else { return };
        let torque = self.positive(given.torque.0, &format!("{at}/torque"));
        if matches!(measure, Measure::Displacement { .. }) {
            let problem = Diagnostic::new(codes::WRONG_SHAPE, format!("clutch \"{}\" slides", given.name));
            self.report(at, problem.help("name a hinge, or a body, an axis and the frame it turns with"));
            return;
        }
        self.record_origin(&format!("constraint {}", given.name), "slips", format!("beyond {torque} N m"), at, "");
        let kind = ConstraintKind::Coupling { terms: vec![Term { measure, coefficient: 1.0 }] };
        out.constraints.push(Constraint { slips: Some(torque), ..Constraint::new(&given.name, kind) });
    }

    pub(super) fn gear_weight(&mut self, given: &sidecar::GearWeight, at: &str, out: &mut Joints) {
        let header = self.header(&given.name, &given.timing, at, out);
        let frame = self.carrier(given.frame.as_ref(), at, &given.name);
        let places = (format!("{at}/gear/body"), format!("{at}/gear/axis"));
        let axis = self.body_axis(&given.gear.body, given.gear.axis, &places.0, &places.1, &given.name);
        let point = self.point_of(&given.weight.body, given.weight.at.as_ref(), &format!("{at}/weight"), &given.name);
        let place = format!("{at}/weight/direction");
        let direction = match given.frame.as_ref() {
            None => self.unit(DVec3::from(given.weight.direction), &place).map(|d| Axis { body: None, direction: d }),
            Some(node) => self.body_axis(node, given.weight.direction, &format!("{at}/frame"), &place, &given.name),
        };
        let radius = self.positive(given.gear.radius.0, &format!("{at}/gear/radius"));
        let (Some(frame), Some(axis), Some(point), Some(direction)) = (frame, axis, point, direction) else { return };
        if !self.joinable(axis.body, point.body, &given.name, at) {
            return;
        }
        let terms = vec![
            Term { measure: Measure::Displacement { point, direction }, coefficient: f64::from(given.pulleys) },
            Term { measure: Measure::Angle { axis, frame }, coefficient: -radius },
        ];
        let first = out.constraints.len();
        self.push(out, &header, "", ConstraintKind::Coupling { terms }, None);
        self.record_header_origins(&header, "", out, first);
    }

    /// Reports rings of gears that cannot turn.
    pub(in super::super) fn check_gear_rings(&mut self, constraints: &[Constraint]) {
        // A wheel is a body about an axis: a body on two crossed axes is two wheels.
        let mut wheels: Vec<(usize, DVec3)> = Vec::new();
        let gears: Vec<Mesh> = constraints.iter().filter_map(|c| self.mesh(c, &mut wheels)).collect();
        // The trains so far, without rings: a gear whose wheels are in one train already closes a ring.
        let mut train: Vec<&Mesh> = Vec::new();
        for gear in &gears {
            let Some(path) = route(&train, gear.a, gear.b) else {
                train.push(gear);
                continue;
            };
            let turns = path.iter().map(|(_, ratio)| ratio).product::<f64>();
            let product = gear.ratio / turns;
            if (product - 1.0).abs() <= RATIO {
                continue;
            }
            let names: Vec<&str> =
                path.iter().map(|(gear, _)| gear.name.as_str()).chain([gear.name.as_str()]).collect();
            let message = format!("gear \"{}\" closes a ring that cannot turn: {}", gear.name, names.join(", "));
            let label = format!("around the ring, one turn becomes {product:.6} turns");
            let help = "the product of all ratios must be 1; an odd ring of external gears always jams";
            let place = self.place(&gear.name);
            self.report(&place, Diagnostic::new(codes::GEAR_RING, message).label(label).help(help));
        }
    }

    /// A constraint as two meshing wheels; `None` where it is none.
    fn mesh(&self, constraint: &Constraint, wheels: &mut Vec<(usize, DVec3)>) -> Option<Mesh> {
        let ConstraintKind::Coupling { terms } = &constraint.kind else { return None };
        let [a, b] = terms.as_slice() else { return None };
        let (Measure::Angle { axis: u, frame: f }, Measure::Angle { axis: v, frame: g }) = (&a.measure, &b.measure)
        else {
            return None;
        };
        // Rotations are comparable where both wheels of every gear rotate about parallel axles of one frame.
        let axis_world = |axis: &Axis| self.pose_of(axis.body).vector(axis.direction);
        let sense = axis_world(u).dot(axis_world(v));
        if f != g || sense.abs() < PARALLEL {
            return None;
        }
        // Right-handed about one direction for all: a·dφ_a + b·dφ_b = 0.
        let upright = |axis: &Axis| {
            let w = axis_world(axis);
            w.to_array().into_iter().find(|x| x.abs() > UPRIGHT).unwrap_or(1.0).signum()
        };
        let ratio = -(a.coefficient * upright(u)) / (b.coefficient * upright(v));
        let mut wheel = |axis: &Axis| {
            let (body, along) = (axis.body?, axis_world(axis));
            let known = wheels.iter().position(|(b, w)| *b == body && w.dot(along).abs() > PARALLEL);
            Some(known.unwrap_or_else(|| {
                wheels.push((body, along));
                wheels.len() - 1
            }))
        };
        Some(Mesh { name: constraint.name.clone(), a: wheel(u)?, b: wheel(v)?, ratio })
    }
}

/// The gears from one wheel to another, each with its transmission ratio.
fn route<'m>(train: &[&'m Mesh], from: usize, to: usize) -> Option<Vec<(&'m Mesh, f64)>> {
    let mut waiting = vec![(from, Vec::<(&Mesh, f64)>::new())];
    while let Some((here, path)) = waiting.pop() {
        if here == to {
            return Some(path);
        }
        for &gear in train {
            let back = path.last().is_some_and(|(last, _)| std::ptr::eq(*last, gear));
            if let Some((there, ratio)) = gear.across(here).filter(|_| !back) {
                waiting.push((there, path.iter().copied().chain([(gear, ratio)]).collect()));
            }
        }
    }
    None
}

/// Two meshing wheels (by their numbers): `ratio` turns of b for one of a.
struct Mesh {
    name: String,
    a: usize,
    b: usize,
    ratio: f64,
}

impl Mesh {
    /// The other wheel, and its turns for one turn of this one.
    fn across(&self, from: usize) -> Option<(usize, f64)> {
        if from == self.a {
            Some((self.b, self.ratio))
        } else if from == self.b {
            Some((self.a, 1.0 / self.ratio))
        } else {
            None
        }
    }
}

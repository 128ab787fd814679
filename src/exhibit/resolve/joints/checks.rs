//! Checks of constraints: are they closed at the start, and can they be solved accurately?

use super::super::super::bodies::Body;
use super::super::super::codes;
use super::super::super::diagnostic::Diagnostic;
use super::super::bodies::meters;
use super::super::context::Context;
use soffio_math::PI;
use soffio_multibody::articulation::{Constraint, ConstraintKind};
use soffio_multibody::dynamics::KinematicBody;

/// Largest gap of a joint at the start, m: single-precision files of a few metres, and manual drawing.
pub(super) const APART: f64 = 1e-4;
/// Largest deviation of an orientation at the start: 0.1°.
const OBLIQUE: f64 = 0.1 * PI / 180.0;
/// Ratio of two joined masses above which precision runs short: f64 has 16 digits, the solver keeps 10.
const MASS_RATIO: f64 = 1e6;

impl Context<'_> {
    /// Reports a constraint that is open at the start and would be torn closed in the first step; an exhibit with
    /// `assemble` may start so.
    pub(super) fn check_rest(&mut self, kind: &ConstraintKind, name: &str, at: &str) {
        if self.assembles() {
            return;
        }
        match kind {
            ConstraintKind::PointToPoint { a, b } => {
                let (p, q) = (self.start_position(a), self.start_position(b));
                self.check_gap(p.distance(q), &format!("the two points of \"{name}\""), at, || {
                    format!("{} and {}", meters(p), meters(q))
                });
            }
            ConstraintKind::PointOnPlane { point, plane, normal, offset } => {
                let (p, s) = (self.start_position(point), self.start_position(plane));
                let height = self.start_of(plane.body).vector(*normal).dot(p - s);
                let wanted = offset.at(0.0).value;
                self.check_gap((height - wanted).abs(), &format!("the point and the plane of \"{name}\""), at, || {
                    format!(
                        "the point is {:.3} mm above the plane, but must be at {:.3} mm",
                        height * 1e3,
                        wanted * 1e3
                    )
                });
            }
            ConstraintKind::Orientation { a, b, angle } => {
                let (t, n) = (self.start_of(a.body).vector(a.direction), self.start_of(b.body).vector(b.direction));
                let off = soffio_math::asin(t.dot(n).clamp(-1.0, 1.0)) - angle.at(0.0).value;
                if off.abs() > OBLIQUE {
                    let degrees = off.abs() * 180.0 / PI;
                    let message = format!("the two axes of \"{name}\" are {degrees:.2}° from their angle at the start");
                    let problem = Diagnostic::new(codes::NOT_PERPENDICULAR, message);
                    let problem = problem.label(format!("{t} and {n} in the world"));
                    self.report(
                        at,
                        problem.help("rotate them in the model or here, or write the angle that they have"),
                    );
                }
            }
            ConstraintKind::Coupling { .. } => {}
        }
    }

    fn check_gap(&mut self, gap: f64, what: &str, at: &str, label: impl Fn() -> String) {
        if gap > APART {
            let message = format!("{what} are {:.2} mm apart at the start", gap * 1e3);
            let help = format!(
                "move one of the two nodes (up to {} mm is taken as meant together), or let the figure assemble itself: \
                 [solver] assemble = true",
                APART * 1e3
            );
            self.report(at, Diagnostic::new(codes::APART, message).label(label()).help(help));
        }
    }

    /// Warns of joined bodies whose masses differ widely.
    pub(in super::super) fn check_mass_ratios(
        &mut self,
        constraints: &[Constraint],
        bodies: &[Body],
        drives: &[KinematicBody],
    ) {
        let mass = |body: Option<usize>| {
            let free = body.filter(|&b| !drives.iter().any(|drive| drive.body == b));
            free.map(|b| bodies[b].properties.mass)
        };
        let mut warned: Vec<String> = Vec::new();
        for constraint in constraints {
            for (a, b) in super::pairs::pairs(&constraint.kind) {
                let (Some(x), Some(y)) = (mass(a), mass(b)) else { continue };
                let ratio = (x / y).max(y / x);
                let group = constraint.group().to_owned();
                if ratio <= MASS_RATIO || warned.contains(&group) {
                    continue;
                }
                let (one, other) = (self.body_name(a), self.body_name(b));
                let message = format!("\"{group}\" joins {one} ({x:.3e} kg) and {other} ({y:.3e} kg)");
                let label = format!("one is {ratio:.1e} times as heavy as the other");
                let help = "above a million the joint loses precision; check both masses";
                let place = self.place(&group);
                self.report(&place, Diagnostic::new(codes::MASS_RATIO, message).label(label).help(help));
                warned.push(group);
            }
        }
    }
}

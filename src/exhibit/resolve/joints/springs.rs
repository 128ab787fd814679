//! Springs and dampers, along a line and about an axis.

use super::super::super::codes;
use super::super::super::diagnostic::Diagnostic;
use super::super::super::sidecar;
use super::super::context::Context;
use super::{Header, Joints, functions};
use soffio_math::Function;
use soffio_multibody::articulation::{Spring, SpringKind};

impl Context<'_> {
    pub(super) fn spring(&mut self, given: &sidecar::Spring, at: &str, out: &mut Joints) {
        let header = self.header(&given.name, &given.timing, at, out);
        let a = self.attachment(&given.a, &format!("{at}/a"), &given.name);
        let b = self.attachment(&given.b, &format!("{at}/b"), &given.name);
        let (Some(a), Some(b)) = (a, b) else { return };
        if !self.joinable(a.body, b.body, &given.name, at) {
            return;
        }
        self.one_rest(given.follows.as_deref(), given.rest_length.is_some(), "rest_length", at);
        let rest = match &given.rest_length {
            _ if given.follows.is_some() => {
                let length = self.reference_position(&a).distance(self.reference_position(&b));
                Function::Given { value: length, rate: 0.0 }
            }
            Some(rest) => self.function_from_zero(rest, &format!("{at}/rest_length")),
            None => self.reference_position(&a).distance(self.reference_position(&b)).into(),
        };
        let stiffness = self.function_from_zero(&given.stiffness, &format!("{at}/stiffness"));
        let damping = given.damping.as_ref();
        let damping = damping.map_or(Function::default(), |d| self.function_from_zero(d, &format!("{at}/damping")));
        let units = [("rest_length", "m"), ("stiffness", "N/m"), ("damping", "N s/m")];
        self.push_spring(out, &header, SpringKind::Linear { a, b }, [rest, stiffness, damping], units);
    }

    pub(super) fn torsion_spring(&mut self, given: &sidecar::TorsionSpring, at: &str, out: &mut Joints) {
        let header = self.header(&given.name, &given.timing, at, out);
        let Some(measure) = self.turn(&given.axle, &given.name, at, out) else { return };
        if let soffio_multibody::articulation::Measure::Displacement { .. } = measure {
            let problem = Diagnostic::new(codes::WRONG_TYPE, format!("\"{}\" twists a slider", given.name));
            self.report(&format!("{at}/of"), problem.help("a torsion spring acts on a hinge; a slider takes a spring"));
            return;
        }
        let rest = given.rest_angle.as_ref();
        let mut rest = rest.map_or(Function::default(), |r| self.function(r, &format!("{at}/rest_angle")));
        self.one_rest(given.follows.as_deref(), given.rest_angle.is_some(), "rest_angle", at);
        if given.follows.is_some() {
            rest = Function::Given { value: 0.0, rate: 0.0 };
        }
        let stiffness = self.function_from_zero(&given.stiffness, &format!("{at}/stiffness"));
        let damping = given.damping.as_ref();
        let damping = damping.map_or(Function::default(), |d| self.function_from_zero(d, &format!("{at}/damping")));
        let units = [("rest_angle", "rad"), ("stiffness", "N m/rad"), ("damping", "N m s/rad")];
        self.push_spring(out, &header, SpringKind::Angular { measure }, [rest, stiffness, damping], units);
    }

    /// Reports a spring that follows a signal and has a rest of its own.
    fn one_rest(&mut self, follows: Option<&str>, has_rest: bool, key: &str, at: &str) {
        if let Some(signal) = follows.filter(|_| has_rest) {
            let message = format!("it follows \"{signal}\", and has a {key} of its own");
            let problem = Diagnostic::new(codes::WRONG_SHAPE, message);
            self.report(&format!("{at}/{key}"), problem.help(format!("leave out follows or {key}")));
        }
    }

    fn push_spring(
        &mut self,
        out: &mut Joints,
        header: &Header,
        kind: SpringKind,
        functions: [Function; 3],
        units: [(&str, &str); 3],
    ) {
        let of = format!("spring {}", header.name);
        if header.stabilization_time.is_some() {
            let message = format!("spring \"{}\" has a stabilizer", header.name);
            let problem = Diagnostic::new(codes::WRONG_SHAPE, message);
            let help = "a spring acts by its stiffness and damping: leave out stabilize";
            self.report(&format!("{}/stabilize", header.at), problem.help(help));
        }
        for (function, (key, unit)) in functions.iter().zip(units) {
            let otherwise = if key == "rest_length" { "derived: length in the model" } else { "default" };
            self.record_origin(&of, key, functions::shown(function, unit), &format!("{}/{key}", header.at), otherwise);
        }
        self.record_timing_origins(&of, header);
        let [rest, stiffness, damping] = functions;
        out.springs.push(Spring {
            name: header.name.to_owned(),
            kind,
            rest_length: rest,
            stiffness,
            damping,
            schedule: header.schedule.clone(),
            breaking: header.breaking,
        });
    }
}

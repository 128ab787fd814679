//! Resolves signals and the springs that follow them.

use super::super::diagnostic::{Diagnostic, quoted};
use super::super::signal::{GIVEN, Signal, SignalSource};
use super::super::{codes, sidecar};
use super::context::Context;
use soffio_math::DVec3;
use soffio_math::expression::Expression;
use soffio_multibody::articulation::Spring;

impl Context<'_> {
    /// The signals; `springs` are checked for what they follow.
    pub(super) fn signals(&mut self, springs: &[Spring]) -> Vec<Signal> {
        let sidecar = self.sidecar;
        let names: Vec<&str> =
            GIVEN.into_iter().chain(sidecar.signal.iter().map(|given| given.name.as_str())).collect();
        let mut signals: Vec<Signal> = Vec::new();
        for (i, given) in sidecar.signal.iter().enumerate() {
            let at = format!("/signal/{i}");
            if names[..GIVEN.len() + i].contains(&given.name.as_str()) {
                let problem = Diagnostic::new(codes::DUPLICATE_NAME, format!("\"{}\" is known already", given.name));
                self.report(&format!("{at}/name"), problem.help("give each signal its own name"));
            }
            let source = self.source_of(given, &names, &at);
            let source = source.unwrap_or(SignalSource::Way { body: 0, direction: DVec3::X });
            signals.push(Signal { name: given.name.clone(), source, springs: Vec::new() });
        }
        for (name, followed, at) in sidecar.constraint.followed() {
            let Some(signal) = signals.iter_mut().find(|signal| signal.name == followed) else {
                let names: Vec<&str> = signals.iter().map(|signal| signal.name.as_str()).collect();
                let help = match names.as_slice() {
                    [] => "add a [[signal]] of this name".to_owned(),
                    _ => format!("signals: {}", quoted(&names)),
                };
                let problem = Diagnostic::new(codes::UNKNOWN_SIGNAL, format!("no signal is named \"{followed}\""));
                self.report(&at, problem.help(help));
                continue;
            };
            signal.springs.extend(springs.iter().position(|spring| spring.name == name));
        }
        signals
    }

    fn source_of(&mut self, given: &sidecar::Signal, names: &[&str], at: &str) -> Option<SignalSource> {
        match (&given.value, &given.rate, &given.wind, &given.way) {
            (Some(text), None, None, None) => {
                self.expression(text, names, &format!("{at}/value")).map(SignalSource::Value)
            }
            (None, Some(text), None, None) => {
                self.expression(text, names, &format!("{at}/rate")).map(SignalSource::Rate)
            }
            (None, None, Some(of), None) => {
                let (body, direction) = self.measured_body(of, &format!("{at}/wind"))?;
                Some(SignalSource::Wind { body, direction })
            }
            (None, None, None, Some(of)) => {
                let (body, direction) = self.measured_body(of, &format!("{at}/way"))?;
                Some(SignalSource::Way { body, direction })
            }
            _ => {
                let message = format!("signal \"{}\" must have exactly one source", given.name);
                let problem = Diagnostic::new(codes::WRONG_SHAPE, message);
                self.report(at, problem.help("give one of value, rate, wind and way"));
                None
            }
        }
    }

    fn measured_body(&mut self, given: &sidecar::SignalOfBody, at: &str) -> Option<(usize, DVec3)> {
        let body = self.moving_body(&given.body, &format!("{at}/body"), "a signal");
        let direction = self.unit(DVec3::from(given.direction), &format!("{at}/direction"));
        Some((body?, direction?))
    }

    /// An expression of these numbers.
    fn expression(&mut self, text: &str, names: &[&str], at: &str) -> Option<Expression> {
        match Expression::parse(text, &|name| names.iter().position(|known| *known == name)) {
            Ok(expression) => Some(expression),
            Err(error) => {
                let message = format!("\"{text}\", character {}: {}", error.at + 1, error.message);
                let help = format!("known numbers: {}", quoted(names));
                self.report(at, Diagnostic::new(codes::EXPRESSION, message).help(help));
                None
            }
        }
    }
}

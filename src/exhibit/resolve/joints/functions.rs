//! Resolves numbers that change with time.

use super::super::super::codes;
use super::super::super::diagnostic::Diagnostic;
use super::super::super::quantity::Quantity;
use super::super::super::sidecar;
use super::super::context::Context;
use soffio_math::Function;
use soffio_math::Interpolation;

/// The interpolation of a sidecar's word.
pub(crate) fn interpolation(given: sidecar::Interpolation) -> Interpolation {
    match given {
        sidecar::Interpolation::Step => Interpolation::Step,
        sidecar::Interpolation::Linear => Interpolation::Linear,
        sidecar::Interpolation::Smooth => Interpolation::Smooth,
        sidecar::Interpolation::Spline => Interpolation::Spline,
    }
}

impl Context<'_> {
    /// A function of time; reports its problems.
    pub(crate) fn function<Q: Quantity>(&mut self, given: &sidecar::Function<Q>, at: &str) -> Function {
        match given {
            sidecar::Function::Value(value) => value.si().into(),
            sidecar::Function::Keys(given) => {
                let keys: Vec<(f64, f64)> = given.keys.iter().map(|(time, value)| (time.0, value.si())).collect();
                self.rising(keys.iter().map(|key| key.0), &format!("{at}/keys"));
                Function::Keys { keys, interpolation: interpolation(given.interpolation), repeat: given.repeat }
            }
            sidecar::Function::Wave(given) => Function::Wave {
                mean: given.mean.map_or(0.0, Q::si),
                amplitude: given.amplitude.si(),
                period: self.positive(given.period.0, &format!("{at}/period")),
                phase: given.phase.0,
            },
        }
    }

    /// A function that must not become negative.
    pub(crate) fn function_from_zero<Q: Quantity>(&mut self, given: &sidecar::Function<Q>, at: &str) -> Function {
        let function = self.function(given, at);
        let least = match &function {
            Function::Constant(value) => *value,
            Function::Keys { keys, .. } => keys.iter().fold(f64::INFINITY, |least, key| least.min(key.1)),
            Function::Wave { mean, amplitude, .. } => mean - amplitude.abs(),
            Function::Given { value, .. } => *value,
        };
        self.not_negative(least, at);
        function
    }

    /// Reports times that do not increase, or are negative.
    pub(crate) fn rising(&mut self, times: impl Iterator<Item = f64>, at: &str) {
        let mut last = f64::NEG_INFINITY;
        for (i, time) in times.enumerate() {
            if time <= last || time < 0.0 {
                let message = format!("key {i} is at {time} s, but times must increase from key to key, from 0 on");
                let problem = Diagnostic::new(codes::KEYS, message);
                self.report(&format!("{at}/{i}"), problem.help("write keys as [time, value] in increasing time"));
                return;
            }
            last = time;
        }
    }
}

/// A function as text.
pub(super) fn shown(function: &Function, unit: &str) -> String {
    match function {
        Function::Constant(value) => format!("{value} {unit}"),
        Function::Keys { keys, interpolation, repeat } => format!(
            "{} keys, {interpolation:?}{}, from {} {unit}",
            keys.len(),
            if *repeat { ", repeated" } else { "" },
            keys.first().map_or(0.0, |key| key.1)
        ),
        Function::Given { .. } => "follows a signal".to_owned(),
        Function::Wave { mean, amplitude, period, .. } => format!("{mean} ± {amplitude} {unit}, every {period} s"),
    }
}

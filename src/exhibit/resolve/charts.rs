//! Resolves charts: their boards, and what their curves show.

use super::super::chart::{Chart, Curve, Measured};
use super::super::diagnostic::Diagnostic;
use super::super::{codes, sidecar};
use super::context::Context;
use super::nodes::rigid;
use super::wires::linear;
use soffio_multibody::articulation::{Constraint, ConstraintKind};

impl Context<'_> {
    /// The charts.
    pub(super) fn charts(&mut self, constraints: &[Constraint]) -> Vec<Chart> {
        let sidecar = self.sidecar;
        let mut charts: Vec<Chart> = Vec::new();
        for (i, given) in sidecar.chart.iter().enumerate() {
            let at = format!("/chart/{i}");
            if charts.iter().any(|chart| chart.name == given.name) {
                let problem =
                    Diagnostic::new(codes::DUPLICATE_NAME, format!("two charts are named \"{}\"", given.name));
                self.report(&format!("{at}/name"), problem.help("give each its own name"));
            }
            charts.extend(self.chart(given, constraints, &at));
        }
        charts
    }

    fn chart(&mut self, given: &sidecar::Chart, constraints: &[Constraint], at: &str) -> Option<Chart> {
        let used_for = format!("the chart \"{}\"", given.name);
        let place = format!("{at}/node");
        let node = self.node(&given.node, &place, &used_for)?;
        if self.owner[node].is_some() {
            let problem = Diagnostic::new(codes::UNKNOWN_BODY, format!("node \"{}\" moves", given.node));
            self.report(
                &place,
                problem.label("a board of a chart is fixed").help("name a node that belongs to no body"),
            );
            return None;
        }
        let Some(pose) = rigid(&self.model.nodes[node].world) else {
            let problem = Diagnostic::new(codes::SCALED_BODY, format!("node \"{}\" is scaled unevenly", given.node));
            self.report(&place, problem.help("apply its scale in the modelling program"));
            return None;
        };
        let [low, high] = given.range.map(|value| value.0);
        if !(low > 0.0 && high > low) {
            let message = format!("the range from {low} m to {high} m has no logarithmic scale");
            let problem = Diagnostic::new(codes::RANGE, message);
            self.report(&format!("{at}/range"), problem.help("write two lengths above zero, the smaller one first"));
        }
        let size = [0, 1].map(|k| self.positive(given.size[k].0, &format!("{at}/size/{k}")));
        let seconds = self.positive(given.seconds.0, &format!("{at}/seconds"));
        let radius = self.positive(given.radius.0, &format!("{at}/radius"));
        let curves = given.curve.iter().enumerate().filter_map(|(k, curve)| {
            let place = format!("{at}/curve/{k}");
            let measured = self.measured(given.measures, curve, constraints, &place)?;
            Some(Curve { measured, color: linear(&curve.color) })
        });
        let curves = curves.collect();
        Some(Chart { name: given.name.clone(), pose, size, range: [low, high], seconds, radius: radius as f32, curves })
    }

    /// What a curve shows.
    fn measured(
        &mut self,
        measures: sidecar::Measured,
        given: &sidecar::ChartCurve,
        constraints: &[Constraint],
        at: &str,
    ) -> Option<Measured> {
        let body = self.moving_body(&given.body, &format!("{at}/body"), "a curve")?;
        match (measures, &given.like) {
            (sidecar::Measured::Departure, Some(like)) => {
                let like = self.moving_body(like, &format!("{at}/like"), "a curve")?;
                Some(Measured::Departure { body, like })
            }
            (sidecar::Measured::Departure, None) => {
                let problem = Diagnostic::new(codes::MISSING_KEY, "a departure is from another body");
                self.report(at, problem.help("add like = \"…\", the node of the body that it is compared with"));
                None
            }
            (sidecar::Measured::JointError, like) => {
                if like.is_some() {
                    let problem = Diagnostic::new(codes::UNUSED, "a joint error is compared with nothing");
                    self.report(&format!("{at}/like"), problem.help("leave it out"));
                }
                let joints = self.joints_with(body, constraints);
                if joints.is_empty() {
                    let problem = Diagnostic::new(codes::UNUSED, format!("\"{}\" hangs on no joint", given.body));
                    self.report(&format!("{at}/body"), problem.help("name a body that a constraint joins"));
                }
                Some(Measured::JointError { body, constraints: joints })
            }
        }
    }

    /// Constraints of lengths on all bodies that constraints join with `body`.
    fn joints_with(&self, body: usize, constraints: &[Constraint]) -> Vec<usize> {
        let mut is_joined = vec![false; self.body_nodes.len()];
        is_joined[body] = true;
        loop {
            let before = is_joined.iter().filter(|joined| **joined).count();
            for constraint in constraints {
                let of = |k: &usize| constraint.kind.acts_on(*k) && !self.is_kinematic(*k);
                let acted: Vec<usize> = (0..is_joined.len()).filter(of).collect();
                if acted.iter().any(|&k| is_joined[k]) {
                    acted.iter().for_each(|&k| is_joined[k] = true);
                }
            }
            if is_joined.iter().filter(|joined| **joined).count() == before {
                break;
            }
        }
        let is_own = |c: &Constraint| (0..is_joined.len()).any(|k| is_joined[k] && c.kind.acts_on(k));
        let is_length = |c: &Constraint| !matches!(c.kind, ConstraintKind::Orientation { .. });
        (0..constraints.len()).filter(|&i| is_own(&constraints[i]) && is_length(&constraints[i])).collect()
    }
}

//! Signals: numbers that an exhibit computes while it moves.

use schemars::JsonSchema;
use serde::Deserialize;

use super::Constraints;

/// A number that is computed once a step: one of value, rate, wind and way. Springs follow it (`follows`).
///
/// Expressions know `time` (s since the reset), `breath` (m/s at the lips), all signals (those below are a step old), numbers,
/// + − * / and ( ), and the functions sin, cos, atan2, abs, min, max, rise and noise.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Signal {
    /// Unique name: lower-case letters, digits and _.
    #[schemars(regex(pattern = "^[a-z][a-z0-9_]*$"))]
    pub name: String,
    /// An expression.
    pub value: Option<String>,
    /// An expression of its change in a second. It begins at 0.
    pub rate: Option<String>,
    /// Speed of the air at a body.
    pub wind: Option<SignalOfBody>,
    /// Way of a body since the start.
    pub way: Option<SignalOfBody>,
}

/// What is measured at a body.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SignalOfBody {
    /// Node of the body.
    pub body: String,
    /// Along this direction of the world.
    pub direction: [f64; 3],
}

impl Constraints {
    /// Springs that follow a signal: the spring's name, the signal's, and its place in the sidecar.
    pub fn followed(&self) -> Vec<(&str, &str, String)> {
        let lines = self.spring.iter().enumerate();
        let lines = lines.map(|(i, spring)| (&spring.name, spring.follows.as_deref(), format!("spring/{i}")));
        let twists = self.torsion_spring.iter().enumerate();
        let twists = twists.map(|(i, spring)| (&spring.name, spring.follows.as_deref(), format!("torsion-spring/{i}")));
        let followed = lines.chain(twists);
        followed
            .filter_map(|(name, signal, at)| Some((name.as_str(), signal?, format!("/constraint/{at}/follows"))))
            .collect()
    }
}

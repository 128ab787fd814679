//! Numbers that may change with time, and paths.

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::quantity::*;

/// A number that may change with time: a constant, key frames, or a wave. Time counts from the exhibit's reset.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Function<Q> {
    /// A constant.
    Value(Q),
    /// Key frames.
    Keys(Keys<Q>),
    /// A sine about a mean.
    Wave(Wave<Q>),
}

/// Key frames: values at given times.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Keys<Q> {
    /// [time, value] pairs in increasing time.
    #[schemars(length(min = 1, max = 4096))]
    pub keys: Vec<(Time, Q)>,
    /// Interpolation between two keys.
    #[serde(default)]
    pub interpolation: Interpolation,
    /// Starts again after the last key; otherwise the last value stays.
    #[serde(default, rename = "loop")]
    pub repeat: bool,
}

/// mean + amplitude · sin(2π t/period + phase).
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wave<Q> {
    /// Its shape.
    pub wave: WaveShape,
    /// Mean value; by default 0.
    pub mean: Option<Q>,
    /// Largest departure from the mean.
    pub amplitude: Q,
    /// Time of one oscillation.
    pub period: Time,
    /// Phase at the start; by default 0.
    #[serde(default)]
    pub phase: Angle,
}

/// Shape of a wave.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum WaveShape {
    /// A sine.
    Sine,
}

/// Interpolation between two keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Interpolation {
    /// The earlier value, until the next key.
    Step,
    /// A straight line (linear).
    Linear,
    /// Starts and stops at each key, without a jump of acceleration.
    #[default]
    Smooth,
    /// Passes through each key without stopping; the acceleration has no jumps.
    Spline,
}

/// A path in the world.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Path {
    /// [time s, x, y, z m] in increasing time.
    #[schemars(length(min = 1, max = 4096))]
    pub points: Vec<[f64; 4]>,
    /// Interpolation between two points; by default "spline".
    pub interpolation: Option<Interpolation>,
    /// Starts again after the last point.
    #[serde(default, rename = "loop")]
    pub repeat: bool,
}

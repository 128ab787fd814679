//! Charts: boards on which curves show what is measured while the exhibit moves.

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::quantity::*;
use super::{Color, Name};

/// A board with curves of the last seconds: time runs to the right, the scale is logarithmic.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Chart {
    /// Unique name.
    pub name: Name,
    /// Fixed glTF node: lower left corner of the board; its x axis points to the right, its y axis up.
    pub node: String,
    /// What the curves show.
    pub measures: Measured,
    /// Width and height.
    pub size: [Length; 2],
    /// Values at the lower and the upper edge, both above zero.
    pub range: [Length; 2],
    /// Time from the left edge to the right one.
    pub seconds: Time,
    /// Radius of the line.
    pub radius: Length,
    /// The curves.
    #[schemars(length(min = 1, max = 8))]
    pub curve: Vec<ChartCurve>,
}

/// What a chart shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Measured {
    /// The greatest distance of two points that a joint holds together.
    JointError,
    /// How far a body's centre of mass is from where that of its like is, each from its own start.
    Departure,
}

/// A curve of a chart.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ChartCurve {
    /// Node of a body. The joint error is that of all bodies that are joined with it.
    pub body: String,
    /// With measures = "departure": node of the body that it is compared with.
    pub like: Option<String>,
    /// Colour: linear [r, g, b], or sRGB "#rrggbb".
    pub color: Color,
}

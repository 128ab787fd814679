//! The winds of an exhibit: what a breath is to it, and what blows by itself.

use schemars::JsonSchema;
use serde::Deserialize;

use super::super::quantity::*;
use super::{Function, Name, Point};

/// The winds of an exhibit: what a breath is to it, and what blows by itself.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Winds {
    /// What a breath is to this exhibit.
    pub breath: BreathTuning,
    /// How the work comes to rest when nobody blows, so that the next breath is seen. By default it does so by itself.
    pub calm: Option<Calm>,
    /// The room's own air: it stirs, and keeps a mobile alive when nobody blows. By default it is at rest.
    pub room: Option<Room>,
    /// Winds from a round opening: a fan, an air conditioner.
    pub fan: Vec<Fan>,
    /// Winds that blow one way: from a door, through a window.
    pub draught: Vec<Draught>,
    /// Separate puffs of wind that come one way.
    pub gust: Vec<Gust>,
    /// glTF nodes that let the wind through. Every other mesh shelters what lies behind it.
    pub open: Vec<String>,
}

/// What a breath is to an exhibit.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct BreathTuning {
    /// How it spreads.
    pub law: Law,
    /// Multiplies its force, on top of the site's own gain.
    #[schemars(range(min = 0.0, max = 100.0))]
    pub gain: f64,
    /// Diameter of the blowing lips; by default the site's.
    pub lip_diameter: Option<Length>,
}

impl Default for BreathTuning {
    fn default() -> Self {
        Self { law: Law::Jet, gain: 1.0, lip_diameter: None }
    }
}

/// How the work comes to rest when nobody blows: the gallery's air thickens. The true profile leaves it out.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Calm {
    /// So long after the last breath or hand.
    pub after: Time,
    /// Time in which free motion fades to 37 % at first; a swing takes twice as long. The calm grows eight times as firm within
    /// five seconds.
    pub time: Time,
}

/// How a breath spreads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Law {
    /// A cone that only the breath's own air fills: weak at a distance.
    Cone,
    /// A turbulent jet that takes the room's air along, as a real breath does.
    #[default]
    Jet,
}

/// The room's own air.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Room {
    /// How fast it moves, root mean square: 0.05 … 0.2 m/s indoors.
    pub speed: Function<Speed>,
    /// Size of its largest eddies; by default 0.6 m.
    pub scale: Option<Length>,
    /// Time in which they change; by default 6 s.
    pub period: Option<Time>,
    /// Seed of the eddies.
    #[serde(default)]
    pub seed: u64,
}

/// A wind from a round opening: a jet as wide as it.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fan {
    /// Unique name.
    pub name: Name,
    /// Middle of the opening: a node that stands still, or a point of the world.
    pub at: Point,
    /// Where it blows, world axes.
    pub direction: [f64; 3],
    /// Diameter of the opening.
    pub diameter: Length,
    /// How fast the air leaves it.
    pub speed: Function<Speed>,
    /// How it comes and goes; by default it blows evenly.
    pub gusts: Option<Gusts>,
}

/// A wind that blows one way.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Draught {
    /// Unique name.
    pub name: Name,
    /// Where it blows, world axes.
    pub direction: [f64; 3],
    /// Where it comes in: a node that stands still, or a point of the world; with `width`. By default it is everywhere.
    pub at: Option<Point>,
    /// With `at`: across it is half as fast this far from side to side.
    pub width: Option<Length>,
    /// How fast it is in its middle.
    pub speed: Function<Speed>,
    /// How it comes and goes; by default it blows evenly.
    pub gusts: Option<Gusts>,
}

/// How a wind comes and goes: three octaves of it, weaker as they grow quicker.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gusts {
    /// Greatest departure from the speed, as a share of it.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub strength: f64,
    /// Time of the slowest change.
    pub period: Time,
    /// Seed.
    #[serde(default)]
    pub seed: u64,
}

/// Separate puffs of wind, each at a moment of its own.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gust {
    /// Unique name.
    pub name: Name,
    /// Where it blows, world axes.
    pub direction: [f64; 3],
    /// Where it comes in: a node that stands still, or a point of the world; with `width`. By default it is everywhere.
    pub at: Option<Point>,
    /// With `at`: across it is half as fast this far from side to side.
    pub width: Option<Length>,
    /// How fast the strongest puff is.
    pub speed: Function<Speed>,
    /// One puff in each such time.
    pub every: Time,
    /// How long a puff lasts.
    pub lasts: Time,
    /// Seed.
    #[serde(default)]
    pub seed: u64,
}

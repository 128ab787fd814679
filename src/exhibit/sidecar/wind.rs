//! The winds of an exhibit: how a breath acts on it, and winds of its own.

use schemars::JsonSchema;
use serde::Deserialize;

use soffio_wind::force::TURBULENCE;

use super::super::quantity::*;
use super::{Function, Name, Point};

/// The winds of an exhibit: how a breath acts on it, and winds of its own.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Winds {
    /// How a breath acts on this exhibit.
    pub breath: BreathTuning,
    /// Idle damping: brings the exhibit to rest when nobody blows, so that the next breath is visible. By default none.
    pub idle_damping: Option<IdleDamping>,
    /// Ambient turbulence, which keeps a mobile moving when nobody blows. By default none.
    pub ambient: Option<AmbientTurbulence>,
    /// Jets from a round opening: a fan, an air conditioner.
    pub fan: Vec<Fan>,
    /// Winds in one direction: from a door, through a window.
    pub draught: Vec<Draught>,
    /// Separate gusts in one direction.
    pub gust: Vec<Gust>,
    /// glTF nodes that let the wind through. Every other mesh shelters bodies behind it.
    pub open: Vec<String>,
}

/// How a breath acts on an exhibit.
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
    /// With law = "cone": distance of the cone's vertex behind the lips, 1 mm … 10 m. The longer, the narrower the cone and
    /// the faster its air. By default that of a cone of 11.8° to each side: 24 mm for lips of 10 mm.
    pub vertex_distance: Option<Length>,
    /// Turbulence: greatest random part of its force, as a fraction of it; 0 is a steady breath.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub turbulence: f64,
}

impl Default for BreathTuning {
    fn default() -> Self {
        Self { law: Law::Jet, gain: 1.0, lip_diameter: None, vertex_distance: None, turbulence: TURBULENCE }
    }
}

/// Idle damping: the air of the gallery becomes more viscous when nobody blows. The profile "physical" leaves it out.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct IdleDamping {
    /// Delay after the last breath or grab.
    pub after: Time,
    /// Time in which free motion decays to 37 % at first; oscillations take twice as long. The damping grows eightfold
    /// within five seconds.
    pub time: Time,
}

/// How a breath spreads.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum Law {
    /// A cone filled by the breath's own air alone: weak at a distance.
    Cone,
    /// A turbulent jet that entrains the surrounding air, as a real breath does.
    #[default]
    Jet,
}

/// Ambient turbulence of the gallery.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AmbientTurbulence {
    /// Speed, root mean square: 0.05 … 0.2 m/s indoors.
    pub speed: Function<Speed>,
    /// Size of its largest eddies; by default 0.6 m.
    pub scale: Option<Length>,
    /// Time in which the eddies change; by default 6 s.
    pub period: Option<Time>,
    /// Seed of the eddies.
    #[serde(default)]
    pub seed: u64,
}

/// A jet from a round opening.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Fan {
    /// Unique name.
    pub name: Name,
    /// Centre of the opening: a fixed node, or a point of the world.
    pub at: Point,
    /// Direction of the jet, world axes.
    pub direction: [f64; 3],
    /// Diameter of the opening.
    pub diameter: Length,
    /// Speed of the air at the opening.
    pub speed: Function<Speed>,
    /// Fluctuations of the speed; by default none.
    pub gusts: Option<Gusts>,
}

/// A wind in one direction.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Draught {
    /// Unique name.
    pub name: Name,
    /// Direction, world axes.
    pub direction: [f64; 3],
    /// Where it enters: a fixed node, or a point of the world; with `width`. By default it is everywhere.
    pub at: Option<Point>,
    /// With `at`: full width at half the speed of the middle.
    pub width: Option<Length>,
    /// Speed in its middle.
    pub speed: Function<Speed>,
    /// Fluctuations of the speed; by default none.
    pub gusts: Option<Gusts>,
}

/// Fluctuations of a wind: three octaves, the faster the weaker.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gusts {
    /// Greatest deviation from the speed, as a fraction of it.
    #[schemars(range(min = 0.0, max = 1.0))]
    pub strength: f64,
    /// Period of the slowest fluctuation.
    pub period: Time,
    /// Seed of the fluctuations.
    #[serde(default)]
    pub seed: u64,
}

/// Separate gusts, each at a random moment.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Gust {
    /// Unique name.
    pub name: Name,
    /// Direction, world axes.
    pub direction: [f64; 3],
    /// Where they enter: a fixed node, or a point of the world; with `width`. By default they are everywhere.
    pub at: Option<Point>,
    /// With `at`: full width at half the speed of the middle.
    pub width: Option<Length>,
    /// Speed of the strongest gust.
    pub speed: Function<Speed>,
    /// Time span in which one gust comes.
    pub every: Time,
    /// Duration of a gust.
    pub lasts: Time,
    /// Seed of the gusts.
    #[serde(default)]
    pub seed: u64,
}

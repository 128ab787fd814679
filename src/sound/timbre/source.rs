//! Modal nodes: where the partials of a body come from.

use schemars::JsonSchema;
use serde::Deserialize;

use super::limits::MAX_PARTIALS;
use super::number::{Number, one};

/// Decaying partials.
#[derive(Clone, Debug, JsonSchema, PartialEq)]
pub struct Modal {
    /// Where the partials come from.
    #[serde(flatten)]
    pub source: Source,
    /// Keys that every source of partials has.
    #[serde(flatten)]
    pub common: Common,
}

impl std::ops::Deref for Modal {
    type Target = Common;

    fn deref(&self) -> &Common {
        &self.common
    }
}

/// Keys of every modal node.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq)]
pub struct Common {
    /// Node whose samples are a force in N that drives the partials, beside the hits.
    pub r#in: Option<String>,
    /// Where that force acts along the body, −1…1; without it, where the hit or the slide is, and in the middle for wind.
    pub drive_at: Option<f64>,
    /// Most partials, 1…1024; of more, the lowest are kept.
    #[serde(default = "most_partials")]
    pub partials: usize,
    /// Damping by what it hangs on or lies on, 1/s. On beams and strings that know where (`hang`): times φ² there.
    #[serde(default)]
    pub support_loss: f64,
    /// Radius of the surfaces that meet, m (Hertz contact).
    pub contact_radius: f64,
    /// Young's modulus of the surfaces that meet (paint, patina, leather), Pa; without it, the body's material.
    pub surface_modulus: Option<f64>,
    /// Spread of each partial, cents.
    #[serde(default)]
    pub detune: f64,
    /// Multiplies the physical level; full scale per N s for `table`, `random`, `mass-spring` and `string`.
    #[serde(default = "one")]
    pub gain: Number,
}

/// Keys of [`Common`].
pub(super) const COMMON: [&str; 8] =
    ["in", "drive_at", "partials", "support_loss", "contact_radius", "surface_modulus", "detune", "gain"];

fn most_partials() -> usize {
    MAX_PARTIALS
}

/// Where partials come from.
#[derive(Clone, Debug, JsonSchema, PartialEq)]
#[serde(tag = "from", rename_all = "kebab-case")]
pub enum Source {
    /// The modes of a free plate of the body's dimensions and material; the place of the hit is heard.
    Plate(Plate),
    /// The preset's own table.
    Table(Table),
    /// A free tube or round rod, bending.
    Tube(Tube),
    /// A free bar of rectangular section, bending across its smaller side.
    Bar(Bar),
    /// A string between two ends.
    String(Strung),
    /// One mass on one spring: f = √(k/m) / 2π.
    MassSpring(MassSpring),
    /// A circular membrane, such as a drum's head; the place of the hit is heard.
    Membrane(Membrane),
    /// Random partials from stated distributions, for bodies with too many to distinguish.
    Random(Drawn),
    /// What the body's own dimensions say: a sheet is a plate, what is long a tube or a bar.
    Mesh(Mesh),
}

/// Names of the sources.
pub(super) const SOURCES: [&str; 9] =
    ["plate", "table", "tube", "bar", "string", "mass-spring", "membrane", "random", "mesh"];

/// Numbers of a material; what is not said is the body's.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct MaterialOverride {
    /// E, Pa.
    pub youngs_modulus: Option<f64>,
    /// G, Pa; without it E / 2(1 + ν).
    pub shear_modulus: Option<f64>,
    /// ν.
    pub poisson: Option<f64>,
    /// Density, kg/m³.
    pub density: Option<f64>,
    /// η of the installed body: c = π η f, T60 = 2.2/(η f).
    pub loss_factor: Option<f64>,
}

/// A free plate.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Plate {
    /// Constants of the material that replace the body's.
    #[serde(default)]
    pub material: MaterialOverride,
}

/// The preset's own table.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// Frequency of ratio 1, Hz.
    pub fundamental: f64,
    /// Radius of the body that these partials are of, m. Of bodies of one form and material frequencies go with 1/size, and so do
    /// decays. Without it every body has these.
    pub radius: Option<f64>,
    /// The partials.
    pub table: Vec<TablePartial>,
}

/// One partial of a table.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct TablePartial {
    /// Frequency over the fundamental.
    pub ratio: f64,
    /// Relative amplitude.
    pub gain: f64,
    /// Time to fall by 60 dB, s.
    pub t60: f64,
}

/// Theory of a bending beam.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum BeamModel {
    /// Euler and Bernoulli's slender beam: f = (K/2π L²) √(E/ρ) (βL)², the thesis' (π K/8 L²) √(E/ρ) m².
    Thesis,
    /// With shear and rotary inertia: real tubes fall below the slender series from the third partial on.
    #[default]
    Timoshenko,
}

/// A free tube or round rod.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Tube {
    /// Beam theory that gives the frequencies and shapes.
    #[serde(default)]
    pub model: BeamModel,
    /// Length L, m; without it, the body's.
    pub length: Option<f64>,
    /// Outer diameter, m; without it, the body's.
    pub outer: Option<f64>,
    /// Inner diameter, m, 0 for a rod; without it, what the body's mass leaves.
    pub inner: Option<f64>,
    /// Where it hangs, 0…1 of its length: `support_loss` takes φ² there. The node of the first mode is at 0.2242.
    #[serde(default = "first_node")]
    pub hang: f64,
    /// Two planes of bending, this far apart in pitch, cents: a tube is never quite round.
    #[serde(default)]
    pub split: f64,
    /// Angle of the first plane to the direction of a hit on the middle, rad.
    #[serde(default = "half_a_radian")]
    pub plane: f64,
    /// Whether the sound itself takes energy away, beside the loss factor.
    #[serde(default)]
    pub radiation_loss: bool,
    /// Constants of the material that replace the body's.
    #[serde(default)]
    pub material: MaterialOverride,
}

/// A free bar of rectangular section.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Bar {
    /// Beam theory that gives the frequencies and shapes.
    #[serde(default)]
    pub model: BeamModel,
    /// Length L, m; without it, the body's.
    pub length: Option<f64>,
    /// Width, across the direction of bending, m; without it, the body's.
    pub width: Option<f64>,
    /// Thickness, in the direction of bending, m; without it, the body's.
    pub thickness: Option<f64>,
    /// Where it lies or hangs, as a share of its length, 0 … 1. The node of the first mode is at 0.2242.
    #[serde(default = "first_node")]
    pub hang: f64,
    /// Whether the sound itself takes energy away, beside the loss factor.
    #[serde(default)]
    pub radiation_loss: bool,
    /// Constants of the material that replace the body's.
    #[serde(default)]
    pub material: MaterialOverride,
}

/// A string: f_n = n v/2L √(1 + B n²).
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Strung {
    /// Length L, m; without it, the body's.
    pub length: Option<f64>,
    /// Tension, N: v = √(T L/m). Without it, longitudinal waves: v = √(E/ρ).
    pub tension: Option<f64>,
    /// Mass, kg; without it, the body's.
    pub mass: Option<f64>,
    /// Inharmonicity B by the string's stiffness, without a unit.
    #[serde(default)]
    pub inharmonicity: f64,
    /// Constants of the material that replace the body's.
    #[serde(default)]
    pub material: MaterialOverride,
}

/// One mass on one spring.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct MassSpring {
    /// Stiffness k of the spring, N/m.
    pub stiffness: f64,
    /// Mass m, kg; without it, the body's.
    pub mass: Option<f64>,
    /// Time to fall by 60 dB, s.
    pub t60: f64,
}

/// A circular membrane under tension: f = j/(2π a) √(T/σ), j the zeros of Bessel's functions.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Membrane {
    /// Frequency of the lowest mode at `radius`, Hz.
    pub fundamental: f64,
    /// Radius of that membrane, m; others of the same tension and skin have frequencies that go with 1/size.
    pub radius: f64,
    /// T60 of the lowest mode and at `high`, s; c = c₀ + c₂ ω² between.
    pub t60: [f64; 2],
    /// Frequency of the second T60, Hz.
    pub high: f64,
    /// Level over frequency, dB per octave: low modes move more air.
    #[serde(default)]
    pub tilt: f64,
}

/// Partials drawn by chance.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Drawn {
    /// Lowest frequency, Hz.
    pub low: f64,
    /// Highest frequency, Hz.
    pub high: f64,
    /// Radius of the body that these partials are of, m. Of bodies of one form and material frequencies go with 1/size, and so do
    /// decays. Without it every body has these.
    pub radius: Option<f64>,
    /// How they lie between.
    #[serde(default)]
    pub spacing: Spacing,
    /// T60 at `low` and at `high`, s; c = c₀ + c₂ ω² between. The second is not above the first.
    pub t60: [f64; 2],
    /// s: each T60 is multiplied by a random factor between 1/s and s.
    #[serde(default = "unity")]
    pub t60_spread: f64,
    /// Level of `high` against `low`, dB per octave.
    #[serde(default)]
    pub tilt: f64,
    /// Seed of the draw.
    #[serde(default)]
    pub seed: u64,
}

/// How drawn frequencies lie.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Spacing {
    /// As many in each hertz: a plate's.
    #[default]
    Even,
    /// As many in each octave.
    Octaves,
}

/// What the body's own dimensions say.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// Constants of the material that replace the body's.
    #[serde(default)]
    pub material: MaterialOverride,
}

fn first_node() -> f64 {
    0.2242
}
fn half_a_radian() -> f64 {
    0.5
}
fn unity() -> f64 {
    1.0
}

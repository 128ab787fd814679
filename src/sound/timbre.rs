//! Timbre presets: a sound as data. A preset names nodes; each node takes other nodes by name, so that the whole is a
//! graph without rings, and `out` is what is heard. Any [`Number`] may follow the motion instead of standing still.
//!
//! Presets are compiled into the program: the kiosk needs no path. Unknown keys are refused; every error says which
//! file and which key.

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::Deserialize;

use crate::math::pow;

/// The shipped presets, in the order in which they are listed.
const SHIPPED: [(&str, &str); 3] = [
    ("plate", include_str!("../../audio/timbres/plate.toml")),
    ("bell", include_str!("../../audio/timbres/bell.toml")),
    ("wind-room", include_str!("../../audio/timbres/wind-room.toml")),
];

/// Version of the format that this program reads.
const VERSION: u32 = 1;
/// Most nodes of one timbre.
pub const MAX_NODES: usize = 12;
/// Most partials of one timbre.
pub const MAX_PARTIALS: usize = 1024;

/// What is wrong with a timbre, and where.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{file}: {key}: {problem}")]
pub struct TimbreError {
    /// The preset's file.
    pub file: String,
    /// Path of the key, `node.body.partials`.
    pub key: String,
    /// What is wrong and what would be right.
    pub problem: String,
}

impl TimbreError {
    pub(super) fn new(name: &str, key: impl Into<String>, problem: impl Into<String>) -> Self {
        Self { file: format!("audio/timbres/{name}.toml"), key: key.into(), problem: problem.into() }
    }
}

/// A timbre preset (`audio/timbres/<name>.toml`).
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Preset {
    /// Version of the format: 1.
    pub timbre: u32,
    /// The file's name without extension.
    pub name: String,
    /// What it sounds like, in a few words.
    pub description: String,
    /// Nodes by name; `out` is heard.
    pub node: BTreeMap<String, Node>,
}

/// One operator of a timbre.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(tag = "type", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Node {
    /// Decaying partials, set ringing by hits: Σ a e^(−ct) sin ωt. They belong to the body: hits add up in them. At most
    /// one in a timbre.
    Modal {
        /// Where the partials come from.
        from: ModalSource,
        /// Node whose samples are a force in N that drives the partials, beside the hits.
        r#in: Option<String>,
        /// Most partials, 1…1024.
        #[serde(default = "most_partials")]
        partials: usize,
        /// Damping of the suspension, the same for all partials, 1/s.
        #[serde(default)]
        support_loss: f64,
        /// Radius of the surfaces that meet, m (Hertz contact).
        contact_radius: f64,
        /// Young's modulus of the surfaces that meet (paint, patina, leather), Pa; without it, the body's material.
        surface_modulus: Option<f64>,
        /// Spread of each partial from body to body, cents.
        #[serde(default)]
        detune: f64,
        /// `table` only: frequency of ratio 1, Hz.
        fundamental: Option<f64>,
        /// `table` only: the partials.
        #[serde(default)]
        table: Vec<TablePartial>,
        /// `plate`: multiplies the physical level. `table`: full scale per N s.
        #[serde(default = "one")]
        gain: Number,
    },
    /// Endless noise.
    Noise {
        /// Its kind.
        #[serde(default)]
        kind: NoiseKind,
        /// `multifractal` only: rate of the slowest octave, Hz.
        #[serde(default = "one_hertz")]
        base: f64,
        /// `multifractal` only: number of octaves, 1…12.
        #[serde(default = "one_octave")]
        octaves: u32,
        /// `multifractal` only: Hurst exponent H; the spectrum falls as f^(−1−2H).
        #[serde(default = "kolmogorov")]
        roughness: f64,
        /// Level.
        #[serde(default = "one")]
        gain: Number,
    },
    /// State-variable filter, 12 dB per octave.
    Filter {
        /// Node that is filtered.
        r#in: String,
        /// Which of its outputs.
        kind: FilterKind,
        /// Corner or centre, Hz.
        cutoff: Number,
        /// Resonance; 0.707 is flat.
        #[serde(default = "flat")]
        q: Number,
        /// Level.
        #[serde(default = "one")]
        gain: Number,
    },
    /// Multiplies by a decay that begins with the hit.
    Env {
        /// Node that is shaped.
        r#in: String,
        /// Time constant, s.
        decay: Number,
        /// Level.
        #[serde(default = "one")]
        gain: Number,
    },
    /// Adds nodes.
    Sum {
        /// Nodes that are added.
        r#in: Vec<String>,
        /// Level.
        #[serde(default = "one")]
        gain: Number,
    },
    /// Multiplies nodes.
    Product {
        /// Nodes that are multiplied.
        r#in: Vec<String>,
        /// Level.
        #[serde(default = "one")]
        gain: Number,
    },
}

fn most_partials() -> usize {
    MAX_PARTIALS
}
fn one() -> Number {
    Number::Fixed(1.0)
}
fn flat() -> Number {
    Number::Fixed(std::f64::consts::FRAC_1_SQRT_2)
}
fn one_hertz() -> f64 {
    1.0
}
fn one_octave() -> u32 {
    1
}
fn kolmogorov() -> f64 {
    1.0 / 3.0
}

/// Where partials come from.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum ModalSource {
    /// The modes of a free plate of the body's dimensions and material; the place of the hit is heard.
    Plate,
    /// The preset's own table.
    Table,
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

/// Kind of a noise.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum NoiseKind {
    /// Every sample on its own, uniform in ±1.
    #[default]
    White,
    /// Gusts: a product of octaves of gradient noise, mean 1 ([`multifractal`](crate::sound::multifractal)).
    Multifractal,
}

/// Output of a filter.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum FilterKind {
    /// Below the corner.
    LowPass,
    /// Around the centre; gain 1 there.
    BandPass,
    /// Above the corner.
    HighPass,
}

/// A number of a preset: fixed, or following the motion.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(untagged)]
pub enum Number {
    /// Always this.
    Fixed(f64),
    /// offset + scale · input^power, within min…max.
    Bound(Binding),
}

/// How a number follows the motion: offset + scale · input^power, within min…max.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Binding {
    /// What it follows.
    pub input: Input,
    /// Factor.
    #[serde(default = "unity")]
    pub scale: f64,
    /// Exponent; the sign of the input is kept.
    #[serde(default = "unity")]
    pub power: f64,
    /// Value where the input is 0.
    #[serde(default)]
    pub offset: f64,
    /// Least value.
    pub min: Option<f64>,
    /// Largest value.
    pub max: Option<f64>,
}

fn unity() -> f64 {
    1.0
}

/// What a number can follow. The wind's inputs change all the time, the others are those of the hit.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Input {
    /// N s.
    Impulse,
    /// Approach speed, m/s.
    Speed,
    /// Effective mass of the hit, kg.
    Mass,
    /// Hertz contact time, s.
    ContactTime,
    /// Pressure 1 m away if the body's whole face moved as the hit pushes it, full scale.
    RigidPressure,
    /// Place of the hit along the larger half extent, −1…1.
    PositionX,
    /// Place of the hit along the smaller half extent, −1…1.
    PositionY,
    /// Speed of the air, m/s.
    WindSpeed,
    /// Relative gust, about ±1.
    Gust,
}

/// Values of all inputs at one moment, by the names of [`Input`].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Inputs {
    pub impulse: f64,
    pub speed: f64,
    pub mass: f64,
    pub contact_time: f64,
    pub rigid_pressure: f64,
    pub position: [f64; 2],
    pub wind_speed: f64,
    pub gust: f64,
}

impl Number {
    /// Its value now.
    pub(super) fn at(&self, inputs: &Inputs) -> f64 {
        let binding = match self {
            Self::Fixed(value) => return *value,
            Self::Bound(binding) => binding,
        };
        let input = match binding.input {
            Input::Impulse => inputs.impulse,
            Input::Speed => inputs.speed,
            Input::Mass => inputs.mass,
            Input::ContactTime => inputs.contact_time,
            Input::RigidPressure => inputs.rigid_pressure,
            Input::PositionX => inputs.position[0],
            Input::PositionY => inputs.position[1],
            Input::WindSpeed => inputs.wind_speed,
            Input::Gust => inputs.gust,
        };
        let raised = if binding.power == 1.0 { input } else { pow(input.abs(), binding.power).copysign(input) };
        let value = binding.offset + binding.scale * raised;
        value.max(binding.min.unwrap_or(f64::NEG_INFINITY)).min(binding.max.unwrap_or(f64::INFINITY))
    }

    fn follows_wind(&self) -> bool {
        matches!(self, Self::Bound(Binding { input: Input::WindSpeed | Input::Gust, .. }))
    }
}

impl Node {
    /// Names of the nodes it takes.
    pub(super) fn inputs(&self) -> &[String] {
        match self {
            Self::Modal { r#in, .. } => r#in.as_slice(),
            Self::Noise { .. } => &[],
            Self::Filter { r#in, .. } | Self::Env { r#in, .. } => std::slice::from_ref(r#in),
            Self::Sum { r#in, .. } | Self::Product { r#in, .. } => r#in,
        }
    }

    /// Its level.
    pub(super) fn gain(&self) -> Number {
        match self {
            Self::Modal { gain, .. }
            | Self::Noise { gain, .. }
            | Self::Filter { gain, .. }
            | Self::Env { gain, .. }
            | Self::Sum { gain, .. }
            | Self::Product { gain, .. } => *gain,
        }
    }

    fn follows_wind(&self) -> bool {
        let own = match self {
            Self::Filter { cutoff, q, .. } => cutoff.follows_wind() || q.follows_wind(),
            Self::Env { decay, .. } => decay.follows_wind(),
            _ => false,
        };
        own || self.gain().follows_wind()
    }
}

/// Names of the shipped timbres.
pub fn names() -> impl Iterator<Item = &'static str> {
    SHIPPED.iter().map(|(name, _)| *name)
}

/// The text of a shipped preset.
pub fn source(name: &str) -> Option<&'static str> {
    SHIPPED.iter().find(|(known, _)| *known == name).map(|(_, text)| *text)
}

impl Preset {
    /// A shipped preset by name.
    pub fn shipped(name: &str) -> Result<Self, TimbreError> {
        match source(name) {
            Some(text) => Self::parse(name, text),
            None => {
                let known: Vec<_> = names().collect();
                let near =
                    known.iter().max_by(|a, b| strsim::jaro_winkler(name, a).total_cmp(&strsim::jaro_winkler(name, b)));
                let hint = near.map(|n| format!("; did you mean \"{n}\"?")).unwrap_or_default();
                Err(TimbreError::new(name, "timbre", format!("no such timbre; there are {}{hint}", known.join(", "))))
            }
        }
    }

    /// A preset from its text; `name` must be the name inside.
    pub fn parse(name: &str, text: &str) -> Result<Self, TimbreError> {
        let table: toml::Table = text.parse().map_err(|e: toml::de::Error| {
            let line = e.span().map_or(0, |span| text[..span.start.min(text.len())].matches('\n').count() + 1);
            TimbreError::new(name, format!("line {line}"), e.message())
        })?;
        Self::from_table(name, table)
    }

    /// A preset from a parsed table (with values replaced, say, by a command line).
    pub fn from_table(name: &str, mut table: toml::Table) -> Result<Self, TimbreError> {
        // Node by node, so that an error knows the node it belongs to.
        let nodes = match table.remove("node") {
            Some(toml::Value::Table(nodes)) => nodes,
            _ => return Err(TimbreError::new(name, "node", "a timbre needs nodes, such as [node.out]")),
        };
        table.insert("node".into(), toml::Value::Table(toml::Table::new()));
        let mut preset: Self =
            table.try_into().map_err(|e: toml::de::Error| TimbreError::new(name, "top level", e.message()))?;
        for (key, value) in nodes {
            let node = value
                .try_into()
                .map_err(|e: toml::de::Error| TimbreError::new(name, format!("node.{key}"), e.message()))?;
            preset.node.insert(key, node);
        }
        preset.check(name)?;
        Ok(preset)
    }

    /// The wind plays it all the time; otherwise hits play it, one by one.
    pub fn continuous(&self) -> bool {
        self.node.values().any(Node::follows_wind)
    }

    fn check(&self, name: &str) -> Result<(), TimbreError> {
        let wrong = |key: String, problem: String| Err(TimbreError::new(name, key, problem));
        if self.timbre != VERSION {
            return wrong(
                "timbre".into(),
                format!("version {} is not known; this program reads {VERSION}", self.timbre),
            );
        }
        if self.name != name {
            return wrong("name".into(), format!("\"{}\" is not the file's name \"{name}\"", self.name));
        }
        if self.node.len() > MAX_NODES {
            return wrong("node".into(), format!("{} nodes; the limit is {MAX_NODES}", self.node.len()));
        }
        if self.node.values().filter(|n| matches!(n, Node::Modal { .. })).count() > 1 {
            return wrong("node".into(), "more than one modal node; put all partials into one".into());
        }
        for (key, node) in &self.node {
            for input in node.inputs() {
                if !self.node.contains_key(input) {
                    let known: Vec<_> = self.node.keys().map(String::as_str).collect();
                    return wrong(
                        format!("node.{key}.in"),
                        format!("no node \"{input}\"; there are {}", known.join(", ")),
                    );
                }
            }
            node.check(&|field, problem| TimbreError::new(name, format!("node.{key}.{field}"), problem))?;
        }
        self.order(name).map(drop)
    }

    /// Names of the nodes that `out` needs, each after those it takes.
    pub(super) fn order(&self, name: &str) -> Result<Vec<&str>, TimbreError> {
        /// Depth-first; `open` is the path from `out` down to here.
        fn visit<'a>(preset: &'a Preset, key: &'a str, open: &mut Vec<&'a str>, done: &mut Vec<&'a str>) -> bool {
            if done.contains(&key) {
                return true;
            }
            let Some(node) = preset.node.get(key).filter(|_| !open.contains(&key)) else { return false };
            open.push(key);
            let fine = node.inputs().iter().all(|input| visit(preset, input, open, done));
            open.pop();
            done.push(key);
            fine
        }
        let mut done = Vec::new();
        if visit(self, "out", &mut Vec::new(), &mut done) {
            Ok(done)
        } else if self.node.contains_key("out") {
            Err(TimbreError::new(name, "node", "nodes take each other in a ring"))
        } else {
            Err(TimbreError::new(name, "node.out", "missing: the node that is heard"))
        }
    }
}

impl Node {
    fn check(&self, error: &dyn Fn(&str, &str) -> TimbreError) -> Result<(), TimbreError> {
        let need = |fine: bool, field: &str, problem: &str| if fine { Ok(()) } else { Err(error(field, problem)) };
        let positive = |v: f64| v.is_finite() && v > 0.0;
        match self {
            Self::Modal {
                from,
                partials,
                support_loss,
                contact_radius,
                surface_modulus,
                detune,
                fundamental,
                table,
                ..
            } => {
                need((1..=MAX_PARTIALS).contains(partials), "partials", "must be 1 to 1024")?;
                need(support_loss.is_finite() && *support_loss >= 0.0, "support_loss", "must be 0 or more, 1/s")?;
                need(positive(*contact_radius), "contact_radius", "must be above 0, m")?;
                need(surface_modulus.is_none_or(positive), "surface_modulus", "must be above 0, Pa")?;
                need((0.0..=100.0).contains(detune), "detune", "must be 0 to 100 cents")?;
                let tabled = *from == ModalSource::Table;
                need(
                    fundamental.is_some_and(positive) == tabled,
                    "fundamental",
                    "a table needs one, in Hz; a plate has its own",
                )?;
                need(
                    (1..=MAX_PARTIALS).contains(&table.len()) == tabled,
                    "table",
                    "a table has 1 to 1024 partials; a plate has its own",
                )?;
                let fine = |p: &TablePartial| positive(p.ratio) && positive(p.t60) && p.gain.is_finite();
                need(table.iter().all(fine), "table", "ratios and t60 must be above 0")
            }
            Self::Noise { base, octaves, roughness, .. } => {
                need(positive(*base), "base", "must be above 0, Hz")?;
                need((1..=12).contains(octaves), "octaves", "must be 1 to 12")?;
                need((0.0..=1.0).contains(roughness), "roughness", "must be 0 to 1")
            }
            Self::Sum { r#in, .. } | Self::Product { r#in, .. } => need(!r#in.is_empty(), "in", "must name a node"),
            Self::Filter { .. } | Self::Env { .. } => Ok(()),
        }
    }
}

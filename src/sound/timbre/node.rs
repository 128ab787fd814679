//! The operators of a timbre, as a preset writes them.

use schemars::JsonSchema;
use serde::Deserialize;

use super::formula::Formula;
use super::number::{Input, Number, Player, one};
use super::source::Modal;

/// One operator of a timbre.
#[derive(Clone, Debug, JsonSchema, PartialEq)]
#[serde(tag = "type", rename_all = "kebab-case")]
pub enum Node {
    /// Decaying partials, set ringing by hits or driven by a force: Σ a e^(−ct) sin ωt. At most one in a timbre.
    Modal(Box<Modal>),
    /// Endless noise.
    Noise(Noise),
    /// An endless periodic tone, whose phase another node may modulate.
    Oscillator(Oscillator),
    /// Frequency modulation: a sine whose frequency a second sine moves to and fro (Chowning, JAES 21, 1973).
    Fm(Fm),
    /// A formula of nodes, inputs and time.
    Function(Function),
    /// A line across a surface, read at the place of the contact: the needle of a gramophone.
    Texture(Texture),
    /// State-variable or one-pole filter.
    Filter(Filter),
    /// Multiplies by an envelope that begins with the hit.
    Env(Env),
    /// A number as a signal.
    Value(Value),
    /// A curve: what goes in is looked up.
    Map(Map),
    /// The same, later.
    Delay(Delay),
    /// Adds nodes.
    Sum(Mix),
    /// Multiplies nodes.
    Product(Mix),
}

/// Names of the types of nodes.
pub(super) const TYPES: [&str; 13] = [
    "modal",
    "noise",
    "oscillator",
    "fm",
    "function",
    "texture",
    "filter",
    "env",
    "value",
    "map",
    "delay",
    "sum",
    "product",
];

/// Endless noise.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Noise {
    /// Its kind.
    #[serde(default)]
    pub kind: NoiseKind,
    /// `perlin` and `multifractal`: rate of the slowest octave, Hz.
    #[serde(default = "one_hertz")]
    pub base: f64,
    /// `perlin` and `multifractal`: number of octaves, 1…12. Those above a quarter of the rate of control are left out.
    #[serde(default = "one_octave")]
    pub octaves: u32,
    /// `perlin` and `multifractal`: Hurst exponent H; the spectrum falls as f^(−1−2H).
    #[serde(default = "kolmogorov")]
    pub roughness: f64,
    /// Linear gain of the node's output.
    #[serde(default = "one")]
    pub gain: Number,
}

/// Kind of a noise.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum NoiseKind {
    /// Every sample on its own, uniform in ±1.
    #[default]
    White,
    /// 3 dB less in each octave, as loud as white noise in all.
    Pink,
    /// Octaves of gradient noise, about ±1, slow: it steers.
    Perlin,
    /// Gusts: a product of octaves of gradient noise, mean 1 ([`multifractal`](crate::multifractal)).
    Multifractal,
}

/// An endless periodic tone of amplitude 1.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Oscillator {
    /// Its waveform.
    #[serde(default)]
    pub shape: Waveform,
    /// Hz; a negative one counts as positive.
    pub frequency: Number,
    /// Where in its period it begins, 0…1.
    #[serde(default)]
    pub phase: f64,
    /// Node that modulates the phase.
    pub r#in: Option<String>,
    /// Phase that this node adds where its sample is 1, rad.
    #[serde(default = "one")]
    pub index: Number,
    /// Linear gain of the node's output.
    #[serde(default = "one")]
    pub gain: Number,
}

/// Waveform of an oscillator. Corners are rounded so far that they do not alias.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum Waveform {
    /// The fundamental alone.
    #[default]
    Sine,
    /// Odd harmonics that fall with the square of their number.
    Triangle,
    /// All harmonics, falling with their number: it rises and jumps back.
    Saw,
    /// Odd harmonics that fall with their number.
    Square,
}

/// sin(2π f t + I sin(2π r f t)) of amplitude 1: partials at f ± k r f with the amplitudes of Bessel's functions J_k(I).
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Fm {
    /// Frequency f of the carrier, Hz.
    pub carrier: Number,
    /// Frequency of the modulator over that of the carrier, r; whole numbers sound harmonic, others like metal.
    #[serde(default = "one")]
    pub ratio: Number,
    /// Index of the modulation I, rad: larger is brighter.
    #[serde(default = "one")]
    pub index: Number,
    /// Linear gain of the node's output.
    #[serde(default = "one")]
    pub gain: Number,
}

/// A formula of nodes, inputs and time.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Function {
    /// Nodes that the formula names.
    #[serde(default)]
    pub r#in: Vec<String>,
    /// The formula, such as `"low * max(0, body_spin - 2) + 0.1 * sin(2 * pi * 3 * t)"`: signs + − * / % ^, the functions sin,
    /// cos, exp, ln, sqrt, tanh, abs, floor, min, max, clamp(x, low, high) and step(edge, x), the nodes of `in`, inputs, the time
    /// t since the sound began in s, and pi. Names of nodes in it have letters, digits and underscores.
    pub of: String,
    /// Linear gain of the node's output.
    #[serde(default = "one")]
    pub gain: Number,
}

/// A line across a surface.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Texture {
    /// What the surface is.
    pub kind: TextureKind,
    /// Size of its coarsest pattern, m: a year's ring, a vein, a grain.
    #[serde(default = "two_millimetres")]
    pub grain: f64,
    /// Octaves of detail below that, 1…12.
    #[serde(default = "eight_octaves")]
    pub octaves: u32,
    /// H of the detail: the roughness falls as f^(−1−2H).
    #[serde(default = "kolmogorov")]
    pub roughness: f64,
    /// Distance between its points, m; finer detail is not there.
    #[serde(default = "ten_micrometres")]
    pub resolution: f64,
    /// Another piece of the same surface.
    #[serde(default)]
    pub seed: u64,
    /// `image`: a body without a picture is smooth; otherwise it is a mistake.
    #[serde(default)]
    pub optional: bool,
    /// Speed at which it is read, m/s.
    #[serde(default = "slip_speed")]
    pub speed: Number,
    /// Linear gain of the node's output.
    #[serde(default = "one")]
    pub gain: Number,
}

/// What a surface is made of.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum TextureKind {
    /// Years' rings, cut across, with the pores between them.
    Wood,
    /// Veins: a sine disturbed by noise.
    Marble,
    /// Rough without a pattern: stone, cast or brushed metal.
    Rough,
    /// The surface of the body itself: a line of its picture.
    Image,
}

/// A filter.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Filter {
    /// Node that is filtered.
    pub r#in: String,
    /// Which it is.
    pub kind: FilterKind,
    /// Corner or centre, Hz.
    pub cutoff: Number,
    /// Resonance; 0.707 is flat. Not for `one-pole`.
    #[serde(default = "flat")]
    pub q: Number,
    /// Linear gain of the node's output.
    #[serde(default = "one")]
    pub gain: Number,
}

/// Kind of a filter.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "kebab-case")]
pub enum FilterKind {
    /// Below the corner, 12 dB per octave.
    LowPass,
    /// Around the centre; gain 1 there.
    BandPass,
    /// Above the corner, 12 dB per octave.
    HighPass,
    /// Below the corner, 6 dB per octave.
    OnePole,
}

/// An envelope that begins with the hit.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Env {
    /// Node that is shaped.
    pub r#in: String,
    /// Time in which it rises to 1, s; without one it begins there.
    #[serde(default = "zero")]
    pub attack: Number,
    /// Time constant with which it falls then, s.
    pub decay: Number,
    /// Linear gain of the node's output.
    #[serde(default = "one")]
    pub gain: Number,
}

/// A number as a signal, gliding from one reading to the next.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Value {
    /// The number.
    pub gain: Number,
}

/// A curve by points.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Map {
    /// Node that is looked up.
    pub r#in: String,
    /// [in, out], ascending; straight lines between them, level beyond.
    pub points: Vec<[f64; 2]>,
    /// Linear gain of the node's output.
    #[serde(default = "one")]
    pub gain: Number,
}

/// A delay line with feedback: its input, later.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Delay {
    /// Node that is delayed.
    pub r#in: String,
    /// By how much, s, at most 0.1; read once, when the sound begins.
    pub time: Number,
    /// Share that goes round again, −0.99…0.99.
    #[serde(default)]
    pub feedback: f64,
    /// Linear gain of the node's output.
    #[serde(default = "one")]
    pub gain: Number,
}

/// Several nodes as one.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Mix {
    /// The nodes.
    pub r#in: Vec<String>,
    /// Linear gain of the node's output.
    #[serde(default = "one")]
    pub gain: Number,
}

fn zero() -> Number {
    Number::Fixed(0.0)
}
fn flat() -> Number {
    Number::Fixed(std::f64::consts::FRAC_1_SQRT_2)
}
fn slip_speed() -> Number {
    Number::following(Input::SlipSpeed)
}
fn one_hertz() -> f64 {
    1.0
}
fn one_octave() -> u32 {
    1
}
fn eight_octaves() -> u32 {
    8
}
fn kolmogorov() -> f64 {
    1.0 / 3.0
}
fn two_millimetres() -> f64 {
    2e-3
}
fn ten_micrometres() -> f64 {
    1e-5
}

impl Function {
    /// The formula as a program.
    ///
    /// # Errors
    /// What is wrong with it.
    pub(crate) fn compile(&self) -> Result<Formula, String> {
        Formula::parse(&self.of, &self.r#in)
    }
}

impl Node {
    /// Names of the nodes it takes.
    pub(crate) fn inputs(&self) -> &[String] {
        match self {
            Self::Modal(modal) => modal.r#in.as_slice(),
            Self::Noise(_) | Self::Fm(_) | Self::Texture(_) | Self::Value(_) => &[],
            Self::Oscillator(oscillator) => oscillator.r#in.as_slice(),
            Self::Function(function) => &function.r#in,
            Self::Filter(Filter { r#in, .. })
            | Self::Env(Env { r#in, .. })
            | Self::Map(Map { r#in, .. })
            | Self::Delay(Delay { r#in, .. }) => std::slice::from_ref(r#in),
            Self::Sum(mix) | Self::Product(mix) => &mix.r#in,
        }
    }

    /// Its level.
    pub(crate) fn gain(&self) -> Number {
        match self {
            Self::Modal(modal) => modal.gain,
            Self::Noise(Noise { gain, .. })
            | Self::Oscillator(Oscillator { gain, .. })
            | Self::Fm(Fm { gain, .. })
            | Self::Function(Function { gain, .. })
            | Self::Texture(Texture { gain, .. })
            | Self::Filter(Filter { gain, .. })
            | Self::Env(Env { gain, .. })
            | Self::Value(Value { gain })
            | Self::Map(Map { gain, .. })
            | Self::Delay(Delay { gain, .. })
            | Self::Sum(Mix { gain, .. })
            | Self::Product(Mix { gain, .. }) => *gain,
        }
    }

    /// Every number of it that may follow the motion, by its key.
    pub(super) fn numbers(&self) -> Vec<(&'static str, Number)> {
        let mut numbers = vec![("gain", self.gain())];
        match self {
            Self::Filter(filter) => numbers.extend([("cutoff", filter.cutoff), ("q", filter.q)]),
            Self::Env(env) => numbers.extend([("attack", env.attack), ("decay", env.decay)]),
            Self::Texture(texture) => numbers.push(("speed", texture.speed)),
            Self::Delay(delay) => numbers.push(("time", delay.time)),
            Self::Oscillator(Oscillator { frequency, index, .. }) => {
                numbers.extend([("frequency", *frequency), ("index", *index)]);
            }
            Self::Fm(Fm { carrier, ratio, index, .. }) => {
                numbers.extend([("carrier", *carrier), ("ratio", *ratio), ("index", *index)]);
            }
            _ => {}
        }
        numbers
    }

    /// Everything that it follows.
    pub(super) fn follows(&self) -> Vec<Input> {
        let formula = match self {
            Self::Function(function) => function.compile().map(|formula| formula.inputs).unwrap_or_default(),
            _ => Vec::new(),
        };
        let numbers = self.numbers();
        numbers.iter().flat_map(|(_, number)| number.inputs()).chain(formula).collect()
    }

    /// Whether it follows an input that plays timbres so.
    pub(super) fn is_played_by(&self, player: Player) -> bool {
        self.follows().iter().any(|input| input.player() == player)
    }
}

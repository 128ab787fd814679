//! Numbers that may follow the motion.
//!
//! ```text
//! value = offset + scale · x^power · Π factor + Σ term        within min … max
//! factor = (offset + x)^power        term = scale · x^power
//! ```
//!
//! x is an [`Input`]. A power keeps the sign of what it raises; 0 raised to a negative power is 0 (no input, no
//! output), so no input can make a number that is not finite.

use schemars::JsonSchema;
use serde::de::value::MapAccessDeserializer;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer};

use crate::BodyMotion;
use soffio_math::pow;

/// Most factors, and most terms, of one number: bounds the work of a reading.
pub const MAX_FACTORS: usize = 3;
/// Bound of the magnitude of every number, in its own unit: beyond it a file is wrong.
const BOUND: f64 = 1e12;

/// A number of a preset: fixed, or following the motion.
#[derive(Clone, Copy, Debug, JsonSchema, PartialEq)]
#[schemars(untagged)]
#[allow(clippy::large_enum_variant, reason = "copied into flat programs once, never moved about after")]
pub enum Number {
    /// Always this.
    Fixed(f64),
    /// offset + scale · input^power · factors + terms, within min…max.
    Bound(Binding),
}

/// How a number follows the motion: offset + scale · input^power · factors + terms, within min…max.
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
    /// Value where the input is 0, in the number's own unit.
    #[serde(default)]
    pub offset: f64,
    /// Other inputs that it is multiplied by.
    #[serde(default)]
    pub times: Few<Factor>,
    /// Other inputs that are added.
    #[serde(default)]
    pub plus: Few<Term>,
    /// Least value.
    pub min: Option<f64>,
    /// Largest value.
    pub max: Option<f64>,
}

/// (offset + input)^power.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Factor {
    /// What it follows.
    pub input: Input,
    /// Exponent.
    #[serde(default = "unity")]
    pub power: f64,
    /// Added to the input.
    #[serde(default)]
    pub offset: f64,
}

/// scale · input^power.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Term {
    /// What it follows.
    pub input: Input,
    /// Factor.
    #[serde(default = "unity")]
    pub scale: f64,
    /// Exponent.
    #[serde(default = "unity")]
    pub power: f64,
}

/// At most [`MAX_FACTORS`] things, in place: numbers are copied into the synth's flat program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Few<T>([Option<T>; MAX_FACTORS]);

impl<T> Default for Few<T> {
    fn default() -> Self {
        Self([const { None }; MAX_FACTORS])
    }
}

impl<T> Few<T> {
    fn iter(&self) -> impl Iterator<Item = &T> {
        self.0.iter().flatten()
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Few<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let given = Vec::<T>::deserialize(deserializer)?;
        if given.len() > MAX_FACTORS {
            let problem = format!("{} inputs in one list; the limit is {MAX_FACTORS}", given.len());
            return Err(serde::de::Error::custom(problem));
        }
        let mut given = given.into_iter();
        Ok(Self(std::array::from_fn(|_| given.next())))
    }
}

impl<T: JsonSchema> JsonSchema for Few<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        format!("Few_{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        let items = generator.subschema_for::<T>();
        schemars::json_schema!({ "type": "array", "items": items, "maxItems": MAX_FACTORS })
    }
}

fn unity() -> f64 {
    1.0
}

impl<'de> Deserialize<'de> for Number {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        /// Reads either shape, so that what is wrong inside a table is said about that table.
        struct Either;

        impl<'de> Visitor<'de> for Either {
            type Value = Number;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a number, or a table such as { input = \"speed\", scale = 2 }")
            }

            fn visit_f64<E>(self, value: f64) -> Result<Number, E> {
                Ok(Number::Fixed(value))
            }

            fn visit_i64<E>(self, value: i64) -> Result<Number, E> {
                Ok(Number::Fixed(value as f64))
            }

            fn visit_u64<E>(self, value: u64) -> Result<Number, E> {
                Ok(Number::Fixed(value as f64))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Number, A::Error> {
                Binding::deserialize(MapAccessDeserializer::new(map)).map(Number::Bound)
            }
        }

        deserializer.deserialize_any(Either)
    }
}

/// What a number can follow. Inputs of wind, touch and motion change all the time, the others are those of the hit.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Input {
    /// Impulse of the hit, N s.
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
    /// Speed at which surfaces slide over each other, m/s.
    SlipSpeed,
    /// Force that presses sliding surfaces together, N.
    NormalForce,
    /// Speed of the air, m/s.
    WindSpeed,
    /// Where the wind goes, seen from above: 0 away from the visitor, positive to the right, rad.
    WindDirection,
    /// Relative gust, about ±1.
    Gust,
    /// Speed of the body's centre of mass, m/s.
    BodySpeed,
    /// Angular speed of the body, rad/s.
    BodySpin,
    /// Force of the joint that the sound names, N.
    JointForce,
    /// Pull of the spring or cord that the sound names, N.
    Tension,
    /// Way of the centre of mass along its path since the start, m.
    Way,
    /// Height of the centre of mass above its start, m.
    Height,
    /// Distance of the body from the visitor, m.
    Distance,
    /// The sound's own `parameter` in the exhibit, in its own unit.
    Parameter,
}

/// Names of the inputs as files write them.
pub(crate) const INPUTS: [(&str, Input); 20] = [
    ("impulse", Input::Impulse),
    ("speed", Input::Speed),
    ("mass", Input::Mass),
    ("contact_time", Input::ContactTime),
    ("rigid_pressure", Input::RigidPressure),
    ("position_x", Input::PositionX),
    ("position_y", Input::PositionY),
    ("slip_speed", Input::SlipSpeed),
    ("normal_force", Input::NormalForce),
    ("wind_speed", Input::WindSpeed),
    ("wind_direction", Input::WindDirection),
    ("gust", Input::Gust),
    ("body_speed", Input::BodySpeed),
    ("body_spin", Input::BodySpin),
    ("joint_force", Input::JointForce),
    ("tension", Input::Tension),
    ("way", Input::Way),
    ("height", Input::Height),
    ("distance", Input::Distance),
    ("parameter", Input::Parameter),
];

/// Values of all inputs at one moment, by the names of [`Input`].
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Inputs {
    /// Impulse of the hit, N s.
    pub impulse: f64,
    /// Approach speed of the hit, m/s.
    pub speed: f64,
    /// Effective mass of the hit, kg.
    pub mass: f64,
    /// Contact time of the hit, s.
    pub contact_time: f64,
    /// Pressure 1 m away if the body's whole face moved as the hit pushes it, of full scale.
    pub rigid_pressure: f64,
    /// Place of the hit along both half extents, −1 … 1.
    pub position: [f64; 2],
    /// Speed at which surfaces slide over each other, m/s.
    pub slip_speed: f64,
    /// Force that presses sliding surfaces together, N.
    pub normal_force: f64,
    /// Speed of the air, m/s.
    pub wind_speed: f64,
    /// Direction of the wind seen from above, rad: 0 away from the visitor, positive to the right.
    pub wind_direction: f64,
    /// Relative gust, about ±1.
    pub gust: f64,
    /// Motion of the body.
    pub motion: BodyMotion,
    /// Distance of the body from the visitor, m.
    pub distance: f64,
}

impl Inputs {
    pub(crate) fn of(&self, input: Input) -> f64 {
        match input {
            Input::Impulse => self.impulse,
            Input::Speed => self.speed,
            Input::Mass => self.mass,
            Input::ContactTime => self.contact_time,
            Input::RigidPressure => self.rigid_pressure,
            Input::PositionX => self.position[0],
            Input::PositionY => self.position[1],
            Input::SlipSpeed => self.slip_speed,
            Input::NormalForce => self.normal_force,
            Input::WindSpeed => self.wind_speed,
            Input::WindDirection => self.wind_direction,
            Input::Gust => self.gust,
            Input::BodySpeed => f64::from(self.motion.speed),
            Input::BodySpin => f64::from(self.motion.spin),
            Input::JointForce => f64::from(self.motion.joint_force),
            Input::Tension => f64::from(self.motion.tension),
            Input::Way => f64::from(self.motion.way),
            Input::Height => f64::from(self.motion.height),
            Input::Distance => self.distance,
            Input::Parameter => f64::from(self.motion.parameter),
        }
    }
}

/// |x|^power with the sign of x.
fn raise(x: f64, power: f64) -> f64 {
    if power == 1.0 {
        x
    } else if x == 0.0 {
        if power == 0.0 { 1.0 } else { 0.0 }
    } else {
        pow(x.abs(), power).copysign(x)
    }
}

impl Number {
    /// The input itself.
    pub(super) fn following(input: Input) -> Self {
        let (times, plus) = (Few::default(), Few::default());
        Self::Bound(Binding { input, scale: 1.0, power: 1.0, offset: 0.0, times, plus, min: None, max: None })
    }

    /// Its value now: finite for finite inputs.
    pub(crate) fn at(&self, inputs: &Inputs) -> f64 {
        let binding = match self {
            Self::Fixed(value) => return *value,
            Self::Bound(binding) => binding,
        };
        let mut product = binding.scale * raise(inputs.of(binding.input), binding.power);
        for factor in binding.times.iter() {
            product *= raise(inputs.of(factor.input) + factor.offset, factor.power);
        }
        let mut value = binding.offset + product;
        for term in binding.plus.iter() {
            value += term.scale * raise(inputs.of(term.input), term.power);
        }
        // Where infinities meet there is no number: nothing is heard.
        let value = if value.is_nan() { 0.0 } else { value };
        value.max(binding.min.unwrap_or(-BOUND)).min(binding.max.unwrap_or(BOUND))
    }

    /// Everything it follows.
    pub(super) fn inputs(&self) -> impl Iterator<Item = Input> {
        let binding = match self {
            Self::Fixed(_) => None,
            Self::Bound(binding) => Some(binding),
        };
        binding.into_iter().flat_map(|b| {
            let others = b.times.iter().map(|f| f.input).chain(b.plus.iter().map(|t| t.input));
            std::iter::once(b.input).chain(others)
        })
    }

    /// What is wrong with it, if anything.
    pub(super) fn problem(&self) -> Option<String> {
        let binding = match self {
            Self::Fixed(value) => return (!value.is_finite()).then(|| format!("{value} is not a number to play")),
            Self::Bound(binding) => binding,
        };
        let mut numbers = vec![("scale", binding.scale), ("power", binding.power), ("offset", binding.offset)];
        numbers.extend(binding.min.map(|v| ("min", v)));
        numbers.extend(binding.max.map(|v| ("max", v)));
        numbers.extend(binding.times.iter().flat_map(|f| [("times.power", f.power), ("times.offset", f.offset)]));
        numbers.extend(binding.plus.iter().flat_map(|t| [("plus.power", t.power), ("plus.scale", t.scale)]));
        if let Some((field, value)) = numbers.iter().find(|(_, v)| v.is_nan() || v.abs() > BOUND) {
            return Some(format!("its {field} {value} is not a number within ±{BOUND:e}"));
        }
        match (binding.min, binding.max) {
            (Some(min), Some(max)) if min > max => Some(format!("its min {min} is above its max {max}")),
            _ => None,
        }
    }
}

/// How an input plays a timbre.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Player {
    Hit,
    Wind,
    Slide,
    Motion,
}

impl Input {
    pub(super) fn player(self) -> Player {
        match self {
            Self::WindSpeed | Self::WindDirection | Self::Gust => Player::Wind,
            Self::SlipSpeed | Self::NormalForce => Player::Slide,
            Self::BodySpeed
            | Self::BodySpin
            | Self::JointForce
            | Self::Tension
            | Self::Way
            | Self::Height
            | Self::Distance
            | Self::Parameter => Player::Motion,
            Self::Impulse
            | Self::Speed
            | Self::Mass
            | Self::ContactTime
            | Self::RigidPressure
            | Self::PositionX
            | Self::PositionY => Player::Hit,
        }
    }
}

/// A factor that leaves what it multiplies.
pub(super) fn one() -> Number {
    Number::Fixed(1.0)
}

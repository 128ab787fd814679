//! Physical quantities with units: a bare number is SI, a text carries its unit (`"35 deg"`, `"12 mm"`, `"2.7 g/cm3"`).
//!
//! Each kind of quantity is a type of its own: a mass in place of a length is refused by the schema check, which lists
//! the units that fit. Each kind has a limit: what a museum can hold, with a margin of ten to a thousand. Beyond it a run takes
//! minutes a second, or products of numbers lose their digits.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::{Deserialize, Deserializer, Serialize, de};
use serde_json::Value;

/// Splits `"12 mm"` into number and unit.
fn split(text: &str) -> Option<(f64, &str)> {
    let text = text.trim();
    let unit_at = text.char_indices().find(|&(i, c)| {
        // The e of an exponent is part of the number where a digit or sign follows it.
        let exponent =
            matches!(c, 'e' | 'E') && text[i + 1..].starts_with(|n: char| n.is_ascii_digit() || "+-".contains(n));
        !(c.is_ascii_digit() || "+-.".contains(c) || exponent)
    });
    let (number, unit) = text.split_at(unit_at.map_or(text.len(), |(i, _)| i));
    number.trim().parse().ok().filter(|n: &f64| n.is_finite()).map(|n| (n, unit.trim()))
}

fn convert(text: &str, units: &[(&str, f64)]) -> Result<f64, String> {
    let expected = || units.iter().map(|(unit, _)| *unit).collect::<Vec<_>>().join(", ");
    let (number, unit) = split(text).ok_or_else(|| format!("\"{text}\" does not begin with a number"))?;
    let factor = units.iter().find(|(name, _)| *name == unit).map(|(_, factor)| *factor);
    factor
        .map(|factor| number * factor)
        .ok_or_else(|| format!("\"{unit}\" is not a valid unit here; use one of {}", expected()))
}

fn read<'de, D: Deserializer<'de>>(deserializer: D, units: &[(&str, f64)]) -> Result<f64, D::Error> {
    #[derive(Deserialize)]
    #[serde(untagged)]
    enum Raw {
        Number(f64),
        Text(String),
    }
    match Raw::deserialize(deserializer)? {
        Raw::Number(number) => Ok(number),
        Raw::Text(text) => convert(&text, units).map_err(de::Error::custom),
    }
}

fn schema(kind: &str, units: &[(&str, f64)]) -> Schema {
    let names: Vec<&str> = units.iter().map(|(unit, _)| *unit).collect();
    let pattern = names.iter().map(|unit| unit.replace('/', "\\/")).collect::<Vec<_>>().join("|");
    json_schema!({
        "description": format!("{kind}: a number in {}, or a text with a unit ({}).", names[0], names.join(", ")),
        "anyOf": [
            { "type": "number" },
            { "type": "string", "pattern": format!(r"^\s*[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?\s*({pattern})\s*$") },
        ],
    })
}

/// A number in SI units.
pub trait Quantity: Copy {
    /// The value in SI units.
    fn si(self) -> f64;
}

impl Quantity for f64 {
    fn si(self) -> f64 {
        self
    }
}

/// The limit of a kind of quantity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    /// Name of its type, and of its definition in the schema.
    pub name: &'static str,
    /// The kind, for messages.
    pub kind: &'static str,
    /// Greatest magnitude, SI.
    pub most: f64,
    /// Units, the SI unit first, with their factors.
    pub units: &'static [(&'static str, f64)],
}

impl Bound {
    /// The value of a number or a text with a unit, SI; `None` for anything else.
    pub fn value(&self, value: &Value) -> Option<f64> {
        match value {
            Value::String(text) => convert(text, self.units).ok(),
            other => other.as_f64(),
        }
    }

    /// The limit with its unit.
    pub fn shown(&self) -> String {
        format!("{} {}", self.most, self.units.first().map_or("", |(unit, _)| unit))
    }
}

/// Greatest magnitude of a number without a unit: factors, directions and coefficients are far below it, and its square and
/// cube stay exact enough.
pub const MAX_NUMBER: f64 = 1e9;
/// Greatest count, such as teeth of a gear or voices of a sound.
pub const MAX_COUNT: u64 = 10_000;

macro_rules! quantities {
    ($($(#[$doc:meta])* $name:ident, $kind:literal, $most:expr, [$(($unit:literal, $factor:expr)),+];)*) => {
        /// The limits of all kinds.
        pub const BOUNDS: &[Bound] =
            &[$(Bound { name: stringify!($name), kind: $kind, most: $most, units: $name::UNITS }),*];
        $(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, Default, PartialEq, PartialOrd, Serialize)]
        pub struct $name(pub f64);

        impl $name {
            const UNITS: &[(&'static str, f64)] = &[$(($unit, $factor)),+];
        }

        impl Quantity for $name {
            fn si(self) -> f64 {
                self.0
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                read(deserializer, Self::UNITS).map(Self)
            }
        }

        impl JsonSchema for $name {
            fn schema_name() -> Cow<'static, str> {
                stringify!($name).into()
            }
            fn json_schema(_: &mut SchemaGenerator) -> Schema {
                schema($kind, Self::UNITS)
            }
        }
    )*};
}

const DEGREE: f64 = soffio_math::PI / 180.0;

quantities! {
    /// A length, m. No hall is longer than 1 km.
    Length, "length", 1e3, [("m", 1.0), ("mm", 1e-3), ("cm", 1e-2), ("in", 0.0254)];
    /// A mass, kg. 1,000 t.
    Mass, "mass", 1e6, [("kg", 1.0), ("g", 1e-3), ("mg", 1e-6), ("t", 1e3)];
    /// A density, kg/m³. Osmium has 22,600.
    Density, "density", 1e5, [("kg/m3", 1.0), ("g/cm3", 1e3)];
    /// A pressure or modulus, Pa. Diamond has 1.2 · 10¹².
    Pressure, "pressure", 1e13, [("Pa", 1.0), ("kPa", 1e3), ("MPa", 1e6), ("GPa", 1e9)];
    /// An angle, rad.
    Angle, "angle", 1e6, [("rad", 1.0), ("deg", DEGREE)];
    /// A speed, m/s. The simulation refuses more.
    Speed, "speed", 1e3, [("m/s", 1.0), ("cm/s", 1e-2), ("mm/s", 1e-3), ("km/h", 1.0 / 3.6)];
    /// An angular velocity, rad/s. The simulation refuses more.
    Rotation, "angular velocity", 1e5, [("rad/s", 1.0), ("deg/s", DEGREE), ("rpm", soffio_math::PI / 30.0)];
    /// An acceleration, m/s².
    Acceleration, "acceleration", 1e4, [("m/s2", 1.0)];
    /// A time, s. 116 days.
    Time, "time", 1e7, [("s", 1.0), ("ms", 1e-3), ("min", 60.0)];
    /// A rate, 1/s.
    Rate, "rate", 1e6, [("/s", 1.0), ("1/s", 1.0), ("/min", 1.0 / 60.0)];
    /// A level: dB of an amplitude ratio.
    Decibel, "level", 200.0, [("dB", 1.0)];
    /// Points per area, 1/m².
    PerArea, "density of points", 1e9, [("/m2", 1.0), ("/cm2", 1e4), ("/dm2", 1e2)];
    /// A stiffness, N/m.
    Stiffness, "stiffness", 1e12, [("N/m", 1.0), ("N/mm", 1e3), ("N/cm", 1e2)];
    /// A damping coefficient, N s/m.
    Damping, "damping", 1e9, [("Ns/m", 1.0), ("N s/m", 1.0), ("kg/s", 1.0)];
    /// An angular stiffness, N m/rad.
    AngularStiffness, "angular stiffness", 1e12, [("N m/rad", 1.0), ("Nm/rad", 1.0), ("N mm/rad", 1e-3), ("N m/deg", 1.0 / DEGREE)];
    /// An angular damping coefficient, N m s/rad.
    AngularDamping, "angular damping", 1e9, [("N m s/rad", 1.0), ("Nms/rad", 1.0), ("N mm s/rad", 1e-3)];
    /// A force, N.
    Force, "force", 1e9, [("N", 1.0), ("mN", 1e-3), ("kN", 1e3)];
    /// A torque, N m.
    Torque, "torque", 1e9, [("N m", 1.0), ("Nm", 1.0), ("N mm", 1e-3), ("mN m", 1e-3)];
    /// An impulse, N s.
    Impulse, "impulse", 1e9, [("N s", 1.0), ("Ns", 1.0), ("mN s", 1e-3)];
    /// A moment of inertia, kg m².
    Inertia, "moment of inertia", 1e10, [("kg m2", 1.0), ("g cm2", 1e-7)];
}

#[cfg(test)]
mod tests {
    use super::*;

    fn length(json: &str) -> Result<f64, String> {
        serde_json::from_str::<Length>(json).map(|l| l.0).map_err(|e| e.to_string())
    }

    #[test]
    fn units_convert_to_si() {
        assert_eq!(length("0.25"), Ok(0.25));
        assert_eq!(length("\"12 mm\""), Ok(12.0 * 1e-3));
        assert_eq!(length("\"1.5e-3 m\""), Ok(1.5e-3));
        assert_eq!(length("\"-2in\""), Ok(-2.0 * 0.0254));
        assert_eq!(serde_json::from_str::<Density>("\"2.7 g/cm3\"").unwrap().0, 2.7 * 1e3);
        assert_eq!(serde_json::from_str::<Angle>("\"180 deg\"").unwrap().0, 180.0 * DEGREE);
    }

    #[test]
    fn a_unit_of_another_kind_is_refused_and_the_right_ones_named() {
        let message = length("\"3 kg\"").unwrap_err();
        assert!(message.contains("\"kg\" is not a valid unit here") && message.contains("mm"), "{message}");
        assert!(length("\"mm\"").is_err() && length("\"\"").is_err() && length("\"nan m\"").is_err());
    }
}

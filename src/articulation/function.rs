//! Functions of time for a constraint's value and a spring's stiffness: number, keys, or wave, with two derivatives.
//!
//! A constraint that follows f(t) needs ḟ in its velocity and f̈ in its acceleration, so both are exact here:
//!
//! ```text
//! linear   f = a + (b − a) s,                    s = (t − t₀)/(t₁ − t₀)
//! smooth   f = a + (b − a) (10 s³ − 15 s⁴ + 6 s⁵)     ḟ and f̈ vanish at both keys: a follower feels no jerk there
//! wave     f = mean + amplitude · sin(2π t/period + phase)
//! ```

use crate::math::{PI, sincos};

/// A number that may change with time, SI units of whatever it stands for.
#[derive(Clone, Debug, PartialEq)]
pub enum Function {
    /// Always the same.
    Constant(f64),
    /// Through given values.
    Keys {
        /// (time s, value), times rising, at least one.
        keys: Vec<(f64, f64)>,
        /// What happens between two keys.
        interpolation: Interpolation,
        /// Begins anew after the last key; otherwise the last value stays.
        repeat: bool,
    },
    /// A sine about a mean.
    Wave {
        /// Mean value.
        mean: f64,
        /// Largest departure from it.
        amplitude: f64,
        /// s, positive.
        period: f64,
        /// rad at t = 0.
        phase: f64,
    },
}

/// What happens between two keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Interpolation {
    /// The earlier value, until the next key.
    Step,
    /// A straight line.
    Linear,
    /// A straight line's ends joined without jerk (quintic).
    #[default]
    Smooth,
}

/// A function's value and derivatives at one time.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Jet3 {
    /// f.
    pub value: f64,
    /// ḟ, per s.
    pub rate: f64,
    /// f̈, per s².
    pub acceleration: f64,
}

impl Default for Function {
    fn default() -> Self {
        Self::Constant(0.0)
    }
}

impl Function {
    /// Value and derivatives at `t` seconds.
    pub fn at(&self, t: f64) -> Jet3 {
        match self {
            Self::Constant(value) => Jet3 { value: *value, ..Jet3::default() },
            Self::Wave { mean, amplitude, period, phase } => {
                let omega = 2.0 * PI / period;
                let (s, c) = sincos(omega * t + phase);
                Jet3 {
                    value: mean + amplitude * s,
                    rate: amplitude * omega * c,
                    acceleration: -amplitude * omega * omega * s,
                }
            }
            Self::Keys { keys, interpolation, repeat } => between(keys, *interpolation, *repeat, t),
        }
    }

    /// Is it the same at all times?
    pub fn is_constant(&self) -> bool {
        matches!(self, Self::Constant(_))
    }
}

impl From<f64> for Function {
    fn from(value: f64) -> Self {
        Self::Constant(value)
    }
}

fn between(keys: &[(f64, f64)], interpolation: Interpolation, repeat: bool, t: f64) -> Jet3 {
    let Some((&(first, start), &(last, end))) = keys.first().zip(keys.last()) else { return Jet3::default() };
    let still = |value| Jet3 { value, ..Jet3::default() };
    let length = last - first;
    let t = if repeat && length > 0.0 { first + (t - first) - length * ((t - first) / length).floor() } else { t };
    if t < first {
        return still(start);
    }
    let after = keys.partition_point(|&(time, _)| time <= t);
    if after == keys.len() {
        return still(end);
    }
    let ((t0, a), (t1, b)) = (keys[after - 1], keys[after]);
    let (span, rise) = (t1 - t0, b - a);
    let s = (t - t0) / span;
    match interpolation {
        Interpolation::Step => still(a),
        Interpolation::Linear => Jet3 { value: a + rise * s, rate: rise / span, acceleration: 0.0 },
        Interpolation::Smooth => Jet3 {
            value: a + rise * s * s * s * (10.0 + s * (6.0 * s - 15.0)),
            rate: rise / span * 30.0 * s * s * (1.0 - s) * (1.0 - s),
            acceleration: rise / (span * span) * 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s),
        },
    }
}

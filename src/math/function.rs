//! Functions of time for a constraint's value and a spring's stiffness: number, keys, wave, or given from outside, with two derivatives.
//!
//! A constraint that follows f(t) needs ḟ in its velocity and f̈ in its acceleration, so both are exact here:
//!
//! ```text
//! linear   f = a + (b − a) s,                    s = (t − t₀)/(t₁ − t₀)
//! smooth   f = a + (b − a) (10 s³ − 15 s⁴ + 6 s⁵)     ḟ and f̈ vanish at both keys: a follower feels no jerk there
//! spline   the quintic with f, ḟ, f̈ given at both keys; ḟ and f̈ of a key are those of the parabola through it and
//!          its two neighbours, and 0 at the first and the last key: f̈ has no jumps
//! wave     f = mean + amplitude · sin(2π t/period + phase)
//! ```
//!
//! The quintic over a span h with s = (t − t₀)/h, from (p, v, a) to (q, w, b), d = q − p − v h − a h²/2,
//! e = (w − v) h − a h², g = (b − a) h²:
//!
//! ```text
//! f = p + v h s + a h² s²/2 + (10 d − 4 e + g/2) s³ + (−15 d + 7 e − g) s⁴ + (6 d − 3 e + g/2) s⁵
//! ```

use std::ops::{Add, Mul, Sub};

use crate::{PI, sincos};

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
        /// Repeats from the first key after the last one; otherwise the last value stays.
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
    /// Given from outside before each step: its value and its rate in the step.
    Given {
        /// Value.
        value: f64,
        /// Rate, per s.
        rate: f64,
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
    /// Through the keys without stopping, the second derivative continuous (quintic).
    Spline,
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
            Self::Given { value, rate } => Jet3 { value: *value, rate: *rate, acceleration: 0.0 },
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

    /// First time after `t` (s) at which its rate jumps; infinite where it never does again.
    pub fn next_jump(&self, t: f64) -> f64 {
        match self {
            Self::Keys { keys, interpolation: Interpolation::Linear, repeat } if !keys.is_empty() => {
                next_key(keys.len(), |i| keys[i].0, *repeat, t)
            }
            _ => f64::INFINITY,
        }
    }

    /// Is it the same at all times?
    #[inline]
    pub fn is_constant(&self) -> bool {
        matches!(self, Self::Constant(_))
    }
}

impl From<f64> for Function {
    fn from(value: f64) -> Self {
        Self::Constant(value)
    }
}

/// Time before a key that counts as the key, s: times that are sums of steps round by less.
pub const AT_KEY_S: f64 = 1e-9;

/// The span between two keys that holds a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Index of the earlier key; the next one ends the span.
    pub key: usize,
    /// Seconds since the earlier key.
    pub since: f64,
}

/// Where `t` falls among `count` (at least one) keys of rising times. Before the first key and from the last one on it
/// is in no span: the error is the key that it stays at.
///
/// # Errors
/// `t` is in no span: the index of the key that the function stays at.
pub fn span(count: usize, time: impl Fn(usize) -> f64, repeat: bool, t: f64) -> Result<Span, usize> {
    let (first, last) = (time(0), time(count - 1));
    let length = last - first;
    let t = if repeat && length > 0.0 { first + (t - first) - length * ((t - first) / length).floor() } else { t };
    if t < first {
        return Err(0);
    }
    let (mut low, mut high) = (0, count);
    while low < high {
        let middle = (low + high) / 2;
        if time(middle) <= t {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    if low == count { Err(count - 1) } else { Ok(Span { key: low - 1, since: t - time(low - 1) }) }
}

/// The same, where a time just before a key counts as the key: for what jumps there, and must have jumped at the end of a step.
///
/// # Errors
/// As [`span`].
pub fn span_from_key(count: usize, time: impl Fn(usize) -> f64, repeat: bool, t: f64) -> Result<Span, usize> {
    match span(count, &time, repeat, t + AT_KEY_S)? {
        Span { key, since } if since <= 2.0 * AT_KEY_S => Ok(Span { key, since: 0.0 }),
        _ => span(count, time, repeat, t),
    }
}

/// Time of the first of such keys after `t`, s; infinite where there is none.
pub fn next_key(count: usize, time: impl Fn(usize) -> f64, repeat: bool, t: f64) -> f64 {
    let length = if repeat { time(count - 1) - time(0) } else { 0.0 };
    match span_from_key(count, &time, repeat, t) {
        Ok(Span { key, since }) => t - since + time(key + 1) - time(key),
        Err(_) if t + AT_KEY_S < time(0) => time(0),
        Err(_) if length > 0.0 => t + length,
        Err(_) => f64::INFINITY,
    }
}

/// First and second derivative at a key: of the parabola through it and its neighbours, given the means of the rates
/// before and after it and the two spans.
#[inline]
pub fn knot<V>(before: V, after: V, span_before: f64, span_after: f64) -> (V, V)
where
    V: Copy + Add<Output = V> + Sub<Output = V> + Mul<f64, Output = V>,
{
    let whole = span_before + span_after;
    (before * (span_after / whole) + after * (span_before / whole), (after - before) * (2.0 / whole))
}

/// Value and two derivatives of the quintic of the file's head, `since` s after its start; ends are (f, ḟ, f̈).
pub fn quintic<V>(from: (V, V, V), to: (V, V, V), h: f64, since: f64) -> (V, V, V)
where
    V: Copy + Add<Output = V> + Sub<Output = V> + Mul<f64, Output = V>,
{
    let ((p, v, a), (q, w, b)) = (from, to);
    let d = q - p - v * h - a * (0.5 * h * h);
    let e = (w - v) * h - a * (h * h);
    let g = (b - a) * (h * h);
    let c3 = d * 10.0 - e * 4.0 + g * 0.5;
    let c4 = e * 7.0 - d * 15.0 - g;
    let c5 = d * 6.0 - e * 3.0 + g * 0.5;
    let s = since / h;
    (
        p + v * since + a * (0.5 * since * since) + (c3 + (c4 + c5 * s) * s) * (s * s * s),
        v + a * since + (c3 * 3.0 + (c4 * 4.0 + c5 * (5.0 * s)) * s) * (s * s / h),
        a + (c3 * 6.0 + (c4 * 12.0 + c5 * (20.0 * s)) * s) * (s / (h * h)),
    )
}

/// The way from 0 to 1 in `h` seconds, `since` s after its start; a spline is not one way but knows its neighbours.
#[inline]
pub fn easing(interpolation: Interpolation, h: f64, since: f64) -> Jet3 {
    let s = since / h;
    match interpolation {
        Interpolation::Step => Jet3::default(),
        Interpolation::Linear => Jet3 { value: s, rate: 1.0 / h, acceleration: 0.0 },
        Interpolation::Smooth | Interpolation::Spline => Jet3 {
            value: s * s * s * (10.0 + s * (6.0 * s - 15.0)),
            rate: 30.0 * s * s * (1.0 - s) * (1.0 - s) / h,
            acceleration: 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / (h * h),
        },
    }
}

fn between(keys: &[(f64, f64)], interpolation: Interpolation, repeat: bool, t: f64) -> Jet3 {
    let still = |value| Jet3 { value, ..Jet3::default() };
    if keys.is_empty() {
        return Jet3::default();
    }
    let found = match interpolation {
        Interpolation::Linear => span_from_key(keys.len(), |i| keys[i].0, repeat, t),
        _ => span(keys.len(), |i| keys[i].0, repeat, t),
    };
    let Span { key, since } = match found {
        Ok(span) => span,
        Err(key) => return still(keys[key].1),
    };
    let ((t0, a), (t1, b)) = (keys[key], keys[key + 1]);
    if interpolation == Interpolation::Spline {
        let slope = |i: usize| (keys[i + 1].1 - keys[i].1) / (keys[i + 1].0 - keys[i].0);
        let derivatives = |i: usize| match neighbours(i, keys.len(), repeat) {
            Some((before, after)) => {
                let length = |i: usize| keys[i + 1].0 - keys[i].0;
                knot(slope(before), slope(after), length(before), length(after))
            }
            None => (0.0, 0.0),
        };
        let ((v, c), (w, d)) = (derivatives(key), derivatives(key + 1));
        let (value, rate, acceleration) = quintic((a, v, c), (b, w, d), t1 - t0, since);
        return Jet3 { value, rate, acceleration };
    }
    let share = easing(interpolation, t1 - t0, since);
    Jet3 { value: a + (b - a) * share.value, rate: (b - a) * share.rate, acceleration: (b - a) * share.acceleration }
}

/// The spans before and after key `i` of `count`, by their earlier keys; `None` where it ends the row of keys.
#[inline]
pub fn neighbours(i: usize, count: usize, repeat: bool) -> Option<(usize, usize)> {
    let last = count - 1;
    match i {
        _ if last == 0 => None,
        i if i > 0 && i < last => Some((i - 1, i)),
        _ if repeat => Some((last - 1, 0)),
        _ => None,
    }
}

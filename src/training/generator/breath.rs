//! Breaths of visitors: speed at the lips, the jet at the capsules, and the hiss of the lips.
//!
//! # At the lips
//!
//! A mouth of the diameter d (m) blows the volume flow Q = U₀ π d²/4. Strong blowing is 0.3 to 1.5 l/s and a breath has
//! at most 3.5 l, a child's 1.5 l (Tsuda and others, Compr. Physiol. 3, 2013; Gupta, Lin and Chen, Indoor Air 20,
//! 2010). So U₀ is 3 to 35 m/s. Longer breaths have smaller openings.
//!
//! # At the capsules
//!
//! A capsule at the distance D and the angle θ from the jet's axis is at x = D cos θ, r = D sin θ. The mean speed there
//! is that of [`super::jet`]. Large eddies carry the whole jet to and fro by δ(t), with σ = 0.25 w in each direction,
//! where w = r_h/√(2 ln 2). To keep the mean, the momentary jet is narrower and faster:
//!
//! ```text
//! U(t) = U_c (w/w_i)² exp(−|r + δ|²/(2 w_i²)),   w_i² = w² − σ²
//! ```
//!
//! On the axis U fluctuates by 7 %. At the edge it comes in gusts between still air, as in the intermittent edge of
//! jets (Wygnanski and Fiedler, J. Fluid Mech. 38, 1969). δ changes at f ≈ 0.2 U/x. Small eddies add 0.26 U_c on the
//! axis, 27 % in all. They fall more slowly towards the edge than U, and half of them stay when the jet moves. Their integral scale is 0.07 to 0.1 x.
//!
//! # Hiss
//!
//! The constriction of the lips makes sound with a pressure ∝ U₀ⁿ, n = 2.5 to 4, at 0.4 to 8 kHz (Shadle, "The
//! acoustics of fricative consonants", MIT, 1985). It travels with the speed of sound, and is there before the air.

use soffio_math::noise::Random;
use soffio_math::{PI, cos, exp, pow, sin, sincos};

use super::BreathLabel;
use super::jet::{self, SAMPLES, STEP, STILL};
use super::noise::{Draw, Drift, RATE, Shape};
use super::stage::Stage;
use super::turbulence::{Air, pressure};

/// Share of w by which large eddies move the jet.
const MEANDER: f64 = 0.25;
/// Small eddies on the axis, as a share of the centre line's speed.
const SMALL_EDDIES: f64 = 0.26;
/// Their radius over that of the speed.
const WIDER: f64 = 1.35;
/// Frequency of the large eddies, as a share of U/x.
const GUSTS: f64 = 0.2;
/// Air that counts as arrived at the capsule, m/s.
const ARRIVED: f64 = 0.2;
/// Fastest speed at which the hiss is still known, m/s.
const HISS_REFERENCE: f64 = 10.0;

/// How one visitor blows.
#[derive(Clone, Debug)]
pub(super) struct Manner {
    /// Its name.
    pub(super) name: &'static str,
    /// Speed at the lips, m/s.
    pub(super) speed: f64,
    /// Diameter of the mouth, m.
    pub(super) diameter: f64,
    /// Duration at the lips, s.
    pub(super) seconds: f64,
    /// Rise and fall, s.
    pub(super) edges: (f64, f64),
    /// Level of the hiss at 1 m and 10 m/s, dB.
    pub(super) hiss: f64,
}

impl Manner {
    /// Brings `times` as much air to a place: a faster breath, then a wider mouth.
    pub(super) fn harder(&mut self, times: f64) {
        let faster = times.min((35.0 / self.speed).max(1.0)).min(2.5);
        self.speed *= faster;
        self.diameter = (self.diameter * (times / faster).min(1.6)).min(0.016);
        let volume = 1000.0 * self.speed * 0.25 * PI * self.diameter * self.diameter * self.seconds;
        self.seconds *= (4.0 / volume).min(1.0);
        let short = 0.4 * self.seconds;
        self.edges = (self.edges.0.min(short), self.edges.1.min(short));
    }
}

/// Where the visitor stands, and how well they aim.
#[derive(Clone, Copy, Debug)]
pub(super) struct Aim {
    /// Distance of the lips from the first capsule, m.
    pub(super) distance: f64,
    /// Angle of the axis off the first capsule, rad: away from the second capsule (negative: towards it), and across.
    pub(super) off: (f64, f64),
    /// Root mean square of its wandering, rad, and its frequency, Hz.
    pub(super) wander: (f64, f64),
    /// Way along the flow from the first to the second capsule, m.
    pub(super) lag: f64,
    /// Integral scale over distance.
    pub(super) scale: f64,
}

/// Manners and their weights.
const MANNERS: [(&str, usize); 11] = [
    ("blow", 26),
    ("soft", 16),
    ("strong", 10),
    ("puff", 10),
    ("hold", 8),
    ("pfff", 7),
    ("whoo", 5),
    ("straw", 4),
    ("child", 8),
    ("haa", 3),
    ("foam", 3),
];

/// Draws a manner; `foam` is the radius of the microphone's foam, m.
pub(super) fn draw_manner(random: &mut Random, foam: f64) -> Manner {
    let all: usize = MANNERS.iter().map(|m| m.1).sum();
    let mut left = random.whole(0, all - 1);
    let drawn = MANNERS.iter().find(|m| {
        let here = left < m.1;
        left = left.saturating_sub(m.1);
        here
    });
    let name = drawn.map_or("blow", |m| m.0);
    let name = if name == "foam" && foam == 0.0 { "soft" } else { name };
    manner(random, name)
}

/// Draws a visitor's way of this manner.
pub(super) fn manner(random: &mut Random, name: &'static str) -> Manner {
    let (speed, millimetres, seconds, hiss) = match name {
        "soft" => ((2.0, 6.5), (6.0, 12.0), (0.5, 3.0), (30.0, 47.0)),
        "strong" => ((14.0, 34.0), (4.0, 8.0), (0.4, 3.0), (34.0, 51.0)),
        "puff" => ((5.0, 25.0), (4.0, 10.0), (0.15, 0.32), (33.0, 51.0)),
        "hold" => ((3.0, 11.0), (3.5, 7.0), (5.0, 12.0), (32.0, 49.0)),
        "pfff" => ((8.0, 26.0), (3.0, 7.0), (0.4, 2.5), (48.0, 62.0)),
        "whoo" => ((4.0, 14.0), (5.0, 11.0), (0.5, 2.5), (38.0, 54.0)),
        "straw" => ((10.0, 38.0), (2.5, 6.0), (0.5, 4.0), (31.0, 47.0)),
        "child" => ((4.0, 14.0), (4.0, 8.0), (0.35, 1.6), (32.0, 51.0)),
        "haa" => ((1.2, 4.5), (12.0, 22.0), (0.5, 2.5), (38.0, 54.0)),
        "foam" => ((3.0, 18.0), (5.0, 12.0), (0.4, 3.0), (36.0, 52.0)),
        _ => ((5.0, 18.0), (4.0, 10.0), (0.4, 4.0), (32.0, 51.0)),
    };
    let mut manner = Manner {
        name,
        speed: random.log_range(speed.0, speed.1),
        diameter: 1e-3 * random.log_range(millimetres.0, millimetres.1),
        seconds: random.log_range(seconds.0, seconds.1),
        edges: (random.log_range(0.025, 0.3), random.log_range(0.04, 0.4)),
        hiss: random.range(hiss.0, hiss.1),
    };
    let litres = if name == "child" { 1.5 } else { 3.5 };
    let volume = 1000.0 * manner.speed * 0.25 * PI * manner.diameter * manner.diameter * manner.seconds;
    if volume > litres {
        manner.diameter = (manner.diameter * (litres / volume).sqrt()).max(0.0025);
    }
    let short = 0.4 * manner.seconds;
    manner.edges = (manner.edges.0.min(short), manner.edges.1.min(short));
    manner
}

/// Draws a place and an aim. Lips on the foam, and warm air of an open mouth, are near.
pub(super) fn draw_aim(random: &mut Random, manner: &str, foam: f64, spacing: f64) -> Aim {
    let distance = match manner {
        "foam" => foam + random.range(0.002, 0.02),
        "haa" => random.log_range(0.02, 0.2),
        _ => match random.unit() {
            u if u < 0.15 => random.log_range(0.02, 0.09),
            u if u < 0.92 => random.log_range(0.09, 0.6),
            _ => random.range(0.6, 0.8),
        },
    };
    let degrees = match random.unit() {
        u if u < 0.65 => random.range(0.0, 3.5),
        u if u < 0.9 => random.range(2.5, 9.0),
        _ => random.range(7.0, 25.0),
    };
    let (s, c) = sincos(2.0 * PI * random.unit());
    let radians = degrees * PI / 180.0;
    // Some aim between the capsules, where the jet still reaches both.
    let middle = 0.5 * spacing / distance;
    let between = if middle < 0.12 && random.chance(0.35) { -middle } else { 0.0 };
    let lag = if random.chance(0.5) { 0.0 } else { spacing * random.signed() * 0.7 };
    Aim {
        distance,
        off: (radians * c + between, radians * s),
        wander: (random.log_range(0.2, 2.5) * PI / 180.0, random.log_range(0.15, 1.5)),
        lag,
        scale: random.range(0.07, 0.1),
    }
}

/// Speed at the lips every [`STEP`], m/s: rise, slow change with a tremor, fall.
pub(super) fn lips(random: &mut Random, manner: &Manner) -> Vec<f64> {
    let steps = (manner.seconds / STEP) as usize + 1;
    let waver = Drift::new(random, manner.seconds * 6.0 + 4.0);
    let (depth, rate) = (random.range(0.02, 0.13), random.range(0.6, 5.0));
    let (tremor, tremor_hertz) = (random.range(0.0, 0.08), random.range(4.0, 9.0));
    let (slope, power) = (random.range(-0.3, 0.6), random.range(0.7, 1.6));
    let smooth = |x: f64| {
        let x = x.clamp(0.0, 1.0);
        x * x * (3.0 - 2.0 * x)
    };
    (0..steps)
        .map(|i| {
            let t = i as f64 * STEP;
            let edge = smooth(t / manner.edges.0) * smooth((manner.seconds - t) / manner.edges.1);
            let envelope = 1.0 - slope * t / manner.seconds + depth * waver.at(t * rate);
            let envelope = envelope + tremor * sin(2.0 * PI * tremor_hertz * t);
            manner.speed * pow(edge, power) * envelope.clamp(0.15, 1.6)
        })
        .collect()
}

/// The jet at the capsules: air, and mean speed at the first capsule every [`STEP`], m/s.
pub(super) fn at_capsules(
    random: &mut Random,
    lips: &[f64],
    diameter: f64,
    aim: &Aim,
    spacing: f64,
) -> (Air, Vec<f64>) {
    let tilt = (aim.off.0 * aim.off.0 + aim.off.1 * aim.off.1).sqrt().min(1.2);
    let x = (aim.distance * cos(tilt)).max(0.01);
    let centre = jet::centre_line(lips, diameter, x);
    let half = jet::half_radius(x, diameter);
    let w = half / (2.0 * std::f64::consts::LN_2).sqrt();
    let sigma = MEANDER * w;
    let narrow = w * w - sigma * sigma;
    let seconds = centre.len() as f64 * STEP;
    let wander = [0, 1].map(|_| Drift::new(random, seconds * 4.0 * aim.wander.1));
    let eddy = [0, 1].map(|_| Drift::new(random, 512.0));
    let start = random.unit() * 400.0;
    let (mut turn, mut mean) = (0.0, Vec::with_capacity(centre.len()));
    let mut air = Air {
        speed: [Vec::with_capacity(centre.len()), Vec::with_capacity(centre.len())],
        eddies: [Vec::with_capacity(centre.len()), Vec::with_capacity(centre.len())],
        carrier: Vec::with_capacity(centre.len()),
        scale: (aim.scale * x).max(0.25 * diameter),
        lag: aim.lag,
    };
    for (i, u) in centre.iter().enumerate() {
        let t = i as f64 * STEP;
        // Four knots a period.
        turn += 4.0 * GUSTS * u / x.max(half) * STEP;
        let axis = [0, 1].map(|k| {
            let off = [aim.off.0, aim.off.1][k];
            x * (off + aim.wander.0 * wander[k].at(t * 4.0 * aim.wander.1))
        });
        // Axis of the jet in the plane of the capsules; the first is at 0, the second at −spacing. Never nearer to the
        // second than to the first.
        let axis = [if axis[0] < -0.5 * spacing { -spacing - axis[0] } else { axis[0] }, axis[1]];
        let shift = [0, 1].map(|k| sigma * eddy[k].at(start + turn));
        let mut fastest = 0.0_f64;
        for capsule in 0..2 {
            let to = axis[0] + if capsule == 1 { spacing } else { 0.0 };
            let r2 = to * to + axis[1] * axis[1];
            let moved = (to + shift[0]) * (to + shift[0]) + (axis[1] + shift[1]) * (axis[1] + shift[1]);
            let now = u * (w * w / narrow) * exp(-moved / (2.0 * narrow));
            air.speed[capsule].push(now);
            let around = |r2: f64| exp(-r2 / (2.0 * WIDER * WIDER * w * w));
            air.eddies[capsule].push(SMALL_EDDIES * u * (0.5 * around(moved) + 0.5 * around(r2)));
            fastest = fastest.max(now);
            if capsule == 0 {
                mean.push(u * jet::profile(r2.sqrt(), half));
            }
        }
        air.carrier.push(0.75 * fastest + 0.15 * u);
    }
    (air, mean)
}

/// Adds a breath that leaves the lips from `at` s on; its label, if it ends within the scene.
pub(super) fn add_breath(stage: &mut Stage, random: &mut Random, at: f64, manner: &Manner, aim: &Aim) -> BreathLabel {
    let lips = lips(random, manner);
    let (air, mean) = at_capsules(random, &lips, manner.diameter, aim, stage.port.spacing);
    let waves = pressure(&mut stage.workshop, random, &air, &stage.port);
    stage.pressure(at, &waves, true);
    hiss(stage, random, at, manner, &lips, aim.distance);
    let mut label = BreathLabel {
        lips: (at, at + manner.seconds),
        capsule: (0.0, 0.0),
        lips_speed: lips.iter().copied().fold(0.0, f64::max),
        peak_air: mean.iter().copied().fold(0.0, f64::max),
        distance: aim.distance,
        angle_deg: (aim.off.0 * aim.off.0 + aim.off.1 * aim.off.1).sqrt() * 180.0 / PI,
        manner: manner.name,
    };
    let arrived = |u: &f64| *u >= ARRIVED;
    if let Some((first, last)) = mean.iter().position(arrived).zip(mean.iter().rposition(arrived)) {
        label.capsule = (at + first as f64 * STEP, at + last as f64 * STEP);
    }
    // Two values a step; slower air is still.
    for (i, u) in mean.iter().enumerate().filter(|(_, u)| **u >= STILL) {
        let ms = (at * 1000.0) as usize + i * (1000.0 * STEP) as usize;
        for value in stage.air.iter_mut().skip(ms).take((1000.0 * STEP) as usize) {
            *value = value.max(*u as f32);
        }
    }
    label
}

/// Adds the sound of a breath that is blown past the microphone: its hiss, at the distance `metres`, and no air.
pub(super) fn blow_past(stage: &mut Stage, random: &mut Random, at: f64, metres: f64) {
    let manner = draw_manner(random, 0.0);
    let lips = lips(random, &manner);
    hiss(stage, random, at, &manner, &lips, metres);
}

/// Adds the sound of the breath taken in before, which ends at `at` s.
pub(super) fn inhale(stage: &mut Stage, random: &mut Random, at: f64, metres: f64) {
    let seconds = random.range(0.3, 1.0);
    if at < seconds {
        return;
    }
    let centre = random.log_range(600.0, 3000.0);
    let shape = Shape::corners(&[(100.0, -40.0), (0.5 * centre, -8.0), (centre, 0.0), (8000.0, -18.0)]);
    let mut wave = stage.noise(random, seconds, &shape);
    let steps = (seconds / STEP) as usize;
    let gains: Vec<f64> = (0..steps).map(|i| sin(PI * i as f64 / steps as f64)).collect();
    modulate(&mut wave, &gains);
    stage.sound(at - seconds, &wave, random.range(26.0, 46.0), metres);
}

/// Adds the sound of the lips, and of a voiced or whistled onset.
fn hiss(stage: &mut Stage, random: &mut Random, at: f64, manner: &Manner, lips: &[f64], distance: f64) {
    let centre = random.log_range(700.0, 5000.0);
    let low = random.range(6.0, 15.0);
    let shape = Shape::corners(&[
        (60.0, -45.0),
        (centre / 3.0, -low),
        (centre, 0.0),
        ((2.0 * centre).min(7000.0), -random.range(0.0, 8.0)),
        (8000.0, -random.range(4.0, 16.0)),
    ]);
    let mut wave = stage.noise(random, lips.len() as f64 * STEP, &shape);
    let n = random.range(2.5, 4.0);
    let gains: Vec<f64> = lips.iter().map(|u| pow(u / HISS_REFERENCE, n).min(12.0)).collect();
    modulate(&mut wave, &gains);
    stage.sound(at, &wave, manner.hiss, distance);
    if manner.name == "whoo" {
        let whistled = random.chance(0.4);
        let f0 = if whistled { random.log_range(700.0, 1800.0) } else { random.log_range(150.0, 420.0) };
        let seconds = random.range(0.1, 0.5).min(manner.seconds);
        let glide = random.range(-0.4, 0.4);
        let count = (seconds * RATE) as usize;
        let (mut phase, mut tone) = (0.0, Vec::with_capacity(count));
        for i in 0..count {
            let t = i as f64 / count as f64;
            phase += f0 * (1.0 + glide * t) / RATE;
            phase -= f64::from(u8::from(phase >= 1.0));
            let arch = 4.0 * t * (1.0 - t);
            // A parabola for each half wave: a sine within 5 %, so a whistle with weak odd harmonics.
            let half = if phase < 0.5 { 16.0 * phase * (0.5 - phase) } else { -16.0 * (phase - 0.5) * (1.0 - phase) };
            tone.push((arch * half) as f32);
        }
        stage.sound(at, &tone, random.range(50.0, 66.0), distance);
    }
}

/// Multiplies with gains given every [`STEP`], straight between.
pub(super) fn modulate(wave: &mut [f32], gains: &[f64]) {
    for (i, part) in wave.chunks_mut(SAMPLES).enumerate() {
        let from = gains.get(i).copied().unwrap_or(0.0);
        let slope = (gains.get(i + 1).copied().unwrap_or(0.0) - from) / SAMPLES as f64;
        for (k, x) in part.iter_mut().enumerate() {
            *x *= (from + slope * k as f64) as f32;
        }
    }
}

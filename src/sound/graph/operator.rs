//! The kinds of operators: initial state, control and rendering of each.

use std::sync::Arc;

use super::block::{AudioBlock, CONTROL_PERIOD};
use super::noises::{Pink, Slow};
use super::relief::Relief;
use super::state::{Glide, OperatorState};
use super::surface::Pyramid;
use super::tones::{Tone, begin_formula, control_formula, render_formula};
use crate::SoundSurface;
use crate::shared::Shared;
use crate::timbre::{FilterKind, Formula, Inputs, Node, NoiseKind, Number, TextureKind};
use soffio_math::exp;

/// Level below which an envelope ends: −120 dB, 24 dB below the steps of 16 bits.
const OVER: f64 = 1e-6;
/// Shortest time constant of an envelope, s: half a sample at 48 kHz.
const SHORTEST: f64 = 1e-5;

pub(super) enum OperatorKind {
    Modal,
    White,
    Pink(Pink),
    Slow(Slow),
    Tone(Box<Tone>),
    Formula(Formula),
    Texture {
        line: Arc<Pyramid>,
        speed: Number,
    },
    Relief(Relief),
    Filter {
        kind: FilterKind,
        cutoff: Number,
        q: Number,
    },
    Env {
        attack: Number,
        decay: Number,
    },
    Value,
    Map {
        points: Vec<[f64; 2]>,
    },
    Delay {
        time: Number,
        feedback: f32,
    },
    Sum,
    Product,
    /// A surface without a picture.
    Smooth,
}

impl OperatorKind {
    /// An operator of a checked node. The error says what the node lacks.
    ///
    /// # Errors
    /// What the node lacks.
    pub fn compile(node: &Node, surface: Option<&SoundSurface>, shared: &mut Shared) -> Result<Self, String> {
        Ok(match node {
            Node::Modal(_) => Self::Modal,
            Node::Noise(noise) => match noise.kind {
                NoiseKind::White => Self::White,
                NoiseKind::Pink => Self::Pink(Pink::new()),
                NoiseKind::Perlin | NoiseKind::Multifractal => Self::Slow(Slow::new(noise)),
            },
            Node::Oscillator(oscillator) => Self::Tone(Box::new(Tone::oscillator(oscillator))),
            Node::Fm(fm) => Self::Tone(Box::new(Tone::fm(fm))),
            Node::Function(function) => Self::Formula(function.compile()?),
            Node::Texture(texture) => {
                let line = match (texture.kind, surface) {
                    (TextureKind::Image, None) if texture.optional => return Ok(Self::Smooth),
                    (TextureKind::Image, Some(SoundSurface::Line(line))) => Arc::new(Pyramid::of_picture(line)?),
                    (TextureKind::Image, Some(SoundSurface::Relief(picture))) => {
                        return Ok(Self::Relief(Relief::new(picture)?));
                    }
                    (TextureKind::Image, None) => {
                        return Err("kind \"image\" needs a body whose surface has a picture; this one has none".into());
                    }
                    _ => shared.texture(texture),
                };
                Self::Texture { line, speed: texture.speed }
            }
            Node::Filter(filter) => Self::Filter { kind: filter.kind, cutoff: filter.cutoff, q: filter.q },
            Node::Env(env) => Self::Env { attack: env.attack, decay: env.decay },
            Node::Value(_) => Self::Value,
            Node::Map(map) => Self::Map { points: map.points.clone() },
            Node::Delay(delay) => Self::Delay { time: delay.time, feedback: delay.feedback as f32 },
            Node::Sum(_) => Self::Sum,
            Node::Product(_) => Self::Product,
        })
    }

    /// The first state of a voice.
    pub fn begin(&self, state: &mut OperatorState, inputs: &Inputs, seed: u64, time: f64, sample_rate: f64) {
        match self {
            Self::Env { attack, decay } => {
                let attack = attack.at(inputs);
                (state.value, state.rise) = if attack > 0.0 {
                    let rise = (1.0 / (attack * sample_rate)).min(1.0);
                    (rise, rise)
                } else {
                    (1.0, 0.0)
                };
                state.change = exp(-1.0 / (decay.at(inputs).max(SHORTEST) * sample_rate));
            }
            Self::Slow(slow) => slow.begin(state, seed, time, sample_rate),
            Self::Tone(tone) => tone.begin(state, inputs, sample_rate),
            Self::Relief(_) => {
                for (glide, place) in state.glides.iter_mut().zip(inputs.position) {
                    *glide = Glide::at(place);
                }
            }
            Self::Formula(formula) => {
                begin_formula(formula, state, inputs);
                state.step = 1.0 / sample_rate;
            }
            Self::Texture { line, speed } => {
                // Anywhere on the surface: no two strokes are the same.
                state.place = state.random.unit() * line.points() as f64;
                (state.left, state.next) = (line.piece(&mut state.random), None);
                state.value = line.step(speed.at(inputs), sample_rate);
                state.level[0] = line.level(state.value);
            }
            Self::Delay { time, .. } => {
                state.delay.begin((time.at(inputs).max(0.0) * sample_rate) as usize);
            }
            _ => {}
        }
    }

    /// A point of the control grid.
    pub fn control(&self, state: &mut OperatorState, inputs: &Inputs, seed: u64, time: f64, sample_rate: f64) {
        match self {
            Self::Slow(slow) => slow.control(state, seed, time, sample_rate),
            Self::Tone(tone) => tone.control(state, inputs, sample_rate),
            Self::Formula(formula) => control_formula(formula, state, inputs),
            Self::Relief(_) => {
                state.glides.iter_mut().zip(inputs.position).for_each(|(glide, place)| glide.towards(place));
            }
            Self::Texture { line, speed } => {
                let target = line.step(speed.at(inputs), sample_rate);
                state.change = (target - state.value) / CONTROL_PERIOD as f64;
                state.level[1] = (line.level(target) - state.level[0]) / CONTROL_PERIOD as f64;
            }
            _ => {}
        }
    }

    /// Coefficients of a filter for the inputs of this moment.
    pub fn tune(&self, state: &mut OperatorState, inputs: &Inputs, sample_rate: f64) {
        if let Self::Filter { cutoff, q, .. } = self {
            let hz = cutoff.at(inputs).clamp(5.0, 0.45 * sample_rate);
            state.filter.tune(hz, q.at(inputs).clamp(0.1, 100.0), sample_rate);
        }
    }

    /// Renders the next samples. The graph itself renders sums and modal nodes.
    pub fn render(&self, state: &mut OperatorState, inputs: &[usize], blocks: &[AudioBlock], out: &mut [f32]) {
        let first = inputs.first().map(|&i| &blocks[i][..out.len()]);
        match (self, first) {
            (Self::White, _) => out.iter_mut().for_each(|y| *y = state.random.signed() as f32),
            (Self::Pink(pink), _) => pink.render(state, out),
            (Self::Slow(slow), _) => slow.render(state, out),
            (Self::Tone(tone), modulation) => tone.render(state, modulation, out),
            (Self::Relief(relief), _) => {
                let [x, y, ..] = &mut state.glides;
                out.iter_mut().for_each(|sample| *sample = relief.at([x.next(), y.next()]));
            }
            (Self::Formula(formula), _) => render_formula(formula, state, inputs, blocks, state.step, out),
            (Self::Texture { line, .. }, _) => line.render(state, out),
            (Self::Value, _) => out.fill(1.0),
            (Self::Filter { kind, .. }, Some(input)) => state.filter.render(*kind, input, out),
            (Self::Env { .. }, Some(_)) if state.value == 0.0 => out.fill(0.0),
            (Self::Env { .. }, Some(input)) => {
                for (y, x) in out.iter_mut().zip(input) {
                    *y = (f64::from(*x) * state.value) as f32;
                    if state.rise > 0.0 {
                        state.value += state.rise;
                        if state.value >= 1.0 {
                            (state.value, state.rise) = (1.0, 0.0);
                        }
                    } else {
                        state.value *= state.change;
                        if state.value < OVER {
                            state.value = 0.0;
                        }
                    }
                }
            }
            (Self::Map { points }, Some(input)) => {
                for (y, x) in out.iter_mut().zip(input) {
                    *y = curve(points, f64::from(*x)) as f32;
                }
            }
            (Self::Delay { feedback, .. }, Some(input)) => state.delay.render(*feedback, input, out),
            (Self::Product, Some(input)) => {
                out.copy_from_slice(input);
                for &other in &inputs[1..] {
                    out.iter_mut().zip(&blocks[other]).for_each(|(y, x)| *y *= x);
                }
            }
            // A checked preset gives each of these an input; the graph renders sums and modal nodes.
            _ => out.fill(0.0),
        }
    }
}

/// Straight lines between ascending points, level beyond them.
fn curve(points: &[[f64; 2]], x: f64) -> f64 {
    let after = points.iter().position(|p| p[0] > x).unwrap_or(points.len());
    match (after.checked_sub(1).map(|i| points[i]), points.get(after)) {
        (None, Some(first)) => first[1],
        (Some(last), None) => last[1],
        (Some(a), Some(b)) => a[1] + (b[1] - a[1]) * (x - a[0]) / (b[0] - a[0]),
        (None, None) => 0.0,
    }
}

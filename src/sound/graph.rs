//! A timbre compiled to a flat list of operators, and the state that one voice keeps for it.
//!
//! Operators stand in an order in which each comes after those it takes, so one pass over the list renders a block.
//! Bound numbers are read on a fixed grid of [`CONTROL`] samples of the synth's own clock; levels glide from one grid
//! point to the next. Everything between is a recurrence sample by sample, so that the result does not
//! depend on how the caller cuts its blocks.

use super::gusts::multifractal;
use super::timbre::{FilterKind, Inputs, MAX_NODES, Node, NoiseKind, Number, Preset, TimbreError};
use crate::math::{PI, exp};
use crate::noise::{Random, hash_words};

/// Samples between two readings of bound numbers.
pub(super) const CONTROL: usize = 64;
/// An envelope below this is over: −120 dB.
const OVER: f64 = 1e-6;
/// One operator's block.
pub(super) type Block = [f32; CONTROL];

/// A compiled timbre.
pub(super) struct Graph {
    operators: Vec<Operator>,
}

/// Whose sound is rendered: what rings belongs to the body and adds up there, the rest to each hit by itself. A sum of
/// both is taken apart; everything else that takes what rings is the body's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    Body,
    Hit,
}

struct Operator {
    kind: Kind,
    /// Indices of the operators it takes, all smaller than its own.
    inputs: Vec<usize>,
    gain: Number,
    /// Whether what rings is in it.
    rings: bool,
    /// Whether something of a hit is in it beside.
    hits: bool,
}

enum Kind {
    Modal,
    White,
    Multifractal { base: f64, octaves: u32, roughness: f64 },
    Filter { kind: FilterKind, cutoff: Number, q: Number },
    Env { decay: Number },
    Sum,
    Product,
}

/// What one operator of one voice remembers.
#[derive(Clone)]
pub(super) struct State {
    /// Level now, and its change per sample.
    gain: f64,
    gain_step: f64,
    random: Random,
    /// Env and gust: value now; env: factor per sample; gust: change per sample.
    value: f64,
    change: f64,
    /// Filter: the two integrators, and the coefficients.
    integrators: [f64; 2],
    g: f64,
    damping: f64,
    shrink: f64,
    /// Whether anything that is heard takes this operator.
    needed: bool,
}

impl Graph {
    /// Compiles a checked preset.
    pub fn compile(preset: &Preset) -> Result<Self, TimbreError> {
        let order = preset.order(&preset.name)?;
        let index = |name: &str| order.iter().position(|known| *known == name).unwrap_or_default();
        let mut operators: Vec<Operator> = Vec::with_capacity(order.len());
        for name in &order {
            let node = &preset.node[*name];
            let kind = match *node {
                Node::Modal { .. } => Kind::Modal,
                Node::Noise { kind: NoiseKind::White, .. } => Kind::White,
                Node::Noise { base, octaves, roughness, .. } => Kind::Multifractal { base, octaves, roughness },
                Node::Filter { kind, cutoff, q, .. } => Kind::Filter { kind, cutoff, q },
                Node::Env { decay, .. } => Kind::Env { decay },
                Node::Sum { .. } => Kind::Sum,
                Node::Product { .. } => Kind::Product,
            };
            // A bank's level is in its partials already, so that what is inaudible is never started.
            let gain = if matches!(kind, Kind::Modal) { Number::Fixed(1.0) } else { node.gain() };
            let inputs: Vec<usize> = node.inputs().iter().map(|input| index(input)).collect();
            let rings = matches!(kind, Kind::Modal) || inputs.iter().any(|&input| operators[input].rings);
            let mut hit = inputs.iter().map(|&input| operators[input].hits);
            let hits = match kind {
                Kind::Modal => false,
                Kind::Sum => hit.any(|hits| hits),
                _ => hit.all(|hits| hits),
            };
            operators.push(Operator { kind, inputs, gain, rings, hits });
        }
        Ok(Self { operators })
    }

    /// Whether anything of this part is heard.
    pub fn has(&self, part: Part) -> bool {
        self.operators.last().is_some_and(|out| out.is_in(part)) || (part == Part::Hit && self.force().is_some())
    }

    /// Whether voices drive what rings.
    pub fn drives(&self) -> bool {
        self.force().is_some()
    }

    /// The operator whose samples are the force in N that drives what rings.
    fn force(&self) -> Option<usize> {
        let modal = self.operators.iter().find(|operator| matches!(operator.kind, Kind::Modal))?;
        modal.inputs.first().copied()
    }

    /// States of a voice that begins with these inputs.
    pub fn begin(
        &self,
        part: Part,
        states: &mut [State; MAX_NODES],
        inputs: &Inputs,
        seed: u64,
        time: f64,
        sample_rate: f64,
    ) {
        for (i, (operator, state)) in self.operators.iter().zip(states.iter_mut()).enumerate() {
            *state = State::new(hash_words(&[seed, i as u64]));
            state.gain = operator.gain.at(inputs);
            match &operator.kind {
                Kind::Env { decay } => {
                    state.value = 1.0;
                    state.change = exp(-1.0 / (decay.at(inputs).max(1e-5) * sample_rate));
                }
                Kind::Multifractal { base, octaves, roughness } => {
                    state.value = multifractal(time * base, *octaves, *roughness, i as u64);
                }
                _ => {}
            }
            operator.tune(state, inputs, sample_rate);
        }
        self.find_needed(part, states);
    }

    /// A grid point: reads bound numbers. `time` is the synth's, s.
    pub fn control(&self, part: Part, states: &mut [State; MAX_NODES], inputs: &Inputs, time: f64, sample_rate: f64) {
        for (i, (operator, state)) in self.operators.iter().zip(states.iter_mut()).enumerate() {
            state.gain_step = (operator.gain.at(inputs) - state.gain) / CONTROL as f64;
            if let Kind::Multifractal { base, octaves, roughness } = &operator.kind {
                let next = multifractal((time + CONTROL as f64 / sample_rate) * base, *octaves, *roughness, i as u64);
                state.change = (next - state.value) / CONTROL as f64;
            }
            operator.tune(state, inputs, sample_rate);
        }
        self.find_needed(part, states);
    }

    /// What an envelope that is over would shape need not be made: soon after a hit only its partials are left to do.
    fn find_needed(&self, part: Part, states: &mut [State; MAX_NODES]) {
        states.iter_mut().for_each(|state| state.needed = false);
        let force = if part == Part::Hit { self.force() } else { None };
        for (i, operator) in self.operators.iter().enumerate().rev() {
            let out = i + 1 == self.operators.len() && operator.is_in(part);
            let heard = out || states[i].needed || force == Some(i);
            states[i].needed = heard;
            if heard && !(matches!(operator.kind, Kind::Env { .. }) && states[i].value == 0.0) {
                let taken = operator.inputs.iter().filter(|&&input| operator.takes(part, &self.operators[input]));
                taken.for_each(|&input| states[input].needed = true);
            }
        }
    }

    /// Renders `n` samples, as many as `ringing` has: what rings of the body. The answer is the block of the last
    /// operator and, for a hit, that of the force on what rings.
    pub fn render<'a>(
        &self,
        part: Part,
        states: &mut [State; MAX_NODES],
        ringing: &[f32],
        blocks: &'a mut [Block; MAX_NODES],
        n: usize,
    ) -> (&'a [f32], Option<&'a [f32]>) {
        for (i, operator) in self.operators.iter().enumerate() {
            if !states[i].needed {
                continue;
            }
            let (before, rest) = blocks.split_at_mut(i);
            let out = &mut rest[0][..n];
            let state = &mut states[i];
            match operator.kind {
                Kind::Modal => out.copy_from_slice(ringing),
                Kind::Sum => {
                    out.fill(0.0);
                    for &input in operator.inputs.iter().filter(|&&i| operator.takes(part, &self.operators[i])) {
                        out.iter_mut().zip(&before[input]).for_each(|(y, x)| *y += x);
                    }
                }
                _ => operator.render(state, before, out),
            }
            if state.gain == 1.0 && state.gain_step == 0.0 {
                continue;
            }
            for sample in out {
                *sample = (f64::from(*sample) * state.gain) as f32;
                state.gain += state.gain_step;
            }
        }
        let last = self.operators.len() - 1;
        if !states[last].needed {
            blocks[last][..n].fill(0.0);
        }
        let force = if part == Part::Hit { self.force() } else { None };
        let blocks = &*blocks;
        (&blocks[last][..n], force.map(|i| &blocks[i][..n]))
    }
}

impl Operator {
    fn is_in(&self, part: Part) -> bool {
        match part {
            Part::Body => self.rings,
            Part::Hit => self.hits,
        }
    }

    /// Whether this part of it takes an input.
    fn takes(&self, part: Part, input: &Operator) -> bool {
        match part {
            Part::Body => input.rings || !(self.rings && matches!(self.kind, Kind::Modal | Kind::Sum)),
            Part::Hit => input.hits,
        }
    }

    /// Coefficients of a filter for the inputs of this moment.
    fn tune(&self, state: &mut State, inputs: &Inputs, sample_rate: f64) {
        if let Kind::Filter { cutoff, q, .. } = &self.kind {
            let hz = cutoff.at(inputs).clamp(5.0, 0.45 * sample_rate);
            state.g = libm::tan(PI * hz / sample_rate);
            state.damping = 1.0 / q.at(inputs).clamp(0.1, 100.0);
            state.shrink = 1.0 / (1.0 + state.g * (state.damping + state.g));
            // Ringing below −400 dB is not worth the slow arithmetic of denormal numbers.
            for integrator in &mut state.integrators {
                if integrator.abs() < 1e-20 {
                    *integrator = 0.0;
                }
            }
        }
    }

    fn render(&self, state: &mut State, blocks: &[Block], out: &mut [f32]) {
        let first = self.inputs.first().map(|&i| &blocks[i][..out.len()]);
        match (&self.kind, first) {
            (Kind::White, _) => out.iter_mut().for_each(|y| *y = state.random.signed() as f32),
            (Kind::Multifractal { .. }, _) => {
                for y in out {
                    *y = state.value as f32;
                    state.value += state.change;
                }
            }
            (Kind::Filter { kind, .. }, Some(input)) => {
                for (y, x) in out.iter_mut().zip(input) {
                    *y = state.filter(f64::from(*x), *kind) as f32;
                }
            }
            (Kind::Env { .. }, Some(_)) if state.value == 0.0 => out.fill(0.0),
            (Kind::Env { .. }, Some(input)) => {
                for (y, x) in out.iter_mut().zip(input) {
                    *y = (f64::from(*x) * state.value) as f32;
                    state.value *= state.change;
                    if state.value < OVER {
                        state.value = 0.0;
                    }
                }
            }
            (Kind::Product, Some(input)) => {
                out.copy_from_slice(input);
                for &other in &self.inputs[1..] {
                    out.iter_mut().zip(&blocks[other]).for_each(|(y, x)| *y *= x);
                }
            }
            // A checked preset gives each of these an input; the graph itself makes the others.
            (Kind::Filter { .. } | Kind::Env { .. } | Kind::Product, None) | (Kind::Modal | Kind::Sum, _) => {
                out.fill(0.0)
            }
        }
    }
}

impl State {
    /// At rest.
    pub fn new(seed: u64) -> Self {
        Self {
            gain: 0.0,
            gain_step: 0.0,
            random: Random::new(seed),
            value: 0.0,
            change: 0.0,
            integrators: [0.0; 2],
            g: 0.0,
            damping: 1.0,
            shrink: 1.0,
            needed: false,
        }
    }

    /// One sample of the state-variable filter by trapezoidal integration (Zavalishin, "The Art of VA Filter Design",
    /// 2018, 4.1): stable under any change of its coefficients. g = tan(π f/fs), damping = 1/Q,
    /// shrink = 1/(1 + g (damping + g)).
    fn filter(&mut self, x: f64, kind: FilterKind) -> f64 {
        let [s1, s2] = self.integrators;
        let (g, damping) = (self.g, self.damping);
        let high = (x - (damping + g) * s1 - s2) * self.shrink;
        let band = g * high + s1;
        let low = g * band + s2;
        self.integrators = [2.0 * band - s1, 2.0 * low - s2];
        match kind {
            FilterKind::LowPass => low,
            FilterKind::BandPass => damping * band,
            FilterKind::HighPass => high,
        }
    }
}

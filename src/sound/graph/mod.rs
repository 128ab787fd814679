//! A timbre compiled to a flat list of operators, and the state that one voice keeps for it.
//!
//! Operators stand in an order in which each comes after those it takes, so one pass over the list renders a block.
//! Bound numbers are read on a fixed grid of [`CONTROL`] samples of the synth's own clock; levels glide from one grid
//! point to the next. Everything between is a recurrence sample by sample, so that the result does not
//! depend on how the caller cuts its blocks.
//!
//! Real-time: delays need room, which [`Graph::make_room`] makes before the first sound; nothing else allocates.

mod block;
mod delay;
mod filter;
mod noises;
mod operator;
mod state;
mod surface;

use super::InstrumentSpec;
use super::shared::Shared;
use super::timbre::{Inputs, MAX_NODES, Number, Preset, TimbreError};
pub(super) use block::{Block, CONTROL};
use operator::Kind;
use soffio_math::noise::hash_words;
pub(super) use state::State;
pub(super) use surface::Pyramid;

/// Whose sound is rendered: what rings belongs to the body and adds up there, the rest to each hit by itself. A sum of
/// both is taken apart; everything else that takes what rings is the body's.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Part {
    Body,
    Hit,
}

/// A compiled timbre.
pub(super) struct Graph {
    operators: Vec<Operator>,
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

impl Graph {
    /// Compiles a checked preset for a body.
    pub fn compile(preset: &Preset, spec: &InstrumentSpec, shared: &mut Shared) -> Result<Self, TimbreError> {
        let order = preset.order(&preset.name)?;
        let index = |name: &str| order.iter().position(|known| *known == name).unwrap_or_default();
        let mut operators: Vec<Operator> = Vec::with_capacity(order.len());
        for name in &order {
            let node = &preset.node[*name];
            let kind = Kind::compile(node, spec.surface.as_ref(), shared)
                .map_err(|problem| TimbreError::new(&preset.name, format!("node.{name}"), problem))?;
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

    /// Whether something is still to come out that went in.
    pub fn holds(&self, states: &[State; MAX_NODES]) -> bool {
        let mut delays = self.operators.iter().zip(states);
        delays.any(|(operator, state)| matches!(operator.kind, Kind::Delay { .. }) && state.holds())
    }

    /// The operator whose samples are the force in N that drives what rings.
    fn force(&self) -> Option<usize> {
        let modal = self.operators.iter().find(|operator| matches!(operator.kind, Kind::Modal))?;
        modal.inputs.first().copied()
    }

    /// Room for the delays of voices that may play this. Allocates.
    pub fn make_room(&self, states: &mut [State; MAX_NODES], sample_rate: f64) {
        for (operator, state) in self.operators.iter().zip(states) {
            if matches!(operator.kind, Kind::Delay { .. }) {
                state.make_room(sample_rate);
            }
        }
    }

    /// States of a voice or a body that begins with these inputs.
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
            state.reset(hash_words(&[seed, i as u64]));
            state.gain = operator.gain.at(inputs);
            operator.kind.begin(state, inputs, i as u64, time, sample_rate);
            operator.kind.tune(state, inputs, sample_rate);
        }
        self.find_needed(part, states);
    }

    /// A grid point: reads bound numbers. `time` is the synth's, s.
    pub fn control(&self, part: Part, states: &mut [State; MAX_NODES], inputs: &Inputs, time: f64, sample_rate: f64) {
        for (i, (operator, state)) in self.operators.iter().zip(states.iter_mut()).enumerate() {
            state.gain_step = (operator.gain.at(inputs) - state.gain) / CONTROL as f64;
            operator.kind.control(state, inputs, i as u64, time, sample_rate);
            operator.kind.tune(state, inputs, sample_rate);
        }
        self.find_needed(part, states);
    }

    /// What an envelope that is over would shape need not be made: soon after a hit only its partials are left to do.
    fn find_needed(&self, part: Part, states: &mut [State; MAX_NODES]) {
        // States behind the operators' are another timbre's: left alone, they stay out of the cache.
        states[..self.operators.len()].iter_mut().for_each(|state| state.needed = false);
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
                _ => operator.kind.render(state, &operator.inputs, before, out),
            }
            if state.gain == 1.0 && state.gain_step == 0.0 {
                continue;
            }
            let (mut gain, step) = (state.gain, state.gain_step);
            for sample in out {
                *sample = (f64::from(*sample) * gain) as f32;
                gain += step;
            }
            state.gain = gain;
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
}

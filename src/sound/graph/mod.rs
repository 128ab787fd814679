//! A timbre compiled to a flat list of operators, and the state that one voice keeps for it.
//!
//! Operators stand in an order in which each comes after those it takes, so one pass over the list renders a block.
//! Bound numbers are read on a fixed grid of [`CONTROL`] samples of the synth's own clock; levels glide from one grid
//! point to the next. Everything between is a recurrence sample by sample, so that the result does not
//! depend on how the caller cuts its blocks.
//!
//! Real-time: delays need room, which [`Graph::make_room`] makes before the first sound; nothing else allocates.

mod noises;
mod operator;
mod state;
mod surface;

use super::bank::Bank;
use super::timbre::{Inputs, MAX_NODES, Number, Preset, TimbreError};
use super::{InstrumentSpec, SurfaceLine};
use crate::noise::hash_words;
use operator::Kind;
pub(super) use state::State;

/// Samples between two readings of bound numbers.
pub(super) const CONTROL: usize = 64;
/// One operator's block.
pub(super) type Block = [f32; CONTROL];

/// A compiled timbre.
pub(super) struct Graph {
    operators: Vec<Operator>,
}

struct Operator {
    kind: Kind,
    /// Indices of the operators it takes, all smaller than its own.
    inputs: Vec<usize>,
    gain: Number,
}

impl Graph {
    /// Compiles a checked preset for a body.
    pub fn compile(preset: &Preset, spec: &InstrumentSpec) -> Result<Self, TimbreError> {
        let order = preset.order(&preset.name)?;
        let index = |name: &str| order.iter().position(|known| *known == name).unwrap_or_default();
        let mut operators = Vec::with_capacity(order.len());
        for name in &order {
            let node = &preset.node[*name];
            let kind = Kind::compile(node, spec.surface.as_ref())
                .map_err(|problem| TimbreError::new(&preset.name, format!("node.{name}"), problem))?;
            // A bank's level is in its partials already, so that what is inaudible is never started.
            let gain = if matches!(kind, Kind::Modal) { Number::Fixed(1.0) } else { node.gain() };
            operators.push(Operator { kind, inputs: node.inputs().iter().map(|input| index(input)).collect(), gain });
        }
        Ok(Self { operators })
    }

    /// Whether a force of its own drives what rings, beside the hits.
    pub fn drives(&self) -> bool {
        self.operators.iter().any(|operator| matches!(operator.kind, Kind::Modal) && !operator.inputs.is_empty())
    }

    /// Room for the delays of voices that may play this. Allocates.
    pub fn make_room(&self, states: &mut [State; MAX_NODES], sample_rate: f64) {
        for (operator, state) in self.operators.iter().zip(states) {
            if matches!(operator.kind, Kind::Delay { .. }) {
                state.make_room(sample_rate);
            }
        }
    }

    /// States of a voice that begins with these inputs.
    pub fn begin(&self, states: &mut [State; MAX_NODES], inputs: &Inputs, seed: u64, time: f64, sample_rate: f64) {
        for (i, (operator, state)) in self.operators.iter().zip(states.iter_mut()).enumerate() {
            state.reset(hash_words(&[seed, i as u64]));
            state.gain = operator.gain.at(inputs);
            operator.kind.begin(state, inputs, i as u64, time, sample_rate);
            operator.kind.tune(state, inputs, sample_rate);
        }
        self.find_needed(states);
    }

    /// A grid point: reads bound numbers. `time` is the synth's, s.
    pub fn control(&self, states: &mut [State; MAX_NODES], inputs: &Inputs, time: f64, sample_rate: f64) {
        for (i, (operator, state)) in self.operators.iter().zip(states.iter_mut()).enumerate() {
            state.gain_step = (operator.gain.at(inputs) - state.gain) / CONTROL as f64;
            operator.kind.control(state, inputs, i as u64, time, sample_rate);
            operator.kind.tune(state, inputs, sample_rate);
        }
        self.find_needed(states);
    }

    /// What an envelope that is over would shape need not be made: soon after a hit only its partials are left to do.
    fn find_needed(&self, states: &mut [State; MAX_NODES]) {
        states.iter_mut().for_each(|state| state.needed = false);
        for (i, operator) in self.operators.iter().enumerate().rev() {
            let heard = i + 1 == self.operators.len() || states[i].needed;
            states[i].needed = heard;
            if heard && !(matches!(operator.kind, Kind::Env { .. }) && states[i].value == 0.0) {
                operator.inputs.iter().for_each(|&input| states[input].needed = true);
            }
        }
    }

    /// Renders `n` samples; the answer is the block of the last operator.
    pub fn render<'a>(
        &self,
        states: &mut [State; MAX_NODES],
        bank: &mut Bank,
        blocks: &'a mut [Block; MAX_NODES],
        n: usize,
    ) -> &'a mut [f32] {
        for (i, (operator, state)) in self.operators.iter().zip(states).enumerate() {
            if !state.needed {
                continue;
            }
            let (before, rest) = blocks.split_at_mut(i);
            let out = &mut rest[0][..n];
            match (&operator.kind, operator.inputs.first()) {
                (Kind::Modal, Some(&force)) => bank.render_driven(&before[force][..n], out),
                (Kind::Modal, None) => bank.render(out),
                (kind, _) => kind.render(state, &operator.inputs, before, out),
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
        &mut blocks[last][..n]
    }
}

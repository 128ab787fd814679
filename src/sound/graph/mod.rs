//! Signal-flow graph of a timbre: a flat list of operators, and the state that a voice or body keeps for it.
//!
//! The list is in topological order, so one pass renders a block. Bound numbers are evaluated on a control grid of
//! [`CONTROL_PERIOD`] samples of the synth's clock, and levels are interpolated between grid points. All else is a recurrence
//! sample by sample, so the result does not depend on how the caller cuts its blocks.
//!
//! Real-time: [`Graph::allocate`] allocates the delay lines before the first sound; nothing else allocates.

mod block;
mod delay;
mod filter;
mod noises;
mod operator;
mod relief;
mod state;
mod surface;
mod tones;

use super::InstrumentSpec;
use super::shared::Shared;
use super::timbre::{Inputs, MAX_NODES, Number, Preset, TimbreError};
pub(super) use block::{AudioBlock, CONTROL_PERIOD};
use operator::OperatorKind;
use soffio_math::noise::hash_words;
pub(super) use state::OperatorState;
pub(super) use surface::Pyramid;

/// Bus of a graph. Modal sound belongs to the body and adds up there; other sound belongs to the voice of each impact. A sum of
/// both is split; all other operators with a modal input belong to the body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Bus {
    Body,
    Voice,
}

/// A compiled timbre.
pub(super) struct Graph {
    operators: Vec<Operator>,
}

struct Operator {
    kind: OperatorKind,
    /// Indices of the operators it takes, all smaller than its own.
    inputs: Vec<usize>,
    gain: Number,
    /// Whether it has a modal input.
    rings: bool,
    /// Whether it has an input of the voice bus.
    hits: bool,
}

impl Graph {
    /// Compiles a checked preset for a body.
    ///
    /// # Errors
    /// The preset does not fit the body; what it lacks.
    pub fn compile(preset: &Preset, spec: &InstrumentSpec, shared: &mut Shared) -> Result<Self, TimbreError> {
        let order = preset.order(&preset.name)?;
        let index = |name: &str| order.iter().position(|known| *known == name).unwrap_or_default();
        let mut operators: Vec<Operator> = Vec::with_capacity(order.len());
        for name in &order {
            let node = &preset.node[*name];
            let kind = OperatorKind::compile(node, spec.surface.as_ref(), shared)
                .map_err(|problem| TimbreError::new(&preset.name, format!("node.{name}"), problem))?;
            // A bank's level is in its partials already, so that what is inaudible is never started.
            let gain = if matches!(kind, OperatorKind::Modal) { Number::Fixed(1.0) } else { node.gain() };
            let inputs: Vec<usize> = node.inputs().iter().map(|input| index(input)).collect();
            let rings = matches!(kind, OperatorKind::Modal) || inputs.iter().any(|&input| operators[input].rings);
            let mut hit = inputs.iter().map(|&input| operators[input].hits);
            let hits = match kind {
                OperatorKind::Modal => false,
                OperatorKind::Sum => hit.any(|hits| hits),
                _ => hit.all(|hits| hits),
            };
            operators.push(Operator { kind, inputs, gain, rings, hits });
        }
        Ok(Self { operators })
    }

    /// Whether this bus has any output.
    pub fn has(&self, bus: Bus) -> bool {
        self.operators.last().is_some_and(|out| out.is_in(bus)) || (bus == Bus::Voice && self.force().is_some())
    }

    /// Whether voices drive the modal bank.
    pub fn drives(&self) -> bool {
        self.force().is_some()
    }

    /// Whether a delay line still holds a signal.
    pub fn holds(&self, states: &[OperatorState; MAX_NODES]) -> bool {
        let mut delays = self.operators.iter().zip(states);
        delays.any(|(operator, state)| matches!(operator.kind, OperatorKind::Delay { .. }) && state.holds())
    }

    /// The operator whose samples are the force on the modal bank, N.
    fn force(&self) -> Option<usize> {
        let modal = self.operators.iter().find(|operator| matches!(operator.kind, OperatorKind::Modal))?;
        modal.inputs.first().copied()
    }

    /// Allocates the delay lines of a voice or body that may play this.
    pub fn allocate(&self, states: &mut [OperatorState; MAX_NODES], sample_rate: f64) {
        for (operator, state) in self.operators.iter().zip(states) {
            if matches!(operator.kind, OperatorKind::Delay { .. }) {
                state.allocate(sample_rate);
            }
        }
    }

    /// Initialises the states of a voice or body with these inputs.
    pub fn begin(
        &self,
        bus: Bus,
        states: &mut [OperatorState; MAX_NODES],
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
        self.find_needed(bus, states);
    }

    /// Evaluates the parameters that follow an input, at a point of the control grid. `time` is the synth's, s.
    pub fn control(
        &self,
        bus: Bus,
        states: &mut [OperatorState; MAX_NODES],
        inputs: &Inputs,
        time: f64,
        sample_rate: f64,
    ) {
        for (i, (operator, state)) in self.operators.iter().zip(states.iter_mut()).enumerate() {
            state.gain_step = (operator.gain.at(inputs) - state.gain) / CONTROL_PERIOD as f64;
            operator.kind.control(state, inputs, i as u64, time, sample_rate);
            operator.kind.tune(state, inputs, sample_rate);
        }
        self.find_needed(bus, states);
    }

    /// Marks the operators that the output needs. Inputs of a finished envelope are not: soon after an impact only its partials
    /// remain.
    fn find_needed(&self, bus: Bus, states: &mut [OperatorState; MAX_NODES]) {
        // States beyond the operators' belong to other timbres and are not touched.
        states[..self.operators.len()].iter_mut().for_each(|state| state.is_needed = false);
        let force = if bus == Bus::Voice { self.force() } else { None };
        for (i, operator) in self.operators.iter().enumerate().rev() {
            let out = i + 1 == self.operators.len() && operator.is_in(bus);
            let heard = out || states[i].is_needed || force == Some(i);
            states[i].is_needed = heard;
            if heard && !(matches!(operator.kind, OperatorKind::Env { .. }) && states[i].value == 0.0) {
                let taken = operator.inputs.iter().filter(|&&input| operator.takes(bus, &self.operators[input]));
                taken.for_each(|&input| states[input].is_needed = true);
            }
        }
    }

    /// Renders `n` samples; `ringing` holds the body's modal samples. Returns the block of the last operator and, for the voice
    /// bus, that of the force on the modal bank.
    pub fn render<'a>(
        &self,
        bus: Bus,
        states: &mut [OperatorState; MAX_NODES],
        ringing: &[f32],
        blocks: &'a mut [AudioBlock; MAX_NODES],
        n: usize,
    ) -> (&'a [f32], Option<&'a [f32]>) {
        for (i, operator) in self.operators.iter().enumerate() {
            if !states[i].is_needed {
                continue;
            }
            let (before, rest) = blocks.split_at_mut(i);
            let out = &mut rest[0][..n];
            let state = &mut states[i];
            match operator.kind {
                OperatorKind::Modal => out.copy_from_slice(ringing),
                OperatorKind::Sum => {
                    out.fill(0.0);
                    for &input in operator.inputs.iter().filter(|&&i| operator.takes(bus, &self.operators[i])) {
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
        if !states[last].is_needed {
            blocks[last][..n].fill(0.0);
        }
        let force = if bus == Bus::Voice { self.force() } else { None };
        let blocks = &*blocks;
        (&blocks[last][..n], force.map(|i| &blocks[i][..n]))
    }
}

impl Operator {
    fn is_in(&self, bus: Bus) -> bool {
        match bus {
            Bus::Body => self.rings,
            Bus::Voice => self.hits,
        }
    }

    /// Whether it takes an input on this bus.
    fn takes(&self, bus: Bus, input: &Operator) -> bool {
        match bus {
            Bus::Body => input.rings || !(self.rings && matches!(self.kind, OperatorKind::Modal | OperatorKind::Sum)),
            Bus::Voice => input.hits,
        }
    }
}

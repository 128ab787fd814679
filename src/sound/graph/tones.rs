//! Endless tones: oscillators, frequency modulation, formulas.
//!
//! A phase φ is counted in periods, so that it stays in 0…1 however long the tone lasts: φ ← φ + f/fs, without its whole part.
//!
//! **Frequency modulation** adds I sin(2π φ₂) to the phase, in radians; the modulator's frequency is r f (Chowning, JAES 21, 1973).
//!
//! **Corners** of saw and square would alias. Each jump is smoothed over one sample on either side by the integral of a triangle,
//! (1 − |x|)²/2 at the distance x in samples (Välimäki and Huovilainen, Computer Music Journal 30, 2006).

use super::block::AudioBlock;
use super::state::{Glide, OperatorState};
use crate::timbre::{Fm, Formula, Inputs, Number, Oscillator, Waveform};
use soffio_math::{PI, sin};

/// Highest frequency of a tone over the sample rate: what is above would alias.
const HIGHEST: f64 = 0.45;

/// A tone with what it follows.
pub(super) struct Tone {
    shape: Waveform,
    /// Where in its period it begins.
    phase: f64,
    /// Hz.
    frequency: Number,
    /// rad.
    index: Number,
    /// Frequency of its own modulator over its own; `None` where a node modulates it, or nothing.
    ratio: Option<Number>,
}

impl Tone {
    /// The tone of a checked node.
    pub fn oscillator(node: &Oscillator) -> Self {
        let &Oscillator { shape, phase, frequency, index, .. } = node;
        Self { shape, phase, frequency, index, ratio: None }
    }

    /// The tone of a checked node.
    pub fn fm(node: &Fm) -> Self {
        let &Fm { carrier, ratio, index, .. } = node;
        Self { shape: Waveform::Sine, phase: 0.0, frequency: carrier, index, ratio: Some(ratio) }
    }

    /// Steps per sample of the phase and of the modulator's, and the index.
    fn targets(&self, inputs: &Inputs, sample_rate: f64) -> [f64; 3] {
        let frequency = self.frequency.at(inputs).abs() / sample_rate;
        let modulator = self.ratio.map_or(0.0, |ratio| frequency * ratio.at(inputs).abs());
        [frequency.min(HIGHEST), self.index.at(inputs), modulator.min(HIGHEST)]
    }

    /// Begins at the inputs of this moment.
    pub fn begin(&self, state: &mut OperatorState, inputs: &Inputs, sample_rate: f64) {
        state.phases = [self.phase, 0.0];
        let targets = self.targets(inputs, sample_rate);
        state.glides.iter_mut().zip(targets).for_each(|(glide, target)| *glide = Glide::at(target));
    }

    /// Glides to the inputs of this moment.
    pub fn control(&self, state: &mut OperatorState, inputs: &Inputs, sample_rate: f64) {
        let targets = self.targets(inputs, sample_rate);
        state.glides.iter_mut().zip(targets).for_each(|(glide, target)| glide.towards(target));
    }

    /// The next samples; `modulation` is the block of the node that modulates it.
    pub fn render(&self, state: &mut OperatorState, modulation: Option<&[f32]>, out: &mut [f32]) {
        let OperatorState { glides: [frequency, index, modulator, _], phases: [phase, modulator_phase], .. } = state;
        for (i, y) in out.iter_mut().enumerate() {
            let (step, index) = (frequency.next(), index.next());
            let moved = match (modulation, self.ratio) {
                (Some(block), _) => index * f64::from(block[i]) / (2.0 * PI),
                (None, Some(_)) => index * sin(2.0 * PI * *modulator_phase) / (2.0 * PI),
                (None, None) => 0.0,
            };
            let place = *phase + moved;
            *y = wave(self.shape, place - place.floor(), step) as f32;
            *phase = advanced(*phase, step);
            *modulator_phase = advanced(*modulator_phase, modulator.next());
        }
    }
}

fn advanced(phase: f64, step: f64) -> f64 {
    let next = phase + step;
    next - next.floor()
}

/// A waveform at a phase of 0…1 that moves by `step` a sample.
fn wave(shape: Waveform, phase: f64, step: f64) -> f64 {
    let half = if phase < 0.5 { phase + 0.5 } else { phase - 0.5 };
    match shape {
        Waveform::Sine => sin(2.0 * PI * phase),
        Waveform::Triangle => 1.0 - 4.0 * (half - 0.5).abs(),
        // It passes 0 upwards where a sine does, and jumps half a period later.
        Waveform::Saw => 2.0 * half - 1.0 - jump(half, step),
        Waveform::Square => {
            let level = if phase < 0.5 { 1.0 } else { -1.0 };
            level + jump(phase, step) - jump(half, step)
        }
    }
}

/// What smooths an upward jump by 2 at phase 0.
fn jump(phase: f64, step: f64) -> f64 {
    if phase < step {
        let x = 1.0 - phase / step;
        -x * x
    } else if phase > 1.0 - step {
        let x = 1.0 - (1.0 - phase) / step;
        x * x
    } else {
        0.0
    }
}

/// Begins a formula at the inputs of this moment.
pub(super) fn begin_formula(formula: &Formula, state: &mut OperatorState, inputs: &Inputs) {
    state.phases = [0.0; 2];
    for (glide, input) in state.glides.iter_mut().zip(&formula.inputs) {
        *glide = Glide::at(inputs.of(*input));
    }
}

/// Lets a formula glide to the inputs of this moment.
pub(super) fn control_formula(formula: &Formula, state: &mut OperatorState, inputs: &Inputs) {
    for (glide, input) in state.glides.iter_mut().zip(&formula.inputs) {
        glide.towards(inputs.of(*input));
    }
}

/// The next samples of a formula of these blocks; `period` is that of the samples, s.
pub(super) fn render_formula(
    formula: &Formula,
    state: &mut OperatorState,
    inputs: &[usize],
    blocks: &[AudioBlock],
    period: f64,
    out: &mut [f32],
) {
    for (i, y) in out.iter_mut().enumerate() {
        let values = std::array::from_fn(|k| state.glides[k].next());
        *y = formula.at(|node| f64::from(blocks[inputs[node]][i]), &values, state.phases[0]) as f32;
        state.phases[0] += period;
    }
}

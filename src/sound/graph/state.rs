//! What one operator of one voice remembers.

use super::block::CONTROL_PERIOD;
use super::delay::DelayLine;
use super::filter::StateVariable;
use crate::timbre::{LONGEST_DELAY, MOST_INPUTS};
use soffio_math::noise::Random;

/// Sections of the pink filter: one every two octaves from 20 Hz, the last beyond 20 kHz.
pub(super) const PINK: usize = 6;

/// A value that glides along a straight line from one control point to the next.
#[derive(Clone, Copy, Default)]
pub(super) struct Glide {
    pub value: f64,
    /// Per sample.
    step: f64,
}

impl Glide {
    /// At this value from now on.
    pub fn at(value: f64) -> Self {
        Self { value, step: 0.0 }
    }

    /// Sets the value that it reaches at the next control point.
    pub fn towards(&mut self, target: f64) {
        self.step = (target - self.value) / CONTROL_PERIOD as f64;
    }

    /// The value now; moves on by a sample.
    pub fn next(&mut self) -> f64 {
        let now = self.value;
        self.value += self.step;
        now
    }
}

/// What one operator of one voice remembers.
#[derive(Clone)]
pub(crate) struct OperatorState {
    /// Present level, linear.
    pub gain: f64,
    /// Change of the level per sample.
    pub gain_step: f64,
    /// Does anything that is heard read this operator?
    pub is_needed: bool,
    pub(super) random: Random,
    /// Present value of an envelope, a slow noise or a texture, without a unit.
    pub value: f64,
    /// Of an envelope: factor of the value per sample. Of a slow noise or a texture: change per sample.
    pub(super) change: f64,
    /// Env: rise per sample until it is 1; 0 afterwards.
    pub(super) rise: f64,
    /// Slow noise: its seed, and how many octaves are heard.
    pub(super) seed: u64,
    pub(super) octaves: u32,
    /// Of an oscillator: frequency, index and modulator's frequency; of a formula: its inputs. Each glides from one control
    /// point to the next.
    pub(super) glides: [Glide; MOST_INPUTS],
    /// Phases of an oscillator and its modulator, in periods. Of a formula: the time since it began, s.
    pub(super) phases: [f64; 2],
    /// Slow noise at audio rate: its time and step. Texture: place on the line, in points.
    pub(super) place: f64,
    pub(super) step: f64,
    /// Texture: level of the pyramid and its change per sample; points left of this piece, and the place on the next.
    pub(super) level: [f64; 2],
    pub(super) left: f64,
    pub(super) next: Option<f64>,
    pub(super) filter: StateVariable,
    /// Pink noise: memories of its sections.
    pub(super) pink: [f64; PINK],
    pub(super) delay: DelayLine,
}

impl OperatorState {
    /// At rest.
    pub fn new(seed: u64) -> Self {
        Self {
            gain: 0.0,
            gain_step: 0.0,
            is_needed: false,
            random: Random::new(seed),
            value: 0.0,
            change: 0.0,
            rise: 0.0,
            seed: 0,
            octaves: 0,
            glides: [Glide::default(); MOST_INPUTS],
            phases: [0.0; 2],
            place: 0.0,
            step: 0.0,
            level: [0.0; 2],
            left: f64::INFINITY,
            next: None,
            filter: StateVariable::default(),
            pink: [0.0; PINK],
            delay: DelayLine::default(),
        }
    }

    /// Whether something is still to come out that went in.
    pub(super) fn holds(&self) -> bool {
        self.delay.holds()
    }

    /// At rest again; the room of a delay stays. Real-time.
    pub fn reset(&mut self, seed: u64) {
        let delay = std::mem::take(&mut self.delay).into_empty();
        *self = Self { delay, ..Self::new(seed) };
    }

    /// Room for the longest delay. Allocates.
    pub(super) fn allocate(&mut self, sample_rate: f64) {
        self.delay.allocate((LONGEST_DELAY * sample_rate) as usize + 1);
    }
}

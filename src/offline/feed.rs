//! A recorded breath as microphone input: the samples of each simulation step.
//!
//! Step n receives the samples from ⌊n·rate/240⌋ up to, but not including, ⌊(n+1)·rate/240⌋. The bounds are integers,
//! so every rate is played completely and in order. The live kiosk and the offline run use this same code, so both
//! receive the same samples at the same step.

use std::sync::Arc;

use super::wav::Recording;
use soffio_simulation::{Microphone, STEPS_PER_SECOND};

/// A recording, played step by step.
#[derive(Clone, Debug)]
pub struct WavFeed {
    samples: Arc<[f32]>,
    second: Option<Arc<[f32]>>,
    sample_rate: u32,
    step: u64,
}

impl WavFeed {
    /// Plays the mono `samples` (full scale ±1) at `sample_rate` Hz from their start.
    pub fn new(samples: impl Into<Arc<[f32]>>, sample_rate: u32) -> Self {
        Self { samples: samples.into(), second: None, sample_rate, step: 0 }
    }

    /// The next step's samples as a microphone without loudspeaker feedback; empty after the end.
    pub fn microphone(&mut self) -> Microphone<'_> {
        let (low, high) = (self.bound(self.step), self.bound(self.step + 1));
        self.step += 1;
        Microphone {
            samples: &self.samples[low..high],
            second: self.second.as_ref().map(|second| &second[low..high]),
            sample_rate: self.sample_rate,
            reference: &[],
        }
    }

    /// Length, s.
    pub fn duration(&self) -> f64 {
        self.samples.len() as f64 / f64::from(self.sample_rate)
    }

    /// Has the whole recording been played?
    pub fn is_over(&self) -> bool {
        self.bound(self.step) == self.samples.len()
    }

    /// Sample rate, Hz.
    pub fn sample_rate(&self) -> u32 {
        self.sample_rate
    }

    /// Index of the first sample of a step.
    fn bound(&self, step: u64) -> usize {
        let sample = u128::from(step) * u128::from(self.sample_rate) / u128::from(STEPS_PER_SECOND);
        sample.min(self.samples.len() as u128) as usize
    }
}

impl From<&Recording> for WavFeed {
    /// A stereo recording counts as one of a dual microphone.
    fn from(recording: &Recording) -> Self {
        let Recording { samples, capsules, sample_rate } = recording;
        match capsules {
            Some([left, right]) => {
                Self { second: Some(right.as_slice().into()), ..Self::new(left.as_slice(), *sample_rate) }
            }
            None => Self::new(samples.as_slice(), *sample_rate),
        }
    }
}

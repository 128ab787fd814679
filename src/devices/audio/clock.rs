//! Clock mapping from the simulation's samples to the output device's.
//!
//! Both count samples, but the simulation follows the system's clock and the output its own crystal, in blocks. With r the ratio of the rates, o an offset and L a fixed lookahead:
//!
//! ```text
//! device = r · simulation + o          e = (position + L) − (r · now + o)          o ← o + e / min(n, INERTIA) at observation n
//! ```
//!
//! At first the offset is the mean of all observations. Then it follows slowly, so that neither blocks nor drift are audible as
//! jitter. After a standstill (e larger than [`JUMP`]) it is reset.

use soffio_simulation::{SAMPLE_RATE, SAMPLES_PER_STEP};

/// Observations over which the offset follows; at 240 a second, 2 s.
const INERTIA: f64 = 480.0;
/// A difference beyond this is a standstill, not a drift, s.
const JUMP: f64 = 0.1;

/// Maps sample times of the simulation to frames of the output device.
#[derive(Clone, Debug)]
pub struct ClockMap {
    ratio: f64,
    rate: f64,
    offset: f64,
    looks: f64,
}

impl ClockMap {
    /// For an output device of this rate, Hz.
    pub fn new(sample_rate: u32) -> Self {
        let rate = f64::from(sample_rate);
        Self { ratio: rate / f64::from(SAMPLE_RATE), rate, offset: 0.0, looks: 0.0 }
    }

    /// Observes both clocks: the simulation's present, the output's position and the length of its blocks, frames.
    pub fn look(&mut self, now: u64, position: u64, block: u32) {
        // One step, because a hit may be as old as its step; one block, because the position is as old as its block.
        let lookahead = SAMPLES_PER_STEP as f64 * self.ratio + f64::from(block);
        let wanted = position as f64 + lookahead - now as f64 * self.ratio;
        let error = wanted - self.offset;
        self.looks = if error.abs() < JUMP * self.rate { (self.looks + 1.0).min(INERTIA) } else { 1.0 };
        self.offset += error / self.looks;
    }

    /// Output frame of a moment of the simulation.
    pub fn frame(&self, sample: u64) -> u64 {
        // A float beyond either end of u64 becomes that end: the past is frame 0.
        (sample as f64 * self.ratio + self.offset).round() as u64
    }
}

//! From the simulation's sample clock to the loudspeaker's.
//!
//! Both count samples, but the simulation is paced by the system's clock and the loudspeaker by its crystal, and its
//! position moves in blocks. With r the ratio of the rates, o an offset and L a fixed lookahead:
//!
//! ```text
//! device = r · simulation + o          e = (position + L) − (r · now + o)          o ← o + e / min(n, INERTIA) at look n
//! ```
//!
//! At first the offset is the mean of all looks; then it follows slowly, so neither the blocks nor the crystal are heard as jitter. Only after a standstill (e larger
//! than [`JUMP`]) it is set anew.

use soffio_simulation::{SAMPLE_RATE, SAMPLES_PER_STEP};

/// Looks over which the offset follows; at 240 looks a second, 2 s.
const INERTIA: f64 = 480.0;
/// A difference beyond this is a standstill, not a drift, s.
const JUMP: f64 = 0.1;

/// Maps sample times of the simulation to frames of the loudspeaker.
#[derive(Clone, Debug)]
pub struct ClockMap {
    ratio: f64,
    rate: f64,
    offset: f64,
    looks: f64,
}

impl ClockMap {
    /// For a loudspeaker of this rate, Hz.
    pub fn new(sample_rate: u32) -> Self {
        let rate = f64::from(sample_rate);
        Self { ratio: rate / f64::from(SAMPLE_RATE), rate, offset: 0.0, looks: 0.0 }
    }

    /// A look at both clocks: the simulation's present, the loudspeaker's position and the length of its blocks, frames.
    pub fn look(&mut self, now: u64, position: u64, block: u32) {
        // One step, because a hit may be as old as its step; one block, because the position is as old as its block.
        let lookahead = SAMPLES_PER_STEP as f64 * self.ratio + f64::from(block);
        let wanted = position as f64 + lookahead - now as f64 * self.ratio;
        let error = wanted - self.offset;
        self.looks = if error.abs() < JUMP * self.rate { (self.looks + 1.0).min(INERTIA) } else { 1.0 };
        self.offset += error / self.looks;
    }

    /// The loudspeaker's frame at which a moment of the simulation is heard.
    pub fn frame(&self, sample: u64) -> u64 {
        // A float beyond either end of u64 becomes that end: the past is frame 0.
        (sample as f64 * self.ratio + self.offset).round() as u64
    }
}

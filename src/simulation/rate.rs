//! The simulation's clocks: integer steps and samples.

/// Simulation steps per second.
pub const STEPS_PER_SECOND: u64 = 240;
/// Audio samples per second of the simulation's sample clock.
pub const SAMPLE_RATE: u32 = 48_000;
/// Audio samples per step.
pub const SAMPLES_PER_STEP: u64 = SAMPLE_RATE as u64 / STEPS_PER_SECOND;
/// Seconds per step.
pub(crate) const DT: f64 = 1.0 / STEPS_PER_SECOND as f64;

//! Rates and blocks of sound.

use soffio_soundscape::RATE;

/// Samples a second of sound card and pipeline.
pub(super) const SAMPLE_RATE_HZ: u32 = 48_000;
/// Length of a sound card's block: 10 ms, at 48 kHz and at the 16 kHz of what is made.
pub(super) const FRAMES: usize = 480;
/// The same at the rate of what is made.
pub(super) const BLOCK: usize = FRAMES * RATE as usize / SAMPLE_RATE_HZ as usize;

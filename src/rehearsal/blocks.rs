//! Sample rates and block lengths.

use soffio_soundscape::RATE;

/// Sample rate of sound card and pipeline, Hz.
pub(super) const SAMPLE_RATE_HZ: u32 = 48_000;
/// Frames of a sound card's block: 10 ms at 48 kHz.
pub(super) const FRAMES: usize = 480;
/// Samples of a block at the 16 kHz of the synthetic sound.
pub(super) const BLOCK: usize = FRAMES * RATE as usize / SAMPLE_RATE_HZ as usize;

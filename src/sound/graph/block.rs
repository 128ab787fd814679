//! The control grid.

/// Samples between two readings of bound numbers: 1.3 ms at 48 kHz, below the 5 ms or so that the ear separates.
pub(crate) const CONTROL_PERIOD: usize = 64;
/// One operator's block.
pub(crate) type AudioBlock = [f32; CONTROL_PERIOD];

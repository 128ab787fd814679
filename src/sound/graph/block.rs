//! The control grid.

/// Samples between two readings of bound numbers.
pub(crate) const CONTROL_PERIOD: usize = 64;
/// One operator's block.
pub(crate) type AudioBlock = [f32; CONTROL_PERIOD];

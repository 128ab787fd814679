//! The control grid.

/// Period, samples, at which parameters that follow an input are evaluated: 1.3 ms at 48 kHz. Chosen as a compromise between the
/// cost and audible steps; not measured.
pub(crate) const CONTROL_PERIOD: usize = 64;
/// One operator's block.
pub(crate) type AudioBlock = [f32; CONTROL_PERIOD];

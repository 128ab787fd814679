//! The control grid.

/// Samples between two readings of bound numbers.
pub(crate) const CONTROL: usize = 64;
/// One operator's block.
pub(crate) type Block = [f32; CONTROL];

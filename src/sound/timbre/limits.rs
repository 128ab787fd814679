//! Version and bounds of the format.

/// Version of the format that this program reads.
pub(super) const VERSION: u32 = 1;
/// Most nodes of one timbre: bounds the work of a voice.
pub const MAX_NODES: usize = 16;
/// Most partials of one timbre: bounds the work of a voice.
pub const MAX_PARTIALS: usize = 1024;
/// Longest delay of a node, s: bounds the memory of a voice; longer ones are echoes.
pub const LONGEST_DELAY: f64 = 0.1;

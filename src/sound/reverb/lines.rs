//! Constants of the delay lines.

/// Number of delay lines: a power of two for the Hadamard matrix, and one vector of 16 numbers.
pub(crate) const LINES: usize = 16;
/// Octaves at which the decay is given, Hz.
pub const BANDS: [f64; 7] = [125.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0];
/// Samples below this become 0: −240 dB. It keeps subnormal numbers, which are slow, out of the loop.
pub(super) const FLOOR: f32 = 1e-12;

//! Constants of the delay lines.

/// Delay lines.
pub(crate) const LINES: usize = 16;
/// Octaves at which the decay is given, Hz.
pub const BANDS: [f64; 7] = [125.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0];
/// Smaller samples become 0: −240 dB.
pub(super) const FLOOR: f32 = 1e-12;

//! The delay lines' number, the octaves of their decay, and where they fall silent.

/// Delay lines.
pub(crate) const LINES: usize = 16;
/// Octaves at which a room's decay is given, Hz.
pub const BANDS: [f64; 7] = [125.0, 250.0, 500.0, 1000.0, 2000.0, 4000.0, 8000.0];
/// What is below this becomes 0: −240 dB.
pub(super) const FLOOR: f32 = 1e-12;

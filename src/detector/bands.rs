//! Frequency bands of a power spectrum, and decibels.
//!
//! Bands are about half an octave wide, but never narrower than two bins, which is all that a frame of 48 ms resolves. They begin
//! below 31 Hz, since a breath from half a metre has its corner there, and end where an 8 kHz recording ends.

use super::spectrum::{BINS, FRAME_S, Power, band};
use soffio_math::{exp, log10};

/// Edges of the bands, bins of 15.6 Hz: 16, 47, 78, 109, 156, 219, 313, 438, 625, 875, 1250, 1781, 2531, 3406 Hz.
pub const EDGES: [usize; BANDS + 1] = [1, 3, 5, 7, 10, 14, 20, 28, 40, 56, 80, 114, 162, 218];
/// Distance of two bins, Hz.
pub const BIN_HZ: f64 = 15.625;
/// Number of bands.
pub const BANDS: usize = 13;
/// Bands below 219 Hz, in which turbulence at a capsule is strongest.
pub const RUMBLE: std::ops::Range<usize> = 0..5;
/// Edges of the wider bands in which two capsules are compared, bins: 16, 109, 219, 438, 875, 1781, 3406 Hz. The coherence of a
/// band needs several independent bins.
pub const WIDE_EDGES: [usize; WIDE + 1] = [1, 7, 14, 28, 56, 114, 218];
/// Number of wide bands.
pub const WIDE: usize = 6;
/// Keeps logarithms finite, power.
const EPSILON: f64 = 1e-14;

/// Powers of all bands.
pub fn powers<const N: usize>(power: &[f64; BINS], edges: &[usize]) -> [f64; N] {
    std::array::from_fn(|b| band(power as &Power, edges[b], edges[b + 1]))
}

/// Weight of a new frame in an exponential moving average with this time constant, s.
pub fn blend(time_constant: f64) -> f64 {
    1.0 - exp(-FRAME_S / time_constant)
}

/// Level of a power, dB: 10 lg p, limited below.
pub fn power_to_db(power: f64) -> f64 {
    10.0 * log10(power.max(EPSILON))
}

//! Frequency bands of the power spectrum, their smallest noise floors, and conversions to decibels.

use super::spectrum::FRAME_S;
use soffio_math::{exp, log10};

/// Edges of the bands, bins of 15.6 Hz: 31, 94, 203, 406, 812, 1625, 3400 Hz.
pub const EDGES: [usize; BANDS + 1] = [2, 6, 13, 26, 52, 104, 218];
/// Number of bands.
pub const BANDS: usize = 6;
/// Bins of the low band, 31–203 Hz.
pub const LOW: (usize, usize) = (EDGES[0], EDGES[2]);
/// Bins of the middle band, 406–3400 Hz.
pub const MIDDLE: (usize, usize) = (EDGES[3], EDGES[6]);
/// Smallest noise floor of a band, power (−75 dBFS): below it lies a converter's own noise.
pub(crate) const MIN_FLOOR: f64 = 3.2e-8;
/// Smallest noise floor of the difference of two capsules below 406 Hz, power (−90 dBFS). Ambient noise is 20 to 30 dB weaker in
/// the difference, and so is a breath that passes both capsules.
pub const MIN_DIFFERENCE_FLOOR: f64 = 1e-9;
/// Keeps logarithms finite; far below [`MIN_FLOOR`].
pub(crate) const EPSILON: f64 = 1e-14;
/// A band is above the noise floor from this rise on, dB.
pub(crate) const RISEN_DB: f64 = 5.0;

/// Weight of a new frame in an exponential moving average with this time constant, s.
pub fn blend(time_constant: f64) -> f64 {
    1.0 - exp(-FRAME_S / time_constant)
}

/// Level of a power, dB: 10 lg p, limited below.
pub fn power_to_db(power: f64) -> f64 {
    10.0 * log10(power.max(EPSILON))
}

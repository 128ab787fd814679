//! Bands of the spectrum, what counts as nothing in them, and how they are averaged and told.

use super::spectrum::FRAME_S;
use soffio_math::{exp, log10};

/// Limits of the bands, bins.
pub const EDGES: [usize; BANDS + 1] = [2, 6, 13, 26, 52, 104, 218];
/// How many there are.
pub const BANDS: usize = 6;
/// Bins of the low band, 31–203 Hz.
pub const LOW: (usize, usize) = (EDGES[0], EDGES[2]);
/// Bins of the middle, 406–3400 Hz.
pub const MIDDLE: (usize, usize) = (EDGES[3], EDGES[6]);
/// A room is never taken to be quieter than this in a band, power (−75 dBFS): below it lies a converter's own noise.
pub(crate) const QUIETEST: f64 = 3.2e-8;
/// Nor is what differs between two capsules below 406 Hz (−90 dBFS): a house lies 20 to 30 dB lower there than it is, and so does
/// the breath of who blows past them.
pub const QUIETEST_DIFFERENCE: f64 = 1e-9;
/// Keeps logarithms finite; far below [`QUIETEST`].
pub(crate) const NOTHING: f64 = 1e-14;
/// Below this rise nothing has risen, dB.
pub(crate) const RISEN_DB: f64 = 5.0;

/// Weight of a new frame in an exponential mean with this time constant, s.
pub fn blend(time_constant: f64) -> f64 {
    1.0 - exp(-FRAME_S / time_constant)
}

/// Decibels of a power.
pub fn decibels(power: f64) -> f64 {
    10.0 * log10(power.max(NOTHING))
}

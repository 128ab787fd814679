//! Gusts: a multifractal of gradient noise (Ebert et al., "Texturing and Modeling", 3rd ed., chapter 16).
//!
//! ```text
//! g(t) = Π_i (1 + n(2^i t) · 2^(−iH))        i = 0 … octaves − 1
//! ```
//!
//! A product, not a sum: where the slow octaves are strong the fast ones are strong too, as in real wind, calm between
//! gusts. Each octave's weight stands inside its bracket; outside, H would only change the gain. The mean is
//! 1, the spectrum falls about as f^(−1−2H): H = 1/3 gives the −5/3 of turbulence.

use soffio_math::noise::{hash, perlin1};

/// Strongest gust over the mean. A product has rare peaks far beyond, which would only feed the limiter.
const STRONGEST: f64 = 3.0;

/// Relative strength of the gust at `t` (in units of the slowest octave), 0 … 3, mean about 1.
pub fn multifractal(t: f64, octaves: u32, roughness: f64, seed: u64) -> f64 {
    let (mut value, mut rate, mut weight) = (1.0, 1.0, 1.0);
    let falling = libm::exp2(-roughness);
    for octave in 0..octaves {
        value *= 1.0 + weight * perlin1(t * rate, hash(seed ^ u64::from(octave)));
        rate *= 2.0;
        weight *= falling;
    }
    value.clamp(0.0, STRONGEST)
}

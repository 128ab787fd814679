//! Sound levels at the microphone.

use soffio_detector::generate::filter::power;
use soffio_math::db_to_amplitude;

/// Sound pressure level of full scale, dB.
const FULL_SCALE_DB: f64 = 117.0;

/// Amplitude of a sound level at the microphone, dB of sound; full scale 1.
pub fn loud(db: f64) -> f64 {
    db_to_amplitude(db - FULL_SCALE_DB)
}

/// Scales a sound to an RMS at the first capsule, and the other capsules alike.
pub fn scaled(mut channels: Vec<Vec<f64>>, rms: f64) -> Vec<Vec<f64>> {
    let scale = rms / power(&channels[0]).sqrt().max(1e-12);
    channels.iter_mut().flatten().for_each(|x| *x *= scale);
    channels
}

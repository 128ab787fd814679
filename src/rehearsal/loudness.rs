//! How loud sounds are at the microphone.

use soffio_detector::generate::filter::power;
use soffio_math::from_decibels;

/// Sound pressure level of full scale, dB.
const FULL_SCALE_DB: f64 = 117.0;

/// Amplitude of a sound of so many dB at the microphone, full scale 1.
pub fn loud(db: f64) -> f64 {
    from_decibels(db - FULL_SCALE_DB)
}

/// What each capsule hears of something, with this RMS at the first.
pub fn scaled(mut channels: Vec<Vec<f64>>, rms: f64) -> Vec<Vec<f64>> {
    let scale = rms / power(&channels[0]).sqrt().max(1e-12);
    channels.iter_mut().flatten().for_each(|x| *x *= scale);
    channels
}

//! Sound levels at the microphone. All sound of the venue is pressure, Pa, until the capsules.
//!
//! ```text
//! U = 5.85 · 9 m/s · 9 mm / 10 cm = 4.7 m/s        air of a normal breath at 10 cm (soffio_soundscape::jet)
//! p = ρ U u' = 1.2 · 4.7 · 0.27 · 4.7 = 7 Pa       RMS of its pressure; its peaks reach 20 Pa
//! ```
//!
//! A microphone is set up so that these peaks just reach full scale. A sine of full scale then has 117 dB of sound.

use soffio_soundscape::filters::power;
use soffio_soundscape::microphone::pascals;

/// Peak pressure of full scale, Pa.
pub const FULL_SCALE_PA: f64 = 20.0;

/// RMS of a level at the microphone, Pa, dB of sound.
pub fn loud(db: f64) -> f64 {
    pascals(db)
}

/// Scales a sound to an RMS at the first capsule, and the other capsules alike.
pub fn scaled(mut channels: Vec<Vec<f64>>, rms: f64) -> Vec<Vec<f64>> {
    let scale = rms / power(&channels[0]).sqrt().max(1e-12);
    channels.iter_mut().flatten().for_each(|x| *x *= scale);
    channels
}

//! Remedies for a microphone, the same in `soffio doctor` and on the staff panel.

use soffio_math::log10;

/// Remedy for automatic gain control, which hides the strength of a breath.
pub const GAIN_CONTROL: &str = "switch off automatic gain control: in the system's mixer (\"Auto Gain\", \"AGC\"), in the \
                                microphone's own software, or on the device itself";
/// Remedy for samples at full scale.
pub const CLIPPING: &str = "it clips: turn the input gain down";
/// Remedy for exact silence.
pub const MUTED: &str = "it is muted: open the input in the system's mixer";
/// Remedy for a high level without any breath.
pub const LOUD: &str = "loud for a quiet room: turn the input gain down";
/// Remedy where the device has no second channel.
pub const NO_SECOND_MICROPHONE: &str = "set audio.microphone_channel and audio.second_microphone_channel to channels that it \
                                     has (`soffio devices` says how many), or the latter to 0";

/// Level without any breath above which a gentle breath is hard to detect, dB of full scale.
pub const LOUD_DBFS: f64 = -25.0;

/// Speed at the lips of a normal breath, for which the sensitivity is set, m/s.
pub const NORMAL_M_S: f64 = 9.0;

/// The `breath.sensitivity_db` that makes breaths normal which were measured at this mean speed, m/s, with `now_db`.
pub fn sensitivity(mean: f64, now_db: f64) -> f64 {
    // U goes with 10^(dB/40).
    (now_db + 40.0 * log10(NORMAL_M_S / mean)).clamp(-40.0, 40.0).round()
}

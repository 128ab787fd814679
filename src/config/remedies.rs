//! What staff can do about a microphone: `soffio doctor` and the staff panel say the same.

use soffio_math::log10;

/// It changes its gain by itself: a breath turns the room down, and strength cannot be told.
pub const GAIN_CONTROL: &str = "switch off automatic gain control: in the system's mixer (\"Auto Gain\", \"AGC\"), in the \
                                microphone's own software, or on the device itself";
/// Samples are at full scale.
pub const CLIPPING: &str = "it clips: turn the input gain down";
/// Nothing but exact silence.
pub const MUTED: &str = "it is muted: open the input in the system's mixer";
/// The room alone is loud.
pub const LOUD: &str = "loud for a quiet room: turn the input gain down";
/// The device has no such channel.
pub const NO_SECOND_CAPSULE: &str = "set audio.microphone_channel and audio.second_capsule_channel to channels that it \
                                     has (`soffio devices` says how many), or the latter to 0";

/// Louder than a room should be where a gentle breath is to stand out, dB of full scale.
pub const LOUD_DBFS: f64 = -25.0;

/// Speed at the lips of the breath that a curator is asked for, m/s: a normal one.
pub const NORMAL_M_S: f64 = 9.0;

/// The `breath.sensitivity_db` with which breaths that were heard at this mean speed (m/s) with `now_db` are normal ones.
pub fn sensitivity(mean: f64, now_db: f64) -> f64 {
    // U goes with 10^(dB/40).
    (now_db + 40.0 * log10(NORMAL_M_S / mean)).clamp(-40.0, 40.0).round()
}

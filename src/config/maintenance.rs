//! Checks that the kiosk does by itself.

use serde::{Deserialize, Serialize};

use super::hours::TimeOfDay;
use super::time_text;

/// Time of the audio self-test, life of the microphone's foam, and time for cleaning.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MaintenanceSettings {
    /// Local time, `03:30`, of the daily audio self-test: the loudspeaker plays a sweep, which the microphone records. It
    /// waits until the venue is closed or nobody is there. Empty: staff start it.
    #[serde(with = "time_text")]
    #[schemars(with = "String")]
    pub audio_self_test_at: Option<TimeOfDay>,
    /// Breaths at the microphone after which its foam needs changing; 0: never.
    pub foam_blows: u32,
    /// Time for which all input is off while the screen is cleaned, s.
    pub cleaning_s: f64,
}

/// Default of [`MaintenanceSettings::cleaning_s`], s: enough to wipe a large screen.
pub const CLEANING_S: f64 = 60.0;

impl Default for MaintenanceSettings {
    fn default() -> Self {
        Self { audio_self_test_at: None, foam_blows: 5000, cleaning_s: CLEANING_S }
    }
}

//! The audio section of the site's configuration.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Microphone and loudspeaker.
#[derive(Clone, Debug, Deserialize, JsonSchema, PartialEq, Serialize)]
#[serde(deny_unknown_fields, default)]
pub struct AudioSettings {
    /// Id (`soffio devices`) or any part of the microphone's name; empty is the system's own choice.
    pub microphone: String,
    /// Which of its channels listens, from 1; 0 mixes all of them.
    pub microphone_channel: u16,
    /// Id or any part of the loudspeaker's name; empty is the system's own choice.
    pub loudspeaker: String,
    /// Loudness of the kiosk, dB of full scale, 0 at most.
    pub volume_db: f64,
    /// Length of one block of either device, ms: short answers at once, long never stutters.
    pub block_ms: f64,
}

impl Default for AudioSettings {
    fn default() -> Self {
        Self {
            microphone: String::new(),
            microphone_channel: 0,
            loudspeaker: String::new(),
            volume_db: -6.0,
            block_ms: 10.0,
        }
    }
}

//! What the kiosk looks after by itself.

use serde::{Deserialize, Serialize};

use super::hours::TimeOfDay;
use super::time_text;

/// When it listens to its own chirp, and how long a foam lasts.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Care {
    /// Local time, `03:30`, at which the loudspeaker chirps and the microphone hears it, once a day, when the house is
    /// closed or nobody is there; empty leaves it to staff.
    #[serde(with = "time_text")]
    #[schemars(with = "String")]
    pub chirp_at: Option<TimeOfDay>,
    /// Breaths at the microphone after which its foam is to be changed; 0 for never.
    pub foam_blows: u32,
}

impl Default for Care {
    fn default() -> Self {
        Self { chirp_at: None, foam_blows: 5000 }
    }
}

//! Times of day, and the hours between two of them.

use std::fmt;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

use super::time_text;

/// Minutes of a day.
const DAY: u16 = 24 * 60;

/// A time of day, `22:30`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct TimeOfDay(u16);

impl TimeOfDay {
    /// So many minutes after midnight; whole days count for nothing.
    pub fn from_minutes(minutes: u16) -> Self {
        Self(minutes % DAY)
    }

    /// Minutes since the last time it was `then`.
    pub fn since(self, then: Self) -> u16 {
        (self.0 + DAY - then.0) % DAY
    }
}

impl FromStr for TimeOfDay {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let wrong = || format!("\"{text}\" is no time of day: write hours and minutes, as in \"22:30\"");
        let (hours, minutes) = text.trim().split_once(':').ok_or_else(wrong)?;
        let read = |part: &str, below: u16| {
            let digits = part.len() <= 2 && part.bytes().all(|b| b.is_ascii_digit());
            part.parse::<u16>().ok().filter(|n| digits && *n < below)
        };
        let (hours, minutes) = (read(hours, 24).ok_or_else(wrong)?, read(minutes, 60).ok_or_else(wrong)?);
        Ok(Self(60 * hours + minutes))
    }
}

impl fmt::Display for TimeOfDay {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:02}:{:02}", self.0 / 60, self.0 % 60)
    }
}

/// Hours of quieter sound, from one time of day to another; over midnight where the first is the later.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Hours {
    /// Local time at which the quieter sound begins, `22:00`; empty: staff choose.
    #[serde(with = "time_text")]
    #[schemars(with = "String")]
    pub from: Option<TimeOfDay>,
    /// Local time at which it ends.
    #[serde(with = "time_text")]
    #[schemars(with = "String")]
    pub to: Option<TimeOfDay>,
}

impl Hours {
    /// Is this time inside? Never where one of the two is missing, or both are the same.
    pub fn contain(&self, time: TimeOfDay) -> bool {
        let (Some(from), Some(to)) = (self.from, self.to) else { return false };
        time.since(from) < to.since(from)
    }
}

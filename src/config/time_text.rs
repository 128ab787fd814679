//! A time of day as text in a file; an empty text is no time.

use serde::{Deserialize, Deserializer, Serializer, de};

use super::hours::TimeOfDay;

/// Writes a time as `HH:MM`, `None` as an empty text.
pub fn serialize<S: Serializer>(time: &Option<TimeOfDay>, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&time.map(|time| time.to_string()).unwrap_or_default())
}

/// Reads a time from `HH:MM`, `None` from an empty text.
pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Option<TimeOfDay>, D::Error> {
    let text = String::deserialize(deserializer)?;
    if text.is_empty() { Ok(None) } else { text.parse().map(Some).map_err(de::Error::custom) }
}

//! Findings of `soffio doctor`.

/// Health of a checked item.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Health {
    /// Good.
    Ok,
    /// The kiosk runs, but not as well as it could.
    Warn,
    /// The kiosk lacks something essential.
    Bad,
}

/// Result for one checked item.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Finding {
    /// The item.
    pub what: String,
    /// Its health.
    pub health: Health,
    /// Description of its state.
    pub found: String,
    /// Remedy; empty where none is needed.
    pub remedy: String,
    /// A device or driver (exit code 3) rather than a file (exit code 1).
    pub device: bool,
}

impl Finding {
    pub(super) fn new(what: &str, health: Health, found: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { what: what.into(), health, found: found.into(), remedy: remedy.into(), device: false }
    }

    pub(super) fn of_device(self) -> Self {
        Self { device: true, ..self }
    }
}

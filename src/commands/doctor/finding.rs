//! What `soffio doctor` finds.

/// How well something is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, serde::Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Health {
    /// As it should be.
    Ok,
    /// The kiosk runs, but not as well as it could.
    Warn,
    /// The kiosk lacks something that it is made for.
    Bad,
}

/// One thing looked at.
#[derive(Clone, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Finding {
    /// What was looked at.
    pub what: String,
    /// How well it is.
    pub health: Health,
    /// What was found.
    pub found: String,
    /// What to do; empty where there is nothing to do.
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

//! Outcome of a command, and its error.

/// Error message: what, where, why, and what to do.
#[derive(Debug)]
pub struct Failure(pub(super) String);

impl Failure {
    pub(super) fn input(message: impl std::fmt::Display) -> Self {
        Self(message.to_string())
    }
}

/// Result of a command.
pub(super) type Outcome = Result<(), Failure>;

//! How a command ends.

/// What went wrong, where, why, and what to do.
#[derive(Debug)]
pub struct Failure(pub(super) String);

impl Failure {
    pub(super) fn input(message: impl std::fmt::Display) -> Self {
        Self(message.to_string())
    }
}

/// What a command returns.
pub(super) type Outcome = Result<(), Failure>;

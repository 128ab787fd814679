//! `soffio check`.

use super::{Failure, Outcome};

/// Validates exhibits, configs and models: all problems at once, located, explained.
#[derive(clap::Args, Debug, Default)]
pub struct Args {}

/// Runs the command.
pub fn run(_args: Args) -> Outcome {
    Err(Failure { code: 2, message: "soffio check: under construction".into() })
}

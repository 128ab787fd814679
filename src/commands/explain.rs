//! `soffio explain`.

use super::{Failure, Outcome};

/// Prints each value of an exhibit with its origin.
#[derive(clap::Args, Debug, Default)]
pub struct Args {}

/// Runs the command.
pub fn run(_args: Args) -> Outcome {
    Err(Failure { code: 2, message: "soffio explain: under construction".into() })
}

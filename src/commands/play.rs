//! `soffio play`.

use super::{Failure, Outcome};

/// Runs an exhibit offline, faster than real time.
#[derive(clap::Args, Debug, Default)]
pub struct Args {}

/// Runs the command.
pub fn run(_args: Args) -> Outcome {
    Err(Failure { code: 2, message: "soffio play: under construction".into() })
}

//! `soffio sound`.

use super::{Failure, Outcome};

/// Renders one sound, dry mono.
#[derive(clap::Args, Debug, Default)]
pub struct Args {}

/// Runs the command.
pub fn run(_args: Args) -> Outcome {
    Err(Failure { code: 2, message: "soffio sound: under construction".into() })
}

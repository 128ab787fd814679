//! `soffio breath`.

use super::{Failure, Outcome};

/// Runs the blow detector alone over WAV files.
#[derive(clap::Args, Debug, Default)]
pub struct Args {}

/// Runs the command.
pub fn run(_args: Args) -> Outcome {
    Err(Failure { code: 2, message: "soffio breath: under construction".into() })
}

//! `soffio doctor`.

use super::{Failure, Outcome};

/// Says what to mend on this machine.
#[derive(clap::Args, Debug, Default)]
pub struct Args {}

/// Runs the command.
pub fn run(_args: Args) -> Outcome {
    Err(Failure { code: 2, message: "soffio doctor: under construction".into() })
}

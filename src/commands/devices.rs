//! `soffio devices`.

use super::{Failure, Outcome};

/// Lists what the machine has: microphones, loudspeakers, GPUs.
#[derive(clap::Args, Debug, Default)]
pub struct Args {}

/// Runs the command.
pub fn run(_args: Args) -> Outcome {
    Err(Failure { code: 2, message: "soffio devices: under construction".into() })
}

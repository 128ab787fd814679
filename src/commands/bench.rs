//! `soffio bench`.

use super::{Failure, Outcome};

/// Measures solver, wind, sound and step of an exhibit, or a physics scene.
#[derive(clap::Args, Debug, Default)]
pub struct Args {}

/// Runs the command.
pub fn run(_args: Args) -> Outcome {
    Err(Failure { code: 2, message: "soffio bench: under construction".into() })
}

//! `soffio schema`.

use super::{Failure, Outcome};

/// Prints the JSON Schema of a file kind.
#[derive(clap::Args, Debug, Default)]
pub struct Args {}

/// Runs the command.
pub fn run(_args: Args) -> Outcome {
    Err(Failure { code: 2, message: "soffio schema: under construction".into() })
}

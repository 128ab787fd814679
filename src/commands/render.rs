//! `soffio render`.

use super::{Failure, Outcome};

/// Renders one picture, headless.
#[derive(clap::Args, Debug, Default)]
pub struct Args {}

/// Runs the command.
pub fn run(_args: Args) -> Outcome {
    Err(Failure { code: 2, message: "soffio render: under construction".into() })
}

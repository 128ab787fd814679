//! `soffio kiosk`.

use super::{Failure, Outcome};

/// Runs the live kiosk.
#[derive(clap::Args, Debug, Default)]
pub struct Args {}

/// Runs the command.
pub fn run(_args: Args) -> Outcome {
    Err(Failure { code: 2, message: "soffio kiosk: under construction".into() })
}

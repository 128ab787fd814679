//! The tool's command line: a file a command.

use std::path::PathBuf;

use clap::{Parser, Subcommand};
use soffio_detector::BlowSettings;

use crate::descent::{ONE, TWO};
use crate::{course, tables};

mod day;
mod make;
mod score;
mod train;

/// What went wrong, where, why, and what to do.
#[derive(Debug)]
pub struct Failure(String);

impl Failure {
    fn input(message: impl std::fmt::Display) -> Self {
        Self(message.to_string())
    }
}

type Outcome = Result<(), Failure>;

/// Trains the breath detector and scores it.
#[derive(Parser, Debug)]
#[command(name = "soffio-training", version, about, long_about = None)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand, Debug)]
enum Command {
    Make(make::Args),
    Train(train::Args),
    Score(score::Args),
    Day(day::Args),
}

/// Runs the tool on the process's arguments. The exit code is 1 for bad input, 2 for wrong usage.
pub fn run() -> std::process::ExitCode {
    let outcome = match Cli::parse().command {
        Command::Make(args) => make::run(&args),
        Command::Train(args) => train::run(&args),
        Command::Score(args) => score::run(&args),
        Command::Day(args) => day::run(args),
    };
    match outcome {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(Failure(message)) => {
            eprintln!("soffio-training: {message}");
            std::process::ExitCode::FAILURE
        }
    }
}

/// The shipped detector, or one with the weights of these tables; of more than one of a kind, their mean.
fn detector(tables: &[PathBuf]) -> Result<BlowSettings, Failure> {
    let mut settings = BlowSettings::default();
    let (mut ones, mut twos) = (Vec::new(), Vec::new());
    for path in tables {
        let fail = |why: &dyn std::fmt::Display| Failure::input(format!("{}: {why}", path.display()));
        let source = std::fs::read_to_string(path).map_err(|error| fail(&error))?;
        match (tables::read(&ONE, &source), tables::read(&TWO, &source)) {
            (Ok(one), _) => ones.push(one),
            (_, Ok(two)) => twos.push(two),
            (Err(one), Err(two)) => return Err(fail(&format!("{one}; {two}"))),
        }
    }
    if let Some(mean) = course::mean(&ones) {
        (ONE.give)(&mut settings, mean);
    }
    if let Some(mean) = course::mean(&twos) {
        (TWO.give)(&mut settings, mean);
    }
    Ok(settings)
}

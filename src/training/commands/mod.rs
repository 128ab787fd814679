//! The command line of the tool, with one file per command.

use clap::{Parser, Subcommand};

mod day;
mod detector_from_tables;
mod failure;
mod make;
mod score;
mod train;

pub use failure::Failure;

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
    warn_of_renamed_options(std::env::args());
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

/// Warns of options by their old names; clap reads them as aliases.
fn warn_of_renamed_options(arguments: impl Iterator<Item = String>) {
    for argument in arguments {
        let option = argument.split('=').next().unwrap_or_default();
        if let Some((old, new)) = train::RENAMED.iter().find(|(old, _)| *old == option) {
            eprintln!("soffio-training: {old} is now called {new}; the old name will be removed");
        }
    }
}

//! The tool's command line: a file a command.

use clap::{Parser, Subcommand};

mod day;
mod failure;
mod make;
mod score;
mod tables_given;
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

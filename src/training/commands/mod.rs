//! The command line of the tool, with one file per command.

use clap::{Parser, Subcommand};

mod failure;
mod make_scene;
mod train;

pub use failure::Failure;

/// Trains the breath detector.
#[derive(Parser, Debug)]
#[command(name = "soffio-training", version, about, long_about = None)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand, Debug)]
enum Command {
    MakeScene(make_scene::Args),
    Train(train::Args),
}

/// Runs the tool on the process's arguments. The exit code is 1 for bad input, 2 for wrong usage.
pub fn run() -> std::process::ExitCode {
    let outcome = match Cli::parse().command {
        Command::MakeScene(args) => make_scene::run(&args),
        Command::Train(args) => train::run(&args),
    };
    match outcome {
        Ok(()) => std::process::ExitCode::SUCCESS,
        Err(Failure(message)) => {
            eprintln!("soffio-training: {message}");
            std::process::ExitCode::FAILURE
        }
    }
}

//! The command line: one file per command, arguments and all.

use std::process::ExitCode;

use clap::{Parser, Subcommand};

mod arguments;
mod drivers;
mod failure;
mod fix;
mod old_options;
mod setup;

pub use failure::{Failure, Outcome};

pub mod bench;
pub mod breath;
pub mod check;
pub mod devices;
pub mod doctor;
pub mod explain;
pub mod export;
pub mod import;
#[cfg(feature = "kiosk")]
pub mod kiosk;
pub mod labels;
pub mod loudness;
pub mod new;
pub mod pin;
pub mod play;
pub mod privacy;
#[cfg(feature = "kiosk")]
pub mod rehearse;
#[cfg(feature = "kiosk")]
pub mod render;
pub mod replay;
pub mod schema;
pub mod sound;

/// Sculptures that hang in virtual air and answer a visitor's breath.
#[derive(Parser, Debug)]
#[command(name = "soffio", version, about, long_about = None)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand, Debug)]
enum Command {
    #[cfg(feature = "kiosk")]
    Kiosk(kiosk::Args),
    Play(play::Args),
    Replay(replay::Args),
    Breath(breath::Args),
    Sound(sound::Args),
    Loudness(loudness::Args),
    #[cfg(feature = "kiosk")]
    Render(render::Args),
    #[cfg(feature = "kiosk")]
    Rehearse(rehearse::Args),
    Export(export::Args),
    Check(check::Args),
    Explain(explain::Args),
    New(new::Args),
    Import(import::Args),
    Labels(labels::Args),
    Schema(schema::Args),
    Devices(devices::Args),
    Doctor(doctor::Args),
    Pin(pin::Args),
    Privacy(privacy::Args),
    Bench(bench::Args),
}

/// Runs the program on the process's arguments.
pub fn run() -> ExitCode {
    drivers::keep_quiet();
    let (arguments, warnings) = old_options::update(std::env::args_os());
    warnings.iter().for_each(|warning| eprintln!("{warning}"));
    let cli = Cli::parse_from(arguments);
    let outcome = match cli.command {
        #[cfg(feature = "kiosk")]
        None => kiosk::run(kiosk::Args::default()),
        #[cfg(not(feature = "kiosk"))]
        None => Err(Failure { code: 2, message: "this build has no kiosk; say a command, see --help".into() }),
        #[cfg(feature = "kiosk")]
        Some(Command::Kiosk(args)) => kiosk::run(args),
        Some(Command::Play(args)) => play::run(args),
        Some(Command::Replay(args)) => replay::run(args),
        Some(Command::Breath(args)) => breath::run(args),
        Some(Command::Sound(args)) => sound::run(args),
        Some(Command::Loudness(args)) => loudness::run(args),
        #[cfg(feature = "kiosk")]
        Some(Command::Render(args)) => render::run(args),
        #[cfg(feature = "kiosk")]
        Some(Command::Rehearse(args)) => rehearse::run(args),
        Some(Command::Export(args)) => export::run(args),
        Some(Command::Check(args)) => check::run(args),
        Some(Command::Explain(args)) => explain::run(args),
        Some(Command::New(args)) => new::run(args),
        Some(Command::Labels(args)) => labels::run(args),
        Some(Command::Import(args)) => import::run(args),
        Some(Command::Schema(args)) => schema::run(args),
        Some(Command::Devices(args)) => devices::run(args),
        Some(Command::Doctor(args)) => doctor::run(args),
        Some(Command::Pin(args)) => pin::run(args),
        Some(Command::Privacy(args)) => privacy::run(args),
        Some(Command::Bench(args)) => bench::run(args),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => {
            if !failure.message.is_empty() {
                eprintln!("soffio: {}", failure.shown());
            }
            ExitCode::from(failure.code)
        }
    }
}

//! The command line: one file per command, arguments and all.

use std::process::ExitCode;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use clap::{Parser, Subcommand};

use soffio_config::Config;
use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_simulation::Settings;
use soffio_sound::RoomSpec;

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

/// How a command ended when it did not succeed.
#[derive(Debug)]
pub struct Failure {
    /// 1 bad input or problems found, 2 usage, 3 a device or driver is missing, 130 interrupted.
    pub code: u8,
    /// What, where, why, and what to do. Empty where everything is said already.
    pub message: String,
}

impl Failure {
    /// Bad input, or problems found.
    pub fn input(message: impl std::fmt::Display) -> Self {
        Self { code: 1, message: message.to_string() }
    }

    /// A device or driver is missing.
    pub fn device(message: impl std::fmt::Display) -> Self {
        Self { code: 3, message: message.to_string() }
    }
}

/// Loads an exhibit by its id or folder; all its problems are told at once.
fn open(id_or_folder: &str) -> Result<Arc<Exhibit>, Failure> {
    let folder = exhibit::resolve(id_or_folder).map_err(Failure::input)?;
    exhibit::load(&folder).map(Arc::new).map_err(Failure::input)
}

/// Constants of a run as the site's configuration has them.
fn settings() -> Result<Settings, Failure> {
    let (config, _) = Config::load(None).map_err(Failure::input)?;
    Ok(config.simulation_settings(1))
}

/// The room of the site's configuration.
fn room() -> Result<Option<RoomSpec>, Failure> {
    let (config, _) = Config::load(None).map_err(Failure::input)?;
    Ok(config.room.spec())
}

/// Raises `stop` at Ctrl-C, so that a run ends without half-written files.
fn stop_on_ctrl_c(stop: &Arc<AtomicBool>) {
    let stop = stop.clone();
    if let Err(error) = ctrlc::set_handler(move || stop.store(true, Ordering::Relaxed)) {
        tracing::warn!("Ctrl-C will not stop this cleanly: {error}");
    }
}

/// What a command returns.
pub type Outcome = Result<(), Failure>;

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
    let cli = Cli::parse();
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
                eprintln!("soffio: {}", failure.message);
            }
            ExitCode::from(failure.code)
        }
    }
}

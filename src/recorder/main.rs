//! `soffio-record-breaths`: records breaths and the room, with consent.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use soffio_config::Config;
use soffio_devices::protection::forbid_core_dumps;
use soffio_record_breaths::microphone::Microphone;
use soffio_record_breaths::session::{Plan, guide};

/// Records ten breaths and the room, to set the kiosk's detector with `soffio breath fit`. Run it while the kiosk is off.
#[derive(Parser)]
#[command(name = "soffio-record-breaths", version)]
struct Arguments {
    /// Folder for the recordings; it is made.
    folder: PathBuf,
    /// The site's configuration [default: kiosk-config/kiosk.toml here or above, else built in]
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    /// Number of breaths
    #[arg(long, default_value_t = 10)]
    breaths: usize,
    /// Minutes of the empty room, and of the full one
    #[arg(long, default_value_t = 5.0)]
    minutes: f64,
}

fn main() -> ExitCode {
    let Arguments { folder, config, breaths, minutes } = Arguments::parse();
    let loaded = || Config::load(config.as_deref()).map_err(|error| error.to_string());
    let result = forbid_core_dumps().and_then(|()| loaded()).and_then(|loaded| {
        let mut microphone = Microphone::open(&loaded.config);
        let plan = Plan { breaths, ambient_s: 60.0 * minutes };
        guide(&folder, plan, &mut std::io::stdin().lock(), &mut std::io::stdout(), &mut |seconds| {
            microphone.record(seconds)
        })
    });
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("soffio-record-breaths: {message}");
            ExitCode::FAILURE
        }
    }
}

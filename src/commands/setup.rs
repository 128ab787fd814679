//! What commands need around their work: the exhibit, the site's settings, a clean stop, a progress bar.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use indicatif::{ProgressBar, ProgressStyle};

use super::failure::Failure;
use soffio_config::Config;
use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_simulation::Settings;
use soffio_sound::ReverbSpec;

/// Loads an exhibit by its id or folder; all its problems are told at once.
pub fn open(id_or_folder: &str) -> Result<Arc<Exhibit>, Failure> {
    let folder = exhibit::resolve(id_or_folder).map_err(Failure::input)?;
    exhibit::load(&folder).map(Arc::new).map_err(Failure::input)
}

/// Constants of a run as the site's configuration has them.
pub fn settings() -> Result<Settings, Failure> {
    let (config, _) = Config::load(None).map_err(Failure::input)?;
    Ok(config.simulation_settings(1))
}

/// The room of the site's configuration.
pub fn room() -> Result<Option<ReverbSpec>, Failure> {
    let (config, _) = Config::load(None).map_err(Failure::input)?;
    Ok(config.room.spec())
}

/// Raises `stop` at Ctrl-C, so that a run ends without half-written files.
pub fn stop_on_ctrl_c(stop: &Arc<AtomicBool>) {
    let stop = stop.clone();
    if let Err(error) = ctrlc::set_handler(move || stop.store(true, Ordering::Relaxed)) {
        tracing::warn!("Ctrl-C will not stop this cleanly: {error}");
    }
}

/// A bar on a terminal, nothing in a pipe.
pub fn progress_bar(steps: u64) -> ProgressBar {
    let style =
        ProgressStyle::with_template("{wide_bar} {percent}% {eta}").unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(steps).with_style(style)
}

//! What several commands need: the exhibit, the site's settings, a clean stop, a progress bar.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use indicatif::{ProgressBar, ProgressStyle};

use super::failure::Failure;
use soffio_config::{Config, LoadedConfig};
use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_simulation::Settings;
use soffio_sound::ReverbSpec;

/// Loads an exhibit by its id or folder; all its problems are in the error.
///
/// # Errors
/// There is no such exhibit, or it has problems.
pub fn open(id_or_folder: &str) -> Result<Arc<Exhibit>, Failure> {
    let folder = exhibit::resolve(id_or_folder).map_err(Failure::input)?;
    exhibit::load(&folder).map(Arc::new).map_err(Failure::input)
}

/// The site's configuration: that of a file, or the one that is found from here. Its warnings go to stderr.
///
/// # Errors
/// The file cannot be read, or it has problems.
pub fn config(file: Option<&Path>) -> Result<Config, Failure> {
    let loaded = Config::load(file).map_err(Failure::input)?;
    print_warnings(&loaded);
    Ok(loaded.config)
}

/// The configuration with the settings that staff saved in their panel.
pub fn with_staff_overrides(loaded: LoadedConfig) -> LoadedConfig {
    #[cfg(feature = "kiosk")]
    if let Some(folder) = soffio_kiosk::fleet::persisted::folder(&loaded.config) {
        return loaded.with_staff_overrides(&folder);
    }
    loaded
}

/// Says on stderr which old names a configuration has.
fn print_warnings(loaded: &LoadedConfig) {
    loaded.warning_texts().for_each(|warning| eprintln!("{warning}"));
}

/// Constants of a run as the site's configuration has them.
///
/// # Errors
/// The configuration has problems.
pub fn settings() -> Result<Settings, Failure> {
    Ok(config(None)?.simulation_settings(1))
}

/// The reverberation of the site's configuration.
///
/// # Errors
/// The configuration has problems.
pub fn reverb() -> Result<Option<ReverbSpec>, Failure> {
    Ok(config(None)?.reverb.spec())
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

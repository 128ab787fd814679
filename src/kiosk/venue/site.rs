//! The site's configuration while the kiosk runs. Its file is watched: a valid change is taken over, an invalid one is
//! rejected with its problems, and the last valid configuration stays.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use notify_debouncer_full::notify::{Error, RecommendedWatcher, RecursiveMode};
use notify_debouncer_full::{DebounceEventResult, Debouncer, RecommendedCache, new_debouncer};

use crate::venue::catalog::{QUIET, is_change};
use soffio_config::{AudioSettings, Config, ControllerSettings, Hours, LoadedConfig, STAFF_FILE};
use soffio_exhibit as exhibit;
use soffio_simulation::Settings;
use soffio_sound::{ReverbSpec, VolumeSettings};

/// Part of the configuration that the simulation thread needs.
#[derive(Clone, Debug, PartialEq)]
pub struct Site {
    /// Settings that are constant over a run of the exhibit.
    pub settings: Settings,
    /// Devices.
    pub audio: AudioSettings,
    /// Reverberation of the sounds; `None` is the open air.
    pub reverb: Option<ReverbSpec>,
    /// How loud it may be.
    pub volume: VolumeSettings,
    /// Hours of quieter sound.
    pub night: Hours,
    /// Does attract mode play without a sound?
    pub silent_attract: bool,
    /// Other ways to blow and to aim.
    pub controllers: ControllerSettings,
    /// Idle time before attract mode, s; `None` without attract mode.
    pub idle_s: Option<f64>,
    /// May visitors blow?
    pub breath: bool,
}

impl Site {
    /// Of a configuration, with the seed of all random numbers.
    pub fn new(config: &Config, seed: u64) -> Self {
        Self {
            settings: config.simulation_settings(seed),
            audio: config.audio.clone(),
            reverb: config.reverb.spec(),
            volume: config.volume_settings(),
            night: config.night.clone(),
            silent_attract: config.attract.silent,
            controllers: config.controllers.clone(),
            idle_s: config.attract.enabled.then_some(config.attract.idle_s),
            breath: config.visit.breath,
        }
    }
}

/// Options of the command line that take precedence over the file, now and after every change.
#[derive(Clone, Copy, Debug, Default)]
pub struct Overrides {
    /// A window on a desk.
    pub windowed: bool,
    /// Never attract mode.
    pub no_attract: bool,
    /// Safe mode: the only inputs are the microphone, pointer and keys.
    pub safe: bool,
}

impl Overrides {
    /// The configuration with these options applied.
    pub fn apply(self, mut config: Config) -> Config {
        config.exhibits.folder = exhibit::exhibits_folder(&config.exhibits.folder);
        config.screen.fullscreen &= !self.windowed;
        config.attract.enabled &= !self.no_attract;
        if self.safe {
            config.controllers.listen.clear();
            config.mqtt.broker.clear();
        }
        config
    }
}

/// Result of a change of the file.
#[derive(Debug)]
pub enum ConfigEvent {
    /// A valid configuration, with warnings where the file has old names.
    Loaded(Box<LoadedConfig>),
    /// An invalid configuration: all its problems.
    Rejected(String),
}

/// Watches a configuration file, and the settings of staff over it, for as long as it lives.
pub struct ConfigWatcher {
    /// The file.
    pub path: PathBuf,
    /// The file with the settings of staff; `None` without a folder for the state.
    staff: Option<PathBuf>,
    events: Receiver<ConfigEvent>,
    /// End the watching when dropped.
    _watchers: Vec<Debouncer<RecommendedWatcher, RecommendedCache>>,
}

impl ConfigWatcher {
    /// Watches a file, and the settings of staff in the folder of the state. Where that is impossible the reason is logged.
    pub fn watch(path: &Path, state: Option<&Path>) -> Self {
        let (sender, events) = channel();
        let staff = state.map(|folder| folder.join(STAFF_FILE));
        let files = [Some(path.to_path_buf()), staff.clone()];
        let watchers = files.into_iter().flatten().filter_map(|watched| {
            let (file, state, sender) = (path.to_path_buf(), state.map(Path::to_path_buf), sender.clone());
            let read = move || {
                let event = match Config::load(Some(&file)) {
                    Ok(loaded) => ConfigEvent::Loaded(Box::new(match &state {
                        Some(folder) => loaded.with_staff_overrides(folder),
                        None => loaded,
                    })),
                    Err(error) => ConfigEvent::Rejected(error.to_string()),
                };
                // A closed receiver is about to drop the watcher.
                let _ = sender.send(event);
            };
            let unwatched = |error: &Error| tracing::warn!("{} is not watched for changes: {error}", watched.display());
            watcher(&watched, read).inspect_err(unwatched).ok()
        });
        let watchers = watchers.collect();
        Self { path: path.to_path_buf(), staff, events, _watchers: watchers }
    }

    /// The file in which the staff panel saves settings: the configuration itself where no folder for the state is.
    pub fn saved_in(&self) -> &Path {
        self.staff.as_deref().unwrap_or(&self.path)
    }

    /// The next event, the oldest first; `None` where there is none.
    pub fn next_event(&self) -> Option<ConfigEvent> {
        self.events.try_recv().ok()
    }

    /// Waits for the next event, at most so long.
    pub fn wait(&self, longest: Duration) -> Option<ConfigEvent> {
        self.events.recv_timeout(longest).ok()
    }
}

/// Changed keys that take effect only at the next start.
pub fn waits_for_restart(old: &Config, new: &Config) -> Vec<&'static str> {
    let keys = [
        ("screen.fullscreen", old.screen.fullscreen != new.screen.fullscreen),
        ("exhibits.folder", old.exhibits.folder != new.exhibits.folder),
        ("exhibits.hot_reload", old.exhibits.hot_reload != new.exhibits.hot_reload),
        ("staff.state", old.staff.state != new.staff.state),
    ];
    keys.into_iter().filter(|(_, differ)| *differ).map(|(key, _)| key).collect()
}

/// Calls `read` when the file has changed. The folder is watched, because many editors replace the file.
fn watcher(
    path: &Path,
    read: impl Fn() + Send + 'static,
) -> Result<Debouncer<RecommendedWatcher, RecommendedCache>, Error> {
    let name = path.file_name().unwrap_or_default().to_owned();
    let mut debouncer = new_debouncer(QUIET, None, move |result: DebounceEventResult| match result {
        Ok(events) => {
            let own = |path: &PathBuf| path.file_name().is_some_and(|other| other == name);
            if events.iter().any(|event| is_change(&event.kind) && event.paths.iter().any(own)) {
                read();
            }
        }
        Err(errors) => errors.iter().for_each(|error| tracing::warn!("watching the configuration: {error}")),
    })?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    debouncer.watch(folder, RecursiveMode::NonRecursive)?;
    Ok(debouncer)
}

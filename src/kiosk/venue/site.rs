//! The site's configuration while the kiosk runs: its file is watched, a good new one is taken over, a broken one is
//! refused with its diagnostics and the last good one stays.

use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use notify_debouncer_full::notify::{Error, RecommendedWatcher, RecursiveMode};
use notify_debouncer_full::{DebounceEventResult, Debouncer, RecommendedCache, new_debouncer};

use crate::venue::shelf::{QUIET, is_change};
use soffio_config::{AudioSettings, Config, ControllerSettings, Hours};
use soffio_exhibit as exhibit;
use soffio_simulation::Settings;
use soffio_sound::{ReverbSpec, VolumeSettings};

/// What the simulation thread needs of the configuration.
#[derive(Clone, Debug, PartialEq)]
pub struct Site {
    /// Constant over a run of the exhibit.
    pub settings: Settings,
    /// Devices.
    pub audio: AudioSettings,
    /// What the sounds are heard in; `None` is the open air.
    pub room: Option<ReverbSpec>,
    /// How loud it may be.
    pub volume: VolumeSettings,
    /// When the house is quiet.
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
    /// Of a configuration, with the seed of all that is random.
    pub fn new(config: &Config, seed: u64) -> Self {
        Self {
            settings: config.simulation_settings(seed),
            audio: config.audio.clone(),
            room: config.room.spec(),
            volume: config.volume_settings(),
            night: config.night.clone(),
            silent_attract: config.attract.silent,
            controllers: config.controllers.clone(),
            idle_s: config.attract.enabled.then_some(config.attract.idle_s),
            breath: config.visit.breath,
        }
    }
}

/// What the command line says over the file, now and after every change.
#[derive(Clone, Copy, Debug, Default)]
pub struct Overrides {
    /// A window on a desk.
    pub windowed: bool,
    /// Never attract mode.
    pub no_attract: bool,
    /// Safe mode: nothing from outside but the visitor's breath and hand.
    pub safe: bool,
}

impl Overrides {
    /// The configuration as the run has it.
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

/// What became of a change.
#[derive(Debug)]
pub enum News {
    /// A good one.
    Good(Box<Config>),
    /// A broken one: all that is wrong with it.
    Bad(String),
}

/// A configuration file that is watched for as long as this lives.
pub struct SiteFile {
    /// Where it is.
    pub path: PathBuf,
    news: Receiver<News>,
    /// Ends the watching when dropped.
    _watcher: Option<Debouncer<RecommendedWatcher, RecommendedCache>>,
}

impl SiteFile {
    /// Watches a file. Where that is impossible the reason is logged.
    pub fn watch(path: &Path) -> Self {
        let (tell, news) = channel();
        let file = path.to_path_buf();
        let look = move || {
            let told = match Config::load(Some(&file)) {
                Ok((config, _)) => News::Good(Box::new(config)),
                Err(error) => News::Bad(error.to_string()),
            };
            // Whoever does not listen any more is about to drop the watcher.
            let _ = tell.send(told);
        };
        let watcher = watcher(path, look);
        if let Err(error) = &watcher {
            tracing::warn!("{} is not watched for changes: {error}", path.display());
        }
        Self { path: path.to_path_buf(), news, _watcher: watcher.ok() }
    }

    /// What has happened, the oldest first.
    pub fn news(&self) -> Option<News> {
        self.news.try_recv().ok()
    }

    /// Waits for what happens next.
    pub fn wait(&self, longest: Duration) -> Option<News> {
        self.news.recv_timeout(longest).ok()
    }
}

/// Keys that differ and cannot change while the kiosk runs.
pub fn waits_for_restart(old: &Config, new: &Config) -> Vec<&'static str> {
    let keys = [
        ("screen.fullscreen", old.screen.fullscreen != new.screen.fullscreen),
        ("exhibits.folder", old.exhibits.folder != new.exhibits.folder),
        ("exhibits.hot_reload", old.exhibits.hot_reload != new.exhibits.hot_reload),
        ("staff.state", old.staff.state != new.staff.state),
    ];
    keys.into_iter().filter(|(_, differ)| *differ).map(|(key, _)| key).collect()
}

/// Calls `look` when the file has changed. Its folder is watched: many editors put a new file in the old one's place.
fn watcher(
    path: &Path,
    look: impl Fn() + Send + 'static,
) -> Result<Debouncer<RecommendedWatcher, RecommendedCache>, Error> {
    let name = path.file_name().unwrap_or_default().to_owned();
    let mut debouncer = new_debouncer(QUIET, None, move |result: DebounceEventResult| match result {
        Ok(events) => {
            let own = |path: &PathBuf| path.file_name().is_some_and(|other| other == name);
            if events.iter().any(|event| is_change(&event.kind) && event.paths.iter().any(own)) {
                look();
            }
        }
        Err(errors) => errors.iter().for_each(|error| tracing::warn!("watching the configuration: {error}")),
    })?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    debouncer.watch(folder, RecursiveMode::NonRecursive)?;
    Ok(debouncer)
}

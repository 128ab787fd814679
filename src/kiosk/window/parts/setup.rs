//! The configuration of this run, its file and its problems.

use crate::venue::site::{ConfigEvent, ConfigWatcher, Overrides, Site, waits_for_restart};
use crate::visitor::input::Keys;
use soffio_config::{Config, LoadedConfig, StaffOverrides};

/// Configuration of this run.
pub(crate) struct Setup {
    /// The configuration, overrides included.
    pub config: Config,
    /// Watcher of the configuration file; `None` without a file.
    pub file: Option<ConfigWatcher>,
    /// What staff must know of the configuration: mistakes, old names, settings of the panel, and keys that wait for a restart.
    pub problems: Vec<String>,
    /// Old names in the file and settings of the panel at the start; [`Self::problems`] get them when the run begins.
    pub warnings: Vec<String>,
    /// Options of the command line that take precedence over the file.
    pub overrides: Overrides,
    /// Seed of all random numbers.
    pub seed: u64,
    /// Is there only one exhibit?
    pub one: bool,
}

/// Changes by a valid configuration.
pub(crate) struct Change {
    /// The configuration before.
    pub before: Config,
    /// The settings of visits have changed.
    pub visit: bool,
    /// The exhibits are offered in another order.
    pub reordered: bool,
}

impl Setup {
    /// Does the kiosk run in a window on a desk, not in the gallery?
    pub fn on_desk(&self) -> bool {
        !self.config.screen.fullscreen
    }

    /// The next change of the file.
    pub fn next_event(&self) -> Option<ConfigEvent> {
        self.file.as_ref().and_then(ConfigWatcher::next_event)
    }

    /// Takes over a valid configuration, except the keys that wait for a restart. `standing` problems are none of the file. `Err` is returned where nothing has changed, and says whether the file had problems before.
    ///
    /// # Errors
    /// Nothing has changed; the value says whether the file had problems before.
    pub fn take_over(&mut self, loaded: LoadedConfig, standing: Vec<String>) -> Result<Change, bool> {
        let was_broken = !self.problems.is_empty();
        self.problems.clear();
        self.problems.extend(standing);
        self.problems.extend(loaded.warning_texts());
        self.problems.extend(loaded.staff.iter().map(StaffOverrides::summary));
        let mut config = self.overrides.apply(loaded.config);
        let waits = waits_for_restart(&self.config, &config);
        if !waits.is_empty() {
            let problem = format!("{}: takes effect at the next start", waits.join(", "));
            tracing::warn!("{problem}");
            self.problems.push(problem);
        }
        config.screen.fullscreen = self.config.screen.fullscreen;
        let (old, new) = (&self.config.exhibits, &mut config.exhibits);
        (new.folder, new.hot_reload) = (old.folder.clone(), old.hot_reload);
        if config == self.config {
            return Err(was_broken);
        }
        let reordered = config.exhibits.show != self.config.exhibits.show && !self.one;
        let visit = config.visit != self.config.visit;
        let before = std::mem::replace(&mut self.config, config);
        Ok(Change { before, visit, reordered })
    }

    /// Settings for the simulation.
    pub fn site(&self) -> Site {
        Site::new(&self.config, self.seed)
    }

    /// Keys of the configuration; `menu`: the page is open.
    pub fn keys(&self, menu: bool) -> Keys<'_> {
        let staff = &self.config.staff;
        Keys {
            staff: &staff.chord,
            open: &staff.open,
            mute: &staff.mute,
            night: &staff.night,
            blow: &self.config.controllers.key,
            read: &self.config.controllers.read_key,
            menu,
        }
    }
}

//! The configuration of this run, its file, and what is wrong with it.

use crate::fleet::SAFE_MODE;
use crate::venue::site::{News, Overrides, Site, SiteFile, waits_for_restart};
use crate::visitor::input::Keys;
use soffio_config::Config;

/// How the site wants its kiosk.
pub(crate) struct Setup {
    pub config: Config,
    pub file: Option<SiteFile>,
    /// What staff should know of the configuration: what is wrong with it, what waits for a restart.
    pub says: Vec<String>,
    /// What the command line says over the file.
    pub overrides: Overrides,
    /// Of all that is random.
    pub seed: u64,
    /// Is there one exhibit only?
    pub one: bool,
}

/// What a good configuration changes for the window.
pub(crate) struct Change {
    /// The configuration before.
    pub before: Config,
    /// What visitors find is another.
    pub visit: bool,
    /// The exhibits are offered in another order.
    pub reordered: bool,
}

impl Setup {
    /// Somebody's desk and not the gallery?
    pub fn on_desk(&self) -> bool {
        !self.config.screen.fullscreen
    }

    /// The next change of the file.
    pub fn news(&self) -> Option<News> {
        self.file.as_ref().and_then(SiteFile::news)
    }

    /// Takes over a good configuration, but for what waits for a restart; `safe` mode says so. `Err` says whether the file was
    /// broken before, where nothing else has changed.
    pub fn take_over(&mut self, mut config: Config, safe: bool) -> Result<Change, bool> {
        let mended = !self.says.is_empty();
        self.says.clear();
        self.says.extend(safe.then(|| SAFE_MODE.into()));
        let waits = waits_for_restart(&self.config, &config);
        if !waits.is_empty() {
            let says = format!("{}: from the next start on", waits.join(", "));
            tracing::warn!("{says}");
            self.says.push(says);
        }
        config.screen.fullscreen = self.config.screen.fullscreen;
        let (old, new) = (&self.config.exhibits, &mut config.exhibits);
        (new.folder, new.hot_reload) = (old.folder.clone(), old.hot_reload);
        if config == self.config {
            return Err(mended);
        }
        let reordered = config.exhibits.show != self.config.exhibits.show && !self.one;
        let visit = config.visit != self.config.visit;
        let before = std::mem::replace(&mut self.config, config);
        Ok(Change { before, visit, reordered })
    }

    /// What the simulation needs of it.
    pub fn site(&self) -> Site {
        Site::new(&self.config, self.seed)
    }

    /// The keys that the site chooses; `menu`: the page is open.
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

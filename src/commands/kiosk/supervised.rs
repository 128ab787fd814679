//! A kiosk that somebody starts again when it has died: `kiosk-config/launch`, or systemd.

use std::sync::Arc;

use soffio_authoring::template::Template;
use soffio_config::{Config, ConfigError};
use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_kiosk::fleet::kept::{Keeper, Kept, folder, last_good};

/// Set by the launcher from the second start on.
const RESTARTED: &str = "SOFFIO_RESTARTED";
/// Set by systemd for a unit of `Type=notify`.
const NOTIFIED: &str = "NOTIFY_SOCKET";

/// Did the launcher start this run because the last one died?
pub fn is_restart() -> bool {
    std::env::var_os(RESTARTED).is_some()
}

/// The last configuration that was good, where nobody is there to mend a broken one: then the kiosk shows what it
/// showed, and says what is wrong.
pub fn config_in_need(error: &ConfigError) -> Option<Config> {
    if !is_restart() && std::env::var_os(NOTIFIED).is_none() {
        return None;
    }
    let config = last_good(&error.file)?;
    tracing::error!("{error}\nThe last good configuration is taken instead.");
    Some(config)
}

/// A run that has begun.
pub struct Begun {
    /// Keeps what outlives it.
    pub keeper: Keeper,
    /// What the runs before it have left.
    pub kept: Kept,
    /// Is this one in safe mode?
    pub safe: bool,
    died: bool,
}

/// Begins a run: counts it, and says how the one before ended.
pub fn begin(config: &Config, asked_safe: bool) -> Begun {
    let (mut keeper, mut kept) = Keeper::open(folder(config));
    let died = kept.begin();
    keeper.begin(&kept);
    if died {
        tracing::warn!("the run before this one died; start {} goes on with what it kept", kept.starts);
    }
    Begun { keeper, safe: asked_safe || kept.wants_safe_mode(), kept, died }
}

impl Begun {
    /// The work that a run that died had on show. Who ended in order begins with the first one.
    pub fn goes_on_with(&self) -> Option<&str> {
        self.died.then_some(self.kept.on_show.as_str())
    }
}

/// A work that needs no file of the exhibits' folder.
pub struct BuiltIn {
    /// The work.
    pub exhibit: Arc<Exhibit>,
    /// Holds its files for as long as it is shown.
    _folder: tempfile::TempDir,
}

/// The pendulum of a shelf clock, from the program itself; where even that fails it is said, and the others are tried.
pub fn built_in() -> Option<BuiltIn> {
    let made = || {
        let made = Template::Pendulum.copy("pendulum").map_err(|error| error.to_string())?;
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        let inside = folder.path().join("pendulum");
        std::fs::create_dir(&inside).map_err(|error| error.to_string())?;
        for soffio_authoring::FolderFile { name, bytes } in &made.files {
            std::fs::write(inside.join(name), bytes).map_err(|error| error.to_string())?;
        }
        let exhibit = exhibit::load(&inside).map_err(|error| error.to_string())?;
        Ok::<_, String>(BuiltIn { exhibit: Arc::new(exhibit), _folder: folder })
    };
    made().inspect_err(|error| tracing::error!("the built-in work cannot be shown: {error}")).ok()
}

//! A kiosk that somebody starts again when it has died: `kiosk-config/launch`, or systemd.

use std::path::PathBuf;
use std::sync::Arc;

use soffio_authoring::template::Template;
use soffio_config::{Config, ConfigError};
use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_kiosk::fleet::instance::InstanceLock;
use soffio_kiosk::fleet::persisted::{PersistedState, StateStore, last_good, make};

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
    /// Store of the persisted state.
    pub store: StateStore,
    /// Persisted state of the runs before.
    pub persisted: PersistedState,
    /// Is this one in safe mode?
    pub safe: bool,
    died: bool,
    /// No second kiosk uses the folder of the state.
    _lock: Option<InstanceLock>,
}

/// Begins a run with its state in this folder: counts it, and logs a crash of the one before.
///
/// # Errors
/// Another kiosk is running with the same state.
pub fn begin(folder: Option<PathBuf>, asked_safe: bool) -> Result<Begun, String> {
    // A folder that cannot be made is reported when it is opened.
    let lock = match folder.as_deref().filter(|folder| make(folder).is_ok()) {
        Some(folder) => InstanceLock::take(folder)?,
        None => None,
    };
    let (mut store, mut persisted) = StateStore::open(folder);
    let died = persisted.begin();
    store.begin(&persisted);
    if died {
        tracing::warn!("the run before this one crashed; start {} restores its state", persisted.starts);
    }
    Ok(Begun { store, safe: asked_safe || persisted.wants_safe_mode(), persisted, died, _lock: lock })
}

impl Begun {
    /// The exhibit that was on show at a crash; `None` after an orderly end.
    pub fn restored_exhibit(&self) -> Option<&str> {
        self.died.then_some(self.persisted.on_show.as_str())
    }
}

/// An exhibit that needs no file of the exhibits' folder.
pub struct BuiltIn {
    /// The exhibit.
    pub exhibit: Arc<Exhibit>,
    /// Holds its files while it is shown.
    _folder: tempfile::TempDir,
}

/// A pendulum, built into the program; a failure is logged, and the configured exhibits are used.
pub fn built_in() -> Option<BuiltIn> {
    let made = || {
        let made = Template::Pendulum.copy("pendulum").map_err(|error| error.to_string())?;
        let folder = tempfile::tempdir().map_err(|error| error.to_string())?;
        let inside = folder.path().join("pendulum");
        std::fs::create_dir(&inside).map_err(|error| error.to_string())?;
        for soffio_authoring::FolderFile { name, bytes } in &made.files {
            let path = inside.join(name);
            path.parent().map_or(Ok(()), std::fs::create_dir_all).map_err(|error| error.to_string())?;
            std::fs::write(path, bytes).map_err(|error| error.to_string())?;
        }
        let exhibit = exhibit::load(&inside).map_err(|error| error.to_string())?;
        Ok::<_, String>(BuiltIn { exhibit: Arc::new(exhibit), _folder: folder })
    };
    made().inspect_err(|error| tracing::error!("the built-in exhibit cannot be shown: {error}")).ok()
}

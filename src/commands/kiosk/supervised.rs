//! A kiosk that somebody starts again when it has died: `kiosk-config/launch`, or systemd.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::SystemTime;

use soffio_authoring::template::Template;
use soffio_config::{Config, ConfigError};
use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_kiosk::fleet::instance::InstanceLock;
use soffio_kiosk::fleet::persisted::{EXHIBIT_AFTER, PersistedState, StateStore, last_good, make};
use soffio_kiosk::venue::catalog::id;

/// Number of crashes in a row within a minute of their start; set by the launcher from the second start on.
const CRASHES: &str = "SOFFIO_CRASHES";
/// Set by systemd for a unit of `Type=notify`.
const NOTIFIED: &str = "NOTIFY_SOCKET";

/// Crashes before this run that the launcher has counted; `None` at its first start, or without it.
fn crashes() -> Option<u32> {
    std::env::var(CRASHES).ok()?.parse().ok()
}

/// The last configuration that was good, where nobody is there to mend a broken one: then the kiosk shows what it
/// showed, and says what is wrong.
pub fn config_in_need(error: &ConfigError) -> Option<Config> {
    if crashes().is_none() && std::env::var_os(NOTIFIED).is_none() {
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
    /// Is this one in safe mode: nothing from outside?
    pub safe: bool,
    /// Is a built-in exhibit shown, since none is left or safe mode was asked for?
    pub shows_built_in: bool,
    /// Folders of the exhibits that are not set aside; all of them if none is left.
    folders: Vec<PathBuf>,
    /// No second kiosk uses the folder of the state.
    _lock: Option<InstanceLock>,
}

/// Begins a run with its state in the folder `state`: counts it, and logs a crash of the one before. `folders` are those of all exhibits, in
/// order.
///
/// # Errors
/// Another kiosk is running with the same state.
pub fn begin(state: Option<PathBuf>, mut folders: Vec<PathBuf>, asked_safe: bool) -> Result<Begun, String> {
    // A folder that cannot be made is reported when it is opened.
    let lock = match state.as_deref().filter(|state| make(state).is_ok()) {
        Some(state) => InstanceLock::take(state)?,
        None => None,
    };
    let (mut store, mut persisted) = StateStore::open(state);
    let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH).map_or(0, |since| since.as_secs() as i64);
    let died = persisted.begin(store.load_marker().take(), now);
    // Where no state is kept, the launcher counts.
    persisted.start_crashes = persisted.start_crashes.max(crashes().unwrap_or_default());
    store.begin(&persisted);
    if died {
        tracing::warn!("the run before this one crashed; start {} restores its state", persisted.starts);
        folders.sort_by_key(|folder| id(folder) != persisted.on_show);
    }
    let mut left = folders.clone();
    left.retain(|folder| !persisted.quarantine.contains(&id(folder)));
    if !store.is_kept() {
        // Nobody knows what was on show: the first exhibits are left out, one for so many crashes.
        left.drain(..left.len().min((persisted.start_crashes / EXHIBIT_AFTER) as usize));
    }
    let safe = asked_safe || persisted.wants_safe_mode(!left.is_empty());
    let shows_built_in = asked_safe || safe && left.is_empty();
    let folders = if left.is_empty() { folders } else { left };
    Ok(Begun { store, safe, shows_built_in, persisted, folders, _lock: lock })
}

impl Begun {
    /// Folders of the exhibits that may be shown, the first one first. After a crash that is the one that was on show.
    pub fn folders(&self) -> &[PathBuf] {
        &self.folders
    }

    /// Persists which exhibit is on show from now on, before it can crash.
    pub fn announce(&mut self, id: &str) {
        self.persisted.on_show = id.to_owned();
        self.store.begin(&self.persisted);
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

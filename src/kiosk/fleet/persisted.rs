//! Persisted state: counters, settings of staff, and how the last run ended. One small JSON file, replaced as a whole. It
//! holds counts and settings, and nothing about a person.
//!
//! A run after a crash restores the exhibit on show, the mute and blank state, and the count of wrong PINs. Each crash counts for the
//! exhibit that was loaded or shown, see `venue::quarantine`. Crashes within a minute of the start are counted too; where setting exhibits aside
//! does not end them, the next run is in safe mode.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use crate::fleet::persisted_spread::PersistedSpread;
use crate::fleet::visits::Histogram;
use crate::fleet::writer::Writer;
use crate::step::breaths::BreathSource;
use crate::venue::loudness::NightBy;
use crate::venue::quarantine::{LoadMarker, Quarantine};
use crate::venue::self_test::SelfTestHistory;
use crate::visitor::breath_time::BreathTime;
use soffio_config::Config;
use soffio_offline::atomic_file::{Readers, replace};

/// Age of a run from which a crash does not count as one of the start.
pub const SETTLED: Duration = Duration::from_secs(60);
/// Crashes of the start in a row that lead to safe mode where no other exhibit is left. One may be chance; three are the file.
pub const EXHIBIT_AFTER: u32 = 3;
/// Crashes of the start in a row that lead to safe mode whatever is on show: two exhibits were set aside, so it is something else.
pub const SAFE_MODE_AFTER: u32 = 2 * EXHIBIT_AFTER;
/// Least time between two writes.
const EVERY: Duration = Duration::from_secs(1);
/// Names of the state file, and of the copy of the last valid configuration beside it.
const FILE: &str = "state.json";
const LAST_GOOD: &str = "last-good.toml";

/// Phase of a run.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum RunPhase {
    /// Ended in order, or never begun.
    #[default]
    Ended,
    /// Running for less than [`SETTLED`].
    Young,
    /// Running for longer.
    Settled,
}

/// The persisted state. Keys that an older file lacks have their defaults; each alias is the key of an older file.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct PersistedState {
    /// Phase of the run that wrote this.
    #[serde(alias = "life")]
    pub phase: RunPhase,
    /// Crashes of the start in a row.
    #[serde(alias = "deaths")]
    pub start_crashes: u32,
    /// Runs so far.
    pub starts: u64,
    /// Id of the exhibit on show.
    pub on_show: String,
    /// Exhibits that are set aside after crashes.
    pub quarantine: Quarantine,
    /// Muted by staff?
    pub muted: bool,
    /// What decides whether it is night.
    pub night_by: NightBy,
    /// Blanked by a remote command?
    pub blank: bool,
    /// Wrong PINs in a row.
    pub wrong_pins: i32,
    /// Breath time of the day.
    #[serde(alias = "given")]
    pub breath_time: BreathTime,
    /// Results of the audio self-test, and the state of the foam.
    #[serde(alias = "care")]
    pub self_test: SelfTestHistory,
    /// What the breath detector knows of the room.
    pub ambient_spread: Option<PersistedSpread>,
    /// Counters over all runs since the file was deleted.
    #[serde(alias = "tally")]
    pub counters: Counters,
}

/// Counters over all runs.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Counters {
    /// Visits that have ended.
    pub visits: u64,
    /// Histogram of their lengths, s.
    pub dwell: Histogram,
    /// Visits by the language that was shown last.
    pub languages: BTreeMap<String, u64>,
    /// Breaths by their source.
    pub blows: BTreeMap<String, u64>,
}

impl Counters {
    /// Breaths at the microphone.
    pub fn breaths(&self) -> u64 {
        self.blows.get(&BreathSource::Microphone.to_string()).copied().unwrap_or_default()
    }
}

impl PersistedState {
    /// Begins a run at `now`, seconds since 1970. Returns whether the one before it crashed; `loading` is the exhibit that it was
    /// loading then, if not the one on show.
    pub fn begin(&mut self, loading: Option<String>, now: i64) -> bool {
        let crashed = self.phase != RunPhase::Ended;
        self.quarantine.expire(now);
        let id = loading.unwrap_or_else(|| self.on_show.clone());
        if crashed && !id.is_empty() {
            self.quarantine.record(&id, now);
        }
        self.start_crashes = if self.phase == RunPhase::Young { self.start_crashes.saturating_add(1) } else { 0 };
        self.phase = RunPhase::Young;
        self.starts += 1;
        crashed
    }

    /// Did too many runs crash at their start? `others`: is an exhibit left that is not set aside?
    pub fn wants_safe_mode(&self, others: bool) -> bool {
        self.start_crashes >= if others { SAFE_MODE_AFTER } else { EXHIBIT_AFTER }
    }
}

/// Folder of the persisted state: `staff.state`, else systemd's `$STATE_DIRECTORY`, else the user's own. `None` in a
/// window on a desk, which has no visitors.
pub fn folder(config: &Config) -> Option<PathBuf> {
    if !config.staff.state.as_os_str().is_empty() {
        return Some(config.staff.state.clone());
    }
    if !config.screen.fullscreen {
        return None;
    }
    let variable = |name| std::env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
    // systemd gives one folder for each name in the unit, with colons between them; ours has one.
    variable("STATE_DIRECTORY")
        .or_else(|| variable("XDG_STATE_HOME").map(|home| home.join("soffio")))
        .or_else(|| variable("HOME").map(|home| home.join(".local/state/soffio")))
}

/// Reads and writes the persisted state.
#[derive(Debug, Default)]
pub struct StateStore {
    folder: Option<PathBuf>,
    writer: Option<Writer>,
    written: Option<Instant>,
    last: PersistedState,
    /// The begin of the run could not be written.
    refused: bool,
}

impl StateStore {
    /// Opens the folder, creates it if needed, and reads the state. An unreadable file is logged, and the state starts from
    /// its defaults.
    pub fn open(folder: Option<PathBuf>) -> (Self, PersistedState) {
        let Some(folder) = folder else { return <(Self, PersistedState)>::default() };
        if let Err(error) = make(&folder) {
            tracing::warn!(
                "no state is kept after this run: {} cannot be created: {error}; set staff.state to a writable folder",
                folder.display()
            );
            return <(Self, PersistedState)>::default();
        }
        let file = folder.join(FILE);
        let state = match std::fs::read(&file) {
            Ok(bytes) => serde_json::from_slice(&bytes).unwrap_or_else(|error| {
                tracing::warn!("{} is broken ({error}): all counters start at zero", file.display());
                PersistedState::default()
            }),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                tracing::info!("{} is new: all counters start at zero", file.display());
                PersistedState::default()
            }
            Err(error) => {
                tracing::warn!("{} cannot be read ({error}): all counters start at zero", file.display());
                PersistedState::default()
            }
        };
        (
            Self {
                writer: Some(Writer::start("state", file, Readers::Owner)),
                folder: Some(folder),
                ..Self::default()
            },
            state,
        )
    }

    /// What distinguishes this kiosk from others on the same machine: its folder, or its process where nothing is kept.
    pub fn instance(&self) -> String {
        let folder = self.folder.as_ref().map(|folder| folder.canonicalize().unwrap_or_else(|_| folder.clone()));
        folder.map_or_else(|| std::process::id().to_string(), |folder| folder.to_string_lossy().into_owned())
    }

    /// Names the exhibit that is being loaded.
    pub fn load_marker(&self) -> LoadMarker {
        LoadMarker::new(self.folder.as_deref())
    }

    /// Is the state kept after this run?
    pub fn is_kept(&self) -> bool {
        self.folder.is_some()
    }

    /// Writes the begin of a run at once, before it can crash.
    pub fn begin(&mut self, state: &PersistedState) {
        let Some(folder) = &self.folder else { return };
        match replace(&folder.join(FILE), text(state).as_bytes(), Readers::Owner) {
            Ok(()) => self.last = state.clone(),
            // Said once: the writer says it again when the disk has room.
            Err(_) if self.refused => {}
            Err(error) => {
                self.refused = true;
                tracing::warn!("state: {error}. This start is not counted.");
            }
        }
    }

    /// Writes a changed state, once a second at most.
    pub fn save_if_due(&mut self, now: Instant, state: &PersistedState) {
        let due = self.written.is_none_or(|at| now.duration_since(at) >= EVERY);
        let Some(writer) = self.writer.as_ref().filter(|_| due && *state != self.last) else { return };
        if writer.write(text(state)) {
            (self.written, self.last) = (Some(now), state.clone());
        }
    }

    /// Writes that the run ended in order.
    pub fn end(&mut self, mut state: PersistedState) {
        (state.phase, state.start_crashes) = (RunPhase::Ended, 0);
        if let Some(writer) = self.writer.take() {
            writer.finish(text(&state));
        }
    }

    /// Copies a valid configuration, for a start at which the file itself is broken.
    pub fn save_good_config(&self, file: &Path) {
        let Some(folder) = &self.folder else { return };
        // It may hold a password.
        let to = folder.join(LAST_GOOD);
        let copied = std::fs::read(file).and_then(|text| replace(&to, &text, Readers::Owner));
        if let Err(error) = copied {
            tracing::warn!("the valid configuration cannot be copied: {error}");
        }
    }
}

/// The last valid configuration, for a kiosk whose `file` is broken when it starts; `None` where there is no copy. The
/// folder is read from the broken file if possible.
pub fn last_good(file: &Path) -> Option<Config> {
    let named = std::fs::read_to_string(file).ok().and_then(|text| state_named_in(&text));
    let folders = [named, folder(&Config::default())].into_iter().flatten();
    let mut good = folders.filter_map(|folder| Config::load(Some(&folder.join(LAST_GOOD))).ok());
    good.next().map(|loaded| loaded.config)
}

/// `state` of `[staff]`, from a text in which another line may be broken.
fn state_named_in(text: &str) -> Option<PathBuf> {
    let staff = text.lines().map(str::trim).skip_while(|line| !line.starts_with("[staff]")).skip(1);
    let mut within = staff.take_while(|line| !line.starts_with('['));
    let line: toml::Table =
        within.find(|line| line.split('=').next().is_some_and(|key| key.trim() == "state"))?.parse().ok()?;
    line.get("state")?.as_str().filter(|folder| !folder.is_empty()).map(PathBuf::from)
}

/// The state in a folder, without opening it for writing.
pub fn read(folder: &Path) -> Option<PersistedState> {
    serde_json::from_slice(&std::fs::read(folder.join(FILE)).ok()?).ok()
}

fn text(state: &PersistedState) -> String {
    // Maps with text keys and numbers always have a JSON form.
    serde_json::to_string_pretty(state).unwrap_or_default()
}

/// Creates a folder that only its owner can read: a configuration may hold a password.
///
/// # Errors
/// The system's reason.
pub fn make(folder: &Path) -> std::io::Result<()> {
    let mut builder = std::fs::DirBuilder::new();
    builder.recursive(true);
    #[cfg(unix)]
    std::os::unix::fs::DirBuilderExt::mode(&mut builder, 0o700);
    builder.create(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_broken_configuration_still_says_where_its_last_good_copy_is() {
        let broken =
            "[visit]\nbreth = tru\n[[[\n[staff]\npin = \n  state = \"/srv/kiosk 2\"  # ours\n[mqtt]\nstate = \"no\"\n";
        assert_eq!(state_named_in(broken), Some("/srv/kiosk 2".into()));
        assert_eq!(state_named_in("state = \"/elsewhere\"\n[staff]\nstate = \"\"\n"), None);
        assert_eq!(state_named_in("[staff]\nstate = [\n"), None);
    }

    #[test]
    fn the_last_good_copy_lies_in_the_folder_that_the_broken_file_names() {
        let home = tempfile::tempdir().expect("a folder");
        let (file, state) = (home.path().join("kiosk.toml"), home.path().join("state"));
        let site = |more: &str| format!("[staff]\nstate = {:?}\n{more}", state.to_string_lossy());
        std::fs::write(&file, site("[visit]\nbreath = false\n")).expect("written");
        StateStore::open(Some(state.clone())).0.save_good_config(&file);
        std::fs::write(&file, site("[visit]\nbreath = fals\n")).expect("written");
        assert!(Config::load(Some(&file)).is_err(), "it is broken");
        assert!(!last_good(&file).expect("the copy").visit.breath);
    }

    #[test]
    fn crashes_in_the_first_minute_ask_for_safe_mode_and_a_long_run_or_an_orderly_end_forgets_them() {
        let mut state = PersistedState::default();
        assert!(!state.begin(None, 0), "the first run follows nobody");
        for crash in 1..=SAFE_MODE_AFTER {
            assert!(state.begin(None, 0));
            let wants = [false, true].map(|others| state.wants_safe_mode(others));
            assert_eq!((state.start_crashes, wants), (crash, [crash >= EXHIBIT_AFTER, crash >= SAFE_MODE_AFTER]));
        }
        state.phase = RunPhase::Settled;
        assert!(state.begin(None, 0) && state.start_crashes == 0, "a long run was no crash of its start");
        state.begin(None, 0);
        state.phase = RunPhase::Ended;
        assert!(!state.begin(None, 0) && state.start_crashes == 0 && state.starts == 10);
    }

    #[test]
    fn a_crash_counts_for_the_exhibit_that_was_loaded_or_else_shown_however_late_it_comes() {
        let mut state =
            PersistedState { phase: RunPhase::Settled, on_show: "clock".into(), ..PersistedState::default() };
        for now in 0..3 {
            assert!(!state.quarantine.contains("bad"));
            assert!(state.begin(Some("bad".into()), now));
            state.phase = RunPhase::Settled;
        }
        assert!(state.quarantine.contains("bad") && !state.quarantine.contains("clock"));
        (3..6).for_each(|now| {
            state.begin(None, now);
            state.phase = RunPhase::Settled;
        });
        assert!(state.quarantine.contains("clock"), "it crashed after the first minute, and counts");
        state.phase = RunPhase::Ended;
        state.begin(Some("cart".into()), 7);
        assert_eq!(state.quarantine.set_aside().collect::<Vec<_>>(), ["bad", "clock"], "an orderly end is no crash");
    }

    #[test]
    fn what_is_kept_comes_back_and_what_is_broken_starts_again() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("in/state");
        let (mut store, mut state) = StateStore::open(Some(path.clone()));
        assert_eq!(state, PersistedState::default());
        state.begin(None, 0);
        store.begin(&state);
        assert_eq!(StateStore::open(Some(path.clone())).1.phase, RunPhase::Young, "at once");
        state.on_show = "clock".into();
        state.counters.blows.insert("hold".into(), 7);
        state.breath_time.add("clock", jiff::civil::Date::constant(2026, 1, 5), 12.5);
        let now = Instant::now();
        store.save_if_due(now, &state);
        state.wrong_pins = 3;
        store.save_if_due(now, &state);
        store.end(state.clone());
        let (_, read) = StateStore::open(Some(path.clone()));
        let breath_time = read.breath_time.of("clock");
        assert_eq!(
            (read.phase, read.wrong_pins, breath_time),
            (RunPhase::Ended, 3, [0.0, 12.5]),
            "the visit itself is over"
        );
        assert_eq!(read.counters, state.counters);

        // An older file knows less; a torn one nothing.
        std::fs::write(path.join(FILE), r#"{"starts": 5}"#).expect("writable");
        assert_eq!(StateStore::open(Some(path.clone())).1, PersistedState { starts: 5, ..PersistedState::default() });
        std::fs::write(path.join(FILE), r#"{"starts": 5, "de"#).expect("writable");
        assert_eq!(StateStore::open(Some(path)).1, PersistedState::default());
    }

    #[test]
    fn a_file_with_the_older_keys_is_read_and_written_with_the_present_ones() {
        let folder = tempfile::tempdir().expect("a folder");
        let older = r#"{"life": "young", "deaths": 2, "starts": 5, "given": {"day": [["clock", 12.5]], "date": "2026-01-05"},
            "care": {"foam_changed_at": 3, "clean_db": [[1, 2, 3, 4, 5, 6, 7]]}, "tally": {"visits": 4}}"#;
        std::fs::write(folder.path().join(FILE), older).expect("writable");
        let (mut store, state) = StateStore::open(Some(folder.path().into()));
        assert_eq!((state.phase, state.start_crashes, state.starts), (RunPhase::Young, 2, 5));
        assert_eq!((state.breath_time.of("clock"), state.counters.visits), ([0.0, 12.5], 4));
        assert_eq!((state.self_test.foam_changed_at, state.self_test.reference_db.len()), (3, 1));
        store.end(state);
        let written = std::fs::read_to_string(folder.path().join(FILE)).expect("readable");
        for (old, new) in [
            ("life", "phase"),
            ("deaths", "start_crashes"),
            ("given", "breath_time"),
            ("care", "self_test"),
            ("clean_db", "reference_db"),
            ("tally", "counters"),
        ] {
            let has = |key: &str| written.contains(&format!("\"{key}\":"));
            assert!(has(new) && !has(old), "{old}, {new}: {written}");
        }
    }

    #[test]
    fn where_the_folder_cannot_be_made_the_kiosk_goes_on() {
        let folder = tempfile::tempdir().expect("a folder");
        let taken = folder.path().join("taken");
        std::fs::write(&taken, "").expect("writable");
        let (mut store, state) = StateStore::open(Some(taken.join("state")));
        store.save_if_due(Instant::now(), &PersistedState { starts: 1, ..state });
        assert!(store.writer.is_none());
    }
}

//! What outlives the process: counters, how staff left the kiosk, and how the last run ended. One small file of JSON,
//! written whole. Numbers only; nothing in it is about anybody.
//!
//! A run that was killed is gone on with: the same work on show, muted or black as staff left it, wrong PINs not
//! forgotten. Runs that die within a minute of their start are counted; after [`MOST_DEATHS`] of them in a row the next
//! one is in safe mode.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};

use crate::fleet::visits::Histogram;
use crate::fleet::writer::{Writer, write};
use crate::step::breaths::Source;
use crate::venue::care::Care;
use crate::venue::loudness::NightBy;
use crate::visitor::given::Given;
use soffio_config::Config;

/// A run that has lived so long did not die of its start.
pub const SETTLED: Duration = Duration::from_secs(60);
/// After so many runs in a row that died before that, safe mode.
pub const MOST_DEATHS: u32 = 3;
/// Between two writes, at least.
const EVERY: Duration = Duration::from_secs(1);
/// The file's name, and beside it the last configuration that was good.
const FILE: &str = "state.json";
const LAST_GOOD: &str = "last-good.toml";

/// How far a run has come.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Life {
    /// It has ended in order, or never began.
    #[default]
    Ended,
    /// It runs, for less than [`SETTLED`].
    Young,
    /// It runs, for longer.
    Settled,
}

/// All that is kept. What an older file does not have is as in a new one.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Kept {
    /// The run that wrote this.
    pub life: Life,
    /// Runs in a row that died young.
    pub deaths: u32,
    /// Runs so far.
    pub starts: u64,
    /// Id of the work on show.
    pub on_show: String,
    /// Muted by staff?
    pub muted: bool,
    /// Who says whether it is night.
    pub night_by: NightBy,
    /// Made black by whoever looks after many kiosks?
    pub blank: bool,
    /// Wrong PINs in a row.
    pub wrong_pins: i32,
    /// Breath given today.
    pub given: Given,
    /// What is known of foam and chirps.
    pub care: Care,
    /// What is counted for ever.
    pub tally: Tally,
}

/// What is counted for ever.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Tally {
    /// Visits that have ended.
    pub visits: u64,
    /// How long they were, s.
    pub dwell: Histogram,
    /// Visits by the language that was shown last.
    pub languages: BTreeMap<String, u64>,
    /// Breaths by their source.
    pub blows: BTreeMap<String, u64>,
}

impl Tally {
    /// Breaths at the microphone.
    pub fn breaths(&self) -> u64 {
        self.blows.get(&Source::Microphone.to_string()).copied().unwrap_or_default()
    }
}

impl Kept {
    /// A run begins. Says whether the one before it died.
    pub fn begin(&mut self) -> bool {
        let died = self.life != Life::Ended;
        self.deaths = if self.life == Life::Young { self.deaths.saturating_add(1) } else { 0 };
        self.life = Life::Young;
        self.starts += 1;
        died
    }

    /// Have too many died of their start?
    pub fn wants_safe_mode(&self) -> bool {
        self.deaths >= MOST_DEATHS
    }
}

/// The folder for what is kept: `staff.state`, else systemd's `$STATE_DIRECTORY`, else the user's own; none on a desk,
/// where nobody is a visitor.
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

/// Where what is kept is.
#[derive(Debug, Default)]
pub struct Keeper {
    folder: Option<PathBuf>,
    writer: Option<Writer>,
    written: Option<Instant>,
    last: Kept,
}

impl Keeper {
    /// Opens the folder, makes it if need be, and reads what is there. What cannot be read is begun anew, and said.
    pub fn open(folder: Option<PathBuf>) -> (Self, Kept) {
        let Some(folder) = folder else { return <(Self, Kept)>::default() };
        if let Err(error) = make(&folder) {
            tracing::warn!(
                "nothing outlives this run: {} cannot be made: {error}; set staff.state to a folder that can be written",
                folder.display()
            );
            return <(Self, Kept)>::default();
        }
        let file = folder.join(FILE);
        let kept = match std::fs::read(&file) {
            Ok(bytes) => serde_json::from_slice(&bytes).unwrap_or_else(|error| {
                tracing::warn!("{} is broken ({error}): all counters begin anew", file.display());
                Kept::default()
            }),
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => {
                tracing::info!("{} is new: all counters begin at zero", file.display());
                Kept::default()
            }
            Err(error) => {
                tracing::warn!("{} cannot be read ({error}): all counters begin anew", file.display());
                Kept::default()
            }
        };
        (Self { writer: Some(Writer::start("state", file)), folder: Some(folder), ..Self::default() }, kept)
    }

    /// A run begins: written at once, before anything can die of it.
    pub fn begin(&mut self, kept: &Kept) {
        let Some(folder) = &self.folder else { return };
        match write(&folder.join(FILE), &text(kept)) {
            Ok(()) => self.last = kept.clone(),
            Err(error) => tracing::warn!("state: {error}. This start is not counted."),
        }
    }

    /// Writes what has changed, once a second at most.
    pub fn tend(&mut self, now: Instant, kept: &Kept) {
        let due = self.written.is_none_or(|at| now.duration_since(at) >= EVERY);
        let Some(writer) = self.writer.as_ref().filter(|_| due && *kept != self.last) else { return };
        if writer.write(text(kept)) {
            (self.written, self.last) = (Some(now), kept.clone());
        }
    }

    /// The run ends in order.
    pub fn end(&mut self, mut kept: Kept) {
        (kept.life, kept.deaths) = (Life::Ended, 0);
        if let Some(writer) = self.writer.take() {
            writer.finish(text(&kept));
        }
    }

    /// Keeps a copy of a configuration that was good, for a start at which the file itself is broken.
    pub fn keep_good(&self, file: &Path) {
        let Some(folder) = &self.folder else { return };
        let copied = std::fs::read_to_string(file).and_then(|text| write(&folder.join(LAST_GOOD), &text));
        if let Err(error) = copied {
            tracing::warn!("no copy of the good configuration is kept: {error}");
        }
    }
}

/// The last configuration that was good, where one was kept: for a kiosk whose `file` is broken when it starts. As far as it
/// can be read it still says where.
pub fn last_good(file: &Path) -> Option<Config> {
    let named = std::fs::read_to_string(file).ok().and_then(|text| state_named_in(&text));
    let folders = [named, folder(&Config::default())].into_iter().flatten();
    let mut good = folders.filter_map(|folder| Config::load(Some(&folder.join(LAST_GOOD))).ok());
    good.next().map(|(config, _)| config)
}

/// `state` of `[staff]`, from a text of which another line may be broken.
fn state_named_in(text: &str) -> Option<PathBuf> {
    let staff = text.lines().map(str::trim).skip_while(|line| !line.starts_with("[staff]")).skip(1);
    let mut within = staff.take_while(|line| !line.starts_with('['));
    let line: toml::Table =
        within.find(|line| line.split('=').next().is_some_and(|key| key.trim() == "state"))?.parse().ok()?;
    line.get("state")?.as_str().filter(|folder| !folder.is_empty()).map(PathBuf::from)
}

/// What is kept there now, for whoever only looks.
pub fn look(folder: &Path) -> Option<Kept> {
    serde_json::from_slice(&std::fs::read(folder.join(FILE)).ok()?).ok()
}

fn text(kept: &Kept) -> String {
    // Maps with text keys and numbers always have a JSON form.
    serde_json::to_string_pretty(kept).unwrap_or_default()
}

/// Makes a folder that nobody else reads: a configuration may hold a password.
fn make(folder: &Path) -> std::io::Result<()> {
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
        Keeper::open(Some(state.clone())).0.keep_good(&file);
        std::fs::write(&file, site("[visit]\nbreath = fals\n")).expect("written");
        assert!(Config::load(Some(&file)).is_err(), "it is broken");
        assert!(!last_good(&file).expect("the copy").visit.breath);
    }

    #[test]
    fn three_deaths_in_the_first_minute_ask_for_safe_mode_and_a_life_or_an_orderly_end_forgets_them() {
        let mut kept = Kept::default();
        assert!(!kept.begin(), "the first run follows nobody");
        for death in 1..=MOST_DEATHS {
            assert!(kept.begin());
            assert_eq!((kept.deaths, kept.wants_safe_mode()), (death, death >= MOST_DEATHS));
        }
        kept.life = Life::Settled;
        assert!(kept.begin() && kept.deaths == 0, "a long life was no death of its start");
        kept.begin();
        kept.life = Life::Ended;
        assert!(!kept.begin() && kept.deaths == 0 && kept.starts == 7);
    }

    #[test]
    fn what_is_kept_comes_back_and_what_is_broken_begins_anew() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("in/state");
        let (mut keeper, mut kept) = Keeper::open(Some(path.clone()));
        assert_eq!(kept, Kept::default());
        kept.begin();
        keeper.begin(&kept);
        assert_eq!(Keeper::open(Some(path.clone())).1.life, Life::Young, "at once");
        kept.on_show = "clock".into();
        kept.tally.blows.insert("hold".into(), 7);
        kept.given.note("clock", jiff::civil::Date::constant(2026, 1, 5), 12.5);
        let now = Instant::now();
        keeper.tend(now, &kept);
        kept.wrong_pins = 3;
        keeper.tend(now, &kept);
        keeper.end(kept.clone());
        let (_, read) = Keeper::open(Some(path.clone()));
        let given = read.given.of("clock");
        assert_eq!((read.life, read.wrong_pins, given), (Life::Ended, 3, [0.0, 12.5]), "the visit itself is over");
        assert_eq!(read.tally, kept.tally);

        // An older file knows less; a torn one nothing.
        std::fs::write(path.join(FILE), r#"{"starts": 5}"#).expect("writable");
        assert_eq!(Keeper::open(Some(path.clone())).1, Kept { starts: 5, ..Kept::default() });
        std::fs::write(path.join(FILE), r#"{"starts": 5, "de"#).expect("writable");
        assert_eq!(Keeper::open(Some(path)).1, Kept::default());
    }

    #[test]
    fn where_the_folder_cannot_be_made_the_kiosk_goes_on() {
        let folder = tempfile::tempdir().expect("a folder");
        let taken = folder.path().join("taken");
        std::fs::write(&taken, "").expect("writable");
        let (mut keeper, kept) = Keeper::open(Some(taken.join("state")));
        keeper.tend(Instant::now(), &Kept { starts: 1, ..kept });
        assert!(keeper.writer.is_none());
    }
}

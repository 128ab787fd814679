//! A kiosk as one of a fleet: counters, state kept over a restart, metrics, MQTT, and systemd's watchdog.
//!
//! It observes from the window's side and changes nothing that a visitor sees. Commands of a broker are handed to the window.

pub mod instance;
pub mod metrics;
pub(crate) mod mqtt;
pub(crate) mod orders;
pub mod persisted;
pub mod persisted_spread;
pub mod visits;
#[cfg(target_os = "linux")]
pub(crate) mod watchdog;
pub(crate) mod writer;

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::fleet::metrics::{ContentVersion, Metrics, MetricsInput, text};
use crate::fleet::mqtt::Mqtt;
pub use crate::fleet::orders::Order;
use crate::fleet::persisted::{Counters, PersistedState, RunPhase, SETTLED, StateStore};
use crate::fleet::persisted_spread::PersistedSpread;
use crate::fleet::visits::{DWELL_S, FRAME_S, Histogram, VisitCounter, VisitorSigns};
use crate::live::LiveState;
use crate::venue::loudness::VolumeRequests;
use crate::venue::quarantine::LoadMarker;
use crate::venue::self_test::SelfTestHistory;
use crate::venue::state::VenueState;
use crate::visitor::breath_time::BreathTime;
use soffio_config::{Config, Day, TimeOfDay};
use soffio_devices::audio::DeviceState;
use soffio_exhibit::{Exhibit, files};

/// Longest wait of the daily self-test for a moment without visitors, minutes.
const SELF_TEST_WAITS_MIN: u16 = 60;
/// Time between two copies of what the detector knows of the room: it changes over minutes, and an empty night must not fill a log of
/// writes.
const SPREAD_EVERY: Duration = Duration::from_secs(600);

/// Message about safe mode for staff.
pub const SAFE_MODE: &str = "safe mode: the kiosk crashed again and again within a minute of its start, so it ignores controllers \
                             and remote commands, and shows an exhibit that has not crashed, or else a built-in one. The log \
                             before says why it crashed; a restart tries again";

/// State of the window, for counters, metrics and reports.
pub struct WindowStatus<'a> {
    /// State of the simulation.
    pub frame: &'a LiveState,
    /// The configuration.
    pub site: &'a Config,
    /// State of the venue.
    pub venue: &'a VenueState,
    /// Breath time of the day.
    pub breath_time: &'a BreathTime,
    /// Language on show.
    pub language: &'a str,
    /// Inputs so far.
    pub activity: u64,
    /// Wrong PINs in a row.
    pub wrong_pins: i32,
    /// Lines of the log that were dropped since nobody read them.
    pub dropped_lines: usize,
}

/// A moment by the clock on the wall.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LocalTime {
    /// Its day.
    pub today: Day,
    /// The day before.
    pub yesterday: Day,
    /// Its time of day.
    pub time: TimeOfDay,
}

/// Counters, persisted state and reports of this kiosk.
pub struct Fleet {
    store: StateStore,
    persisted: PersistedState,
    /// Counters of the runs before this one.
    before: Counters,
    visits: VisitCounter,
    /// Times from picture to picture.
    frames: Histogram,
    metrics: Metrics,
    mqtt: Mqtt,
    /// What distinguishes this kiosk from others on the machine.
    instance: String,
    began: Instant,
    safe: bool,
    /// Was the last reloaded file, a configuration or an exhibit, valid?
    reloads: bool,
    /// Self-tests recorded so far.
    self_tests: u64,
    /// The day of the last self-test.
    tested_on: Option<Day>,
    /// When the room was copied last.
    spread_at: Instant,
    /// The exhibit on show, and a hash of its sidecar.
    content: Option<(Arc<Exhibit>, String)>,
}

impl Fleet {
    /// For a run that has begun, in safe mode or not.
    pub fn start(store: StateStore, persisted: PersistedState, safe: bool, site: &Config) -> Self {
        let instance = store.instance();
        Self {
            store,
            before: persisted.counters.clone(),
            persisted,
            visits: VisitCounter::default(),
            frames: Histogram::default(),
            metrics: Metrics::start(site.staff.metrics.clone()),
            mqtt: Mqtt::start(&site.mqtt, &instance),
            instance,
            began: Instant::now(),
            spread_at: Instant::now(),
            safe,
            reloads: true,
            self_tests: 0,
            tested_on: None,
            content: None,
        }
    }

    /// The persisted state.
    pub fn persisted(&self) -> &PersistedState {
        &self.persisted
    }

    /// Is it in safe mode?
    pub fn is_safe(&self) -> bool {
        self.safe
    }

    /// What staff must know of the runs before this one: safe mode, and the exhibits that are set aside.
    pub fn problems(&self) -> Vec<String> {
        let set_aside = self.persisted.quarantine.set_aside().map(|id| {
            format!(
                "{id} is set aside: the kiosk crashed again and again while it was loaded or shown. It is offered again when \
                 its files change, or after a day"
            )
        });
        self.safe.then(|| SAFE_MODE.into()).into_iter().chain(set_aside).collect()
    }

    /// Offers an exhibit again that was set aside, since its files have changed. Returns whether it was.
    pub fn release(&mut self, id: &str) -> bool {
        self.persisted.quarantine.release(id)
    }

    /// Names the exhibit that is being loaded.
    pub fn load_marker(&self) -> LoadMarker {
        self.store.load_marker()
    }

    /// Requests that restore the loudness as staff left it.
    pub fn volume_requests(&self) -> VolumeRequests {
        VolumeRequests {
            mutes: self.persisted.muted.into(),
            nights: self.persisted.night_by.presses(),
            ..VolumeRequests::default()
        }
    }

    /// Is somebody here?
    pub fn is_visited(&self) -> bool {
        self.visits.in_progress()
    }

    /// Records the time between two frames, s.
    pub fn record_frame(&mut self, seconds: f64) {
        self.frames.record(FRAME_S, seconds);
    }

    /// Records whether a reloaded configuration or exhibit was valid. A valid configuration `file` is copied.
    pub fn record_reload(&mut self, good: bool, file: Option<&Path>) {
        self.reloads = good;
        if let Some(file) = file.filter(|_| good) {
            self.store.save_good_config(file);
        }
    }

    /// Takes over a changed configuration.
    pub fn reconfigure(&mut self, before: &Config, site: &Config) {
        if before.staff.metrics != site.staff.metrics {
            self.metrics = Metrics::start(site.staff.metrics.clone());
        }
        if before.mqtt != site.mqtt {
            // The old connection ends before the new one uses its name.
            self.mqtt = Mqtt::none();
            self.mqtt = Mqtt::start(&site.mqtt, &self.instance);
        }
    }

    /// Counts, stores and reports. Call it often; it does little most of the time.
    pub fn update(&mut self, now: Instant, seen: &WindowStatus) {
        let lived = now.duration_since(self.began);
        let (frame, load) = (seen.frame, &seen.frame.load);
        let blows = frame.current.breath.estimate.speed > 0.0;
        let signs = VisitorSigns { inputs: seen.activity, blows };
        let counters = &mut self.persisted.counters;
        if let Some(visit) = self.visits.record(lived.as_secs_f64(), signs, seen.language, seen.site.attract.idle_s) {
            counters.visits += 1;
            counters.dwell.record(DWELL_S, visit.seconds);
            *counters.languages.entry(visit.language).or_default() += 1;
        }
        for (source, count) in load.blows.iter().filter(|(_, count)| *count > 0) {
            let name = source.to_string();
            let before = self.before.blows.get(&name).copied().unwrap_or_default();
            counters.blows.insert(name, before + count);
        }
        if lived >= SETTLED {
            self.persisted.phase = RunPhase::Settled;
        }
        self.persisted.on_show.clone_from(&frame.exhibit.id);
        // Before the first step the simulation does not know the settings of staff.
        if frame.current.step > 0 {
            (self.persisted.muted, self.persisted.night_by) = (load.loudness.muted, load.loudness.by);
        }
        if let Some(ambient_spread) = load.ambient_spread.filter(|_| now.duration_since(self.spread_at) >= SPREAD_EVERY)
        {
            (self.persisted.ambient_spread, self.spread_at) = (Some(PersistedSpread::from(ambient_spread)), now);
        }
        self.persisted.blank = seen.venue.is_blank();
        self.persisted.wrong_pins = seen.wrong_pins;
        if self.persisted.breath_time != *seen.breath_time {
            self.persisted.breath_time = seen.breath_time.clone();
        }
        if let (count, Some(outcome)) = &load.self_test
            && *count != self.self_tests
        {
            self.self_tests = *count;
            let when = jiff::Zoned::now().strftime("%Y-%m-%d %H:%M").to_string();
            match self.persisted.self_test.record(outcome, when) {
                verdict if verdict.is_bad() => tracing::warn!("audio self-test: {verdict}"),
                verdict => tracing::info!("audio self-test: {verdict}"),
            }
        }
        self.store.save_if_due(now, &self.persisted);

        if self.content.as_ref().is_none_or(|(shown, _)| !Arc::ptr_eq(shown, &frame.exhibit)) {
            self.content = Some((frame.exhibit.clone(), version(&frame.exhibit)));
        }
        let version = self.content.as_ref().map_or("", |(_, version)| version);
        let numbers = MetricsInput {
            persisted: &self.persisted,
            frames: &self.frames,
            safe: self.safe,
            reloads: self.reloads,
            dropped_lines: seen.dropped_lines,
            foam_lasts: seen.site.maintenance.foam_blows,
            content: ContentVersion { exhibit: &frame.exhibit.id, version },
        };
        self.metrics.update(now, || text(frame, &numbers));
        let fleet =
            FleetState { persisted: &self.persisted, version, safe: self.safe, visited: self.visits.in_progress() };
        self.mqtt.update(now, || state(seen, &fleet));
    }

    /// Is the daily self-test due now? `at`: its configured time; `None`: staff start it. For an hour it waits until the
    /// venue is closed or nobody is there; then it is skipped for the day.
    pub fn self_test_is_due(&mut self, at: Option<TimeOfDay>, now: LocalTime, open: bool) -> bool {
        let LocalTime { today, yesterday, time } = now;
        let Some(late) = at.map(|at| time.since(at)).filter(|late| *late < SELF_TEST_WAITS_MIN) else { return false };
        // An hour that began before midnight belongs to the day before.
        let day = if late > time.since(TimeOfDay::from_minutes(0)) { yesterday } else { today };
        let is = self.tested_on != Some(day) && !(open && self.visits.in_progress());
        if is {
            self.tested_on = Some(day);
        }
        is
    }

    /// Results of the self-test, for staff to change.
    pub fn self_test(&mut self) -> &mut SelfTestHistory {
        &mut self.persisted.self_test
    }

    /// Number of breaths at the microphone in all runs.
    pub fn breaths(&self) -> u64 {
        self.persisted.counters.breaths()
    }

    /// The next command of the broker that is due.
    pub fn order(&self, now: Instant) -> Option<Order> {
        self.mqtt.order(now)
    }

    /// The run ends in order.
    pub fn end(&mut self) {
        self.store.end(self.persisted.clone());
    }
}

/// What the fleet knows beside the window.
struct FleetState<'a> {
    persisted: &'a PersistedState,
    /// Hash of the sidecar of the exhibit on show.
    version: &'a str,
    /// Does the kiosk run in safe mode?
    safe: bool,
    /// Is a visitor here?
    visited: bool,
}

/// The state that is published to the broker.
fn state(seen: &WindowStatus, fleet: &FleetState) -> serde_json::Value {
    let FleetState { persisted, version, safe, visited } = *fleet;
    let (frame, load) = (seen.frame, &seen.frame.load);
    let is_open = |state: &DeviceState| matches!(state, DeviceState::Ok { .. });
    serde_json::json!({
        "exhibit": frame.exhibit.id,
        "content": version,
        "program": env!("CARGO_PKG_VERSION"),
        "open": seen.venue.is_open(),
        "blank": seen.venue.is_blank(),
        "visited": visited,
        "attracts": frame.attracts,
        "muted": load.loudness.muted,
        "night": load.loudness.night,
        "volume_db": load.loudness.volume_db,
        "microphone": is_open(&load.audio.input),
        "loudspeaker": is_open(&load.audio.output),
        "language": seen.language,
        "safe": safe,
        "starts": persisted.starts,
        "visits": persisted.counters.visits,
        "blows": persisted.counters.blows,
    })
}

/// Hash of the exhibit's sidecar as it is when the exhibit is shown.
fn version(exhibit: &Exhibit) -> String {
    let bytes = files::read_sidecar(&exhibit.folder).unwrap_or_default();
    format!("{:016x}", fnv1a(bytes.into_iter()))
}

/// FNV-1a hash, 64 bits (Fowler, Noll and Vo).
fn fnv1a(bytes: impl Iterator<Item = u8>) -> u64 {
    bytes.fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

//! One kiosk among many: what it counts, keeps over a restart, and tells whoever looks after it.
//!
//! Looks on from the window's side and changes nothing that a visitor sees; what a broker orders is handed to the window.

pub mod kept;
pub mod metrics;
pub(crate) mod mqtt;
pub mod visits;
#[cfg(target_os = "linux")]
pub(crate) mod watchdog;
pub(crate) mod writer;

use std::path::Path;
use std::sync::Arc;
use std::time::Instant;

use crate::fleet::kept::{Keeper, Kept, Life, SETTLED, Tally};
use crate::fleet::metrics::{Metrics, Numbers, text};
use crate::fleet::mqtt::{Mqtt, Order};
use crate::fleet::visits::{DWELL_S, FRAME_S, Histogram, Visits};
use crate::live::Frame;
use crate::venue::care::Care;
use crate::venue::house::House;
use crate::venue::loudness::Wishes;
use crate::visitor::given::Given;
use soffio_config::{Config, Day, TimeOfDay};
use soffio_devices::audio::DeviceState;
use soffio_exhibit::{Exhibit, SIDECAR};

/// For so long the daily chirp waits for a silent moment, minutes.
const CHIRP_WAITS_MIN: u16 = 60;

/// What staff are told of safe mode.
pub const SAFE_MODE: &str = "safe mode: the kiosk died three times within a minute of its start, so it shows one built-in \
                             work and hears no controllers. The log before says why it died; a restart tries again";

/// The window's part of what is known now.
pub struct Seen<'a> {
    /// The simulation's part.
    pub frame: &'a Frame,
    /// The configuration.
    pub site: &'a Config,
    /// The doors.
    pub house: &'a House,
    /// Breath of the day.
    pub given: &'a Given,
    /// Language on show.
    pub language: &'a str,
    /// Inputs so far.
    pub activity: u64,
    /// Wrong PINs in a row.
    pub wrong_pins: i32,
}

/// One kiosk among many.
pub struct Fleet {
    keeper: Keeper,
    kept: Kept,
    /// Counted by the runs before this one.
    before: Tally,
    visits: Visits,
    /// Times from picture to picture.
    frames: Histogram,
    metrics: Metrics,
    mqtt: Mqtt,
    began: Instant,
    safe: bool,
    /// Was what was read last, a configuration or a work, good?
    reloads: bool,
    /// Chirps that were taken in.
    chirps: u64,
    /// The day on which it chirped last.
    chirped: Option<Day>,
    /// The work on show, and a word that differs where its sidecar does.
    content: Option<(Arc<Exhibit>, String)>,
}

impl Fleet {
    /// Of a run that has begun, in safe mode or not.
    pub fn start(keeper: Keeper, kept: Kept, safe: bool, site: &Config) -> Self {
        Self {
            keeper,
            before: kept.tally.clone(),
            kept,
            visits: Visits::default(),
            frames: Histogram::default(),
            metrics: Metrics::start(site.staff.metrics.clone()),
            mqtt: Mqtt::start(&site.mqtt),
            began: Instant::now(),
            safe,
            reloads: true,
            chirps: 0,
            chirped: None,
            content: None,
        }
    }

    /// As the run before left it.
    pub fn kept(&self) -> &Kept {
        &self.kept
    }

    /// Is it in safe mode?
    pub fn is_safe(&self) -> bool {
        self.safe
    }

    /// What is asked of a new run's loudness, so that it is as staff left it.
    pub fn wishes(&self) -> Wishes {
        Wishes { mutes: self.kept.muted.into(), nights: self.kept.night_by.presses(), ..Wishes::default() }
    }

    /// Is somebody here?
    pub fn is_visited(&self) -> bool {
        self.visits.goes_on()
    }

    /// A picture came so many seconds after the one before.
    pub fn picture(&mut self, seconds: f64) {
        self.frames.note(FRAME_S, seconds);
    }

    /// A configuration or a work was read anew, and was good or not.
    pub fn read_anew(&mut self, good: bool, file: Option<&Path>) {
        self.reloads = good;
        if let Some(file) = file.filter(|_| good) {
            self.keeper.keep_good(file);
        }
    }

    /// The configuration has changed.
    pub fn settle(&mut self, before: &Config, site: &Config) {
        if before.staff.metrics != site.staff.metrics {
            self.metrics = Metrics::start(site.staff.metrics.clone());
        }
        if before.mqtt != site.mqtt {
            // The old line says farewell before the new one speaks in its name.
            self.mqtt = Mqtt::none();
            self.mqtt = Mqtt::start(&site.mqtt);
        }
    }

    /// Counts, keeps and tells. Call it often; it does little most of the time.
    pub fn tend(&mut self, now: Instant, seen: &Seen) {
        let lived = now.duration_since(self.began);
        let (frame, load) = (seen.frame, &seen.frame.load);
        let blows = frame.current.breath.estimate.speed > 0.0;
        let input = (seen.activity, blows);
        let tally = &mut self.kept.tally;
        if let Some(visit) = self.visits.note(lived.as_secs_f64(), input, seen.language, seen.site.attract.idle_s) {
            tally.visits += 1;
            tally.dwell.note(DWELL_S, visit.seconds);
            *tally.languages.entry(visit.language).or_default() += 1;
        }
        for (source, count) in load.blows.iter().filter(|(_, count)| *count > 0) {
            let name = source.to_string();
            let before = self.before.blows.get(&name).copied().unwrap_or_default();
            tally.blows.insert(name, before + count);
        }
        if lived >= SETTLED {
            self.kept.life = Life::Settled;
        }
        self.kept.on_show.clone_from(&frame.exhibit.id);
        // Before the first step nothing is known of what staff wished.
        if frame.current.step > 0 {
            (self.kept.muted, self.kept.night_by) = (load.loudness.muted, load.loudness.by);
        }
        self.kept.blank = seen.house.is_blank();
        self.kept.wrong_pins = seen.wrong_pins;
        if self.kept.given != *seen.given {
            self.kept.given = seen.given.clone();
        }
        if let (count, Some(outcome)) = &load.chirp
            && *count != self.chirps
        {
            self.chirps = *count;
            let when = jiff::Zoned::now().strftime("%Y-%m-%d %H:%M").to_string();
            match self.kept.care.note(outcome, when) {
                verdict if verdict.is_bad() => tracing::warn!("chirp: {verdict}"),
                verdict => tracing::info!("chirp: {verdict}"),
            }
        }
        self.keeper.tend(now, &self.kept);

        if self.content.as_ref().is_none_or(|(shown, _)| !Arc::ptr_eq(shown, &frame.exhibit)) {
            self.content = Some((frame.exhibit.clone(), version(&frame.exhibit)));
        }
        let version = self.content.as_ref().map_or("", |(_, version)| version);
        let numbers = Numbers {
            kept: &self.kept,
            frames: &self.frames,
            safe: self.safe,
            reloads: self.reloads,
            foam_lasts: seen.site.care.foam_blows,
            content: (&frame.exhibit.id, version),
        };
        self.metrics.tend(now, || text(frame, &numbers));
        let (kept, safe, visited) = (&self.kept, self.safe, self.visits.goes_on());
        self.mqtt.tend(now, || state(seen, kept, version, (safe, visited)));
    }

    /// Is the daily chirp due, on this day and the one before it, at this time? It waits until the house is closed or nobody
    /// is there, for an hour; then it is too late for this day.
    pub fn chirp_is_due(
        &mut self,
        at: Option<TimeOfDay>,
        [today, yesterday]: [Day; 2],
        time: TimeOfDay,
        open: bool,
    ) -> bool {
        let Some(late) = at.map(|at| time.since(at)).filter(|late| *late < CHIRP_WAITS_MIN) else { return false };
        // An hour that began before midnight belongs to the day before.
        let day = if late > time.since(TimeOfDay::from_minutes(0)) { yesterday } else { today };
        let is = self.chirped != Some(day) && !(open && self.visits.goes_on());
        if is {
            self.chirped = Some(day);
        }
        is
    }

    /// What is known of foam and chirps, for staff to change.
    pub fn care(&mut self) -> (&mut Care, u64) {
        let breaths = self.kept.tally.breaths();
        (&mut self.kept.care, breaths)
    }

    /// The next order of the broker.
    pub fn order(&self) -> Option<Order> {
        self.mqtt.order()
    }

    /// The run ends in order.
    pub fn end(&mut self) {
        self.keeper.end(self.kept.clone());
    }
}

/// What a broker is told.
fn state(seen: &Seen, kept: &Kept, version: &str, (safe, visited): (bool, bool)) -> serde_json::Value {
    let (frame, load) = (seen.frame, &seen.frame.load);
    let works = |state: &DeviceState| matches!(state, DeviceState::Ok { .. });
    serde_json::json!({
        "exhibit": frame.exhibit.id,
        "content": version,
        "program": env!("CARGO_PKG_VERSION"),
        "open": seen.house.is_open(),
        "blank": seen.house.is_blank(),
        "visited": visited,
        "attracts": frame.attracts,
        "muted": load.loudness.muted,
        "night": load.loudness.night,
        "volume_db": load.loudness.volume_db,
        "microphone": works(&load.audio.input),
        "loudspeaker": works(&load.audio.output),
        "language": seen.language,
        "safe": safe,
        "starts": kept.starts,
        "visits": kept.tally.visits,
        "blows": kept.tally.blows,
    })
}

/// A word that differs where a work's sidecar does: 64 bits of FNV-1a over the file as it is when the work comes on.
fn version(exhibit: &Exhibit) -> String {
    let bytes = std::fs::read(exhibit.folder.join(SIDECAR)).unwrap_or_default();
    let hash = bytes
        .iter()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(*byte)).wrapping_mul(0x0100_0000_01b3));
    format!("{hash:016x}")
}

//! Exhibits that are set aside because the kiosk crashed while they were loaded or shown.
//!
//! A file may kill the kiosk in a way that no check foresees: by a fault of a driver, or by all the memory of the machine. The persisted
//! state knows the exhibit on show, and a small file beside it names the one that is being loaded. So a crash counts for that exhibit.
//! After `LIMITS` it is set aside for a day, or until its files change, and the other exhibits go on.
//!
//! A power cut looks like a crash. The limits allow a museum to switch its kiosks off at the mains.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

/// Seconds of a day and of an hour.
const DAY_S: i64 = 24 * HOUR_S;
const HOUR_S: i64 = 3600;
/// Crashes, and the time within which so many set an exhibit aside, s: one may be chance, three in an hour are the exhibit. A slower fault
/// shows in a day.
const LIMITS: [(usize, i64); 2] = [(3, HOUR_S), (6, DAY_S)];
/// File that names the exhibit that is being loaded.
const LOADING: &str = "loading";

/// Crashes of each exhibit, and those that are set aside. Times are seconds since 1970.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(default)]
pub struct Quarantine {
    /// Times of the crashes of the last day, by the id of the exhibit.
    crashes: BTreeMap<String, Vec<i64>>,
    /// Time from which an exhibit is set aside, by its id.
    since: BTreeMap<String, i64>,
}

impl Quarantine {
    /// Counts a crash while the exhibit `id` was loaded or shown. Returns whether it is set aside from now on.
    pub fn record(&mut self, id: &str, now: i64) -> bool {
        self.expire(now);
        let crashes = self.crashes.entry(id.to_owned()).or_default();
        crashes.push(now);
        let within = |seconds: i64| crashes.iter().filter(|&&at| now - at <= seconds).count();
        let is_fault = LIMITS.iter().any(|&(most, seconds)| within(seconds) >= most);
        is_fault && self.since.insert(id.to_owned(), now).is_none()
    }

    /// Ids of the exhibits that are set aside.
    pub fn set_aside(&self) -> impl Iterator<Item = &str> {
        self.since.keys().map(String::as_str)
    }

    /// Is this exhibit set aside?
    pub fn contains(&self, id: &str) -> bool {
        self.since.contains_key(id)
    }

    /// Offers an exhibit again, since its files have changed; returns whether it was set aside.
    pub fn release(&mut self, id: &str) -> bool {
        self.crashes.remove(id);
        self.since.remove(id).is_some()
    }

    /// Drops what is older than a day. A clock that was set back by more makes times of the future, which are dropped too.
    pub fn expire(&mut self, now: i64) {
        let recent = |at: i64| (now - at).abs() <= DAY_S;
        self.since.retain(|_, at| recent(*at));
        self.crashes.retain(|_, times| {
            times.retain(|at| recent(*at));
            !times.is_empty()
        });
    }
}

/// Names the exhibit that is being loaded, in a file of the state folder, so that a crash of its loading is known. Without a folder, or on
/// a full disk, a crash counts for the exhibit on show.
#[derive(Clone, Debug, Default)]
pub struct LoadMarker(Option<PathBuf>);

impl LoadMarker {
    /// A marker in this state folder.
    pub fn new(folder: Option<&Path>) -> Self {
        Self(folder.map(|folder| folder.join(LOADING)))
    }

    /// Marks the exhibit while `load` runs.
    pub fn during<T>(&self, id: &str, load: impl FnOnce() -> T) -> T {
        if let Some(Err(error)) = self.0.as_ref().map(|file| std::fs::write(file, id)) {
            tracing::debug!("the loading of {id} is not marked: {error}");
        }
        let loaded = load();
        self.clear();
        loaded
    }

    /// The exhibit that was being loaded when the run before this one crashed; it is forgotten.
    pub fn take(&self) -> Option<String> {
        let id = std::fs::read_to_string(self.0.as_ref()?).ok().filter(|id| !id.is_empty());
        self.clear();
        id
    }

    fn clear(&self) {
        // It may not exist.
        self.0.as_ref().map(std::fs::remove_file);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A day in 2026.
    const NOON: i64 = 1_780_000_000;

    #[test]
    fn three_crashes_in_an_hour_or_six_in_a_day_set_an_exhibit_aside_and_no_other() {
        let mut quarantine = Quarantine::default();
        assert!(
            !quarantine.record("a", NOON) && !quarantine.record("a", NOON + 60) && !quarantine.record("b", NOON + 61)
        );
        assert!(quarantine.record("a", NOON + HOUR_S), "the third in an hour");
        assert!(quarantine.contains("a") && !quarantine.contains("b"));
        assert!(!quarantine.record("a", NOON + HOUR_S + 1), "it is set aside once");
        let slow: Vec<bool> = (1..=6).map(|k| quarantine.record("b", NOON + k * 3 * HOUR_S)).collect();
        assert_eq!(slow, [false, false, false, false, true, false], "the sixth in a day");
    }

    #[test]
    fn a_kiosk_that_is_switched_off_at_the_mains_twice_a_day_loses_no_exhibit() {
        let mut quarantine = Quarantine::default();
        for day in 0..100 {
            let morning = NOON + day * DAY_S;
            assert!(!quarantine.record("a", morning) && !quarantine.record("a", morning + 8 * HOUR_S));
        }
    }

    #[test]
    fn it_is_offered_again_after_a_day_after_a_change_and_when_the_clock_was_wrong() {
        let aside = || {
            let mut quarantine = Quarantine::default();
            (0..3).for_each(|k| {
                quarantine.record("a", NOON + k);
            });
            assert_eq!(quarantine.set_aside().collect::<Vec<_>>(), ["a"]);
            quarantine
        };
        let mut later = aside();
        later.expire(NOON + 2 + DAY_S);
        assert!(later.contains("a"));
        later.expire(NOON + 3 + DAY_S);
        assert_eq!(later, Quarantine::default());
        let mut changed = aside();
        assert!(changed.release("a") && !changed.release("a") && changed == Quarantine::default());
        let mut reset = aside();
        reset.expire(0);
        assert_eq!(reset, Quarantine::default(), "a clock without a battery");
    }

    #[test]
    fn the_marker_names_the_exhibit_whose_loading_did_not_end() {
        let folder = tempfile::tempdir().expect("a folder");
        let marker = LoadMarker::new(Some(folder.path()));
        assert_eq!(marker.take(), None);
        assert_eq!(marker.during("good", || 5), 5);
        assert_eq!(marker.take(), None, "its loading has ended");
        let crashed = std::panic::catch_unwind(|| marker.during("bad", || panic!("a crash")));
        assert!(crashed.is_err());
        assert_eq!((marker.take(), marker.take()), (Some("bad".into()), None));
        assert_eq!(LoadMarker::default().during("anything", || 5), 5, "without a folder");
    }
}

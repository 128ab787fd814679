//! A rehearsed day with the detector alone: no exhibit, no loudspeaker, no pictures.
//!
//! In a few minutes it measures detected and missed breaths, their latency, and false triggers. So two tables, or two rooms, can be
//! compared before a whole day is spent on them. Segments of the day run in parallel, each after a minute of lead-in; the result of a
//! segment does not depend on their number.

use std::collections::BTreeMap;
use std::fmt;

use serde::Serialize;

use super::blocks::{FRAMES, SAMPLE_RATE_HZ};
use super::day::{Day, Entry};
use super::rehearsal::{Rehearsal, RehearsalError, open_venue};
use super::run::{AFTERMATH_S, EARLY_S};
use super::venue::{PIECE_S, Venue};
use soffio_detector::{BlowDetector, BlowSettings};
use soffio_soundscape::parallel::parallel;
use soffio_soundscape::statistics::quantile;

/// Length of a segment, pieces of the crowd.
const SEGMENT: u64 = 10;
/// Length of the lead-in before a segment, pieces of the crowd.
const LEAD_IN: u64 = 1;
/// Length of a sound card's block, s.
const BLOCK_S: f64 = FRAMES as f64 / SAMPLE_RATE_HZ as f64;
/// Latency with which a breath still changes the exhibit in time, s.
pub const IN_TIME_S: f64 = 0.25;
/// Latency from which a breath counts as missed, s.
const LATEST_S: f64 = 1.0;

/// First breath of a visit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FirstBreath {
    /// Onset, s of the day.
    pub onset_s: f64,
    /// Time from onset to detection, s; null where it is missed for a second.
    pub detected_after_s: Option<f64>,
    /// Groups of the visitor.
    pub groups: Vec<&'static str>,
}

/// Counts of first breaths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Count {
    /// All first breaths.
    pub breaths: usize,
    /// Detected within [`IN_TIME_S`].
    pub in_time: usize,
    /// Missed for a second.
    pub missed: usize,
}

/// Result of a day with the detector alone.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DetectorReport {
    /// Counts of all visits.
    pub all: Count,
    /// Counts of each group.
    pub groups: BTreeMap<&'static str, Count>,
    /// Median and ninth decile of the time to detection, s; null where no breath is detected.
    pub detected_after_s: Option<(f64, f64)>,
    /// Times of wind without breath, s of the day.
    pub false_triggers_s: Vec<f64>,
    /// Every first breath.
    pub breaths: Vec<FirstBreath>,
}

/// Runs a detector over a day.
///
/// # Errors
/// There is no such room.
pub fn run_detector(mut rehearsal: Rehearsal, settings: &BlowSettings) -> Result<DetectorReport, RehearsalError> {
    let length = 3600.0 * rehearsal.hours;
    let day = Day::new(rehearsal.seed, length, rehearsal.exhibits.len(), rehearsal.site.idle_s);
    let venue = open_venue(&mut rehearsal)?;
    let segments = (length / (SEGMENT as f64 * PIECE_S)).ceil() as u64;
    let results = parallel((0..segments).collect(), |segment| {
        let from = segment * SEGMENT;
        let until = ((segment + 1) as f64 * SEGMENT as f64 * PIECE_S).min(length);
        let mut segment = Segment::new(&day, venue.at(from.saturating_sub(LEAD_IN)), from as f64 * PIECE_S, until);
        segment.run(BlowDetector::with_settings(SAMPLE_RATE_HZ, settings.clone()));
        (segment.breaths, segment.false_triggers_s)
    });
    let (breaths, false_triggers_s): (Vec<_>, Vec<_>) = results.into_iter().unzip();
    Ok(DetectorReport::of(breaths.concat(), false_triggers_s.concat()))
}

/// A segment of the day, and its results.
struct Segment<'a> {
    entries: Vec<&'a Entry>,
    venue: Venue,
    from: f64,
    until: f64,
    breaths: Vec<FirstBreath>,
    false_triggers_s: Vec<f64>,
}

impl<'a> Segment<'a> {
    fn new(day: &'a Day, mut venue: Venue, from: f64, until: f64) -> Self {
        let near = |entry: &&Entry| entry.visit.leaves > venue.now() && entry.visit.arrives < until;
        let entries: Vec<&Entry> = day.entries.iter().filter(near).collect();
        let (capsules, spacing) = (venue.capsules(), venue.scenario().spacing());
        for entry in &entries {
            for (at, sound) in entry.visit.noises(venue.scenario(), capsules) {
                venue.put(at, sound);
            }
            for breath in &entry.visit.breaths {
                venue.put_breath(breath.lips(), breath.sound(capsules, spacing));
            }
        }
        Self { entries, venue, from, until, breaths: Vec::new(), false_triggers_s: Vec::new() }
    }

    fn run(&mut self, mut detector: BlowDetector) {
        let begins_here = |entry: &&&Entry| entry.visit.arrives >= self.from;
        let first = |entry: &&Entry| {
            let breath = entry.visit.breaths.first().filter(|_| entry.expects_response())?;
            Some(FirstBreath { onset_s: breath.onset, detected_after_s: None, groups: entry.visit.groups() })
        };
        self.breaths = self.entries.iter().filter(begins_here).filter_map(first).collect();
        let last = self.breaths.last().map_or(self.until, |breath| breath.onset_s + LATEST_S).max(self.until);
        let silence = [0.0; 2 * FRAMES];
        let mut blew = false;
        while self.venue.now() < last {
            let frames = self.venue.next_block(&silence);
            let channel = |first: usize| -> Vec<f32> {
                frames.iter().skip(first).step_by(self.venue.capsules()).copied().collect()
            };
            match self.venue.capsules() {
                1 => detector.push(&frames, &[]),
                _ => detector.push_stereo(&channel(0), &channel(1), &[]),
            }
            let blows = detector.estimate().speed > 0.0;
            self.record(self.venue.now(), blows, blows && !blew);
            blew = blows;
        }
    }

    /// Records wind, and its beginning, in the block that ends now.
    fn record(&mut self, now: f64, blows: bool, began: bool) {
        let due = |breath: &&mut FirstBreath| {
            breath.detected_after_s.is_none() && (0.0..LATEST_S).contains(&(now - breath.onset_s))
        };
        if blows {
            self.breaths.iter_mut().filter(due).for_each(|breath| breath.detected_after_s = Some(now - breath.onset_s));
        }
        let began_at = now - BLOCK_S;
        let mut breaths = self.entries.iter().flat_map(|entry| &entry.visit.breaths);
        let is_response = breaths.any(|b| b.lips() < began_at + EARLY_S && began_at < b.end() + AFTERMATH_S);
        if began && !is_response && (self.from..self.until).contains(&began_at) {
            self.false_triggers_s.push(began_at);
        }
    }
}

impl DetectorReport {
    fn of(breaths: Vec<FirstBreath>, false_triggers_s: Vec<f64>) -> Self {
        let (mut all, mut groups) = (Count::default(), BTreeMap::<_, Count>::new());
        for breath in &breaths {
            all.add(breath);
            breath.groups.iter().for_each(|group| groups.entry(*group).or_default().add(breath));
        }
        let after: Vec<f64> = breaths.iter().filter_map(|breath| breath.detected_after_s).collect();
        let detected_after_s = (!after.is_empty()).then(|| (quantile(&after, 0.5), quantile(&after, 0.9)));
        Self { all, groups, detected_after_s, false_triggers_s, breaths }
    }
}

impl Count {
    fn add(&mut self, breath: &FirstBreath) {
        self.breaths += 1;
        self.in_time += usize::from(breath.detected_after_s.is_some_and(|after| after < IN_TIME_S));
        self.missed += usize::from(breath.detected_after_s.is_none());
    }
}

impl fmt::Display for DetectorReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let in_time = format!("in {IN_TIME_S} s");
        writeln!(f, "{:28} {:>8} {in_time:>12} {:>8}", "first breaths", "all", "missed")?;
        for (name, count) in std::iter::once((&"all", &self.all)).chain(&self.groups) {
            writeln!(f, "  {name:26} {:8} {:12} {:8}", count.breaths, count.in_time, count.missed)?;
        }
        if let Some((median, ninth_decile)) = self.detected_after_s {
            writeln!(f, "half are detected within {median:.3} s, nine of ten within {ninth_decile:.3} s")?;
        }
        let at: Vec<String> = self.false_triggers_s.iter().map(|at| format!("{at:.1}")).collect();
        writeln!(f, "false triggers: {}, at [{}] s", at.len(), at.join(", "))
    }
}

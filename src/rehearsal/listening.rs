//! The day for the ear alone: no work hangs there, nothing is played, no picture is drawn.
//!
//! It tells in a few minutes which breaths of a day an ear hears, how soon, and what it takes for breath that is none; so two
//! tables, or two rooms, are compared before a whole day is spent on them. Parts of the day are listened to side by side, each
//! by an ear that has heard the house for a minute; what is heard of a part does not depend on how many are.

use std::collections::BTreeMap;
use std::fmt;

use serde::Serialize;

use super::blocks::{FRAMES, SAMPLE_RATE_HZ};
use super::day::{Day, Entry};
use super::house::{House, PIECE_S};
use super::rehearsal::{Rehearsal, RehearsalError, open_house};
use super::run::{AFTERMATH_S, EARLY_S};
use soffio_detector::{BlowDetector, BlowSettings};
use soffio_soundscape::parallel::parallel;
use soffio_soundscape::statistics::quantile;

/// Length of a part, and of what an ear hears before it, pieces of the crowd.
const PART: u64 = 10;
const BEFORE: u64 = 1;
/// Length of a sound card's block, s.
const BLOCK_S: f64 = FRAMES as f64 / SAMPLE_RATE_HZ as f64;
/// Whoever is heard so soon sees the work change in time, s.
pub const IN_TIME_S: f64 = 0.25;
/// Whoever is not heard by then is not heard, s.
const LATEST_S: f64 = 1.0;

/// The first breath of a visit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FirstBreath {
    /// s of the day.
    pub onset_s: f64,
    /// Until it is heard, s; null where it is not within a second.
    pub heard_after_s: Option<f64>,
    /// What the visitor belongs to.
    pub groups: Vec<&'static str>,
}

/// How many breaths of how many are heard in [`IN_TIME_S`], and how many not at all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Count {
    /// First breaths.
    pub breaths: usize,
    /// Heard in time.
    pub in_time: usize,
    /// Not heard within a second.
    pub unheard: usize,
}

/// What an ear has heard of a day.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Listened {
    /// Of all visits.
    pub all: Count,
    /// Of each group.
    pub groups: BTreeMap<&'static str, Count>,
    /// Until half of those that are heard are, and nine of ten, s; null where none is.
    pub heard_after_s: Option<(f64, f64)>,
    /// When there was wind without breath, s of the day.
    pub nobody_s: Vec<f64>,
    /// Every first breath.
    pub breaths: Vec<FirstBreath>,
}

/// Lets an ear listen to a day.
pub fn listen(mut rehearsal: Rehearsal, ear: &BlowSettings) -> Result<Listened, RehearsalError> {
    let length = 3600.0 * rehearsal.hours;
    let day = Day::new(rehearsal.seed, length, rehearsal.works.len(), rehearsal.site.idle_s);
    let house = open_house(&mut rehearsal)?;
    let parts = (length / (PART as f64 * PIECE_S)).ceil() as u64;
    let heard = parallel((0..parts).collect(), |part| {
        let (from, until) = (part * PART, ((part + 1) as f64 * PART as f64 * PIECE_S).min(length));
        let mut listener = Part::new(&day, house.at(from.saturating_sub(BEFORE)), from as f64 * PIECE_S, until);
        listener.listen(BlowDetector::with_settings(SAMPLE_RATE_HZ, ear.clone()));
        (listener.breaths, listener.nobody_s)
    });
    let (breaths, nobody): (Vec<_>, Vec<_>) = heard.into_iter().unzip();
    Ok(Listened::of(breaths.concat(), nobody.concat()))
}

/// A part of the day, and what has been heard of it.
struct Part<'a> {
    entries: Vec<&'a Entry>,
    house: House,
    from: f64,
    until: f64,
    breaths: Vec<FirstBreath>,
    nobody_s: Vec<f64>,
}

impl<'a> Part<'a> {
    fn new(day: &'a Day, mut house: House, from: f64, until: f64) -> Self {
        let near = |entry: &&Entry| entry.visit.leaves > house.now() && entry.visit.arrives < until;
        let entries: Vec<&Entry> = day.entries.iter().filter(near).collect();
        let (capsules, apart) = (house.capsules(), house.world().apart());
        for entry in &entries {
            for (at, sound) in entry.visit.noises(house.world(), capsules) {
                house.put(at, sound);
            }
            for breath in &entry.visit.breaths {
                house.put_breath(breath.onset, breath.sound(capsules, apart));
            }
        }
        Self { entries, house, from, until, breaths: Vec::new(), nobody_s: Vec::new() }
    }

    fn listen(&mut self, mut ear: BlowDetector) {
        let begins_here = |entry: &&&Entry| entry.visit.arrives >= self.from;
        let first = |entry: &&Entry| {
            let breath = entry.visit.breaths.first().filter(|_| entry.answered())?;
            Some(FirstBreath { onset_s: breath.onset, heard_after_s: None, groups: entry.visit.groups() })
        };
        self.breaths = self.entries.iter().filter(begins_here).filter_map(first).collect();
        let last = self.breaths.last().map_or(self.until, |breath| breath.onset_s + LATEST_S).max(self.until);
        let silence = [0.0; 2 * FRAMES];
        let mut blew = false;
        while self.house.now() < last {
            let heard = self.house.hear(&silence);
            let channel = |first: usize| -> Vec<f32> {
                heard.iter().skip(first).step_by(self.house.capsules()).copied().collect()
            };
            match self.house.capsules() {
                1 => ear.push(&heard, &[]),
                _ => ear.push_stereo(&channel(0), &channel(1), &[]),
            }
            let blows = ear.estimate().speed > 0.0;
            self.note(self.house.now(), blows, blows && !blew);
            blew = blows;
        }
    }

    /// Notes that there is wind, and that it has begun, in the block that ends now.
    fn note(&mut self, now: f64, blows: bool, began: bool) {
        let due = |breath: &&mut FirstBreath| {
            breath.heard_after_s.is_none() && (0.0..LATEST_S).contains(&(now - breath.onset_s))
        };
        if blows {
            self.breaths.iter_mut().filter(due).for_each(|breath| breath.heard_after_s = Some(now - breath.onset_s));
        }
        let began_at = now - BLOCK_S;
        let mut breaths = self.entries.iter().flat_map(|entry| &entry.visit.breaths);
        let answers = breaths.any(|b| b.onset < began_at + EARLY_S && began_at < b.end() + AFTERMATH_S);
        if began && !answers && (self.from..self.until).contains(&began_at) {
            self.nobody_s.push(began_at);
        }
    }
}

impl Listened {
    fn of(breaths: Vec<FirstBreath>, nobody_s: Vec<f64>) -> Self {
        let (mut all, mut groups) = (Count::default(), BTreeMap::<_, Count>::new());
        for breath in &breaths {
            all.add(breath);
            breath.groups.iter().for_each(|group| groups.entry(*group).or_default().add(breath));
        }
        let after: Vec<f64> = breaths.iter().filter_map(|breath| breath.heard_after_s).collect();
        let heard_after_s = (!after.is_empty()).then(|| (quantile(&after, 0.5), quantile(&after, 0.9)));
        Self { all, groups, heard_after_s, nobody_s, breaths }
    }
}

impl Count {
    fn add(&mut self, breath: &FirstBreath) {
        self.breaths += 1;
        self.in_time += usize::from(breath.heard_after_s.is_some_and(|after| after < IN_TIME_S));
        self.unheard += usize::from(breath.heard_after_s.is_none());
    }
}

impl fmt::Display for Listened {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let in_time = format!("in {IN_TIME_S} s");
        writeln!(f, "{:28} {:>8} {in_time:>12} {:>8}", "first breaths", "of all", "unheard")?;
        for (name, count) in std::iter::once((&"all", &self.all)).chain(&self.groups) {
            writeln!(f, "  {name:26} {:8} {:12} {:8}", count.breaths, count.in_time, count.unheard)?;
        }
        if let Some((half, most)) = self.heard_after_s {
            writeln!(f, "half are heard within {half:.3} s, nine of ten within {most:.3} s")?;
        }
        let at: Vec<String> = self.nobody_s.iter().map(|at| format!("{at:.1}")).collect();
        writeln!(f, "wind without breath: {} times, at [{}] s", at.len(), at.join(", "))
    }
}

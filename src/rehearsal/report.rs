//! What a rehearsal has found: numbers for machines, a table for people, and whether the bars are met.

use std::collections::BTreeMap;
use std::fmt;

use serde::Serialize;

use super::judge::{FPS, SOON, median};
use super::standing::Above;
use soffio_soundscape::statistics::wilson;

/// Share of all visits that must be answered.
pub const HEADLINE: f64 = 0.95;
/// Of each group's.
pub const GROUP: f64 = 0.85;
/// A group of fewer visits says too little: one visit weighs more than five in a hundred.
pub const ENOUGH: usize = 20;
/// The shuffled contingency is about 1: so far from it at most.
pub const SHUFFLED: (f64, f64) = (0.7, 1.4);

/// One judged visit.
#[derive(Clone, Debug, Serialize)]
pub struct Judged {
    /// Onset of what the visitor does, s of the day.
    pub onset_s: f64,
    /// Since anybody last did something, s; null for the first.
    pub since_s: Option<f64>,
    /// Work on show.
    pub work: String,
    /// From the onset to the first wind inside the kiosk, s; null where there is none within a second. Told, not judged: it says
    /// whether a visit that was not answered was not heard, or not seen.
    pub heard_after_s: Option<f64>,
    /// How far its first 0.3 s stood above the house at the microphone, in rumble (31–203 Hz), in hiss (406–3400 Hz) and in the
    /// rumble that differs between two capsules, dB; null where nobody blew. Told, not judged: what lies far below in all of
    /// them, nobody can hear.
    pub above_db: Option<Above>,
    /// What the ear said in that second, and in how many steps of 240 a second, the most frequent first. Told, not judged.
    pub ear: Vec<(String, u32)>,
    /// From the onset to the first picture that is visibly another one than had nobody come, s; null where there is none
    /// within 0.3 s.
    pub changed_after_s: Option<f64>,
    /// From the onset to the change that stands out from what moves anyhow, s. Told, not judged.
    pub seen_after_s: Option<f64>,
    /// Motion energy of the second before and of the second after; full scale 1.
    pub energy: Option<[f64; 2]>,
    /// The one over the other.
    pub contingency: Option<f64>,
    /// Answers to nobody in the ten seconds before.
    pub phantoms: usize,
    /// How often somebody blew: whoever sees nothing move tries again.
    pub breaths: usize,
    /// Was the first thing the visitor did answered as it should be?
    pub at_once: bool,
    /// Was one of them?
    pub good: bool,
    /// Why not the first.
    pub missed: Option<&'static str>,
    /// What the visitor belongs to.
    pub groups: Vec<&'static str>,
}

impl Judged {
    /// The first thing that went wrong on the way from breath to picture.
    pub(super) fn miss(&self) -> Option<&'static str> {
        Some(match (self.contingency, self.heard_after_s, self.changed_after_s) {
            _ if self.at_once => return None,
            (None, ..) => "another work came",
            _ if self.phantoms > 0 => "answered nobody before",
            (_, None, _) => "not heard",
            (_, Some(after), None) if after > SOON as f64 / FPS as f64 => "heard too late",
            (_, _, None) => "not changed soon",
            _ => "moved too much before",
        })
    }
}

/// An answer to nobody.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Nobody {
    /// When, s of the day.
    pub at_s: f64,
    /// Since anybody last did something, s; null before the first.
    pub since_s: Option<f64>,
    /// Was there wind inside the kiosk, or did only its loudspeaker rush?
    pub blew: bool,
}

/// A share of visits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Share {
    /// Visits.
    pub visits: usize,
    /// Answered as they should be.
    pub good: usize,
    /// The share; null of none.
    pub share: Option<f64>,
    /// Its 95 % bounds (Wilson).
    pub bounds: (f64, f64),
}

impl Share {
    /// Of these visits, those of which something holds.
    fn of<'a>(judged: impl Iterator<Item = &'a Judged>, holds: impl Fn(&Judged) -> bool) -> Self {
        let (visits, good) = judged.fold((0, 0), |(all, good), one| (all + 1, good + usize::from(holds(one))));
        let share = (visits > 0).then(|| good as f64 / visits as f64);
        Self { visits, good, share, bounds: wilson(good, visits) }
    }
}

/// How staff's doing went.
#[derive(Clone, Debug, Serialize)]
pub struct StaffCheck {
    /// mute, clean or unplug.
    pub task: &'static str,
    /// s of the day.
    pub from_s: f64,
    /// Was it silent (mute), without any wind (clean, unplug), meanwhile?
    pub good: bool,
}

/// A bar that the day is held against.
#[derive(Clone, Debug, Serialize)]
pub struct Bar {
    /// Its name.
    pub bar: &'static str,
    /// What is asked, in words.
    pub asked: String,
    /// What was found, in words.
    pub found: String,
    /// Is it met? Null where the day has too few visits to say.
    pub met: Option<bool>,
}

/// The report. It has 25 fields, because it is the command's output, field by field.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Of the day.
    pub seed: u64,
    /// Length, h.
    pub hours: f64,
    /// Where.
    pub room: String,
    /// Capsules of the microphone.
    pub capsules: usize,
    /// Works on show, in turn.
    pub works: Vec<String>,
    /// Volume, dB: as loud as visitors can make it.
    pub volume_db: f64,
    /// All who came.
    pub visitors: usize,
    /// A blow, or a hold, visibly changes the work within 0.3 s, with at least three times as much motion in the second after as
    /// in the second before, and no answer to nobody in the ten seconds before.
    pub headline: Share,
    /// The same for each group.
    pub groups: BTreeMap<&'static str, Share>,
    /// The first blow, or hold, does.
    pub at_once: Share,
    /// The same for each group.
    pub groups_at_once: BTreeMap<&'static str, Share>,
    /// Why the first blow, or hold, was not answered as it should be, and in how many visits.
    pub missed: BTreeMap<&'static str, usize>,
    /// Of all visits, those that visibly changed the work within 0.3 s, however much it moved before. Told, not judged.
    pub changed: Share,
    /// Of all visits, those whose change stood out within 0.3 s from what moves anyhow. Told, not judged.
    pub seen: Share,
    /// Median contingency of the visits.
    pub contingency: Option<f64>,
    /// The same at moments of no meaning, and the share of them that look answered.
    pub shuffled_contingency: Option<f64>,
    /// Share of moments of no meaning that look answered.
    pub shuffled_share: Option<f64>,
    /// From the onset to the change, s: median and the slowest of 20.
    pub changed_after_s: Option<(f64, f64)>,
    /// Answers to nobody.
    pub phantoms: Vec<Nobody>,
    /// Staff.
    pub staff: Vec<StaffCheck>,
    /// Times that attract mode came back after somebody had walked away, of how many.
    pub attract_returned: (usize, usize),
    /// Pictures drawn.
    pub pictures: u64,
    /// What is asked, and what was found.
    pub bars: Vec<Bar>,
    /// What misses its bar, in words; empty when all is well.
    pub failures: Vec<String>,
    /// Every visit.
    pub visits: Vec<Judged>,
}

impl Report {
    /// Sums up and holds it against the bars. `shuffled` are contingencies at moments of no meaning and whether they look
    /// answered.
    pub(super) fn conclude(mut self, shuffled: &[(f64, bool)]) -> Self {
        self.headline = Share::of(self.visits.iter(), |visit| visit.good);
        self.at_once = Share::of(self.visits.iter(), |visit| visit.at_once);
        self.changed = Share::of(self.visits.iter(), |visit| visit.changed_after_s.is_some());
        self.seen = Share::of(self.visits.iter(), |visit| visit.seen_after_s.is_some());
        for missed in self.visits.iter().filter_map(|visit| visit.missed) {
            *self.missed.entry(missed).or_default() += 1;
        }
        let mut names: Vec<&str> = self.visits.iter().flat_map(|visit| visit.groups.iter().copied()).collect();
        names.sort_unstable();
        names.dedup();
        for name in names {
            let members = || self.visits.iter().filter(|visit| visit.groups.contains(&name));
            self.groups.insert(name, Share::of(members(), |visit| visit.good));
            self.groups_at_once.insert(name, Share::of(members(), |visit| visit.at_once));
        }
        self.contingency = median(self.visits.iter().filter_map(|visit| visit.contingency).collect());
        self.shuffled_contingency = median(shuffled.iter().map(|(contingency, _)| *contingency).collect());
        let alike = shuffled.iter().filter(|(_, answered)| *answered).count();
        self.shuffled_share = (!shuffled.is_empty()).then(|| alike as f64 / shuffled.len() as f64);
        let mut changed: Vec<f64> = self.visits.iter().filter_map(|visit| visit.changed_after_s).collect();
        changed.sort_by(f64::total_cmp);
        self.changed_after_s =
            median(changed.clone()).map(|middle| (middle, changed[(19 * changed.len() / 20).min(changed.len() - 1)]));
        self.bars = self.hold();
        let missed = self.bars.iter().filter(|bar| bar.met == Some(false));
        self.failures =
            missed.map(|Bar { bar, asked, found, .. }| format!("{bar}: asked {asked}, found {found}")).collect();
        self
    }

    /// Every bar beside what was found.
    fn hold(&self) -> Vec<Bar> {
        let percent = |share: f64| format!("{:.1} %", 100.0 * share);
        let enough = |visits: usize| visits >= ENOUGH;
        let visits = self.headline.visits;
        let [all, first] = [self.headline, self.at_once].map(|share| share.share.unwrap_or_default());
        let groups = || self.groups.iter().filter(|(_, group)| enough(group.visits));
        let below = groups().filter_map(|(name, group)| Some((name, group.share.filter(|share| *share < GROUP)?)));
        let below: Vec<String> = below.map(|(name, share)| format!("{name} {}", percent(share))).collect();
        let shuffled = self.shuffled_contingency;
        let times: Vec<f64> = self.phantoms.iter().map(|nobody| nobody.at_s).collect();
        let broken: Vec<String> =
            self.staff.iter().filter(|c| !c.good).map(|c| format!("{} at {:.1} s", c.task, c.from_s)).collect();
        let (returned, asked) = self.attract_returned;
        let bar = |bar, asked: String, found: String, met: Option<bool>| Bar { bar, asked, found, met };
        vec![
            bar(
                "answered",
                format!("{} of all visits", percent(HEADLINE)),
                format!("{} of {visits}", percent(all)),
                enough(visits).then_some(all >= HEADLINE),
            ),
            bar(
                "first",
                format!("{} of all visits by the first blow", percent(HEADLINE)),
                format!("{} of {visits}", percent(first)),
                enough(visits).then_some(first >= HEADLINE),
            ),
            bar(
                "groups",
                format!("{} of every group", percent(GROUP)),
                format!("{} of {} below: {}", below.len(), groups().count(), below.join(", ")),
                (groups().count() > 0).then_some(below.is_empty()),
            ),
            bar(
                "shuffled",
                format!("contingency {} to {} at moments of no meaning", SHUFFLED.0, SHUFFLED.1),
                shuffled.map_or("none".into(), |found| format!("{found:.2}")),
                shuffled.filter(|_| enough(visits)).map(|found| (SHUFFLED.0..SHUFFLED.1).contains(&found)),
            ),
            bar(
                "nobody",
                "no answer to nobody".into(),
                format!("{}, at {times:.1?} s", times.len()),
                Some(times.is_empty()),
            ),
            bar(
                "staff",
                "silent while mute, still while deaf".into(),
                format!("{} of {} not: {}", broken.len(), self.staff.len(), broken.join(", ")),
                Some(broken.is_empty()),
            ),
            bar(
                "attract",
                "attract mode comes back".into(),
                format!("{returned} times of {asked}"),
                Some(returned >= asked),
            ),
        ]
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |share: Option<f64>| share.map_or("    -".to_owned(), |share| format!("{:5.1}", 100.0 * share));
        let row = |f: &mut fmt::Formatter<'_>, name: &str, share: &Share, at_once: Option<&Share>| {
            let (low, high) = share.bounds;
            let at_once = at_once.map_or(String::new(), |first| format!("   {} %", percent(first.share)));
            writeln!(
                f,
                "{name:28} {:6} {:6}   {} %   {:3.0} to {:3.0} %      {at_once}",
                share.visits,
                share.good,
                percent(share.share),
                100.0 * low,
                100.0 * high
            )
        };
        writeln!(
            f,
            "{} h in the {}, a microphone of {}, seed {}, {} visitors, volume {:.1} dB, works: {}\n",
            self.hours,
            self.room,
            if self.capsules > 1 { "two capsules" } else { "one capsule" },
            self.seed,
            self.visitors,
            self.volume_db,
            self.works.join(", ")
        )?;
        writeln!(f, "{:28} {:>6} {:>6}   answered  with 95 % of certainty  by the first blow", "", "visits", "good")?;
        row(f, "all visits", &self.headline, Some(&self.at_once))?;
        for (name, share) in &self.groups {
            row(f, name, share, self.groups_at_once.get(name))?;
        }
        let number = |x: Option<f64>| x.map_or("-".to_owned(), |x| format!("{x:.2}"));
        writeln!(f, "\ncontingency {}, shuffled {}", number(self.contingency), number(self.shuffled_contingency))?;
        writeln!(f, "of moments of no meaning {} % look answered", percent(self.shuffled_share).trim())?;
        if let Some((middle, slow)) = self.changed_after_s {
            writeln!(f, "changed after {middle:.2} s, one in twenty after {slow:.2} s or more")?;
        }
        row(f, "changed the work in time", &self.changed, None)?;
        row(f, "stood out from what moves", &self.seen, None)?;
        for (why, visits) in &self.missed {
            writeln!(f, "{why:28} {visits:6}")?;
        }
        writeln!(f, "answers to nobody: {}", self.phantoms.len())?;
        let kept = self.staff.iter().filter(|check| check.good).count();
        writeln!(f, "staff: {kept} of {} kept", self.staff.len())?;
        writeln!(f, "attract mode came back: {} of {}", self.attract_returned.0, self.attract_returned.1)?;
        writeln!(f)?;
        for Bar { bar, asked, found, met } in &self.bars {
            let met = met.map_or("too few visits", |met| if met { "met" } else { "MISSED" });
            writeln!(f, "{bar:10} {met:14} asked {asked}; found {found}")?;
        }
        Ok(())
    }
}

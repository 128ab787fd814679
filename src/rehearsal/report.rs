//! Report of a rehearsal: values for machines, a table for people, and the bars.

use std::collections::BTreeMap;
use std::fmt;

use serde::Serialize;

use super::breath_snr::BreathSnr;
use super::scorer::{FPS, Response, SOON, median};
use soffio_soundscape::statistics::wilson;

/// Share of all visits that must get a response.
pub const HEADLINE: f64 = 0.95;
/// Share of each group's visits that must get a response.
pub const GROUP: f64 = 0.85;
/// Smallest group that is judged: in smaller ones a single visit is more than 5 %.
pub const ENOUGH: usize = 20;
/// Range of the contingency at random moments, which is about 1.
pub const SHUFFLED: (f64, f64) = (0.7, 1.4);

/// One scored visit.
#[derive(Clone, Debug, Serialize)]
pub struct ScoredVisit {
    /// Onset of the visitor's first action, s of the day.
    pub onset_s: f64,
    /// Time since the last action of any visitor, s; null for the first.
    pub since_s: Option<f64>,
    /// Exhibit on show.
    pub exhibit: String,
    /// Time from the onset to the first wind inside the kiosk, s; null where there is none within a second. For information: it shows
    /// whether a visit without response was not detected, or not visible.
    pub detected_after_s: Option<f64>,
    /// Signal-to-noise ratio of the breath's first 0.3 s at the microphone, dB: rumble (31–203 Hz), hiss (406–3400 Hz), and rumble of
    /// the difference of two capsules. Null without a breath. For information: a breath far below 0 dB in all of them cannot be
    /// detected.
    #[serde(rename = "above_db")]
    pub snr_db: Option<BreathSnr>,
    /// Reasons of the detector in that second and their numbers of steps (240 a second), the most frequent first. For information.
    pub detector: Vec<(String, u32)>,
    /// Time from the onset to the first picture that differs visibly from the control run, s; null where there is none within 0.3 s.
    pub changed_after_s: Option<f64>,
    /// Time from the onset to the change that stands out from the motion before it, s. For information.
    pub seen_after_s: Option<f64>,
    /// Motion energy of the second before and of the second after; full scale 1.
    pub energy: Option<[f64; 2]>,
    /// Ratio of the energy after to the energy before.
    pub contingency: Option<f64>,
    /// Number of false triggers in the ten seconds before.
    pub false_triggers: usize,
    /// Number of breaths: a visitor who sees no motion tries again.
    pub breaths: usize,
    /// The first action got a response.
    pub at_once: bool,
    /// Any action got a response.
    pub good: bool,
    /// Reason why the first action got none.
    pub missed: Option<&'static str>,
    /// Groups of the visitor.
    pub groups: Vec<&'static str>,
}

impl ScoredVisit {
    /// First error on the way from breath to picture.
    pub(super) fn miss(&self) -> Option<&'static str> {
        Some(match (self.contingency, self.detected_after_s, self.changed_after_s) {
            _ if self.at_once => return None,
            (None, ..) => "exhibit changed",
            _ if self.false_triggers > 0 => "false trigger before",
            (_, None, _) => "not detected",
            (_, Some(after), None) if after > SOON as f64 / FPS as f64 => "detected too late",
            (_, _, None) => "no change in time",
            _ => "moved too much before",
        })
    }
}

/// A response without a visitor's action.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct FalseTrigger {
    /// Time, s of the day.
    pub at_s: f64,
    /// Time since the last action of any visitor, s; null before the first.
    pub since_s: Option<f64>,
    /// There was wind inside the kiosk; otherwise only its loudspeaker sounded like wind.
    pub blew: bool,
}

/// Share of the visits with a property.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct VisitShare {
    /// Number of visits.
    pub visits: usize,
    /// Number of visits with the property.
    pub good: usize,
    /// The share; null without visits.
    pub share: Option<f64>,
    /// Its 95 % bounds (Wilson).
    pub bounds: (f64, f64),
}

impl VisitShare {
    fn of<'a>(visits: impl Iterator<Item = &'a ScoredVisit>, holds: impl Fn(&ScoredVisit) -> bool) -> Self {
        let (visits, good) = visits.fold((0, 0), |(all, good), one| (all + 1, good + usize::from(holds(one))));
        let share = (visits > 0).then(|| good as f64 / visits as f64);
        Self { visits, good, share, bounds: wilson(good, visits) }
    }
}

/// Result of a staff task.
#[derive(Clone, Debug, Serialize)]
pub struct StaffCheck {
    /// Task: mute, clean or unplug.
    pub task: &'static str,
    /// Beginning, s of the day.
    pub from_s: f64,
    /// The kiosk was silent (mute), or without wind (clean, unplug), all the time.
    pub good: bool,
}

/// A bar of the day.
#[derive(Clone, Debug, Serialize)]
pub struct Bar {
    /// Name of the bar.
    pub bar: &'static str,
    /// Requirement, in words.
    pub required: String,
    /// Result, in words.
    pub found: String,
    /// The bar is met; null where the day has too few visits.
    pub met: Option<bool>,
}

/// Report of a rehearsal. It has 25 fields, because it is the command's output, field by field.
#[derive(Clone, Debug, Serialize)]
pub struct Report {
    /// Seed of the day.
    pub seed: u64,
    /// Length of the day, h.
    pub hours: f64,
    /// Name of the room.
    pub room: String,
    /// Capsules of the microphone.
    pub capsules: usize,
    /// Exhibits on show, in turn.
    pub exhibits: Vec<String>,
    /// Volume, dB: the highest that visitors can set.
    pub volume_db: f64,
    /// Number of visitors.
    pub visitors: usize,
    /// Visits with a response to any action. A response is a visible change of the exhibit within 0.3 s, with at least three times as
    /// much motion in the second after as in the second before, and no false trigger in the ten seconds before.
    pub headline: VisitShare,
    /// The same for each group.
    pub groups: BTreeMap<&'static str, VisitShare>,
    /// Visits with a response to the first action.
    pub at_once: VisitShare,
    /// The same for each group.
    pub groups_at_once: BTreeMap<&'static str, VisitShare>,
    /// Reasons why the first action got no response, and their numbers of visits.
    pub missed: BTreeMap<&'static str, usize>,
    /// Visits with a visible change within 0.3 s, whatever the motion before. For information.
    pub changed: VisitShare,
    /// Visits whose change stood out from the motion before within 0.3 s. For information.
    pub seen: VisitShare,
    /// Median contingency of the visits.
    pub contingency: Option<f64>,
    /// Median contingency at random moments.
    pub shuffled_contingency: Option<f64>,
    /// Share of the random moments that look like a response.
    pub shuffled_share: Option<f64>,
    /// Time from the onset to the change, s: median and 95th percentile.
    pub changed_after_s: Option<(f64, f64)>,
    /// Responses without a visitor's action.
    pub false_triggers: Vec<FalseTrigger>,
    /// Results of the staff tasks.
    pub staff: Vec<StaffCheck>,
    /// Number of returns of attract mode after a visitor has walked away, and of all such visits.
    pub attract_returned: (usize, usize),
    /// Number of pictures drawn.
    pub pictures: u64,
    /// Bars and results.
    pub bars: Vec<Bar>,
    /// Bars that are missed, in words; empty where all are met.
    pub failures: Vec<String>,
    /// Every visit.
    pub visits: Vec<ScoredVisit>,
}

impl Report {
    /// Computes all totals and bars. `shuffled` are the responses at random moments.
    pub(super) fn conclude(mut self, shuffled: &[Response]) -> Self {
        self.headline = VisitShare::of(self.visits.iter(), |visit| visit.good);
        self.at_once = VisitShare::of(self.visits.iter(), |visit| visit.at_once);
        self.changed = VisitShare::of(self.visits.iter(), |visit| visit.changed_after_s.is_some());
        self.seen = VisitShare::of(self.visits.iter(), |visit| visit.seen_after_s.is_some());
        for missed in self.visits.iter().filter_map(|visit| visit.missed) {
            *self.missed.entry(missed).or_default() += 1;
        }
        let mut names: Vec<&str> = self.visits.iter().flat_map(|visit| visit.groups.iter().copied()).collect();
        names.sort_unstable();
        names.dedup();
        for name in names {
            let members = || self.visits.iter().filter(|visit| visit.groups.contains(&name));
            self.groups.insert(name, VisitShare::of(members(), |visit| visit.good));
            self.groups_at_once.insert(name, VisitShare::of(members(), |visit| visit.at_once));
        }
        self.contingency = median(self.visits.iter().filter_map(|visit| visit.contingency).collect());
        self.shuffled_contingency = median(shuffled.iter().map(|response| response.contingency).collect());
        let alike = shuffled.iter().filter(|response| response.is_visible()).count();
        self.shuffled_share = (!shuffled.is_empty()).then(|| alike as f64 / shuffled.len() as f64);
        let mut changed: Vec<f64> = self.visits.iter().filter_map(|visit| visit.changed_after_s).collect();
        changed.sort_by(f64::total_cmp);
        self.changed_after_s =
            median(changed.clone()).map(|middle| (middle, changed[(19 * changed.len() / 20).min(changed.len() - 1)]));
        self.bars = self.check_bars();
        let missed = self.bars.iter().filter(|bar| bar.met == Some(false));
        self.failures = missed
            .map(|Bar { bar, required, found, .. }| format!("{bar}: required {required}, found {found}"))
            .collect();
        self
    }

    /// All bars with their results.
    fn check_bars(&self) -> Vec<Bar> {
        let percent = |share: f64| format!("{:.1} %", 100.0 * share);
        let enough = |visits: usize| visits >= ENOUGH;
        let visits = self.headline.visits;
        let [all, first] = [self.headline, self.at_once].map(|share| share.share.unwrap_or_default());
        let groups = || self.groups.iter().filter(|(_, group)| enough(group.visits));
        let below = groups().filter_map(|(name, group)| Some((name, group.share.filter(|share| *share < GROUP)?)));
        let below: Vec<String> = below.map(|(name, share)| format!("{name} {}", percent(share))).collect();
        let shuffled = self.shuffled_contingency;
        let times: Vec<f64> = self.false_triggers.iter().map(|trigger| trigger.at_s).collect();
        let broken: Vec<String> =
            self.staff.iter().filter(|c| !c.good).map(|c| format!("{} at {:.1} s", c.task, c.from_s)).collect();
        let (returned, all_returns) = self.attract_returned;
        let bar = |bar, required: String, found: String, met: Option<bool>| Bar { bar, required, found, met };
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
                format!("contingency {} to {} at random moments", SHUFFLED.0, SHUFFLED.1),
                shuffled.map_or("none".into(), |found| format!("{found:.2}")),
                shuffled.filter(|_| enough(visits)).map(|found| (SHUFFLED.0..SHUFFLED.1).contains(&found)),
            ),
            bar(
                "false_triggers",
                "no false trigger".into(),
                format!("{}, at {times:.1?} s", times.len()),
                Some(times.is_empty()),
            ),
            bar(
                "staff",
                "no sound while muted, no wind while input is off".into(),
                format!("{} of {} not: {}", broken.len(), self.staff.len(), broken.join(", ")),
                Some(broken.is_empty()),
            ),
            bar(
                "attract",
                "attract mode returns".into(),
                format!("{returned} times of {all_returns}"),
                Some(returned >= all_returns),
            ),
        ]
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |share: Option<f64>| share.map_or("    -".to_owned(), |share| format!("{:5.1}", 100.0 * share));
        let row = |f: &mut fmt::Formatter<'_>, name: &str, share: &VisitShare, at_once: Option<&VisitShare>| {
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
            "{} h in the {}, a microphone of {}, seed {}, {} visitors, volume {:.1} dB, exhibits: {}\n",
            self.hours,
            self.room,
            if self.capsules > 1 { "two capsules" } else { "one capsule" },
            self.seed,
            self.visitors,
            self.volume_db,
            self.exhibits.join(", ")
        )?;
        writeln!(f, "{:28} {:>6} {:>6}   answered  95 % confidence         by the first blow", "", "visits", "good")?;
        row(f, "all visits", &self.headline, Some(&self.at_once))?;
        for (name, share) in &self.groups {
            row(f, name, share, self.groups_at_once.get(name))?;
        }
        let number = |x: Option<f64>| x.map_or("-".to_owned(), |x| format!("{x:.2}"));
        writeln!(f, "\ncontingency {}, shuffled {}", number(self.contingency), number(self.shuffled_contingency))?;
        writeln!(f, "{} % of random moments look like a response", percent(self.shuffled_share).trim())?;
        if let Some((middle, slow)) = self.changed_after_s {
            writeln!(f, "changed after {middle:.2} s, one in twenty after {slow:.2} s or more")?;
        }
        row(f, "changed in time", &self.changed, None)?;
        row(f, "stood out from the motion", &self.seen, None)?;
        for (why, visits) in &self.missed {
            writeln!(f, "{why:28} {visits:6}")?;
        }
        writeln!(f, "false triggers: {}", self.false_triggers.len())?;
        let passed = self.staff.iter().filter(|check| check.good).count();
        writeln!(f, "staff tasks: {passed} of {} passed", self.staff.len())?;
        writeln!(f, "attract mode returned: {} of {}", self.attract_returned.0, self.attract_returned.1)?;
        writeln!(f)?;
        for Bar { bar, required, found, met } in &self.bars {
            let met = met.map_or("too few visits", |met| if met { "met" } else { "MISSED" });
            writeln!(f, "{bar:14} {met:14} required {required}; found {found}")?;
        }
        Ok(())
    }
}

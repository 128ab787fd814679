//! The programme of a day: visits one after another, staff between them, works in turn.

use super::visitor::{Press, Pressed, Visit, Way};
use soffio_config::CLEANING_S;
use soffio_math::noise::{Random, hash_words};
use soffio_math::{PI, sin};

/// Nobody comes before the kiosk has heard the room, s.
const BEGINS_S: f64 = 20.0;
/// Between two visits of a queue, and of an afternoon, s.
const QUEUE_S: (f64, f64) = (8.0, 20.0);
const APART_S: (f64, f64) = (20.0, 90.0);
/// Between two doings of staff, and two changes of the work, s; at most a fifth and a third of the day.
const DUTY_S: f64 = 1200.0;
const CHANGE_S: f64 = 1500.0;
/// A work gathers itself and comes to rest before somebody blows at it, s.
const GATHERS_S: f64 = 12.0;
/// How long the microphone is out, s.
const UNPLUGGED_S: f64 = 30.0;
/// Longer than the idle time, before attract mode must have begun, s.
const GRACE_S: f64 = 5.0;

/// How full the house is at a part of the day (0 … 1): it fills and empties, and two school classes come.
pub fn busyness(part: f64) -> f64 {
    let tide = sin(PI * part.clamp(0.0, 1.0));
    let classes = [0.30..0.38, 0.62..0.68].iter().any(|class| class.contains(&part));
    0.3 + 0.7 * tide * tide + if classes { 0.8 } else { 0.0 }
}

/// What staff do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// Mute it, and let it sound again.
    Mute,
    /// Switch input off and clean the glass.
    Clean,
    /// Pull the microphone's cable, and put it back.
    Unplug,
}

impl Task {
    /// In a word.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mute => "mute",
            Self::Clean => "clean",
            Self::Unplug => "unplug",
        }
    }

    /// The group of those who come right after it.
    pub fn after(self) -> &'static str {
        match self {
            Self::Mute => "after a mute",
            Self::Clean => "after cleaning",
            Self::Unplug => "after the cable was out",
        }
    }
}

/// A task and when.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Duty {
    /// What.
    pub task: Task,
    /// s of the day.
    pub from: f64,
    /// s of the day.
    pub until: f64,
}

/// A visit and what it has to do with staff.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The visit.
    pub visit: Visit,
    /// The work on show, by its place among the works.
    pub work: usize,
    /// What staff do meanwhile.
    pub during: Option<Task>,
    /// What staff have just done.
    pub after: Option<Task>,
    /// A moment of no meaning about the visit, s of the day.
    pub shuffled: f64,
}

impl Entry {
    /// Should the kiosk answer? Not while it is cleaned or its cable is out.
    pub fn answered(&self) -> bool {
        self.visit.onset().is_some() && !matches!(self.during, Some(Task::Clean | Task::Unplug))
    }
}

/// A day.
#[derive(Clone, Debug, Default)]
pub struct Day {
    /// In order; no two overlap.
    pub entries: Vec<Entry>,
    /// In order.
    pub duties: Vec<Duty>,
    /// When another work is chosen (s of the day), and which.
    pub changes: Vec<(f64, usize)>,
    /// When attract mode must be playing, s of the day.
    pub attracts: Vec<f64>,
    /// Length, s.
    pub length: f64,
}

impl Day {
    /// A day of so many seconds with so many works; `idle_s` is the time after which attract mode plays, if it does.
    pub fn new(seed: u64, length: f64, works: usize, idle_s: Option<f64>) -> Self {
        let mut day = Self { length, ..Self::default() };
        let mut random = Random::new(hash_words(&[seed, 0x6461_7973]));
        let random = &mut random;
        let (duty_s, change_s) = (DUTY_S.min(length / 5.0), CHANGE_S.min(length / 3.0));
        let (mut next_duty, mut next_change) = (0.6 * duty_s, change_s);
        let mut tasks = [Task::Mute, Task::Clean, Task::Unplug].into_iter().cycle();
        let (mut now, mut work) = (BEGINS_S, 0);
        loop {
            let mut ready = 0.0;
            if now >= next_change && works > 1 {
                next_change += change_s;
                work = (work + 1) % works;
                day.changes.push((now, work));
                ready = GATHERS_S;
            }
            let mut after = None;
            if now >= next_duty {
                next_duty += duty_s;
                let task = tasks.next().unwrap_or(Task::Mute);
                let visit = meanwhile(task, now, ready, random);
                let until = match task {
                    Task::Mute => visit.leaves + 1.0,
                    Task::Clean => now + CLEANING_S,
                    Task::Unplug => (now + UNPLUGGED_S).max(visit.leaves),
                };
                day.duties.push(Duty { task, from: now, until });
                day.enter(visit, work, (Some(task), None), random);
                // Who blew into a mute kiosk has made way, as in any queue; after the others nothing swings.
                let apart = if task == Task::Mute { random.range(QUEUE_S.0, QUEUE_S.1) } else { 0.0 };
                (after, ready, now) = (Some(task), 0.0, until + apart);
            }
            let visit = match after {
                // Who comes right after staff is who is asked about.
                Some(_) => Visit::of(Way::Blows, now, ready, random),
                None => Visit::new(now, ready, random),
            };
            let (leaves, way) = (visit.leaves, visit.way);
            day.enter(visit, work, (None, after), random);
            let (low, high) = if random.unit() < 0.5 { QUEUE_S } else { APART_S };
            now = leaves + random.range(low, high);
            if way == Way::WalksAway
                && let Some(idle) = idle_s
            {
                now = leaves + idle + GRACE_S;
                day.attracts.push(now);
                now += 1.0;
            }
            if now > length {
                // Whoever would still be there when the doors close has not come.
                day.entries.retain(|entry| entry.visit.leaves < length);
                day.duties.retain(|duty| duty.until < length);
                day.attracts.retain(|at| *at < length);
                return day;
            }
        }
    }

    fn enter(&mut self, visit: Visit, work: usize, (during, after): (Option<Task>, Option<Task>), random: &mut Random) {
        let shuffled = random.range(visit.arrives, visit.leaves.max(visit.arrives + 1.0));
        self.entries.push(Entry { visit, work, during, after, shuffled });
    }
}

/// What somebody does while staff are about: a visitor blows as ever, into a kiosk that is mute or deaf; a cloth wipes.
fn meanwhile(task: Task, now: f64, ready: f64, random: &mut Random) -> Visit {
    let mut visit = Visit::of(Way::Blows, now + 2.0, ready, random);
    if task == Task::Clean {
        visit.presses = (0..4)
            .map(|i| {
                let from = now + 5.0 + 12.0 * f64::from(i);
                let at = [random.range(0.2, 0.8), random.range(0.2, 0.8)];
                Pressed { from, until: from + 3.0, press: Press::Finger(at) }
            })
            .collect();
        visit.aim = None;
        visit.leaves = now + CLEANING_S - 2.0;
    }
    visit
}

//! Programme of a day: visits one after another, staff tasks between them, exhibits in turn.

use super::visitor::{Intent, Press, TimedPress, Visit};
use soffio_config::CLEANING_S;
use soffio_math::noise::{Random, hash_words};
use soffio_math::{PI, sin};

/// Beginning of the first visit, s: the detector learns the noise floor before.
const BEGINS_S: f64 = 20.0;
/// Pause between two visits of a queue, s.
const QUEUE_S: (f64, f64) = (8.0, 20.0);
/// Pause between two visits of a quiet afternoon, s.
const QUIET_S: (f64, f64) = (20.0, 90.0);
/// Time between two staff tasks, s; at most a fifth of the day.
const TASK_INTERVAL_S: f64 = 1200.0;
/// Time between two changes of the exhibit, s; at most a third of the day.
const CHANGE_INTERVAL_S: f64 = 1500.0;
/// Time in which a new exhibit is assembled and comes to rest, s.
const ASSEMBLY_S: f64 = 12.0;
/// Time for which the microphone is unplugged, s.
const UNPLUGGED_S: f64 = 30.0;
/// Time after the idle time in which attract mode must begin, s.
const GRACE_S: f64 = 5.0;

/// Occupancy of the venue at a part of the day (0 … 1): it rises and falls, with two school classes.
pub fn occupancy(part: f64) -> f64 {
    let tide = sin(PI * part.clamp(0.0, 1.0));
    let classes = [0.30..0.38, 0.62..0.68].iter().any(|class| class.contains(&part));
    0.3 + 0.7 * tide * tide + if classes { 0.8 } else { 0.0 }
}

/// A task of the staff.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Task {
    /// Mute the kiosk, and unmute it.
    Mute,
    /// Switch input off and clean the glass.
    Clean,
    /// Unplug the microphone, and plug it in again.
    Unplug,
}

impl Task {
    /// Name of the task.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mute => "mute",
            Self::Clean => "clean",
            Self::Unplug => "unplug",
        }
    }

    /// Group of the visitors who come right after it.
    pub fn after(self) -> &'static str {
        match self {
            Self::Mute => "after a mute",
            Self::Clean => "after cleaning",
            Self::Unplug => "after the cable was out",
        }
    }
}

/// A staff task and its time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StaffTask {
    /// The task.
    pub task: Task,
    /// Beginning, s of the day.
    pub from: f64,
    /// End, s of the day.
    pub until: f64,
}

/// A visit, the exhibit on show, and the staff tasks about it.
#[derive(Clone, Debug)]
pub struct Entry {
    /// The visit.
    pub visit: Visit,
    /// Index of the exhibit on show.
    pub exhibit: usize,
    /// Staff task during the visit.
    pub during: Option<Task>,
    /// Staff task just before the visit.
    pub after: Option<Task>,
    /// A random moment during the visit, for comparison, s of the day.
    pub shuffled: f64,
}

impl Entry {
    /// True where the kiosk should respond: the visitor acts, and the kiosk is neither cleaned nor unplugged.
    pub fn expects_response(&self) -> bool {
        self.visit.onset().is_some() && !matches!(self.during, Some(Task::Clean | Task::Unplug))
    }
}

/// Change to another exhibit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExhibitChange {
    /// Time, s of the day.
    pub at: f64,
    /// Index of the new exhibit.
    pub exhibit: usize,
}

/// Programme of a day.
#[derive(Clone, Debug, Default)]
pub struct Day {
    /// Visits in order; no two overlap.
    pub entries: Vec<Entry>,
    /// Staff tasks in order.
    pub staff_tasks: Vec<StaffTask>,
    /// Changes of the exhibit in order.
    pub changes: Vec<ExhibitChange>,
    /// Times at which attract mode must be playing, s of the day.
    pub attracts: Vec<f64>,
    /// Length, s.
    pub length: f64,
}

impl Day {
    /// A day of `length` seconds with a number of exhibits; `idle_s` is the time until attract mode, if the site has it.
    pub fn new(seed: u64, length: f64, exhibits: usize, idle_s: Option<f64>) -> Self {
        let mut day = Self { length, ..Self::default() };
        let mut random = Random::new(hash_words(&[seed, 0x6461_7973]));
        let random = &mut random;
        let (task_interval, change_interval) = (TASK_INTERVAL_S.min(length / 5.0), CHANGE_INTERVAL_S.min(length / 3.0));
        let (mut next_task, mut next_change) = (0.6 * task_interval, change_interval);
        let mut tasks = [Task::Mute, Task::Clean, Task::Unplug].into_iter().cycle();
        let (mut now, mut exhibit) = (BEGINS_S, 0);
        loop {
            let mut ready = 0.0;
            if now >= next_change && exhibits > 1 {
                next_change += change_interval;
                exhibit = (exhibit + 1) % exhibits;
                day.changes.push(ExhibitChange { at: now, exhibit });
                ready = ASSEMBLY_S;
            }
            let mut after = None;
            if now >= next_task {
                next_task += task_interval;
                let task = tasks.next().unwrap_or(Task::Mute);
                let visit = visit_during(task, now, ready, random);
                let until = match task {
                    Task::Mute => visit.leaves + 1.0,
                    Task::Clean => now + CLEANING_S,
                    Task::Unplug => (now + UNPLUGGED_S).max(visit.leaves),
                };
                day.staff_tasks.push(StaffTask { task, from: now, until });
                day.enter(visit, exhibit, StaffContext { during: Some(task), after: None }, random);
                // After a mute the next visitor comes as in a queue; after the other tasks nothing moves any more.
                let pause = if task == Task::Mute { random.range(QUEUE_S.0, QUEUE_S.1) } else { 0.0 };
                (after, ready, now) = (Some(task), 0.0, until + pause);
            }
            let visit = match after {
                // A visit right after a task must test it.
                Some(_) => Visit::of(Intent::Blows, now, ready, random),
                None => Visit::new(now, ready, random),
            };
            let (leaves, intent) = (visit.leaves, visit.intent);
            day.enter(visit, exhibit, StaffContext { during: None, after }, random);
            let (low, high) = if random.unit() < 0.5 { QUEUE_S } else { QUIET_S };
            now = leaves + random.range(low, high);
            if intent == Intent::WalksAway
                && let Some(idle) = idle_s
            {
                now = leaves + idle + GRACE_S;
                day.attracts.push(now);
                now += 1.0;
            }
            if now > length {
                // Visits that would end after closing time are left out.
                day.entries.retain(|entry| entry.visit.leaves < length);
                day.staff_tasks.retain(|task| task.until < length);
                day.attracts.retain(|at| *at < length);
                return day;
            }
        }
    }

    fn enter(&mut self, visit: Visit, exhibit: usize, staff: StaffContext, random: &mut Random) {
        let StaffContext { during, after } = staff;
        let shuffled = random.range(visit.arrives, visit.leaves.max(visit.arrives + 1.0));
        self.entries.push(Entry { visit, exhibit, during, after, shuffled });
    }
}

/// Staff tasks about a visit.
struct StaffContext {
    during: Option<Task>,
    after: Option<Task>,
}

/// Visit during a staff task: a visitor who blows at the muted or unplugged kiosk, or a cloth that wipes the glass.
fn visit_during(task: Task, now: f64, ready: f64, random: &mut Random) -> Visit {
    let mut visit = Visit::of(Intent::Blows, now + 2.0, ready, random);
    if task == Task::Clean {
        visit.presses = (0..4)
            .map(|i| {
                let from = now + 5.0 + 12.0 * f64::from(i);
                let at = [random.range(0.2, 0.8), random.range(0.2, 0.8)];
                TimedPress { from, until: from + 3.0, press: Press::Finger(at) }
            })
            .collect();
        visit.aim = None;
        visit.leaves = now + CLEANING_S - 2.0;
    }
    visit
}

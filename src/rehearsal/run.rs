//! The day, step by step.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};

use super::blocks::FRAMES;
use super::day::{Day, Duty, Task};
use super::ears::Ears;
use super::eyes::{Eyes, Seen, picture_at};
use super::house::House;
use super::judge::{self, Answer, FPS};
use super::machine::Machine;
use super::rehearsal::{Rehearsal, RehearsalError, open_house};
use super::report::{Judged, Nobody, Report, Share, StaffCheck};
use super::standing::Above;
use super::twin::left_alone;
use super::visitor::Press;
use soffio_exhibit::Exhibit;
use soffio_kiosk::gesture;
use soffio_kiosk::stage::Controls;
use soffio_math::Pose;
use soffio_simulation::{SAMPLES_PER_STEP, STEPS_PER_SECOND, Snapshot};
use soffio_wind::SurfaceShape;

/// Width over height of the picture.
const ASPECT: f64 = 16.0 / 9.0;
/// A visit's sounds are made so long before it, s.
const AHEAD_S: f64 = 1.0;
/// No answer to nobody in this time before a visitor's doing, s.
const UNTOUCHED_S: f64 = 10.0;
/// What somebody has done is answered for so long after it ends, s: the wind dies down, the room rings.
pub(super) const AFTERMATH_S: f64 = 2.0;
/// Wind may seem to begin this little before the breath that makes it, s: the length of a frame.
pub(super) const EARLY_S: f64 = 0.05;
/// What staff do has taken effect after this time, s.
const TAKES_EFFECT_S: f64 = 1.0;
/// Whoever has blown waits so long for something to move, s.
const PATIENCE_S: f64 = 1.0;
/// A pull reaches its end after this time, s: too soon for a press that is meant to blow.
const PULL_S: f64 = 0.4;

/// Rehearses a day. `on_second` hears how many seconds of it are over.
pub fn run(
    mut rehearsal: Rehearsal,
    stop: &AtomicBool,
    mut on_second: impl FnMut(u64),
) -> Result<Report, RehearsalError> {
    let house = open_house(&mut rehearsal)?;
    let length = 3600.0 * rehearsal.hours;
    let day = Day::new(rehearsal.seed, length, rehearsal.works.len(), rehearsal.site.idle_s);
    let mut course = Course::new(&rehearsal, day, house)?;
    for step in 0..(length * STEPS_PER_SECOND as f64) as u64 {
        course.step(step);
        if step % STEPS_PER_SECOND == 0 {
            on_second(step / STEPS_PER_SECOND);
        }
        if stop.load(Ordering::Relaxed) {
            return Err(RehearsalError::Interrupted);
        }
        if course.eyes.have_failed() {
            break;
        }
    }
    course.report(&rehearsal)
}

/// A moment that is judged when its pictures are there.
struct Moment {
    entry: usize,
    /// s of the day.
    at: f64,
    /// Which of the visitor's breaths, or of other doings the first, begins; `None` for a moment of no meaning.
    doing: Option<usize>,
    /// The work had nobody come, from then on.
    alone: Vec<Vec<Pose>>,
}

/// The day so far.
struct Course<'a> {
    rehearsal: &'a Rehearsal,
    day: Day,
    house: House,
    machine: Machine,
    /// Is asked about an entry's doing (which one) or about a moment of no meaning.
    eyes: Eyes<(usize, Option<usize>)>,
    ears: Ears,
    controls: Controls,
    blocks: u64,
    work: usize,
    /// Entries whose sounds are made; the one that is on.
    made: usize,
    current: usize,
    changed: usize,
    attract_asked: usize,
    returned: usize,
    /// What is being pulled: the press's beginning and where it took.
    pulled: Option<(f64, [f64; 2])>,
    waiting: Vec<Moment>,
    notes: Notes,
    /// When attract mode last played, and when the kiosk last blew for somebody, s.
    attracted: f64,
    blew: f64,
    duties: Vec<(Duty, bool)>,
}

/// What is noted of the day for its report.
struct Notes {
    /// Did the entry's onset end attract mode?
    woke: Vec<usize>,
    /// Entries whose doing made wind, and after how long, s.
    heard: Vec<(usize, f64)>,
    /// How far each entry's first breath stood above the house, dB.
    above: Vec<Option<Above>>,
    /// What the ear said in the second after each entry's onset, and how often.
    ear: Vec<BTreeMap<String, u32>>,
    phantoms: Vec<Nobody>,
}

impl Notes {
    fn new(entries: usize) -> Self {
        Self {
            woke: Vec::new(),
            heard: Vec::new(),
            above: vec![None; entries],
            ear: vec![BTreeMap::new(); entries],
            phantoms: Vec::new(),
        }
    }

    /// Answers to nobody in the time before a visitor's doing.
    fn phantoms_before(&self, onset: f64) -> usize {
        let before = onset - UNTOUCHED_S..onset;
        self.phantoms.iter().filter(|nobody| before.contains(&nobody.at_s)).count()
    }
}

impl<'a> Course<'a> {
    fn new(rehearsal: &'a Rehearsal, day: Day, house: House) -> Result<Self, RehearsalError> {
        let eyes = Eyes::new(&rehearsal.works)?;
        let machine = Machine::new(rehearsal.works[0].clone(), &rehearsal.site, rehearsal.capsules);
        let entries = day.entries.len();
        Ok(Self {
            rehearsal,
            duties: day.duties.iter().map(|duty| (*duty, true)).collect(),
            day,
            house,
            machine,
            eyes,
            ears: Ears::new(),
            controls: Controls { aspect: ASPECT, ..Controls::default() },
            blocks: 0,
            work: 0,
            made: 0,
            current: 0,
            changed: 0,
            attract_asked: 0,
            returned: 0,
            pulled: None,
            waiting: Vec::new(),
            notes: Notes::new(entries),
            attracted: f64::NEG_INFINITY,
            blew: f64::NEG_INFINITY,
        })
    }

    fn step(&mut self, step: u64) {
        let now = step as f64 / STEPS_PER_SECOND as f64;
        self.programme(now);
        while (self.blocks + 1) * FRAMES as u64 <= step * SAMPLES_PER_STEP {
            self.blocks += 1;
            let heard = self.house.hear(self.machine.played());
            self.machine.exchange(&heard);
            for began in self.ears.hear(self.machine.played(), self.machine.played_in_still_air()) {
                self.wind(began);
            }
        }
        self.act(now);
        self.try_again(now);
        let plugged = !self.on_duty(now, Task::Unplug);
        self.controls.inert = self.on_duty(now, Task::Clean);
        for moment in self.waiting.iter_mut().filter(|moment| begins(moment.at, now)) {
            moment.alone = left_alone(&self.machine.stage, &self.controls, picture_at(moment.at));
        }
        self.machine.step(&self.controls, plugged);
        if self.machine.stage.attracts() {
            self.attracted = now;
        }
        if self.blows() {
            self.blew = now;
        }
        self.note_heard(now);
        self.watch_staff(now);
        self.eyes.look(step + 1, self.work, self.machine.stage.snapshot());
        self.ask((step + 1) * FPS / STEPS_PER_SECOND);
    }

    fn on_duty(&self, now: f64, task: Task) -> bool {
        self.day.duties.iter().any(|duty| duty.task == task && (duty.from..duty.until).contains(&now))
    }

    /// What begins now: visits, staff, another work.
    fn programme(&mut self, now: f64) {
        while let Some(entry) = self.day.entries.get(self.made).filter(|entry| entry.visit.arrives - AHEAD_S <= now) {
            let (capsules, apart) = (self.house.capsules(), self.house.world().apart());
            for (at, sound) in entry.visit.noises(self.house.world(), capsules) {
                self.house.put(at, sound);
            }
            for breath in &entry.visit.breaths {
                self.house.put_breath(breath.onset, breath.sound(capsules, apart));
            }
            if entry.answered()
                && let Some(onset) = entry.visit.onset()
            {
                for (at, doing) in [(onset, Some(0)), (entry.shuffled, None)] {
                    self.waiting.push(Moment { entry: self.made, at, doing, alone: Vec::new() });
                }
            }
            self.made += 1;
        }
        if let Some((_, work)) = self.day.changes.get(self.changed).filter(|(at, _)| *at <= now) {
            self.work = *work;
            self.machine.show(self.rehearsal.works[self.work].clone());
            self.changed += 1;
        }
        let muted = self.on_duty(now, Task::Mute);
        if muted != self.machine.is_muted() {
            self.machine.toggle_mute();
        }
        if self.day.attracts.get(self.attract_asked).is_some_and(|at| *at <= now) {
            self.attract_asked += 1;
            self.returned += usize::from(self.machine.stage.attracts());
        }
    }

    /// What the visitor of the moment does, as the window would tell it.
    fn act(&mut self, now: f64) {
        while self.day.entries.get(self.current).is_some_and(|entry| entry.visit.leaves < now) {
            self.current += 1;
        }
        self.controls.hold = false;
        self.controls.presses.clear();
        let Some(entry) = self.day.entries.get(self.current).filter(|entry| entry.visit.arrives <= now) else { return };
        let visit = &entry.visit;
        if entry.answered() && visit.onset().is_some_and(|onset| begins(onset, now)) && self.machine.stage.attracts() {
            self.notes.woke.push(self.current);
        }
        if let Some(breath) = visit.breaths.first().filter(|breath| begins(breath.onset, now)) {
            self.house.look_at(breath.onset);
        }
        if let Some((_, place)) = visit.aim.filter(|(at, _)| begins(*at, now)) {
            self.controls.aim = Some(place);
            self.controls.activity += 1;
        }
        for (i, pressed) in visit.presses.iter().enumerate().filter(|(_, p)| (p.from..p.until).contains(&now)) {
            let id = 1000 * self.current as u64 + i as u64;
            match pressed.press {
                Press::Key => self.controls.hold = true,
                Press::Finger(at) => self.controls.presses.push(gesture::Press { id, at }),
                Press::Pull(which, pull) => {
                    let (_, from) = *self.pulled.get_or_insert_with(|| {
                        let place = place(self.machine.stage.exhibit(), self.machine.stage.snapshot(), which);
                        (pressed.from, place)
                    });
                    let part = ((now - pressed.from) / PULL_S).min(1.0);
                    let at = [from[0] + part * pull[0] / ASPECT, from[1] + part * pull[1]];
                    self.controls.presses.push(gesture::Press { id, at: at.map(|x| x.clamp(0.0, 1.0)) });
                }
            }
        }
        if self.controls.presses.is_empty() {
            self.pulled = None;
        }
    }

    /// Whoever has blown, and seen nothing move since, blows again while nobody else has come; that is looked at too.
    fn try_again(&mut self, now: f64) {
        let comes = self.day.entries.get(self.current + 1).map_or(self.day.length, |next| next.visit.arrives);
        let Some(entry) = self.day.entries.get_mut(self.current).filter(|entry| entry.answered()) else { return };
        let visit = &mut entry.visit;
        if visit.onset().is_none_or(|onset| self.blew >= onset) {
            return;
        }
        if visit.blown().is_some_and(|end| begins(end + PATIENCE_S, now))
            && let Some(breath) = visit.tries_again().filter(|breath| breath.end() + PATIENCE_S < comes)
        {
            let sound = breath.sound(self.house.capsules(), self.house.world().apart());
            self.house.put_breath(breath.onset, sound);
            visit.leaves = visit.leaves.max(breath.end() + PATIENCE_S);
            visit.breaths.push(breath);
        }
        let begins_now = visit.separate().skip(1).find(|(_, breath)| begins(breath.onset, now));
        if let Some((doing, breath)) = begins_now {
            let (entry, at, doing) = (self.current, breath.onset, Some(doing));
            self.waiting.push(Moment { entry, at, doing, alone: Vec::new() });
        }
    }

    /// Does the kiosk blow for somebody? What the invitation blows is nobody's.
    fn blows(&self) -> bool {
        self.machine.stage.snapshot().breath.speed > 0.0 && !self.machine.stage.attracts()
    }

    /// Does the kiosk blow within a second of what the visitor does?
    fn note_heard(&mut self, now: f64) {
        let onset = self.day.entries.get(self.current).and_then(|entry| entry.visit.onset());
        let Some(onset) = onset.filter(|onset| (*onset..onset + 1.0).contains(&now)) else { return };
        let blows = self.blows();
        let above = &mut self.notes.above[self.current];
        if above.is_none() && !self.day.entries[self.current].visit.breaths.is_empty() {
            *above = self.house.above_db();
        }
        let reason = self.machine.stage.snapshot().breath.estimate.reason;
        *self.notes.ear[self.current].entry(format!("{reason:?}")).or_default() += 1;
        if blows && self.notes.heard.last().is_none_or(|(entry, _)| *entry != self.current) {
            self.notes.heard.push((self.current, now - onset));
        }
    }

    /// Staff's doing is kept: silence while it is mute, no wind at all while it is deaf.
    fn watch_staff(&mut self, now: f64) {
        let speed = self.machine.stage.snapshot().breath.speed;
        let attracts = self.machine.stage.attracts();
        for (duty, good) in &mut self.duties {
            if (duty.from + TAKES_EFFECT_S..duty.until).contains(&now) {
                *good &= match duty.task {
                    Task::Mute => self.machine.played().iter().all(|sample| *sample == 0.0),
                    Task::Clean | Task::Unplug => speed == 0.0 || attracts,
                };
            }
        }
    }

    /// Wind began to rush: is it an answer to somebody?
    fn wind(&mut self, began: f64) {
        let near = |entry: &&super::day::Entry| entry.visit.arrives < began + 1.0 && began < entry.visit.leaves + 10.0;
        let answered =
            self.day.entries.iter().filter(near).filter(|entry| entry.answered()).any(|entry| {
                entry.visit.acts().any(|(from, until)| from < began + EARLY_S && began < until + AFTERMATH_S)
            });
        let shown = began < self.attracted + AFTERMATH_S;
        if !answered && !shown {
            let (since_s, blew) = (since_last_act(&self.day, began), self.blew > began - EARLY_S);
            self.notes.phantoms.push(Nobody { at_s: began, since_s, blew });
        }
    }

    /// Has what is due judged, the pictures up to `picture` being there.
    fn ask(&mut self, picture: u64) {
        let due = |moment: &Moment| picture_at(moment.at) + judge::BEFORE as u64 <= picture;
        while let Some(index) = self.waiting.iter().position(due) {
            let Moment { entry, at, doing, alone } = self.waiting.swap_remove(index);
            self.eyes.ask((entry, doing), picture_at(at), alone);
        }
    }

    fn report(self, rehearsal: &Rehearsal) -> Result<Report, RehearsalError> {
        let Seen { answers, drawn } = self.eyes.seen()?;
        let shuffled: Vec<_> = answers
            .iter()
            .filter_map(|((_, doing), answer)| answer.filter(|_| doing.is_none()))
            .map(|answer| (answer.contingency, answer.is_answer()))
            .collect();
        let firsts = answers.iter().filter(|((_, doing), _)| *doing == Some(0));
        let judged = firsts.filter_map(|((index, _), answer)| {
            let entry = &self.day.entries[*index];
            let onset = entry.visit.onset()?;
            let answered = |onset: f64, answer: &Option<Answer>| {
                answer.is_some_and(|answer| answer.is_answer()) && self.notes.phantoms_before(onset) == 0
            };
            let at_once = answered(onset, answer);
            let later = answers.iter().filter(|((entry, _), _)| entry == index).any(|((_, doing), answer)| {
                doing.is_some_and(|doing| doing > 0 && answered(entry.visit.breaths[doing].onset, answer))
            });
            let mut groups = entry.visit.groups();
            groups.extend(entry.after.map(Task::after));
            groups.extend(self.notes.woke.contains(index).then_some("wakes it from attract mode"));
            let middle = picture_at(onset) as f64;
            let after = |picture: usize| (middle + picture as f64) / FPS as f64 - onset;
            let judged = Judged {
                onset_s: onset,
                since_s: since_last_act(&self.day, onset),
                work: rehearsal.works[entry.work].id.clone(),
                above_db: self.notes.above[*index],
                ear: most_frequent(&self.notes.ear[*index]),
                heard_after_s: self.notes.heard.iter().find(|(entry, _)| entry == index).map(|(_, after)| *after),
                changed_after_s: answer.and_then(|a| a.changed).map(after),
                seen_after_s: answer.and_then(|a| a.seen).map(after),
                energy: answer.map(|answer| answer.energy),
                contingency: answer.map(|answer| answer.contingency),
                phantoms: self.notes.phantoms_before(onset),
                breaths: entry.visit.breaths.len(),
                at_once,
                good: at_once || later,
                missed: None,
                groups,
            };
            Some(Judged { missed: judged.miss(), ..judged })
        });
        let staff = self.duties.iter().map(|(duty, good)| StaffCheck {
            task: duty.task.name(),
            from_s: duty.from,
            good: *good,
        });
        Ok(Report {
            seed: rehearsal.seed,
            hours: rehearsal.hours,
            room: rehearsal.room.clone(),
            capsules: rehearsal.capsules,
            works: rehearsal.works.iter().map(|work| work.id.clone()).collect(),
            volume_db: self.machine.volume_db(),
            visitors: self.day.entries.len(),
            headline: Share::default(),
            groups: Default::default(),
            at_once: Share::default(),
            groups_at_once: Default::default(),
            missed: Default::default(),
            changed: Share::default(),
            seen: Share::default(),
            contingency: None,
            shuffled_contingency: None,
            shuffled_share: None,
            changed_after_s: None,
            staff: staff.collect(),
            attract_returned: (self.returned, self.attract_asked),
            pictures: drawn,
            bars: Vec::new(),
            failures: Vec::new(),
            visits: judged.collect(),
            phantoms: self.notes.phantoms.clone(),
        }
        .conclude(&shuffled))
    }
}

/// How long before `at` somebody last did something, s.
fn since_last_act(day: &Day, at: f64) -> Option<f64> {
    let acts = day.entries.iter().flat_map(|entry| entry.visit.acts());
    let last = acts.map(|(_, until)| until).filter(|until| *until < at).fold(f64::NEG_INFINITY, f64::max);
    last.is_finite().then_some(at - last)
}

/// The most frequent first.
fn most_frequent(counts: &BTreeMap<String, u32>) -> Vec<(String, u32)> {
    let mut counts: Vec<_> = counts.iter().map(|(said, count)| (said.clone(), *count)).collect();
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    counts
}

/// Is this the step in which `at` lies?
fn begins(at: f64, now: f64) -> bool {
    let step = 1.0 / STEPS_PER_SECOND as f64;
    (now - step..now).contains(&(at - step))
}

/// Where one of the plates is in the picture; its middle where there is none.
fn place(exhibit: &Exhibit, moment: &Snapshot, which: f64) -> [f64; 2] {
    let view = exhibit.view(ASPECT);
    let plates = exhibit.wind_surfaces.iter().filter_map(|surface| match &surface.shape {
        SurfaceShape::Mesh { mesh, .. } => Some(moment.poses[surface.body].point(mesh.ball().0)),
        SurfaceShape::Wire { .. } => None,
    });
    let shown: Vec<[f64; 2]> = plates.filter_map(|point| view.project(point, ASPECT)).collect();
    shown.get((which * shown.len() as f64) as usize).copied().unwrap_or([0.5, 0.5])
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::Crowd;
    use crate::day::Entry;
    use crate::visitor::{Visit, Way};
    use soffio_config::Config;
    use soffio_exhibit as exhibit;
    use soffio_kiosk::site::Site;
    use soffio_math::noise::Random;

    #[test]
    fn whoever_is_not_heard_blows_again_in_the_day_and_each_breath_is_looked_at() {
        /// A breath of two seconds at most, and its pause, three times over.
        const LENGTH_S: f64 = 32.0;
        /// Nobody is heard from there.
        const FAR_M: f64 = 30.0;
        /// Of the second before and the second after, and of the moment itself.
        const PICTURES: u64 = 2 * judge::BEFORE as u64 + 1;
        let folder = exhibit::resolve("steel-fish").expect("a shipped work");
        let work = Arc::new(exhibit::load(&folder).expect("a good one"));
        let site = Site::new(&Config::default(), 1);
        let (hours, room) = (LENGTH_S / 3600.0, "gallery".into());
        let mut rehearsal =
            Rehearsal { works: vec![work], site, room, capsules: 2, crowd: Crowd::Made, hours, seed: 1 };
        let house = open_house(&mut rehearsal).expect("a room");
        let mut visit = Visit::of(Way::Blows, 1.0, 0.0, &mut Random::new(1));
        visit.breaths.truncate(1);
        visit.breaths[0].shape.distance = FAR_M;
        visit.leaves = visit.breaths[0].end() + PATIENCE_S + 0.5;
        let entries = vec![Entry { visit, work: 0, during: None, after: None, shuffled: 0.5 * LENGTH_S }];
        let day = Day { entries, length: LENGTH_S, ..Day::default() };
        let mut course = Course::new(&rehearsal, day, house).expect("a driver");
        (0..(LENGTH_S * STEPS_PER_SECOND as f64) as u64).for_each(|step| course.step(step));
        let report = course.report(&rehearsal).expect("pictures");
        let visit = &report.visits[0];
        assert!(visit.breaths == 3 && !visit.good && visit.heard_after_s.is_none(), "{visit:?}");
        assert!(
            report.pictures >= 4 * PICTURES,
            "{} pictures: of each breath, and of a moment of no meaning",
            report.pictures
        );
    }
}

//! Run of a rehearsed day, step by step.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};

use super::audio_observer::AudioObserver;
use super::blocks::FRAMES;
use super::breath_snr::BreathSnr;
use super::control_run::control_poses;
use super::day::{Day, StaffTask, Task};
use super::kiosk_under_test::KioskUnderTest;
use super::rehearsal::{Rehearsal, RehearsalError, open_venue};
use super::report::{FalseTrigger, Report, ScoredVisit, StaffCheck, VisitShare};
use super::scorer::{self, FPS, Response};
use super::venue::Venue;
use super::video_observer::{Observations, VideoObserver, picture_at};
use super::visitor::Press;
use soffio_exhibit::Exhibit;
use soffio_kiosk::step::controls::Controls;
use soffio_kiosk::visitor::gesture;
use soffio_math::Pose;
use soffio_simulation::{SAMPLES_PER_STEP, STEPS_PER_SECOND, Snapshot};
use soffio_wind::SurfaceShape;

/// Width over height of the picture.
const ASPECT: f64 = 16.0 / 9.0;
/// Time before a visit at which its sounds are made, s.
const AHEAD_S: f64 = 1.0;
/// Time before a visitor's action in which a false trigger spoils it, s.
const UNTOUCHED_S: f64 = 10.0;
/// Time after the end of an action in which the kiosk may still respond to it, s: wind and reverberation die away.
pub(super) const AFTERMATH_S: f64 = 2.0;
/// Largest lead of a detected wind over its breath, s: the length of a frame.
pub(super) const EARLY_S: f64 = 0.05;
/// Time in which a staff task takes effect, s.
const TAKES_EFFECT_S: f64 = 1.0;
/// Time for which a visitor waits for a response before trying again, s.
const PATIENCE_S: f64 = 1.0;
/// Time in which a pull reaches its end, s: too short for a press that blows.
const PULL_S: f64 = 0.4;

/// Rehearses a day; `on_second` is called with the number of seconds that are over.
///
/// # Errors
/// There is no such room, no Vulkan driver, or the run was interrupted.
pub fn run(
    mut rehearsal: Rehearsal,
    stop: &AtomicBool,
    mut on_second: impl FnMut(u64),
) -> Result<Report, RehearsalError> {
    let venue = open_venue(&mut rehearsal)?;
    let length = 3600.0 * rehearsal.hours;
    let day = Day::new(rehearsal.seed, length, rehearsal.exhibits.len(), rehearsal.site.idle_s);
    let mut run = DayRun::new(&rehearsal, day, venue)?;
    for step in 0..(length * STEPS_PER_SECOND as f64) as u64 {
        run.step(step);
        if step % STEPS_PER_SECOND == 0 {
            on_second(step / STEPS_PER_SECOND);
        }
        if stop.load(Ordering::Relaxed) {
            return Err(RehearsalError::Interrupted);
        }
        if run.video.has_failed() {
            break;
        }
    }
    run.report(&rehearsal)
}

/// Key of a scored moment.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Key {
    /// Index of the entry.
    entry: usize,
    /// Index of the visitor's action: of a breath, or 0 for the first press; `None` for a random moment.
    action: Option<usize>,
}

/// A moment that is scored once its pictures exist.
struct PendingMoment {
    key: Key,
    /// s of the day.
    at: f64,
    /// Poses of the control run from then on.
    control: Vec<Vec<Pose>>,
}

/// A staff task, and whether the kiosk has behaved as required so far.
struct CheckedTask {
    task: StaffTask,
    good: bool,
}

/// State of the day.
struct DayRun<'a> {
    rehearsal: &'a Rehearsal,
    day: Day,
    venue: Venue,
    kiosk: KioskUnderTest,
    video: VideoObserver<Key>,
    audio: AudioObserver,
    controls: Controls,
    blocks: u64,
    exhibit: usize,
    /// Number of entries whose sounds are made.
    made: usize,
    /// Index of the current entry.
    current: usize,
    /// Number of changes of the exhibit so far.
    changes_made: usize,
    /// Number of checks of attract mode so far, and of those that found it playing.
    attract_checks: usize,
    attract_returns: usize,
    /// Place in the picture at which a visitor's pull began.
    pull_from: Option<[f64; 2]>,
    pending: Vec<PendingMoment>,
    log: Log,
    /// Last time at which attract mode played, s.
    attracted: f64,
    /// Last time at which there was wind outside attract mode, s.
    blew: f64,
    staff: Vec<CheckedTask>,
}

/// First wind after a visitor's action.
struct Detection {
    /// Index of the entry.
    entry: usize,
    /// Time since the onset, s.
    after_s: f64,
}

/// Log of the day, for its report.
struct Log {
    /// Entries whose onset ended attract mode.
    woke: Vec<usize>,
    /// First wind of each visit, in order.
    detected: Vec<Detection>,
    /// Signal-to-noise ratio of each entry's first breath, dB.
    snr_db: Vec<Option<BreathSnr>>,
    /// Reasons of the detector in the second after each entry's onset, and their numbers of steps.
    detector: Vec<BTreeMap<String, u32>>,
    false_triggers: Vec<FalseTrigger>,
}

impl Log {
    fn new(entries: usize) -> Self {
        Self {
            woke: Vec::new(),
            detected: Vec::new(),
            snr_db: vec![None; entries],
            detector: vec![BTreeMap::new(); entries],
            false_triggers: Vec::new(),
        }
    }

    /// Number of false triggers in the ten seconds before an onset.
    fn false_triggers_before(&self, onset: f64) -> usize {
        let before = onset - UNTOUCHED_S..onset;
        self.false_triggers.iter().filter(|trigger| before.contains(&trigger.at_s)).count()
    }
}

impl<'a> DayRun<'a> {
    fn new(rehearsal: &'a Rehearsal, day: Day, venue: Venue) -> Result<Self, RehearsalError> {
        let video = VideoObserver::new(&rehearsal.exhibits)?;
        let kiosk = KioskUnderTest::new(rehearsal.exhibits[0].clone(), &rehearsal.site, rehearsal.capsules);
        let entries = day.entries.len();
        Ok(Self {
            rehearsal,
            staff: day.staff_tasks.iter().map(|task| CheckedTask { task: *task, good: true }).collect(),
            day,
            venue,
            kiosk,
            video,
            audio: AudioObserver::new(),
            controls: Controls { aspect: ASPECT, ..Controls::default() },
            blocks: 0,
            exhibit: 0,
            made: 0,
            current: 0,
            changes_made: 0,
            attract_checks: 0,
            attract_returns: 0,
            pull_from: None,
            pending: Vec::new(),
            log: Log::new(entries),
            attracted: f64::NEG_INFINITY,
            blew: f64::NEG_INFINITY,
        })
    }

    fn step(&mut self, step: u64) {
        let now = step as f64 / STEPS_PER_SECOND as f64;
        self.programme(now);
        while (self.blocks + 1) * FRAMES as u64 <= step * SAMPLES_PER_STEP {
            self.blocks += 1;
            let recorded = self.venue.next_block(self.kiosk.played());
            self.kiosk.exchange(&recorded);
            for began in self.audio.push(self.kiosk.played(), self.kiosk.played_in_still_air()) {
                self.log_wind(began);
            }
        }
        self.act(now);
        self.try_again(now);
        let plugged = !self.is_in_progress(Task::Unplug, now);
        self.controls.inert = self.is_in_progress(Task::Clean, now);
        for moment in self.pending.iter_mut().filter(|moment| begins(moment.at, now)) {
            moment.control = control_poses(&self.kiosk.stage, &self.controls, picture_at(moment.at));
        }
        self.kiosk.step(&self.controls, plugged);
        if self.kiosk.stage.attracts() {
            self.attracted = now;
        }
        if self.blows() {
            self.blew = now;
        }
        self.log_detection(now);
        self.check_staff(now);
        self.video.record(step + 1, self.exhibit, self.kiosk.stage.snapshot());
        self.request_scores((step + 1) * FPS / STEPS_PER_SECOND);
    }

    fn is_in_progress(&self, task: Task, now: f64) -> bool {
        self.day.staff_tasks.iter().any(|staff| staff.task == task && (staff.from..staff.until).contains(&now))
    }

    /// Starts due visits, staff tasks and changes of the exhibit.
    fn programme(&mut self, now: f64) {
        while let Some(entry) = self.day.entries.get(self.made).filter(|entry| entry.visit.arrives - AHEAD_S <= now) {
            let (capsules, spacing) = (self.venue.capsules(), self.venue.scenario().spacing());
            for (at, sound) in entry.visit.noises(self.venue.scenario(), capsules) {
                self.venue.put(at, sound);
            }
            for breath in &entry.visit.breaths {
                self.venue.put_breath(breath.lips(), breath.sound(capsules, spacing));
            }
            if entry.expects_response()
                && let Some(onset) = entry.visit.onset()
            {
                for (at, action) in [(onset, Some(0)), (entry.shuffled, None)] {
                    let key = Key { entry: self.made, action };
                    self.pending.push(PendingMoment { key, at, control: Vec::new() });
                }
            }
            self.made += 1;
        }
        if let Some(change) = self.day.changes.get(self.changes_made).filter(|change| change.at <= now) {
            self.exhibit = change.exhibit;
            self.kiosk.show(self.rehearsal.exhibits[self.exhibit].clone());
            self.changes_made += 1;
        }
        let muted = self.is_in_progress(Task::Mute, now);
        if muted != self.kiosk.is_muted() {
            self.kiosk.toggle_mute();
        }
        if self.day.attracts.get(self.attract_checks).is_some_and(|at| *at <= now) {
            self.attract_checks += 1;
            self.attract_returns += usize::from(self.kiosk.stage.attracts());
        }
    }

    /// Sets the controls to the actions of the current visitor, as the window would.
    fn act(&mut self, now: f64) {
        while self.day.entries.get(self.current).is_some_and(|entry| entry.visit.leaves < now) {
            self.current += 1;
        }
        self.controls.hold = false;
        self.controls.presses.clear();
        let Some(entry) = self.day.entries.get(self.current).filter(|entry| entry.visit.arrives <= now) else { return };
        let visit = &entry.visit;
        let is_onset = visit.onset().is_some_and(|onset| begins(onset, now));
        if entry.expects_response() && is_onset && self.kiosk.stage.attracts() {
            self.log.woke.push(self.current);
        }
        if let Some(breath) = visit.breaths.first().filter(|breath| begins(breath.onset, now)) {
            self.venue.measure_snr(breath.onset);
        }
        if let Some(aim) = visit.aim.filter(|aim| begins(aim.at, now)) {
            self.controls.aim = Some(aim.point);
            self.controls.activity += 1;
        }
        for (i, pressed) in visit.presses.iter().enumerate().filter(|(_, p)| (p.from..p.until).contains(&now)) {
            let id = 1000 * self.current as u64 + i as u64;
            match pressed.press {
                Press::Key => self.controls.hold = true,
                Press::Finger(at) => self.controls.presses.push(gesture::Press { id, at }),
                Press::Pull { which, by } => {
                    let from = *self
                        .pull_from
                        .get_or_insert_with(|| place(self.kiosk.stage.exhibit(), self.kiosk.stage.snapshot(), which));
                    let part = ((now - pressed.from) / PULL_S).min(1.0);
                    let at = [from[0] + part * by[0] / ASPECT, from[1] + part * by[1]];
                    self.controls.presses.push(gesture::Press { id, at: at.map(|x| x.clamp(0.0, 1.0)) });
                }
            }
        }
        if self.controls.presses.is_empty() {
            self.pull_from = None;
        }
    }

    /// A visitor who has blown and seen no response blows again, unless another visitor comes; that breath is scored too.
    fn try_again(&mut self, now: f64) {
        let comes = self.day.entries.get(self.current + 1).map_or(self.day.length, |next| next.visit.arrives);
        let Some(entry) = self.day.entries.get_mut(self.current).filter(|entry| entry.expects_response()) else {
            return;
        };
        let visit = &mut entry.visit;
        if visit.onset().is_none_or(|onset| self.blew >= onset) {
            return;
        }
        if visit.last_breath_end().is_some_and(|end| begins(end + PATIENCE_S, now))
            && let Some(breath) = visit.retry().filter(|breath| breath.end() + PATIENCE_S < comes)
        {
            let sound = breath.sound(self.venue.capsules(), self.venue.scenario().spacing());
            self.venue.put_breath(breath.lips(), sound);
            visit.leaves = visit.leaves.max(breath.end() + PATIENCE_S);
            visit.breaths.push(breath);
        }
        let begins_now = visit.successive_breaths().skip(1).find(|(_, breath)| begins(breath.onset, now));
        if let Some((action, breath)) = begins_now {
            let key = Key { entry: self.current, action: Some(action) };
            self.pending.push(PendingMoment { key, at: breath.onset, control: Vec::new() });
        }
    }

    /// True where there is wind outside attract mode.
    fn blows(&self) -> bool {
        self.kiosk.stage.snapshot().breath.speed > 0.0 && !self.kiosk.stage.attracts()
    }

    /// Logs wind within a second of the visitor's onset, with the signal-to-noise ratio and the detector's reason.
    fn log_detection(&mut self, now: f64) {
        let onset = self.day.entries.get(self.current).and_then(|entry| entry.visit.onset());
        let Some(onset) = onset.filter(|onset| (*onset..onset + 1.0).contains(&now)) else { return };
        let blows = self.blows();
        let snr_db = &mut self.log.snr_db[self.current];
        if snr_db.is_none() && !self.day.entries[self.current].visit.breaths.is_empty() {
            *snr_db = self.venue.snr_db();
        }
        let reason = self.kiosk.stage.snapshot().breath.estimate.reason;
        *self.log.detector[self.current].entry(format!("{reason:?}")).or_default() += 1;
        if blows && self.log.detected.last().is_none_or(|detection| detection.entry != self.current) {
            self.log.detected.push(Detection { entry: self.current, after_s: now - onset });
        }
    }

    /// Checks the staff tasks: silence while muted, no wind while input is off.
    fn check_staff(&mut self, now: f64) {
        let speed = self.kiosk.stage.snapshot().breath.speed;
        let attracts = self.kiosk.stage.attracts();
        for CheckedTask { task, good } in &mut self.staff {
            if (task.from + TAKES_EFFECT_S..task.until).contains(&now) {
                *good &= match task.task {
                    Task::Mute => self.kiosk.played().iter().all(|sample| *sample == 0.0),
                    Task::Clean | Task::Unplug => speed == 0.0 || attracts,
                };
            }
        }
    }

    /// Logs the beginning of wind as a false trigger, unless it responds to an action or belongs to attract mode.
    fn log_wind(&mut self, began: f64) {
        let near = |entry: &&super::day::Entry| entry.visit.arrives < began + 1.0 && began < entry.visit.leaves + 10.0;
        let mut entries = self.day.entries.iter().filter(near).filter(|entry| entry.expects_response());
        let is_response = entries.any(|entry| {
            entry.visit.action_times().any(|act| act.start < began + EARLY_S && began < act.end + AFTERMATH_S)
        });
        let is_attract = began < self.attracted + AFTERMATH_S;
        if !is_response && !is_attract {
            let (since_s, blew) = (since_last_action(&self.day, began), self.blew > began - EARLY_S);
            self.log.false_triggers.push(FalseTrigger { at_s: began, since_s, blew });
        }
    }

    /// Requests the scores of all moments that need pictures up to `picture` only.
    fn request_scores(&mut self, picture: u64) {
        let due = |moment: &PendingMoment| picture_at(moment.at) + scorer::BEFORE as u64 <= picture;
        while let Some(index) = self.pending.iter().position(due) {
            let PendingMoment { key, at, control } = self.pending.swap_remove(index);
            self.video.request(key, picture_at(at), control);
        }
    }

    fn report(self, rehearsal: &Rehearsal) -> Result<Report, RehearsalError> {
        let Observations { responses, drawn } = self.video.finish()?;
        let shuffled: Vec<Response> =
            responses.iter().filter_map(|(key, response)| response.filter(|_| key.action.is_none())).collect();
        let firsts = responses.iter().filter(|(key, _)| key.action == Some(0));
        let scored = firsts.filter_map(|(Key { entry: index, .. }, response)| {
            let entry = &self.day.entries[*index];
            let onset = entry.visit.onset()?;
            let responds = |onset: f64, response: &Option<Response>| {
                response.is_some_and(|response| response.is_visible()) && self.log.false_triggers_before(onset) == 0
            };
            let at_once = responds(onset, response);
            let later = responses.iter().filter(|(key, _)| key.entry == *index).any(|(key, response)| {
                key.action.is_some_and(|action| action > 0 && responds(entry.visit.breaths[action].onset, response))
            });
            let mut groups = entry.visit.groups();
            groups.extend(entry.after.map(Task::after));
            groups.extend(self.log.woke.contains(index).then_some("wakes it from attract mode"));
            let middle = picture_at(onset) as f64;
            let after = |picture: usize| (middle + picture as f64) / FPS as f64 - onset;
            let scored = ScoredVisit {
                onset_s: onset,
                since_s: since_last_action(&self.day, onset),
                exhibit: rehearsal.exhibits[entry.exhibit].id.clone(),
                snr_db: self.log.snr_db[*index],
                detector: most_frequent(&self.log.detector[*index]),
                detected_after_s: self.log.detected.iter().find(|d| d.entry == *index).map(|d| d.after_s),
                changed_after_s: response.and_then(|r| r.changed).map(after),
                seen_after_s: response.and_then(|r| r.seen).map(after),
                energy: response.map(|response| response.energy),
                contingency: response.map(|response| response.contingency),
                false_triggers: self.log.false_triggers_before(onset),
                breaths: entry.visit.breaths.len(),
                at_once,
                good: at_once || later,
                missed: None,
                groups,
            };
            Some(ScoredVisit { missed: scored.miss(), ..scored })
        });
        let staff = self.staff.iter().map(|CheckedTask { task, good }| StaffCheck {
            task: task.task.name(),
            from_s: task.from,
            good: *good,
        });
        Ok(Report {
            seed: rehearsal.seed,
            hours: rehearsal.hours,
            room: rehearsal.room.clone(),
            capsules: rehearsal.capsules,
            exhibits: rehearsal.exhibits.iter().map(|exhibit| exhibit.id.clone()).collect(),
            volume_db: self.kiosk.volume_db(),
            visitors: self.day.entries.len(),
            headline: VisitShare::default(),
            groups: Default::default(),
            at_once: VisitShare::default(),
            groups_at_once: Default::default(),
            missed: Default::default(),
            changed: VisitShare::default(),
            seen: VisitShare::default(),
            contingency: None,
            shuffled_contingency: None,
            shuffled_share: None,
            changed_after_s: None,
            staff: staff.collect(),
            attract_returned: (self.attract_returns, self.attract_checks),
            pictures: drawn,
            bars: Vec::new(),
            failures: Vec::new(),
            visits: scored.collect(),
            false_triggers: self.log.false_triggers.clone(),
        }
        .conclude(&shuffled))
    }
}

/// Time since the last action of any visitor before `at`, s; `None` before the first.
fn since_last_action(day: &Day, at: f64) -> Option<f64> {
    let actions = day.entries.iter().flat_map(|entry| entry.visit.action_times());
    let last = actions.map(|action| action.end).filter(|end| *end < at).fold(f64::NEG_INFINITY, f64::max);
    last.is_finite().then_some(at - last)
}

/// Counts in descending order.
fn most_frequent(counts: &BTreeMap<String, u32>) -> Vec<(String, u32)> {
    let mut counts: Vec<_> = counts.iter().map(|(reason, count)| (reason.clone(), *count)).collect();
    counts.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
    counts
}

/// True in the step that contains the time `at`.
fn begins(at: f64, now: f64) -> bool {
    let step = 1.0 / STEPS_PER_SECOND as f64;
    (now - step..now).contains(&(at - step))
}

/// Place of one of the plates in the picture; the picture's middle where there is none.
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
    use crate::visitor::{Intent, Visit};
    use soffio_config::Config;
    use soffio_exhibit as exhibit;
    use soffio_kiosk::venue::site::Site;
    use soffio_math::noise::Random;

    #[test]
    fn a_visitor_who_is_not_detected_blows_again_and_each_breath_is_scored() {
        /// Three breaths of two seconds at most, with their pauses.
        const LENGTH_S: f64 = 32.0;
        /// Distance at which no breath is detected.
        const FAR_M: f64 = 30.0;
        /// Pictures of the second before, the second after, and the moment itself.
        const PICTURES: u64 = 2 * scorer::BEFORE as u64 + 1;
        let folder = exhibit::resolve("steel-fish").expect("a shipped exhibit");
        let exhibit = Arc::new(exhibit::load(&folder).expect("a valid exhibit"));
        let site = Site::new(&Config::default(), 1);
        let (hours, room) = (LENGTH_S / 3600.0, "gallery".into());
        let mut rehearsal =
            Rehearsal { exhibits: vec![exhibit], site, room, capsules: 2, crowd: Crowd::Made, hours, seed: 1 };
        let venue = open_venue(&mut rehearsal).expect("a room");
        let mut visit = Visit::of(Intent::Blows, 1.0, 0.0, &mut Random::new(1));
        visit.breaths.truncate(1);
        visit.breaths[0].recipe.distance = FAR_M;
        visit.leaves = visit.breaths[0].end() + PATIENCE_S + 0.5;
        let entries = vec![Entry { visit, exhibit: 0, during: None, after: None, shuffled: 0.5 * LENGTH_S }];
        let day = Day { entries, length: LENGTH_S, ..Day::default() };
        let mut run = DayRun::new(&rehearsal, day, venue).expect("a driver");
        (0..(LENGTH_S * STEPS_PER_SECOND as f64) as u64).for_each(|step| run.step(step));
        let report = run.report(&rehearsal).expect("pictures");
        let visit = &report.visits[0];
        assert!(visit.breaths == 3 && !visit.good && visit.detected_after_s.is_none(), "{visit:?}");
        assert!(
            report.pictures >= 4 * PICTURES,
            "{} pictures: of each breath, and of a random moment",
            report.pictures
        );
    }
}

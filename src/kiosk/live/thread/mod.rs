//! The thread itself: hears, steps, sounds and publishes, in this order, as often as a step is due.

mod changes;

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Instant;

use cpu_time::ThreadTime;

use super::{Frame, Load, Onset, Options, Report, Shared, lock, trace_error};
use crate::live::pace::Pacer;
use crate::live::recording::Recording;
use crate::step::breaths::{Breaths, Turn};
use crate::step::captions::Captions;
use crate::step::governor::Governor;
use crate::step::moments::Moments;
use crate::step::stage::{Controls, Stage};
use crate::step::stillness::Stillness;
use crate::step::voice::{Guest, Trial, Voice};
use crate::venue::chirping::{Act, Course};
use crate::venue::loudness::{Loudness, Wishes};
use crate::venue::site::Site;
use changes::voice;
use soffio_devices::audio::{AudioIo, Heard};
use soffio_devices::controllers::{Controllers, Reading};
use soffio_math::from_decibels;
use soffio_offline::trace::TraceWriter;
use soffio_simulation::{Inspection, Look, MotionMode, STEPS_PER_SECOND};
use soffio_sound::SoundCommand;

/// What lives on the simulation thread.
pub(super) struct Thread {
    stage: Stage,
    trace: Option<TraceWriter>,
    record: Option<Recording>,
    mode: Option<MotionMode>,
    audio: AudioIo,
    voice: Voice,
    /// The timbre that staff try beside the exhibit's own, and what is to be heard when it has come.
    guest: Option<Guest>,
    trial: Option<Trial>,
    site: Site,
    loudness: Loudness,
    controllers: Controllers,
    shared: Arc<Shared>,
    wake: Box<dyn Fn() + Send>,
    stillness: Stillness,
    /// Was everything still when it was last published?
    still: bool,
    limit: u64,
    recorded: bool,
    moments: Moments,
    heard: Heard,
    sounds: Vec<SoundCommand>,
    breaths: Breaths,
    chirping: Course,
    began: Instant,
    captions: Captions,
    deaf: bool,
    closed: bool,
    onset: Option<Onset>,
    /// The step that was published last.
    published: u64,
    load: Load,
    governor: Governor,
    inspection: Option<Arc<Inspection>>,
}

impl Thread {
    pub(super) fn new(
        stage: Stage,
        (trace, record): (Option<TraceWriter>, Option<Recording>),
        options: Options,
        (shared, wake): (Arc<Shared>, Box<dyn Fn() + Send>),
    ) -> Self {
        let site = options.site;
        let voice = voice(&site);
        let audio =
            AudioIo::start_with(&site.audio, site.breath && !options.closed, voice.synth(&options.exhibit, None));
        Self {
            moments: Moments::new(stage.snapshot()),
            stage,
            trace,
            record,
            mode: options.mode,
            audio,
            voice,
            guest: None,
            trial: None,
            loudness: Loudness::new(site.volume, site.night.clone(), site.silent_attract),
            controllers: Controllers::start(&site.controllers),
            site,
            shared,
            wake,
            stillness: Stillness::default(),
            still: false,
            limit: options.steps.unwrap_or(u64::MAX),
            recorded: options.recording.is_some(),
            heard: Heard::default(),
            sounds: Vec::new(),
            breaths: Breaths::default(),
            chirping: Course::default(),
            began: Instant::now(),
            captions: Captions::default(),
            deaf: false,
            closed: options.closed,
            onset: None,
            published: 0,
            load: Load::default(),
            governor: Governor::new(options.exhibit.motion),
            inspection: None,
        }
    }

    pub(super) fn run(mut self) -> Result<Report, String> {
        self.write_trace()?;
        let began = Instant::now();
        let mut pacer = Pacer::default();
        while self.stage.steps() < self.limit && !self.shared.stop.load(Ordering::Relaxed) {
            let due = pacer.due(began.elapsed()).min(self.limit - self.stage.steps());
            if due > 0 {
                let hears = self.advance(due)?;
                self.load.dropped = pacer.dropped();
                self.publish(began + pacer.present(), hears);
            }
            std::thread::sleep(pacer.next().saturating_sub(began.elapsed()));
        }
        if let Some(trace) = self.trace.take() {
            trace.finish().map_err(trace_error)?;
        }
        if let Some(mut record) = self.record.take() {
            record.end(&self.stage);
            record.finish();
        }
        Ok(Report {
            steps: self.stage.steps(),
            dropped: pacer.dropped(),
            xruns: self.audio.status().xruns,
            level_dba: Some(self.loudness.view().level_db[1]).filter(|level| level.is_finite()),
            impacts: self.stage.snapshot().diagnostics.impacts,
            state_hash: self.stage.state_hash(),
        })
    }

    /// Does `due` steps with all that the microphone has heard by now. Says whether anything listens.
    fn advance(&mut self, due: u64) -> Result<bool, String> {
        let mut controls = {
            let mut shared = lock(&self.shared.controls);
            let taken = shared.clone();
            shared.commands.clear();
            shared.exhibit = None;
            shared.site = None;
            shared.trials.clear();
            shared.lifts.clear();
            shared.words = None;
            shared.chirp = false;
            shared.loudness = Wishes::default();
            taken
        };
        if let Some(site) = controls.site.take() {
            self.settle(*site);
        }
        if let Some(exhibit) = controls.exhibit.take() {
            self.swap(exhibit);
        }
        add(&mut controls, &self.controllers.reading(), self.site.controllers.stick_speed);
        self.heard.clear();
        self.closed = controls.closed;
        if controls.chirp && self.site.breath {
            self.chirping.begin(self.began.elapsed().as_secs_f64());
        }
        self.audio.listen(self.site.breath && !self.closed || self.chirping.runs());
        self.deaf = controls.deaf;
        let rate = self.audio.read_microphone(&mut self.heard);
        let chirps = self.chirp(rate);
        // What a visitor does not want to be heard is read all the same, so that it is gone.
        let rate = rate.filter(|_| !self.deaf && !chirps);
        self.sounds.clear();
        let before = Instant::now();
        for i in 0..due {
            let microphone = rate.map(|sample_rate| self.heard.share(i, due, sample_rate));
            controls.mode = self.mode.or(self.governor.mode());
            let worked = ThreadTime::now();
            self.stage.step(&controls, microphone);
            self.moments.push(self.stage.snapshot());
            self.stillness.note(self.stage.exhibit(), self.stage.snapshot(), self.stage.sight());
            self.govern(worked.elapsed().as_secs_f64());
            controls.commands.clear();
            if let Some(record) = &mut self.record {
                record.note(&self.stage);
            }
            controls.lifts.clear();
            self.sounds.extend_from_slice(self.stage.sounds());
            self.captions.note(self.stage.exhibit(), self.stage.sounds(), self.stage.steps());
            self.write_trace()?;
            if !self.deaf {
                self.load.microphone.note(rate.is_some(), &self.stage.snapshot().breath.estimate);
            }
            let (step, breath) = (self.stage.steps(), &self.stage.snapshot().breath);
            for turn in self.breaths.note(step, breath, (self.stage.holds(), controls.strength), self.stage.attracts())
            {
                self.load.blows.note(&turn);
                if matches!(turn, Turn::Begins(..)) {
                    self.onset = Some(Onset { step: self.stage.snapshot().step, at: Instant::now() });
                }
                tracing::info!("{:.3} s: {turn}", step as f64 / STEPS_PER_SECOND as f64);
            }
        }
        let each = before.elapsed().as_secs_f64() / due as f64;
        self.load.step_s += 0.02 * (each - self.load.step_s);
        self.try_sounds(controls.trials.pop());
        self.audio.send(self.stage.sample(), &self.sounds);
        if let Some(words) = controls.words.take() {
            self.audio.say(&words);
        }
        self.loudness.tend(controls.loudness, (self.stage.attracts(), controls.closed), self.audio.knobs());
        if chirps {
            self.audio.knobs().set_volume(from_decibels(self.site.audio.volume_db) as f32);
        }
        self.inspection = (controls.look != Look::Nothing).then(|| Arc::new(self.stage.inspect(controls.look)));
        Ok(rate.is_some() && !self.load.microphone.is_silent() || self.recorded)
    }

    /// Goes on with a chirp, where one is on its way; says whether there was one.
    fn chirp(&mut self, rate: Option<u32>) -> bool {
        if !self.chirping.runs() {
            return false;
        }
        let now = self.began.elapsed().as_secs_f64();
        match self.chirping.tend(now, &self.audio.status(), (&self.heard.samples, rate)) {
            Some(Act::Say(words)) => self.audio.say(&words),
            Some(Act::Done(outcome)) => {
                self.load.chirp = (self.load.chirp.0 + 1, Some(Arc::new(outcome)));
                // The hours, or the visitor's keys, say how loud it is again.
                self.loudness.forget();
            }
            None => {}
        }
        true
    }

    /// Looks whether the laws can go on.
    fn govern(&mut self, cost: f64) {
        if self.mode.is_none() && self.governor.note(cost) {
            self.load.mode_changes += 1;
            let mode = self.governor.mode().unwrap_or_default().name();
            let t = self.stage.steps() as f64 / STEPS_PER_SECOND as f64;
            tracing::info!("{t:.3} s: moved by {mode} from here (a step took {:.3} ms)", 1e3 * cost);
        }
    }

    fn write_trace(&mut self) -> Result<(), String> {
        match &mut self.trace {
            Some(trace) => trace.push(self.stage.snapshot()).map_err(trace_error),
            None => Ok(()),
        }
    }

    fn publish(&mut self, due: Instant, hears: bool) {
        self.load.audio = self.audio.status();
        self.load.played = self.audio.played();
        self.load.loudness = self.loudness.view();
        self.load.mode = self.stage.snapshot().diagnostics.mode;
        self.load.controllers.clear();
        self.load.controllers.extend(self.controllers.states().map(|(kind, state)| (kind.name(), state)));
        if let Some(onset) = &mut self.onset
            && onset.step > self.published
        {
            onset.at = Instant::now();
        }
        self.published = self.stage.snapshot().step;
        // In attract mode the camera sways.
        let still = self.stillness.is_still() && !self.stage.attracts();
        let wakes = self.still && !still;
        self.still = still;
        let frame = Arc::new(Frame {
            still,
            exhibit: self.stage.exhibit().clone(),
            current: self.moments.newest().clone(),
            moments: self.moments.clone(),
            due,
            attracts: self.stage.attracts(),
            attract_text: self.stage.attract_text().map(str::to_owned),
            attract_rounds: self.stage.attract_course().0,
            leaves_in: self.stage.attract_course().1,
            captions: self.captions.shown(self.stage.exhibit(), self.stage.steps()),
            turned: self.stage.turned(),
            speaks: self.audio.speaks(),
            deaf: self.deaf,
            hears,
            onset: self.onset,
            load: self.load.clone(),
            inspection: self.inspection.clone(),
        });
        *lock(&self.shared.frame) = frame;
        if wakes {
            (self.wake)();
        }
    }
}

/// Joins what the controllers say to what the window tells.
fn add(controls: &mut Controls, reading: &Reading, stick_speed: f64) {
    controls.hold |= reading.hold;
    controls.strength = reading.strength;
    controls.named = reading.aim;
    for (speed, tilt) in controls.stick.iter_mut().zip(reading.stick) {
        *speed += stick_speed * tilt;
    }
    controls.activity += reading.activity;
}

//! The simulation thread: the wall clock, the microphone and the loudspeaker around a [`Stage`].
//!
//! The thread wakes at step boundaries, consumes everything that the microphone has delivered since (spread evenly
//! over the steps due, so that the way from breath to wind never grows), steps, and publishes. The window never
//! waits for a step and the simulation never for a picture: both sides share two small values under a mutex held
//! for a copy. Only the clock, the devices and the trace file are here; what a step does is in [`Stage`].

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;
use std::time::Instant;

use cpu_time::ThreadTime;

use crate::audio_io::{AudioIo, AudioStatus, DeviceState, Heard};
use crate::controllers::{Controllers, Reading, State};
use crate::exhibit::Exhibit;
use crate::math::from_decibels;
use crate::offline::feed::WavFeed;
use crate::offline::trace::{DEFAULT_FPS, TraceWriter};
use crate::simulation::{Inspection, Look, MotionMode, STEPS_PER_SECOND, Settings, Snapshot};
use crate::sound::SoundCommand;

use super::breaths::{Blows, Breaths, Turn};
use super::captions::Captions;
use super::chirping::{Act, Course, Outcome};
use super::governor::Governor;
use super::loudness::{Loudness, View, Wishes};
use super::microphone::MicrophoneHealth;
use super::moments::{BEHIND, Moments};
use super::pace::Pacer;
use super::recording::Recording;
use super::rest::Stillness;
use super::site::Site;
use super::stage::{Controls, Stage};
use super::voice::{Guest, Trial, Voice};

mod changes;

use changes::voice;

/// What a run is made of.
pub struct Options {
    /// What is shown first.
    pub exhibit: Arc<Exhibit>,
    /// What the site says.
    pub site: Site,
    /// Is the house closed when the run begins?
    pub closed: bool,
    /// A recording in the microphone's place.
    pub recording: Option<WavFeed>,
    /// End after so many steps.
    pub steps: Option<u64>,
    /// Where the trace goes.
    pub trace: Option<PathBuf>,
    /// Where the record goes.
    pub record: Option<PathBuf>,
    /// What moves the exhibits; `None` is their own choice.
    pub mode: Option<MotionMode>,
}

/// What the window sees of the simulation.
#[derive(Clone)]
pub struct Frame {
    /// What is shown. Another `Arc` means: another exhibit.
    pub exhibit: Arc<Exhibit>,
    /// The last step.
    pub current: Arc<Snapshot>,
    /// That one and those before it.
    pub moments: Moments,
    /// When the last step was due.
    pub due: Instant,
    /// Has nothing in the picture moved for a while?
    pub still: bool,
    /// Is attract mode playing?
    pub attracts: bool,
    /// Text key that attract mode shows.
    pub attract_text: Option<String>,
    /// Rounds of its script that have ended.
    pub attract_rounds: u32,
    /// Seconds until attract mode begins, where they are few.
    pub leaves_in: Option<f64>,
    /// Keys of the captions of what can be heard.
    pub captions: Vec<String>,
    /// Works that visitors have swiped on so far, less those that they have swiped back.
    pub turned: i64,
    /// Is the loudspeaker saying words?
    pub speaks: bool,
    /// Has the visitor switched the microphone off?
    pub deaf: bool,
    /// Is there a microphone, or a recording in its place?
    pub hears: bool,
    /// When the last breath began.
    pub onset: Option<Onset>,
    /// For staff.
    pub load: Load,
    /// What staff look at; `None` where nobody does.
    pub inspection: Option<Arc<Inspection>>,
}

/// The beginning of a breath, from whatever source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Onset {
    /// The first step with wind, as its snapshot counts.
    pub step: u64,
    /// When that step was published.
    pub at: Instant,
}

/// How the thread is doing.
#[derive(Clone, Debug, Default)]
pub struct Load {
    /// Mean time of a step lately, s.
    pub step_s: f64,
    /// Steps of time that were dropped so far.
    pub dropped: u64,
    /// How the microphone does.
    pub microphone: MicrophoneHealth,
    /// What the devices say.
    pub audio: AudioStatus,
    /// Frames that the loudspeaker has played; `None` where there is none.
    pub played: Option<u64>,
    /// How loud it is.
    pub loudness: View,
    /// What moves the exhibit.
    pub mode: MotionMode,
    /// Changes between motion by the laws and by places so far.
    pub mode_changes: u64,
    /// Breaths that began so far.
    pub blows: Blows,
    /// What the controllers say, by kind.
    pub controllers: Vec<(&'static str, State)>,
    /// Chirps so far, and what came of the last one.
    pub chirp: (u64, Option<Arc<Outcome>>),
}

impl Frame {
    /// The stage as it stands: nobody there, nothing heard.
    pub fn new(stage: &Stage) -> Self {
        let moments = Moments::new(stage.snapshot());
        Self {
            exhibit: stage.exhibit().clone(),
            current: moments.newest().clone(),
            moments,
            due: Instant::now(),
            still: false,
            attracts: false,
            attract_text: None,
            attract_rounds: 0,
            leaves_in: None,
            captions: Vec::new(),
            turned: 0,
            speaks: false,
            deaf: false,
            hears: false,
            onset: None,
            load: Load::default(),
            inspection: None,
        }
    }

    /// Is it certain that no breath is heard? A microphone that is still being opened is not missing.
    pub fn is_deaf(&self) -> bool {
        !self.hears
            && !self.deaf
            && (self.load.microphone.is_silent()
                || matches!(self.load.audio.input, DeviceState::Missing(_) | DeviceState::Closed))
    }

    /// Is it certain that there is no loudspeaker?
    pub fn is_mute(&self) -> bool {
        matches!(self.load.audio.output, DeviceState::Missing(_))
    }

    /// Sets `moment` to what a picture shows whose time is `shown`.
    pub fn set_moment(&self, shown: Instant, moment: &mut Snapshot) {
        let early = self.due.saturating_duration_since(shown).as_secs_f64();
        let since = shown.saturating_duration_since(self.due).as_secs_f64() - early;
        self.moments.before(BEHIND - since * STEPS_PER_SECOND as f64, moment);
    }
}

/// How a run ended.
#[derive(Clone, Debug, Default, serde::Serialize)]
pub struct Report {
    /// Steps done.
    pub steps: u64,
    /// Steps of time that were dropped because the machine was too slow.
    pub dropped: u64,
    /// Impacts of the last exhibit.
    pub impacts: u64,
    /// Gaps of microphone and loudspeaker.
    pub xruns: u64,
    /// A-weighted mean level of all that was played, dB of a full-scale sine; null for silence.
    pub level_dba: Option<f64>,
    /// Says whether two runs are the same run.
    #[serde(serialize_with = "hex")]
    pub state_hash: u64,
}

/// A running simulation.
pub struct Live {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<Result<Report, String>>>,
}

struct Shared {
    controls: Mutex<Controls>,
    frame: Mutex<Arc<Frame>>,
    stop: AtomicBool,
}

impl Live {
    /// Starts the thread, for a picture of this shape (width over height). `wake` is called in the step in which what stood
    /// still begins to move.
    pub fn start(options: Options, aspect: f64, wake: impl Fn() + Send + 'static) -> Result<Self, String> {
        let site = &options.site;
        let settings = Settings { clock: local_time(), ..site.settings };
        let stage = Stage::new(options.exhibit.clone(), settings, options.recording.clone(), site.idle_s);
        let trace = match &options.trace {
            Some(path) => Some(TraceWriter::create(path, &options.exhibit, DEFAULT_FPS).map_err(trace_error)?),
            None => None,
        };
        let mut record = options.record.as_deref().map(Recording::create).transpose()?;
        if let Some(record) = &mut record {
            record.begin(&options.exhibit, settings);
        }
        let frame = Frame { hears: options.recording.is_some(), ..Frame::new(&stage) };
        let shared = Arc::new(Shared {
            controls: Mutex::new(Controls {
                aspect,
                closed: options.closed,
                inert: options.closed,
                ..Controls::default()
            }),
            frame: Mutex::new(Arc::new(frame)),
            stop: AtomicBool::new(false),
        });
        let theirs = shared.clone();
        let thread = std::thread::Builder::new()
            .name("simulation".into())
            .spawn(move || Thread::new(stage, (trace, record), options, (theirs, Box::new(wake))).run())
            .map_err(|error| format!("the simulation thread does not start: {error}"))?;
        Ok(Self { shared, thread: Some(thread) })
    }

    /// What the visitor does. Hold it briefly.
    pub fn controls(&self) -> MutexGuard<'_, Controls> {
        lock(&self.shared.controls)
    }

    /// The latest moments.
    pub fn frame(&self) -> Arc<Frame> {
        lock(&self.shared.frame).clone()
    }

    /// Has the run ended by itself?
    pub fn is_over(&self) -> bool {
        self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// Ends the run and waits for its files.
    pub fn finish(mut self) -> Result<Report, String> {
        self.join().unwrap_or_else(|| Ok(Report::default()))
    }

    fn join(&mut self) -> Option<Result<Report, String>> {
        self.shared.stop.store(true, Ordering::Relaxed);
        let ended = self.thread.take()?.join();
        Some(ended.unwrap_or_else(|_| Err("the simulation thread died; see the log above".into())))
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        self.join();
    }
}

/// A poisoned lock holds a whole value all the same: every writer replaces it at once.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// What lives on the simulation thread.
struct Thread {
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
    fn new(
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

    fn run(mut self) -> Result<Report, String> {
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

/// Seconds after midnight, by the clock on the wall.
fn local_time() -> Option<f64> {
    let now = jiff::Zoned::now();
    Some(f64::from(3600 * i32::from(now.hour()) + 60 * i32::from(now.minute()) + i32::from(now.second())))
}

/// A hash as text: JSON numbers lose bits beyond 2⁵³.
fn hex<S: serde::Serializer>(hash: &u64, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&format!("{hash:016x}"))
}

fn trace_error(error: std::io::Error) -> String {
    format!("the trace cannot be written: {error}")
}

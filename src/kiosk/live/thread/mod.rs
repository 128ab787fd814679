//! The thread itself: reads the microphone, steps, plays sounds and publishes, in this order, whenever a step is due.

mod files;
mod microphone_input;
mod motion;
mod playback;
mod publisher;

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Instant;

use cpu_time::ThreadTime;

use super::live_state::LiveState;
use super::options::{Options, Report};
use super::shared::{Shared, local_time, lock};
use super::step_scheduler::StepScheduler;
use crate::step::command::Batch;
use crate::step::controls::Controls;
use crate::step::stage::Stage;
use crate::venue::loudness::KioskActivity;
use crate::venue::site::Site;
pub(super) use files::Files;
use microphone_input::MicrophoneInput;
use motion::MotionChoice;
use playback::Playback;
use publisher::Publisher;
use soffio_devices::controllers::{Controllers, Reading};
use soffio_exhibit::Exhibit;
use soffio_simulation::{InspectionScope, Settings};

/// State of the simulation thread.
pub(super) struct Thread {
    stage: Stage,
    site: Site,
    limit: u64,
    recorded: bool,
    files: Files,
    motion: MotionChoice,
    playback: Playback,
    microphone: MicrophoneInput,
    controllers: Controllers,
    publisher: Publisher,
    shared: Arc<Shared>,
    wake: Box<dyn Fn() + Send>,
}

impl Thread {
    pub(super) fn new(
        stage: Stage,
        files: Files,
        options: Options,
        shared: Arc<Shared>,
        wake: Box<dyn Fn() + Send>,
    ) -> Self {
        let site = options.site;
        Self {
            publisher: Publisher::new(&stage),
            stage,
            limit: options.steps.unwrap_or(u64::MAX),
            recorded: options.recording.is_some(),
            files,
            motion: MotionChoice::new(options.mode, &options.exhibit),
            playback: Playback::start(&site, &options.exhibit, options.closed),
            microphone: MicrophoneInput::new(options.closed),
            controllers: Controllers::start(&site.controllers),
            site,
            shared,
            wake,
        }
    }

    pub(super) fn run(mut self) -> Result<Report, String> {
        self.files.write_trace(&self.stage)?;
        let began = Instant::now();
        let mut pacer = StepScheduler::default();
        while self.stage.steps() < self.limit && !self.shared.stop.load(Ordering::Relaxed) {
            let due = pacer.due(began.elapsed()).min(self.limit - self.stage.steps());
            if due > 0 {
                let hears = self.advance(due)?;
                self.publisher.load.dropped = pacer.dropped();
                self.publish(began + pacer.present(), hears);
            }
            std::thread::sleep(pacer.next().saturating_sub(began.elapsed()));
        }
        self.files.finish(&self.stage)?;
        Ok(Report {
            steps: self.stage.steps(),
            dropped: pacer.dropped(),
            xruns: self.playback.audio.status().xruns,
            level_dba: Some(self.playback.loudness.status().level_db[1]).filter(|level| level.is_finite()),
            impacts: self.stage.snapshot().diagnostics.impacts,
            state_hash: self.stage.state_hash(),
        })
    }

    /// Does `due` steps with all samples of the microphone so far; the first step takes the commands. Returns whether there is a
    /// microphone or a recording.
    fn advance(&mut self, due: u64) -> Result<bool, String> {
        let (mut controls, batch, dropped) = {
            let mut inbox = lock(&self.shared.inbox);
            let (controls, batch) = inbox.take();
            (controls, batch, inbox.dropped())
        };
        self.publisher.record_dropped(dropped);
        let Batch { site, exhibit, self_test, lifts, commands, audition, speech, loudness } = batch;
        if let Some(site) = site {
            self.reconfigure(*site);
        }
        if let Some(exhibit) = exhibit {
            self.swap(exhibit);
        }
        add_controllers(&mut controls, &self.controllers.reading(), self.site.controllers.stick_speed);
        lifts.into_iter().for_each(|lift| self.stage.lift(lift));
        commands.into_iter().for_each(|command| self.stage.command(command));
        self.microphone.closed = controls.closed;
        if self_test && self.site.breath {
            self.microphone.begin_self_test();
        }
        self.microphone.ignore_microphone = controls.ignore_microphone;
        let (rate, is_testing) = self.microphone.read(self.site.breath, &mut self.playback, &mut self.publisher.load);
        self.playback.sounds.clear();
        let before = Instant::now();
        for i in 0..due {
            let samples = rate.map(|sample_rate| self.microphone.samples_read.share(i, due, sample_rate));
            controls.mode = self.motion.mode();
            let worked = ThreadTime::now();
            self.stage.step(&controls, samples);
            self.publisher.record_step(&self.stage);
            let cost = worked.elapsed().as_secs_f64();
            self.motion.govern(cost, self.stage.steps(), &mut self.publisher.load);
            self.files.record(&self.stage);
            self.playback.sounds.extend_from_slice(self.stage.sounds());
            self.publisher.record_sounds(&self.stage);
            self.files.write_trace(&self.stage)?;
            if !self.microphone.ignore_microphone {
                self.publisher.load.microphone.update(rate.is_some(), &self.stage.snapshot().breath.estimate);
            }
            self.publisher.record_breaths(&self.stage, controls.strength);
        }
        // Samples are kept no longer than the steps that need them.
        self.microphone.samples_read.clear();
        self.publisher.record_time(before, due);
        self.playback.play_audition(audition, &self.stage);
        self.playback.send(&self.stage);
        if let Some(speech) = speech {
            self.playback.audio.say(&speech);
        }
        let self_test_db = is_testing.then_some(self.site.audio.volume_db);
        let activity = KioskActivity { attracts: self.stage.attracts(), closed: controls.closed };
        self.playback.set_loudness(loudness, activity, self_test_db);
        let look = controls.look;
        self.publisher.inspection = (look != InspectionScope::Nothing).then(|| Arc::new(self.stage.inspect(look)));
        Ok(rate.is_some() && !self.publisher.load.microphone.is_silent() || self.recorded)
    }

    /// Takes over a changed configuration. Only devices and threads with changed settings restart.
    fn reconfigure(&mut self, site: Site) {
        let before = std::mem::replace(&mut self.site, site);
        self.playback.reconfigure(&before, &self.site, self.stage.exhibit(), self.microphone.closed);
        if before.controllers != self.site.controllers {
            self.controllers = Controllers::start(&self.site.controllers);
        }
        let changed = before.settings != self.site.settings;
        if changed {
            self.files.end(&self.stage);
        }
        self.stage.reconfigure(Settings { clock: local_time(), ..self.site.settings }, self.site.idle_s);
        if changed {
            self.restart();
        }
    }

    /// Starts another exhibit with its own sounds.
    fn swap(&mut self, exhibit: Arc<Exhibit>) {
        self.playback.swap(&exhibit);
        self.motion.swap(&exhibit);
        self.files.end(&self.stage);
        self.stage.swap(exhibit, local_time());
        self.restart();
    }

    fn restart(&mut self) {
        self.files.begin(&self.stage);
        self.publisher.restart(&self.stage);
    }

    fn publish(&mut self, due: Instant, hears: bool) {
        let (audio, load) = (&self.playback.audio, &mut self.publisher.load);
        load.audio = audio.status();
        load.played = audio.played();
        load.loudness = self.playback.loudness.status();
        load.ambient_spread = self.stage.ambient_spread();
        load.mode = self.stage.snapshot().diagnostics.mode;
        load.controllers.clear();
        load.controllers.extend(self.controllers.states().map(|(kind, state)| (kind.name(), state)));
        let (frame, wakes) = self.publisher.frame(&self.stage, due);
        let frame = Arc::new(LiveState {
            speaks: audio.speaks(),
            ignore_microphone: self.microphone.ignore_microphone,
            hears,
            ..frame
        });
        *lock(&self.shared.frame) = frame;
        if wakes {
            (self.wake)();
        }
    }
}

/// Adds the readings of the controllers to the controls of the window.
fn add_controllers(controls: &mut Controls, reading: &Reading, stick_speed: f64) {
    controls.hold |= reading.hold;
    controls.strength = reading.strength;
    controls.named = reading.aim;
    for (speed, tilt) in controls.stick.iter_mut().zip(reading.stick) {
        *speed += stick_speed * tilt;
    }
    controls.activity += reading.activity;
}

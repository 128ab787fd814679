//! The thread itself: hears, steps, sounds and publishes, in this order, as often as a step is due.

mod account;
mod files;
mod listening;
mod motion;
mod playback;

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::Instant;

use cpu_time::ThreadTime;

use super::frame::Frame;
use super::options::{Options, Report};
use super::pace::Pacer;
use super::recording::Recording;
use super::shared::{Shared, local_time, lock};
use crate::step::command::Batch;
use crate::step::controls::Controls;
use crate::step::stage::Stage;
use crate::venue::site::Site;
use account::Account;
use files::Files;
use listening::Listening;
use motion::MotionChoice;
use playback::Playback;
use soffio_devices::controllers::{Controllers, Reading};
use soffio_exhibit::Exhibit;
use soffio_offline::trace::TraceWriter;
use soffio_simulation::{InspectionScope, Settings};

/// What lives on the simulation thread.
pub(super) struct Thread {
    stage: Stage,
    site: Site,
    limit: u64,
    recorded: bool,
    files: Files,
    motion: MotionChoice,
    playback: Playback,
    listening: Listening,
    controllers: Controllers,
    account: Account,
    shared: Arc<Shared>,
    wake: Box<dyn Fn() + Send>,
}

impl Thread {
    pub(super) fn new(
        stage: Stage,
        (trace, record): (Option<TraceWriter>, Option<Recording>),
        options: Options,
        (shared, wake): (Arc<Shared>, Box<dyn Fn() + Send>),
    ) -> Self {
        let site = options.site;
        Self {
            account: Account::new(&stage),
            stage,
            limit: options.steps.unwrap_or(u64::MAX),
            recorded: options.recording.is_some(),
            files: Files { trace, record },
            motion: MotionChoice::new(options.mode, options.exhibit.motion),
            playback: Playback::start(&site, &options.exhibit, options.closed),
            listening: Listening::new(options.closed),
            controllers: Controllers::start(&site.controllers),
            site,
            shared,
            wake,
        }
    }

    pub(super) fn run(mut self) -> Result<Report, String> {
        self.files.write_trace(&self.stage)?;
        let began = Instant::now();
        let mut pacer = Pacer::default();
        while self.stage.steps() < self.limit && !self.shared.stop.load(Ordering::Relaxed) {
            let due = pacer.due(began.elapsed()).min(self.limit - self.stage.steps());
            if due > 0 {
                let hears = self.advance(due)?;
                self.account.load.dropped = pacer.dropped();
                self.publish(began + pacer.present(), hears);
            }
            std::thread::sleep(pacer.next().saturating_sub(began.elapsed()));
        }
        self.files.finish(&self.stage)?;
        Ok(Report {
            steps: self.stage.steps(),
            dropped: pacer.dropped(),
            xruns: self.playback.audio.status().xruns,
            level_dba: Some(self.playback.loudness.view().level_db[1]).filter(|level| level.is_finite()),
            impacts: self.stage.snapshot().diagnostics.impacts,
            state_hash: self.stage.state_hash(),
        })
    }

    /// Does `due` steps with all that the microphone has heard by now; the first of them takes the commands. Says whether
    /// anything listens.
    fn advance(&mut self, due: u64) -> Result<bool, String> {
        let (mut controls, batch, dropped) = {
            let mut inbox = lock(&self.shared.inbox);
            let (controls, batch) = inbox.take();
            (controls, batch, inbox.dropped())
        };
        self.account.note_dropped(dropped);
        let Batch { site, exhibit, chirp, lifts, commands, trial, words, loudness } = batch;
        if let Some(site) = site {
            self.settle(*site);
        }
        if let Some(exhibit) = exhibit {
            self.swap(exhibit);
        }
        add(&mut controls, &self.controllers.reading(), self.site.controllers.stick_speed);
        lifts.into_iter().for_each(|lift| self.stage.lift(lift));
        commands.into_iter().for_each(|command| self.stage.command(command));
        self.listening.heard.clear();
        self.listening.closed = controls.closed;
        if chirp && self.site.breath {
            self.listening.begin_chirp();
        }
        self.listening.deaf = controls.deaf;
        let (rate, chirps) = self.listening.hear(self.site.breath, &mut self.playback, &mut self.account.load);
        self.playback.sounds.clear();
        let before = Instant::now();
        for i in 0..due {
            let microphone = rate.map(|sample_rate| self.listening.heard.share(i, due, sample_rate));
            controls.mode = self.motion.mode();
            let worked = ThreadTime::now();
            self.stage.step(&controls, microphone);
            self.account.note_moment(&self.stage);
            let cost = worked.elapsed().as_secs_f64();
            self.motion.govern(cost, self.stage.steps(), &mut self.account.load);
            self.files.note(&self.stage);
            self.playback.sounds.extend_from_slice(self.stage.sounds());
            self.account.note_sounds(&self.stage);
            self.files.write_trace(&self.stage)?;
            if !self.listening.deaf {
                self.account.load.microphone.note(rate.is_some(), &self.stage.snapshot().breath.estimate);
            }
            self.account.note_breath(&self.stage, controls.strength);
        }
        self.account.note_time(before, due);
        self.playback.try_sounds(trial, &self.stage);
        self.playback.send(&self.stage);
        if let Some(words) = words {
            self.playback.audio.say(&words);
        }
        let chirp_at_db = chirps.then_some(self.site.audio.volume_db);
        self.playback.set_loudness(loudness, (self.stage.attracts(), controls.closed), chirp_at_db);
        let look = controls.look;
        self.account.inspection = (look != InspectionScope::Nothing).then(|| Arc::new(self.stage.inspect(look)));
        Ok(rate.is_some() && !self.account.load.microphone.is_silent() || self.recorded)
    }

    /// Takes over a changed configuration: of the devices and threads only what differs begins anew.
    fn settle(&mut self, site: Site) {
        let before = std::mem::replace(&mut self.site, site);
        self.playback.settle(&before, &self.site, self.stage.exhibit(), self.listening.closed);
        if before.controllers != self.site.controllers {
            self.controllers = Controllers::start(&self.site.controllers);
        }
        let anew = before.settings != self.site.settings;
        if anew {
            self.files.end(&self.stage);
        }
        self.stage.settle(Settings { clock: local_time(), ..self.site.settings }, self.site.idle_s);
        if anew {
            self.begin_anew();
        }
    }

    /// Another exhibit from its start, with its own sounds.
    fn swap(&mut self, exhibit: Arc<Exhibit>) {
        self.playback.swap(&exhibit);
        self.motion.swap(exhibit.motion);
        self.files.end(&self.stage);
        self.stage.swap(exhibit, local_time());
        self.begin_anew();
    }

    fn begin_anew(&mut self) {
        self.files.begin(&self.stage);
        self.account.begin_anew(&self.stage);
    }

    fn publish(&mut self, due: Instant, hears: bool) {
        let (audio, load) = (&self.playback.audio, &mut self.account.load);
        load.audio = audio.status();
        load.played = audio.played();
        load.loudness = self.playback.loudness.view();
        load.mode = self.stage.snapshot().diagnostics.mode;
        load.controllers.clear();
        load.controllers.extend(self.controllers.states().map(|(kind, state)| (kind.name(), state)));
        let (frame, wakes) = self.account.frame(&self.stage, due);
        let frame = Arc::new(Frame { speaks: audio.speaks(), deaf: self.listening.deaf, hears, ..frame });
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

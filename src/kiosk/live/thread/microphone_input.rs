//! Input of the microphone: a visitor's breath, or the sweep of the audio self-test.

use std::sync::Arc;
use std::time::Instant;

use super::super::live_state::RunStatus;
use super::playback::Playback;
use crate::venue::self_test_run::{SelfTestAction, SelfTestRun};
use soffio_devices::audio::MicrophoneSamples;

/// Input of the microphone.
pub(super) struct MicrophoneInput {
    /// Samples since the last steps.
    pub heard: MicrophoneSamples,
    /// Has the visitor switched the microphone off?
    pub ignore_microphone: bool,
    /// Is the venue closed?
    pub closed: bool,
    self_test: SelfTestRun,
    began: Instant,
}

impl MicrophoneInput {
    /// Without any samples.
    pub(super) fn new(closed: bool) -> Self {
        Self {
            heard: MicrophoneSamples::default(),
            ignore_microphone: false,
            closed,
            self_test: SelfTestRun::default(),
            began: Instant::now(),
        }
    }

    /// Begins an audio self-test.
    pub(super) fn begin_self_test(&mut self) {
        self.self_test.begin(self.began.elapsed().as_secs_f64());
    }

    /// Reads all new samples; `breath`: visitors may blow. Returns the sample rate, Hz, if a breath may be detected, and whether
    /// a self-test is running.
    pub(super) fn read(&mut self, breath: bool, playback: &mut Playback, load: &mut RunStatus) -> (Option<u32>, bool) {
        playback.audio.listen(breath && !self.closed || self.self_test.is_running());
        let rate = playback.audio.read_microphone(&mut self.heard);
        let is_testing = self.update_self_test(rate, playback, load);
        // Samples are read and dropped even while the microphone is ignored.
        (rate.filter(|_| !self.ignore_microphone && !is_testing), is_testing)
    }

    /// Advances a running self-test; returns whether there was one.
    fn update_self_test(&mut self, rate: Option<u32>, playback: &mut Playback, load: &mut RunStatus) -> bool {
        if !self.self_test.is_running() {
            return false;
        }
        let now = self.began.elapsed().as_secs_f64();
        match self.self_test.update(now, &playback.audio.status(), (&self.heard.samples, rate)) {
            Some(SelfTestAction::PlaySweep(words)) => playback.audio.say(&words),
            Some(SelfTestAction::Done(outcome)) => {
                load.self_test = (load.self_test.0 + 1, Some(Arc::new(outcome)));
                // The volume is again set by hours and visitor.
                playback.loudness.invalidate();
            }
            None => {}
        }
        true
    }
}

//! What is heard by the microphone: a visitor's breath, or the chirp of the self-test.

use std::sync::Arc;
use std::time::Instant;

use super::super::frame::Load;
use super::playback::Playback;
use crate::venue::chirping::{Act, Course};
use soffio_devices::audio::Heard;

/// The microphone's side of the thread.
pub(super) struct Listening {
    /// What has arrived since the last steps.
    pub heard: Heard,
    /// Has the visitor switched the microphone off?
    pub deaf: bool,
    /// Is the house closed?
    pub closed: bool,
    chirping: Course,
    began: Instant,
}

impl Listening {
    /// Nothing has been heard.
    pub(super) fn new(closed: bool) -> Self {
        Self { heard: Heard::default(), deaf: false, closed, chirping: Course::default(), began: Instant::now() }
    }

    /// Begins a chirp.
    pub(super) fn begin_chirp(&mut self) {
        self.chirping.begin(self.began.elapsed().as_secs_f64());
    }

    /// Takes all that has arrived; `breath`: the site wants visitors to blow. Returns the microphone's rate, Hz, where a breath
    /// may be heard in it, and whether a chirp is on its way.
    pub(super) fn hear(&mut self, breath: bool, playback: &mut Playback, load: &mut Load) -> (Option<u32>, bool) {
        playback.audio.listen(breath && !self.closed || self.chirping.runs());
        let rate = playback.audio.read_microphone(&mut self.heard);
        let chirps = self.chirp(rate, playback, load);
        // What a visitor does not want to be heard is read all the same, so that it is gone.
        (rate.filter(|_| !self.deaf && !chirps), chirps)
    }

    /// Goes on with a chirp, where one is on its way; says whether there was one.
    fn chirp(&mut self, rate: Option<u32>, playback: &mut Playback, load: &mut Load) -> bool {
        if !self.chirping.runs() {
            return false;
        }
        let now = self.began.elapsed().as_secs_f64();
        match self.chirping.tend(now, &playback.audio.status(), (&self.heard.samples, rate)) {
            Some(Act::Say(words)) => playback.audio.say(&words),
            Some(Act::Done(outcome)) => {
                load.chirp = (load.chirp.0 + 1, Some(Arc::new(outcome)));
                // The hours, or the visitor's keys, say how loud it is again.
                playback.loudness.forget();
            }
            None => {}
        }
        true
    }
}

//! What the window sees of the simulation.

use std::sync::Arc;
use std::time::Instant;

use crate::live::microphone::MicrophoneHealth;
use crate::step::breaths::Blows;
use crate::step::moments::{BEHIND, Moments};
use crate::step::stage::Stage;
use crate::venue::chirping::Outcome;
use crate::venue::loudness::View;
use soffio_devices::audio::{AudioStatus, DeviceState};
use soffio_devices::controllers::State;
use soffio_exhibit::Exhibit;
use soffio_simulation::{Inspection, MotionMode, STEPS_PER_SECOND, Snapshot};

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
    /// Commands of the window that gave way to newer ones so far.
    pub commands_dropped: u64,
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

    /// Sets `moment` to the newest step.
    pub fn set_newest(&self, moment: &mut Snapshot) {
        self.moments.before(0.0, moment);
    }
}

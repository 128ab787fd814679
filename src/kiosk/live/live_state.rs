//! State that the simulation thread publishes for the window.

use std::sync::Arc;
use std::time::Instant;

use crate::live::microphone::MicrophoneHealth;
use crate::step::breaths::BreathCounts;
use crate::step::frame_interpolation::{DELAY_STEPS, SnapshotHistory};
use crate::step::stage::Stage;
use crate::venue::loudness::LoudnessStatus;
use crate::venue::self_test_run::SelfTestOutcome;
use soffio_detector::AmbientSpread;
use soffio_devices::audio::{AudioStatus, DeviceState};
use soffio_devices::controllers::State;
use soffio_exhibit::Exhibit;
use soffio_simulation::{Inspection, MotionMode, STEPS_PER_SECOND, Snapshot};

/// State that the simulation thread publishes after each step.
#[derive(Clone)]
pub struct LiveState {
    /// The exhibit on show. Another `Arc` is another exhibit.
    pub exhibit: Arc<Exhibit>,
    /// Snapshot of the last step.
    pub current: Arc<Snapshot>,
    /// The last snapshots.
    pub history: SnapshotHistory,
    /// When the last step was due.
    pub due: Instant,
    /// Is the picture idle?
    pub still: bool,
    /// Is attract mode playing?
    pub attracts: bool,
    /// Text key that attract mode shows.
    pub attract_text: Option<String>,
    /// Finished rounds of the attract script.
    pub attract_rounds: u32,
    /// Time until attract mode begins, s, during the countdown.
    pub leaves_in: Option<f64>,
    /// Keys of the captions to show.
    pub captions: Vec<String>,
    /// Swipes forward so far, less those backward.
    pub swipes: i64,
    /// Is speech playing?
    pub speaks: bool,
    /// Has the visitor switched the microphone off?
    pub ignore_microphone: bool,
    /// Is there a microphone, or a recording in its place?
    pub hears: bool,
    /// Begin of the last breath.
    pub onset: Option<Onset>,
    /// Status for staff.
    pub load: RunStatus,
    /// Inspection for staff; `None` where none is open.
    pub inspection: Option<Arc<Inspection>>,
}

/// Begin of a breath from any source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Onset {
    /// The first step with wind, as counted by its snapshot.
    pub step: u64,
    /// When that step was published.
    pub at: Instant,
}

/// Status of the simulation thread and the devices.
#[derive(Clone, Debug, Default)]
pub struct RunStatus {
    /// Recent mean time of a step, s.
    pub step_s: f64,
    /// Dropped steps so far.
    pub dropped: u64,
    /// Dropped commands of the window so far.
    pub commands_dropped: u64,
    /// Health of the microphone.
    pub microphone: MicrophoneHealth,
    /// What the breath detector knows of the room; `None` where there was no microphone yet.
    pub ambient_spread: Option<AmbientSpread>,
    /// Status of the audio devices.
    pub audio: AudioStatus,
    /// Frames that the loudspeaker has played; `None` where there is none.
    pub played: Option<u64>,
    /// State of the loudness.
    pub loudness: LoudnessStatus,
    /// Solver of the exhibit's motion.
    pub mode: MotionMode,
    /// Changes of the solver so far.
    pub mode_changes: u64,
    /// Breaths that began so far.
    pub blows: BreathCounts,
    /// States of the controllers, by kind.
    pub controllers: Vec<(&'static str, State)>,
    /// Audio self-tests so far, and the outcome of the last one.
    pub self_test: (u64, Option<Arc<SelfTestOutcome>>),
}

impl LiveState {
    /// The state of a stage before its first step.
    pub fn new(stage: &Stage) -> Self {
        let history = SnapshotHistory::new(stage.snapshot());
        Self {
            exhibit: stage.exhibit().clone(),
            current: history.newest().clone(),
            history,
            due: Instant::now(),
            still: false,
            attracts: false,
            attract_text: None,
            attract_rounds: 0,
            leaves_in: None,
            captions: Vec::new(),
            swipes: 0,
            speaks: false,
            ignore_microphone: false,
            hears: false,
            onset: None,
            load: RunStatus::default(),
            inspection: None,
        }
    }

    /// Is there certainly no microphone? One that is still being opened is not missing.
    pub fn lacks_microphone(&self) -> bool {
        !self.hears
            && !self.ignore_microphone
            && (self.load.microphone.is_silent()
                || matches!(self.load.audio.input, DeviceState::Missing(_) | DeviceState::Closed))
    }

    /// Is it certain that there is no loudspeaker?
    pub fn lacks_output(&self) -> bool {
        matches!(self.load.audio.output, DeviceState::Missing(_))
    }

    /// Sets `moment` to the interpolated state at the time `shown`.
    pub fn interpolate(&self, shown: Instant, moment: &mut Snapshot) {
        let early = self.due.saturating_duration_since(shown).as_secs_f64();
        let since = shown.saturating_duration_since(self.due).as_secs_f64() - early;
        self.history.interpolate(DELAY_STEPS - since * STEPS_PER_SECOND as f64, moment);
    }

    /// Sets `moment` to the newest step.
    pub fn copy_newest(&self, moment: &mut Snapshot) {
        self.history.interpolate(0.0, moment);
    }
}

//! Collects the results of steps for the window and the log.

use std::sync::Arc;
use std::time::Instant;

use super::super::live_state::{LiveState, Onset, RunStatus};
use crate::step::breaths::{BreathDevices, BreathEvent, BreathLog};
use crate::step::captions::Captions;
use crate::step::frame_interpolation::SnapshotHistory;
use crate::step::idle_detection::IdleDetector;
use crate::step::stage::Stage;
use soffio_simulation::{Inspection, STEPS_PER_SECOND};

/// Collects the results of steps for the next [`LiveState`].
pub(super) struct Publisher {
    /// Counts and states of devices, for the status page.
    pub load: RunStatus,
    /// Inspection for staff.
    pub inspection: Option<Arc<Inspection>>,
    history: SnapshotHistory,
    idle_detector: IdleDetector,
    /// Was the picture idle at the last publication?
    still: bool,
    breaths: BreathLog,
    captions: Captions,
    onset: Option<Onset>,
    /// The step that was published last.
    published: u64,
}

impl Publisher {
    /// Before the first step.
    pub(super) fn new(stage: &Stage) -> Self {
        Self {
            load: RunStatus::default(),
            inspection: None,
            history: SnapshotHistory::new(stage.snapshot()),
            idle_detector: IdleDetector::default(),
            still: false,
            breaths: BreathLog::default(),
            captions: Captions::default(),
            onset: None,
            published: 0,
        }
    }

    /// The exhibit restarts: captions, history and onset are cleared.
    pub(super) fn restart(&mut self, stage: &Stage) {
        self.captions = Captions::default();
        self.history = SnapshotHistory::new(stage.snapshot());
        self.onset = None;
    }

    /// Adds the snapshot of a step.
    pub(super) fn record_step(&mut self, stage: &Stage) {
        self.history.push(stage.snapshot());
        self.idle_detector.update(stage.exhibit(), stage.snapshot(), stage.sight());
    }

    /// Records the sounds of a step.
    pub(super) fn record_sounds(&mut self, stage: &Stage) {
        self.captions.update(stage.exhibit(), stage.sounds(), stage.steps());
    }

    /// Logs and counts the breaths that began or ended in a step; `strength` is that of a controller, 0 … 1.
    pub(super) fn record_breaths(&mut self, stage: &Stage, strength: f64) {
        let (step, breath) = (stage.steps(), &stage.snapshot().breath);
        for turn in self.breaths.record(step, breath, BreathDevices { hold: stage.holds(), strength }, stage.attracts())
        {
            self.load.blows.record(&turn);
            if matches!(turn, BreathEvent::Begins(..)) {
                self.onset = Some(Onset { step: stage.snapshot().step, at: Instant::now() });
            }
            tracing::info!("{:.3} s: {turn}", step as f64 / STEPS_PER_SECOND as f64);
        }
    }

    /// Updates the mean time of a step after `due` steps that began at `before`.
    pub(super) fn record_time(&mut self, before: Instant, due: u64) {
        let each = before.elapsed().as_secs_f64() / due as f64;
        self.load.step_s += 0.02 * (each - self.load.step_s);
    }

    /// Records the dropped commands so far; logs new ones.
    pub(super) fn record_dropped(&mut self, dropped: u64) {
        let more = dropped - self.load.commands_dropped;
        if more > 0 {
            tracing::warn!("the simulation was late: {more} commands of the window were dropped");
        }
        self.load.commands_dropped = dropped;
    }

    /// State after the last step, which was due at `due`, and whether an idle picture begins to move in it.
    pub(super) fn frame(&mut self, stage: &Stage, due: Instant) -> (LiveState, bool) {
        if let Some(onset) = &mut self.onset
            && onset.step > self.published
        {
            onset.at = Instant::now();
        }
        self.published = stage.snapshot().step;
        // In attract mode the camera sways.
        let still = self.idle_detector.is_still() && !stage.attracts();
        let wakes = self.still && !still;
        self.still = still;
        let (attract_rounds, leaves_in) = stage.attract_progress();
        let frame = LiveState {
            still,
            exhibit: stage.exhibit().clone(),
            current: self.history.newest().clone(),
            history: self.history.clone(),
            due,
            attracts: stage.attracts(),
            attract_text: stage.attract_text().map(str::to_owned),
            attract_rounds,
            leaves_in,
            captions: self.captions.shown(stage.exhibit(), stage.steps()),
            swipes: stage.swipes(),
            speaks: false,
            ignore_microphone: false,
            hears: false,
            onset: self.onset,
            load: self.load.clone(),
            inspection: self.inspection.clone(),
        };
        (frame, wakes)
    }
}

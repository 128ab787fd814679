//! What the window and the log are told of the steps done.

use std::sync::Arc;
use std::time::Instant;

use super::super::frame::{Frame, Load, Onset};
use crate::step::breaths::{Breaths, Turn};
use crate::step::captions::Captions;
use crate::step::moments::Moments;
use crate::step::stage::Stage;
use crate::step::stillness::Stillness;
use soffio_simulation::{Inspection, STEPS_PER_SECOND};

/// What is remembered from step to step for the next [`Frame`].
pub(super) struct Account {
    pub load: Load,
    /// What staff look at.
    pub inspection: Option<Arc<Inspection>>,
    moments: Moments,
    stillness: Stillness,
    /// Was everything still when it was last published?
    still: bool,
    breaths: Breaths,
    captions: Captions,
    onset: Option<Onset>,
    /// The step that was published last.
    published: u64,
}

impl Account {
    /// Before the first step.
    pub(super) fn new(stage: &Stage) -> Self {
        Self {
            load: Load::default(),
            inspection: None,
            moments: Moments::new(stage.snapshot()),
            stillness: Stillness::default(),
            still: false,
            breaths: Breaths::default(),
            captions: Captions::default(),
            onset: None,
            published: 0,
        }
    }

    /// The exhibit begins at its start: what was told of it is over.
    pub(super) fn begin_anew(&mut self, stage: &Stage) {
        self.captions = Captions::default();
        self.moments = Moments::new(stage.snapshot());
        self.onset = None;
    }

    /// Keeps the moment after a step.
    pub(super) fn note_moment(&mut self, stage: &Stage) {
        self.moments.push(stage.snapshot());
        self.stillness.note(stage.exhibit(), stage.snapshot(), stage.sight());
    }

    /// Takes notice of the sounds of a step.
    pub(super) fn note_sounds(&mut self, stage: &Stage) {
        self.captions.note(stage.exhibit(), stage.sounds(), stage.steps());
    }

    /// Logs and counts the breaths that began or ended in a step; `strength` is how hard a controller was blown, 0 … 1.
    pub(super) fn note_breath(&mut self, stage: &Stage, strength: f64) {
        let (step, breath) = (stage.steps(), &stage.snapshot().breath);
        for turn in self.breaths.note(step, breath, (stage.holds(), strength), stage.attracts()) {
            self.load.blows.note(&turn);
            if matches!(turn, Turn::Begins(..)) {
                self.onset = Some(Onset { step: stage.snapshot().step, at: Instant::now() });
            }
            tracing::info!("{:.3} s: {turn}", step as f64 / STEPS_PER_SECOND as f64);
        }
    }

    /// The mean time of a step after `due` steps that began at `before`.
    pub(super) fn note_time(&mut self, before: Instant, due: u64) {
        let each = before.elapsed().as_secs_f64() / due as f64;
        self.load.step_s += 0.02 * (each - self.load.step_s);
    }

    /// Commands that gave way so far; says in the log how many more they are.
    pub(super) fn note_dropped(&mut self, dropped: u64) {
        let more = dropped - self.load.commands_dropped;
        if more > 0 {
            tracing::warn!("the simulation was late: {more} commands of the window gave way to newer ones");
        }
        self.load.commands_dropped = dropped;
    }

    /// The frame of the last step, which was due at `due`, and whether something begins to move in it.
    pub(super) fn frame(&mut self, stage: &Stage, due: Instant) -> (Frame, bool) {
        if let Some(onset) = &mut self.onset
            && onset.step > self.published
        {
            onset.at = Instant::now();
        }
        self.published = stage.snapshot().step;
        // In attract mode the camera sways.
        let still = self.stillness.is_still() && !stage.attracts();
        let wakes = self.still && !still;
        self.still = still;
        let (attract_rounds, leaves_in) = stage.attract_course();
        let frame = Frame {
            still,
            exhibit: stage.exhibit().clone(),
            current: self.moments.newest().clone(),
            moments: self.moments.clone(),
            due,
            attracts: stage.attracts(),
            attract_text: stage.attract_text().map(str::to_owned),
            attract_rounds,
            leaves_in,
            captions: self.captions.shown(stage.exhibit(), stage.steps()),
            turned: stage.turned(),
            speaks: false,
            deaf: false,
            hears: false,
            onset: self.onset,
            load: self.load.clone(),
            inspection: self.inspection.clone(),
        };
        (frame, wakes)
    }
}

//! What moves the exhibit: as the command line says, or as the governor chooses.

use super::super::frame::Load;
use crate::step::governor::Governor;
use soffio_exhibit::Motion;
use soffio_simulation::{MotionMode, STEPS_PER_SECOND};

/// The choice for the next step.
pub(super) struct MotionChoice {
    /// Chosen for the whole run.
    fixed: Option<MotionMode>,
    governor: Governor,
}

impl MotionChoice {
    /// For an exhibit; `fixed` overrules its own choice and the governor's.
    pub(super) fn new(fixed: Option<MotionMode>, motion: Motion) -> Self {
        Self { fixed, governor: Governor::new(motion) }
    }

    /// Another exhibit.
    pub(super) fn swap(&mut self, motion: Motion) {
        self.governor = Governor::new(motion);
    }

    /// What moves the next step; `None` leaves it to the exhibit.
    pub(super) fn mode(&self) -> Option<MotionMode> {
        self.fixed.or(self.governor.mode())
    }

    /// Looks whether the laws can go on after a step, the `steps`-th, that took `cost` seconds of processor time.
    pub(super) fn govern(&mut self, cost: f64, steps: u64, load: &mut Load) {
        if self.fixed.is_none() && self.governor.note(cost) {
            load.mode_changes += 1;
            let mode = self.governor.mode().unwrap_or_default().name();
            let t = steps as f64 / STEPS_PER_SECOND as f64;
            tracing::info!("{t:.3} s: moved by {mode} from here (a step took {:.3} ms)", 1e3 * cost);
        }
    }
}

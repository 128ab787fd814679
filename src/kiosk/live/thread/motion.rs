//! Choice of the solver: by the command line, or by the governor.

use super::super::live_state::RunStatus;
use crate::step::governor::Governor;
use soffio_exhibit::{Exhibit, Motion};
use soffio_simulation::{MotionMode, STEPS_PER_SECOND};

/// Solver of the next step.
pub(super) struct MotionChoice {
    /// Fixed for the whole run.
    fixed: Option<MotionMode>,
    governor: Governor,
}

/// Motion of an exhibit as far as it allows another one; logs where it does not move as the command line says.
fn allowed(fixed: Option<MotionMode>, exhibit: &Exhibit) -> Motion {
    let Some(why) = exhibit.refusal() else { return exhibit.motion };
    if fixed.is_some_and(|mode| mode != MotionMode::Dynamic) {
        tracing::warn!("{} moves by dynamics alone: {why}", exhibit.id);
    }
    Motion::Dynamics
}

impl MotionChoice {
    /// For an exhibit; `fixed` takes precedence over its own choice and the governor's.
    pub(super) fn new(fixed: Option<MotionMode>, exhibit: &Exhibit) -> Self {
        Self { fixed, governor: Governor::new(allowed(fixed, exhibit)) }
    }

    /// Another exhibit.
    pub(super) fn swap(&mut self, exhibit: &Exhibit) {
        self.governor = Governor::new(allowed(self.fixed, exhibit));
    }

    /// Solver of the next step; `None` is the exhibit's own.
    pub(super) fn mode(&self) -> Option<MotionMode> {
        self.fixed.or(self.governor.mode())
    }

    /// Lets the governor choose after step number `steps`, which took `cost` s of processor time.
    pub(super) fn govern(&mut self, cost: f64, steps: u64, load: &mut RunStatus) {
        if self.fixed.is_none() && self.governor.record(cost) {
            load.mode_changes += 1;
            let mode = self.governor.mode().unwrap_or_default().name();
            let t = steps as f64 / STEPS_PER_SECOND as f64;
            tracing::info!("{t:.3} s: the solver is {mode} from here (a step took {:.3} ms)", 1e3 * cost);
        }
    }
}

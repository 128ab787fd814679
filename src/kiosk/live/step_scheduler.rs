//! Fixed time step scheduler: which steps are due by the wall clock.
//!
//! Both times are integers, nanoseconds of the clock and steps, related by ⌊t·240⌋, so that there is no drift. A short delay is
//! made up for by more steps of the same size; a longer one is dropped, because hurried motion looks worse than a jump.

use std::time::Duration;

use soffio_simulation::STEPS_PER_SECOND;

/// Longest delay that is made up for, steps (0.25 s).
pub const MOST_BEHIND: u64 = STEPS_PER_SECOND / 4;

const NANOS: u128 = 1_000_000_000;

/// Counts the steps of a run against a clock that the caller reads.
#[derive(Clone, Copy, Debug, Default)]
pub struct StepScheduler {
    done: u64,
    dropped: u64,
}

impl StepScheduler {
    /// Number of steps due at `now`, the time since the run began; they count as done.
    pub fn due(&mut self, now: Duration) -> u64 {
        let elapsed_steps = (now.as_nanos() * u128::from(STEPS_PER_SECOND) / NANOS) as u64;
        let mut due = elapsed_steps.saturating_sub(self.dropped + self.done);
        if due > MOST_BEHIND {
            self.dropped += due - 1;
            due = 1;
        }
        self.done += due;
        due
    }

    /// Due time of the last step, since the run began.
    pub fn present(&self) -> Duration {
        time_of(self.dropped + self.done)
    }

    /// Due time of the next step, since the run began.
    pub fn next(&self) -> Duration {
        time_of(self.dropped + self.done + 1)
    }

    /// Dropped steps so far.
    pub fn dropped(&self) -> u64 {
        self.dropped
    }
}

/// The first nanosecond at which `step` steps are due.
fn time_of(step: u64) -> Duration {
    let nanos = (u128::from(step) * NANOS).div_ceil(u128::from(STEPS_PER_SECOND));
    Duration::from_nanos(nanos as u64)
}

//! Which step the wall clock asks for.
//!
//! Both times are integers: nanoseconds on the clock's side, steps on ours, with ⌊t·240⌋ between them, so a day of
//! steps drifts by none. A kiosk that was held up makes up for a short delay with more steps per wake-up, each of
//! its usual size; a longer delay is dropped, because a visitor would rather miss a moment than see it hurried.

use std::time::Duration;

use soffio_simulation::STEPS_PER_SECOND;

/// Longest delay that is made up for, steps (0.25 s).
pub const MOST_BEHIND: u64 = STEPS_PER_SECOND / 4;

const NANOS: u128 = 1_000_000_000;

/// The step counter of a run against a clock that the caller reads.
#[derive(Clone, Copy, Debug, Default)]
pub struct Pacer {
    done: u64,
    dropped: u64,
}

impl Pacer {
    /// Steps that are due at `now` (since the run began); they count as done.
    pub fn due(&mut self, now: Duration) -> u64 {
        let asked = (now.as_nanos() * u128::from(STEPS_PER_SECOND) / NANOS) as u64;
        let mut due = asked.saturating_sub(self.dropped + self.done);
        if due > MOST_BEHIND {
            self.dropped += due - 1;
            due = 1;
        }
        self.done += due;
        due
    }

    /// When the last step done was due, since the run began.
    pub fn present(&self) -> Duration {
        time_of(self.dropped + self.done)
    }

    /// When the next step is due, since the run began.
    pub fn next(&self) -> Duration {
        time_of(self.dropped + self.done + 1)
    }

    /// Steps of time that were dropped.
    pub fn dropped(&self) -> u64 {
        self.dropped
    }
}

/// The first nanosecond at which `step` steps are due.
fn time_of(step: u64) -> Duration {
    let nanos = (u128::from(step) * NANOS).div_ceil(u128::from(STEPS_PER_SECOND));
    Duration::from_nanos(nanos as u64)
}

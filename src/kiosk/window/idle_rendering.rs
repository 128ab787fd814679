//! Idle rendering: fewer frames while the picture does not change, and the full rate again at the first breath, touch or motion.
//!
//! The simulation's [`IdleDetector`](crate::step::idle_detection::IdleDetector) watches the exhibit. [`IdleRendering`] watches the
//! window: there must be no input, and nothing on the page may fade, fill or close. If both are idle the next frame may wait
//! for [`IDLE_FRAME_S`](crate::step::idle_detection::IDLE_FRAME_S). The first step with motion wakes the window.

use crate::step::idle_detection::QUIET_S;

/// Activity of exhibit and window at a frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct FrameActivity {
    /// Is the exhibit idle?
    pub still: bool,
    /// Does something on the page fade, fill or close, or is a panel open?
    pub page_moves: bool,
    /// Inputs so far, of any kind.
    pub inputs: u64,
}

/// State of idle rendering.
#[derive(Clone, Copy, Debug, Default)]
pub struct IdleRendering {
    inputs: u64,
    /// Time of the last activity, s.
    busy: f64,
    is_idle: bool,
}

impl IdleRendering {
    /// Records a frame at `time`, s. Returns whether the next one may wait.
    pub fn update(&mut self, time: f64, signs: FrameActivity) -> bool {
        if !signs.still || signs.page_moves || signs.inputs != self.inputs {
            (self.busy, self.inputs) = (time, signs.inputs);
        }
        // The exhibit is idle only after its own quiet time.
        self.is_idle = signs.still && time - self.busy >= QUIET_S;
        self.is_idle
    }

    /// May the next frame wait for [`IDLE_FRAME_S`](crate::step::idle_detection::IDLE_FRAME_S), as nothing moves?
    pub fn is_idle(&self) -> bool {
        self.is_idle
    }
}

//! Frame pacing, quality tiers, idle rendering, and counts of frames.

use std::time::Instant;

use crate::live::LiveState;
use crate::step::idle_detection::IDLE_FRAME_S;
use crate::window::idle_rendering::{FrameActivity, IdleRendering};
use crate::window::quality_tiers::{QualityController, QualityTier};
use crate::window::screen::Drawn;
use crate::window::timing::{FrameClock, OnsetLatency};
use soffio_simulation::Snapshot;

/// Assumed refresh interval of a display that does not report it, s.
const COMMON_REFRESH: f64 = 1.0 / 60.0;

/// State of frame pacing.
#[derive(Default)]
pub(crate) struct Pacing {
    /// Times of frames.
    pub clock: FrameClock,
    /// Latency from the onset of a breath to the picture.
    pub onset_latency: OnsetLatency,
    /// Choice of the quality tier.
    pub quality: QualityController,
    idle: IdleRendering,
    /// Number of window events so far, except redraws.
    inputs: u64,
    counts: Counts,
}

/// Counts of frames.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Counts {
    /// Number of frames that were shown.
    pub shown: u64,
    /// Idle ones among them.
    pub at_rest: u64,
    /// Frames while the display was off.
    pub dark: u64,
}

/// Motion of exhibit and page in a frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameMotion {
    /// Is the exhibit idle?
    pub still: bool,
    /// Does something on the page fade, fill or close, or is a panel open?
    pub page_moves: bool,
}

/// A started frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FrameStart {
    /// Start of this frame, and of the one before.
    pub now: Instant,
    /// Start of the frame before.
    pub last: Instant,
    /// Did it wait in idle rendering?
    pub rested: bool,
    /// May the next one wait?
    pub rests: bool,
    /// Time that it shows.
    pub shown: Instant,
}

impl Pacing {
    /// Time since the start of the kiosk, s.
    pub fn time(&self) -> f64 {
        self.clock.seconds(Instant::now())
    }

    /// Ends the wait of idle rendering: the next frame is due at once.
    pub fn wake(&mut self) {
        if self.idle.is_idle() {
            self.clock.next = Instant::now();
        }
    }

    /// An event of the window.
    pub fn count_input(&mut self) {
        self.inputs += 1;
        self.wake();
    }

    /// Another tier, where the machine keeps up with it better; `least` is the shortest time between two pictures, s, and
    /// `refresh` that of the display. Nothing is learnt while the picture is black.
    pub fn adapt_quality(&mut self, now: Instant, open: bool, least: f64, refresh: Option<f64>) -> Option<QualityTier> {
        let target = least.max(refresh.unwrap_or(COMMON_REFRESH));
        let passed = now.duration_since(self.clock.last).as_secs_f64();
        // An interval in idle rendering is not the machine's fault.
        let changed = open && !self.idle.is_idle() && self.quality.record(passed, target);
        changed.then(|| self.quality.tier())
    }

    /// Starts a frame; the next one is due after `least` seconds.
    pub fn begin(&mut self, now: Instant, motion: FrameMotion, least: f64) -> FrameStart {
        let FrameMotion { still, page_moves } = motion;
        let (last, rested) = (self.clock.last, self.idle.is_idle());
        let rests = self.idle.update(self.clock.seconds(now), FrameActivity { still, page_moves, inputs: self.inputs });
        let shown = self.clock.tick(now, if rests { least.max(IDLE_FRAME_S) } else { least });
        FrameStart { now, last, rested, rests, shown }
    }

    /// Records a frame of `moment`.
    pub fn record(&mut self, drawn: Drawn, picture: &FrameStart, frame: &LiveState, moment: &Snapshot) {
        if drawn == Drawn::Shown {
            self.onset_latency.record(frame, moment, picture.now);
            self.counts.shown += 1;
            self.counts.at_rest += u64::from(picture.rests);
        }
        self.counts.dark += u64::from(drawn == Drawn::Dark);
    }

    /// Counts of frames.
    pub fn counts(&self) -> Counts {
        self.counts
    }
}

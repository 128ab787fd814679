//! Frame timing, and the latency from a breath to its first frame.

use std::time::{Duration, Instant};

use crate::live::{LiveState, Onset};
use crate::window::frame_pacing::FramePacer;
use soffio_simulation::Snapshot;

/// Weight of the newest interval in the mean.
const FRAME_SMOOTHING: f64 = 0.1;

/// Clock of the frames.
pub struct FrameClock {
    /// Start of the clock.
    pub began: Instant,
    /// Start of the last frame.
    pub last: Instant,
    /// Due time of the next frame.
    pub next: Instant,
    /// Mean interval between frames, s.
    pub frame_s: f64,
    /// Chooses the times that frames show.
    pub pacer: FramePacer,
}

impl Default for FrameClock {
    fn default() -> Self {
        let now = Instant::now();
        Self { began: now, last: now, next: now, frame_s: 0.0, pacer: FramePacer::default() }
    }
}

impl FrameClock {
    /// Starts a frame; the next one is due after `least` seconds. Returns the time that this one shows.
    pub fn tick(&mut self, now: Instant, least: f64) -> Instant {
        self.frame_s += FRAME_SMOOTHING * (now.duration_since(self.last).as_secs_f64() - self.frame_s);
        self.last = now;
        self.next = now + Duration::from_secs_f64(least);
        let shown = self.pacer.next(self.seconds(now));
        self.began + Duration::from_secs_f64(shown.max(0.0))
    }

    /// Seconds since the start.
    pub fn seconds(&self, now: Instant) -> f64 {
        now.duration_since(self.began).as_secs_f64()
    }
}

/// Latency from the step with the first wind of a breath to the first frame that shows it.
#[derive(Default)]
pub struct OnsetLatency {
    onset: Option<Onset>,
    /// Latency of the last breath, s.
    pub seconds: f64,
    /// Start of the frame before.
    before: Option<Instant>,
}

impl OnsetLatency {
    /// Is there an onset that no frame has shown yet, and `moment` would not show either?
    pub fn misses(&self, frame: &LiveState, moment: &Snapshot) -> bool {
        frame.onset.is_some_and(|onset| self.onset != Some(onset) && moment.step < onset.step)
    }

    /// Records a frame of `moment` that was started at `begun` and has just been presented.
    pub fn record(&mut self, frame: &LiveState, moment: &Snapshot, begun: Instant) {
        let before = self.before.replace(begun);
        if let Some(onset) = frame.onset.filter(|&onset| moment.step >= onset.step && self.onset != Some(onset)) {
            self.onset = Some(onset);
            self.seconds = onset.at.elapsed().as_secs_f64();
            let place = if before.is_none_or(|before| before <= onset.at) { "the next frame" } else { "a later one" };
            tracing::info!(
                "the breath of step {} is seen {:.1} ms after it, in {place} (step {})",
                onset.step,
                1e3 * self.seconds,
                moment.step
            );
        }
    }
}

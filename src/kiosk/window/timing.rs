//! When pictures are drawn, and how soon a breath is seen in one.

use std::time::{Duration, Instant};

use crate::live::{Frame, Onset};
use crate::window::rhythm::Rhythm;
use soffio_simulation::Snapshot;

/// Share of the newest picture in the mean time of a picture.
const FRAME_SMOOTHING: f64 = 0.1;

/// When pictures are drawn.
pub struct Clock {
    /// When it began.
    pub began: Instant,
    /// When the last picture was begun.
    pub last: Instant,
    /// When the next one is due.
    pub next: Instant,
    /// Mean time from picture to picture, s.
    pub frame_s: f64,
    /// What times pictures show.
    pub rhythm: Rhythm,
}

impl Default for Clock {
    fn default() -> Self {
        let now = Instant::now();
        Self { began: now, last: now, next: now, frame_s: 0.0, rhythm: Rhythm::default() }
    }
}

impl Clock {
    /// A picture begins; the next not before `least` seconds. Says what time this one shows.
    pub fn tick(&mut self, now: Instant, least: f64) -> Instant {
        self.frame_s += FRAME_SMOOTHING * (now.duration_since(self.last).as_secs_f64() - self.frame_s);
        self.last = now;
        self.next = now + Duration::from_secs_f64(least);
        let shown = self.rhythm.next(self.seconds(now));
        self.began + Duration::from_secs_f64(shown.max(0.0))
    }

    /// Seconds since it began.
    pub fn seconds(&self, now: Instant) -> f64 {
        now.duration_since(self.began).as_secs_f64()
    }
}

/// From the step with the first wind of a breath to the first picture that shows it.
#[derive(Default)]
pub struct FirstSight {
    onset: Option<Onset>,
    /// Of the last breath, s.
    pub seconds: f64,
    /// When the picture before this one was begun.
    before: Option<Instant>,
}

impl FirstSight {
    /// Is there wind that no picture has shown, nor would one of `moment`?
    pub fn misses(&self, frame: &Frame, moment: &Snapshot) -> bool {
        frame.onset.is_some_and(|onset| self.onset != Some(onset) && moment.step < onset.step)
    }

    /// A picture of `moment`, begun at `begun`, has just been handed to the display.
    pub fn note(&mut self, frame: &Frame, moment: &Snapshot, begun: Instant) {
        let before = self.before.replace(begun);
        if let Some(onset) = frame.onset.filter(|&onset| moment.step >= onset.step && self.onset != Some(onset)) {
            self.onset = Some(onset);
            self.seconds = onset.at.elapsed().as_secs_f64();
            let place = if before.is_none_or(|before| before <= onset.at) { "the next picture" } else { "a later one" };
            tracing::info!(
                "the breath of step {} is seen {:.1} ms after it, in {place} (step {})",
                onset.step,
                1e3 * self.seconds,
                moment.step
            );
        }
    }
}

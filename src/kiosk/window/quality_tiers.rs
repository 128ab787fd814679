//! Quality tiers: adapt the rendering to the speed of the machine. First fewer pixels, then one sample a pixel, then thirty
//! frames a second. Wires and the edges of plates stay smooth, as their coverage is computed analytically.
//!
//! The criterion is the median of the last sixty frame intervals, which ignores single slow or fast frames. If it exceeds the
//! target by a quarter, the next lower tier is chosen. The cost of a higher tier cannot be measured, because every frame waits
//! for the display. So a higher tier is tried after a while. Each failed try doubles the wait before the next one.

use soffio_render::Sampling;

/// Number of frame intervals whose median is compared.
const WINDOW: usize = 60;
/// Largest allowed ratio of the median to the target.
const SLACK: f64 = 1.25;
/// Shortest and longest wait before a higher tier is tried, s.
pub const WAITS: (f64, f64) = (10.0, 1280.0);
/// Time after which failed tries are forgotten, s.
const PROVEN: f64 = 60.0;
/// Interval from which it is a pause, s: the venue was closed, or the window hidden.
const PAUSE: f64 = 0.5;

/// A quality tier.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QualityTier {
    /// Rendering scale and samples.
    pub finish: Sampling,
    /// Least time between frames, s.
    pub least: f64,
}

/// The tiers from the highest to the lowest.
pub const QUALITY_TIERS: [QualityTier; 4] = [
    QualityTier { finish: Sampling { scale: 1.0, msaa: 4 }, least: 0.0 },
    QualityTier { finish: Sampling { scale: 0.75, msaa: 4 }, least: 0.0 },
    QualityTier { finish: Sampling { scale: 0.75, msaa: 1 }, least: 0.0 },
    QualityTier { finish: Sampling { scale: 0.75, msaa: 1 }, least: 1.0 / 30.0 },
];

/// Chooses the tier.
#[derive(Clone, Debug)]
pub struct QualityController {
    tier: usize,
    intervals: [f64; WINDOW],
    recorded: usize,
    /// Seconds since the last change.
    since: f64,
    /// Seconds before the next try.
    wait: f64,
    changes: u64,
}

impl Default for QualityController {
    fn default() -> Self {
        Self { tier: 0, intervals: [0.0; WINDOW], recorded: 0, since: 0.0, wait: WAITS.0, changes: 0 }
    }
}

impl QualityController {
    /// Tier of the next frame.
    pub fn tier(&self) -> QualityTier {
        QUALITY_TIERS[self.tier]
    }

    /// Changes so far.
    pub fn changes(&self) -> u64 {
        self.changes
    }

    /// Records a frame `interval` seconds after the one before; `target` is the wanted interval, s. Returns whether the tier
    /// changed.
    pub fn record(&mut self, interval: f64, target: f64) -> bool {
        if interval > PAUSE {
            self.recorded = 0;
            return false;
        }
        self.intervals[self.recorded % WINDOW] = interval;
        self.recorded += 1;
        self.since += interval;
        let target = target.max(self.tier().least);
        let full = self.recorded >= WINDOW;
        if full
            && self.recorded.is_multiple_of(WINDOW / 4)
            && self.median() > SLACK * target
            && self.tier + 1 < QUALITY_TIERS.len()
        {
            if self.since < PROVEN {
                self.wait = (2.0 * self.wait).min(WAITS.1);
            }
            return self.change(self.tier + 1);
        }
        if self.tier == 0 && self.since > PROVEN {
            self.wait = WAITS.0;
        }
        full && self.tier > 0 && self.since >= self.wait && self.change(self.tier - 1)
    }

    fn change(&mut self, tier: usize) -> bool {
        (self.tier, self.since, self.recorded) = (tier, 0.0, 0);
        self.changes += 1;
        true
    }

    fn median(&self) -> f64 {
        let mut sorted = self.intervals;
        sorted.sort_unstable_by(f64::total_cmp);
        sorted[WINDOW / 2]
    }
}

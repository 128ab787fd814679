//! How finely pictures are drawn, as far as the machine keeps up: fewer pixels, then one sample a pixel (wires and the edges of
//! plates are measured, not sampled, and stay smooth), then thirty pictures a second.
//!
//! What counts is the time from picture to picture: the median of the last sixty, so that neither a single slow one nor a
//! single fast one says anything. Where it is a quarter over what is asked the next coarser tier is taken. How much time
//! a finer one would take cannot be seen while the display's rhythm makes every picture wait, so it is tried after a while;
//! each time that fails the next try waits twice as long, since a machine that is too slow stays so.

use soffio_render::Sampling;

/// Pictures that are looked at.
const WINDOW: usize = 60;
/// How much longer than asked pictures may take.
const SLACK: f64 = 1.25;
/// Seconds before a finer tier is tried, at first and at most.
pub const WAITS: (f64, f64) = (10.0, 1280.0);
/// Seconds that a finer tier must hold before its failures are forgotten.
const PROVEN: f64 = 60.0;
/// A pause that is no picture's, s: the house was closed, the window hidden.
const PAUSE: f64 = 0.5;

/// One way to draw.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tier {
    /// Pixels and samples.
    pub finish: Sampling,
    /// Least time from picture to picture, s.
    pub least: f64,
}

/// From the finest to the coarsest.
pub const TIERS: [Tier; 4] = [
    Tier { finish: Sampling { scale: 1.0, msaa: 4 }, least: 0.0 },
    Tier { finish: Sampling { scale: 0.75, msaa: 4 }, least: 0.0 },
    Tier { finish: Sampling { scale: 0.75, msaa: 1 }, least: 0.0 },
    Tier { finish: Sampling { scale: 0.75, msaa: 1 }, least: 1.0 / 30.0 },
];

/// Chooses the tier.
#[derive(Clone, Debug)]
pub struct Tiers {
    tier: usize,
    ways: [f64; WINDOW],
    noted: usize,
    /// Seconds since the last change.
    since: f64,
    /// Seconds before the next try.
    wait: f64,
    changes: u64,
}

impl Default for Tiers {
    fn default() -> Self {
        Self { tier: 0, ways: [0.0; WINDOW], noted: 0, since: 0.0, wait: WAITS.0, changes: 0 }
    }
}

impl Tiers {
    /// How the next picture is drawn.
    pub fn tier(&self) -> Tier {
        TIERS[self.tier]
    }

    /// Changes so far.
    pub fn changes(&self) -> u64 {
        self.changes
    }

    /// Takes notice of a picture that came `way` seconds after the one before, where `asked` would have been right. Says whether
    /// the tier changed.
    pub fn note(&mut self, way: f64, asked: f64) -> bool {
        if way > PAUSE {
            self.noted = 0;
            return false;
        }
        self.ways[self.noted % WINDOW] = way;
        self.noted += 1;
        self.since += way;
        let asked = asked.max(self.tier().least);
        let full = self.noted >= WINDOW;
        if full && self.noted.is_multiple_of(WINDOW / 4) && self.median() > SLACK * asked && self.tier + 1 < TIERS.len()
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
        (self.tier, self.since, self.noted) = (tier, 0.0, 0);
        self.changes += 1;
        true
    }

    fn median(&self) -> f64 {
        let mut sorted = self.ways;
        sorted.sort_unstable_by(f64::total_cmp);
        sorted[WINDOW / 2]
    }
}

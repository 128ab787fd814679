//! Hits of one moment are one hit, and none is lost: energies add.
//!
//! ```text
//!   hit: apart from others ──→ rings, and a window opens
//!        within the window ──→ waits, Σ J² ──(it is over, or one is LOUDER than what rang)──→ rings as √(Σ J²), a new one opens
//! ```
//!
//! So two that are far enough apart ring each on its own sample, a hit never waits longer than the window, and however
//! fast surfaces chatter, what rings is once a window and as loud as all of it.

use super::rate::{SAMPLE_RATE, STEPS_PER_SECOND};
use soffio_math::DVec3;

/// Hits of one pair within this are one, samples: 15 ms, in which real impacts have their micro-collisions (van den Doel,
/// Kry and Pai, "FoleyAutomatic", 2001).
const WINDOW: u64 = SAMPLE_RATE as u64 * 15 / 1000;
/// A hit of this many times the energy that rang last does not wait: it is the hit, and that was its beginning.
const LOUDER: f64 = 2.0;

/// What waits is looked at once a step.
const _: () = assert!(WINDOW > SAMPLE_RATE as u64 / STEPS_PER_SECOND);

/// A hit as it will ring.
#[derive(Clone, Copy, Debug, Default)]
pub struct Blow {
    pub sample: u64,
    pub impulse: f64,
    pub speed: f64,
    pub mass: f64,
    /// In the node frames of the two bodies, m.
    pub points: [DVec3; 2],
}

/// Hits that are one.
#[derive(Clone, Copy, Debug, Default)]
pub struct Window {
    /// Until when hits wait.
    until: u64,
    /// J² of what rang, and Σ J² of what waits, (N s)².
    rung: f64,
    waiting: f64,
    /// The strongest of those that wait.
    strongest: Blow,
}

impl Window {
    /// Takes a hit; what rings now.
    pub fn take(&mut self, blow: Blow) -> Option<Blow> {
        let energy = blow.impulse * blow.impulse;
        if blow.sample >= self.until {
            *self = Self { until: blow.sample + WINDOW, rung: energy, waiting: 0.0, strongest: blow };
            return Some(blow);
        }
        if self.waiting == 0.0 || blow.impulse > self.strongest.impulse {
            self.strongest = blow;
        }
        self.waiting += energy;
        (energy >= LOUDER * self.rung).then(|| self.ring(blow.sample))
    }

    /// What waits and is due.
    pub fn due(&mut self, now: u64) -> Option<Blow> {
        (self.waiting > 0.0 && self.until <= now).then(|| self.ring(self.until))
    }

    /// Whether a hit now would wait.
    pub fn is_open(&self, now: u64) -> bool {
        self.until > now
    }

    fn ring(&mut self, sample: u64) -> Blow {
        let impulse = self.waiting.sqrt();
        (self.rung, self.waiting, self.until) = (self.waiting, 0.0, sample + WINDOW);
        Blow { sample, impulse, ..self.strongest }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blow(milliseconds: u64, impulse: f64) -> Blow {
        Blow { sample: milliseconds * 48, impulse, ..Blow::default() }
    }

    #[test]
    fn hits_of_one_moment_are_one_and_lose_nothing() {
        let mut window = Window::default();
        let rung = |blow: Option<Blow>| blow.map(|blow| (blow.sample / 48, (blow.impulse * 1e6).round() as i64));
        assert_eq!(rung(window.take(blow(100, 4e-3))), Some((100, 4000)));
        // Two softer ones wait and ring together: 2.4 and 3.2 are 4.
        assert_eq!(rung(window.take(blow(103, 2.4e-3))), None);
        assert_eq!(rung(window.due(114 * 48)), None);
        assert_eq!(rung(window.take(blow(114, 3.2e-3))), None);
        assert_eq!(rung(window.due(115 * 48)), Some((115, 4000)));
        // One that outdoes what rang does not wait, and takes with it what waits.
        assert_eq!(rung(window.take(blow(116, 3e-3))), None);
        assert_eq!(rung(window.take(blow(120, 40e-3))), Some((120, 40112)));
        assert_eq!(rung(window.due(200 * 48)), None);
        assert_eq!(rung(window.take(blow(200, 1e-6))), Some((200, 1)));
    }
}

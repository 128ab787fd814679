//! Merging of impacts: several impacts of one contact pair within a short window sound as one of the same energy.
//!
//! ```text
//!   impact after the window  ──→ sounds at once, and a window opens
//!   impact within the window ──→ pends, Σ J² ──(the window ends, or it is much louder)──→ sounds as √(Σ J²), a new one opens
//! ```
//!
//! So two impacts that are far enough apart each sound on their own sample, and no impact waits longer than the window.
//! However fast surfaces chatter, there is one sound a window, as loud as all impacts together.

use super::rate::{SAMPLE_RATE, STEPS_PER_SECOND};
use soffio_math::DVec3;

/// Length of a window, samples: 15 ms, in which real impacts have their micro-collisions (van den Doel, Kry and Pai,
/// "FoleyAutomatic", 2001).
const WINDOW: u64 = SAMPLE_RATE as u64 * 15 / 1000;
/// An impact with this many times the energy of the last sound does not wait: it is the impact, and that was its beginning.
const ENERGY_RATIO: f64 = 2.0;

/// Pending impacts are looked at once a step.
const _: () = assert!(WINDOW > SAMPLE_RATE as u64 / STEPS_PER_SECOND);

/// An impact as it will sound.
#[derive(Clone, Copy, Debug, Default)]
pub struct ImpactPulse {
    /// Number of the sample at which it sounds.
    pub sample: u64,
    /// Impulse J, N s.
    pub impulse: f64,
    /// Approach speed, m/s.
    pub speed: f64,
    /// Effective mass, kg.
    pub mass: f64,
    /// In the node frames of the two bodies, m.
    pub points: [DVec3; 2],
}

/// Merging window of one contact pair.
#[derive(Clone, Copy, Debug, Default)]
pub struct MergeWindow {
    /// First sample after the window.
    end: u64,
    /// J² of the last sound, (N s)².
    sounded: f64,
    /// Σ J² of the pending impacts, (N s)².
    pending: f64,
    /// The strongest pending impact.
    strongest: ImpactPulse,
}

impl MergeWindow {
    /// Adds an impact. Returns the one that sounds now, if any.
    pub fn push(&mut self, pulse: ImpactPulse) -> Option<ImpactPulse> {
        let energy = pulse.impulse * pulse.impulse;
        if pulse.sample >= self.end {
            *self = Self { end: pulse.sample + WINDOW, sounded: energy, pending: 0.0, strongest: pulse };
            return Some(pulse);
        }
        if self.pending == 0.0 || pulse.impulse > self.strongest.impulse {
            self.strongest = pulse;
        }
        self.pending += energy;
        (energy >= ENERGY_RATIO * self.sounded).then(|| self.flush(pulse.sample))
    }

    /// The merged pending impacts, if the window has ended by `now` (samples).
    pub fn due(&mut self, now: u64) -> Option<ImpactPulse> {
        (self.pending > 0.0 && self.end <= now).then(|| self.flush(self.end))
    }

    /// Whether an impact at `now` (samples) would pend.
    pub fn is_open(&self, now: u64) -> bool {
        self.end > now
    }

    /// Merges the pending impacts into one at this sample, and opens a new window.
    fn flush(&mut self, sample: u64) -> ImpactPulse {
        let impulse = self.pending.sqrt();
        (self.sounded, self.pending, self.end) = (self.pending, 0.0, sample + WINDOW);
        ImpactPulse { sample, impulse, ..self.strongest }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pulse(milliseconds: u64, impulse: f64) -> ImpactPulse {
        ImpactPulse { sample: milliseconds * 48, impulse, ..ImpactPulse::default() }
    }

    #[test]
    fn impacts_within_a_window_merge_without_loss() {
        let mut window = MergeWindow::default();
        let sound =
            |pulse: Option<ImpactPulse>| pulse.map(|pulse| (pulse.sample / 48, (pulse.impulse * 1e6).round() as i64));
        assert_eq!(sound(window.push(pulse(100, 4e-3))), Some((100, 4000)));
        // Two softer ones pend and sound together: √(2.4² + 3.2²) = 4.
        assert_eq!(sound(window.push(pulse(103, 2.4e-3))), None);
        assert_eq!(sound(window.due(114 * 48)), None);
        assert_eq!(sound(window.push(pulse(114, 3.2e-3))), None);
        assert_eq!(sound(window.due(115 * 48)), Some((115, 4000)));
        // A much louder one sounds at once, together with the pending ones.
        assert_eq!(sound(window.push(pulse(116, 3e-3))), None);
        assert_eq!(sound(window.push(pulse(120, 40e-3))), Some((120, 40112)));
        assert_eq!(sound(window.due(200 * 48)), None);
        assert_eq!(sound(window.push(pulse(200, 1e-6))), Some((200, 1)));
    }
}

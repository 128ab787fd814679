//! The first moment of a breath, in the gallery.
//!
//! Whoever blows has blown for a tenth of a second and more before the ear is sure of it, a finger for as long before it is
//! known not to pull. That air has left the lips, and what it would have done is what the visitor waits to see. So the first
//! moment of a breath that is believed makes up for it, with the impulse of the time that was lost:
//!
//! ```text
//! gain = 1 + 2 L/T · max(0, 1 − t/T)      ∫ (gain − 1) dt = L      t: since the breath was believed, L: lost, s
//! ```
//!
//! What began is seen from the speed alone, so a record of speeds runs again to the bit. Who blows into the soft breath of a
//! demonstration begins too: theirs is at once several times as fast, as no breath becomes by itself. What swells from nothing is
//! hardly moved by it: it is slow while that lasts. The *true* profile makes up for nothing.

/// L: what the ear takes to be sure of a breath, and its sound to come to the ear, s.
const LOST: f64 = 0.15;
/// T: it is made up for within so long, s: three pictures on a screen.
const WITHIN: f64 = 0.05;
/// After so long without one, s, the next breath is a new one: shorter pauses are breath that falters.
const ANEW: f64 = 0.5;
/// A breath that is so many times as fast as in the step before is another one.
const FASTER: f64 = 3.0;

/// How long somebody has blown.
#[derive(Clone, Copy, Debug)]
pub struct Onset {
    /// Since the breath was believed, s.
    blown: f64,
    /// Since there last was any, s.
    quiet: f64,
    /// How fast it was last, m/s.
    speed: f64,
}

impl Default for Onset {
    fn default() -> Self {
        Self { blown: 0.0, quiet: ANEW, speed: 0.0 }
    }
}

impl Onset {
    /// Lets `dt` seconds pass, in which somebody blew at a speed, m/s, or nobody, at 0.
    pub fn advance(&mut self, speed: f64, dt: f64) {
        if speed > 0.0 {
            let faster = self.quiet == 0.0 && speed > FASTER * self.speed;
            self.blown = if self.quiet >= ANEW || faster { 0.0 } else { self.blown + dt };
            (self.quiet, self.speed) = (0.0, speed);
        } else {
            self.quiet += dt;
        }
    }

    /// Did it begin in this step?
    pub fn begins(&self) -> bool {
        self.quiet == 0.0 && self.blown == 0.0
    }

    /// Does it last no longer than what is made up for?
    pub fn is_fresh(&self) -> bool {
        self.quiet == 0.0 && self.blown < WITHIN
    }

    /// Multiplies the force of the breath.
    pub fn gain(&self) -> f64 {
        1.0 + 2.0 * LOST / WITHIN * (1.0 - self.blown / WITHIN).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const DT: f64 = 1.0 / 240.0;

    /// What a breath of a second adds to its own impulse, s.
    fn made_up(onset: &mut Onset, speed: f64) -> f64 {
        let step = |_| {
            onset.advance(speed, DT);
            (onset.gain() - 1.0) * DT
        };
        (0..240).map(step).sum()
    }

    fn pause(onset: &mut Onset, seconds: f64) {
        (0..(seconds / DT) as usize).for_each(|_| onset.advance(0.0, DT));
    }

    #[test]
    fn a_breath_makes_up_for_what_was_lost_and_one_that_falters_does_not_again() {
        // The sum of a falling line over 12 steps, each at its beginning: half a step too much of six.
        const STEPS: f64 = 0.09;
        let mut onset = Onset::default();
        assert!((made_up(&mut onset, 5.0) / LOST - 1.0).abs() < STEPS);
        pause(&mut onset, 0.3);
        assert_eq!(made_up(&mut onset, 5.0), 0.0, "it only falters");
        pause(&mut onset, 0.6);
        assert!((made_up(&mut onset, 5.0) / LOST - 1.0).abs() < STEPS, "another breath");
    }

    #[test]
    fn who_blows_into_a_demonstration_begins_too() {
        let mut onset = Onset::default();
        made_up(&mut onset, 0.6);
        assert!(!onset.begins());
        assert_eq!(made_up(&mut onset, 1.5), 0.0, "it only swells");
        onset.advance(5.0, DT);
        assert!(onset.begins(), "another breath");
        assert!(onset.gain() > 2.0);
    }
}

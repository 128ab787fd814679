//! A sound heard for the thousandth time should be softer than when it was new.
//!
//! A clock in a gallery ticks 7,000 times an hour to whoever sits beside it. Each sounding body counts the hits that are
//! like the one before, within [`ALIKE`]; the count n fades with [`RECOVERY`]. What comes more often than the [`FREE`]
//! first is eased:
//!
//! ```text
//! gain = max(LEAST, (FREE/n)^½)
//! ```
//!
//! 3 dB softer for each doubling, at most 12 dB. A tick a second ends at −3 dB, one in each half second at −6 dB; two minutes of rest,
//! or hits of another strength, make it new. A mobile's hits differ and are not eased.

use soffio_math::{exp, ln};

/// Two impulses are alike within this ratio, 3 dB.
const ALIKE: f64 = 1.41;
/// Hits that cost nothing.
const FREE: f64 = 60.0;
/// Time constant of forgetting, s.
const RECOVERY: f64 = 120.0;
/// Softest, −12 dB.
const LEAST: f64 = 0.251_188_643_150_958;

/// What one sounding body was heard to do lately.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Habit {
    count: f64,
    /// N s.
    impulse: f64,
    /// s.
    time: f64,
}

impl Habit {
    /// Notes a hit at a time, s; its gain.
    pub fn hit(&mut self, impulse: f64, time: f64) -> f32 {
        self.count *= exp((self.time - time).min(0.0) / RECOVERY);
        let alike = impulse > 0.0 && self.impulse > 0.0 && ln(impulse / self.impulse).abs() < ln(ALIKE);
        // Another sound takes as much from the habit as the same one adds.
        self.count = if alike { self.count + 1.0 } else { (self.count - 1.0).max(0.0) };
        (self.impulse, self.time) = (impulse, time);
        (FREE / self.count.max(FREE)).sqrt().max(LEAST) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tick_eases_by_its_formula_and_recovers() {
        let mut habit = Habit::default();
        // 7,200 an hour: the count ends at 1/(1 − e^(−0.5/120)).
        let last = (0..7200).map(|i| habit.hit(1e-4, 0.5 * f64::from(i))).last().expect("hits");
        let count = 1.0 / (1.0 - exp(-0.5 / RECOVERY));
        let wanted = (FREE / count).sqrt();
        assert!((f64::from(last) - wanted).abs() < 1e-3, "{last}, not {wanted}");
        assert_eq!(habit.hit(1e-4, 3600.0 + 3.0 * RECOVERY), 1.0, "after a rest it is new");
    }

    #[test]
    fn hits_that_differ_are_not_eased() {
        let mut random = soffio_math::noise::Random::new(4);
        let mut habit = Habit::default();
        for i in 0..2000 {
            // Two decades, as a mobile's: one in seven is like the one before.
            let impulse = soffio_math::pow(10.0, random.range(-6.0, -4.0));
            assert_eq!(habit.hit(impulse, 0.2 * f64::from(i)), 1.0, "hit {i}");
        }
    }
}

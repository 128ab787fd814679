//! Repetition attenuation: habituation to a sound that repeats.
//!
//! A clock in a gallery ticks 7,000 times an hour for a person beside it. Each sounding body counts the impacts that are
//! similar to the one before, within [`SIMILAR_RATIO`]. The count n decays with [`RECOVERY`]. After the first
//! [`FREE_STRIKES`] the gain falls:
//!
//! ```text
//! gain = max(LEAST_GAIN, (FREE_STRIKES/n)^½)
//! ```
//!
//! 3 dB for each doubling, at most 12 dB. A tick a second ends at −3 dB, two a second at −6 dB. Two minutes of silence, or
//! impacts of another strength, restore it. A mobile's impacts differ and are not attenuated.

use soffio_math::{exp, ln};

/// Ratio of impulses that count as similar: 3 dB, a difference that one just notices between two ticks.
const SIMILAR_RATIO: f64 = 1.41;
/// Repetitions without attenuation: a minute of a clock that ticks once a second. Chosen by ear.
const FREE_STRIKES: f64 = 60.0;
/// Time constant of the count, s: two minutes of silence restore the sound.
const RECOVERY: f64 = 120.0;
/// Least gain, linear: −12 dB, so that a clock stays audible beside it.
const LEAST_GAIN: f64 = 0.251_188_643_150_958;

/// Recent impacts of one sounding body.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct RepetitionAttenuation {
    count: f64,
    /// N s.
    impulse: f64,
    /// s.
    time: f64,
}

impl RepetitionAttenuation {
    /// Counts an impact at a time (s) and returns its gain.
    pub fn strike_gain(&mut self, impulse: f64, time: f64) -> f32 {
        self.count *= exp((self.time - time).min(0.0) / RECOVERY);
        let is_similar = impulse > 0.0 && self.impulse > 0.0 && ln(impulse / self.impulse).abs() < ln(SIMILAR_RATIO);
        // A different impact reduces the count by as much as a similar one adds.
        self.count = if is_similar { self.count + 1.0 } else { (self.count - 1.0).max(0.0) };
        (self.impulse, self.time) = (impulse, time);
        (FREE_STRIKES / self.count.max(FREE_STRIKES)).sqrt().max(LEAST_GAIN) as f32
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tick_is_attenuated_by_the_formula_and_recovers() {
        let mut repetition = RepetitionAttenuation::default();
        // 7,200 an hour: the count ends at 1/(1 − e^(−0.5/120)).
        let last = (0..7200).map(|i| repetition.strike_gain(1e-4, 0.5 * f64::from(i))).last().expect("hits");
        let count = 1.0 / (1.0 - exp(-0.5 / RECOVERY));
        let wanted = (FREE_STRIKES / count).sqrt();
        assert!((f64::from(last) - wanted).abs() < 1e-3, "{last}, not {wanted}");
        assert_eq!(repetition.strike_gain(1e-4, 3600.0 + 3.0 * RECOVERY), 1.0, "after a rest it is new");
    }

    #[test]
    fn impacts_that_differ_are_not_attenuated() {
        let mut random = soffio_math::noise::Random::new(4);
        let mut repetition = RepetitionAttenuation::default();
        for i in 0..2000 {
            // Two decades, as a mobile's: one in seven is like the one before.
            let impulse = soffio_math::pow(10.0, random.range(-6.0, -4.0));
            assert_eq!(repetition.strike_gain(impulse, 0.2 * f64::from(i)), 1.0, "hit {i}");
        }
    }
}

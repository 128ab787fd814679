//! Noise-floor tracker: an asymmetric exponential average per power, fast down and slow up, with limited input.
//!
//! ```text
//! F ← F + w↓ (S − F)                      where S < F
//! F ← F + w↑ (min(S, 4 F + Q) − F)        else
//! ```
//!
//! Symbols: S measured power, F noise floor, Q smallest floor; w↓ and w↑ the weights of a frame in averages over 0.4 and 1.5 s.
//! The limit makes a loud bang, such as a door, raise F by at most 9 dB a second. When a crowd leaves, F falls at once.

use super::bands::blend;

/// Time constant of a falling floor, s.
const DOWN_S: f64 = 0.4;
/// Time constant of a rising floor, s.
const UP_S: f64 = 1.5;
/// A frame's power enters with at most this multiple of the floor.
const MAX_RATIO: f64 = 4.0;

/// Weights of one frame in the noise floor.
#[derive(Clone, Copy, Debug)]
pub struct FloorWeights {
    /// Weight of a power below the floor, w↓.
    pub down: f64,
    /// Weight of a power above the floor, w↑.
    pub up: f64,
}

impl FloorWeights {
    /// The weights once the floor is known.
    pub fn steady() -> Self {
        Self { down: blend(DOWN_S), up: blend(UP_S) }
    }

    /// The weights of the `n`-th frame, from 1: the first frames form a plain mean.
    pub fn nth(n: u64) -> Self {
        let (mean, known) = (1.0 / n.max(1) as f64, Self::steady());
        Self { down: known.down.max(mean), up: known.up.max(mean) }
    }

    /// Updates a floor with a measured power; `min_floor` lets a floor of 0 rise.
    pub fn update(self, floor: &mut f64, power: f64, min_floor: f64) {
        *floor += if power < *floor {
            self.down * (power - *floor)
        } else {
            self.up * (power.min(MAX_RATIO * *floor + min_floor) - *floor)
        };
    }
}

#[cfg(test)]
mod tests {
    use super::super::bands::power_to_db;
    use super::super::spectrum::FRAME_S;
    use super::*;

    /// A noise floor, and the smallest one; power.
    const FLOOR: f64 = 1e-4;
    const MIN_FLOOR: f64 = 1e-8;

    /// Change of a floor after a time, s, of constant power; dB.
    fn change_db(power: f64, seconds: f64) -> f64 {
        let mut floor = FLOOR;
        (0..(seconds / FRAME_S).round() as usize)
            .for_each(|_| FloorWeights::steady().update(&mut floor, power, MIN_FLOOR));
        power_to_db(floor / FLOOR)
    }

    #[test]
    fn any_bang_raises_it_by_nine_decibels_a_second_and_silence_lowers_it_by_eleven() {
        for ratio in [1e2, 1e4, 1e8] {
            let rise = change_db(ratio * FLOOR, 1.0);
            // A power limited to four times the floor adds three floors: 10 lg (1 + 3 w↑) a frame.
            let expected = power_to_db(1.0 + 3.0 * FloorWeights::steady().up) / FRAME_S;
            assert!((rise - expected).abs() < 0.01 && (8.5..9.0).contains(&rise), "{rise} dB by {ratio}");
        }
        let fall = change_db(0.0, 1.0);
        assert!((fall + 10.86).abs() < 0.01, "{fall} dB: 10 lg e^(−1/0.4)");
    }

    #[test]
    fn the_first_frames_form_their_mean() {
        let mut floor = 0.0;
        let power = [4.0, 2.0, 3.0];
        for (n, power) in (1..).zip(power) {
            // A smallest floor of 4 keeps the limit from acting.
            FloorWeights::nth(n).update(&mut floor, power, 4.0);
        }
        assert!((floor - 3.0).abs() < 1e-12, "{floor}");
    }
}

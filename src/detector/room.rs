//! How a room is learnt, power by power: fast down, slowly up, whatever the bang.
//!
//! ```text
//! F ← F + w↓ (S − F)                      where S < F
//! F ← F + w↑ (min(S, 4 F + Q) − F)        else
//! ```
//!
//! Symbols: S the power that is heard, F the room's, Q the quietest that a room is taken to be; w↓ and w↑ the weights of a frame
//! in means over 0.4 and 1.5 s. So a door that falls shut raises F by 9 dB a second at the most, and F comes down at once when a
//! crowd leaves: who blows then is told from the room as it is.

use super::bands::blend;

/// Time constants of both ways, s.
const DOWN_S: f64 = 0.4;
const UP_S: f64 = 1.5;
/// A frame weighs at most so many times the room.
const BANG: f64 = 4.0;

/// What one frame weighs in a room.
#[derive(Clone, Copy, Debug)]
pub struct Weight {
    /// w↓.
    pub down: f64,
    /// w↑.
    pub up: f64,
}

impl Weight {
    /// In a room that has long been known.
    pub fn known() -> Self {
        Self { down: blend(DOWN_S), up: blend(UP_S) }
    }

    /// Of the `n`-th frame that is learnt, from 1: the first ones weigh as in their mean.
    pub fn nth(n: u64) -> Self {
        let (mean, known) = (1.0 / n.max(1) as f64, Self::known());
        Self { down: known.down.max(mean), up: known.up.max(mean) }
    }

    /// Lets a room take in what is heard of a power.
    pub fn learn(self, room: &mut f64, heard: f64, quietest: f64) {
        *room += if heard < *room {
            self.down * (heard - *room)
        } else {
            self.up * (heard.min(BANG * *room + quietest) - *room)
        };
    }
}

#[cfg(test)]
mod tests {
    use super::super::bands::decibels;
    use super::super::spectrum::FRAME_S;
    use super::*;

    /// Power of the room, and what none is taken to be quieter than.
    const ROOM: f64 = 1e-4;
    const QUIETEST: f64 = 1e-8;

    /// A room that hears one power for so long, s, dB over what it was.
    fn after(heard: f64, seconds: f64) -> f64 {
        let mut room = ROOM;
        (0..(seconds / FRAME_S).round() as usize).for_each(|_| Weight::known().learn(&mut room, heard, QUIETEST));
        decibels(room / ROOM)
    }

    #[test]
    fn a_bang_of_any_size_raises_it_by_nine_decibels_a_second_and_silence_sinks_it_by_eleven() {
        for bang in [1e2, 1e4, 1e8] {
            let risen = after(bang * ROOM, 1.0);
            // Of what weighs four times the room it takes in three times its own: 10 lg (1 + 3 w↑) a frame.
            let expected = decibels(1.0 + 3.0 * Weight::known().up) / FRAME_S;
            assert!((risen - expected).abs() < 0.01 && (8.5..9.0).contains(&risen), "{risen} dB by {bang}");
        }
        let sunk = after(0.0, 1.0);
        assert!((sunk + 10.86).abs() < 0.01, "{sunk} dB: 10 lg e^(−1/0.4)");
    }

    #[test]
    fn the_first_frames_are_their_mean() {
        let mut room = 0.0;
        let heard = [4.0, 2.0, 3.0];
        for (n, power) in (1..).zip(heard) {
            // Of what is louder than four times the room, a room takes no more in, but for the quietest of all.
            Weight::nth(n).learn(&mut room, power, 4.0);
        }
        assert!((room - 3.0).abs() < 1e-12, "{room}");
    }
}

//! Detection of automatic gain control (AGC) in the microphone.
//!
//! After a loud breath an automatic gain control is still turned down. So the ambient noise above 0.9 kHz, where breath has no
//! rumble, is quieter than before and recovers slowly. Without gain control it is as loud as before.
//!
//! ```text
//! drop of a band = noise before the breath − noise at the quietest moment of 0.1 to 0.5 s after it,   dB
//! ```
//!
//! A gain turns all bands down alike; a sound of the room that ends during the breath does not. So one breath is enough where the drops of
//! all bands are equal, and two of the last three where they are not.
//!
//! Nothing is compensated. Detection does not depend on the gain, and the mean strength of a breath hardly does: the gain falls back to about
//! where it would be without gain control. What is lost is the difference between a gentle and a hard breath, and the samples no longer hold it.

use super::bands::{BANDS, blend};
use super::spectrum::FRAME_S;

/// Number of bands that are compared: those above 875 Hz.
const COMPARED: usize = 4;
/// Smallest mean drop that counts, dB: the ambient noise itself varies by less.
const DROP_DB: f64 = 6.0;
/// Largest difference between the drops of two bands for one breath to be enough, dB: chosen by trying, on twelve
/// visits with gain control and twelve without (a test).
const EQUAL_DB: f64 = 4.0;
/// Breaths that vote.
const VOTES: usize = 3;
/// Time constants of the averages before a breath and now, s.
const AVERAGES_S: (f64, f64) = (0.5, 0.06);
/// Beginning and end of the search after a breath, s; before it the breath's end dies away.
const WINDOW_S: (f64, f64) = (0.1, 0.5);

/// State of the AGC detector.
#[derive(Clone, Copy, Debug, Default)]
pub struct AgcDetector {
    /// Levels of the compared bands before the breath, a slow average, dB of full scale.
    before: [f64; COMPARED],
    /// The same levels now, a fast average.
    now: [f64; COMPARED],
    /// Number of frames.
    frames: u64,
    /// Time since the last breath, s; `None` once it has been evaluated.
    after: Option<f64>,
    /// Drops at the quietest moment after the breath, dB.
    drops: [f64; COMPARED],
    blowing: bool,
    /// Votes of the last breaths: whether the drops of all bands are equal; `None` for a small drop.
    votes: [Option<bool>; VOTES],
}

impl AgcDetector {
    /// Takes the levels of one frame, dB of full scale.
    pub fn push(&mut self, blowing: bool, levels: &[f64; BANDS]) {
        self.frames += 1;
        let early = 1.0 / self.frames as f64;
        let follow = |average: &mut [f64; COMPARED], seconds: f64| {
            let weight = blend(seconds).max(early);
            average
                .iter_mut()
                .zip(&levels[BANDS - COMPARED..])
                .for_each(|(mean, level)| *mean += weight * (level - *mean));
        };
        follow(&mut self.now, AVERAGES_S.1);
        if blowing {
            self.after = None;
        } else if self.blowing {
            (self.after, self.drops) = (Some(0.0), [f64::NEG_INFINITY; COMPARED]);
        }
        self.blowing = blowing;
        match self.after {
            Some(time) if time > WINDOW_S.1 => {
                self.votes.rotate_left(1);
                self.votes[VOTES - 1] = vote(&self.drops);
                self.after = None;
            }
            Some(time) => {
                self.after = Some(time + FRAME_S);
                let drops = std::array::from_fn(|b| self.before[b] - self.now[b]);
                if time > WINDOW_S.0 && mean(&drops) > mean(&self.drops) {
                    self.drops = drops;
                }
            }
            None if !blowing => follow(&mut self.before, AVERAGES_S.0),
            None => {}
        }
    }

    /// True where an automatic gain control has been detected.
    pub fn is_detected(&self) -> bool {
        self.votes.iter().flatten().count() >= 2 || self.votes.contains(&Some(true))
    }
}

/// The vote of a breath with these drops, dB.
fn vote(drops: &[f64; COMPARED]) -> Option<bool> {
    let (least, most) = drops.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(*x), b.max(*x)));
    (mean(drops) > DROP_DB).then_some(most - least < EQUAL_DB)
}

fn mean(values: &[f64; COMPARED]) -> f64 {
    values.iter().sum::<f64>() / COMPARED as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bands of −60 dB that drop by so much after each of so many breaths of a second, and come back.
    fn after(breaths: usize, drops: [f64; COMPARED]) -> AgcDetector {
        let mut detector = AgcDetector::default();
        let levels = |drops: [f64; COMPARED]| {
            std::array::from_fn(|b| -60.0 - if b < BANDS - COMPARED { 0.0 } else { drops[b - (BANDS - COMPARED)] })
        };
        for _ in 0..breaths {
            (0..400).for_each(|_| detector.push(false, &levels([0.0; COMPARED])));
            (0..125).for_each(|_| detector.push(true, &[-20.0; BANDS]));
            (0..80).for_each(|_| detector.push(false, &levels(drops)));
        }
        detector
    }

    #[test]
    fn one_breath_is_enough_where_all_bands_drop_alike_and_two_where_they_do_not() {
        assert!(!after(3, [5.0; COMPARED]).is_detected(), "5 dB is the scatter of a room");
        assert!(after(1, [12.0, 12.5, 11.5, 12.0]).is_detected());
        let fan = [18.0, 12.0, 8.0, 4.0];
        assert!(!after(1, fan).is_detected(), "a fan that stops takes more from the lower bands");
        assert!(after(2, fan).is_detected());
    }
}

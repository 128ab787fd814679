//! Detection of automatic gain control (AGC) in the microphone.
//!
//! After a loud breath an automatic gain control is still turned down. So the ambient noise above 1.6 kHz, where breath has no
//! rumble, is quieter than before and recovers slowly. Without gain control it is as loud as before.
//!
//! ```text
//! drop = noise before the breath − quietest 0.1 s in the first 0.4 s after it,   dB
//! ```
//!
//! Drops of 6 dB or more after two of the last three breaths mean gain control.

use super::bands::blend;
use super::spectrum::FRAME_S;

/// Smallest drop that counts, dB: the ambient noise itself varies by less.
const DROP_DB: f64 = 6.0;
/// Beginning and end of the search after a breath, s; before it the breath's end dies away.
const WINDOW_S: (f64, f64) = (0.1, 0.5);

/// State of the AGC detector.
#[derive(Clone, Copy, Debug, Default)]
pub struct AgcDetector {
    /// Level of 1.6–3.4 kHz before the breath, a slow average, dB of full scale.
    before: f64,
    /// The same level now, a fast average.
    now: f64,
    /// Number of frames.
    frames: u64,
    /// Time since the last breath, s; `None` once it has been evaluated.
    after: Option<f64>,
    lowest: f64,
    blowing: bool,
    /// Drops after the last three breaths.
    votes: [bool; 3],
}

impl AgcDetector {
    /// Takes the level of one frame above 1.8 kHz, dB of full scale.
    pub fn push(&mut self, blowing: bool, level: f64) {
        self.frames += 1;
        let early = 1.0 / self.frames as f64;
        self.now += blend(0.06).max(early) * (level - self.now);
        if blowing {
            self.after = None;
        } else if self.blowing {
            (self.after, self.lowest) = (Some(0.0), f64::INFINITY);
        }
        self.blowing = blowing;
        match self.after {
            Some(time) if time > WINDOW_S.1 => {
                self.votes = [self.votes[1], self.votes[2], self.before - self.lowest > DROP_DB];
                self.after = None;
            }
            Some(time) => {
                self.after = Some(time + FRAME_S);
                if time > WINDOW_S.0 {
                    self.lowest = self.lowest.min(self.now);
                }
            }
            None if !blowing => self.before += blend(0.5).max(early) * (level - self.before),
            None => {}
        }
    }

    /// True where an automatic gain control has been detected.
    pub fn is_detected(&self) -> bool {
        self.votes.iter().filter(|v| **v).count() >= 2
    }
}

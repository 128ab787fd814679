//! Does the microphone change its own gain?
//!
//! After a loud breath an automatic gain control is still turned down: the room above 1.6 kHz, where a breath's rumble leaves
//! nothing, is quieter than before it, and creeps back. A plain microphone's room is as loud as it was.
//!
//! ```text
//! drop = room before the breath − quietest tenth of a second in the first 0.4 s after it,   dB
//! ```
//!
//! Two of the last three breaths with a drop of 6 dB or more mean a gain control.

use super::features::{Levels, blend};
use super::spectrum::FRAME_S;

/// A smaller drop may be the room itself, dB.
const DROP_DB: f64 = 6.0;
/// How long after a breath its room is looked at, and how long it takes until the breath's end has died away, s.
const LOOK_S: (f64, f64) = (0.1, 0.5);

/// What is known about the gain.
#[derive(Clone, Copy, Debug, Default)]
pub struct GainControl {
    /// Level of the treble before the breath, slow, and now, quick; dB of full scale.
    before: f64,
    now: f64,
    /// Frames heard.
    frames: u64,
    /// Time since the last breath, s; `None` where it has been looked at.
    after: Option<f64>,
    lowest: f64,
    blowing: bool,
    /// What the last three breaths said: 1 a drop.
    votes: [bool; 3],
}

impl GainControl {
    /// Takes one frame.
    pub fn push(&mut self, blowing: bool, levels: &Levels) {
        let level = levels.treble_dbfs;
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
            Some(time) if time > LOOK_S.1 => {
                self.votes = [self.votes[1], self.votes[2], self.before - self.lowest > DROP_DB];
                self.after = None;
            }
            Some(time) => {
                self.after = Some(time + FRAME_S);
                if time > LOOK_S.0 {
                    self.lowest = self.lowest.min(self.now);
                }
            }
            None if !blowing => self.before += blend(0.5).max(early) * (level - self.before),
            None => {}
        }
    }

    /// Has a gain control been at work?
    pub fn seen(&self) -> bool {
        self.votes.iter().filter(|v| **v).count() >= 2
    }
}

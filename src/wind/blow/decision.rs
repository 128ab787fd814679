//! From log-odds to a breath that begins, lasts and ends.
//!
//! A cumulative sum (Page, "Continuous Inspection Schemes", Biometrika 1954) of the log-odds ℓ over time, bounded at
//! both ends:
//!
//! ```text
//! c ← clamp(c + ℓ Δt, 0, C_FULL),   breath begins at c ≥ C_ON, ends at c = 0
//! ```
//!
//! ℓ is believed up to +2.5 only, so that even the surest breath needs C_ON / 2.5 to begin (a pop or a clap does not last
//! that long), and a doubtful one needs longer. No one blows for longer than six seconds: then the sound is latched as
//! a machine's until c is 0 again. Order of phases: quiet → waiting → blow → (latched →) quiet.

use super::features::Levels;
use super::spectrum::FRAME_S;
use crate::math::exp;

/// The low band must rise by this much over the room, dB.
pub const LEAST_RISE_DB: f64 = 6.0;
/// Log-odds are believed down and up to here, nats.
const BELIEVED: (f64, f64) = (-5.0, 2.5);
/// A breath begins at this sum, nat·s.
const C_ON: f64 = 0.16;
/// The sum never exceeds this, so that a breath ends in time, nat·s.
const C_FULL: f64 = 0.25;
/// Longest breath, s.
const LONGEST_S: f64 = 6.0;

/// Where a breath stands.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Phase {
    /// No sign of breath.
    #[default]
    Quiet,
    /// Like breath, not long enough yet.
    Waiting,
    /// Somebody blows.
    Blow,
    /// Longer than a breath.
    Latched,
}

/// The state of the decision.
#[derive(Clone, Debug, Default)]
pub struct Decision {
    /// Where the breath stands.
    pub phase: Phase,
    /// The cumulative sum c, nat·s.
    sum: f64,
    /// Log-odds of the last frame, bounded.
    log_odds: f64,
    blowing_s: f64,
}

impl Decision {
    /// Takes one frame; `None` where a frame cannot be breath at all.
    pub fn push(&mut self, log_odds: Option<f64>, levels: &Levels) {
        let possible = log_odds.filter(|_| levels.rise_db > LEAST_RISE_DB);
        self.log_odds = possible.map_or(BELIEVED.0, |l| l.clamp(BELIEVED.0, BELIEVED.1));
        self.sum = (self.sum + self.log_odds * FRAME_S).clamp(0.0, C_FULL);
        self.phase = match self.phase {
            _ if self.sum == 0.0 => Phase::Quiet,
            Phase::Quiet | Phase::Waiting if self.sum < C_ON => Phase::Waiting,
            Phase::Quiet | Phase::Waiting => {
                self.blowing_s = 0.0;
                Phase::Blow
            }
            Phase::Blow if self.blowing_s > LONGEST_S => Phase::Latched,
            Phase::Blow => {
                self.blowing_s += FRAME_S;
                Phase::Blow
            }
            Phase::Latched => Phase::Latched,
        };
    }

    /// 0 … 1: how far the sum is on its way to a breath, weighed with the last frame's probability.
    pub fn confidence(&self) -> f64 {
        let probability = 1.0 / (1.0 + exp(-self.log_odds));
        (self.sum / C_ON).min(1.0) * probability
    }
}

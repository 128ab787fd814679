//! From log-odds to a breath that begins, lasts and ends.
//!
//! A cumulative sum (Page, "Continuous Inspection Schemes", Biometrika 1954) of the log-odds ℓ over time, bounded at
//! both ends:
//!
//! ```text
//! c ← clamp(c + (ℓ − drift) Δt, 0, full),   breath begins at c ≥ on, ends at c = 0
//! ```
//!
//! ℓ is believed within bounds only: the surest breath needs on / (highest − drift) to begin (a pop or a clap does not
//! last that long), and a doubtful one needs longer; what is no more likely than e^drift never begins. Where the kiosk's own
//! sound covers the low band, what its prediction leaves is scattered: a breath that begins there takes longer. So does one
//! that begins soon after another, while the kiosk rings and who has blown turns to go; what hangs there moves anyhow. No one blows
//! for longer than six seconds, pauses that are shorter than half as long included: then the sound is latched as a
//! machine's, and belongs to the room, until it has been silent for a moment or unlike breath for seconds. Order of
//! phases: quiet → waiting → blow → (latched →) quiet.

use super::features::{Levels, blend};
use super::spectrum::FRAME_S;
use soffio_math::exp;

/// Something must rise by this much over the room, dB.
pub const LEAST_RISE_DB: f64 = 5.0;

/// Log-odds from which a sound may be a breath that the room must not learn, nats; and for how long at most, s.
const LIKELY: f64 = 1.0;
const UNDECIDED_S: f64 = 1.0;
/// Breath that is saved up in each second of a pause, s/s: who blows in puffs may go on, a fan that falters may not.
const RECOVERY: f64 = 2.0;
/// A latched sound is over when nothing has been like breath for this long, s. Silence, so far below it, counts more: who has
/// blown for six seconds breathes in, while a fan has lulls.
const OVER_S: f64 = 2.0;
const SILENCE_DB: f64 = -12.0;
const SILENCE: f64 = 6.0;
/// Soon after another breath: within this time of its end, s. Works ring for several seconds, and who has blown talks and goes.
const AGAIN_S: f64 = 10.0;
/// What somebody blew is remembered over this time, s.
const BLOWN_S: f64 = 0.5;

/// The numbers of the cumulative sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// Log-odds are believed down and up to here, nats.
    pub believed: (f64, f64),
    /// What log-odds must exceed to count for breath while nobody blows, nats.
    pub drift: f64,
    /// A breath begins at this sum, nat·s.
    pub on: f64,
    /// And at this one where the kiosk's own sound covers it.
    pub on_covered: f64,
    /// And at this one soon after another breath.
    pub on_again: f64,
    /// The sum never exceeds this, so that a breath ends in time, nat·s.
    pub full: f64,
    /// Longest breath, s.
    pub longest_s: f64,
}

impl Default for Rules {
    fn default() -> Self {
        Self { believed: (-4.0, 9.0), drift: 2.9, on: 0.17, on_covered: 0.2, on_again: 0.24, full: 0.3, longest_s: 6.0 }
    }
}

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
    /// How far it is on its way to a breath, 0 … 1.
    progress: f64,
    /// Log-odds of the last frame, bounded.
    log_odds: f64,
    /// The last frame was weighed at all.
    possible: bool,
    /// For how long somebody has blown, pauses taken off.
    blowing_s: f64,
    /// For how much longer a breath comes soon after another one, s.
    again_s: f64,
    /// For how long the sum has been 0, silence counted more.
    still_s: f64,
    /// How loud the last breath was, dB of full scale.
    blown_dbfs: f64,
    /// For how long breath has been likely, s.
    likely_s: f64,
}

impl Decision {
    /// Takes one frame; `None` where a frame cannot be breath at all.
    pub fn push(&mut self, rules: &Rules, log_odds: Option<f64>, levels: &Levels) {
        let possible = log_odds.filter(|_| levels.most_db() > LEAST_RISE_DB);
        self.possible = possible.is_some();
        self.log_odds = possible.map_or(rules.believed.0, |l| l.clamp(rules.believed.0, rules.believed.1));
        let drift = if self.phase == Phase::Blow { 0.0 } else { rules.drift };
        self.sum = (self.sum + (self.log_odds - drift) * FRAME_S).clamp(0.0, rules.full);
        self.likely_s = if self.log_odds > LIKELY { self.likely_s + FRAME_S } else { 0.0 };
        let on = match (self.again_s > 0.0, levels.covered) {
            (true, _) => rules.on_again,
            (false, true) => rules.on_covered,
            (false, false) => rules.on,
        };
        self.progress = (self.sum / on).min(1.0);
        let silent = levels.loud_dbfs < self.blown_dbfs + SILENCE_DB;
        let still = if silent { SILENCE * FRAME_S } else { FRAME_S };
        self.still_s = if self.sum == 0.0 { self.still_s + still } else { 0.0 };
        self.phase = match self.phase {
            Phase::Latched if self.still_s < OVER_S => Phase::Latched,
            Phase::Latched => {
                self.blowing_s = 0.0;
                Phase::Quiet
            }
            _ if self.sum == 0.0 => Phase::Quiet,
            Phase::Quiet | Phase::Waiting if self.sum < on => Phase::Waiting,
            Phase::Quiet | Phase::Waiting | Phase::Blow if self.blowing_s > rules.longest_s => Phase::Latched,
            Phase::Quiet | Phase::Waiting | Phase::Blow => Phase::Blow,
        };
        if self.phase == Phase::Blow {
            let blend = if self.blowing_s == 0.0 { 1.0 } else { blend(BLOWN_S) };
            self.blown_dbfs += blend * (levels.loud_dbfs - self.blown_dbfs);
        }
        self.again_s = if self.phase == Phase::Blow { AGAIN_S } else { (self.again_s - FRAME_S).max(0.0) };
        let change = if self.phase == Phase::Blow { FRAME_S } else { -RECOVERY * FRAME_S };
        self.blowing_s = (self.blowing_s + change).max(0.0);
    }

    /// May this be a breath that has not been decided yet? Then the room must not learn it; but not for long.
    pub fn is_likely(&self) -> bool {
        self.phase != Phase::Latched && self.likely_s > 0.0 && self.likely_s < UNDECIDED_S
    }

    /// Was the last frame weighed at all?
    pub fn is_possible(&self) -> bool {
        self.possible
    }

    /// 0 … 1: how far the sum is on its way to a breath.
    pub fn progress(&self) -> f64 {
        self.progress
    }

    /// 0 … 1: how far the sum is on its way to a breath, weighed with the last frame's probability.
    pub fn confidence(&self) -> f64 {
        let probability = 1.0 / (1.0 + exp(-self.log_odds));
        self.progress * probability
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Breath as likely as it is for the most part, nats.
    const LIKELY_BREATH: f64 = 6.5;

    fn frames(seconds: f64) -> usize {
        (seconds / FRAME_S).round() as usize
    }

    /// Frames until a breath begins, which lasts for a second then.
    fn begins_after(decision: &mut Decision, rules: &Rules) -> usize {
        let risen = Levels { rise_db: 20.0, ..Levels::default() };
        let push = |decision: &mut Decision| {
            decision.push(rules, Some(LIKELY_BREATH), &risen);
            decision.phase == Phase::Blow
        };
        let waited = (1..100).find(|_| push(decision)).expect("it begins");
        (0..frames(1.0)).for_each(|_| assert!(push(decision), "it lasts"));
        waited
    }

    #[test]
    fn a_breath_begins_at_its_sum_and_soon_after_another_one_at_a_larger_one() {
        let (rules, mut decision) = (Rules::default(), Decision::default());
        let pause = |decision: &mut Decision, seconds: f64| {
            (0..frames(seconds)).for_each(|_| decision.push(&rules, None, &Levels::default()));
        };
        let at = |sum: f64| (sum / ((LIKELY_BREATH - rules.drift) * FRAME_S)).ceil() as usize;
        assert_eq!(begins_after(&mut decision, &rules), at(rules.on));
        pause(&mut decision, 1.0);
        assert_eq!(begins_after(&mut decision, &rules), at(rules.on_again), "soon");
        pause(&mut decision, AGAIN_S + 1.0);
        assert_eq!(begins_after(&mut decision, &rules), at(rules.on), "later");
    }
}

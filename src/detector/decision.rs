//! Sequential detection: a cumulative sum (CUSUM) of log-odds decides when a breath begins and ends.
//!
//! The log-odds ℓ are summed over time and bounded at both ends (Page, "Continuous Inspection Schemes", Biometrika 1954):
//!
//! ```text
//! c ← clamp(c + (ℓ − drift) Δt, 0, full),   breath begins at c ≥ on, ends at c = 0
//! ```
//!
//! There is no drift during a breath. A full sum is the hold through a dip: with the lowest ℓ it lasts full / 4 nats = 75 ms.
//!
//! ℓ is clamped first. So even the surest breath needs on / (limit − drift) to begin, which is longer than a pop or a clap. A
//! doubtful breath needs longer, and one with ℓ below the drift never begins.
//!
//! The threshold `on` is higher where the loudspeaker's echo masks the low band, since the residual of its prediction scatters.
//! It is also higher for 10 s after a breath, while the kiosk still sounds and the visitor leaves; this avoids false triggers.
//!
//! No breath lasts longer than six seconds; pauses shorter than half the breath do not reset that time. A longer sound times out:
//! it counts as a machine and enters the noise floor. The time-out ends after a moment of silence, or after seconds unlike
//! breath. Order of phases: quiet → pending → blow → (timed out →) quiet.

use super::features::{Levels, blend};
use super::spectrum::FRAME_S;
use soffio_math::exp;

/// Smallest rise of a breath over the noise floor, dB.
pub const MIN_RISE_DB: f64 = 5.0;

/// Log-odds from which a sound may be a breath, nats: the noise floor is frozen then.
const LIKELY: f64 = 1.0;
/// Longest such freeze without a detected breath, s.
const UNDECIDED_S: f64 = 1.0;
/// Breathing time that is recovered in each second of a pause, s/s. Puffs may continue, an unsteady fan may not.
const RECOVERY: f64 = 2.0;
/// A time-out ends when nothing has been like breath for this long, s.
const OVER_S: f64 = 2.0;
/// Silence is this far below the level of the breath, dB.
const SILENCE_DB: f64 = -12.0;
/// A moment of silence counts this many times: a visitor breathes in after six seconds, while a fan only has lulls.
const SILENCE: f64 = 6.0;
/// Time after a breath with a higher threshold, s. Exhibits sound for several seconds, and visitors talk and leave.
const AGAIN_S: f64 = 10.0;
/// Time constant of the level of a breath, s.
const BREATH_LEVEL_S: f64 = 0.5;

/// Parameters of the cumulative sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// Log-odds are clamped to this range, nats.
    pub log_odds_limits: (f64, f64),
    /// Log-odds that are subtracted while no breath is detected, nats.
    pub drift: f64,
    /// Sum at which a breath begins, nat·s.
    pub on: f64,
    /// Sum at which a breath begins while the loudspeaker's echo masks the low band, nat·s.
    pub on_masked: f64,
    /// Sum at which a breath begins within 10 s of another one, nat·s.
    pub on_again: f64,
    /// Largest sum, nat·s: it bounds the time in which a breath ends.
    pub full: f64,
    /// Longest breath, s.
    pub longest_s: f64,
}

impl Default for Rules {
    fn default() -> Self {
        Self {
            log_odds_limits: (-4.0, 9.0),
            drift: 2.9,
            on: 0.17,
            on_masked: 0.2,
            on_again: 0.24,
            full: 0.3,
            longest_s: 6.0,
        }
    }
}

/// Phase of the decision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Phase {
    /// No sign of breath.
    #[default]
    Quiet,
    /// Like breath, but not for long enough yet.
    Pending,
    /// A breath.
    Blow,
    /// Longer than a breath.
    TimedOut,
}

/// State of the decision.
#[derive(Clone, Debug, Default)]
pub struct Decision {
    /// Phase of the decision.
    pub phase: Phase,
    /// The cumulative sum c, nat·s.
    sum: f64,
    /// Progress towards a breath, 0 … 1.
    progress: f64,
    /// Log-odds of the last frame, clamped, nats.
    log_odds: f64,
    /// The last frame could be a breath.
    possible: bool,
    /// Breathing time, less the recovery of pauses, s.
    blowing_s: f64,
    /// Remaining time of the higher threshold, s.
    again_s: f64,
    /// Time for which the sum has been 0, s; silence counts more.
    idle_s: f64,
    /// Level of the last breath, dB of full scale.
    breath_dbfs: f64,
    /// Time for which breath has been likely, s.
    likely_s: f64,
}

impl Decision {
    /// Takes one frame; `None` where no breath may begin or continue.
    pub fn push(&mut self, rules: &Rules, log_odds: Option<f64>, levels: &Levels) {
        let possible = log_odds.filter(|_| levels.max_rise_db() > MIN_RISE_DB);
        self.possible = possible.is_some();
        self.log_odds =
            possible.map_or(rules.log_odds_limits.0, |l| l.clamp(rules.log_odds_limits.0, rules.log_odds_limits.1));
        let drift = if self.phase == Phase::Blow { 0.0 } else { rules.drift };
        self.sum = (self.sum + (self.log_odds - drift) * FRAME_S).clamp(0.0, rules.full);
        self.likely_s = if self.log_odds > LIKELY { self.likely_s + FRAME_S } else { 0.0 };
        let on = match (self.again_s > 0.0, levels.masked) {
            (true, _) => rules.on_again,
            (false, true) => rules.on_masked,
            (false, false) => rules.on,
        };
        self.progress = (self.sum / on).min(1.0);
        let silent = levels.loud_dbfs < self.breath_dbfs + SILENCE_DB;
        let idle = if silent { SILENCE * FRAME_S } else { FRAME_S };
        self.idle_s = if self.sum == 0.0 { self.idle_s + idle } else { 0.0 };
        self.phase = match self.phase {
            Phase::TimedOut if self.idle_s < OVER_S => Phase::TimedOut,
            Phase::TimedOut => {
                self.blowing_s = 0.0;
                Phase::Quiet
            }
            _ if self.sum == 0.0 => Phase::Quiet,
            Phase::Quiet | Phase::Pending if self.sum < on => Phase::Pending,
            Phase::Quiet | Phase::Pending | Phase::Blow if self.blowing_s > rules.longest_s => Phase::TimedOut,
            Phase::Quiet | Phase::Pending | Phase::Blow => Phase::Blow,
        };
        if self.phase == Phase::Blow {
            let blend = if self.blowing_s == 0.0 { 1.0 } else { blend(BREATH_LEVEL_S) };
            self.breath_dbfs += blend * (levels.loud_dbfs - self.breath_dbfs);
        }
        self.again_s = if self.phase == Phase::Blow { AGAIN_S } else { (self.again_s - FRAME_S).max(0.0) };
        let change = if self.phase == Phase::Blow { FRAME_S } else { -RECOVERY * FRAME_S };
        self.blowing_s = (self.blowing_s + change).max(0.0);
    }

    /// True where a breath is likely and not decided yet, for at most one second: the noise floor must not learn it.
    pub fn is_likely(&self) -> bool {
        self.phase != Phase::TimedOut && self.likely_s > 0.0 && self.likely_s < UNDECIDED_S
    }

    /// True where the last frame could be a breath.
    pub fn is_possible(&self) -> bool {
        self.possible
    }

    /// Progress of the sum towards a breath, 0 … 1.
    pub fn progress(&self) -> f64 {
        self.progress
    }

    /// Progress of the sum times the probability of breath in the last frame, 0 … 1.
    pub fn confidence(&self) -> f64 {
        let probability = 1.0 / (1.0 + exp(-self.log_odds));
        self.progress * probability
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Typical log-odds of a breath, nats.
    const LIKELY_BREATH: f64 = 6.5;

    fn frames(seconds: f64) -> usize {
        (seconds / FRAME_S).round() as usize
    }

    /// Frames until a breath begins; then it must last for a second.
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
    fn a_breath_begins_at_its_threshold_and_at_a_higher_one_soon_after_another() {
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

//! Sequential detection: a cumulative sum (CUSUM) of log-odds decides when a breath begins and ends.
//!
//! The log-odds ℓ are summed over time and bounded at both ends (Page, "Continuous Inspection Schemes", Biometrika 41, 1954):
//!
//! ```text
//! c ← clamp(c + (clamp(ℓ, ℓ₋, ℓ₊) − drift) Δt, 0, full),   breath begins at c ≥ on, ends at c = 0
//! ```
//!
//! So even the surest breath needs on / (ℓ₊ − drift) to begin, a doubtful one longer, and one with ℓ below the drift never begins.
//! During a breath there is no drift. The sure end needs full / |ℓ₋|, so that a breath lasts through short dips.

use super::spectrum::FRAME_S;
use soffio_math::exp;

/// Parameters of the cumulative sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// ℓ₋ and ℓ₊: log-odds are clamped to this range, nats.
    pub log_odds_limits: (f64, f64),
    /// Log-odds that are subtracted while no breath is detected, nats.
    pub drift: f64,
    /// Sum at which a breath begins, nat·s.
    pub on: f64,
    /// Largest sum, nat·s: it bounds the time in which a breath ends.
    pub full: f64,
}

impl Default for Rules {
    fn default() -> Self {
        Self { log_odds_limits: (-3.0, 5.0), drift: 1.0, on: 0.12, full: 0.3 }
    }
}

/// State of the decision.
#[derive(Clone, Copy, Debug, Default)]
pub struct Decision {
    /// A breath is detected.
    pub blowing: bool,
    /// The cumulative sum c, nat·s.
    sum: f64,
    /// Progress of the sum towards a breath, 0 … 1.
    pub progress: f64,
    /// Log-odds of the last frame, clamped, nats.
    log_odds: f64,
}

impl Decision {
    /// Takes the log-odds of one frame, nats; `None` where no breath may begin or continue.
    pub fn push(&mut self, rules: &Rules, log_odds: Option<f64>) {
        let (least, most) = rules.log_odds_limits;
        self.log_odds = log_odds.map_or(least, |odds| odds.clamp(least, most));
        let drift = if self.blowing { 0.0 } else { rules.drift };
        self.sum = (self.sum + (self.log_odds - drift) * FRAME_S).clamp(0.0, rules.full);
        self.progress = (self.sum / rules.on).min(1.0);
        self.blowing = if self.blowing { self.sum > 0.0 } else { self.sum >= rules.on };
    }

    /// Progress of the sum times the probability of breath in the last frame, 0 … 1.
    pub fn confidence(&self) -> f64 {
        self.progress / (1.0 + exp(-self.log_odds))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Frames of constant log-odds until a breath begins or ends.
    fn frames_until(decision: &mut Decision, blowing: bool, log_odds: f64) -> Option<usize> {
        (1..1000).find(|_| {
            decision.push(&Rules::default(), Some(log_odds));
            decision.blowing == blowing
        })
    }

    #[test]
    fn a_breath_begins_and_ends_as_the_sum_says() {
        let (rules, mut decision) = (Rules::default(), Decision::default());
        assert_eq!(frames_until(&mut decision, true, rules.drift), None, "doubtful for ever");
        let begins = (rules.on / ((rules.log_odds_limits.1 - rules.drift) * FRAME_S)).ceil() as usize;
        assert_eq!(frames_until(&mut decision, true, 100.0), Some(begins));
        assert_eq!(frames_until(&mut decision, false, 100.0), None, "it lasts");
        let ends = (rules.full / (-rules.log_odds_limits.0 * FRAME_S)).ceil() as usize;
        assert_eq!(frames_until(&mut decision, false, -100.0), Some(ends));
    }
}

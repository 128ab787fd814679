//! Sequential detection: a cumulative sum (CUSUM) of log-odds decides when a breath begins and ends.
//!
//! The log-odds ℓ are summed over time and bounded at both ends (Page, "Continuous Inspection Schemes", Biometrika 41, 1954):
//!
//! ```text
//! c ← clamp(c + clamp(ℓ − drift, ℓ₋, ℓ₊) Δt, 0, full),   breath begins at c ≥ on, ends at c = 0
//! ```
//!
//! So even the surest breath needs on / ℓ₊ to begin, a doubtful one longer, and one with ℓ below the drift never begins. With one capsule
//! the drift is higher, since more sounds resemble a breath there. While a breath lasts the drift is negative: a breath that fades into
//! a noise floor that has risen with it goes on. The sure end needs full / |ℓ₋|, so that a breath lasts through short dips.
//!
//! The parameters were chosen on the examining generator's breaths and noises (`src/examination`).

use super::spectrum::FRAME_S;
use soffio_math::exp;

/// Parameters of the cumulative sum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// ℓ₋ and ℓ₊: log-odds over the drift are clamped to this range, nats.
    pub limits: (f64, f64),
    /// Drift while no breath is detected, with one capsule and with two, nats.
    pub drift: [f64; 2],
    /// Drift during a breath, nats.
    pub held_drift: f64,
    /// Sum at which a breath begins, nat·s.
    pub on: f64,
    /// Largest sum, nat·s: it bounds the time in which a breath ends.
    pub full: f64,
}

impl Default for Rules {
    fn default() -> Self {
        Self { limits: (-4.0, 5.0), drift: [0.5, 0.0], held_drift: -1.0, on: 0.12, full: 0.3 }
    }
}

/// State of the decision.
#[derive(Clone, Copy, Debug, Default)]
pub struct Decision {
    /// A breath is detected.
    pub blowing: bool,
    /// Length of the breath so far, s.
    pub seconds: f64,
    /// The cumulative sum c, nat·s.
    sum: f64,
    /// Progress of the sum towards a breath, 0 … 1.
    pub progress: f64,
    /// Log-odds of the last frame over the drift, clamped, nats.
    log_odds: f64,
}

impl Decision {
    /// Takes the log-odds of one frame from `capsules` capsules, nats; `None` where no breath may begin or continue.
    pub fn push(&mut self, rules: &Rules, log_odds: Option<f64>, capsules: usize) {
        let (least, most) = rules.limits;
        let drift = if self.blowing { rules.held_drift } else { rules.drift[capsules - 1] };
        self.seconds = if self.blowing { self.seconds + FRAME_S } else { 0.0 };
        self.log_odds = log_odds.map_or(least, |odds| (odds - drift).clamp(least, most));
        self.sum = (self.sum + self.log_odds * FRAME_S).clamp(0.0, rules.full);
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
            decision.push(&Rules::default(), Some(log_odds), 1);
            decision.blowing == blowing
        })
    }

    #[test]
    fn a_breath_begins_and_ends_as_the_sum_says() {
        let (rules, mut decision) = (Rules::default(), Decision::default());
        assert_eq!(frames_until(&mut decision, true, rules.drift[0]), None, "doubtful for ever");
        let begins = (rules.on / (rules.limits.1 * FRAME_S)).ceil() as usize;
        assert_eq!(frames_until(&mut decision, true, 100.0), Some(begins));
        assert_eq!(frames_until(&mut decision, false, rules.held_drift), None, "it lasts, though doubtful");
        frames_until(&mut decision, false, 100.0);
        let ends = (rules.full / (-rules.limits.0 * FRAME_S)).ceil() as usize;
        assert_eq!(frames_until(&mut decision, false, -100.0), Some(ends));
    }
}

//! The automatic choice: when the laws take longer than an exhibit's budget the figure is moved by places, and by the laws
//! again when the machine can. Poses and velocities go over as they are, so nobody sees the change.
//!
//! What a step costs is what its thread worked for it, lately: the median of the last 120 steps, so that neither a
//! single slow step nor a single fast one says anything. By places the cost of the laws is not known, so they are tried
//! again after a while; each time that fails the next try waits twice as long, as a machine that is too slow stays so.
//!
//! The governor only looks: what it answers goes into the step as an input, so that a run repeats with the same answers.

use soffio_exhibit::Motion;
use soffio_simulation::{MotionMode, STEPS_PER_SECOND};

/// Steps that are looked at: half a second.
const WINDOW: usize = 120;
/// Share of the budget that the laws keep to before they are believed to have got through.
const COMFORT: f64 = 0.8;
/// Seconds by places before the laws are tried again, at first and at most.
const WAITS: (f64, f64) = (5.0, 320.0);
/// Seconds of the laws within the budget after which a failure is forgotten.
const PROVEN: f64 = 30.0;

/// Chooses what moves an exhibit.
#[derive(Clone, Debug)]
pub struct Governor {
    budget: Option<f64>,
    places: bool,
    costs: Vec<f64>,
    next: usize,
    /// Steps since the last change.
    since: u64,
    /// Seconds by places after the next failure.
    wait: f64,
    switches: u64,
}

impl Governor {
    /// For an exhibit; an exhibit that chose for itself is left alone.
    pub fn new(motion: Motion) -> Self {
        let budget = match motion {
            Motion::Auto { budget } => Some(budget),
            Motion::Laws | Motion::Places(_) => None,
        };
        Self { budget, places: false, costs: Vec::with_capacity(WINDOW), next: 0, since: 0, wait: WAITS.0, switches: 0 }
    }

    /// What moves the next step; `None` leaves it to the exhibit.
    pub fn mode(&self) -> Option<MotionMode> {
        self.places.then_some(MotionMode::PositionBased)
    }

    /// Changes so far.
    pub fn switches(&self) -> u64 {
        self.switches
    }

    /// Takes notice of what a step cost, s of processor time. Says whether the choice changed.
    pub fn note(&mut self, cost: f64) -> bool {
        let Some(budget) = self.budget else { return false };
        if self.costs.len() < WINDOW {
            self.costs.push(cost);
        } else {
            self.costs[self.next] = cost;
        }
        self.next = (self.next + 1) % WINDOW;
        self.since += 1;
        let lasted = self.since as f64 / STEPS_PER_SECOND as f64;
        if self.places {
            return lasted >= self.wait && self.change();
        }
        if self.costs.len() < WINDOW {
            return false;
        }
        let median = self.median();
        if median > budget {
            return self.change();
        }
        if lasted > PROVEN && median < COMFORT * budget {
            self.wait = WAITS.0;
        }
        false
    }

    fn change(&mut self) -> bool {
        if self.places {
            // Should it fail again, the next try comes later.
            self.wait = (2.0 * self.wait).min(WAITS.1);
        }
        self.places = !self.places;
        self.switches += 1;
        self.since = 0;
        self.costs.clear();
        self.next = 0;
        true
    }

    fn median(&self) -> f64 {
        let mut sorted = [0.0; WINDOW];
        sorted.copy_from_slice(&self.costs);
        sorted.sort_unstable_by(f64::total_cmp);
        sorted[WINDOW / 2]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BUDGET: f64 = 2e-3;

    /// Steps of seconds that cost so much by the laws and nothing by places; how many of them the laws moved.
    fn run(governor: &mut Governor, seconds: f64, cost: f64) -> usize {
        (0..(seconds * STEPS_PER_SECOND as f64) as usize)
            .filter(|_| {
                let laws = governor.mode().is_none();
                governor.note(if laws { cost } else { 1e-6 });
                laws
            })
            .count()
    }

    #[test]
    fn half_a_second_over_the_budget_changes_and_a_single_slow_step_does_not() {
        let mut governor = Governor::new(Motion::Auto { budget: BUDGET });
        run(&mut governor, 10.0, 1e-3);
        run(&mut governor, 0.02, 0.1);
        run(&mut governor, 10.0, 1e-3);
        assert_eq!((governor.switches(), governor.mode()), (0, None));
        run(&mut governor, 0.3, 3e-3);
        assert_eq!(governor.mode(), Some(MotionMode::PositionBased));
        assert_eq!(governor.switches(), 1);
    }

    #[test]
    fn a_machine_that_is_too_slow_tries_ever_more_rarely_and_one_that_recovers_returns() {
        let mut governor = Governor::new(Motion::Auto { budget: BUDGET });
        let by_laws = run(&mut governor, 600.0, 3e-3);
        // 5 + 10 + 20 + … + 320 s: seven tries of half a second each.
        println!("{by_laws} steps by the laws, {} changes", governor.switches());
        assert!(by_laws <= 8 * (WINDOW + 1), "{by_laws}");
        run(&mut governor, WAITS.1 + 1.0, 1e-3);
        assert_eq!(governor.mode(), None);
        run(&mut governor, PROVEN + 1.0, 1e-3);
        assert_eq!(governor.wait, WAITS.0, "what was slow once is forgotten");
    }

    #[test]
    fn an_exhibit_that_chose_for_itself_is_left_alone() {
        for motion in [Motion::Laws, Motion::Places(soffio_multibody::procedural::Method::Compulsive)] {
            let mut governor = Governor::new(motion);
            run(&mut governor, 10.0, 1.0);
            assert_eq!((governor.switches(), governor.mode()), (0, None));
        }
    }
}

//! Automatic choice of the solver: where dynamics takes longer than an exhibit's budget, position-based motion takes over if
//! it is clearly cheaper, until dynamics fits again. Poses and velocities are kept, so the change is invisible.
//!
//! ```text
//! cost of a mode   = median of its last 5 steps, s of processor time
//! to the cheaper   when dynamics costs more than the budget, and position-based motion, if its cost is known, at most
//!                  0.7 of that
//! back             when position-based motion costs more than 0.7 of what dynamics did, or after a while, to try
//! ```
//!
//! A median of five exceeds the budget from the third late step on; one or two slow steps, caused by the system, never change
//! it. The cost of position-based motion is measured in a trial of five steps. A failed trial of either mode doubles the wait
//! before the next one, because a slow machine stays slow. The cost of position-based motion in a failed trial is stored, and
//! there is no new trial until dynamics costs clearly more or the wait is over.
//!
//! The governor's choice is an input of the step, so that a recorded run repeats it.

use soffio_exhibit::Motion;
use soffio_simulation::{MotionMode, STEPS_PER_SECOND};

/// Steps whose median is a mode's cost.
const WINDOW: usize = 5;
/// Largest cost of position-based motion, as a share of that of dynamics, at which it is chosen.
const CHEAPER: f64 = 0.7;
/// Share of the budget below which dynamics fits well.
const COMFORT: f64 = 0.8;
/// Shortest and longest wait before a trial that follows a failed one, s.
const WAITS: (f64, f64) = (1.0, 64.0);
/// Time of dynamics within the budget after which failed trials are forgotten, s.
const PROVEN: f64 = 30.0;

/// The last steps of a mode.
#[derive(Clone, Copy, Debug, Default)]
struct Costs {
    last: [f64; WINDOW],
    steps: usize,
}

impl Costs {
    fn add(&mut self, cost: f64) {
        self.last[self.steps % WINDOW] = cost;
        self.steps += 1;
    }

    /// Median cost, s; missing steps count as 0.
    fn median(&self) -> f64 {
        let mut sorted = self.last;
        sorted.sort_unstable_by(f64::total_cmp);
        sorted[WINDOW / 2]
    }

    /// Is the window full?
    fn known(&self) -> bool {
        self.steps >= WINDOW
    }
}

/// Chooses the solver of an exhibit.
#[derive(Clone, Debug)]
pub struct Governor {
    budget: Option<f64>,
    position_based: bool,
    dynamics: Costs,
    positions: Costs,
    /// Cost of dynamics at the last change to position-based motion, s.
    given_up: f64,
    /// Cost of position-based motion in its last failed trial, s.
    too_dear: Option<f64>,
    /// Steps since the last change.
    since: u64,
    /// Seconds until the next trial.
    wait: f64,
    switches: u64,
}

impl Governor {
    /// For an exhibit; one with a fixed solver never changes.
    pub fn new(motion: Motion) -> Self {
        let budget = match motion {
            Motion::Auto { budget } => Some(budget),
            Motion::Dynamics | Motion::PositionBased(_) => None,
        };
        Self {
            budget,
            position_based: false,
            dynamics: Costs::default(),
            positions: Costs::default(),
            given_up: 0.0,
            too_dear: None,
            since: 0,
            wait: WAITS.0,
            switches: 0,
        }
    }

    /// Solver of the next step; `None` is the exhibit's own.
    pub fn mode(&self) -> Option<MotionMode> {
        self.position_based.then_some(MotionMode::PositionBased)
    }

    /// Changes so far.
    pub fn switches(&self) -> u64 {
        self.switches
    }

    /// Records the cost of a step, s of processor time. Returns whether the choice changed.
    pub fn record(&mut self, cost: f64) -> bool {
        let Some(budget) = self.budget else { return false };
        self.since += 1;
        let lasted = self.since as f64 / STEPS_PER_SECOND as f64;
        if self.position_based {
            self.positions.add(cost);
            let dear = self.positions.known() && self.positions.median() > CHEAPER * self.given_up;
            if dear {
                self.too_dear = Some(self.positions.median());
            }
            return (dear || lasted >= self.wait) && self.change();
        }
        self.dynamics.add(cost);
        let median = self.dynamics.median();
        if median > budget {
            let tries = self.too_dear.is_none_or(|dear| dear <= CHEAPER * median || lasted >= self.wait);
            return tries && self.change();
        }
        if lasted > PROVEN && median < COMFORT * budget {
            (self.wait, self.too_dear) = (WAITS.0, None);
        }
        false
    }

    fn change(&mut self) -> bool {
        if self.position_based {
            // The wait doubles in any case.
            self.wait = (2.0 * self.wait).min(WAITS.1);
            self.dynamics = Costs::default();
        } else {
            self.given_up = self.dynamics.median();
            self.positions = Costs::default();
        }
        self.position_based = !self.position_based;
        self.switches += 1;
        self.since = 0;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BUDGET: f64 = 2e-3;

    fn governor() -> Governor {
        Governor::new(Motion::Auto { budget: BUDGET })
    }

    /// Steps of seconds with made-up costs of dynamics and of position-based motion; how many of them dynamics moved.
    fn run(governor: &mut Governor, seconds: f64, dynamics: f64, positions: f64) -> usize {
        (0..(seconds * STEPS_PER_SECOND as f64) as usize)
            .filter(|_| {
                let moves = governor.mode().is_none();
                governor.record(if moves { dynamics } else { positions });
                moves
            })
            .count()
    }

    #[test]
    fn the_third_late_step_changes_and_one_or_two_slow_steps_do_not() {
        let mut governor = governor();
        for _ in 0..100 {
            // The machine's doing: a slow step or two, again and again.
            for cost in [1e-3, 0.1, 1e-3, 1e-3, 1e-3, 0.1, 0.1, 1e-3, 1e-3, 1e-3] {
                governor.record(cost);
                assert_eq!(governor.mode(), None);
            }
        }
        let answers = [3e-3, 3e-3, 3e-3].map(|cost| governor.record(cost));
        assert_eq!(answers, [false, false, true]);
        assert_eq!((governor.mode(), governor.switches()), (Some(MotionMode::PositionBased), 1));
        // From the very first step on, too: an assembly that is late from its beginning.
        let mut governor = Governor::new(Motion::Auto { budget: BUDGET });
        assert_eq!([3e-3, 3e-3, 3e-3].map(|cost| governor.record(cost)), [false, false, true]);
    }

    #[test]
    fn what_is_dearer_or_hardly_cheaper_is_left_after_a_trial() {
        for positions in [20e-3, 4e-3, 2.9e-3] {
            let mut governor = governor();
            // Dynamics is late for good, but nothing is cheaper by enough.
            let seconds = 120.0;
            let moved = run(&mut governor, seconds, 4e-3, positions);
            let trials = seconds as usize * STEPS_PER_SECOND as usize - moved;
            // After 1, 2, 4 … 64 s: seven trials of five steps at most.
            assert!((WINDOW..=7 * WINDOW).contains(&trials), "{trials} steps of trials at {positions} s");
            run(&mut governor, 1.0, 4e-3, positions);
            assert_eq!(governor.mode(), None);
        }
        let mut governor = governor();
        let moved = run(&mut governor, 60.0, 4e-3, 2.7e-3);
        assert!(
            moved < 60 * STEPS_PER_SECOND as usize / 20,
            "0.675 of the cost is worth it: {moved} steps of dynamics"
        );
    }

    #[test]
    fn what_was_too_dear_is_tried_at_once_where_dynamics_gets_dearer_yet() {
        let mut governor = governor();
        run(&mut governor, 0.1, 3e-3, 4e-3);
        assert_eq!((governor.mode(), governor.switches()), (None, 2), "one trial");
        let moved = run(&mut governor, 0.1, 50e-3, 4e-3);
        assert_eq!(governor.mode(), Some(MotionMode::PositionBased));
        assert!(moved <= WINDOW, "{moved}");
    }

    #[test]
    fn a_machine_that_is_too_slow_tries_ever_more_rarely_and_one_that_recovers_returns() {
        let mut governor = governor();
        let moved = run(&mut governor, 600.0, 3e-3, 1e-6);
        // Waits of 1, 2, 4 … 64 s and then 64 s each: 7 + 8 trials of three late steps.
        println!("{moved} steps of dynamics, {} changes", governor.switches());
        assert!(moved <= 3 * 16, "{moved}");
        run(&mut governor, WAITS.1 + 1.0, 1e-3, 1e-6);
        assert_eq!(governor.mode(), None);
        run(&mut governor, PROVEN + 1.0, 1e-3, 1e-6);
        assert_eq!(governor.wait, WAITS.0, "what was slow once is forgotten");
    }

    #[test]
    fn a_burst_is_over_after_a_second() {
        let mut governor = governor();
        run(&mut governor, 10.0, 1e-3, 1e-6);
        run(&mut governor, 0.5, 3e-3, 1e-6);
        assert_eq!(governor.mode(), Some(MotionMode::PositionBased));
        run(&mut governor, 0.6, 1e-3, 1e-6);
        assert_eq!((governor.mode(), governor.switches()), (None, 2));
    }

    #[test]
    fn an_exhibit_that_chose_for_itself_is_left_alone() {
        for motion in
            [Motion::Dynamics, Motion::PositionBased(soffio_multibody::procedural::PositionSolver::Relaxation)]
        {
            let mut governor = Governor::new(motion);
            run(&mut governor, 10.0, 1.0, 1e-6);
            assert_eq!((governor.switches(), governor.mode()), (0, None));
        }
    }
}

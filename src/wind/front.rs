//! The front of a breath: which air is where, while a breath swells, fades and travels.
//!
//! The head of a starting jet travels at half the speed of its centre line, dx/dt = 3 U₀ d/x, so that air found at x
//! left the lips when the blown length Φ(t) = ∫ U₀ dt was smaller by x²/(6 d). With Φ kept as a history, the speed at
//! x is that of the air that left at that time: a breath that swells and fades reaches a plate in the same order, and
//! its tail still arrives after the lips have closed, ever slower as nothing drives it on. Both laws of the breath travel so: how fast a head of air comes
//! is a matter of the air, and how much of it arrives that of the law.

use std::collections::VecDeque;

use super::breath::DECAY;
use soffio_math::exp;

/// How long air that has left the lips is followed, s.
const MEMORY: f64 = 3.0;
/// After the lips close the puff still drifts on: its drive falls by 1/e in this time, s.
const DRIFT_TIME: f64 = 0.4;

/// The blown length Φ over the last seconds.
#[derive(Clone, Debug, Default)]
pub struct Front {
    /// (Φ, U₀) at the end of each step, newest last.
    history: VecDeque<(f64, f64)>,
    drive: f64,
}

impl Front {
    /// Remembers one step of `dt` seconds at source speed `speed`.
    pub fn advance(&mut self, speed: f64, dt: f64) {
        self.drive = speed.max(self.drive * exp(-dt / DRIFT_TIME));
        if self.history.is_empty() {
            // Room for all that is ever remembered.
            self.history.reserve((MEMORY / dt) as usize + 2);
            self.history.push_back((0.0, 0.0));
        }
        let blown = self.history.back().map_or(0.0, |&(phi, _)| phi) + self.drive * dt;
        self.history.push_back((blown, speed));
        if self.history.len() as f64 * dt > MEMORY {
            self.history.pop_front();
        }
    }

    /// Source speed of the air that is now at distance `x` (m) before lips of diameter `d` (m).
    pub fn speed_at(&self, x: f64, d: f64) -> f64 {
        let Some(&(now, _)) = self.history.back() else { return 0.0 };
        let left = now - x * x / (DECAY * d);
        // Φ never falls, so the history is sorted.
        let index = self.history.partition_point(|&(phi, _)| phi < left);
        if index == 0 && self.history.front().is_some_and(|&(phi, _)| phi > left) {
            return 0.0;
        }
        self.history.get(index).map_or(0.0, |&(_, speed)| speed.min(self.drive))
    }

    /// Is air still on its way?
    pub fn in_flight(&self) -> bool {
        self.history.iter().any(|&(_, speed)| speed > 0.0)
    }

    /// Forgets all air in flight.
    pub fn clear(&mut self) {
        self.history.clear();
        self.drive = 0.0;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_front_arrives_when_the_formula_says() {
        let (dt, d, speed, x) = (1.0 / 240.0, 0.01, 8.9, 0.5);
        let mut front = Front::default();
        let mut arrival = None;
        for step in 1..480 {
            front.advance(speed, dt);
            if front.speed_at(x, d) > 0.0 {
                arrival = Some(f64::from(step) * dt);
                break;
            }
        }
        // t = x²/(6 U₀ d) = 0.468 s; found within one step.
        let expected = x * x / (DECAY * speed * d);
        assert!((arrival.expect("the front arrives") - expected).abs() < 1.5 * dt, "{arrival:?} for {expected}");
    }

    #[test]
    fn the_tail_arrives_and_then_the_air_is_still() {
        let dt = 1.0 / 240.0;
        let mut front = Front::default();
        for _ in 0..240 {
            front.advance(8.9, dt);
        }
        front.advance(0.0, dt);
        assert!(front.speed_at(0.4, 0.01) > 0.0, "air on its way still arrives");
        for _ in 0..960 {
            front.advance(0.0, dt);
        }
        assert_eq!(front.speed_at(0.4, 0.01), 0.0);
    }
}

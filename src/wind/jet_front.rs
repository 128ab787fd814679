//! Travelling front of a starting jet: the air that is at each distance while a breath swells, fades and ends.
//!
//! The head of a starting jet travels at half its centre-line speed, dx/dt = 3 U₀ d/x. So air at distance x left the lips
//! when the emitted length Φ(t) = ∫ U₀ dt was smaller by x²/(6 d). With a history of Φ, the source speed at x is that of the
//! air that left then. A breath that swells and fades reaches a plate in the same order. Its tail arrives after the lips
//! have closed, more and more slowly because nothing drives it. Both spreading laws use this delay.

use std::collections::VecDeque;

use super::breath::DECAY;
use soffio_math::exp;

/// History of emitted air, s: in this time the air of a breath of 10 m/s reaches 1.3 m (x² = 6 d U₀ t, d = 10 mm).
const MEMORY: f64 = 3.0;
/// Time constant of the drive after the lips close, s: chosen by eye, for a tail that fades rather than stops.
const DECAY_TIME: f64 = 0.4;

/// Air emitted in one step.
#[derive(Clone, Copy, Debug)]
struct Emission {
    /// Φ at the end of the step, m.
    length: f64,
    /// U₀, m/s.
    speed: f64,
}

/// History of the emitted length Φ over the last seconds.
#[derive(Clone, Debug, Default)]
pub struct JetFront {
    /// Newest last.
    history: VecDeque<Emission>,
    /// Speed at which Φ grows, m/s: the source speed, or the remainder of it after the lips close.
    drive: f64,
}

impl JetFront {
    /// Adds one step of `dt` seconds at source speed `speed` (m/s). Allocates in the first step only.
    pub fn advance(&mut self, speed: f64, dt: f64) {
        self.drive = speed.max(self.drive * exp(-dt / DECAY_TIME));
        if self.history.is_empty() {
            self.history.reserve((MEMORY / dt) as usize + 2);
            self.history.push_back(Emission { length: 0.0, speed: 0.0 });
        }
        let length = self.history.back().map_or(0.0, |last| last.length) + self.drive * dt;
        self.history.push_back(Emission { length, speed });
        if self.history.len() as f64 * dt > MEMORY {
            self.history.pop_front();
        }
    }

    /// Source speed, m/s, of the air that is now at distance `x` (m) from lips of diameter `d` (m).
    pub fn speed_at(&self, x: f64, d: f64) -> f64 {
        let Some(now) = self.history.back() else { return 0.0 };
        let left = now.length - x * x / (DECAY * d);
        // Φ never falls, so the history is sorted.
        let index = self.history.partition_point(|emission| emission.length < left);
        if index == 0 && self.history.front().is_some_and(|first| first.length > left) {
            return 0.0;
        }
        self.history.get(index).map_or(0.0, |emission| emission.speed.min(self.drive))
    }

    /// Whether emitted air may still arrive somewhere.
    pub fn in_flight(&self) -> bool {
        self.history.iter().any(|emission| emission.speed > 0.0)
    }

    /// Removes all air in flight.
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
        let mut jet_front = JetFront::default();
        let mut arrival = None;
        for step in 1..480 {
            jet_front.advance(speed, dt);
            if jet_front.speed_at(x, d) > 0.0 {
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
        let mut jet_front = JetFront::default();
        for _ in 0..240 {
            jet_front.advance(8.9, dt);
        }
        jet_front.advance(0.0, dt);
        assert!(jet_front.speed_at(0.4, 0.01) > 0.0, "air on its way still arrives");
        for _ in 0..960 {
            jet_front.advance(0.0, dt);
        }
        assert_eq!(jet_front.speed_at(0.4, 0.01), 0.0);
    }
}

//! Orbit camera: turned by a visitor's pull or by the attract script, and returned to its usual place.
//!
//! A pull moves a goal. The camera follows it through two equal first-order lags in series,
//!
//! ```text
//! ẏ = ω (goal − y),   ẋ = ω (y − x)
//! ```
//!
//! which is critically damped: it starts and ends softly and never overshoots. The goal moves freely within three quarters of
//! the leeway L. Beyond it is compressed, so that the end is soft and L is never passed:
//!
//! ```text
//! soft(g) = g                               |g| ≤ k,   k = ¾ L
//!         = L − (L − k) e^(−(g − k)/(L − k))  beyond
//! ```
//!
//! The attract script sets a goal as well, which the camera follows more slowly.
//!
//! With reduced motion the camera follows the finger at once, and nothing moves by itself.

use soffio_exhibit::OrbitLimits;
use soffio_math::exp;
use soffio_simulation::STEPS_PER_SECOND;

/// Angle of a pull by a picture height, rad.
pub const TURN: f64 = 1.2;
/// Angle of a press beside the exhibit with "press once", rad: 15°.
pub const PRESS: f64 = 0.262;
/// ω of the camera when it follows a finger, and when it returns, 1/s.
const FOLLOWS: f64 = 18.0;
const RETURNS: f64 = 4.0;
/// ω of the camera when it follows the attract script, 1/s: nine tenths of the angle in five seconds.
const LED: f64 = 0.8;
/// Share of the leeway beyond which a pull is compressed.
const FREE: f64 = 0.75;
/// Largest goal beyond the free part, in lengths of the soft end, so that a pull back takes effect at once.
const BEYOND: f64 = 1.5;
/// Distance at which the camera snaps to its goal, rad: a hundredth of a pixel.
const THERE: f64 = 1e-5;

/// Input of the orbit camera in a step, to the right and up, rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OrbitInput {
    /// A visitor pulls it by this angle.
    Pulled([f64; 2]),
    /// The attract script sets this goal.
    Scripted([f64; 2]),
    /// It returns to its usual place.
    Home,
}

/// State of the orbit camera: angles to the right and up, rad.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Orbit {
    /// Goal before the soft ends.
    goal: [f64; 2],
    follows: [f64; 2],
    at: [f64; 2],
}

impl Orbit {
    /// Advances by a step. Returns the angles.
    pub fn step(&mut self, input: OrbitInput, leeway: &OrbitLimits, reduced_motion: bool) -> [f64; 2] {
        let ends = [[leeway.yaw; 2], [leeway.down, leeway.up]];
        let (goal, speed) = match input {
            OrbitInput::Pulled(by) if by.iter().all(|x| x.is_finite()) => {
                ([0, 1].map(|i| self.goal[i] + by[i]), FOLLOWS)
            }
            OrbitInput::Pulled(_) => (self.goal, FOLLOWS),
            OrbitInput::Scripted(there) => (there, LED),
            OrbitInput::Home => ([0.0; 2], RETURNS),
        };
        self.goal = std::array::from_fn(|i| {
            let [least, most] = ends[i].map(|end| end * (FREE + BEYOND * (1.0 - FREE)));
            goal[i].clamp(-least, most)
        });
        let share = if reduced_motion { 1.0 } else { 1.0 - exp(-speed / STEPS_PER_SECOND as f64) };
        for (i, [below, above]) in ends.into_iter().enumerate() {
            let goal = soft(self.goal[i], if self.goal[i] < 0.0 { below } else { above });
            self.follows[i] += share * (goal - self.follows[i]);
            self.at[i] += share * (self.follows[i] - self.at[i]);
            if (goal - self.at[i]).abs() < THERE && (goal - self.follows[i]).abs() < THERE {
                (self.follows[i], self.at[i]) = (goal, goal);
            }
        }
        self.at
    }
}

/// Goal with a soft end.
pub fn soft(goal: f64, end: f64) -> f64 {
    let (way, free) = (goal.abs(), FREE * end);
    if way <= free {
        return goal;
    }
    let left = end - free;
    (end - left * exp(-(way - free) / left)).copysign(goal)
}

//! Looking round the work: how a visitor's pull turns the camera, where the attract script leads it, and its way home.
//!
//! What is pulled is a goal; the camera follows it as two equal lags in a row,
//!
//! ```text
//! ẏ = ω (goal − y),   ẋ = ω (y − x)
//! ```
//!
//! which is critically damped: it starts and ends softly and never goes beyond. The goal may be pulled freely until three
//! quarters of the leeway L and gives way from there on, ever more, so that no end is hit and L is never passed:
//!
//! ```text
//! soft(g) = g                               |g| ≤ k,   k = ¾ L
//!         = L − (L − k) e^(−(g − k)/(L − k))  beyond
//! ```
//!
//! The attract script gives it a goal as well, and it goes there more slowly than by anyone's finger.
//!
//! Where less motion is wanted, the camera is where the finger puts it and nothing moves on by itself.

use soffio_exhibit::OrbitLimits;
use soffio_math::exp;
use soffio_simulation::STEPS_PER_SECOND;

/// What a pull of a picture height turns, rad.
pub const TURN: f64 = 1.2;
/// What a press beside the work turns for whoever presses once, rad: 15°.
pub const PRESS: f64 = 0.262;
/// ω of the camera that follows a finger, and of its way home, 1/s.
const FOLLOWS: f64 = 18.0;
const RETURNS: f64 = 4.0;
/// And of one that the attract script leads, 1/s: within five seconds it has gone nine tenths of its way.
const LED: f64 = 0.8;
/// Share of the leeway beyond which a pull gives way.
const FREE: f64 = 0.75;
/// How far a goal may be beyond its soft end, in lengths of that end: whoever pulls back is answered at once.
const BEYOND: f64 = 1.5;
/// Nearer than this to where it goes it is there, rad: a hundredth of a pixel.
const THERE: f64 = 1e-5;

/// What turns the camera in a step, to the right and up, rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Way {
    /// A visitor pulls it on by so much.
    Pulled([f64; 2]),
    /// The attract script leads it there.
    Led([f64; 2]),
    /// It goes back to where it stands for everybody.
    Home,
}

/// The camera's turn over time: to the right and up, rad.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Orbit {
    /// Where it is pulled, before ends are soft.
    goal: [f64; 2],
    follows: [f64; 2],
    at: [f64; 2],
}

impl Orbit {
    /// Goes on by a step. Returns the turn.
    pub fn step(&mut self, way: Way, leeway: &OrbitLimits, calm: bool) -> [f64; 2] {
        let ends = [[leeway.yaw; 2], [leeway.down, leeway.up]];
        let (goal, speed) = match way {
            Way::Pulled(by) if by.iter().all(|x| x.is_finite()) => ([0, 1].map(|i| self.goal[i] + by[i]), FOLLOWS),
            Way::Pulled(_) => (self.goal, FOLLOWS),
            Way::Led(there) => (there, LED),
            Way::Home => ([0.0; 2], RETURNS),
        };
        self.goal = std::array::from_fn(|i| {
            let [least, most] = ends[i].map(|end| end * (FREE + BEYOND * (1.0 - FREE)));
            goal[i].clamp(-least, most)
        });
        let share = if calm { 1.0 } else { 1.0 - exp(-speed / STEPS_PER_SECOND as f64) };
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

/// A goal with an end that gives way.
pub fn soft(goal: f64, end: f64) -> f64 {
    let (way, free) = (goal.abs(), FREE * end);
    if way <= free {
        return goal;
    }
    let left = end - free;
    (end - left * exp(-(way - free) / left)).copysign(goal)
}

//! A clock's minute hand, carried to the time by hand.
//!
//! A point p runs ahead on the hand's way, with the sun and never back, and the hand is drawn to it against the friction
//! of its clutch and whatever the works ask for:
//!
//! ```text
//! ṗ = Ω, p − q ≤ lead, p ≤ goal        ω* = (p − q)/τ
//! it slips    T = T_f + L + (ω* − ω)/(W Δt),   |T| ≤ 4 T_f        L ← L + (ω*' − ω)/(W Δt)        ' the step before
//! it holds    T from T_f on, a twentieth more in each step: nobody jerks at it
//! ```
//!
//! with q, ω the hand's turn and rate, T_f the clutch's friction and W the answer of the hand to a unit of angular
//! impulse, joints held; L is what hand and works weigh. Whoever sets a striking clock waits at the hour until it has struck. What the works carry along
//! (motion work, pins, levers) goes by its own laws. When the hand has come to the time it is let go for good.

use soffio_exhibit::clock::{Clock, HOUR};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{Vec6, vec6};
use soffio_math::{DVec3, PI};
use soffio_multibody::articulation::rows::coupling::Gauge;
use soffio_multibody::articulation::{Axis, Measure};
use soffio_multibody::dynamics::Dynamics;

/// Ω: an hour in twelve seconds, rad/s.
const PACE: f64 = 2.0 * PI / 12.0;
/// How far p runs ahead, rad.
const LEAD: f64 = 0.25;
/// τ, s.
const FOLLOWS: f64 = 0.05;
/// T over the clutch's friction at the most, and by how much it grows in a step while the clutch holds.
const STRONGEST: f64 = 4.0;
const GROWS: f64 = 0.05;
/// Fastest that it is moved, rad/s.
const FASTEST: f64 = 2.0 * PACE;
/// What strikes turns faster than this, rad/s.
const RUNS: f64 = 0.3;
/// After an hour is passed nothing may run yet: the works are given this long to begin, s.
const WARNS: f64 = 1.0;
/// The hand is let go this close to the time, rad: a second.
const THERE: f64 = 1.5e-3;

/// A hand on its way.
#[derive(Clone, Debug)]
pub struct Carrying {
    gauge: Gauge,
    /// Where the hand is to be when it begins, and p, rad since the start.
    goal: f64,
    place: f64,
    /// Next full hour, rad since the start, and how long it has been waited since one was passed, s.
    hour: f64,
    waited: f64,
    /// T over the clutch's friction while it holds; L over it, and ω*, while it slips.
    pull: f64,
    load: f64,
    wish: f64,
}

impl Carrying {
    /// From the start of a figure to `time`, s after any midnight.
    pub fn new(clock: &Clock, bodies: &[RigidBody], time: f64) -> Self {
        let axis = Axis { body: Some(clock.hand), direction: clock.axis };
        let turn = |seconds: f64| 2.0 * PI * seconds / HOUR;
        Self {
            gauge: Gauge::new(Measure::Angle { axis, frame: None }, bodies),
            goal: turn(clock.left(time)),
            place: 0.0,
            hour: turn(HOUR - clock.shows.rem_euclid(HOUR)),
            waited: WARNS,
            pull: 1.0,
            load: 0.0,
            wish: 0.0,
        }
    }

    /// Carries for a step of `dt` seconds, `elapsed` seconds after the start: adds its torque to the wrenches (N m). False
    /// when the hand has come to the time.
    pub fn carry(
        &mut self,
        clock: &Clock,
        (elapsed, dt): (f64, f64),
        dynamics: &mut Dynamics,
        out: &mut [Vec6],
    ) -> bool {
        self.gauge.count(&dynamics.bodies);
        let turned = self.gauge.total(&dynamics.bodies[..]);
        let goal = self.goal + 2.0 * PI * elapsed / HOUR;
        if turned >= goal - THERE {
            return false;
        }
        if turned > self.hour {
            self.hour += 2.0 * PI;
            self.waited = 0.0;
        }
        self.waited += dt;
        let strikes = clock.strikes.is_some_and(|body| dynamics.bodies[body].angular_velocity.length() > RUNS);
        if strikes || self.waited < WARNS {
            (self.place, self.pull) = (turned, 1.0);
            return true;
        }
        self.place = (self.place.max(turned) + PACE * dt).min(turned + LEAD).min(goal);
        let body = &dynamics.bodies[clock.hand];
        let axis = body.rotation * clock.axis;
        let share = if dynamics.clutch_slips(clock.hand) {
            let (rate, each) =
                (body.angular_velocity.dot(axis), dynamics.angular_response(clock.hand, axis) * dt * clock.friction);
            self.load = (self.load + (self.wish - rate) / each).clamp(-STRONGEST, STRONGEST);
            self.wish = ((self.place - turned) / FOLLOWS).min(FASTEST);
            self.pull = 1.0;
            1.0 + self.load + (self.wish - rate) / each
        } else {
            (self.load, self.wish) = (0.0, 0.0);
            self.pull += GROWS;
            self.pull
        };
        let torque = share.clamp(-STRONGEST, STRONGEST) * clock.friction * axis;
        for (sum, x) in out[clock.hand].iter_mut().zip(vec6(DVec3::ZERO, torque)) {
            *sum += x;
        }
        true
    }
}

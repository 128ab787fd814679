//! Clock setting: a virtual hand turns a clock's minute hand to the time of day.
//!
//! A set point p moves ahead of the minute hand, clockwise only. A torque drives the hand towards it, against the friction of
//! its clutch and the load of the works:
//!
//! ```text
//! ṗ = Ω, p − q ≤ lead, p ≤ goal        ω* = (p − q)/τ
//! clutch slips    T = T_f + L + (ω* − ω)/(W Δt),   |T| ≤ 4 T_f        L ← L + (ω*' − ω)/(W Δt)        ': previous step
//! clutch sticks   T from T_f on, a twentieth more in each step, so that it does not jerk
//! ```
//!
//! with q, ω the hand's angle and rate, T_f the clutch's friction, W the angular response of the hand to a unit impulse,
//! joints included, and L the load of hand and works. A striking clock is set like a real one: the hand waits at the hour
//! until it has struck. The parts that the hand drives (motion work, pins, levers) move by dynamics. At the goal the hand is
//! released for good.

use soffio_exhibit::clock::{Clock, HOUR};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{Vec6, vec6};
use soffio_math::{DVec3, PI};
use soffio_multibody::articulation::rows::coupling::Gauge;
use soffio_multibody::articulation::{Axis, Measure};
use soffio_multibody::dynamics::Dynamics;

/// How the virtual hand turns the minute hand.
struct Tuning {
    /// Ω, rad/s: an hour in twelve seconds.
    rate: f64,
    /// Greatest lead of the set point, rad.
    lead: f64,
    /// τ, s.
    time_constant: f64,
    /// Greatest T over the clutch's friction.
    most_torque: f64,
    /// Growth of T over the clutch's friction in a step while the clutch sticks.
    torque_growth: f64,
    /// Greatest ω*, rad/s.
    most_rate: f64,
    /// The striking work strikes while it turns faster than this, rad/s.
    striking_rate: f64,
    /// Time that the works are given to begin to strike after the hour is passed, s.
    warning_time: f64,
    /// Distance from the goal at which the hand is released, rad: a second of time.
    tolerance: f64,
}

const RATE: f64 = 2.0 * PI / 12.0;
const TUNING: Tuning = Tuning {
    rate: RATE,
    lead: 0.25,
    time_constant: 0.05,
    most_torque: 4.0,
    torque_growth: 0.05,
    most_rate: 2.0 * RATE,
    striking_rate: 0.3,
    warning_time: 1.0,
    tolerance: 1.5e-3,
};

/// Time of one step of the setting.
#[derive(Clone, Copy, Debug)]
pub struct SettingStep {
    /// Since the start, s.
    pub elapsed: f64,
    /// Length of the step, s.
    pub dt: f64,
}

/// A clock that is being set.
#[derive(Clone, Debug)]
pub struct ClockSetting {
    gauge: Gauge,
    /// Angle of the hand at the time of day when the setting began, rad since the start.
    goal: f64,
    /// p, rad since the start.
    set_point: f64,
    /// Next full hour, rad since the start.
    hour: f64,
    /// Since the last full hour, s.
    since_hour: f64,
    /// T over the clutch's friction while it sticks.
    stick_torque: f64,
    /// L over the clutch's friction while it slips.
    load: f64,
    /// ω* while it slips, rad/s.
    desired_rate: f64,
}

impl ClockSetting {
    /// Of a clock at its start, to `time`, s after any midnight.
    pub fn new(clock: &Clock, bodies: &[RigidBody], time: f64) -> Self {
        let axis = Axis { body: Some(clock.minute_hand), direction: clock.axis };
        let angle = |seconds: f64| 2.0 * PI * seconds / HOUR;
        Self {
            gauge: Gauge::new(Measure::Angle { axis, frame: None }, bodies),
            goal: angle(clock.remaining_seconds(time)),
            set_point: 0.0,
            hour: angle(HOUR - clock.initial_time.rem_euclid(HOUR)),
            since_hour: TUNING.warning_time,
            stick_torque: 1.0,
            load: 0.0,
            desired_rate: 0.0,
        }
    }

    /// Adds the torque of a step to the wrenches (N m). Returns false once the hand has reached the time.
    pub fn apply(&mut self, clock: &Clock, step: SettingStep, dynamics: &mut Dynamics, out: &mut [Vec6]) -> bool {
        let SettingStep { elapsed, dt } = step;
        self.gauge.count(&dynamics.bodies);
        let angle = self.gauge.total(&dynamics.bodies[..]);
        let goal = self.goal + 2.0 * PI * elapsed / HOUR;
        if angle >= goal - TUNING.tolerance {
            return false;
        }
        if angle > self.hour {
            self.hour += 2.0 * PI;
            self.since_hour = 0.0;
        }
        self.since_hour += dt;
        let rate_of = |body: usize| dynamics.bodies[body].angular_velocity.length();
        let strikes = clock.striking_body.is_some_and(|body| rate_of(body) > TUNING.striking_rate);
        if strikes || self.since_hour < TUNING.warning_time {
            (self.set_point, self.stick_torque) = (angle, 1.0);
            return true;
        }
        self.set_point = (self.set_point.max(angle) + TUNING.rate * dt).min(angle + TUNING.lead).min(goal);
        let body = &dynamics.bodies[clock.minute_hand];
        let axis = body.rotation * clock.axis;
        // T over the clutch's friction.
        let torque = if dynamics.clutch_slips(clock.minute_hand) {
            let rate = body.angular_velocity.dot(axis);
            // Change of the rate in a step by the clutch's friction alone, rad/s.
            let friction_rate = dynamics.angular_response(clock.minute_hand, axis) * dt * clock.friction;
            self.load =
                (self.load + (self.desired_rate - rate) / friction_rate).clamp(-TUNING.most_torque, TUNING.most_torque);
            self.desired_rate = ((self.set_point - angle) / TUNING.time_constant).min(TUNING.most_rate);
            self.stick_torque = 1.0;
            1.0 + self.load + (self.desired_rate - rate) / friction_rate
        } else {
            (self.load, self.desired_rate) = (0.0, 0.0);
            self.stick_torque += TUNING.torque_growth;
            self.stick_torque
        };
        let torque = torque.clamp(-TUNING.most_torque, TUNING.most_torque) * clock.friction * axis;
        for (sum, x) in out[clock.minute_hand].iter_mut().zip(vec6(DVec3::ZERO, torque)) {
            *sum += x;
        }
        true
    }
}

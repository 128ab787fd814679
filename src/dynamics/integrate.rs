//! The classical fourth-order Runge–Kutta method on constrained bodies, and what follows it.
//!
//! State of a body: (x, q, v, ω). Its rate: (v, ½ ω q, a, α), with a and α from the tree solve. The quaternion is
//! integrated as four numbers and normalised, which keeps the method's order. Afterwards the joints have drifted by
//! O(h⁵); one Newton step on C (least in kinetic energy) brings them back to rounding, one linear solve does the same
//! for Ċ, and pivot friction joins that solve as soft rows.

use super::{Dynamics, forces};
use crate::articulation::block::{MAX_ROWS, angular, linear};
use crate::math::{DQuat, DVec3};

/// Joints farther apart than this are drawn together by the stabiliser, not snapped by projection, m or rad.
const PROJECTION_REACH: f64 = 1e-4;
/// Shares of the step at which the second, third and fourth rates are taken, and the weights of the four.
const NODES: [f64; 3] = [0.5, 0.5, 1.0];
const WEIGHTS: [f64; 4] = [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];

/// Rate of change of a body's state.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rate {
    velocity: DVec3,
    rotation: [f64; 4],
    acceleration: DVec3,
    angular_acceleration: DVec3,
}

impl Rate {
    fn add(&mut self, weight: f64, other: &Self) {
        self.velocity += weight * other.velocity;
        for k in 0..4 {
            self.rotation[k] += weight * other.rotation[k];
        }
        self.acceleration += weight * other.acceleration;
        self.angular_acceleration += weight * other.angular_acceleration;
    }
}

impl Dynamics {
    /// Moves the bodies `h` seconds on from the substep's start.
    pub(super) fn integrate(&mut self, h: f64) {
        if h <= 0.0 {
            return;
        }
        for stage in 0..4 {
            if stage > 0 {
                self.advance_from_start(NODES[stage - 1] * h, stage - 1);
            }
            self.accelerate(stage);
        }
        for (joint, load) in self.loads.iter_mut().enumerate() {
            *load = self.system.load(joint);
        }
        // The weighted mean of the rates takes the first stage's place.
        for body in 0..self.bodies.len() {
            let mut mean = Rate::default();
            for (stage, weight) in WEIGHTS.into_iter().enumerate() {
                mean.add(weight, &self.stages[stage][body]);
            }
            self.stages[0][body] = mean;
        }
        self.advance_from_start(h, 0);
        self.project();
    }

    /// Rates of the bodies' present state into a stage.
    fn accelerate(&mut self, stage: usize) {
        let bodies = &self.bodies;
        self.system.evaluate(bodies);
        self.system.factor();
        forces::collect(
            bodies,
            self.settings.gravity,
            &self.damping,
            &self.springs,
            &self.external,
            &mut self.system.b,
        );
        let rate = 1.0 / self.settings.stabilization_time;
        for joint in 0..self.system.joints().len() {
            let hard = self.system.joints()[joint].hard;
            let mut g = [0.0; MAX_ROWS];
            for (row, g) in g.iter_mut().enumerate().take(hard) {
                let j = &self.system.joints()[joint];
                let speed = self.system.rate(bodies, joint, row);
                *g = -j.bias[row] - rate * rate * j.value[row] - 2.0 * rate * speed;
            }
            self.system.g[joint] = g;
        }
        self.system.solve();
        for ((rate, body), a) in self.stages[stage].iter_mut().zip(bodies).zip(&self.system.a) {
            let spin = DQuat::from_xyzw(body.angular_velocity.x, body.angular_velocity.y, body.angular_velocity.z, 0.0);
            *rate = Rate {
                velocity: body.velocity,
                rotation: (spin * body.rotation * 0.5).to_array(),
                acceleration: linear(a),
                angular_acceleration: angular(a),
            };
        }
    }

    /// Bodies = start + h · stage.
    fn advance_from_start(&mut self, h: f64, stage: usize) {
        for ((body, start), rate) in self.bodies.iter_mut().zip(&self.start).zip(&self.stages[stage]) {
            body.position = start.position + h * rate.velocity;
            let q = start.rotation.to_array();
            body.rotation = DQuat::from_array(std::array::from_fn(|k| q[k] + h * rate.rotation[k])).normalize();
            body.velocity = start.velocity + h * rate.acceleration;
            body.angular_velocity = start.angular_velocity + h * rate.angular_acceleration;
        }
    }

    /// Closes the joints in place and speed.
    pub(super) fn project(&mut self) {
        if self.system.joints().is_empty() {
            return;
        }
        self.system.evaluate(&self.bodies);
        self.system.factor();
        if self.system.largest_error() < PROJECTION_REACH {
            self.system.solve_displacement();
            self.system.apply_displacement(&mut self.bodies);
            self.system.solve_velocity(&self.bodies);
            self.system.apply_velocity(&mut self.bodies);
        }
    }

    /// Lets pivot friction act for `dt` seconds, the joints held.
    pub(super) fn rub(&mut self, dt: f64) {
        self.system.evaluate(&self.bodies);
        self.system.add_friction(&self.bodies, &self.loads, dt);
        self.system.factor();
        self.system.solve_velocity(&self.bodies);
        self.system.apply_velocity(&mut self.bodies);
    }
}

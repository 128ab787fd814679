//! The integrators: from one state of constrained bodies to a later one.
//!
//! State of a body: (x, q, v, ω). Its rate: (v, ½ ω q, a, α), with a and α from the joints' solve. The quaternion is
//! integrated as four numbers and normalised, which keeps a method's order. Afterwards the joints have drifted by
//! the method's local error; one Newton step on C (least in kinetic energy) brings them back to rounding, one linear
//! solve does the same for Ċ. The factor of that projection also gives the rate at the new state, which is the next
//! substep's first stage.
//!
//! **Runge–Kutta**, the classical method of fourth order. The new state's own rate k₅ beside the last stage k₄ gives
//! an estimate of the local error for nothing: e = h/6 (k₅ − k₄) is what a companion of third order would differ by.
//! It is measured in the norm of the kinetic energy,
//!
//! ```text
//! error = √(Σ e·M e / Σ v·M v)
//! ```
//!
//! **Gauss–Legendre** with three stages, of sixth order, symplectic on smooth motion:
//!
//! ```text
//! Y_i = y + h Σ_j a_ij f(Y_j)          y' = y + h Σ b_i f(Y_i)
//! ```
//!
//! solved by simple iteration from the rate at the start (Hairer, Lubich, Wanner, Geometric Numerical Integration,
//! II.1.3). **Fast**: semi-implicit Euler.

use super::{Dynamics, forces};
use crate::articulation::block::{angular, linear, vec6};
use crate::bodies::RigidBody;
use crate::math::{DQuat, DVec3};

/// Shares of the step at which the second, third and fourth rates are taken, and the weights of the four.
const NODES: [f64; 4] = [0.0, 0.5, 0.5, 1.0];
const WEIGHTS: [f64; 4] = [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];

/// √15.
const R15: f64 = 3.872_983_346_207_417;
/// Nodes, weights and coefficients of the Gauss–Legendre method.
const GAUSS_NODES: [f64; 3] = [0.5 - R15 / 10.0, 0.5, 0.5 + R15 / 10.0];
const GAUSS_WEIGHTS: [f64; 3] = [5.0 / 18.0, 4.0 / 9.0, 5.0 / 18.0];
const GAUSS: [[f64; 3]; 3] = [
    [5.0 / 36.0, 2.0 / 9.0 - R15 / 15.0, 5.0 / 36.0 - R15 / 30.0],
    [5.0 / 36.0 + R15 / 24.0, 2.0 / 9.0, 5.0 / 36.0 - R15 / 24.0],
    [5.0 / 36.0 + R15 / 30.0, 2.0 / 9.0 + R15 / 15.0, 5.0 / 36.0],
];
/// Iteration ends when rates change by less than this share of themselves: rounding.
const SETTLED: f64 = 1e-15;
/// Most iterations; what has not settled by then has not for want of digits, or the substep was too long.
const MOST_ITERATIONS: usize = 16;

/// A body's changing numbers.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct State {
    position: DVec3,
    rotation: DQuat,
    velocity: DVec3,
    angular_velocity: DVec3,
}

impl State {
    pub(super) fn of(body: &RigidBody) -> Self {
        Self {
            position: body.position,
            rotation: body.rotation,
            velocity: body.velocity,
            angular_velocity: body.angular_velocity,
        }
    }

    pub(super) fn put(&self, body: &mut RigidBody) {
        body.position = self.position;
        body.rotation = self.rotation;
        body.velocity = self.velocity;
        body.angular_velocity = self.angular_velocity;
    }

    /// This state and `h` times a rate, into a body.
    #[inline]
    fn advance(&self, h: f64, rate: &Rate, body: &mut RigidBody) {
        body.position = self.position + h * rate.velocity;
        body.rotation = (self.rotation + rate.rotation * h).normalize();
        body.velocity = self.velocity + h * rate.acceleration;
        body.angular_velocity = self.angular_velocity + h * rate.angular_acceleration;
    }
}

/// Rate of change of a body's state.
#[derive(Clone, Copy, Debug)]
pub(super) struct Rate {
    velocity: DVec3,
    rotation: DQuat,
    acceleration: DVec3,
    angular_acceleration: DVec3,
}

impl Default for Rate {
    fn default() -> Self {
        Self {
            velocity: DVec3::ZERO,
            rotation: DQuat::from_xyzw(0.0, 0.0, 0.0, 0.0),
            acceleration: DVec3::ZERO,
            angular_acceleration: DVec3::ZERO,
        }
    }
}

impl Rate {
    #[inline]
    fn of(body: &RigidBody, a: &[f64; 6]) -> Self {
        let w = body.angular_velocity;
        Self {
            velocity: body.velocity,
            rotation: DQuat::from_xyzw(w.x, w.y, w.z, 0.0) * body.rotation * 0.5,
            acceleration: linear(a),
            angular_acceleration: angular(a),
        }
    }

    #[inline]
    fn add(&mut self, weight: f64, other: &Self) {
        self.velocity += weight * other.velocity;
        self.rotation = self.rotation + other.rotation * weight;
        self.acceleration += weight * other.acceleration;
        self.angular_acceleration += weight * other.angular_acceleration;
    }
}

impl Dynamics {
    /// Moves the bodies from the time `t` by `h`, by the classical Runge–Kutta method; returns the estimated error.
    pub(super) fn runge_kutta(&mut self, t: f64, h: f64) -> f64 {
        self.ensure_rates(t);
        for stage in 1..4 {
            for (index, body) in self.bodies.iter_mut().enumerate() {
                let rate = Rate::of(body, &self.system.a[index]);
                let mean = &mut self.mean[index];
                if stage == 1 {
                    *mean = Rate::default();
                }
                mean.add(WEIGHTS[stage - 1], &rate);
                self.start[index].advance(NODES[stage] * h, &rate, body);
            }
            self.accelerate(t + NODES[stage] * h);
        }
        for (index, body) in self.bodies.iter_mut().enumerate() {
            let rate = Rate::of(body, &self.system.a[index]);
            let mean = &mut self.mean[index];
            mean.add(WEIGHTS[3], &rate);
            self.last[index] = self.system.a[index];
            self.start[index].advance(h, mean, body);
        }
        self.arrive(t + h);
        // k₅ − k₄ in the norm of the kinetic energy.
        let (mut error, mut scale) = (0.0, 0.0);
        for (index, body) in self.bodies.iter().enumerate() {
            let (mass, inertia) = (body.properties.mass, self.system.inertia_world(index));
            let norm = |v: &[f64; 6]| mass * linear(v).length_squared() + angular(v).dot(inertia.mul(angular(v)));
            let difference: [f64; 6] =
                std::array::from_fn(|k| h / 6.0 * (self.system.a[index][k] - self.last[index][k]));
            error += norm(&difference);
            scale += norm(&vec6(body.velocity, body.angular_velocity)) + mass * SLOWEST * SLOWEST;
        }
        (error / scale).sqrt()
    }

    /// Moves the bodies by semi-implicit Euler.
    pub(super) fn euler(&mut self, t: f64, h: f64) {
        self.ensure_rates(t);
        for (index, body) in self.bodies.iter_mut().enumerate() {
            let a = &self.system.a[index];
            body.velocity += h * linear(a);
            body.angular_velocity += h * angular(a);
            let (way, turn) = (h * body.velocity, h * body.angular_velocity);
            body.displace(way, turn);
        }
        self.arrive(t + h);
    }

    /// Moves the bodies by the Gauss–Legendre method; false where the iteration did not settle.
    pub(super) fn gauss(&mut self, t: f64, h: f64) -> bool {
        self.ensure_rates(t);
        for (index, body) in self.bodies.iter().enumerate() {
            let rate = Rate::of(body, &self.system.a[index]);
            // A body's velocity changes as its acceleration says, which is the better first guess.
            for (stage, node) in GAUSS_NODES.into_iter().enumerate() {
                let mut guess = rate;
                guess.velocity += node * h * rate.acceleration;
                self.stages[stage][index] = guess;
            }
        }
        let mut settled = false;
        for _ in 0..MOST_ITERATIONS {
            let (mut change, mut size) = (0.0, 0.0);
            for stage in 0..3 {
                for (index, body) in self.bodies.iter_mut().enumerate() {
                    let mut mean = Rate::default();
                    for (other, weight) in GAUSS[stage].into_iter().enumerate() {
                        mean.add(weight, &self.stages[other][index]);
                    }
                    self.start[index].advance(h, &mean, body);
                }
                self.accelerate(t + GAUSS_NODES[stage] * h);
                for (index, body) in self.bodies.iter().enumerate() {
                    let rate = Rate::of(body, &self.system.a[index]);
                    let old = &self.stages[stage][index];
                    change += (rate.acceleration - old.acceleration).length_squared()
                        + (rate.angular_acceleration - old.angular_acceleration).length_squared();
                    size += rate.acceleration.length_squared() + rate.angular_acceleration.length_squared();
                    self.stages[stage][index] = rate;
                }
            }
            if change <= SETTLED * SETTLED * size {
                settled = true;
                break;
            }
            // Not finite, or far from settling: a shorter substep will.
            if !(change.is_finite()) {
                break;
            }
            settled = change <= NEARLY * NEARLY * size;
        }
        for (index, body) in self.bodies.iter_mut().enumerate() {
            let mut mean = Rate::default();
            for (stage, weight) in GAUSS_WEIGHTS.into_iter().enumerate() {
                mean.add(weight, &self.stages[stage][index]);
            }
            self.start[index].advance(h, &mean, body);
        }
        self.arrive(t + h);
        settled
    }

    /// Closes the joints at the new state, at the time `t`, and finds the rate there.
    fn arrive(&mut self, t: f64) {
        self.carry_driven(t);
        self.project();
        self.solve_forces(t);
    }

    /// Accelerations of the present state into the system's `a`, unless they are there already.
    fn ensure_rates(&mut self, t: f64) {
        if self.fresh {
            return;
        }
        self.accelerate(t);
        self.fresh = true;
    }

    /// Accelerations at the bodies' present state, rows and factor made anew.
    fn accelerate(&mut self, t: f64) {
        self.carry_driven(t);
        self.system.evaluate(&self.bodies);
        self.system.factor();
        self.solve_forces(t);
    }

    /// Accelerations by the rows and the factor at hand.
    fn solve_forces(&mut self, t: f64) {
        let gravity = self.settings.gravity;
        for (index, body) in self.bodies.iter().enumerate() {
            self.system.b[index] = forces::on_body(
                body,
                self.system.inertia_world(index),
                gravity,
                self.damping[index],
                &self.external[index],
            );
        }
        self.springs.push(&self.bodies, t, &mut self.system.b);
        for (body, a) in &self.driven_accelerations {
            self.system.a[*body] = *a;
        }
        self.system.solve_acceleration(&self.bodies, 1.0 / self.settings.stabilization_time);
    }

    /// Puts driven bodies where they belong at the time `t`.
    pub(super) fn carry_driven(&mut self, t: f64) {
        self.system.activity.set_time(t);
        for (drive, (body, a)) in self.drives.iter().zip(&mut self.driven_accelerations) {
            let (acceleration, turn) = drive.motion.at(t).carry(&mut self.bodies[*body]);
            *a = vec6(acceleration, turn);
        }
    }

    /// Closes the joints in place and speed; leaves the system factored there.
    pub(super) fn project(&mut self) {
        self.system.evaluate(&self.bodies);
        self.system.factor();
        if self.system.states().is_empty() {
            return;
        }
        self.system.solve_displacement();
        self.system.close(&mut self.bodies);
        self.system.solve_velocity(&self.bodies);
        self.system.apply_velocity(&mut self.bodies);
    }

    /// Lets pivot friction act for `dt` seconds, the joints held.
    pub(super) fn rub(&mut self, dt: f64) {
        self.system.evaluate(&self.bodies);
        self.system.add_friction(&self.bodies, &self.loads, dt);
        self.system.factor();
        self.system.solve_velocity(&self.bodies);
        self.system.apply_velocity(&mut self.bodies);
        self.fresh = false;
    }
}

/// Slower motion than this is followed no more closely than this one, m/s.
const SLOWEST: f64 = 1e-3;
/// Rates that still change by less than this share are good enough when iterations run out.
const NEARLY: f64 = 1e-12;

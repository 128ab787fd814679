//! The integrators: from one state of constrained bodies to a later one.
//!
//! State of a body: (x, q, v, ω), with a and α from the joints' solve. Within a substep its rotation is written as
//! q = exp(σ) q₀ and the vector σ is integrated (Munthe-Kaas), so that a body spinning about a fixed axis, as every
//! wheel does, turns by exactly the angle it should:
//!
//! ```text
//! σ̇ = ω − ½ σ×ω + k σ×(σ×ω)          k = (1 − (θ/2) cot(θ/2))/θ² = 1/12 + θ²/720 + θ⁴/30240 + …,  θ = |σ|
//! ```
//!
//! Afterwards the joints have drifted by
//! the method's local error; one Newton step on C (least in kinetic energy) brings them back to rounding, one linear
//! solve does the same for Ċ. The factor of that projection also gives the rate at the new state, which is the next
//! substep's first stage.
//!
//! **Runge–Kutta**, the classical method of fourth order. The new state's own rate k₅ beside the last stage k₄ gives
//! an estimate of the local error for nothing: h/6 (k₅ − k₄) = c h⁴ y⁗ is what a companion of third order would
//! differ by, and its change from one substep to the next, c h⁵ y⁽⁵⁾, has the order of the method's own error. It is
//! measured in the norm of the kinetic energy:
//!
//! ```text
//! d = (k₅ − k₄)/h³       e = h⁵/6 (d − d')/h'       error = √(Σ e·M e / Σ v·M v)       ' the substep before
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
use crate::articulation::block::{Vec6, angular, linear, vec6};
use crate::bodies::RigidBody;
use crate::math::{DQuat, DVec3, product, renormalized, rotation};

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

    /// This state and `h` times a rate, into a body; returns σ.
    #[inline]
    fn advance(&self, h: f64, rate: &Rate, body: &mut RigidBody) -> DVec3 {
        let turn = h * rate.turn;
        body.position = self.position + h * rate.velocity;
        body.rotation = renormalized(product(rotation(turn), self.rotation));
        body.velocity = self.velocity + h * rate.acceleration;
        body.angular_velocity = self.angular_velocity + h * rate.angular_acceleration;
        turn
    }
}

/// Rate of change of a body's state.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Rate {
    velocity: DVec3,
    /// σ̇.
    turn: DVec3,
    acceleration: DVec3,
    angular_acceleration: DVec3,
}

impl Rate {
    /// Of a body that has turned by σ since the substep began.
    #[inline]
    fn of(body: &RigidBody, sigma: DVec3, a: &Vec6) -> Self {
        let w = body.angular_velocity;
        let across = sigma.cross(w);
        let square = sigma.length_squared();
        let k = 1.0 / 12.0 + square * (1.0 / 720.0 + square / 30240.0);
        Self {
            velocity: body.velocity,
            turn: w - 0.5 * across + k * sigma.cross(across),
            acceleration: linear(a),
            angular_acceleration: angular(a),
        }
    }

    #[inline]
    fn add(&mut self, weight: f64, other: &Self) {
        self.velocity += weight * other.velocity;
        self.turn += weight * other.turn;
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
                let (mean, sigma) = (&mut self.mean[index], &mut self.turned[index]);
                if stage == 1 {
                    (*mean, *sigma) = (Rate::default(), DVec3::ZERO);
                }
                let rate = Rate::of(body, *sigma, &self.system.a[index]);
                mean.add(WEIGHTS[stage - 1], &rate);
                *sigma = self.start[index].advance(NODES[stage] * h, &rate, body);
            }
            self.accelerate(t + NODES[stage] * h);
        }
        for (index, body) in self.bodies.iter_mut().enumerate() {
            let rate = Rate::of(body, self.turned[index], &self.system.a[index]);
            let mean = &mut self.mean[index];
            mean.add(WEIGHTS[3], &rate);
            self.last[index] = self.system.a[index];
            self.start[index].advance(h, mean, body);
        }
        self.arrive(t + h);
        self.estimate(h)
    }

    /// The error of a Runge–Kutta substep of `h` that has just arrived, as a share of the velocities.
    fn estimate(&mut self, h: f64) -> f64 {
        let cube = h * h * h;
        let per_cube = 1.0 / cube;
        // h⁵/(6 h'), or a share of the estimate itself where there is no substep before.
        let spread = cube * self.fourth_step.map_or(h * UNKNOWN, |before| h * h / before) / 6.0;
        let (mut error, mut scale) = (0.0, 0.0);
        for (index, body) in self.bodies.iter().enumerate() {
            let (mass, inertia) = (body.properties.mass, self.system.inertia_world(index));
            let norm = |v: &Vec6| mass * linear(v).length_squared() + angular(v).dot(inertia.mul(angular(v).into()).into());
            let (a, last) = (&self.system.a[index], &self.last[index]);
            let fourth: Vec6 = std::array::from_fn(|k| (a[k] - last[k]) * per_cube);
            let before = std::mem::replace(&mut self.fourth[index], fourth);
            let change: Vec6 = match self.fourth_step {
                Some(_) => std::array::from_fn(|k| (fourth[k] - before[k]) * spread),
                None => fourth.map(|x| x * spread),
            };
            error += norm(&change);
            scale += norm(&vec6(body.velocity, body.angular_velocity)) + mass * SLOWEST * SLOWEST;
        }
        self.fourth_step = Some(h);
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
            let rate = Rate::of(body, DVec3::ZERO, &self.system.a[index]);
            // A body's velocity changes as its acceleration says, which is the better first guess.
            for (stage, node) in GAUSS_NODES.into_iter().enumerate() {
                let mut guess = rate;
                guess.velocity += node * h * rate.acceleration;
                guess.turn += node * h * rate.angular_acceleration;
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
                    self.turned[index] = self.start[index].advance(h, &mean, body);
                }
                self.accelerate(t + GAUSS_NODES[stage] * h);
                for (index, body) in self.bodies.iter().enumerate() {
                    let rate = Rate::of(body, self.turned[index], &self.system.a[index]);
                    let old = &self.stages[stage][index];
                    change += (rate.acceleration - old.acceleration).length_squared()
                        + (rate.angular_acceleration - old.angular_acceleration).length_squared()
                        + (rate.turn - old.turn).length_squared();
                    size += rate.acceleration.length_squared()
                        + rate.angular_acceleration.length_squared()
                        + rate.turn.length_squared();
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
    pub(super) fn ensure_rates(&mut self, t: f64) {
        if self.fresh {
            return;
        }
        self.carry_driven(t);
        self.system.evaluate(&self.bodies);
        self.system.look_for_gaps();
        self.system.factor();
        self.solve_forces(t);
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
                &self.system.inertia_world(index),
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
        self.system.look_for_gaps();
        let apart = self.system.largest_error();
        self.system.solve_displacement();
        self.system.close(&mut self.bodies);
        if apart > COARSE {
            // Newton's error is the square of what was there.
            self.system.evaluate(&self.bodies);
            self.system.factor();
            self.system.solve_displacement();
            self.system.close(&mut self.bodies);
        }
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

/// Joints farther apart than this before projection are projected twice, m or rad: the second time from the square of it.
const COARSE: f64 = 1e-7;
/// Where no earlier substep tells how fast the estimate changes, this share of it is taken.
const UNKNOWN: f64 = 0.1;
/// Slower motion than this is followed no more closely than this one, m/s.
const SLOWEST: f64 = 1e-3;
/// Rates that still change by less than this share are good enough when iterations run out.
const NEARLY: f64 = 1e-12;

//! The integrators: from one state of constrained bodies to a later one.
//!
//! How a state goes on at a rate says `course.rs`; it is done for four bodies at a time, by the quads of the tree.
//! At the end of a substep the joints have drifted by the method's local error; one Newton step on C (least in kinetic
//! energy) brings them back to rounding, one linear solve does the same for Ċ. The factor of that projection also gives
//! the rate at the new state, which is the next substep's first stage.
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
//! Where motion has gone smoothly for three whole steps, **Adams'** method does the next one at half the price (`adams.rs`).
//!
//! **Gauss–Legendre** with three stages, of sixth order, symplectic on smooth motion:
//!
//! ```text
//! Y_i = y + h Σ_j a_ij f(Y_j)          y' = y + h Σ b_i f(Y_i)
//! ```
//!
//! solved by simple iteration from the rate at the start (Hairer, Lubich, Wanner, Geometric Numerical Integration,
//! II.1.3). **Fast**: semi-implicit Euler.

use super::passes::{Compare, Estimate, Guess, Last, Mean, Push, Show, Stage};
use super::{Dynamics, Known};
use soffio_math::spatial::{angular, linear, vec6};

/// Shares of the step at which the second, third and fourth rates are taken, and the weights of the four.
const NODES: [f64; 4] = [0.0, 0.5, 0.5, 1.0];
pub(super) const WEIGHTS: [f64; 4] = [1.0 / 6.0, 1.0 / 3.0, 1.0 / 3.0, 1.0 / 6.0];

/// √15.
const R15: f64 = 3.872_983_346_207_417;
/// Nodes, weights and coefficients of the Gauss–Legendre method.
pub(super) const GAUSS_NODES: [f64; 3] = [0.5 - R15 / 10.0, 0.5, 0.5 + R15 / 10.0];
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

impl Dynamics {
    /// Moves the bodies from the time `t` by `h`, by the classical Runge–Kutta method; returns the estimated error.
    pub(super) fn runge_kutta(&mut self, t: f64, h: f64) -> f64 {
        self.ensure_rates(t);
        for stage in 1..4 {
            let (weight, share) = (WEIGHTS[stage - 1], NODES[stage]);
            self.by_quads(Stage { first: stage == 1, weight, h: share * h });
            self.accelerate(t + NODES[stage] * h);
        }
        self.by_quads(Last { h });
        self.arrive(t + h);
        self.estimate(h)
    }

    /// The error of a Runge–Kutta substep of `h` that has just arrived, as a share of the velocities.
    fn estimate(&mut self, h: f64) -> f64 {
        let cube = h * h * h;
        // h⁵/(6 h'), or a share of the estimate itself where there is no substep before.
        let spread = cube * self.fourth_step.map_or(h * UNKNOWN, |before| h * h / before) / 6.0;
        let slot = self.run.goes_by(h);
        self.by_quads(Estimate { per_cube: 1.0 / cube, spread, before: self.fourth_step.is_some(), slot });
        self.fourth_step = Some(h);
        let [error, scale] = self.norms.iter().fold([0.0, 0.0], |sum, norm| [sum[0] + norm[0], sum[1] + norm[1]]);
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
        self.system.quads_mut().look(&self.bodies);
        self.arrive(t + h);
    }

    /// Moves the bodies by the Gauss–Legendre method; false where the iteration did not settle.
    pub(super) fn gauss(&mut self, t: f64, h: f64) -> bool {
        self.ensure_rates(t);
        self.by_quads(Guess { h });
        let mut settled = false;
        for _ in 0..MOST_ITERATIONS {
            let (mut change, mut size) = (0.0, 0.0);
            for stage in 0..3 {
                self.by_quads(Mean { weights: GAUSS[stage], h });
                self.accelerate(t + GAUSS_NODES[stage] * h);
                self.by_quads(Compare { stage });
                for norm in &self.norms {
                    change += norm[0];
                    size += norm[1];
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
        self.by_quads(Mean { weights: GAUSS_WEIGHTS, h });
        self.arrive(t + h);
        settled
    }

    /// Closes the joints at the new state, at the time `t`, and finds the rate there.
    fn arrive(&mut self, t: f64) {
        self.close(t, true);
        self.solve_forces(t);
        self.contacts.weigh(&self.system);
    }

    /// Closes the joints at the new state, at the time `t`; in speed where what rests does not do so afterwards, with its impulses.
    /// Not `anew`, the factor is that of a state which differs by less than a step's error.
    pub(super) fn close(&mut self, t: f64, anew: bool) {
        self.carry_driven(t);
        self.close_joints(anew, !self.contacts.anything_rests());
    }

    /// Accelerations of the present state into the system's `a`, as far as they are not there already.
    pub(super) fn ensure_rates(&mut self, t: f64) {
        if self.known == Known::Rates {
            return;
        }
        self.carry_driven(t);
        if self.known == Known::Nothing {
            self.system.evaluate_lean(&self.bodies);
            self.system.look_for_gaps();
            self.system.factor();
        }
        self.solve_forces(t);
        self.known = Known::Rates;
    }

    /// Accelerations at the quads' present state, rows and factor made anew.
    pub(super) fn accelerate(&mut self, t: f64) {
        self.carry_driven(t);
        self.show_where_asked();
        self.system.evaluate_motion(&self.bodies);
        self.system.factor();
        self.solve_forces(t);
    }

    /// Accelerations by the rows and the factor at hand.
    fn solve_forces(&mut self, t: f64) {
        self.by_quads(Push);
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
            self.system.quads_mut().look_at(*body, &self.bodies[*body]);
            *a = vec6(acceleration, turn);
        }
    }

    /// Evaluates the rows at the quads' present state.
    fn evaluate_quads(&mut self) {
        self.show_where_asked();
        self.system.evaluate_quads(&self.bodies);
    }

    fn show_where_asked(&mut self) {
        if self.system.asks_bodies() || !self.springs.is_empty() {
            self.by_quads(Show);
        }
    }

    /// Closes the joints of the bodies in place and speed; leaves the system factored there.
    pub(super) fn project(&mut self) {
        self.system.quads_mut().look(&self.bodies);
        self.close_joints(true, true);
        self.known = Known::Factor;
    }

    /// Takes over the velocities of bodies whose joints are closed, and factored there.
    pub(super) fn look_at_rates(&mut self) {
        self.system.quads_mut().look(&self.bodies);
        self.evaluate_quads();
        self.system.look_for_gaps();
        self.known = Known::Factor;
    }

    /// The same as [`Dynamics::project`] where the quads are, factored `anew` and `in_speed` too if asked; the bodies follow.
    fn close_joints(&mut self, anew: bool, in_speed: bool) {
        self.evaluate_quads();
        if anew {
            self.system.factor();
        }
        if self.system.states().is_empty() {
            self.by_quads(Show);
            return;
        }
        self.system.look_for_gaps();
        let apart = self.system.largest_lean_error();
        self.system.solve_displacement();
        self.system.close_quads();
        if apart > COARSE {
            // Newton's error is the square of what was there.
            self.system.quads_mut().turn();
            self.evaluate_quads();
            self.system.factor();
            self.system.solve_displacement();
            self.system.close_quads();
        }
        if in_speed {
            self.system.solve_velocity_quads(&self.bodies);
            self.system.apply_velocity_quads();
        }
        self.by_quads(Show);
    }

    /// Lets pivot friction act for `dt` seconds, the joints held.
    pub(super) fn rub(&mut self, dt: f64) {
        self.system.evaluate(&self.bodies);
        self.system.add_friction(&self.bodies, &self.loads, dt);
        self.system.factor();
        self.system.solve_velocity(&self.bodies);
        self.system.apply_velocity(&mut self.bodies);
        self.known = Known::Nothing;
    }
}

/// Joints farther apart than this before projection are projected twice, m or rad: the second time from the square of it.
const COARSE: f64 = 1e-7;
/// Where no earlier substep tells how fast the estimate changes, this share of it is taken.
const UNKNOWN: f64 = 0.1;
/// Rates that still change by less than this share are good enough when iterations run out.
const NEARLY: f64 = 1e-12;

//! The integrators: from one state of constrained bodies to a later one.
//!
//! How a state goes on at a rate says `state.rs`; it is done for four bodies at a time, by the quads of the tree.
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

use super::Integrator;
use super::adams::MultistepHistory;
use super::contacts::Contacts;
use super::equations::{Equations, Evaluated};
use super::lane_kernels::{Compare, Estimate, Guess, Last, Mean, Restore, Save, Stage, Stages, run_kernel};
use super::step_size_controller;
use super::substep_state::{Rate, SLOWEST, SubstepState};
use soffio_geometry::bodies::RigidBody;

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

/// Where no earlier substep tells how fast the estimate changes, this share of it is taken.
const UNKNOWN: f64 = 0.1;
/// Rates that still change by less than this share are good enough when iterations run out.
const NEARLY: f64 = 1e-12;

/// A figure as an integrator moves it.
pub(super) struct Moving<'a> {
    pub bodies: &'a mut [RigidBody],
    pub equations: &'a mut Equations,
    /// What rests stays as it is; it is told what the joints carry.
    pub contacts: &'a mut Contacts,
}

/// State of the integrators. Nothing here allocates after [`Integration::new`].
#[derive(Clone)]
pub(super) struct Integration {
    method: Integrator,
    /// Is it the Gauss–Legendre method's figure?
    precise: bool,
    /// By quads of the joints' tree.
    states: Vec<SubstepState>,
    /// Rates of the Gauss–Legendre stages, by quads.
    stages: Stages,
    /// What a pass over the bodies found of each, for sums in their order.
    norms: Vec<[f64; 2]>,
    /// The steps that Adams' method goes on from.
    history: MultistepHistory,
    /// h of the last substep; `None` where its error says nothing of the next.
    pub fourth_step: Option<f64>,
    /// Length of the present step, s.
    dt: f64,
    /// Substep that the error allows, s.
    pub suggested_step: f64,
}

impl Integration {
    /// Of a figure of so many bodies in so many quads.
    pub fn new(method: Integrator, precise: bool, bodies: usize, quads: usize) -> Self {
        let stages = || vec![Rate::default(); if precise { quads } else { 0 }];
        Self {
            method,
            precise,
            states: vec![SubstepState::default(); quads],
            stages: [stages(), stages(), stages()],
            norms: vec![[0.0; 2]; bodies],
            history: MultistepHistory::default(),
            fourth_step: None,
            dt: 0.0,
            suggested_step: f64::INFINITY,
        }
    }

    /// Begins a step of `dt` seconds.
    pub fn begin_step(&mut self, dt: f64) {
        self.dt = dt;
    }

    /// Begins a substep where the bodies are.
    pub fn begin_substep(&mut self, moving: &mut Moving) {
        run_kernel(&mut moving.equations.system, Save { bodies: moving.bodies, states: &mut self.states });
        self.history.begin();
    }

    /// Puts the bodies back to where the substep began.
    pub fn back_to_start(&self, moving: &mut Moving) {
        run_kernel(&mut moving.equations.system, Restore { bodies: moving.bodies, states: &self.states });
        moving.equations.evaluated = Evaluated::Nothing;
    }

    /// Something has happened: past accelerations say nothing of what comes.
    pub fn interrupt(&mut self) {
        self.history.end();
    }

    /// Forgets all that was learnt: the figure goes on from another state.
    pub fn reset(&mut self) {
        self.history.end();
        (self.fourth_step, self.suggested_step) = (None, f64::INFINITY);
    }

    /// A body of this mass (kg) is put to rest: it has no error.
    pub fn put_to_rest(&mut self, body: usize, mass: f64) {
        self.norms[body] = [0.0, mass * SLOWEST * SLOWEST];
    }

    /// Integrates from the substep's start at the time `t` over `h`, or over less where the error asks for it, but
    /// not less than `least`; returns the time used.
    pub fn integrate(&mut self, moving: &mut Moving, t: f64, mut h: f64, least: f64) -> f64 {
        let whole = h > 0.999 * self.dt;
        if whole && !self.precise && self.method == Integrator::Auto && self.adams(moving, t, h) {
            moving.equations.evaluated = Evaluated::Factor;
            self.suggested_step = f64::INFINITY;
            return h;
        }
        loop {
            let (good, wish) = if self.method == Integrator::Fast {
                self.euler(moving, t, h);
                (true, f64::INFINITY)
            } else if self.precise {
                let settled = self.gauss(moving, t, h);
                (settled, if settled { f64::INFINITY } else { 0.5 * h })
            } else {
                let error = self.runge_kutta(moving, t, h);
                step_size_controller::judge(h, self.dt, error)
            };
            moving.equations.evaluated = Evaluated::Accelerations;
            self.suggested_step = wish;
            if good || h <= least {
                return h;
            }
            self.back_to_start(moving);
            self.fourth_step = None;
            h = wish.min(0.5 * h).max(least);
        }
    }

    /// Moves the bodies from the time `t` by `h`, by the classical Runge–Kutta method; returns the estimated error.
    fn runge_kutta(&mut self, moving: &mut Moving, t: f64, h: f64) -> f64 {
        moving.equations.ensure_accelerations(moving.bodies, t);
        for stage in 1..4 {
            let (weight, share) = (WEIGHTS[stage - 1], NODES[stage]);
            let pass = Stage { states: &mut self.states, first: stage == 1, weight, h: share * h };
            run_kernel(&mut moving.equations.system, pass);
            moving.equations.accelerate(moving.bodies, t + NODES[stage] * h);
        }
        run_kernel(&mut moving.equations.system, Last { states: &mut self.states, h, weight: WEIGHTS[3] });
        moving.finish_substep(t + h);
        self.estimate(moving, h)
    }

    /// The error of a Runge–Kutta substep of `h` that has just arrived, as a share of the velocities.
    fn estimate(&mut self, moving: &mut Moving, h: f64) -> f64 {
        let cube = h * h * h;
        // h⁵/(6 h'), or a share of the estimate itself where there is no substep before.
        let spread = cube * self.fourth_step.map_or(h * UNKNOWN, |before| h * h / before) / 6.0;
        let (per_cube, before, slot) = (1.0 / cube, self.fourth_step.is_some(), self.history.goes_by(h));
        let (states, norms) = (&mut self.states, &mut self.norms);
        run_kernel(&mut moving.equations.system, Estimate { states, norms, per_cube, spread, before, slot });
        self.fourth_step = Some(h);
        let [error, scale] = self.norms.iter().fold([0.0, 0.0], |sum, norm| [sum[0] + norm[0], sum[1] + norm[1]]);
        (error / scale).sqrt()
    }

    /// Moves the bodies by semi-implicit Euler.
    fn euler(&mut self, moving: &mut Moving, t: f64, h: f64) {
        moving.equations.ensure_accelerations(moving.bodies, t);
        moving.equations.step_euler(moving.bodies, h);
        moving.finish_substep(t + h);
    }

    /// Moves the bodies from the time `t` by `h` by Adams' method, if they have moved smoothly enough for it; else they stay
    /// where they were.
    fn adams(&mut self, moving: &mut Moving, t: f64, h: f64) -> bool {
        if !self.history.serves(h) {
            return false;
        }
        moving.equations.ensure_accelerations(moving.bodies, t);
        self.history.predict(moving.equations, moving.bodies, &mut self.states, (t, h));
        moving.contacts.record_clutch_loads(&moving.equations.system);
        let smooth = self.history.correct(&mut moving.equations.system, &mut self.states, &mut self.norms, h);
        if smooth {
            // The corrected state is the predicted one but for an error of fifth order: its factor serves.
            moving.close(t + h, false);
            self.history.go_on();
            // It is another method's estimate.
            self.fourth_step = None;
        } else {
            self.history.end();
            self.back_to_start(moving);
        }
        smooth
    }

    /// Moves the bodies by the Gauss–Legendre method; false where the iteration did not settle.
    fn gauss(&mut self, moving: &mut Moving, t: f64, h: f64) -> bool {
        let Self { states, stages, norms, .. } = self;
        moving.equations.ensure_accelerations(moving.bodies, t);
        run_kernel(&mut moving.equations.system, Guess { states, stages, h, nodes: GAUSS_NODES });
        let mut settled = false;
        for _ in 0..MOST_ITERATIONS {
            let (mut change, mut size) = (0.0, 0.0);
            for stage in 0..3 {
                run_kernel(&mut moving.equations.system, Mean { states, stages, weights: GAUSS[stage], h });
                moving.equations.accelerate(moving.bodies, t + GAUSS_NODES[stage] * h);
                run_kernel(&mut moving.equations.system, Compare { states, stages, norms, stage });
                for norm in &*norms {
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
        run_kernel(&mut moving.equations.system, Mean { states, stages, weights: GAUSS_WEIGHTS, h });
        moving.finish_substep(t + h);
        settled
    }
}

impl Moving<'_> {
    /// Closes the joints at the new state, at the time `t`, and finds the rate there.
    fn finish_substep(&mut self, t: f64) {
        self.close(t, true);
        self.equations.solve_forces(self.bodies, t);
        self.contacts.record_clutch_loads(&self.equations.system);
    }

    /// Closes the joints at the new state, at the time `t`; in speed where what rests does not do so afterwards, with its impulses.
    /// Not `anew`, the factor is that of a state which differs by less than a step's error.
    fn close(&mut self, t: f64, anew: bool) {
        self.equations.close(self.bodies, t, (anew, !self.contacts.has_resting_contacts()));
    }
}

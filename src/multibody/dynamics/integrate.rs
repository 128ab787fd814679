//! Integrators: Runge–Kutta, Adams–Bashforth–Moulton, Gauss–Legendre and semi-implicit Euler, with projection of the joints.
//!
//! `substep_state.rs` has the state and its rate; kernels advance four bodies at a time (`lane_kernels.rs`). At the end of a
//! substep the joints have drifted by the method's local error. One Newton step on C, least in kinetic energy, projects them back
//! to rounding, and one linear solve does the same for Ċ. The factor of that projection also gives the rate at the new state,
//! which is the next substep's first stage.
//!
//! **Runge–Kutta**, the classical method of fourth order. The new state's rate k₅ and the last stage k₄ estimate the local error
//! without further evaluations. h/6 (k₅ − k₄) = c h⁴ y⁗ is the difference from an embedded method of third order. Its change
//! between two substeps, c h⁵ y⁽⁵⁾, has the order of the method's own error. It is measured in the norm of kinetic energy:
//!
//! ```text
//! d = (k₅ − k₄)/h³       e = h⁵/6 (d − d')/h'       error = √(Σ e·M e / Σ v·M v)       ' the substep before
//! ```
//!
//! Where motion was smooth for three whole steps, **Adams–Bashforth–Moulton** takes the next one at half the cost (`adams.rs`).
//!
//! **Gauss–Legendre** with three stages, of sixth order, symplectic on smooth motion:
//!
//! ```text
//! Y_i = y + h Σ_j a_ij f(Y_j)          y' = y + h Σ b_i f(Y_i)
//! ```
//!
//! solved by fixed-point iteration from the rate at the start (Hairer, Lubich, Wanner, Geometric Numerical Integration, II.1.3).
//! **Fast**: semi-implicit Euler.

use super::Integrator;
use super::adams::{MultistepHistory, Smoothness};
use super::contacts::Contacts;
use super::equations::{Equations, Evaluated, FactorUse, JointClosing};
use super::lane_kernels::{Compare, Estimate, Guess, Last, Mean, Restore, Save, Stage, Stages, run_kernel};
use super::step_size_controller::{self, StepSizeDecision};
use super::substep_state::{Rate, SLOWEST, SubstepState};
use soffio_geometry::bodies::RigidBody;

/// Nodes (fractions of the substep) and weights of the classical Runge–Kutta method.
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

/// When the fixed-point iteration of Gauss–Legendre's stages ends.
struct GaussIteration {
    /// Relative change of the rates that is rounding.
    converged: f64,
    /// Relative change that will do when the iterations run out.
    acceptable: f64,
    /// Iterations at most; slower convergence is rounding, or the substep was too long.
    iterations: usize,
}

const GAUSS_ITERATION: GaussIteration = GaussIteration { converged: 1e-15, acceptable: 1e-12, iterations: 16 };

/// Change of the error estimate, as a fraction of it, where there is no earlier substep to compare with.
const UNKNOWN_CHANGE: f64 = 0.1;

/// A substep longer than this fraction of the step is a whole step: rounding.
const WHOLE: f64 = 0.999;

/// Whether a substep is repeated with a shorter length where its error is too large.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ErrorControl {
    On,
    /// The length is given.
    Off,
}

/// A substep to be integrated.
#[derive(Clone, Copy, Debug)]
pub(super) struct Substep {
    /// Time at its start, seconds since reset.
    pub t: f64,
    /// Its length, s.
    pub h: f64,
    /// The shortest length that the error may ask for, s.
    pub shortest: f64,
    /// How the length of the substep follows from the error.
    pub error_control: ErrorControl,
}

/// Whether an iteration converged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Convergence {
    Converged,
    NotConverged,
}

/// An articulation as an integrator advances it.
pub(super) struct Moving<'a> {
    /// All bodies.
    pub bodies: &'a mut [RigidBody],
    /// Their equations of motion.
    pub equations: &'a mut Equations,
    /// Contacts do not change within a substep; only the clutches' loads are recorded.
    pub contacts: &'a mut Contacts,
}

/// State of the integrators. Nothing here allocates after [`Integration::new`].
#[derive(Clone)]
pub(super) struct Integration {
    method: Integrator,
    /// Gauss–Legendre's method is used.
    precise: bool,
    /// By lane blocks of the joints' tree.
    states: Vec<SubstepState>,
    /// Rates of the Gauss–Legendre stages, by lane blocks.
    stages: Stages,
    /// Error and scale of each body, for sums in the bodies' order.
    norms: Vec<[f64; 2]>,
    history: MultistepHistory,
    /// Length of the last substep, s; `None` where its error says nothing about the next.
    pub fourth_step: Option<f64>,
    /// Length of the present step, s.
    dt: f64,
    /// Substep that the error allows, s.
    pub suggested_step: f64,
}

impl Integration {
    /// For so many bodies in so many lane blocks.
    pub fn new(method: Integrator, precise: bool, bodies: usize, lane_blocks: usize) -> Self {
        let stages = || vec![Rate::default(); if precise { lane_blocks } else { 0 }];
        Self {
            method,
            precise,
            states: vec![SubstepState::default(); lane_blocks],
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

    /// Begins a substep at the bodies' present state.
    pub fn begin_substep(&mut self, moving: &mut Moving) {
        run_kernel(&mut moving.equations.system, Save { bodies: moving.bodies, states: &mut self.states });
        self.history.begin_substep();
    }

    /// Puts the bodies back to the start of the substep.
    pub fn back_to_start(&self, moving: &mut Moving) {
        run_kernel(&mut moving.equations.system, Restore { bodies: moving.bodies, states: &self.states });
        moving.equations.evaluated = Evaluated::Nothing;
    }

    /// Ends the multistep history: past accelerations say nothing about the next ones.
    pub fn interrupt(&mut self) {
        self.history.end();
    }

    /// Forgets all past substeps, for bodies that were moved.
    pub fn reset(&mut self) {
        self.history.end();
        (self.fourth_step, self.suggested_step) = (None, f64::INFINITY);
    }

    /// Sets the error of a body of this mass (kg) to zero, because it falls asleep.
    pub fn put_to_rest(&mut self, body: usize, mass: f64) {
        self.norms[body] = [0.0, mass * SLOWEST * SLOWEST];
    }

    /// Integrates a substep from its start, or less of it where the error asks for that. Returns the time used, s.
    pub fn integrate(&mut self, moving: &mut Moving, substep: Substep) -> f64 {
        let Substep { t, mut h, shortest, error_control } = substep;
        let shortest = if error_control == ErrorControl::Off { h } else { shortest };
        let whole = h > WHOLE * self.dt;
        let may_multistep = whole && !self.precise && self.method == Integrator::Auto;
        if may_multistep && self.adams(moving, t, h) == Smoothness::Smooth {
            moving.equations.evaluated = Evaluated::Factor;
            self.suggested_step = f64::INFINITY;
            return h;
        }
        loop {
            let StepSizeDecision { accepted, suggested_step } = if self.method == Integrator::Fast {
                self.euler(moving, t, h);
                StepSizeDecision { accepted: true, suggested_step: f64::INFINITY }
            } else if self.precise {
                match self.gauss(moving, t, h) {
                    Convergence::Converged => StepSizeDecision { accepted: true, suggested_step: f64::INFINITY },
                    Convergence::NotConverged => StepSizeDecision { accepted: false, suggested_step: 0.5 * h },
                }
            } else {
                let error = self.runge_kutta(moving, t, h);
                step_size_controller::decide(h, self.dt, error)
            };
            moving.equations.evaluated = Evaluated::Accelerations;
            self.suggested_step = suggested_step;
            if accepted || h <= shortest {
                return h;
            }
            self.back_to_start(moving);
            self.fourth_step = None;
            h = suggested_step.min(0.5 * h).max(shortest);
        }
    }

    /// Advances by `h` from the time `t` by the classical Runge–Kutta method. Returns the estimated error.
    fn runge_kutta(&mut self, moving: &mut Moving, t: f64, h: f64) -> f64 {
        moving.equations.ensure_accelerations(moving.bodies, t);
        for stage in 1..4 {
            let (weight, node) = (WEIGHTS[stage - 1], NODES[stage]);
            let kernel = Stage { states: &mut self.states, first: stage == 1, weight, h: node * h };
            run_kernel(&mut moving.equations.system, kernel);
            moving.equations.accelerate(moving.bodies, t + NODES[stage] * h);
        }
        run_kernel(&mut moving.equations.system, Last { states: &mut self.states, h, weight: WEIGHTS[3] });
        moving.finish_substep(t + h);
        self.estimate(moving, h)
    }

    /// Error of a Runge–Kutta substep of `h` that has just ended, relative to the velocities.
    fn estimate(&mut self, moving: &mut Moving, h: f64) -> f64 {
        let cube = h * h * h;
        // h⁵/(6 h'), or a fraction of the estimate itself where there is no substep before.
        let scale = cube * self.fourth_step.map_or(h * UNKNOWN_CHANGE, |before| h * h / before) / 6.0;
        let (per_cube, has_previous, index) = (1.0 / cube, self.fourth_step.is_some(), self.history.record_step(h));
        let (states, norms) = (&mut self.states, &mut self.norms);
        run_kernel(&mut moving.equations.system, Estimate { states, norms, per_cube, scale, has_previous, index });
        self.fourth_step = Some(h);
        let [error, scale] = self.norms.iter().fold([0.0, 0.0], |sum, norm| [sum[0] + norm[0], sum[1] + norm[1]]);
        (error / scale).sqrt()
    }

    /// Advances by semi-implicit Euler.
    fn euler(&mut self, moving: &mut Moving, t: f64, h: f64) {
        moving.equations.ensure_accelerations(moving.bodies, t);
        moving.equations.step_euler(moving.bodies, h);
        moving.finish_substep(t + h);
    }

    /// Advances by `h` from the time `t` by Adams–Bashforth–Moulton, if motion is smooth enough for it; else the bodies stay at
    /// the start.
    fn adams(&mut self, moving: &mut Moving, t: f64, h: f64) -> Smoothness {
        if !self.history.is_sufficient(h) {
            return Smoothness::NotSmooth;
        }
        moving.equations.ensure_accelerations(moving.bodies, t);
        self.history.predict(moving.equations, moving.bodies, &mut self.states, t, h);
        moving.contacts.record_clutch_loads(&moving.equations.system);
        let smoothness = self.history.correct(&mut moving.equations.system, &mut self.states, &mut self.norms, h);
        match smoothness {
            Smoothness::Smooth => {
                // The corrected state differs from the predicted one by an error of fifth order: its factor is reused.
                moving.close_joints(t + h, FactorUse::Reuse);
                self.history.extend();
                // The estimate was another method's.
                self.fourth_step = None;
            }
            Smoothness::NotSmooth => {
                self.history.end();
                self.back_to_start(moving);
            }
        }
        smoothness
    }

    /// Advances by the Gauss–Legendre method.
    fn gauss(&mut self, moving: &mut Moving, t: f64, h: f64) -> Convergence {
        let Self { states, stages, norms, .. } = self;
        let GaussIteration { converged, acceptable, iterations } = GAUSS_ITERATION;
        moving.equations.ensure_accelerations(moving.bodies, t);
        run_kernel(&mut moving.equations.system, Guess { states, stages, h, nodes: GAUSS_NODES });
        let mut convergence = Convergence::NotConverged;
        for _ in 0..iterations {
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
            if change <= converged * converged * size {
                convergence = Convergence::Converged;
                break;
            }
            // It diverges: a shorter substep will converge.
            if !(change.is_finite()) {
                break;
            }
            let is_acceptable = change <= acceptable * acceptable * size;
            convergence = if is_acceptable { Convergence::Converged } else { Convergence::NotConverged };
        }
        run_kernel(&mut moving.equations.system, Mean { states, stages, weights: GAUSS_WEIGHTS, h });
        moving.finish_substep(t + h);
        convergence
    }
}

impl Moving<'_> {
    /// Closes the joints at the new state, at the time `t`, and finds the accelerations there.
    fn finish_substep(&mut self, t: f64) {
        self.close_joints(t, FactorUse::Refactor);
        self.equations.solve_forces(self.bodies, t);
        self.contacts.record_clutch_loads(&self.equations.system);
    }

    /// Closes the joints at the new state, at the time `t`. Resting contacts close them in velocity afterwards, with their impulses.
    fn close_joints(&mut self, t: f64, factor: FactorUse) {
        let velocities = !self.contacts.has_resting_contacts();
        self.equations.close_joints_at(self.bodies, t, JointClosing { factor, velocities });
    }
}

//! Position-based motion (method 3.1 to 3.6): positions are solved first and velocities derived from them. It has no
//! stiff forces, so a body can be dragged anywhere, and a step has a bounded cost.
//!
//! Each step has two stages. The **update** moves each body as if it were free,
//!
//! ```text
//! x_{k+1} = x_k + κ (x_k − x_{k−1}) + a Δt²        κ ∈ [0, 1],   (x_k − x_{k−1})/Δt kept as the velocity
//! ```
//!
//! and rotates it likewise; kinematic bodies follow their motion. The **adjustment** closes the joints again, by one
//! of two solvers:
//!
//! * [`PositionSolver::Relaxation`], the source's "compulsive motion": joint-by-joint relaxation, a Gauss–Seidel
//!   sweep akin to CCD and FABRIK, with a rule for two bodies (`two_body_rule.rs`), one joint (`joint_closure.rs`),
//!   and grouping along the mechanism (`walk.rs`, `relaxation.rs`). It is visibly plausible for drags; under gravity
//!   alone it swings too little, as small displacements rotate nothing.
//! * [`PositionSolver::TreeSolve`]: Newton's method on all joints at once, of least kinetic energy (`tree_solve.rs`),
//!   first order in Δt.
//!
//! Then penetrating contacts are separated and impulses applied (`contact_response.rs`); resting contacts slide, roll
//! and spin (`resting_friction.rs`). Balls follow the source's slip ratio with Relaxation, Coulomb's law with
//! TreeSolve. Velocities are v = (x_{k+1} − x_k)/Δt, so constrained dynamics can continue from any step, and vice
//! versa.
//!
//! κ is 1/(1 + c Δt) with the body's damping rate c, times [`Settings::retention`]. Breaking by load and pivot
//! friction need forces and are not included; windows, triggers, breaths and springs act as always.

mod contact_response;
mod grab;
mod joint_closure;
mod lane_kernels;
mod relaxation;
mod resting_friction;
mod settings;
mod tree_solve;
pub mod two_body_rule;
pub mod walk;

use crate::dynamics::{Dynamics, Impact, PositionStep};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::Vec6;

use contact_response::{ContactResponse, FrictionLaw, ResponseStep, SeparationPass};
pub use grab::{GrabTarget, MAX_GRABS, POSITION_TOLERANCE, SolveOutcome, SolveReport};
use lane_kernels::LaneKernels;
pub use lane_kernels::{MAX_SPEED, MAX_SPIN};
pub use relaxation::MAX_SWEEPS;
use relaxation::Relaxation;
pub use settings::{DEFAULT_CONTROL, PositionSolver, Settings};
use tree_solve::TreeSolve;
pub use tree_solve::{MAX_FREE_PASSES, MAX_GRAB_PASSES};

/// Grab error below which a failed Newton solve is retried after relaxation, m.
const RETRY_DISTANCE: f64 = 0.02;
/// Most separation passes in one step.
const MAX_SEPARATION_PASSES: usize = 6;
/// Position-based motion of an articulation. Nothing here allocates once the largest number of grabs has been used.
#[derive(Clone, Debug)]
pub struct Procedural {
    settings: Settings,
    lane_kernels: LaneKernels,
    before: Vec<RigidBody>,
    checkpoint: Vec<RigidBody>,
    relaxation: Relaxation,
    tree: TreeSolve,
    contact_response: ContactResponse,
    report: SolveReport,
    /// End of the last step, s.
    ended: f64,
}

impl Procedural {
    /// Position-based motion of the articulation of `dynamics`.
    pub fn new(dynamics: &Dynamics, settings: Settings) -> Self {
        let bodies = &dynamics.bodies;
        Self {
            settings,
            lane_kernels: LaneKernels::new(dynamics),
            before: bodies.clone(),
            checkpoint: bodies.clone(),
            relaxation: Relaxation::new(dynamics),
            tree: TreeSolve::new(dynamics.system_without_trains(), bodies.len()),
            contact_response: ContactResponse::new(dynamics),
            report: SolveReport::default(),
            ended: f64::NAN,
        }
    }

    /// Settings; they may be changed between steps.
    pub fn settings_mut(&mut self) -> &mut Settings {
        &mut self.settings
    }

    /// Report of the last step's position solve.
    pub fn report(&self) -> SolveReport {
        self.report
    }

    /// Advances the articulation by `dt` seconds under external wrenches (N and N m about each centre of mass), with
    /// the first [`MAX_GRABS`] grabs. Appends impacts to `impacts`. Returns the first body with non-finite numbers,
    /// if any: then the articulation was restored.
    pub fn step(
        &mut self,
        dynamics: &mut Dynamics,
        dt: f64,
        external: &[Vec6],
        grabs: &[GrabTarget],
        impacts: &mut Vec<Impact>,
    ) -> Option<usize> {
        let grabs = &grabs[..grabs.len().min(MAX_GRABS)];
        let continues = dynamics.time() == self.ended;
        let restored = dynamics.position_step(dt, external, impacts, |step| self.advance(step, dt, grabs, continues));
        self.ended = dynamics.time();
        restored
    }

    fn advance(&mut self, mut step: PositionStep, dt: f64, grabs: &[GrabTarget], continues: bool) {
        self.before.copy_from_slice(step.bodies);
        self.decay_targets(&mut step, dt, continues);
        step.system.activity.set_time(step.end_time);
        self.update(&mut step, dt);
        self.report = self.adjust(&mut step, grabs);
        self.lane_kernels.derive_velocities(step.system, step.bodies, &self.before, dt);
        if self.contact_response.is_empty() {
            return;
        }
        let mut pass = SeparationPass::First;
        for _ in 0..MAX_SEPARATION_PASSES {
            if !self.contact_response.detect(step.contacts, &self.before, step.bodies, pass) {
                break;
            }
            match self.settings.method {
                PositionSolver::Relaxation => {
                    self.contact_response.separate_directly(
                        &mut self.relaxation,
                        step.system,
                        step.contacts,
                        step.bodies,
                        pass,
                    );
                }
                PositionSolver::TreeSolve => {
                    self.contact_response.separate_through_joints(step.system, step.bodies, pass)
                }
            }
            pass = SeparationPass::Repeated;
            step.system.lane_blocks_mut().load(step.bodies);
            self.report = self.adjust(&mut step, grabs);
        }
        let friction = match self.settings.method {
            PositionSolver::Relaxation => FrictionLaw::SlipRatio,
            PositionSolver::TreeSolve => FrictionLaw::Coulomb,
        };
        let response_step = ResponseStep { dt, gravity: step.gravity.length(), friction };
        let displaced =
            self.contact_response.apply_impulses(step.system, step.bodies, &self.before, response_step, step.impacts);
        self.lane_kernels.clamp_velocities(step.bodies);
        if displaced && !step.system.joints().is_empty() {
            self.report = self.adjust(&mut step, grabs);
        }
    }

    /// Sets the joints' target errors: an error at a step's start is closed over time, not in one step.
    fn decay_targets(&mut self, step: &mut PositionStep, dt: f64, continues: bool) {
        let closed = continues && !step.activation_changed && self.report.residual <= POSITION_TOLERANCE;
        if closed {
            self.tree.targets.fill(0.0);
            return;
        }
        step.system.evaluate(step.bodies);
        step.system.decay_targets(dt, step.stabilization_time, &mut self.tree.targets);
    }

    /// The update: each body as if it were free.
    fn update(&self, step: &mut PositionStep, dt: f64) {
        let Settings { method, retention, .. } = self.settings;
        self.lane_kernels.update(step, dt, retention, method == PositionSolver::TreeSolve);
        for drive in step.kinematic_bodies {
            drive.motion.at(step.end_time).place(&mut step.bodies[drive.body]);
            step.system.lane_blocks_mut().load_body(drive.body, &step.bodies[drive.body]);
        }
    }

    /// Closes the joints from the lane blocks' state.
    fn adjust(&mut self, step: &mut PositionStep, grabs: &[GrabTarget]) -> SolveReport {
        if self.settings.method == PositionSolver::Relaxation {
            return self.adjust_by_rule(step, grabs);
        }
        let report = self.tree.adjust(step, grabs, &self.lane_kernels);
        if report.converged() {
            return report;
        }
        // Newton did not converge: the step was too long for linearisation, or the targets are out of reach.
        // Relaxation closes a tree from anywhere.
        self.checkpoint.copy_from_slice(step.bodies);
        let mut last = self.relaxation.adjust(step, grabs, &self.tree.targets, None);
        let no_nearer = report.residual <= POSITION_TOLERANCE && last.grab_error >= report.grab_error;
        if last.residual > POSITION_TOLERANCE.max(report.residual) || no_nearer {
            // Not so a mechanism held in several places, or a grab out of reach.
            step.bodies.copy_from_slice(&self.checkpoint);
            last = report;
        } else if !last.converged() && last.grab_error <= RETRY_DISTANCE {
            last = self.retry(step, grabs, last, SolveReport::converged);
        }
        if last.residual > POSITION_TOLERANCE {
            // Joints take precedence over grabs.
            let before = last.residual;
            last = self.retry(step, &[], last, |report| report.residual < before);
            last.grab_error = relaxation::largest_grab_error(grabs, step.bodies);
        }
        if last.residual > POSITION_TOLERANCE {
            self.restore_start(step);
            last = self.retry(step, &[], last, |_| true);
            last.grab_error = relaxation::largest_grab_error(grabs, step.bodies);
        }
        last.passes += report.passes;
        last
    }

    /// Closes the joints by relaxation. Joints take precedence: grabs that would open them are given up.
    fn adjust_by_rule(&mut self, step: &mut PositionStep, grabs: &[GrabTarget]) -> SolveReport {
        let mut report = self.relaxation.adjust(step, grabs, &self.tree.targets, Some(self.settings.control));
        for stays in [false, true] {
            // Small errors without grabs are closed over the next steps.
            if report.residual <= POSITION_TOLERANCE || (grabs.is_empty() && report.residual <= RETRY_DISTANCE) {
                break;
            }
            if stays {
                self.restore_start(step);
                step.system.evaluate(step.bodies);
                report.residual = step.system.largest_residual(&self.tree.targets);
                report.grab_error = relaxation::largest_grab_error(grabs, step.bodies);
                if report.residual <= POSITION_TOLERANCE {
                    break;
                }
            }
            let alone = self.relaxation.adjust(step, &[], &self.tree.targets, None);
            report = SolveReport {
                passes: report.passes + alone.passes,
                grab_error: relaxation::largest_grab_error(grabs, step.bodies),
                ..alone
            };
        }
        report
    }

    /// Puts all free bodies back where the step began.
    fn restore_start(&self, step: &mut PositionStep) {
        let free = step.system.kinematic().iter().map(|kinematic| !kinematic);
        for ((body, before), free) in step.bodies.iter_mut().zip(&self.before).zip(free) {
            if free {
                *body = *before;
            }
        }
    }

    /// Retries the Newton solve from the relaxed state; back to that unless the report is `good`.
    fn retry(
        &mut self,
        step: &mut PositionStep,
        grabs: &[GrabTarget],
        passed: SolveReport,
        good: impl Fn(&SolveReport) -> bool,
    ) -> SolveReport {
        self.checkpoint.copy_from_slice(step.bodies);
        step.system.lane_blocks_mut().load(step.bodies);
        let report = self.tree.adjust(step, grabs, &self.lane_kernels);
        if good(&report) {
            return report;
        }
        step.bodies.copy_from_slice(&self.checkpoint);
        passed
    }
}

//! Position-based motion (method 3.1 to 3.6): positions are solved first. It has no stiff forces, so a body can be dragged
//! anywhere, and a step has a bounded cost.
//!
//! Each step has two stages. The **update** moves each body with the velocity of the last step, the forces, and what the joints take
//! of both,
//!
//! ```text
//! x_{k+1} = x_k + v Δt        v = P(κ v_k + a Δt)        κ ∈ [0, 1]
//! ```
//!
//! and rotates it likewise; kinematic bodies follow their motion. P projects velocities on the joints with least kinetic energy. The
//! source has no P: its bodies are free, and the adjustment also has to give them what gravity and momentum pass through the joints. Joint by
//! joint it cannot, and such an articulation gains energy or never swings. With P nothing gains energy, whatever Δt.
//!
//! The **adjustment** closes what the bodies' way, which is bent, has opened, and follows the hands, by one of two solvers:
//!
//! * [`PositionSolver::Relaxation`], the source's "compulsive motion": joint by joint outwards from a piece's anchor, with a rule for two
//!   bodies (`two_body_rule.rs`), one joint (`joint_closure.rs`), and groups along the mechanism (`walk.rs`, `relaxation.rs`). One
//!   traversal closes a piece that one anchor holds. A piece of several anchors, or beyond a limit, is left to the other solver.
//! * [`PositionSolver::TreeSolve`]: Newton's method on all joints at once, of least kinetic energy (`tree_solve.rs`). Where it does not
//!   converge, relaxation by sweeps from every anchor in turn closes a tree from anywhere.
//!
//! Then penetrating contacts are separated and impulses applied (`contact_response.rs`); resting contacts slide, roll
//! and spin (`resting_friction.rs`). Balls follow the source's slip ratio with Relaxation, Coulomb's law with
//! TreeSolve. Velocities are those of the update after the rule, else v = (x_{k+1} − x_k)/Δt. So constrained dynamics can continue from any
//! step, and vice versa.
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
    /// Bodies after the update.
    free: Vec<RigidBody>,
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
            free: bodies.clone(),
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
        let led = !grabs.is_empty();
        let restored =
            dynamics.position_step(dt, external, led, impacts, |step| self.advance(step, dt, grabs, continues));
        self.ended = dynamics.time();
        restored
    }

    fn advance(&mut self, mut step: PositionStep, dt: f64, grabs: &[GrabTarget], continues: bool) {
        self.before.copy_from_slice(step.bodies);
        self.decay_targets(&mut step, dt, continues);
        step.system.activity.set_time(step.end_time);
        self.update(&mut step, dt);
        self.project_update(&mut step, dt);
        if self.settings.method == PositionSolver::Relaxation {
            self.free.copy_from_slice(step.bodies);
        }
        self.report = match self.settings.method {
            PositionSolver::Relaxation => self.adjust_by_rule(&mut step, grabs),
            PositionSolver::TreeSolve => self.adjust(&mut step, grabs),
        };
        self.lane_kernels.derive_velocities(step.system, step.bodies, &self.before, dt);
        if self.settings.method == PositionSolver::Relaxation {
            self.keep_update_velocities(step.bodies);
        }
        if self.contact_response.is_empty() {
            return;
        }
        let mut pass = SeparationPass::First;
        for _ in 0..MAX_SEPARATION_PASSES {
            if !self.contact_response.detect(step.contacts, &self.before, step.bodies, pass) {
                break;
            }
            self.contact_response.separate_through_joints(step.system, step.bodies, pass);
            pass = SeparationPass::Repeated;
            step.system.lane_blocks_mut().load(step.bodies);
            self.report = self.adjust(&mut step, grabs);
        }
        let friction = match self.settings.method {
            PositionSolver::Relaxation => FrictionLaw::SlipRatio,
            PositionSolver::TreeSolve => FrictionLaw::Coulomb,
        };
        let response_step = ResponseStep { dt, friction };
        let displaced =
            self.contact_response.apply_impulses(step.system, step.bodies, &self.before, response_step, step.impacts);
        self.lane_kernels.clamp_velocities(step.bodies);
        if displaced && !step.system.joints().is_empty() {
            step.system.lane_blocks_mut().load(step.bodies);
            self.report = self.adjust(&mut step, grabs);
        }
    }

    /// The update of the rule: velocities are projected on the joints before they move the bodies. The projection is of least kinetic
    /// energy, so it adds none, and forces and momentum go through the joints. Only what the bodies' way bends is left to the rule.
    fn project_update(&mut self, step: &mut PositionStep, dt: f64) {
        // Positions of the step's start, velocities of its update.
        self.checkpoint.copy_from_slice(&self.before);
        for (state, body) in self.checkpoint.iter_mut().zip(step.bodies.iter()) {
            (state.velocity, state.angular_velocity) = (body.velocity, body.angular_velocity);
        }
        step.system.evaluate(&self.checkpoint);
        step.system.factor();
        step.system.include_open_rows();
        step.system.solve_velocity(&self.checkpoint);
        step.system.apply_velocity(step.bodies);
        step.system.lane_blocks_mut().load(step.bodies);
        self.lane_kernels.displace(step.system, step.bodies, dt);
    }

    /// Velocities after the rule: those of the update, but for what a hand or several anchors hold, whose speed is in its displacement.
    fn keep_update_velocities(&self, bodies: &mut [RigidBody]) {
        for body in self.relaxation.closed_by_rule() {
            bodies[body].velocity = self.free[body].velocity;
            bodies[body].angular_velocity = self.free[body].angular_velocity;
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

    /// Closes the joints after the update: by the rule those of pieces that one anchor holds, by Newton's method those of the others.
    fn adjust_by_rule(&mut self, step: &mut PositionStep, grabs: &[GrabTarget]) -> SolveReport {
        let report = self.relaxation.adjust_by_rule(step, grabs, &self.tree.targets, self.settings.control);
        if report.converged() && report.beyond <= POSITION_TOLERANCE {
            return report;
        }
        step.system.lane_blocks_mut().load(step.bodies);
        let closed = self.adjust(step, grabs);
        SolveReport { passes: report.passes + closed.passes, ..closed }
    }

    /// Closes the joints from the lane blocks' state by Newton's method.
    fn adjust(&mut self, step: &mut PositionStep, grabs: &[GrabTarget]) -> SolveReport {
        let report = self.tree.adjust(step, grabs, &self.lane_kernels);
        // A hand that is out of reach is missed. What a hand alone holds is always within reach, and what is far may be.
        let missed = report.outcome() == SolveOutcome::GrabOutOfReach
            && report.grab_error <= RETRY_DISTANCE
            && !self.relaxation.has_lone_grab(step, grabs);
        if missed || report.converged() {
            return report;
        }
        SolveReport { passes: report.passes, ..self.relax(step, grabs, report) }
    }

    /// After a Newton solve that did not converge: the step was too long for linearisation, or the targets are out of reach. Relaxation
    /// closes a tree from anywhere.
    fn relax(&mut self, step: &mut PositionStep, grabs: &[GrabTarget], report: SolveReport) -> SolveReport {
        self.checkpoint.copy_from_slice(step.bodies);
        let mut last = self.relaxation.adjust(step, grabs, &self.tree.targets);
        let no_nearer = report.residual <= POSITION_TOLERANCE && last.grab_error >= report.grab_error;
        if last.residual > POSITION_TOLERANCE.max(report.residual) || no_nearer {
            // Not so a mechanism held in several places, or a grab out of reach.
            step.bodies.copy_from_slice(&self.checkpoint);
            last = report;
        } else if !last.converged() && last.grab_error <= RETRY_DISTANCE {
            last = self.retry(step, grabs, last, SolveReport::converged);
        }
        if last.residual.max(last.beyond) > POSITION_TOLERANCE {
            // Joints take precedence over grabs, and over limits.
            let before = last;
            let nearer = |report: &SolveReport| match before.residual > POSITION_TOLERANCE {
                true => report.residual < before.residual,
                false => report.residual <= POSITION_TOLERANCE && report.beyond < before.beyond,
            };
            last = self.retry(step, &[], last, nearer);
            last.grab_error = relaxation::largest_grab_error(grabs, step.bodies);
        }
        if last.residual > POSITION_TOLERANCE {
            self.restore_start(step);
            step.system.evaluate(step.bodies);
            let start = SolveReport { residual: step.system.largest_residual(&self.tree.targets), ..last };
            last = self.retry(step, &[], start, |report| report.residual < start.residual.max(POSITION_TOLERANCE));
            last.grab_error = relaxation::largest_grab_error(grabs, step.bodies);
        }
        last
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

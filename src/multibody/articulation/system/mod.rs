//! Constraint system of an articulation: joints, their Jacobian rows, and one factor for all solves.
//!
//! Order of use: [`System::evaluate`] at a configuration, [`System::factor`], then any number of solves:
//! accelerations, displacements, velocity changes, responses to a unit impulse.

mod build;
mod couplings;
mod factor;
mod joint;
mod position_solve;
mod report;
mod rows;
mod sleep_state;
mod solve;
mod train_rows;

use fearless_simd::{Level, dispatch};

use super::Constraint;
use super::activity::Activity;
use super::lane_blocks::LaneBlocks;
use super::lane_blocks::effective_inverse_mass;
use super::trains::Trains;
use factor::Factor;
pub(super) use joint::PROJECTION_LIMIT;
pub use joint::{Joint, RowState};
use rows::{Extent, Now, Rows};
use sleep_state::SleepState;
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::row_blocks::{RowSquare, RowVec};
use soffio_math::spatial::{Vec6, add_scaled};
pub use train_rows::TrainRow;

/// Linear solver for the multipliers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LinearSolver {
    /// Articulated-body factorisation with sparse factors of loops; linear in the number of bodies for trees.
    #[default]
    Sparse,
    /// Dense Cholesky of all rows: the reference.
    Dense,
}

/// Joints, rows and factor of an articulation. Nothing here allocates after [`System::new`].
#[derive(Clone, Debug)]
pub struct System {
    /// Activation of the constraints.
    pub activity: Activity,
    rows: Rows,
    factor: Factor,
    lane_blocks: LaneBlocks,
    kinematic: Vec<bool>,
    sleep_state: SleepState,
    /// Right-hand side per body: force (N, N m) or impulse (N s, N m s); a solve overwrites it.
    pub b: Vec<Vec6>,
    /// Right-hand side per row: the wanted J a.
    pub g: Vec<f64>,
    /// Solution per body: acceleration, velocity change or displacement. For kinematic bodies it is an input.
    pub a: Vec<Vec6>,
    /// Solution per row: force or impulse. Those of ball joints stay in the tree until [`System::solve`] copies them
    /// here.
    pub lambda: Vec<f64>,
}

impl System {
    /// The system of `bodies` in their start state, joined by `constraints`; `kinematic` marks bodies with a
    /// prescribed motion.
    pub fn new(bodies: &[RigidBody], kinematic: &[bool], constraints: &[Constraint], method: LinearSolver) -> Self {
        Self::at_level(Level::new(), bodies, kinematic, constraints, method)
    }

    /// As [`Self::new`], with each gear as a row of its own instead of gear trains: position-based motion solves gears row by row.
    pub fn without_trains(
        bodies: &[RigidBody],
        kinematic: &[bool],
        constraints: &[Constraint],
        method: LinearSolver,
    ) -> Self {
        Self::with(Level::new(), bodies, kinematic, constraints, (method, Trains::default()))
    }

    /// The same for a given SIMD level; the results do not depend on it.
    pub fn at_level(
        level: Level,
        bodies: &[RigidBody],
        kinematic: &[bool],
        constraints: &[Constraint],
        method: LinearSolver,
    ) -> Self {
        let trains = match method {
            LinearSolver::Sparse => Trains::new(bodies, kinematic, constraints),
            LinearSolver::Dense => Trains::default(),
        };
        Self::with(level, bodies, kinematic, constraints, (method, trains))
    }

    /// The constraints, in the order given.
    pub fn constraints(&self) -> &[Constraint] {
        &self.rows.constraints
    }

    /// The joints, one for each connected pair of bodies.
    pub fn joints(&self) -> &[Joint] {
        &self.rows.joints
    }

    /// States of all rows.
    pub fn states(&self) -> &[RowState] {
        &self.rows.states
    }

    /// Whether each body is kinematic.
    pub fn kinematic(&self) -> &[bool] {
        &self.kinematic
    }

    /// Row of the coupling at an index, if there is one.
    pub(super) fn coupling_row(&self, index: usize) -> Option<usize> {
        self.rows.couplings.get(index).map(|coupling| coupling.at)
    }

    /// Hard rows of the last evaluation outside gear trains: joint by joint, then couplings.
    pub(super) fn rows_without_trains(&self) -> impl Iterator<Item = usize> {
        let joints = self.rows.joints.iter().filter(|joint| !joint.in_train);
        let couplings = self.rows.couplings.iter().filter(|coupling| !self.factor.trains.owns(coupling.constraint));
        joints.flat_map(|joint| joint.at..joint.at + joint.hard).chain(couplings.map(|coupling| coupling.at))
    }

    /// Effective inverse mass of a row with its bodies uncoupled from all others.
    pub(super) fn uncoupled_inverse_mass(&self, row: usize) -> f64 {
        effective_inverse_mass(&self.jacobian(row), &self.kinematic, &self.lane_blocks)
    }

    /// State of the bodies at the last evaluation, in lane blocks.
    pub fn lane_blocks(&self) -> &LaneBlocks {
        &self.lane_blocks
    }

    /// The same, mutable, to be moved before an evaluation.
    pub fn lane_blocks_mut(&mut self) -> &mut LaneBlocks {
        &mut self.lane_blocks
    }

    /// Whether any row reads the bodies themselves rather than the lane blocks.
    pub fn reads_bodies(&self) -> bool {
        !self.rows.frames.is_empty()
    }

    /// Evaluates all rows and inertias at the bodies' state and the activity's time.
    pub fn evaluate(&mut self, bodies: &[RigidBody]) {
        self.lane_blocks.load(bodies);
        self.evaluate_rows(bodies, Extent { trains: true, coupling_values: true });
        self.rows.write_values(&self.factor);
    }

    /// The same without the rows inside gear trains, for constrained dynamics.
    pub fn evaluate_without_trains(&mut self, bodies: &[RigidBody]) {
        self.lane_blocks.load(bodies);
        self.evaluate_rows(bodies, Extent { trains: false, coupling_values: true });
        self.rows.write_values(&self.factor);
    }

    /// The same at the lane blocks' state. `bodies` are read only where [`System::reads_bodies`].
    pub fn evaluate_lane_blocks(&mut self, bodies: &[RigidBody]) {
        self.evaluate_rows(bodies, Extent { trains: false, coupling_values: true });
    }

    /// The same for accelerations alone: C of couplings is not updated unless rows are being stabilised.
    pub fn evaluate_motion(&mut self, bodies: &[RigidBody]) {
        self.evaluate_rows(bodies, Extent { trains: false, coupling_values: self.rows.stabilising });
    }

    /// Evaluates rows at the lane blocks' state.
    fn evaluate_rows(&mut self, bodies: &[RigidBody], extent: Extent) {
        let Self { activity, rows, factor, lane_blocks, sleep_state, .. } = self;
        let now = Now { bodies, lane_blocks, activity, asleep: &sleep_state.bodies };
        dispatch!(lane_blocks.level(), simd => rows.evaluate(simd, now, factor, extent));
    }

    /// Excludes sleeping bodies, with all joints to them, until they wake. Rows and factor must be built again.
    pub fn let_sleep(&mut self, asleep: &[bool], bodies: &[RigidBody]) {
        self.sleep_state.set(asleep, &self.rows.constraints, &self.factor.trains);
        let mut frames = std::mem::take(&mut self.sleep_state.frames);
        self.sleep_state.gap = self.largest_length(bodies, true, &mut frames);
        self.sleep_state.frames = frames;
        self.lane_blocks.let_sleep(asleep);
        self.factor.let_sleep(asleep);
        for (body, a) in self.a.iter_mut().enumerate().filter(|(body, _)| asleep[*body]) {
            (*a, self.b[body]) = ([0.0; 6], [0.0; 6]);
        }
    }

    /// Whether a constraint is between sleeping bodies.
    pub fn constraint_sleeps(&self, constraint: usize) -> bool {
        self.sleep_state.constraints[constraint]
    }

    /// Whether any row is being closed by stabilisation.
    pub fn is_stabilising(&self) -> bool {
        self.rows.stabilising
    }

    /// Adds the soft rows of pivot friction for a time step `h` (s), with the loads (N) of the joints.
    pub fn add_friction(&mut self, bodies: &[RigidBody], loads: &[f64], h: f64) {
        let outside = self.factor.outside_mut();
        for (joint, &load) in
            self.rows.joints.iter_mut().zip(loads).filter(|(joint, _)| !self.sleep_state.bodies[joint.link.a])
        {
            joint.add_friction(&self.rows.constraints, bodies, load, h, &mut self.rows.blocks, &mut self.rows.states);
            joint.write_outside(&self.rows.blocks, outside);
        }
    }

    /// Factors the system at the configuration last evaluated.
    pub fn factor(&mut self) {
        self.factor_rows();
        if self.activity.is_partial() {
            self.soften();
            self.factor_rows();
        }
    }

    /// Factors the rows as evaluated.
    fn factor_rows(&mut self) {
        let Self { rows, factor, lane_blocks, .. } = self;
        dispatch!(lane_blocks.level(), simd => factor.make(simd, rows, lane_blocks));
    }

    /// Adds `s` times a row's transposed block to a body's right-hand side.
    pub fn push_impulse(&mut self, body: usize, block: &Vec6, s: f64) {
        add_scaled(&mut self.b[body], s, block);
    }

    /// Writes Γ = D K D among these rows of one joint or of a coupling, D diagonal.
    pub(super) fn set_compliance(&mut self, rows: &[usize], k: &RowSquare, d: &RowVec) {
        self.rows.set_compliance(self.factor.outside_mut(), rows, (k, d));
    }

    /// Whether there are gear trains.
    pub fn has_trains(&self) -> bool {
        !self.factor.trains.is_empty()
    }
}

//! The articulated figure: joints, their rows, and one factor that all solves share.
//!
//! Used in this order: [`System::evaluate`] at a configuration, [`System::factor`], then any number of solves:
//! accelerations, displacements, velocity changes, responses to a unit impulse.

mod build;
mod closing;
mod couplings;
mod factor;
mod geared;
mod joint;
mod report;
mod rows;
mod sleepers;
mod solve;

use fearless_simd::{Level, dispatch};

use super::Constraint;
use super::activity::Activity;
use super::block::{RowSquare, RowVec};
use super::quads::Quads;
use super::quads::response;
use super::trains::Trains;
use factor::Factor;
pub use geared::Geared;
pub(super) use joint::PROJECTION_REACH;
pub use joint::{Joint, RowState};
use rows::{Now, Rows};
use sleepers::Sleepers;
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{Vec6, add_scaled};

/// Which linear solver finds the multipliers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// The tree factor, linear in the number of bodies.
    #[default]
    Sparse,
    /// One dense matrix of all rows: the reference.
    Dense,
}

/// Joints, rows and factor of an articulated figure. Nothing here allocates after [`System::new`].
#[derive(Clone, Debug)]
pub struct System {
    /// What acts now.
    pub activity: Activity,
    rows: Rows,
    factor: Factor,
    quads: Quads,
    driven: Vec<bool>,
    sleepers: Sleepers,
    /// Right-hand side per body: force (N, N m) or impulse; used up by a solve.
    pub b: Vec<Vec6>,
    /// Wanted J a per row.
    pub g: Vec<f64>,
    /// Answer per body: acceleration, velocity change or displacement. Of driven bodies it is given.
    pub a: Vec<Vec6>,
    /// Answer per row: force or impulse. The tree keeps those of points by which bodies hang until [`System::solve`] copies them here.
    pub lambda: Vec<f64>,
}

impl System {
    /// The figure of `bodies` at its start, joined by `constraints`; `driven` says whose motion is given.
    pub fn new(bodies: &[RigidBody], driven: &[bool], constraints: &[Constraint], method: Method) -> Self {
        Self::at_level(Level::new(), bodies, driven, constraints, method)
    }

    /// The same without trains, for motion that turns wheels by places: row by row.
    pub fn without_trains(bodies: &[RigidBody], driven: &[bool], constraints: &[Constraint], method: Method) -> Self {
        Self::with(Level::new(), bodies, driven, constraints, (method, Trains::default()))
    }

    /// The same for a processor of this level; what it finds does not depend on it.
    pub fn at_level(
        level: Level,
        bodies: &[RigidBody],
        driven: &[bool],
        constraints: &[Constraint],
        method: Method,
    ) -> Self {
        let trains = match method {
            Method::Sparse => Trains::new(bodies, driven, constraints),
            Method::Dense => Trains::default(),
        };
        Self::with(level, bodies, driven, constraints, (method, trains))
    }

    /// The constraints, in the order given.
    pub fn constraints(&self) -> &[Constraint] {
        &self.rows.constraints
    }

    /// The joints between pairs of bodies.
    pub fn joints(&self) -> &[Joint] {
        &self.rows.joints
    }

    /// Numbers of all rows.
    pub fn states(&self) -> &[RowState] {
        &self.rows.states
    }

    /// Whose motion is given?
    pub fn driven(&self) -> &[bool] {
        &self.driven
    }

    /// The coupling's row at an index, if there is one.
    pub(super) fn coupling_row(&self, index: usize) -> Option<usize> {
        self.rows.couplings.get(index).map(|coupling| coupling.at)
    }

    /// Rows that hold at the last evaluation and are no train's: joint by joint, then couplings.
    pub(super) fn lean_rows(&self) -> impl Iterator<Item = usize> {
        let joints = self.rows.joints.iter().filter(|joint| !joint.in_train);
        let couplings = self.rows.couplings.iter().filter(|coupling| !self.factor.trains.owns(coupling.constraint));
        joints.flat_map(|joint| joint.at..joint.at + joint.hard).chain(couplings.map(|coupling| coupling.at))
    }

    /// What the bodies of a row answer to it, each alone.
    pub(super) fn response(&self, row: usize) -> f64 {
        response(&self.jacobian(row), &self.driven, &self.quads)
    }

    /// The bodies by fours, as they stood at the last evaluation.
    pub fn quads(&self) -> &Quads {
        &self.quads
    }

    /// The same, to be moved before an evaluation.
    pub fn quads_mut(&mut self) -> &mut Quads {
        &mut self.quads
    }

    /// Is there any joint that looks at the bodies themselves?
    pub fn asks_bodies(&self) -> bool {
        !self.rows.frames.is_empty()
    }

    /// Evaluates all rows and mass matrices for the bodies' state at the activity's time.
    pub fn evaluate(&mut self, bodies: &[RigidBody]) {
        self.quads.look(bodies);
        self.evaluate_rows(bodies, true, true);
        self.rows.tell_values(&self.factor);
    }

    /// The same for the laws of motion, which do not ask for what trains hold of themselves.
    pub fn evaluate_lean(&mut self, bodies: &[RigidBody]) {
        self.quads.look(bodies);
        self.evaluate_rows(bodies, false, true);
        self.rows.tell_values(&self.factor);
    }

    /// The same for bodies whose state the quads have. Only where [`System::asks_bodies`] are the bodies looked at.
    pub fn evaluate_quads(&mut self, bodies: &[RigidBody]) {
        self.evaluate_rows(bodies, false, true);
    }

    /// The same for accelerations alone: C of couplings stays what it was, unless rows are drawn together by it.
    pub fn evaluate_motion(&mut self, bodies: &[RigidBody]) {
        self.evaluate_rows(bodies, false, self.rows.gathering);
    }

    /// Evaluates rows where the quads are, with those of trains or without, and with C of couplings or without.
    fn evaluate_rows(&mut self, bodies: &[RigidBody], all: bool, values: bool) {
        let Self { activity, rows, factor, quads, sleepers, .. } = self;
        let now = Now { bodies, quads, activity, asleep: &sleepers.bodies };
        dispatch!(quads.level(), simd => rows.evaluate(simd, now, factor, (all, values)));
    }

    /// Leaves these bodies out: they stand still, with all that is joined to them, until they wake. Rows and factor are to be
    /// made anew.
    pub fn let_sleep(&mut self, asleep: &[bool], bodies: &[RigidBody]) {
        self.sleepers.set(asleep, &self.rows.constraints, &self.factor.trains);
        let mut frames = std::mem::take(&mut self.sleepers.frames);
        self.sleepers.gap = self.largest_length(bodies, true, &mut frames);
        self.sleepers.frames = frames;
        self.quads.let_sleep(asleep);
        self.factor.let_sleep(asleep);
        for (body, a) in self.a.iter_mut().enumerate().filter(|(body, _)| asleep[*body]) {
            (*a, self.b[body]) = ([0.0; 6], [0.0; 6]);
        }
    }

    /// Does what a constraint is between sleep?
    pub fn constraint_sleeps(&self, constraint: usize) -> bool {
        self.sleepers.constraints[constraint]
    }

    /// Is any row being drawn together?
    pub fn gathers(&self) -> bool {
        self.rows.gathering
    }

    /// Adds the soft rows of pivot friction for a time `h` (s), with the loads (N) that the joints carry.
    pub fn add_friction(&mut self, bodies: &[RigidBody], loads: &[f64], h: f64) {
        let outside = self.factor.outside_mut();
        for (joint, &load) in
            self.rows.joints.iter_mut().zip(loads).filter(|(joint, _)| !self.sleepers.bodies[joint.link.a])
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

    /// Factors the rows as they are.
    fn factor_rows(&mut self) {
        let Self { rows, factor, quads, .. } = self;
        dispatch!(quads.level(), simd => factor.make(simd, rows, quads));
    }

    /// Adds `s` times a row's transposed blocks to the right-hand side.
    pub fn push_impulse(&mut self, body: usize, block: &Vec6, s: f64) {
        add_scaled(&mut self.b[body], s, block);
    }

    /// Writes Γ = D K D among these rows of one joint or of a coupling, D diagonal.
    pub(super) fn set_compliance(&mut self, rows: &[usize], k: &RowSquare, d: &RowVec) {
        self.rows.set_compliance(self.factor.outside_mut(), rows, (k, d));
    }

    /// Are there trains?
    pub fn has_trains(&self) -> bool {
        !self.factor.trains.is_empty()
    }
}

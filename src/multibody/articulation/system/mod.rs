//! The articulated figure: joints, their rows, and one factor that all solves share.
//!
//! Used in this order: [`System::evaluate`] at a configuration, [`System::factor`], then any number of solves:
//! accelerations, displacements, velocity changes, responses to a unit impulse.

mod build;
mod closing;
mod couplings;
mod geared;
mod joint;
mod report;
mod solve;

use std::ops::Range;

use fearless_simd::{Level, Simd, dispatch};

use super::Constraint;
use super::activity::Activity;
use super::block::{RowSquare, RowVec};
use super::dense::Dense;
use super::hung::Hung;
use super::loops::{LoopRow, Loops};
use super::quads::Quads;
use super::quads::response;
use super::rows::Scene;
use super::rows::coupling;
use super::trains::{Asked, Trains};
use super::tree::{Form, JointRows, Tree};
use couplings::Coupling;
pub use geared::Geared;
pub use joint::{Joint, RowState};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{Vec6, add_scaled};
use soffio_math::{DMat3, DVec3};

/// Joints farther apart than this are drawn together by the stabiliser, not snapped by projection, m or rad.
pub(super) const PROJECTION_REACH: f64 = 1e-4;

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
    constraints: Vec<Constraint>,
    /// Is any row being drawn together?
    gathering: bool,
    /// What acts now.
    pub activity: Activity,
    joints: Vec<Joint>,
    /// Joints that are not always one point by which a body hangs; first those that are no train's.
    various: Vec<usize>,
    /// How many of them are no train's.
    outside_trains: usize,
    /// Numbers of all rows that are no train's.
    rows: Vec<Range<usize>>,
    trains: Trains,
    /// What is being solved for.
    asked: Asked,
    couplings: Vec<Coupling>,
    blocks: Vec<JointRows>,
    states: Vec<RowState>,
    tree: Tree,
    hung: Hung,
    /// Do the rows' numbers hold the values of the last evaluation?
    told: bool,
    /// Was it of all that is held, and not for accelerations alone?
    whole: bool,
    loops: Loops,
    dense: Option<Dense>,
    quads: Quads,
    /// Rotation matrices, where a row asks for them; the bodies that rows outside trains ask for.
    frames: Vec<DMat3>,
    framed: Vec<usize>,
    driven: Vec<bool>,
    /// Which bodies sleep, and those of them that the tree may go through all the same.
    asleep: Vec<bool>,
    still: Vec<usize>,
    /// Which constraints are between such, and the largest error of a length among them, m.
    idle: Vec<bool>,
    asleep_gap: f64,
    /// Room for that search.
    lent: Vec<DMat3>,
    /// Right-hand side per body: force (N, N m) or impulse; used up by a solve.
    pub b: Vec<Vec6>,
    /// Wanted J a per row.
    pub g: Vec<f64>,
    /// Answer per body: acceleration, velocity change or displacement. Of driven bodies it is given.
    pub a: Vec<Vec6>,
    /// Answer per row: force or impulse.
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
        &self.constraints
    }

    /// The joints between pairs of bodies.
    pub fn joints(&self) -> &[Joint] {
        &self.joints
    }

    /// Numbers of all rows.
    pub fn states(&self) -> &[RowState] {
        &self.states
    }

    /// Whose motion is given?
    pub fn driven(&self) -> &[bool] {
        &self.driven
    }

    /// The coupling's row at an index, if there is one.
    pub(super) fn coupling_row(&self, index: usize) -> Option<usize> {
        self.couplings.get(index).map(|coupling| coupling.at)
    }

    /// Rows that hold at the last evaluation and are no train's: joint by joint, then couplings.
    pub(super) fn lean_rows(&self) -> impl Iterator<Item = usize> {
        let joints = self.joints.iter().filter(|joint| !joint.in_train);
        let couplings = self.couplings.iter().filter(|coupling| !self.trains.owns(coupling.constraint));
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
        !self.frames.is_empty()
    }

    /// Evaluates all rows and mass matrices for the bodies' state at the activity's time.
    pub fn evaluate(&mut self, bodies: &[RigidBody]) {
        self.quads.look(bodies);
        self.evaluate_rows(bodies, true, true);
        self.tell_values();
    }

    /// The same for the laws of motion, which do not ask for what trains hold of themselves.
    pub fn evaluate_lean(&mut self, bodies: &[RigidBody]) {
        self.quads.look(bodies);
        self.evaluate_rows(bodies, false, true);
        self.tell_values();
    }

    /// The same for bodies whose state the quads have. Only where [`System::asks_bodies`] are the bodies looked at.
    pub fn evaluate_quads(&mut self, bodies: &[RigidBody]) {
        self.evaluate_rows(bodies, false, true);
    }

    /// The same for accelerations alone: C of couplings stays what it was, unless rows are drawn together by it.
    pub fn evaluate_motion(&mut self, bodies: &[RigidBody]) {
        self.evaluate_rows(bodies, false, self.gathering);
    }

    /// Evaluates rows where the quads are, with those of trains or without, and with C of couplings or without.
    fn evaluate_rows(&mut self, bodies: &[RigidBody], all: bool, values: bool) {
        dispatch!(self.quads.level(), simd => self.evaluate_in(simd, bodies, (all, values)));
    }

    #[inline(always)]
    fn evaluate_in<S: Simd>(&mut self, simd: S, bodies: &[RigidBody], (all, values): (bool, bool)) {
        self.trains.evaluate(&self.quads);
        self.hung.evaluate(simd, self.quads.all(), &mut self.tree);
        (self.told, self.whole) = (false, values);
        if all {
            for (body, frame) in self.frames.iter_mut().enumerate().filter(|(body, _)| !self.asleep[*body]) {
                *frame = self.quads.frame(body);
            }
        } else {
            for &body in self.framed.iter().filter(|&&body| !self.asleep[body]) {
                self.frames[body] = self.quads.frame(body);
            }
        }
        let scene = Scene { bodies, frames: &self.frames, time: self.activity.time() };
        let outside = self.dense.as_mut().map_or(&mut self.loops.rows, |dense| &mut dense.rows);
        let asked = if all { self.various.len() } else { self.outside_trains };
        for &index in &self.various[..asked] {
            let joint = &mut self.joints[index];
            if self.asleep[joint.link.a] {
                continue;
            }
            joint.evaluate(&scene, &self.constraints, &self.activity, &mut self.blocks, &mut self.states);
            joint.write_outside(&self.blocks, outside);
        }
        for coupling in &mut self.couplings {
            let share = self.activity.share(coupling.constraint);
            let slot = &mut outside[coupling.outside];
            if (slot.held && !all) || slot.sleeps(&self.asleep) {
                continue;
            }
            slot.active = share > 0.0 && !slot.held;
            slot.compliance[0] = 0.0;
            let mut row = coupling::motion(&scene, &coupling.terms, &mut slot.parts);
            row.value = if values {
                coupling::value(&scene, &coupling.terms) - coupling.offset
            } else {
                self.states[coupling.at].value
            };
            self.states[coupling.at].set(&row, coupling.constraint, share);
        }
        // Whoever draws open joints together, or lets them yield, asks how far they are open.
        if self.gathering {
            self.tell_values();
        }
    }

    /// Leaves these bodies out: they stand still, with all that is joined to them, until they wake. Rows and factor are to be
    /// made anew.
    pub fn let_sleep(&mut self, asleep: &[bool], bodies: &[RigidBody]) {
        self.asleep.copy_from_slice(asleep);
        for (idle, constraint) in self.idle.iter_mut().zip(&self.constraints) {
            *idle = (0..asleep.len()).any(|body| asleep[body] && constraint.kind.touches(body));
        }
        let mut lent = std::mem::take(&mut self.lent);
        self.asleep_gap = self.largest_length(bodies, true, &mut lent);
        self.lent = lent;
        self.quads.let_sleep(asleep);
        self.tree.let_sleep(asleep);
        self.trains.let_sleep(asleep);
        self.still.clear();
        self.still.extend((0..asleep.len()).filter(|&body| asleep[body] && !self.trains.has(body)));
        for (body, a) in self.a.iter_mut().enumerate().filter(|(body, _)| asleep[*body]) {
            (*a, self.b[body]) = ([0.0; 6], [0.0; 6]);
        }
        let outside = self.dense.as_mut().map_or(&mut self.loops.rows, |dense| &mut dense.rows);
        for row in outside.iter_mut().filter(|row| row.sleeps(asleep)) {
            row.active = false;
        }
    }

    /// Is what a joint carries known: is it awake, and no train's?
    pub fn is_weighed(&self, joint: usize) -> bool {
        let Joint { in_train, link, .. } = self.joints[joint];
        !in_train && !self.asleep[link.a]
    }

    /// Does what a constraint is between sleep?
    pub fn constraint_sleeps(&self, constraint: usize) -> bool {
        self.idle[constraint]
    }

    /// Is any row being drawn together?
    pub fn gathers(&self) -> bool {
        self.gathering
    }

    /// Adds the soft rows of pivot friction for a time `h` (s), with the loads (N) that the joints carry.
    pub fn add_friction(&mut self, bodies: &[RigidBody], loads: &[f64], h: f64) {
        let outside = self.dense.as_mut().map_or(&mut self.loops.rows, |dense| &mut dense.rows);
        for (joint, &load) in self.joints.iter_mut().zip(loads).filter(|(joint, _)| !self.asleep[joint.link.a]) {
            joint.add_friction(&self.constraints, bodies, load, h, &mut self.blocks, &mut self.states);
            joint.write_outside(&self.blocks, outside);
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
        dispatch!(self.quads.level(), simd => self.factor_in(simd));
    }

    #[inline(always)]
    fn factor_in<S: Simd>(&mut self, simd: S) {
        if let Some(dense) = &mut self.dense {
            dense.factor(&self.quads, self.gathering);
            return;
        }
        let (joints, blocks) = (&self.joints, &self.blocks);
        self.tree.factor(simd, self.quads.all(), &|index| {
            let joint = &joints[index];
            match (joint.arms, joint.block) {
                (Some((a, b)), _) => Form::Point(a, b),
                (None, Some(block)) => Form::Rows(&blocks[block]),
                (None, None) => unreachable!("a joint is a point or has a block"),
            }
        });
        self.loops.factor((&self.tree, &self.trains), &self.quads, (self.gathering, self.whole));
    }

    /// Writes Γ = D K D among these rows of one joint or of a coupling, D diagonal.
    pub(super) fn set_compliance(&mut self, rows: &[usize], k: &RowSquare, d: &RowVec) {
        let outside = self.dense.as_mut().map_or(&mut self.loops.rows, |dense| &mut dense.rows);
        if let Some(joint) = self.joints.iter().find(|joint| (joint.at..joint.at + joint.hard).contains(&rows[0])) {
            let Some(block) = joint.block else { return };
            for (i, &row) in rows.iter().enumerate() {
                for (j, &other) in rows[..=i].iter().enumerate() {
                    self.blocks[block].compliance[row - joint.at][other - joint.at] = d[i] * d[j] * k[i][j];
                }
            }
            joint.write_outside(&self.blocks, outside);
        } else if let Some(coupling) = self.couplings.iter().find(|coupling| coupling.at == rows[0]) {
            outside[coupling.outside].compliance[0] = d[0] * d[0] * k[0][0];
        }
    }

    /// World arms of a joint that is one point now.
    fn arms_of(&self, joint: &Joint) -> Option<(DVec3, DVec3)> {
        joint.hangs.map_or(joint.arms, |body| Some(self.tree.arms(body)))
    }

    /// Rows outside the tree.
    fn outside_rows(&self) -> &[LoopRow] {
        self.dense.as_ref().map_or(&self.loops.rows, |dense| &dense.rows)
    }

    /// Adds `s` times a row's transposed blocks to the right-hand side.
    pub fn push_impulse(&mut self, body: usize, block: &Vec6, s: f64) {
        add_scaled(&mut self.b[body], s, block);
    }

    /// Are there trains?
    pub fn has_trains(&self) -> bool {
        !self.trains.is_empty()
    }
}

//! Jacobian rows of joints and couplings at the last evaluation.

use std::ops::Range;

use fearless_simd::Simd;

use super::factor::Factor;
use super::joint::{Joint, PROJECTION_LIMIT, RowState};
use crate::articulation::Constraint;
use crate::articulation::activity::Activity;
use crate::articulation::lane_blocks::LaneBlocks;
use crate::articulation::loops::LoopRow;
use crate::articulation::rows::BodyStates;
use crate::articulation::rows::coupling::{self, Gauge};
use crate::articulation::tree::JointRows;
use soffio_geometry::bodies::RigidBody;
use soffio_math::DMat3;
use soffio_math::spatial::row_blocks::{RowSquare, RowVec};

/// A coupling constraint.
#[derive(Clone, Debug)]
pub(super) struct Coupling {
    /// Index of its constraint.
    pub constraint: usize,
    /// Where its number is in `g`, `lambda` and the other lists of rows.
    pub at: usize,
    /// Its coordinates, each with its coefficient.
    pub terms: Vec<(Gauge, f64)>,
    /// Value at which a clutch sticks; subtracted from the coupling's value.
    pub offset: f64,
    /// Index among the loops' rows.
    pub outside: usize,
}

/// All rows.
#[derive(Clone, Debug)]
pub(super) struct Rows {
    /// All constraints.
    pub constraints: Vec<Constraint>,
    /// All joints.
    pub joints: Vec<Joint>,
    /// Joints that are not always a tree's ball joint; first those outside gear trains.
    pub general_joints: Vec<usize>,
    /// Number of those outside gear trains.
    pub outside_trains: usize,
    /// Ranges of all rows outside gear trains.
    pub rows_without_trains: Vec<Range<usize>>,
    /// Those of these ranges that are not of ball joints.
    pub general_rows: Vec<Range<usize>>,
    /// All coupling constraints.
    pub couplings: Vec<Coupling>,
    /// Jacobian blocks of joints that are not ball joints.
    pub blocks: Vec<JointRows>,
    /// State of each row.
    pub states: Vec<RowState>,
    /// Rotation matrices of bodies, where any row reads them.
    pub frames: Vec<DMat3>,
    /// The bodies whose frames rows outside trains read.
    pub framed: Vec<usize>,
    /// Whether any row is being closed by stabilisation.
    pub stabilising: bool,
    /// Whether the states hold C of the last evaluation.
    pub values_valid: bool,
}

/// Extent of an evaluation.
#[derive(Clone, Copy)]
pub(super) struct Extent {
    /// Rows inside gear trains too.
    pub trains: bool,
    /// C of couplings too.
    pub coupling_values: bool,
}

/// A configuration at which rows are evaluated.
#[derive(Clone, Copy)]
pub(super) struct Now<'a> {
    /// All bodies.
    pub bodies: &'a [RigidBody],
    /// The same bodies by lane blocks.
    pub lane_blocks: &'a LaneBlocks,
    /// Activation of the constraints.
    pub activity: &'a Activity,
    /// Does each body sleep?
    pub asleep: &'a [bool],
}

impl Rows {
    /// Evaluates rows at the lane blocks' state.
    #[inline(always)]
    pub fn evaluate<S: Simd>(&mut self, simd: S, now: Now, factor: &mut Factor, extent: Extent) {
        let Extent { trains, coupling_values } = extent;
        let Now { bodies, lane_blocks, activity, asleep } = now;
        factor.trains.evaluate(lane_blocks);
        factor.ball_joints.evaluate(simd, lane_blocks.all(), &mut factor.tree);
        self.values_valid = false;
        if trains {
            for (body, frame) in self.frames.iter_mut().enumerate().filter(|(body, _)| !asleep[*body]) {
                *frame = lane_blocks.frame(body);
            }
        } else {
            for &body in self.framed.iter().filter(|&&body| !asleep[body]) {
                self.frames[body] = lane_blocks.frame(body);
            }
        }
        let scene = BodyStates { bodies, frames: &self.frames, time: activity.time() };
        let dense = factor.dense.is_some();
        let outside = factor.outside_mut();
        let count = if trains { self.general_joints.len() } else { self.outside_trains };
        for &index in &self.general_joints[..count] {
            let joint = &mut self.joints[index];
            if asleep[joint.link.a] {
                continue;
            }
            joint.evaluate(&scene, &self.constraints, activity, &mut self.blocks, &mut self.states);
            if dense {
                joint.write_outside(&self.blocks, outside);
            }
        }
        for coupling in &mut self.couplings {
            let activation = activity.activation(coupling.constraint);
            let row_outside = &mut outside[coupling.outside];
            if (row_outside.train_internal && !trains) || row_outside.sleeps(asleep) {
                continue;
            }
            row_outside.active = activation > 0.0 && !row_outside.train_internal;
            row_outside.compliance[0] = 0.0;
            let mut row = coupling::motion(&scene, &coupling.terms, &mut row_outside.parts);
            row.value = if coupling_values {
                coupling::value(&scene, &coupling.terms) - coupling.offset
            } else {
                self.states[coupling.at].value
            };
            self.states[coupling.at].set(&row, coupling.constraint, activation);
        }
        // Stabilisation and softening read C.
        if self.stabilising {
            self.write_values(factor);
        }
    }

    /// Writes C of the ball joints into their states, if it is not there yet.
    pub fn write_values(&mut self, factor: &Factor) {
        if !self.values_valid {
            factor.ball_joints.write_values(&factor.tree, &mut self.states);
            self.values_valid = true;
        }
    }

    /// Marks the rows that stabilisation closes: those far from closed, and partially active ones.
    pub fn classify_rows(&mut self, factor: &Factor) {
        let any_open = factor.ball_joints.largest(&factor.tree) > PROJECTION_LIMIT;
        if any_open || self.stabilising {
            self.write_values(factor);
        }
        let rows = if any_open || self.stabilising { &self.rows_without_trains } else { &self.general_rows };
        self.stabilising = false;
        for rows in rows {
            for state in &mut self.states[rows.clone()] {
                state.stabilised = state.value.abs() > PROJECTION_LIMIT || state.activation < 1.0;
                self.stabilising |= state.stabilised;
            }
        }
    }

    /// Ranges of the rows whose right-hand side is in `g`.
    pub fn right_hand_rows(&self) -> &[Range<usize>] {
        if self.stabilising { &self.rows_without_trains } else { &self.general_rows }
    }

    /// Writes Γ = D K D among these rows of one joint or of a coupling, D diagonal.
    pub fn set_compliance(&mut self, outside: &mut [LoopRow], rows: &[usize], (k, d): (&RowSquare, &RowVec)) {
        if let Some(joint) = self.joints.iter().find(|joint| (joint.at..joint.at + joint.hard).contains(&rows[0])) {
            let Some(block) = joint.block else { return };
            self.blocks[block].soft = true;
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
}

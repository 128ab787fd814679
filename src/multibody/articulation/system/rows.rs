//! The rows of a figure's joints and couplings, as they are at the configuration last evaluated.

use std::ops::Range;

use fearless_simd::Simd;

use super::factor::Factor;
use super::joint::{Joint, PROJECTION_REACH, RowState};
use crate::articulation::Constraint;
use crate::articulation::activity::Activity;
use crate::articulation::block::{RowSquare, RowVec};
use crate::articulation::loops::LoopRow;
use crate::articulation::quads::Quads;
use crate::articulation::rows::Scene;
use crate::articulation::rows::coupling::{self, Gauge};
use crate::articulation::tree::JointRows;
use soffio_geometry::bodies::RigidBody;
use soffio_math::DMat3;

/// A constraint that couples turns and ways.
#[derive(Clone, Debug)]
pub(super) struct Coupling {
    pub constraint: usize,
    pub at: usize,
    pub terms: Vec<(Gauge, f64)>,
    /// Subtracted from the value: where a clutch holds.
    pub offset: f64,
    /// Index among the loops' rows.
    pub outside: usize,
}

/// All rows.
#[derive(Clone, Debug)]
pub(super) struct Rows {
    pub constraints: Vec<Constraint>,
    pub joints: Vec<Joint>,
    /// Joints that are not always one point by which a body hangs; first those that are no train's.
    pub various: Vec<usize>,
    /// How many of them are no train's.
    pub outside_trains: usize,
    /// Numbers of all rows that are no train's; of those of them that are not of points by which bodies hang.
    pub lean: Vec<Range<usize>>,
    pub aside: Vec<Range<usize>>,
    pub couplings: Vec<Coupling>,
    pub blocks: Vec<JointRows>,
    pub states: Vec<RowState>,
    /// Rotation matrices, where a row asks for them; the bodies that rows outside trains ask for.
    pub frames: Vec<DMat3>,
    pub framed: Vec<usize>,
    /// Is any row being drawn together?
    pub gathering: bool,
    /// Do the rows' numbers hold the values of the last evaluation?
    pub told: bool,
}

/// A configuration at which rows are evaluated.
#[derive(Clone, Copy)]
pub(super) struct Now<'a> {
    pub bodies: &'a [RigidBody],
    pub quads: &'a Quads,
    pub activity: &'a Activity,
    pub asleep: &'a [bool],
}

impl Rows {
    /// Evaluates rows where the quads are: `all`, or without those of trains; with C of couplings (`values`) or without.
    #[inline(always)]
    pub fn evaluate<S: Simd>(&mut self, simd: S, now: Now, factor: &mut Factor, (all, values): (bool, bool)) {
        let Now { bodies, quads, activity, asleep } = now;
        factor.trains.evaluate(quads);
        factor.hung.evaluate(simd, quads.all(), &mut factor.tree);
        self.told = false;
        if all {
            for (body, frame) in self.frames.iter_mut().enumerate().filter(|(body, _)| !asleep[*body]) {
                *frame = quads.frame(body);
            }
        } else {
            for &body in self.framed.iter().filter(|&&body| !asleep[body]) {
                self.frames[body] = quads.frame(body);
            }
        }
        let scene = Scene { bodies, frames: &self.frames, time: activity.time() };
        let dense = factor.dense.is_some();
        let outside = factor.outside_mut();
        let asked = if all { self.various.len() } else { self.outside_trains };
        for &index in &self.various[..asked] {
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
            let share = activity.share(coupling.constraint);
            let slot = &mut outside[coupling.outside];
            if (slot.held && !all) || slot.sleeps(asleep) {
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
            self.tell_values(factor);
        }
    }

    /// C of the point joints into their rows' numbers, if it is not there yet.
    pub fn tell_values(&mut self, factor: &Factor) {
        if !self.told {
            factor.hung.tell_values(&factor.tree, &mut self.states);
            self.told = true;
        }
    }

    /// Notes which rows are drawn together by the stabiliser: those far from closed, and those of a share below 1.
    pub fn look_for_gaps(&mut self, factor: &Factor) {
        let reach = factor.hung.largest(&factor.tree) > PROJECTION_REACH;
        if reach || self.gathering {
            self.tell_values(factor);
        }
        let rows = if reach || self.gathering { &self.lean } else { &self.aside };
        self.gathering = false;
        for rows in rows {
            for state in &mut self.states[rows.clone()] {
                state.gathers = state.value.abs() > PROJECTION_REACH || state.share < 1.0;
                self.gathering |= state.gathers;
            }
        }
    }

    /// Numbers of the rows that are asked by `g`.
    pub fn asked(&self) -> &[Range<usize>] {
        if self.gathering { &self.lean } else { &self.aside }
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

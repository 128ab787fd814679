//! Factor of all rows: the tree, the loops outside it, the gear trains.

use fearless_simd::Simd;

use super::rows::Rows;
use crate::articulation::ball_elimination::JointTarget;
use crate::articulation::ball_joints::BallJoints;
use crate::articulation::dense::Dense;
use crate::articulation::lane_blocks::LaneBlocks;
use crate::articulation::loops::{LoopInputs, LoopRow, Loops};
use crate::articulation::trains::{SolveKind, Trains};
use crate::articulation::tree::{Form, Tree};
use soffio_math::spatial::Vec6;

/// Factor of the system.
#[derive(Clone, Debug)]
pub(super) struct Factor {
    /// Articulated-body factor of the kinematic tree.
    pub tree: Tree,
    /// Ball joints of the tree.
    pub ball_joints: BallJoints,
    /// Rows that close loops, and their factor.
    pub loops: Loops,
    /// Factor of the dense solver, where it is chosen.
    pub dense: Option<Dense>,
    /// Gear trains.
    pub trains: Trains,
    /// Kind of the next solve.
    pub solve_kind: SolveKind,
}

impl Factor {
    /// Rows outside the tree.
    pub fn outside(&self) -> &[LoopRow] {
        self.dense.as_ref().map_or(&self.loops.rows, |dense| &dense.rows)
    }

    /// Rows outside the tree, mutable.
    #[inline(always)]
    pub fn outside_mut(&mut self) -> &mut [LoopRow] {
        self.dense.as_mut().map_or(&mut self.loops.rows, |dense| &mut dense.rows)
    }

    /// Excludes rows of sleeping bodies.
    pub fn let_sleep(&mut self, asleep: &[bool]) {
        self.tree.let_sleep(asleep);
        self.trains.let_sleep(asleep);
        for row in self.outside_mut().iter_mut().filter(|row| row.sleeps(asleep)) {
            row.active = false;
        }
    }

    /// Factors the rows as evaluated.
    #[inline(always)]
    pub fn make<S: Simd>(&mut self, simd: S, rows: &Rows, lane_blocks: &LaneBlocks) {
        if let Some(dense) = &mut self.dense {
            dense.factor(lane_blocks, rows.stabilising);
            return;
        }
        let (joints, blocks) = (&rows.joints, &rows.blocks);
        let form = |index: usize| {
            let joint = &joints[index];
            match (joint.arms, joint.block) {
                (Some((a, b)), _) => Form::Point(a, b),
                (None, Some(block)) => Form::Rows(&blocks[block]),
                (None, None) => unreachable!("a joint is a point or has a block"),
            }
        };
        self.loops.begin();
        let inputs = LoopInputs { blocks, trains: &self.trains, stabilising: rows.stabilising };
        self.tree.factor(simd, lane_blocks.all(), &form, &mut self.loops, inputs);
    }

    /// Solves for `a` and `lambda` from `b` and `g` at a SIMD level. `wanted` is the target of ball joints, whose
    /// multipliers stay in the tree.
    #[inline(always)]
    pub fn solve<S: Simd>(
        &mut self,
        simd: S,
        lane_blocks: &LaneBlocks,
        (b, g, wanted): (&mut [Vec6], &[f64], JointTarget),
        (a, lambda): (&mut [Vec6], &mut [f64]),
    ) {
        if let Some(dense) = &mut self.dense {
            dense.solve(b, g, a, lambda);
            return;
        }
        self.trains.solve(self.solve_kind, lane_blocks, b, a);
        self.loops.begin_solve();
        self.tree.sweep_inward(simd, &mut self.loops, (b, g, a), (wanted, lambda));
        self.tree.sweep_outward(simd, &mut self.loops, (b, wanted), (lambda, a));
        self.trains.push(self.loops.pushes(), a);
    }
}

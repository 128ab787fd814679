//! The factor of a figure's rows, and what is solved by it: the tree, the rows outside it, the trains.

use fearless_simd::Simd;

use super::rows::Rows;
use crate::articulation::ball::Wanted;
use crate::articulation::dense::Dense;
use crate::articulation::hung::Hung;
use crate::articulation::loops::{LoopRow, Loops};
use crate::articulation::quads::Quads;
use crate::articulation::trains::{Asked, Trains};
use crate::articulation::tree::{Form, Tree};
use soffio_math::spatial::Vec6;

/// Everything that a solve goes through.
#[derive(Clone, Debug)]
pub(super) struct Factor {
    pub tree: Tree,
    pub hung: Hung,
    pub loops: Loops,
    pub dense: Option<Dense>,
    pub trains: Trains,
    /// What is being solved for.
    pub asked: Asked,
}

impl Factor {
    /// Rows outside the tree.
    pub fn outside(&self) -> &[LoopRow] {
        self.dense.as_ref().map_or(&self.loops.rows, |dense| &dense.rows)
    }

    /// The same, to be written.
    #[inline(always)]
    pub fn outside_mut(&mut self) -> &mut [LoopRow] {
        self.dense.as_mut().map_or(&mut self.loops.rows, |dense| &mut dense.rows)
    }

    /// Leaves out what is joined to bodies that sleep.
    pub fn let_sleep(&mut self, asleep: &[bool]) {
        self.tree.let_sleep(asleep);
        self.trains.let_sleep(asleep);
        for row in self.outside_mut().iter_mut().filter(|row| row.sleeps(asleep)) {
            row.active = false;
        }
    }

    /// Factors rows as they are.
    #[inline(always)]
    pub fn make<S: Simd>(&mut self, simd: S, rows: &Rows, quads: &Quads) {
        if let Some(dense) = &mut self.dense {
            dense.factor(quads, rows.gathering);
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
        let of_loops = (&blocks[..], &self.trains, rows.gathering);
        self.tree.factor(simd, quads.all(), &form, &mut self.loops, of_loops);
    }

    /// Solves for `a` and `lambda` from `b` and `g`, by the best instructions there are. `wanted` stands for the `g` of points by
    /// which bodies hang; what these carry is in the tree.
    #[inline(always)]
    pub fn solve<S: Simd>(
        &mut self,
        simd: S,
        quads: &Quads,
        (b, g, wanted): (&mut [Vec6], &[f64], Wanted),
        (a, lambda): (&mut [Vec6], &mut [f64]),
    ) {
        if let Some(dense) = &mut self.dense {
            dense.solve(b, g, a, lambda);
            return;
        }
        self.trains.solve(self.asked, quads, b, a);
        self.loops.begin_solve();
        self.tree.sweep_up(simd, &mut self.loops, (b, g, a), (wanted, lambda));
        self.tree.sweep_down(simd, &mut self.loops, (b, wanted), (lambda, a));
        self.trains.push(self.loops.pushes(), a);
    }
}

//! Sweeps of the articulated-body factorisation (`tree.rs`): inward (leaves to roots) and outward.
//!
//! The bodies of a lane block are eliminated together. Their loads are added to the parents one by one, the last
//! first, so that sums do not depend on how bodies are grouped.

use fearless_simd::Simd;

use super::ball_elimination::{Arms, BallElimination, JointTarget};
use super::lane_blocks::{BodyLane, LaneBlock};
use super::loops::{LoopInputs, Loops};
use super::topology::EliminationStep;
use super::tree::{Form, Tree};
use soffio_math::DVec3;
use soffio_math::for_rows;
use soffio_math::lanes::{All, Lanes, One};
use soffio_math::spatial::Articulated;
use soffio_math::spatial::SpatialVector;
use soffio_math::spatial::row_blocks::MAX_ROWS;
use soffio_math::spatial::{Vec6, add_scaled, dot, inverse, mul};

impl Tree {
    /// Factors the matrix of the equations of motion by articulated-body inertias, from the leaves to the roots
    /// (Featherstone). `lane_blocks` have the bodies' masses and inertias, `form` the kind of each joint by its index, and
    /// `loops` the rows that close loops, eliminated last with `inputs`. Solutions use the factor until the next call.
    #[inline(always)]
    pub fn factor<'a, S: Simd>(
        &mut self,
        simd: S,
        lane_blocks: &[LaneBlock],
        form: &impl Fn(usize) -> Form<'a>,
        loops: &mut Loops,
        inputs: LoopInputs,
    ) {
        for &index in &self.initial_blocks {
            let (block_bodies, lane_block, lanes) = (&self.block_bodies[index], &lane_blocks[index], All(simd));
            let alone = Articulated::alone(lanes.get(&lane_block.mass), lane_block.inertia.get(lanes));
            lanes.scatter(block_bodies.count, &alone.numbers(), |lane, mass| {
                self.articulated[block_bodies.bodies[lane]] = *mass;
            });
        }
        for index in (0..self.awake.len()).rev() {
            match self.awake[index] {
                EliminationStep::LaneBlock(lane_block) if self.parents[lane_block].leaves => {
                    let LaneBlock { mass, inertia, .. } = &lane_blocks[lane_block];
                    let alone = Articulated::alone(All(simd).get(mass), inertia.get(All(simd)));
                    self.factor_balls(All(simd), lane_block, &alone);
                }
                EliminationStep::LaneBlock(lane_block) => {
                    let mass = self.articulated(All(simd), lane_block);
                    self.factor_balls(All(simd), lane_block, &mass);
                }
                EliminationStep::Point(BodyLane { lane_block, lane }) => {
                    let mass = self.articulated(One(lane), lane_block);
                    self.factor_balls(One(lane), lane_block, &mass);
                }
                EliminationStep::Body(body) => self.factor_one(body, form),
                EliminationStep::Loops(component) => loops.factor(component, &mut self.articulated, inputs),
            }
        }
    }

    /// Articulated inertias of a block's bodies.
    #[inline(always)]
    fn articulated<L: Lanes>(&self, lanes: L, lane_block: usize) -> Articulated<L::T> {
        let block_bodies = &self.block_bodies[lane_block];
        Articulated::of_numbers(&lanes.rows(|k| &self.articulated[block_bodies.bodies[k]]))
    }

    /// Eliminates a block's ball-joint bodies with these articulated inertias; their arms are set.
    #[inline(always)]
    fn factor_balls<L: Lanes>(&mut self, lanes: L, lane_block: usize, mass: &Articulated<L::T>) {
        let (block_bodies, parents) = (&self.block_bodies[lane_block], &self.parents[lane_block].parents);
        let ball_joint = BallElimination::factor(self.ball_eliminations[lane_block].arms.get(lanes), mass);
        self.ball_eliminations[lane_block].put_factor(lanes, &ball_joint);
        let articulated = &mut self.articulated;
        lanes.scatter(
            block_bodies.count,
            &ball_joint.load().numbers(),
            #[inline(always)]
            |lane, load| add(&mut articulated[parents[lane]], load),
        );
    }

    #[inline(always)]
    fn factor_one<'a>(&mut self, body: usize, form: &impl Fn(usize) -> Form<'a>) {
        let BodyLane { lane_block, lane } = self.body_lanes[body];
        let node = &mut self.nodes[body];
        let Some(general) = self.general[body].as_mut().filter(|_| !self.kinematic[body]) else { return };
        let shape = node.joint.map(form);
        if let Some(Form::Point(a, b)) = shape {
            node.ball_joint = true;
            let (own, parent) = if node.first { (a, b) } else { (b, a) };
            self.ball_eliminations[lane_block].arms.put(One(lane), &Arms { own: own.into(), parent: parent.into() });
            let mass = self.articulated(One(lane), lane_block);
            return self.factor_balls(One(lane), lane_block, &mass);
        }
        node.ball_joint = false;
        general.rows = 0;
        let mass = Articulated::of_numbers(&self.articulated[body]);
        general.inverse = if node.leaf { mass.inverse_alone() } else { inverse(&mass.matrix()) };
        let Some(Form::Rows(rows)) = shape else { return };
        general.eliminate(rows, node.first, node.parent.is_some());
        if let Some(parent) = node.parent {
            for k in 0..general.rows {
                let load = Articulated::outer(&general.jp[k], &general.x[k]);
                add(&mut self.articulated[parent], &load.numbers());
            }
        }
    }

    /// Inward sweep: h of the joints into `lambda`, loads on the parents into `b`. `a` holds the given accelerations,
    /// `wanted` is the target of the ball joints.
    #[inline(always)]
    pub fn sweep_inward<S: Simd>(
        &mut self,
        simd: S,
        loops: &mut Loops,
        (b, g, a): (&mut [Vec6], &[f64], &[Vec6]),
        (wanted, lambda): (JointTarget, &mut [f64]),
    ) {
        for index in (0..self.awake.len()).rev() {
            match self.awake[index] {
                EliminationStep::LaneBlock(lane_block) => self.inward_ball_joints(All(simd), lane_block, b, wanted),
                EliminationStep::Point(BodyLane { lane_block, lane }) => {
                    self.inward_ball_joints(One(lane), lane_block, b, wanted)
                }
                EliminationStep::Body(body) => self.inward(body, b, Some(g), lambda),
                EliminationStep::Loops(component) => loops.inward(component, b, g, a),
            }
        }
    }

    /// Outward sweep: accelerations and the final `lambda`, except those of ball joints.
    #[inline(always)]
    pub fn sweep_outward<S: Simd>(
        &mut self,
        simd: S,
        loops: &mut Loops,
        (b, wanted): (&[Vec6], JointTarget),
        (lambda, a): (&mut [f64], &mut [Vec6]),
    ) {
        for index in 0..self.awake.len() {
            match self.awake[index] {
                EliminationStep::LaneBlock(lane_block) => self.outward_ball_joints(All(simd), lane_block, wanted, a),
                EliminationStep::Point(BodyLane { lane_block, lane }) => {
                    self.outward_ball_joints(One(lane), lane_block, wanted, a)
                }
                EliminationStep::Body(body) => self.outward(body, b, JointTarget::Given, lambda, a),
                EliminationStep::Loops(component) => loops.outward(component, b, lambda, a),
            }
        }
    }

    #[inline(always)]
    fn inward_ball_joints<L: Lanes>(&mut self, lanes: L, lane_block: usize, b: &mut [Vec6], wanted: JointTarget) {
        let (block_bodies, parents, points) =
            (&self.block_bodies[lane_block], &self.parents[lane_block], &mut self.points[lane_block]);
        let ball_joint = self.ball_eliminations[lane_block].get(lanes);
        let (torque, w) = ball_joint
            .inward(SpatialVector::gather(lanes, |k| &b[block_bodies.bodies[k]]), points.wanted(lanes, wanted));
        points.torque.put(lanes, torque);
        points.force.put(lanes, w);
        lanes.scatter(
            block_bodies.count,
            &ball_joint.wrench(w).numbers(),
            #[inline(always)]
            |lane, push| {
                if let Some(b) = b.get_mut(parents.parents[lane]) {
                    add(b, push);
                }
            },
        );
    }

    #[inline(always)]
    fn outward_ball_joints<L: Lanes>(&mut self, lanes: L, lane_block: usize, wanted: JointTarget, a: &mut [Vec6]) {
        const WORLD: Vec6 = [0.0; 6];
        let (block_bodies, parents, points) =
            (&self.block_bodies[lane_block], &self.parents[lane_block], &mut self.points[lane_block]);
        let ball_joint = self.ball_eliminations[lane_block].get(lanes);
        let parent = |k: usize| a.get(parents.parents[k]).unwrap_or(&WORLD);
        let carried = SpatialVector::gather(lanes, parent);
        let inward = (points.torque.get(lanes), points.force.get(lanes));
        let (acceleration, lambda) = ball_joint.outward(points.wanted(lanes, wanted), inward, carried);
        points.force.put(lanes, lambda);
        lanes.scatter(
            block_bodies.count,
            &acceleration.numbers(),
            #[inline(always)]
            |lane, own| a[block_bodies.bodies[lane]] = *own,
        );
    }

    /// Inward step of one body. Without `g`, g is 0.
    #[inline(always)]
    pub fn inward(&mut self, body: usize, b: &mut [Vec6], g: Option<&[f64]>, lambda: &mut [f64]) {
        let node = &self.nodes[body];
        if node.ball_joint {
            let BodyLane { lane_block, lane } = self.body_lanes[body];
            let Some(g) = g else { return self.inward_ball_joints(One(lane), lane_block, b, JointTarget::Zero) };
            let g = DVec3::from_slice(&g[node.at..]) * node.sign();
            self.points[lane_block].wanted.put(One(lane), g.into());
            return self.inward_ball_joints(One(lane), lane_block, b, JointTarget::Given);
        }
        let Some(f) = self.general[body].as_ref().filter(|_| !self.kinematic[body]) else { return };
        let (lambda, push) = (&mut lambda[node.at..node.at + f.rows], b[body]);
        let g = g.map(|g| &g[node.at..node.at + f.rows]);
        let mut ends = node.parent.map(|parent| &mut b[parent]);
        for_rows!(f.rows, rows => {
            let mut wanted = [0.0; MAX_ROWS];
            for k in 0..rows {
                wanted[k] = g.map_or(0.0, |g| g[k]) - dot(&f.w[k], &push);
            }
            for k in 0..rows {
                let h = (0..rows).fold(0.0, |sum, l| sum + f.k[k][l] * wanted[l]);
                lambda[k] = h;
                if let Some(parent) = &mut ends {
                    add_scaled(parent, h, &f.jp[k]);
                }
            }
        });
    }

    /// Outward step of one body, after its parent. For a ball joint, `wanted` must be that of the inward step.
    #[inline(always)]
    pub fn outward(&mut self, body: usize, b: &[Vec6], wanted: JointTarget, lambda: &mut [f64], a: &mut [Vec6]) {
        if self.nodes[body].ball_joint {
            let BodyLane { lane_block, lane } = self.body_lanes[body];
            self.outward_ball_joints(One(lane), lane_block, wanted, a);
            let force: DVec3 = self.points[lane_block].force.get(One(lane)).into();
            let node = &self.nodes[body];
            (force * node.sign()).write_to_slice(&mut lambda[node.at..]);
            return;
        }
        let node = &self.nodes[body];
        let Some(f) = self.general[body].as_ref().filter(|_| !self.kinematic[body]) else { return };
        let mut out = mul(&f.inverse, &b[body]);
        let lambda = &mut lambda[node.at..node.at + f.rows];
        let carried = node.parent.map(|parent| &a[parent]);
        for_rows!(f.rows, rows => {
            for k in 0..rows {
                if let Some(carried) = carried {
                    lambda[k] -= dot(&f.x[k], carried);
                }
                add_scaled(&mut out, lambda[k], &f.w[k]);
            }
        });
        a[body] = out;
    }
}

/// x += y.
#[inline(always)]
fn add<const N: usize>(x: &mut [f64; N], y: &[f64; N]) {
    for k in 0..N {
        x[k] += y[k];
    }
}

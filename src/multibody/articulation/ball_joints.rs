//! Kinematics of ball joints, four at a time: position error C and acceleration bias J̇ẋ.
//!
//! The formulas of `rows/point.rs`, seen from the child: with its parent's s and ω_p,
//!
//! ```text
//! C = (x + r) − (x_p + s)        J̇ẋ = ω×(ω×r) − ω_p×(ω_p×s)
//! ```
//!
//! The world is a parent like any other: at the origin, at rest.

use fearless_simd::{Simd, dispatch};

use super::ball_elimination::{Arms, BallJointBlock};
use super::lane_blocks::{BodyLane, LaneBlock, LaneGather};
use super::system::RowState;
use super::tree::Tree;
use soffio_math::DVec3;
use soffio_math::lanes::{All, Four, Lanes, One, V3, WIDTH};

/// Ball joints of all lane blocks.
#[derive(Clone, Debug)]
pub struct BallJoints {
    ends: Vec<Ends>,
}

/// Joint points of one lane block from the centres of mass, body axes, m; the world's from its origin.
#[derive(Clone, Copy, Debug, Default)]
struct Ends {
    own: V3<Four>,
    parent: V3<Four>,
    /// Whether each lane's body is on a ball joint, and the joint's index.
    is_ball_joint: [bool; WIDTH],
    joints: [usize; WIDTH],
    /// 1 for ball-joint lanes, 0 for others.
    counts: Four,
}

/// Ball joint of one lane.
struct OnePoint<'a> {
    /// Where its numbers begin in `g` and `lambda`.
    at: usize,
    /// 1 where the child is the joint's first body, −1 where it is the second.
    sign: f64,
    lane: usize,
    points: &'a BallJointBlock,
}

impl OnePoint<'_> {
    /// A vector of the block as the joint's rows define it.
    #[inline(always)]
    fn seen(&self, of: &V3<Four>) -> [f64; 3] {
        [&of.x, &of.y, &of.z].map(|part| part.0[self.lane] * self.sign)
    }
}

impl BallJoints {
    /// Ball joints of a tree. `points` gives, for a body always on a ball joint, the joint's index and its points on
    /// the body and on the parent.
    pub fn new(tree: &Tree, points: impl Fn(usize) -> Option<(usize, (DVec3, DVec3))>) -> Self {
        let mut ends = vec![Ends::default(); tree.block_bodies().len()];
        for &body in tree.order() {
            let BodyLane { lane_block, lane } = tree.body_lane(body);
            let Some((joint, (own, parent))) = points(body) else { continue };
            let lanes = One(lane);
            ends[lane_block].own.put(lanes, own.into());
            ends[lane_block].parent.put(lanes, parent.into());
            (ends[lane_block].is_ball_joint[lane], ends[lane_block].joints[lane], ends[lane_block].counts.0[lane]) =
                (true, joint, 1.0);
        }
        Self { ends }
    }

    /// Writes C into the rows' states.
    pub fn write_values(&self, tree: &Tree, states: &mut [RowState]) {
        self.each(tree, |joint| {
            for (state, value) in states[joint.at..].iter_mut().zip(joint.seen(&joint.points.value)) {
                state.value = value;
            }
        });
    }

    /// Writes J̇ẋ into the rows' states.
    pub fn write_biases(&self, tree: &Tree, states: &mut [RowState]) {
        self.each(tree, |joint| {
            for (state, bias) in states[joint.at..].iter_mut().zip(joint.seen(&joint.points.bias)) {
                state.bias = bias;
            }
        });
    }

    /// Writes Ċ into `g`, after [`BallJoints::target_zero_rate`].
    pub fn write_rates(&self, tree: &Tree, g: &mut [f64]) {
        self.each(tree, |joint| {
            let rates = joint.seen(&joint.points.wanted).map(|wanted| -wanted);
            g[joint.at..joint.at + 3].copy_from_slice(&rates);
        });
    }

    /// Writes the multipliers into `lambda`.
    pub fn write_forces(&self, tree: &Tree, lambda: &mut [f64]) {
        self.each(tree, |joint| lambda[joint.at..joint.at + 3].copy_from_slice(&joint.seen(&joint.points.force)));
    }

    /// Sets the targets from the right-hand side `g`.
    pub fn set_targets(&self, tree: &mut Tree, g: &[f64]) {
        for ((ends, parents), points) in self.ends.iter().zip(&tree.parents).zip(&mut tree.points) {
            for lane in (0..WIDTH).filter(|&lane| ends.is_ball_joint[lane]) {
                let g = DVec3::from_slice(&g[parents.at[lane]..]) * parents.signs.0[lane];
                points.wanted.put(One(lane), g.into());
            }
        }
    }

    /// Largest |C| of any ball joint, m.
    pub fn largest(&self, tree: &Tree) -> f64 {
        let mut largest = [0.0; WIDTH];
        for BallJointBlock { value, .. } in &tree.points {
            for part in [&value.x, &value.y, &value.z] {
                for (largest, value) in largest.iter_mut().zip(part.0) {
                    let size = value.abs();
                    *largest = if size > *largest { size } else { *largest };
                }
            }
        }
        largest.into_iter().fold(0.0, f64::max)
    }

    /// Writes the force of the ball joints of awake bodies into `loads`, N.
    pub fn record_joint_loads(&self, tree: &Tree, asleep: &[bool], loads: &mut [f64]) {
        for ((ends, block_bodies), BallJointBlock { force, .. }) in
            self.ends.iter().zip(&tree.block_bodies).zip(&tree.points)
        {
            let (x, y, z) = (&force.x.0, &force.y.0, &force.z.0);
            let all: [f64; WIDTH] = std::array::from_fn(|k| (x[k] * x[k] + y[k] * y[k] + z[k] * z[k]).sqrt());
            for lane in (0..WIDTH).filter(|&lane| ends.is_ball_joint[lane] && !asleep[block_bodies.bodies[lane]]) {
                loads[ends.joints[lane]] = all[lane];
            }
        }
    }

    /// Marks the joints as closed, C = 0, except the rows that are stabilised.
    pub fn close(&self, tree: &mut Tree, stabilising: Option<&[RowState]>) {
        let Some(states) = stabilising else {
            tree.points.iter_mut().for_each(|points| points.value = V3::default());
            return;
        };
        for ((ends, parents), BallJointBlock { value, .. }) in self.ends.iter().zip(&tree.parents).zip(&mut tree.points)
        {
            for lane in (0..WIDTH).filter(|&lane| ends.is_ball_joint[lane]) {
                let rows = states[parents.at[lane]..].iter().zip([&mut value.x, &mut value.y, &mut value.z]);
                rows.filter(|(state, _)| !state.stabilised).for_each(|(_, value)| value.0[lane] = 0.0);
            }
        }
    }

    /// Visits all ball joints.
    #[inline(always)]
    fn each<'a>(&self, tree: &'a Tree, mut joint: impl FnMut(OnePoint<'a>)) {
        for ((ends, parents), points) in self.ends.iter().zip(&tree.parents).zip(&tree.points) {
            for lane in (0..WIDTH).filter(|&lane| ends.is_ball_joint[lane]) {
                joint(OnePoint { at: parents.at[lane], sign: parents.signs.0[lane], lane, points });
            }
        }
    }

    /// Arms (into the tree), C and J̇ẋ at the bodies' present state.
    #[inline(always)]
    pub fn evaluate<S: Simd>(&self, simd: S, lane_blocks: &[LaneBlock], tree: &mut Tree) {
        let lanes = All(simd);
        for (lane_block, ends) in self.ends.iter().enumerate() {
            if ends.is_ball_joint == [false; WIDTH] {
                continue;
            }
            let parents = &tree.parents[lane_block];
            let (own, parent) = (&lane_blocks[lane_block], LaneGather::new(lane_blocks, &parents.body_lanes));
            let r = own.frame.get(lanes).mul(ends.own.get(lanes));
            let frame = parent.matrix(lanes, |lane_block| &lane_block.frame);
            let s = frame.mul(ends.parent.get(lanes));
            tree.ball_eliminations[lane_block].arms.put(lanes, &Arms { own: r, parent: s });
            let value =
                own.state.position.get(lanes) + r - (parent.vector(lanes, |lane_block| &lane_block.state.position) + s);
            let (spin, other) = (own.state.spin.get(lanes), parent.vector(lanes, |lane_block| &lane_block.state.spin));
            let bias = spin.cross(spin.cross(r)) - other.cross(other.cross(s));
            let points = &mut tree.points[lane_block];
            points.value.put(lanes, value * lanes.get(&ends.counts));
            points.bias.put(lanes, bias);
        }
    }

    /// Sets the required velocity change that stops the drift of the joint points: g = −Ċ.
    pub fn target_zero_rate(&self, lane_blocks: &[LaneBlock], tree: &mut Tree) {
        dispatch!(tree.level, simd => self.target_zero_rate_in(simd, lane_blocks, tree));
    }

    #[inline(always)]
    fn target_zero_rate_in<S: Simd>(&self, simd: S, lane_blocks: &[LaneBlock], tree: &mut Tree) {
        let lanes = All(simd);
        for (lane_block, ends) in self.ends.iter().enumerate() {
            if ends.is_ball_joint == [false; WIDTH] {
                continue;
            }
            let (own, parent) =
                (&lane_blocks[lane_block].state, LaneGather::new(lane_blocks, &tree.parents[lane_block].body_lanes));
            let arms = tree.ball_eliminations[lane_block].arms.get(lanes);
            let own = own.velocity.get(lanes) + own.spin.get(lanes).cross(arms.own);
            let spin = parent.vector(lanes, |lane_block| &lane_block.state.spin);
            let rate = own - (parent.vector(lanes, |lane_block| &lane_block.state.velocity) + spin.cross(arms.parent));
            tree.points[lane_block].wanted.put(lanes, -rate);
        }
    }
}

//! Articulated-body factorisation (Baraff 1996; equivalent to Featherstone's articulated-body algorithm): linear-time
//! solution of the constrained equations of motion.
//!
//! # The equations
//!
//! With M the block-diagonal mass matrix, J the rows of all joints, Γ ≥ 0 a diagonal compliance (zero for a hard
//! row), b the impulses or forces and g the wanted J a:
//!
//! ```text
//! M a − Jᵀ λ = b
//! J a + Γ λ  = g
//! ```
//!
//! # The elimination (D. Baraff, Linear-time dynamics using Lagrange multipliers, SIGGRAPH 1996)
//!
//! Bodies are eliminated leaves first; a tree has no fill-in. Let c be a body whose children are gone, A its
//! articulated mass block, p its parent, J_c and J_p the joint's blocks. From a_c = A⁻¹ (b_c + J_cᵀ λ):
//!
//! ```text
//! K = J_c A⁻¹ J_cᵀ + Γ         W = A⁻¹ J_cᵀ         h = K⁻¹ (g − Wᵀ b_c)
//! λ = h − X a_p                X = K⁻¹ J_p           A_p += J_pᵀ X        b_p += J_pᵀ h
//! ```
//!
//! (the load on the parent is J_pᵀ λ = J_pᵀ h − J_pᵀ X a_p). Then, roots first, a_c = A⁻¹ b_c + W λ. The factor
//! depends on poses and masses only, so one factor serves accelerations, position and velocity projection, friction
//! and impacts. A body on a ball joint uses `ball_elimination.rs`, the same elimination in 3×3 blocks; ball-joint
//! bodies of one depth are independent and are processed four at a time (`tree_sweeps.rs`).
//!
//! The acceleration of a kinematic body is given: it is ground that moves. Γ need not be diagonal within a joint
//! (`partial_rows.rs`).
//!
//! Invariant: `Tree::new` fixes the order and all sizes; `factor` and `solve` never allocate.

use fearless_simd::Level;

use super::DisjointSets;
use super::ball_elimination::{BallElimination, BallJointBlock};
use super::lane_blocks::{BlockBodies, BodyLane};
use super::loops::biconnected::{Component, Graph};
use super::topology::{
    EliminationStep, Link, ParentReferences, TreeNode, build_nodes, parent_references, schedule_elimination,
};
use soffio_math::DVec3;
use soffio_math::for_rows;
use soffio_math::lanes::{Four, One};
use soffio_math::spatial::NUMBERS;
use soffio_math::spatial::row_blocks::{MAX_ROWS, RowBlock, RowSquare, pseudo_inverse};
use soffio_math::spatial::{Mat6, add_scaled, dot, mul};

/// Rows of one joint at one configuration, for the general elimination.
#[derive(Clone, Debug)]
pub struct JointRows {
    /// Number of used rows, at most [`MAX_ROWS`].
    pub rows: usize,
    /// J on the first body, one six-vector per row.
    pub a: RowBlock,
    /// J on the second body; unused where that is the world.
    pub b: RowBlock,
    /// Γ, lower triangle; 0 is hard.
    pub compliance: RowSquare,
    /// Whether any entry of Γ is not 0.
    pub soft: bool,
}

impl Default for JointRows {
    fn default() -> Self {
        let (blocks, hard) = ([[0.0; 6]; MAX_ROWS], [[0.0; MAX_ROWS]; MAX_ROWS]);
        Self { rows: 0, a: blocks, b: blocks, compliance: hard, soft: false }
    }
}

/// A joint's present form in the elimination.
#[derive(Clone, Copy, Debug)]
pub enum Form<'a> {
    /// A hard ball joint: arms from the centres of mass of the first and the second body, world axes, m.
    Point(DVec3, DVec3),
    /// Any other rows.
    Rows(&'a JointRows),
}

/// Factor of a body on a joint of any kind, in the symbols of the module's head; `k` holds K⁻¹.
#[derive(Clone, Debug)]
pub(super) struct General {
    /// Number of used rows.
    pub rows: usize,
    /// Inverse of the articulated-body inertia.
    pub inverse: Mat6,
    /// J on the parent, one six-vector per row.
    pub jp: RowBlock,
    /// W, one six-vector per row.
    pub w: RowBlock,
    /// K⁻¹.
    pub k: RowSquare,
    /// X, one six-vector per row.
    pub x: RowBlock,
    /// Rows that depend on others, as bits.
    pub redundant: u32,
}

/// Elimination order and factor of the kinematic tree.
#[derive(Clone, Debug)]
pub struct Tree {
    pub(super) level: Level,
    /// All bodies, roots first.
    order: Vec<usize>,
    /// Elimination steps, roots first, without kinematic bodies; and those of them with an awake body. Reversed, this
    /// is the elimination order.
    pub(super) steps: Vec<EliminationStep>,
    pub(super) awake: Vec<EliminationStep>,
    /// Lane blocks whose articulated inertias are initialised: of the eliminated bodies and of their parents.
    pub(super) initial_blocks: Vec<usize>,
    /// Scratch for finding them: a flag for each lane block and for the world's.
    needed: Vec<bool>,
    pub(super) nodes: Vec<TreeNode>,
    pub(super) kinematic: Vec<bool>,
    /// Whether each joint is an edge of the tree; and the components with loops.
    bridges: Vec<bool>,
    pub(super) components: Vec<Component>,
    pub(super) block_bodies: Vec<BlockBodies>,
    pub(super) body_lanes: Vec<BodyLane>,
    pub(super) parents: Vec<ParentReferences>,
    /// Articulated inertias by bodies; the last one collects the load on the world and is never read.
    pub(super) articulated: Vec<[f64; NUMBERS]>,
    /// By lane blocks.
    pub(super) ball_eliminations: Vec<BallElimination<Four>>,
    pub(super) points: Vec<BallJointBlock>,
    /// Per body; `None` where the body is always on a ball joint or in a loop.
    pub(super) general: Vec<Option<Box<General>>>,
}

impl Tree {
    /// Elimination order of the bodies of a graph joined by `links`: breadth first from the ground (the world and the
    /// kinematic bodies), then from the first body of each floating piece. `at` is where each joint's numbers begin,
    /// `points` whether it is always a ball joint, `components` are those of the graph. `level` is the SIMD level;
    /// bodies of one group are placed side by side where possible.
    pub(super) fn new(
        level: Level,
        graph: &Graph,
        links: &[Link],
        (at, points): (&[usize], &[bool]),
        components: Vec<Component>,
        groups: &DisjointSets,
    ) -> Self {
        let bodies = graph.kinematic.len();
        // For the tree, a gear train is ground that moves.
        let kinematic: Vec<bool> =
            (0..bodies).map(|body| graph.kinematic[body] || graph.train[body].is_some()).collect();
        let (of_tree, components): (Vec<_>, Vec<_>) =
            components.into_iter().partition(|component| component.is_bridge(links.len()));
        let mut bridges = vec![false; links.len()];
        of_tree.iter().for_each(|component| bridges[component.ties[0]] = true);
        let (nodes, mut order) = build_nodes(&kinematic, links, (at, points), (&bridges, &components));
        // Sleeping lane blocks are skipped, so a block should hold few groups; sums do not depend on it.
        order.sort_by_key(|&body| (nodes[body].depth, groups.first(body)));
        let (steps, block_bodies) = schedule_elimination(&order, &nodes, &kinematic, &components);
        let (body_lanes, parents) = parent_references(&nodes, &block_bodies);
        let mut tree = Self {
            level,
            initial_blocks: Vec::with_capacity(block_bodies.len()),
            needed: vec![false; block_bodies.len() + 1],
            general: nodes
                .iter()
                .map(|node| (!node.ball_joint && node.component.is_none()).then(Box::default))
                .collect(),
            awake: steps.clone(),
            steps,
            parents,
            body_lanes,
            articulated: vec![[0.0; NUMBERS]; bodies + 1],
            ball_eliminations: vec![BallElimination::default(); block_bodies.len()],
            points: vec![BallJointBlock::default(); block_bodies.len()],
            block_bodies,
            order,
            nodes,
            kinematic,
            bridges,
            components,
        };
        tree.find_initial_blocks();
        tree
    }

    /// Skips the steps whose bodies are all asleep.
    pub fn let_sleep(&mut self, asleep: &[bool]) {
        let Self { steps, awake, block_bodies, components, .. } = self;
        let of = |body_lane: &BodyLane| asleep[block_bodies[body_lane.lane_block].bodies[body_lane.lane]];
        let asleep_step = |step: &EliminationStep| match step {
            EliminationStep::LaneBlock(lane_block) => block_bodies[*lane_block].all().iter().all(|&body| asleep[body]),
            EliminationStep::Point(body_lane) => of(body_lane),
            EliminationStep::Body(body) => asleep[*body],
            EliminationStep::Loops(component) => {
                components[*component].bodies.first().is_some_and(|&body| asleep[body])
            }
        };
        awake.clear();
        awake.extend(steps.iter().filter(|step| !asleep_step(step)));
        self.find_initial_blocks();
    }

    fn find_initial_blocks(&mut self) {
        let Self { awake, block_bodies, body_lanes, parents, components, initial_blocks, needed, .. } = self;
        needed.fill(false);
        let mut needs = |body_lane: BodyLane, itself: bool| {
            needed[body_lane.lane_block] |= itself;
            needed[parents[body_lane.lane_block].body_lanes[body_lane.lane].lane_block] = true;
        };
        for step in awake.iter() {
            match *step {
                // A leaf has no children's inertia to collect.
                EliminationStep::LaneBlock(lane_block) => {
                    (0..block_bodies[lane_block].count)
                        .for_each(|lane| needs(BodyLane { lane_block, lane }, !parents[lane_block].leaves));
                }
                EliminationStep::Point(body_lane) => needs(body_lane, true),
                EliminationStep::Body(body) => needs(body_lanes[body], true),
                EliminationStep::Loops(index) => {
                    let Component { bodies, top, .. } = &components[index];
                    bodies.iter().chain(top).for_each(|&body| needs(body_lanes[body], true));
                }
            }
        }
        initial_blocks.clear();
        initial_blocks.extend((0..block_bodies.len()).filter(|&lane_block| needed[lane_block]));
    }

    /// Bodies of each lane block.
    pub fn block_bodies(&self) -> &[BlockBodies] {
        &self.block_bodies
    }

    /// Whether a joint is an edge of the tree; otherwise it is in a loop, or between bodies that cannot move.
    pub fn is_bridge(&self, link: usize) -> bool {
        self.bridges[link]
    }

    /// Whether a body has children.
    pub fn has_children(&self, body: usize) -> bool {
        !self.nodes[body].leaf
    }

    /// Redundant rows of a body's joint at the last factorisation, as a bit set: their multipliers are 0.
    pub fn redundant(&self, body: usize) -> u32 {
        self.general[body].as_ref().filter(|_| !self.nodes[body].ball_joint).map_or(0, |f| f.redundant)
    }

    /// Joint to the parent; `None` for a floating root and in loops.
    pub fn joint_of(&self, body: usize) -> Option<usize> {
        self.nodes[body].joint
    }

    /// Lane of a body.
    pub fn body_lane(&self, body: usize) -> BodyLane {
        self.body_lanes[body]
    }

    /// Arms of a body's ball joint, from the centres of mass of the joint's first and second body, world axes, m.
    pub fn arms(&self, body: usize) -> (DVec3, DVec3) {
        let BodyLane { lane_block, lane } = self.body_lanes[body];
        let arms = self.ball_eliminations[lane_block].arms.get(One(lane));
        let (own, parent) = (arms.own.into(), arms.parent.into());
        if self.nodes[body].first { (own, parent) } else { (parent, own) }
    }

    /// Force of a body's ball joint on the body in the last solve, N.
    pub fn force(&self, body: usize) -> DVec3 {
        let BodyLane { lane_block, lane } = self.body_lanes[body];
        self.points[lane_block].force.get(One(lane)).into()
    }

    /// Bodies on the paths from these to their roots, roots first, into `paths`; `on` is scratch, a flag a body.
    /// Paths do not continue through loops.
    pub fn paths_into(&self, from: impl Iterator<Item = usize>, on: &mut [bool], paths: &mut Vec<usize>) {
        on.fill(false);
        for mut body in from {
            while !on[body] {
                on[body] = true;
                match self.nodes[body].parent {
                    Some(parent) => body = parent,
                    None => break,
                }
            }
        }
        paths.clear();
        paths.extend(self.order.iter().copied().filter(|&body| on[body]));
    }

    /// All bodies, roots first.
    pub fn order(&self) -> &[usize] {
        &self.order
    }
}

impl JointRows {
    /// Sets Γ to 0.
    #[inline(always)]
    pub fn harden(&mut self) {
        if std::mem::take(&mut self.soft) {
            self.compliance = [[0.0; MAX_ROWS]; MAX_ROWS];
        }
    }
}

impl Default for General {
    fn default() -> Self {
        Self {
            rows: 0,
            inverse: [[0.0; 6]; 6],
            jp: [[0.0; 6]; MAX_ROWS],
            w: [[0.0; 6]; MAX_ROWS],
            k: [[0.0; MAX_ROWS]; MAX_ROWS],
            x: [[0.0; 6]; MAX_ROWS],
            redundant: 0,
        }
    }
}

impl General {
    /// Eliminates a body by its joint's rows. `first`: it is the joint's first body. J_p and X are computed only
    /// where `has_parent`.
    #[inline(always)]
    pub fn eliminate(&mut self, r: &JointRows, first: bool, has_parent: bool) {
        let (jc, jp) = if first { (&r.a, &r.b) } else { (&r.b, &r.a) };
        self.rows = r.rows.min(MAX_ROWS);
        for_rows!(self.rows, rows => {
            for k in 0..rows {
                self.w[k] = mul(&self.inverse, &jc[k]);
                for l in 0..=k {
                    self.k[k][l] = dot(&jc[k], &self.w[l]) + r.compliance[k][l];
                }
            }
            self.redundant = pseudo_inverse(&mut self.k, rows);
            for k in 0..if has_parent { rows } else { 0 } {
                (self.jp[k], self.x[k]) = (jp[k], [0.0; 6]);
                for l in 0..rows {
                    add_scaled(&mut self.x[k], self.k[k][l], &jp[l]);
                }
            }
        });
    }
}

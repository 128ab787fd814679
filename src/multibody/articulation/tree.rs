//! The tree factor: linear-time solution of the constrained equations of motion.
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
//! (the parent feels J_pᵀ λ = J_pᵀ h − J_pᵀ X a_p). Then, roots first, a_c = A⁻¹ b_c + W λ. The factor
//! depends on poses and masses only, so one factor serves accelerations, position and velocity projection, friction
//! and impacts. A body that hangs by one point only goes through `ball.rs`, the same elimination in 3×3 blocks; those of
//! one depth do not wait for each other and go four at a time (`sweeps.rs`).
//!
//! A driven body's a is given: it is ground that moves. Γ need not be diagonal within a joint: `share.rs` says why.
//!
//! Invariant: the order and all sizes are fixed by `Tree::new`; `factor` and `solve` never allocate.

use fearless_simd::Level;

use super::Groups;
use super::ball::{Ball, Points};
use super::block::{MAX_ROWS, RowBlock, RowSquare, for_rows, pseudo_inverse};
use super::hang::{Hang, Hooks, Link, Step, by_quads, hangs, hooks};
use super::loops::graph::{Component, Graph};
use super::quads::{Members, Slot};
use soffio_math::DVec3;
use soffio_math::lanes::{Four, One};
use soffio_math::spatial::NUMBERS;
use soffio_math::spatial::{Mat6, add_scaled, dot, mul};

/// Rows of one joint at one configuration, for the general elimination.
#[derive(Clone, Debug)]
pub struct JointRows {
    /// Used rows, at most [`MAX_ROWS`].
    pub rows: usize,
    /// Blocks that multiply the coordinates of the first body.
    pub a: RowBlock,
    /// Blocks that multiply the coordinates of the second body; unused where it is the world.
    pub b: RowBlock,
    /// Γ, lower triangle; 0 is hard.
    pub compliance: RowSquare,
    /// Is any of it not 0?
    pub soft: bool,
}

impl Default for JointRows {
    fn default() -> Self {
        let (blocks, hard) = ([[0.0; 6]; MAX_ROWS], [[0.0; MAX_ROWS]; MAX_ROWS]);
        Self { rows: 0, a: blocks, b: blocks, compliance: hard, soft: false }
    }
}

/// A joint as the tree needs it now.
#[derive(Clone, Copy, Debug)]
pub enum Form<'a> {
    /// One point, hard: arms from the first and the second body's centre, world axes, m.
    Point(DVec3, DVec3),
    /// Any rows.
    Rows(&'a JointRows),
}

/// What is kept of a body's general elimination, in the letters of the file's head; `k` holds K⁻¹.
#[derive(Clone, Debug)]
pub(super) struct General {
    pub rows: usize,
    pub inverse: Mat6,
    pub jp: RowBlock,
    pub w: RowBlock,
    pub k: RowSquare,
    pub x: RowBlock,
    pub redundant: u32,
}

/// Elimination order and factor of an articulated figure.
#[derive(Clone, Debug)]
pub struct Tree {
    pub(super) level: Level,
    /// Roots first.
    order: Vec<usize>,
    /// The same by quads, without what is driven; reversed it is the elimination order. Then those of them whose bodies are awake.
    pub(super) steps: Vec<Step>,
    pub(super) awake: Vec<Step>,
    /// Quads that the factor begins with: those of whom is eliminated, and of what these hang on.
    pub(super) begun: Vec<usize>,
    /// Room to find them: a flag a quad, and one for the world's.
    needed: Vec<bool>,
    pub(super) hang: Vec<Hang>,
    pub(super) driven: Vec<bool>,
    /// Which links are the tree's, and what else there is.
    bridges: Vec<bool>,
    pub(super) components: Vec<Component>,
    pub(super) members: Vec<Members>,
    pub(super) slots: Vec<Slot>,
    pub(super) hooks: Vec<Hooks>,
    /// Articulated masses by bodies, and what hangs on the world, which does not move for it.
    pub(super) articulated: Vec<[f64; NUMBERS]>,
    /// By quads.
    pub(super) balls: Vec<Ball<Four>>,
    pub(super) points: Vec<Points>,
    /// Per body, where its joint is ever anything but a point.
    pub(super) general: Vec<Option<Box<General>>>,
}

impl Tree {
    /// The elimination order of the bodies of a graph joined by `links`: breadth first from the ground (the world and what is
    /// driven), then each piece that floats from its first body. `at` is where each link's numbers begin, `points`
    /// whether it is never anything but a point. `components` are those of the graph.
    /// `level` says which instructions there are, `groups` which bodies stand beside each other where they may.
    pub(super) fn new(
        level: Level,
        graph: &Graph,
        links: &[Link],
        (at, points): (&[usize], &[bool]),
        components: Vec<Component>,
        groups: &Groups,
    ) -> Self {
        let bodies = graph.driven.len();
        // To the tree a train is ground that moves.
        let driven: Vec<bool> = (0..bodies).map(|body| graph.driven[body] || graph.train[body].is_some()).collect();
        let (of_tree, components): (Vec<_>, Vec<_>) =
            components.into_iter().partition(|component| component.is_bridge(links.len()));
        let mut bridges = vec![false; links.len()];
        of_tree.iter().for_each(|component| bridges[component.ties[0]] = true);
        let (hang, mut order) = hangs(&driven, links, (at, points), (&bridges, &components));
        // What sleeps is left out quad by quad, so groups share as few as they can; sums come out the same.
        order.sort_by_key(|&body| (hang[body].depth, groups.first(body)));
        let (steps, members) = by_quads(&order, &hang, &driven, &components);
        let (slots, hooks) = hooks(&hang, &members);
        let mut tree = Self {
            level,
            begun: Vec::with_capacity(members.len()),
            needed: vec![false; members.len() + 1],
            general: hang.iter().map(|hang| (!hang.ball && hang.component.is_none()).then(Box::default)).collect(),
            awake: steps.clone(),
            steps,
            hooks,
            slots,
            articulated: vec![[0.0; NUMBERS]; bodies + 1],
            balls: vec![Ball::default(); members.len()],
            points: vec![Points::default(); members.len()],
            members,
            order,
            hang,
            driven,
            bridges,
            components,
        };
        tree.look_who_begins();
        tree
    }

    /// Leaves out the steps whose bodies all sleep.
    pub fn let_sleep(&mut self, asleep: &[bool]) {
        let Self { steps, awake, members, components, .. } = self;
        let of = |slot: &Slot| asleep[members[slot.quad].bodies[slot.lane]];
        let idle = |step: &Step| match step {
            Step::Quad(quad) => members[*quad].all().iter().all(|&body| asleep[body]),
            Step::Point(slot) => of(slot),
            Step::Body(body) => asleep[*body],
            Step::Loops(component) => components[*component].bodies.first().is_some_and(|&body| asleep[body]),
        };
        awake.clear();
        awake.extend(steps.iter().filter(|step| !idle(step)));
        self.look_who_begins();
    }

    fn look_who_begins(&mut self) {
        let Self { awake, members, slots, hooks, components, begun, needed, .. } = self;
        needed.fill(false);
        let mut needs = |slot: Slot, itself: bool| {
            needed[slot.quad] |= itself;
            needed[hooks[slot.quad].slots[slot.lane].quad] = true;
        };
        for step in awake.iter() {
            match *step {
                // Leaves carry themselves alone.
                Step::Quad(quad) => {
                    (0..members[quad].count).for_each(|lane| needs(Slot { quad, lane }, !hooks[quad].leaves));
                }
                Step::Point(slot) => needs(slot, true),
                Step::Body(body) => needs(slots[body], true),
                Step::Loops(index) => {
                    let Component { bodies, top, .. } = &components[index];
                    bodies.iter().chain(top).for_each(|&body| needs(slots[body], true));
                }
            }
        }
        begun.clear();
        begun.extend((0..members.len()).filter(|&quad| needed[quad]));
    }

    /// Who stands beside whom.
    pub fn members(&self) -> &[Members] {
        &self.members
    }

    /// Is a link one of the tree? Else it is in a loop, or joins nothing that gives way.
    pub fn is_bridge(&self, link: usize) -> bool {
        self.bridges[link]
    }

    /// Does anything hang on a body?
    pub fn carries(&self, body: usize) -> bool {
        !self.hang[body].leaf
    }

    /// Rows of a body's joint that repeat others at the last factorisation, as a bit set: they carry no multiplier.
    pub fn redundant(&self, body: usize) -> u32 {
        self.general[body].as_ref().filter(|_| !self.hang[body].ball).map_or(0, |f| f.redundant)
    }

    /// Joint by which a body hangs.
    pub fn joint_of(&self, body: usize) -> Option<usize> {
        self.hang[body].joint
    }

    /// Where a body's numbers are.
    pub fn slot(&self, body: usize) -> Slot {
        self.slots[body]
    }

    /// Where the point is by which a body hangs: arms from the centres of its joint's first and second body, world
    /// axes, m.
    pub fn arms(&self, body: usize) -> (DVec3, DVec3) {
        let Slot { quad, lane } = self.slots[body];
        let arms = self.balls[quad].arms.get(One(lane));
        let (own, parent) = (arms.own.into(), arms.parent.into());
        if self.hang[body].first { (own, parent) } else { (parent, own) }
    }

    /// What the point by which a body hangs carries by the last solve, as seen from the body, N.
    pub fn force(&self, body: usize) -> DVec3 {
        let Slot { quad, lane } = self.slots[body];
        self.points[quad].force.get(One(lane)).into()
    }

    /// Bodies on the ways from these to their roots, roots first, into `ways`; `on` lends a flag a body. In loops there are no ways.
    pub fn paths_into(&self, from: impl Iterator<Item = usize>, on: &mut [bool], ways: &mut Vec<usize>) {
        on.fill(false);
        for mut body in from {
            while !on[body] {
                on[body] = true;
                match self.hang[body].parent {
                    Some(parent) => body = parent,
                    None => break,
                }
            }
        }
        ways.clear();
        ways.extend(self.order.iter().copied().filter(|&body| on[body]));
    }

    /// All bodies, roots first.
    pub fn order(&self) -> &[usize] {
        &self.order
    }
}

impl JointRows {
    /// Lets no row be soft.
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
    /// Eliminates a body by these rows; J_p and X only where there is a parent to carry them.
    #[inline(always)]
    pub fn eliminate(&mut self, r: &JointRows, first: bool, hangs: bool) {
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
            for k in 0..if hangs { rows } else { 0 } {
                (self.jp[k], self.x[k]) = (jp[k], [0.0; 6]);
                for l in 0..rows {
                    add_scaled(&mut self.x[k], self.k[k][l], &jp[l]);
                }
            }
        });
    }
}

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
//! and impacts. A body that hangs by one point only goes through `ball.rs`, the same elimination in 3×3 blocks.
//!
//! A driven body's a is given: it is ground that moves. Γ need not be diagonal within a joint: `share.rs` says why.
//!
//! Invariant: the order and all sizes are fixed by [`Tree::new`]; `factor` and `solve` never allocate.

use super::ball::Ball;
use super::block::{MAX_ROWS, Mat6, RowBlock, RowSquare, Vec6, add_scaled, dot, inverse, mul, pseudo_inverse};
use super::spatial::{Articulated, Sym3};
use crate::math::DVec3;

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
}

impl Default for JointRows {
    fn default() -> Self {
        Self { rows: 0, a: [[0.0; 6]; MAX_ROWS], b: [[0.0; 6]; MAX_ROWS], compliance: [[0.0; MAX_ROWS]; MAX_ROWS] }
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

/// Which bodies a joint connects: the first is always a body, the second may be the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link {
    /// First body.
    pub a: usize,
    /// Second body; `None` is the world.
    pub b: Option<usize>,
}

/// How a body hangs in the tree.
#[derive(Clone, Copy, Debug)]
struct Hang {
    /// Parent body; `None`: the world, or nothing.
    parent: Option<usize>,
    /// Joint to the parent; `None` for the root of a piece that is not joined to the ground.
    joint: Option<usize>,
    /// Where the joint's numbers begin in `g` and `lambda`.
    at: usize,
    /// Is this body the joint's first one?
    first: bool,
    /// Was the joint a point at the last factorisation?
    ball: bool,
}

/// What is kept of a body's general elimination, in the letters of the file's head; `k` holds K⁻¹.
#[derive(Clone, Debug)]
struct General {
    rows: usize,
    inverse: Mat6,
    jp: RowBlock,
    w: RowBlock,
    k: RowSquare,
    x: RowBlock,
    redundant: u32,
}

/// Elimination order and factor of an articulated figure.
#[derive(Clone, Debug)]
pub struct Tree {
    /// Roots first; reversed it is the elimination order.
    order: Vec<usize>,
    hang: Vec<Hang>,
    driven: Vec<bool>,
    loops: Vec<usize>,
    articulated: Vec<Articulated>,
    balls: Vec<Ball>,
    /// Per body, where its joint is ever anything but a point.
    general: Vec<Option<Box<General>>>,
}

impl Tree {
    /// The elimination order of bodies joined by `links`: breadth first from the ground (the world and what is
    /// driven), then each piece that floats from its first body. `at` is where each link's numbers begin, `points`
    /// whether it is never anything but a point. Links that would close a loop are left out, see [`Tree::loops`].
    pub fn new(driven: &[bool], links: &[Link], at: &[usize], points: &[bool]) -> Self {
        let bodies = driven.len();
        let mut beside: Vec<Vec<usize>> = vec![Vec::new(); bodies];
        for (joint, link) in links.iter().enumerate() {
            beside[link.a].push(joint);
            if let Some(b) = link.b {
                beside[b].push(joint);
            }
        }
        let root = |joint| Hang { parent: None, joint, at: joint.map_or(0, |j| at[j]), first: true, ball: false };
        let mut hang: Vec<Option<Hang>> = vec![None; bodies];
        let mut in_tree = vec![false; links.len()];
        let mut order = Vec::with_capacity(bodies);
        for body in (0..bodies).filter(|&body| driven[body]) {
            hang[body] = Some(root(None));
            order.push(body);
        }
        for (joint, link) in links.iter().enumerate() {
            if link.b.is_none() && hang[link.a].is_none() {
                hang[link.a] = Some(root(Some(joint)));
                in_tree[joint] = true;
                order.push(link.a);
            }
        }
        let mut head = 0;
        for piece in 0..=bodies {
            while head < order.len() {
                let parent = order[head];
                head += 1;
                for &joint in &beside[parent] {
                    let link = links[joint];
                    let child = if link.a == parent { link.b } else { Some(link.a) };
                    let Some(child) = child.filter(|&child| hang[child].is_none()) else { continue };
                    let first = link.a == child;
                    hang[child] =
                        Some(Hang { parent: Some(parent), joint: Some(joint), at: at[joint], first, ball: false });
                    in_tree[joint] = true;
                    order.push(child);
                }
            }
            if piece < bodies && hang[piece].is_none() {
                hang[piece] = Some(root(None));
                order.push(piece);
            }
        }
        let hang: Vec<Hang> = hang.into_iter().flatten().collect();
        let blank = || {
            Box::new(General {
                rows: 0,
                inverse: [[0.0; 6]; 6],
                jp: [[0.0; 6]; MAX_ROWS],
                w: [[0.0; 6]; MAX_ROWS],
                k: [[0.0; MAX_ROWS]; MAX_ROWS],
                x: [[0.0; 6]; MAX_ROWS],
                redundant: 0,
            })
        };
        let always_point = |hang: &Hang| hang.joint.is_some_and(|joint| points[joint]);
        Self {
            general: hang.iter().map(|hang| (!always_point(hang)).then(blank)).collect(),
            order,
            hang,
            driven: driven.to_vec(),
            loops: (0..links.len()).filter(|&joint| !in_tree[joint]).collect(),
            articulated: vec![Articulated::ZERO; bodies],
            balls: vec![Ball::default(); bodies],
        }
    }

    /// Links that close a loop and so are not in the tree.
    pub fn loops(&self) -> &[usize] {
        &self.loops
    }

    /// Rows of a body's joint that repeat others at the last factorisation, as a bit set: they carry no multiplier.
    pub fn redundant(&self, body: usize) -> u32 {
        self.general[body].as_ref().filter(|_| !self.hang[body].ball).map_or(0, |f| f.redundant)
    }

    /// Joint by which a body hangs.
    pub fn joint_of(&self, body: usize) -> Option<usize> {
        self.hang[body].joint
    }

    /// Bodies on the ways from these to their roots, roots first.
    pub fn paths(&self, from: impl Iterator<Item = usize>) -> Vec<usize> {
        let mut on = vec![false; self.hang.len()];
        for mut body in from {
            while !on[body] {
                on[body] = true;
                match self.hang[body].parent {
                    Some(parent) => body = parent,
                    None => break,
                }
            }
        }
        self.order.iter().copied().filter(|&body| on[body]).collect()
    }

    /// Factors the system for these masses, world inertias and the joints' present forms.
    pub fn factor<'a>(&mut self, masses: &[f64], inertias: &[Sym3], form: impl Fn(usize) -> Form<'a>) {
        for ((articulated, &mass), inertia) in self.articulated.iter_mut().zip(masses).zip(inertias) {
            *articulated = Articulated::alone(mass, inertia);
        }
        for index in (0..self.order.len()).rev() {
            let body = self.order[index];
            if self.driven[body] {
                continue;
            }
            let hang = &mut self.hang[body];
            let shape = hang.joint.map(&form);
            if let Some(Form::Point(a, b)) = shape {
                hang.ball = true;
                let ball = &mut self.balls[body];
                (ball.arm, ball.parent_arm) = if hang.first { (a, b) } else { (b, a) };
                ball.factor(&self.articulated[body]);
                if let Some(parent) = hang.parent {
                    self.balls[body].load(&mut self.articulated[parent]);
                }
                continue;
            }
            hang.ball = false;
            let (first, parent) = (hang.first, hang.parent);
            let Some(f) = &mut self.general[body] else { continue };
            f.rows = 0;
            f.inverse = inverse(&self.articulated[body].matrix());
            let Some(Form::Rows(rows)) = shape else { continue };
            f.eliminate(rows, first);
            if let Some(parent) = parent {
                for k in 0..f.rows {
                    self.articulated[parent].add_outer(&f.jp[k], &f.x[k]);
                }
            }
        }
    }

    /// Solves for the bodies' `a` and the joints' `lambda`; `b` is used up. The `a` of driven bodies must be given.
    pub fn solve(&self, b: &mut [Vec6], g: &[f64], a: &mut [Vec6], lambda: &mut [f64]) {
        for &body in self.order.iter().rev() {
            self.up(body, b, Some(g), lambda);
        }
        for &body in &self.order {
            self.down(body, b, Some(g), lambda, a);
        }
    }

    /// The way up for one body: h of its joint into `lambda`, its share of `b` to the parent. Without `g`, g is 0.
    #[inline]
    pub fn up(&self, body: usize, b: &mut [Vec6], g: Option<&[f64]>, lambda: &mut [f64]) {
        let hang = &self.hang[body];
        if hang.ball {
            let ball = &self.balls[body];
            let wanted = g.map_or(DVec3::ZERO, |g| hang.sign() * triple(g, hang.at));
            let w = ball.up(&b[body], wanted);
            put(lambda, hang.at, w);
            if let Some(parent) = hang.parent {
                let wrench = ball.wrench(w);
                for k in 0..6 {
                    b[parent][k] += wrench[k];
                }
            }
            return;
        }
        let Some(f) = self.general[body].as_ref().filter(|_| !self.driven[body]) else { return };
        let mut wanted = [0.0; MAX_ROWS];
        for k in 0..f.rows {
            wanted[k] = g.map_or(0.0, |g| g[hang.at + k]) - dot(&f.w[k], &b[body]);
        }
        for k in 0..f.rows {
            let h = (0..f.rows).fold(0.0, |sum, l| sum + f.k[k][l] * wanted[l]);
            lambda[hang.at + k] = h;
            if let Some(parent) = hang.parent {
                add_scaled(&mut b[parent], h, &f.jp[k]);
            }
        }
    }

    /// The way down for one body, after its parent.
    #[inline]
    pub fn down(&self, body: usize, b: &[Vec6], g: Option<&[f64]>, lambda: &mut [f64], a: &mut [Vec6]) {
        let hang = &self.hang[body];
        if hang.ball {
            let wanted = g.map_or(DVec3::ZERO, |g| hang.sign() * triple(g, hang.at));
            let parent = hang.parent.map(|parent| a[parent]);
            let (own, l) = self.balls[body].down(&b[body], wanted, triple(lambda, hang.at), parent.as_ref());
            a[body] = own;
            put(lambda, hang.at, hang.sign() * l);
            return;
        }
        let Some(f) = self.general[body].as_ref().filter(|_| !self.driven[body]) else { return };
        let mut out = mul(&f.inverse, &b[body]);
        for k in 0..f.rows {
            let slot = &mut lambda[hang.at + k];
            if let Some(parent) = hang.parent {
                *slot -= dot(&f.x[k], &a[parent]);
            }
            add_scaled(&mut out, *slot, &f.w[k]);
        }
        a[body] = out;
    }

    /// All bodies, roots first.
    pub fn order(&self) -> &[usize] {
        &self.order
    }
}

impl Hang {
    /// Rows are written for the joint's first body: their sign as seen from this one.
    #[inline]
    fn sign(&self) -> f64 {
        if self.first { 1.0 } else { -1.0 }
    }
}

impl General {
    fn eliminate(&mut self, r: &JointRows, first: bool) {
        let (jc, jp) = if first { (&r.a, &r.b) } else { (&r.b, &r.a) };
        let rows = r.rows.min(MAX_ROWS);
        self.rows = rows;
        for k in 0..rows {
            self.jp[k] = jp[k];
            self.w[k] = mul(&self.inverse, &jc[k]);
            for l in 0..=k {
                self.k[k][l] = dot(&jc[k], &self.w[l]) + r.compliance[k][l];
            }
        }
        self.redundant = pseudo_inverse(&mut self.k, rows);
        for k in 0..rows {
            self.x[k] = [0.0; 6];
            for l in 0..rows {
                add_scaled(&mut self.x[k], self.k[k][l], &jp[l]);
            }
        }
    }
}

#[inline]
fn triple(v: &[f64], at: usize) -> DVec3 {
    DVec3::new(v[at], v[at + 1], v[at + 2])
}

#[inline]
fn put(v: &mut [f64], at: usize, x: DVec3) {
    v[at] = x.x;
    v[at + 1] = x.y;
    v[at + 2] = x.z;
}

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
//! then roots first, a_c = A⁻¹ b_c + W λ. The factor (A⁻¹, W, K, X) depends on poses and masses only, so one factor
//! serves accelerations, position and velocity projection, friction and impacts.
//!
//! Invariant: the order and all sizes are fixed by [`Tree::new`]; `factor` and `solve` never allocate.

use super::block::{MAX_ROWS, Mat6, RowBlock, RowSquare, RowVec, Vec6, add_scaled, dot, inverse, mul, pseudo_inverse};

/// Rows of one joint between two bodies, at one configuration.
#[derive(Clone, Debug)]
pub struct JointRows {
    /// Used rows, at most [`MAX_ROWS`].
    pub rows: usize,
    /// Blocks that multiply the coordinates of the first body.
    pub a: RowBlock,
    /// Blocks that multiply the coordinates of the second body; unused where it is the world.
    pub b: RowBlock,
    /// Γ: compliance of each row, 0 is hard.
    pub compliance: RowVec,
}

impl Default for JointRows {
    fn default() -> Self {
        Self { rows: 0, a: [[0.0; 6]; MAX_ROWS], b: [[0.0; 6]; MAX_ROWS], compliance: [0.0; MAX_ROWS] }
    }
}

/// Which bodies a joint connects: the first is always a body, the second may be the world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link {
    /// First body.
    pub a: usize,
    /// Second body; `None` is the world.
    pub b: Option<usize>,
}

impl Link {
    /// The body at the other end, if `body` is at one.
    fn other(&self, body: usize) -> Option<usize> {
        match self.b {
            Some(b) if self.a == body => Some(b),
            Some(b) if b == body => Some(self.a),
            _ => None,
        }
    }
}

/// How a body hangs in the tree.
#[derive(Clone, Copy, Debug)]
struct Hang {
    /// Parent body; `None`: the world, or nothing.
    parent: Option<usize>,
    /// Joint to the parent; `None` for the root of a piece that is not joined to the world.
    joint: Option<usize>,
    /// Is this body the joint's first one?
    first: bool,
}

/// What is kept of a joint's elimination, in the letters of the file's head; `k` holds K⁻¹.
#[derive(Clone, Debug)]
struct JointFactor {
    w: RowBlock,
    k: RowSquare,
    x: RowBlock,
}

/// Elimination order and factor of an articulated figure.
#[derive(Clone, Debug)]
pub struct Tree {
    /// Roots first; reversed it is the elimination order.
    order: Vec<usize>,
    hang: Vec<Hang>,
    loops: Vec<usize>,
    articulated: Vec<Mat6>,
    inverse: Vec<Mat6>,
    joints: Vec<JointFactor>,
    redundant: Vec<u32>,
}

impl Tree {
    /// The elimination order of `bodies` bodies joined by `links`: breadth first from the world, then each piece that
    /// floats from its first body. Links that would close a loop are left out, see [`Tree::loops`].
    pub fn new(bodies: usize, links: &[Link]) -> Self {
        let mut hang: Vec<Option<Hang>> = vec![None; bodies];
        let mut in_tree = vec![false; links.len()];
        let mut order = Vec::with_capacity(bodies);
        for (joint, link) in links.iter().enumerate() {
            if link.b.is_none() && hang[link.a].is_none() {
                hang[link.a] = Some(Hang { parent: None, joint: Some(joint), first: true });
                in_tree[joint] = true;
                order.push(link.a);
            }
        }
        let mut head = 0;
        for root in 0..=bodies {
            while head < order.len() {
                let parent = order[head];
                head += 1;
                for (joint, link) in links.iter().enumerate() {
                    let Some(child) = link.other(parent).filter(|&child| hang[child].is_none()) else { continue };
                    hang[child] = Some(Hang { parent: Some(parent), joint: Some(joint), first: link.a == child });
                    in_tree[joint] = true;
                    order.push(child);
                }
            }
            if root < bodies && hang[root].is_none() {
                hang[root] = Some(Hang { parent: None, joint: None, first: true });
                order.push(root);
            }
        }
        let blank = JointFactor { w: [[0.0; 6]; MAX_ROWS], k: [[0.0; MAX_ROWS]; MAX_ROWS], x: [[0.0; 6]; MAX_ROWS] };
        Self {
            order,
            hang: hang.into_iter().flatten().collect(),
            loops: (0..links.len()).filter(|&joint| !in_tree[joint]).collect(),
            articulated: vec![[[0.0; 6]; 6]; bodies],
            inverse: vec![[[0.0; 6]; 6]; bodies],
            joints: vec![blank; links.len()],
            redundant: vec![0; links.len()],
        }
    }

    /// Joints that close a loop and so are not in the tree.
    pub fn loops(&self) -> &[usize] {
        &self.loops
    }

    /// Rows that repeat others of their joint, as a bit set per joint: they carry no multiplier.
    pub fn redundant(&self) -> &[u32] {
        &self.redundant
    }

    /// Factors the system for these masses and rows.
    pub fn factor(&mut self, masses: &[Mat6], rows: &[JointRows]) {
        self.articulated.copy_from_slice(masses);
        for &body in self.order.iter().rev() {
            let hang = self.hang[body];
            self.inverse[body] = inverse(&self.articulated[body]);
            let Some(joint) = hang.joint else { continue };
            let (r, f) = (&rows[joint], &mut self.joints[joint]);
            let (jc, jp) = if hang.first { (&r.a, &r.b) } else { (&r.b, &r.a) };
            let rows = r.rows.min(MAX_ROWS);
            for k in 0..rows {
                f.w[k] = mul(&self.inverse[body], &jc[k]);
                for l in 0..=k {
                    f.k[k][l] = dot(&jc[k], &f.w[l]);
                }
                f.k[k][k] += r.compliance[k];
            }
            self.redundant[joint] = pseudo_inverse(&mut f.k, rows);
            let Some(parent) = hang.parent else { continue };
            let a_parent = &mut self.articulated[parent];
            for k in 0..rows {
                f.x[k] = [0.0; 6];
                for l in 0..rows {
                    add_scaled(&mut f.x[k], f.k[k][l], &jp[l]);
                }
                for (row, &j) in a_parent.iter_mut().zip(&jp[k]) {
                    add_scaled(row, j, &f.x[k]);
                }
            }
        }
    }

    /// Solves for the bodies' `a` and the joints' `lambda`; `b` is used up.
    pub fn solve(&self, rows: &[JointRows], b: &mut [Vec6], g: &[RowVec], a: &mut [Vec6], lambda: &mut [RowVec]) {
        for &body in self.order.iter().rev() {
            let hang = self.hang[body];
            let Some(joint) = hang.joint else { continue };
            let (r, f) = (&rows[joint], &self.joints[joint]);
            let rows = r.rows.min(MAX_ROWS);
            let mut wanted = g[joint];
            for k in 0..rows {
                wanted[k] -= dot(&f.w[k], &b[body]);
            }
            let h = &mut lambda[joint];
            for k in 0..rows {
                h[k] = (0..rows).fold(0.0, |sum, l| sum + f.k[k][l] * wanted[l]);
            }
            if let Some(parent) = hang.parent {
                let jp = if hang.first { &r.b } else { &r.a };
                for k in 0..rows {
                    add_scaled(&mut b[parent], h[k], &jp[k]);
                }
            }
        }
        for &body in &self.order {
            let hang = self.hang[body];
            let mut out = mul(&self.inverse[body], &b[body]);
            if let Some(joint) = hang.joint {
                let (r, f) = (&rows[joint], &self.joints[joint]);
                for k in 0..r.rows.min(MAX_ROWS) {
                    if let Some(parent) = hang.parent {
                        lambda[joint][k] -= dot(&f.x[k], &a[parent]);
                    }
                    add_scaled(&mut out, lambda[joint][k], &f.w[k]);
                }
            }
            a[body] = out;
        }
    }
}

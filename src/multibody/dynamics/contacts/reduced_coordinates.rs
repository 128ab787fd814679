//! Reduced coordinates of a contact problem: what its bodies can do, in numbers whose mass is one.
//!
//! A *node* is what moves as one thing: a body free of joints, or a *mechanism*, all bodies that joints put together. The
//! world and bodies with a given motion are none, they do not give way. Nodes feel each other through contact alone, so
//! the effective inverse mass of all rows J falls apart into one sum of nodes,
//!
//! ```text
//! J H⁻¹ Jᵀ = Σ_i B_i B_iᵀ        u = u₀ + Σ_i B_i z_i        z_i = B_iᵀ (P − P₀)        kinetic energy ½ Σ |z_i|²
//! ```
//!
//! with z_i the change of velocity of node i in coordinates that make its mass matrix the identity. For a free body of mass
//! m and inertia I, with F Fᵀ = I⁻¹ (Cholesky), a row (l, r × l) that pushes along l at the arm r has
//!
//! ```text
//! B = (l/√m, Fᵀ (r × l))        6 numbers
//! ```
//!
//! and for a mechanism B is the factor of W = J H⁻¹ Jᵀ = B Bᵀ over the rows that touch it, found by Cholesky's method with
//! pivots: as many numbers as the rows can move it in ways that differ. A clock of many teeth that touch has a handful.
//! Columns of W take one solve of the joints each; mechanisms do not feel each other's, so one solve serves the k-th rows of
//! all of them.

use super::contact::Contact;
use super::jacobian_row::{JacobianRow, MAX_ROW_BODIES};
use super::open_joints::OpenJoints;
use crate::articulation::{Constraint, Geared, Groups, System};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{Vec6, angular, linear};
use soffio_math::{DMat3, DVec3};

/// What is left of a row's own answer below this share of it is rounding: other rows move the mechanism that way already.
const REPEATS: f64 = 1e-11;
/// Room for the rows of so many touches of mechanisms; more make lists grow.
const ROOM: usize = 64;
/// No node.
const NONE: usize = usize::MAX;

/// Which bodies move as one.
#[derive(Clone, Debug)]
pub(in crate::dynamics) struct Mechanisms {
    /// First body of each body's mechanism; [`NONE`] where its motion is given.
    first: Vec<usize>,
    /// Is a body free of joints?
    free: Vec<bool>,
}

impl Mechanisms {
    /// Those that these constraints make of the bodies that are not driven.
    pub fn new(constraints: &[Constraint], is_kinematic: &[bool]) -> Self {
        let n = is_kinematic.len();
        let mut groups = Groups::new(n);
        let mut free = vec![true; n];
        for constraint in constraints {
            let held = || (0..n).filter(|&body| !is_kinematic[body] && constraint.kind.touches(body));
            groups.join_all(held());
            held().for_each(|body| free[body] = false);
        }
        let first = (0..n).map(|body| if is_kinematic[body] { NONE } else { groups.first(body) }).collect();
        Self { first, free }
    }

    /// How many bodies there are.
    pub fn count(&self) -> usize {
        self.first.len()
    }
}

/// What moves as one thing, in a problem.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// First body of a mechanism, or the body that is free.
    body: usize,
    free: bool,
    /// How many coordinates it has.
    pub size: usize,
    /// Its lines among all, and where its W begins.
    lines: (usize, usize),
    w: usize,
}

/// How the rows of a touch move one node: a matrix of `rows` by the node's size, row by row.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodeBlock {
    pub node: usize,
    pub contact: usize,
    /// Where its numbers begin.
    pub at: usize,
}

/// A row of the problem, as far as it touches one mechanism.
#[derive(Clone, Copy, Debug)]
struct MechanismRow {
    row: usize,
    part: usize,
    geared: Option<Geared<MAX_ROW_BODIES>>,
}

/// The nodes of a problem and how its rows move them.
#[derive(Clone, Debug)]
pub(super) struct Coordinates {
    mechanisms: Mechanisms,
    /// Node of each mechanism by its first body, in the present problem.
    node_of: Vec<usize>,
    pub nodes: Vec<Node>,
    pub parts: Vec<NodeBlock>,
    pub jacobian: Vec<f64>,
    lines: Vec<MechanismRow>,
    /// W of all mechanisms, one after the other, row by row.
    w: Vec<f64>,
    /// Scratch of the factor: what is left of each line's own answer, that answer, and B.
    left: Vec<[f64; 2]>,
    b: Vec<f64>,
    open: OpenJoints,
}

impl Coordinates {
    /// For problems among these mechanisms, of about so many touches.
    pub fn new(mechanisms: Mechanisms, contacts: usize, (joint_rows, time): (usize, f64)) -> Self {
        let bodies = mechanisms.first.len();
        let rows = if mechanisms.free.iter().all(|free| *free) { 0 } else { 3 * contacts.min(ROOM) };
        Self {
            node_of: vec![NONE; bodies],
            nodes: Vec::with_capacity(bodies),
            parts: Vec::with_capacity(3 * contacts),
            jacobian: Vec::with_capacity(36 * contacts + rows * rows),
            lines: Vec::with_capacity(2 * rows),
            w: Vec::with_capacity(rows * rows),
            left: Vec::with_capacity(rows),
            b: Vec::with_capacity(rows * rows),
            open: OpenJoints::new(joint_rows, time, 2 * rows),
            mechanisms,
        }
    }

    /// Are there joints that give way, at the last assembly?
    pub fn has_open_joints(&self) -> bool {
        !self.open.is_empty()
    }

    /// The parts of a touch.
    pub fn parts_of(&self, contact: &Contact) -> &[NodeBlock] {
        &self.parts[contact.parts.0..contact.parts.1]
    }

    /// The matrix of a part.
    pub fn block(&self, part: &NodeBlock, rows: usize) -> &[f64] {
        &self.jacobian[part.at..][..rows * self.nodes[part.node].size]
    }

    /// Finds nodes and matrices at the bodies' present state; the joints must be factored there.
    pub fn assemble(
        &mut self,
        contacts: &mut [Contact],
        rows: &[JacobianRow],
        system: &mut System,
        bodies: &[RigidBody],
    ) {
        self.find_parts(contacts, rows, bodies);
        self.open.find(system);
        if !self.lines.is_empty() {
            self.find_lines(system, rows);
            self.solve_lines(system, rows);
            (0..self.nodes.len()).for_each(|node| self.factor_mechanism(node));
            self.write_blocks(contacts);
        }
        for node in &self.nodes {
            self.node_of[node.body] = NONE;
        }
    }

    /// Finds nodes and parts, and the matrices of free bodies.
    fn find_parts(&mut self, contacts: &mut [Contact], rows: &[JacobianRow], bodies: &[RigidBody]) {
        self.nodes.clear();
        self.parts.clear();
        self.jacobian.clear();
        self.lines.clear();
        for (index, contact) in contacts.iter_mut().enumerate() {
            let first = self.parts.len();
            let own = &rows[contact.first..contact.first + contact.rows];
            for (end, (body, _)) in own[0].ends.iter().enumerate().filter_map(|(k, end)| Some((k, end.as_ref()?))) {
                let Some(node) = self.node(*body) else { continue };
                if self.parts[first..].iter().any(|part| part.node == node) {
                    continue;
                }
                let at = self.jacobian.len();
                self.parts.push(NodeBlock { node, contact: index, at });
                if self.nodes[node].free {
                    let body = &bodies[*body];
                    let (lightness, f) = (body.properties.mass.sqrt().recip(), spin_factor(body));
                    for row in own {
                        let (_, block) = row.ends[end].unwrap_or_default();
                        let (push, twist) = (lightness * linear(&block), f.transpose() * angular(&block));
                        self.jacobian.extend(push.to_array().into_iter().chain(twist.to_array()));
                    }
                } else {
                    let part = self.parts.len() - 1;
                    self.nodes[node].lines.1 += own.len();
                    self.lines.extend((contact.first..).take(own.len()).map(|row| MechanismRow {
                        row,
                        part,
                        geared: None,
                    }));
                }
            }
            contact.parts = (first, self.parts.len());
        }
    }

    /// The node of a body; none where its motion is given.
    fn node(&mut self, body: usize) -> Option<usize> {
        let first = self.mechanisms.first[body];
        if first == NONE {
            return None;
        }
        if self.node_of[first] == NONE {
            self.node_of[first] = self.nodes.len();
            let free = self.mechanisms.free[body];
            self.nodes.push(Node { body: first, free, size: if free { 6 } else { 0 }, lines: (0, 0), w: 0 });
        }
        Some(self.node_of[first])
    }

    /// Brings the lines into the order of their nodes, and says which push trains alone.
    fn find_lines(&mut self, system: &System, rows: &[JacobianRow]) {
        let Self { lines, parts, nodes, mechanisms, open, .. } = self;
        lines.sort_unstable_by_key(|line| (parts[line.part].node, line.row));
        let (mut first, mut w) = (0, 0);
        for node in nodes.iter_mut().filter(|node| !node.free) {
            let count = node.lines.1;
            (node.lines, node.w) = ((first, first + count), w);
            (first, w) = (first + count, w + count * count);
        }
        for numbers in [&mut self.w, &mut self.b] {
            numbers.clear();
            numbers.resize(w, 0.0);
        }
        // Of joints that give way the multipliers are asked too.
        if open.is_empty() && system.has_trains() {
            for line in lines.iter_mut() {
                let body = nodes[parts[line.part].node].body;
                line.geared = system.geared(&within(mechanisms, &rows[line.row], body));
            }
        }
        open.make_room(lines.len());
    }

    /// Finds W of every mechanism.
    fn solve_lines(&mut self, system: &mut System, rows: &[JacobianRow]) {
        let most = self.nodes.iter().map(|node| node.lines.1 - node.lines.0).max().unwrap_or(0);
        for k in 0..most {
            let has = |node: &Node| node.lines.0 + k < node.lines.1;
            let asks = |this: &Self, node: &Node| has(node) && this.lines[node.lines.0 + k].geared.is_none();
            if self.open.is_empty() {
                system.b.fill([0.0; 6]);
                let mut any = false;
                for node in 0..self.nodes.len() {
                    if asks(self, &self.nodes[node]) {
                        self.push(self.nodes[node].lines.0 + k, rows, system);
                        any = true;
                    }
                }
                if any {
                    system.solve_impulse();
                }
            }
            for node in 0..self.nodes.len() {
                let Node { lines: (first, end), .. } = self.nodes[node];
                if first + k >= end {
                    continue;
                }
                let line = first + k;
                match &self.lines[line].geared {
                    Some(geared) => {
                        system.answer_geared(geared);
                        for other in line..end {
                            if let Some(row) = &self.lines[other].geared {
                                self.enter(node, (other - first, k), system.geared_rate(row));
                            }
                        }
                    }
                    None => {
                        if !self.open.is_empty() {
                            system.b.fill([0.0; 6]);
                            self.push(line, rows, system);
                            system.solve_impulse();
                            self.open.take(line, system);
                        }
                        for other in first..end {
                            if other >= line || self.lines[other].geared.is_some() {
                                let value = self.along(other, rows, &system.a);
                                self.enter(node, (other - first, k), value);
                            }
                        }
                    }
                }
            }
        }
        if !self.open.is_empty() {
            for node in 0..self.nodes.len() {
                let Node { lines: (first, end), w, .. } = self.nodes[node];
                let count = end - first;
                for (row, column) in (0..count).flat_map(|row| (0..count).map(move |column| (row, column))) {
                    self.w[w + row * count + column] += self.open.adds(first + row, first + column);
                }
            }
        }
    }

    /// Enters an element of W and its mirror image.
    fn enter(&mut self, node: usize, (row, column): (usize, usize), value: f64) {
        let Node { lines: (first, end), w, .. } = self.nodes[node];
        let count = end - first;
        self.w[w + row * count + column] = value;
        self.w[w + column * count + row] = value;
    }

    /// Lays a unit impulse of a line on its bodies.
    fn push(&self, line: usize, rows: &[JacobianRow], system: &mut System) {
        let MechanismRow { row, part, .. } = self.lines[line];
        let own = within(&self.mechanisms, &rows[row], self.nodes[self.parts[part].node].body);
        for (body, block) in own.iter().flatten() {
            system.push_impulse(*body, block, 1.0);
        }
    }

    /// A line times the bodies' coordinates.
    fn along(&self, line: usize, rows: &[JacobianRow], a: &[Vec6]) -> f64 {
        let MechanismRow { row, part, .. } = self.lines[line];
        JacobianRow { ends: within(&self.mechanisms, &rows[row], self.nodes[self.parts[part].node].body) }.along(a)
    }

    /// Factors W of a mechanism, W = B Bᵀ, pivot after pivot the line of which most is left; B's lines stand in `b`.
    fn factor_mechanism(&mut self, node: usize) {
        let Node { free, lines: (first, end), w, .. } = self.nodes[node];
        if free {
            return;
        }
        let count = end - first;
        let (w, b) = (&self.w[w..][..count * count], &mut self.b[w..][..count * count]);
        self.left.clear();
        self.left.extend((0..count).map(|k| [w[k * count + k]; 2]));
        let mut size = 0;
        loop {
            let share = |[left, own]: &[f64; 2]| if *own > 0.0 { left / own } else { 0.0 };
            let (mut pivot, mut best) = (0, REPEATS);
            for (k, left) in self.left.iter().enumerate() {
                if share(left) > best {
                    (pivot, best) = (k, share(left));
                }
            }
            if best == REPEATS || size == count {
                break;
            }
            let root = self.left[pivot][0].sqrt();
            for k in 0..count {
                let done = (0..size).map(|j| b[k * count + j] * b[pivot * count + j]).sum::<f64>();
                let value = (w[k * count + pivot] - done) / root;
                b[k * count + size] = value;
                self.left[k][0] -= value * value;
            }
            self.left[pivot][0] = 0.0;
            size += 1;
        }
        self.nodes[node].size = size;
    }

    /// Writes the mechanisms' factors into the matrices of their parts.
    fn write_blocks(&mut self, contacts: &[Contact]) {
        for line in 0..self.lines.len() {
            let MechanismRow { row, part, .. } = self.lines[line];
            let NodeBlock { node, contact, .. } = self.parts[part];
            let Node { size, lines: (first, end), w, .. } = self.nodes[node];
            let count = end - first;
            if row == contacts[contact].first {
                self.parts[part].at = self.jacobian.len();
            }
            self.jacobian.extend_from_slice(&self.b[w + (line - first) * count..][..size]);
            debug_assert_eq!(self.jacobian.len(), self.parts[part].at + (row - contacts[contact].first + 1) * size);
        }
    }

    /// Solves for the answer to the impulses in the system's `b`, which are these in the problem's rows.
    pub fn answer(&self, impulses: &[f64], system: &mut System) {
        self.open.solve(self.lines.iter().map(|line| impulses[line.row]), system);
    }
}

/// The ends of a row in the mechanism of this first body.
fn within(mechanisms: &Mechanisms, row: &JacobianRow, body: usize) -> [Option<(usize, Vec6)>; MAX_ROW_BODIES] {
    row.ends.map(|end| end.filter(|(other, _)| mechanisms.first[*other] == body))
}

/// F with F Fᵀ = I⁻¹, lower triangular.
fn spin_factor(body: &RigidBody) -> DMat3 {
    let i = body.inertia_world().inverse();
    let a = i.x_axis.x.sqrt();
    let (b, c) = (i.x_axis.y / a, i.x_axis.z / a);
    let d = (i.y_axis.y - b * b).sqrt();
    let e = (i.y_axis.z - b * c) / d;
    let f = (i.z_axis.z - c * c - e * e).sqrt();
    DMat3::from_cols(DVec3::new(a, b, c), DVec3::new(0.0, d, e), DVec3::new(0.0, 0.0, f))
}

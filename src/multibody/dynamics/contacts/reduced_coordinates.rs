//! Reduced coordinates of the contact problem: a factor of its effective inverse mass (Delassus) matrix.
//!
//! A *node* moves as one: a free body, or a *mechanism*, which is all bodies that joints connect. The world and kinematic bodies
//! are no nodes, because nothing moves them. Nodes influence each other by contact alone, so the effective inverse mass of all
//! rows J is a sum over nodes,
//!
//! ```text
//! J H⁻¹ Jᵀ = Σ_i B_i B_iᵀ        u = u₀ + Σ_i B_i z_i        z_i = B_iᵀ (P − P₀)        kinetic energy ½ Σ |z_i|²
//! ```
//!
//! with z_i the velocity change of node i in coordinates that make its mass matrix the identity. For a free body of mass m and
//! inertia I, with F Fᵀ = I⁻¹ (Cholesky), a row (l, r × l) along l at the arm r has
//!
//! ```text
//! B = (l/√m, Fᵀ (r × l))        6 coordinates
//! ```
//!
//! For a mechanism B is a pivoted Cholesky factor of W = J H⁻¹ Jᵀ = B Bᵀ over the rows that act on it. It has as many coordinates
//! as independent ways in which contact can move it, a handful for a clock of many teeth. A column of W takes one solve of the
//! joints. Mechanisms do not influence each other, so one solve finds the k-th column of all of them.

use super::contact::{Contact, IndexRange};
use super::jacobian_row::{JacobianRow, MAX_ROW_BODIES};
use super::open_joints::{OpenJoints, Stabilization};
use crate::articulation::{Constraint, DisjointSets, System, TrainRow};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{Vec6, angular, linear};
use soffio_math::{DMat3, DVec3};

/// A pivot below this fraction of its diagonal element is rounding: the row depends on others.
const DEPENDENT: f64 = 1e-11;
/// Capacity for the rows of so many contacts of mechanisms; more make lists grow.
const CAPACITY: usize = 64;
/// No node.
const NONE: usize = usize::MAX;

/// Which bodies joints connect.
#[derive(Clone, Debug)]
pub(in crate::dynamics) struct Mechanisms {
    /// First body of each body's mechanism; [`NONE`] for a kinematic body.
    first: Vec<usize>,
    /// Whether no joint acts on a body.
    free: Vec<bool>,
}

impl Mechanisms {
    /// The mechanisms that these constraints make of the bodies that are not kinematic.
    pub fn new(constraints: &[Constraint], is_kinematic: &[bool]) -> Self {
        let n = is_kinematic.len();
        let mut groups = DisjointSets::new(n);
        let mut free = vec![true; n];
        for constraint in constraints {
            let connected = || (0..n).filter(|&body| !is_kinematic[body] && constraint.kind.acts_on(body));
            groups.join_all(connected());
            connected().for_each(|body| free[body] = false);
        }
        let first = (0..n).map(|body| if is_kinematic[body] { NONE } else { groups.first(body) }).collect();
        Self { first, free }
    }

    /// Number of bodies.
    pub fn count(&self) -> usize {
        self.first.len()
    }
}

/// A free body or a mechanism of the problem.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// First body of a mechanism, or the free body.
    body: usize,
    free: bool,
    /// Number of its coordinates.
    pub size: usize,
    /// Its rows among those of all mechanisms.
    rows: IndexRange,
    /// Where its W begins.
    w: usize,
}

/// B of one contact and one node: a matrix of the contact's rows by the node's size, row by row.
#[derive(Clone, Copy, Debug)]
pub(super) struct NodeBlock {
    /// Index of the node.
    pub node: usize,
    /// Index of the contact.
    pub contact: usize,
    /// Where its elements begin.
    pub at: usize,
}

/// A row of the problem, as far as it acts on one mechanism.
#[derive(Clone, Copy, Debug)]
struct MechanismRow {
    row: usize,
    block: usize,
    train_row: Option<TrainRow<MAX_ROW_BODIES>>,
}

/// The nodes of the problem and the factor B of its rows.
#[derive(Clone, Debug)]
pub(super) struct ReducedCoordinates {
    mechanisms: Mechanisms,
    /// Node of each mechanism by its first body, in the present problem.
    node_of: Vec<usize>,
    /// The nodes: mechanisms and free bodies.
    pub nodes: Vec<Node>,
    /// The blocks of B.
    pub blocks: Vec<NodeBlock>,
    /// Elements of all blocks.
    pub elements: Vec<f64>,
    mechanism_rows: Vec<MechanismRow>,
    /// W of all mechanisms, one after the other, row by row.
    w: Vec<f64>,
    /// Scratch of the factorization: each row's remaining and original diagonal element, and B.
    diagonals: Vec<[f64; 2]>,
    b: Vec<f64>,
    open: OpenJoints,
}

impl ReducedCoordinates {
    /// Capacity for problems among these mechanisms, of about so many contacts.
    pub fn new(mechanisms: Mechanisms, contacts: usize, stabilization: Stabilization) -> Self {
        let bodies = mechanisms.first.len();
        let rows = if mechanisms.free.iter().all(|free| *free) { 0 } else { 3 * contacts.min(CAPACITY) };
        Self {
            node_of: vec![NONE; bodies],
            nodes: Vec::with_capacity(bodies),
            blocks: Vec::with_capacity(3 * contacts),
            elements: Vec::with_capacity(36 * contacts + rows * rows),
            mechanism_rows: Vec::with_capacity(2 * rows),
            w: Vec::with_capacity(rows * rows),
            diagonals: Vec::with_capacity(rows),
            b: Vec::with_capacity(rows * rows),
            open: OpenJoints::new(stabilization, 2 * rows),
            mechanisms,
        }
    }

    /// Whether joints were open at the last assembly.
    pub fn has_open_joints(&self) -> bool {
        !self.open.is_empty()
    }

    /// The blocks of a contact.
    pub fn blocks_of(&self, contact: &Contact) -> &[NodeBlock] {
        &self.blocks[contact.blocks.range()]
    }

    /// The elements of a block of so many rows, row by row.
    pub fn matrix(&self, block: &NodeBlock, rows: usize) -> &[f64] {
        &self.elements[block.at..][..rows * self.nodes[block.node].size]
    }

    /// Finds nodes and blocks at the bodies' present state, where the joints must be factored.
    pub fn assemble(
        &mut self,
        contacts: &mut [Contact],
        rows: &[JacobianRow],
        system: &mut System,
        bodies: &[RigidBody],
    ) {
        self.find_blocks(contacts, rows, bodies);
        self.open.find(system);
        if !self.mechanism_rows.is_empty() {
            self.sort_mechanism_rows(system, rows);
            self.solve_mechanism_rows(system, rows);
            (0..self.nodes.len()).for_each(|node| self.factor_mechanism(node));
            self.write_blocks(contacts);
        }
        for node in &self.nodes {
            self.node_of[node.body] = NONE;
        }
    }

    /// Finds nodes and blocks, and the elements of free bodies.
    fn find_blocks(&mut self, contacts: &mut [Contact], rows: &[JacobianRow], bodies: &[RigidBody]) {
        self.nodes.clear();
        self.blocks.clear();
        self.elements.clear();
        self.mechanism_rows.clear();
        for (index, contact) in contacts.iter_mut().enumerate() {
            let first = self.blocks.len();
            let own = &rows[contact.rows.range()];
            for (end, (body, _)) in own[0].ends.iter().enumerate().filter_map(|(k, end)| Some((k, end.as_ref()?))) {
                let Some(node) = self.node(*body) else { continue };
                if self.blocks[first..].iter().any(|block| block.node == node) {
                    continue;
                }
                let at = self.elements.len();
                self.blocks.push(NodeBlock { node, contact: index, at });
                if self.nodes[node].free {
                    let body = &bodies[*body];
                    let (inverse_root_mass, f) = (body.properties.mass.sqrt().recip(), spin_factor(body));
                    for row in own {
                        let (_, block) = row.ends[end].unwrap_or_default();
                        let (translation, rotation) =
                            (inverse_root_mass * linear(&block), f.transpose() * angular(&block));
                        self.elements.extend(translation.to_array().into_iter().chain(rotation.to_array()));
                    }
                } else {
                    let block = self.blocks.len() - 1;
                    self.nodes[node].rows.end += own.len();
                    self.mechanism_rows.extend((contact.rows.start..).take(own.len()).map(|row| MechanismRow {
                        row,
                        block,
                        train_row: None,
                    }));
                }
            }
            contact.blocks = IndexRange { start: first, end: self.blocks.len() };
        }
    }

    /// The node of a body; `None` of a kinematic one.
    fn node(&mut self, body: usize) -> Option<usize> {
        let first = self.mechanisms.first[body];
        if first == NONE {
            return None;
        }
        if self.node_of[first] == NONE {
            self.node_of[first] = self.nodes.len();
            let free = self.mechanisms.free[body];
            let size = if free { 6 } else { 0 };
            self.nodes.push(Node { body: first, free, size, rows: IndexRange::default(), w: 0 });
        }
        Some(self.node_of[first])
    }

    /// Sorts the rows by their nodes, and finds those that act on gear trains alone.
    fn sort_mechanism_rows(&mut self, system: &System, rows: &[JacobianRow]) {
        let Self { mechanism_rows, blocks, nodes, mechanisms, open, .. } = self;
        mechanism_rows.sort_unstable_by_key(|own| (blocks[own.block].node, own.row));
        let (mut start, mut w) = (0, 0);
        for node in nodes.iter_mut().filter(|node| !node.free) {
            let count = node.rows.end;
            (node.rows, node.w) = (IndexRange { start, end: start + count }, w);
            (start, w) = (start + count, w + count * count);
        }
        for numbers in [&mut self.w, &mut self.b] {
            numbers.clear();
            numbers.resize(w, 0.0);
        }
        // Open joints need the multipliers too, which gear trains alone do not give.
        if open.is_empty() && system.has_trains() {
            for own in mechanism_rows.iter_mut() {
                let body = nodes[blocks[own.block].node].body;
                own.train_row = system.train_row(&within(mechanisms, &rows[own.row], body));
            }
        }
        open.begin_columns(mechanism_rows.len());
    }

    /// Finds W of every mechanism, column by column.
    fn solve_mechanism_rows(&mut self, system: &mut System, rows: &[JacobianRow]) {
        let longest = self.nodes.iter().map(|node| node.rows.len()).max().unwrap_or(0);
        for k in 0..longest {
            if self.open.is_empty() {
                system.b.fill([0.0; 6]);
                let mut any = false;
                for node in 0..self.nodes.len() {
                    let Node { rows: own, .. } = self.nodes[node];
                    if own.start + k < own.end && self.mechanism_rows[own.start + k].train_row.is_none() {
                        self.push(own.start + k, rows, system);
                        any = true;
                    }
                }
                if any {
                    system.solve_impulse();
                }
            }
            for node in 0..self.nodes.len() {
                let IndexRange { start, end } = self.nodes[node].rows;
                if start + k >= end {
                    continue;
                }
                let pushed = start + k;
                match &self.mechanism_rows[pushed].train_row {
                    Some(train_row) => {
                        system.respond_to_train_row(train_row);
                        for other in pushed..end {
                            if let Some(row) = &self.mechanism_rows[other].train_row {
                                self.set_symmetric(node, other - start, k, system.train_row_rate(row));
                            }
                        }
                    }
                    None => {
                        if !self.open.is_empty() {
                            system.b.fill([0.0; 6]);
                            self.push(pushed, rows, system);
                            system.solve_impulse();
                            self.open.take_column(pushed, system);
                        }
                        for other in start..end {
                            if other >= pushed || self.mechanism_rows[other].train_row.is_some() {
                                let value = self.along(other, rows, &system.a);
                                self.set_symmetric(node, other - start, k, value);
                            }
                        }
                    }
                }
            }
        }
        if !self.open.is_empty() {
            for node in 0..self.nodes.len() {
                let Node { rows: own, w, .. } = self.nodes[node];
                let count = own.len();
                for (row, column) in (0..count).flat_map(|row| (0..count).map(move |column| (row, column))) {
                    self.w[w + row * count + column] += self.open.addition(own.start + row, own.start + column);
                }
            }
        }
    }

    /// Sets an element of W and its mirror image.
    fn set_symmetric(&mut self, node: usize, row: usize, column: usize, value: f64) {
        let Node { rows, w, .. } = self.nodes[node];
        let count = rows.len();
        self.w[w + row * count + column] = value;
        self.w[w + column * count + row] = value;
    }

    /// Adds a unit impulse along a mechanism's row to the right-hand side.
    fn push(&self, mechanism_row: usize, rows: &[JacobianRow], system: &mut System) {
        for (body, block) in self.ends(mechanism_row, rows).iter().flatten() {
            system.push_impulse(*body, block, 1.0);
        }
    }

    /// A mechanism's row times one vector per body.
    fn along(&self, mechanism_row: usize, rows: &[JacobianRow], a: &[Vec6]) -> f64 {
        JacobianRow { ends: self.ends(mechanism_row, rows) }.along(a)
    }

    /// The ends of a row within its mechanism.
    fn ends(&self, mechanism_row: usize, rows: &[JacobianRow]) -> [Option<(usize, Vec6)>; MAX_ROW_BODIES] {
        let MechanismRow { row, block, .. } = self.mechanism_rows[mechanism_row];
        within(&self.mechanisms, &rows[row], self.nodes[self.blocks[block].node].body)
    }

    /// Factors W = B Bᵀ of a mechanism by Cholesky's method with diagonal pivoting; B's rows are in `b`.
    fn factor_mechanism(&mut self, node: usize) {
        let Node { free, rows, w, .. } = self.nodes[node];
        if free {
            return;
        }
        let count = rows.len();
        let (w, b) = (&self.w[w..][..count * count], &mut self.b[w..][..count * count]);
        self.diagonals.clear();
        self.diagonals.extend((0..count).map(|k| [w[k * count + k]; 2]));
        let mut size = 0;
        loop {
            let fraction = |[remaining, own]: &[f64; 2]| if *own > 0.0 { remaining / own } else { 0.0 };
            let (mut pivot, mut best) = (0, DEPENDENT);
            for (k, diagonal) in self.diagonals.iter().enumerate() {
                if fraction(diagonal) > best {
                    (pivot, best) = (k, fraction(diagonal));
                }
            }
            if best == DEPENDENT || size == count {
                break;
            }
            let root = self.diagonals[pivot][0].sqrt();
            for k in 0..count {
                let done = (0..size).map(|j| b[k * count + j] * b[pivot * count + j]).sum::<f64>();
                let value = (w[k * count + pivot] - done) / root;
                b[k * count + size] = value;
                self.diagonals[k][0] -= value * value;
            }
            self.diagonals[pivot][0] = 0.0;
            size += 1;
        }
        self.nodes[node].size = size;
    }

    /// Copies the mechanisms' factors into their blocks.
    fn write_blocks(&mut self, contacts: &[Contact]) {
        for own in 0..self.mechanism_rows.len() {
            let MechanismRow { row, block, .. } = self.mechanism_rows[own];
            let NodeBlock { node, contact, .. } = self.blocks[block];
            let Node { size, rows, w, .. } = self.nodes[node];
            let first_row = contacts[contact].rows.start;
            if row == first_row {
                self.blocks[block].at = self.elements.len();
            }
            self.elements.extend_from_slice(&self.b[w + (own - rows.start) * rows.len()..][..size]);
            debug_assert_eq!(self.elements.len(), self.blocks[block].at + (row - first_row + 1) * size);
        }
    }

    /// Solves for the response to the impulses in the system's `b`, which are `impulses` in the problem's rows.
    pub fn solve_impulses(&self, impulses: &[f64], system: &mut System) {
        self.open.solve(self.mechanism_rows.iter().map(|own| impulses[own.row]), system);
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

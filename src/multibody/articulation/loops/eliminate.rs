//! Elimination of a loop component and its solves, in the symbols of the module's head.

use super::cluster::{Cluster, Node};
use super::sparse_structure::BORDER;
use super::{LoopRow, STABILISING_COMPLIANCE};
use crate::articulation::trains::Trains;
use crate::articulation::tree::JointRows;
use soffio_math::for_rows;
use soffio_math::spatial::row_blocks::RowVec;
use soffio_math::spatial::{Articulated, Mat6, NUMBERS, Vec6, add_scaled, dot, inverse, mul};

/// Where the rows of a component are.
#[derive(Clone, Copy)]
pub(super) struct RowSource<'a> {
    /// Of joints.
    pub blocks: &'a [JointRows],
    /// Of couplings.
    pub rows: &'a [LoopRow],
}

impl<'a> RowSource<'a> {
    /// How many rows of a node act.
    #[inline(always)]
    fn size(&self, node: &Node) -> usize {
        node.span.block.map_or_else(|| usize::from(self.rows[node.span.first].active), |block| self.blocks[block].rows)
    }

    /// One of their parts.
    #[inline(always)]
    fn part(&self, node: &Node, index: usize, size: usize) -> &'a [Vec6] {
        match (node.span.block, index) {
            (Some(block), 0) => &self.blocks[block].a[..size],
            (Some(block), _) => &self.blocks[block].b[..size],
            (None, _) => &std::slice::from_ref(&self.rows[node.span.first].parts[index].1)[..size],
        }
    }

    /// Γ among them, lower triangle; `None` where all are hard.
    #[inline(always)]
    fn compliance(&self, node: &Node) -> Option<&'a [RowVec]> {
        match node.span.block {
            Some(block) => self.blocks[block].soft.then_some(&self.blocks[block].compliance),
            None => Some(std::slice::from_ref(&self.rows[node.span.first].compliance)),
        }
    }
}

impl Cluster {
    /// Factors K for these rows, and adds their Schur complement to the articulated inertia of the top.
    /// `stabilising`: rows that close loops get [`STABILISING_COMPLIANCE`].
    #[inline(always)]
    pub fn factor(
        &mut self,
        source: RowSource,
        articulated: &mut [[f64; NUMBERS]],
        trains: &Trains,
        stabilising: bool,
    ) {
        let Self { nodes, factor, w, .. } = self;
        factor.begin(|node| source.size(&nodes[node]));
        for (_, part) in &self.given {
            let own = source.part(&nodes[part.node], part.index, factor.size(part.node));
            self.j[part.at..part.at + own.len()].copy_from_slice(own);
        }
        for (k, clique) in self.bodies.iter().enumerate() {
            let mass = Articulated::of_numbers(&articulated[clique.index]);
            self.inverses[k] = if self.leaves[k] { mass.inverse_alone() } else { inverse(&mass.matrix()) };
            let inverse = &self.inverses[k];
            for part in &clique.parts {
                let own = source.part(&nodes[part.node], part.index, factor.size(part.node));
                let columns = &mut w[6 * part.at..][..6 * own.len()];
                for (l, j) in own.iter().enumerate() {
                    let column = if self.leaves[k] { mul_alone(inverse, j) } else { mul(inverse, j) };
                    for c in 0..6 {
                        columns[c * own.len() + l] = column[c];
                    }
                }
            }
            for (first, second, item) in clique.pairs() {
                let others = factor.size(second.node);
                let own = source.part(&nodes[first.node], first.index, factor.size(first.node));
                for_rows!(others, others => {
                    let w = &w[6 * second.at..][..6 * others];
                    for (k, j) in own.iter().enumerate() {
                        add_product(&mut factor.row(first.node, k, item)[..others], j, w);
                    }
                });
            }
        }
        self.add_trains(source, trains);
        let Self { nodes, factor, .. } = self;
        for &(part, item) in &self.on_top {
            let own = source.part(&nodes[part.node], part.index, factor.size(part.node));
            for (k, j) in own.iter().enumerate() {
                factor.row(part.node, k, item).copy_from_slice(j);
            }
        }
        for (index, node) in nodes.iter().enumerate() {
            if stabilising && node.closes {
                (0..factor.size(index)).for_each(|k| *factor.diagonal(index, k) *= 1.0 + STABILISING_COMPLIANCE);
            }
            let Some(compliance) = source.compliance(node) else { continue };
            let (size, item) = (factor.size(index), factor.own(index));
            for l in 0..size {
                for (entry, gamma) in factor.row(index, l, item)[l..].iter_mut().zip(&compliance[l..size]) {
                    *entry += gamma[l];
                }
            }
        }
        factor.factor();
        if let Some(top) = self.top {
            let (border, item) = (factor.border(), factor.own(factor.border()));
            let mut left: Mat6 = [[0.0; BORDER]; BORDER];
            for (k, row) in left.iter_mut().enumerate() {
                row.copy_from_slice(factor.row(border, k, item));
            }
            for (sum, left) in articulated[top].iter_mut().zip(Articulated::of_matrix(&left).numbers()) {
                *sum -= left;
            }
        }
    }

    /// Adds the response of gear trains.
    #[inline(always)]
    fn add_trains(&mut self, source: RowSource, trains: &Trains) {
        let Self { nodes, factor, coefficients, .. } = self;
        for clique in &self.trains {
            for part in &clique.parts {
                let (node, size) = (&nodes[part.node], factor.size(part.node));
                let coefficients = &mut coefficients[part.at..part.at + size];
                coefficients.fill(0.0);
                for (index, &(body, _)) in source.rows[node.span.first].parts.iter().enumerate() {
                    if trains.of(body) == Some(clique.index) {
                        for (coefficient, j) in coefficients.iter_mut().zip(source.part(node, index, size)) {
                            *coefficient += trains.row_coefficient(&(body, *j)).map_or(0.0, |(_, f)| f);
                        }
                    }
                }
            }
            for (first, second, item) in clique.pairs() {
                for k in 0..factor.size(first.node) {
                    let entries = factor.row(first.node, k, item);
                    for (entry, f) in entries.iter_mut().zip(&coefficients[second.at..]) {
                        *entry += trains.response(clique.index, coefficients[first.at + k], *f);
                    }
                }
            }
        }
    }

    /// The way up: what the rows push on the top into `b`. `a` has the given accelerations.
    #[inline(always)]
    pub fn inward(&mut self, b: &mut [Vec6], g: &[f64], a: &[Vec6]) {
        let Self { nodes, factor, j, w, x, .. } = self;
        for (index, node) in nodes.iter().enumerate() {
            let (first, size) = (factor.first(index), factor.size(index));
            x[first..first + size].copy_from_slice(&g[node.at..node.at + size]);
        }
        for clique in &self.bodies {
            for part in &clique.parts {
                let (first, size) = (factor.first(part.node), factor.size(part.node));
                let (x, w) = (&mut x[first..first + size], &w[6 * part.at..][..6 * size]);
                for c in 0..6 {
                    for (x, w) in x.iter_mut().zip(&w[c * size..]) {
                        *x -= w * b[clique.index][c];
                    }
                }
            }
        }
        for (body, part) in &self.given {
            let (first, size) = (factor.first(part.node), factor.size(part.node));
            for (x, block) in x[first..first + size].iter_mut().zip(&j[part.at..]) {
                *x -= dot(block, &a[*body]);
            }
        }
        let border = factor.first(factor.border());
        x[border..].fill(0.0);
        factor.forward(x);
        if let (Some(top), Some(left)) = (self.top, x[border..].first_chunk::<BORDER>()) {
            add_scaled(&mut b[top], -1.0, left);
        }
    }

    /// The way down: the rows' `lambda`, the bodies' `a`, and what the rows push along each train.
    #[inline(always)]
    pub fn outward(&mut self, b: &[Vec6], lambda: &mut [f64], a: &mut [Vec6], pushes: &mut [f64]) {
        let Self { nodes, factor, x, .. } = self;
        let border = factor.first(factor.border());
        match self.top {
            Some(top) => x[border..].copy_from_slice(&a[top]),
            None => x[border..].fill(0.0),
        }
        factor.backward(x);
        for (index, node) in nodes.iter().enumerate() {
            let (first, size) = (factor.first(index), factor.size(index));
            lambda[node.at..node.at + size].copy_from_slice(&x[first..first + size]);
        }
        for (clique, inverse) in self.bodies.iter().zip(&self.inverses) {
            let mut out = mul(inverse, &b[clique.index]);
            for part in &clique.parts {
                let (first, size) = (factor.first(part.node), factor.size(part.node));
                let x = &x[first..first + size];
                let w = &self.w[6 * part.at..][..6 * size];
                for (c, out) in out.iter_mut().enumerate() {
                    for (x, w) in x.iter().zip(&w[c * size..]) {
                        *out += w * x;
                    }
                }
            }
            a[clique.index] = out;
        }
        self.push_trains(pushes);
    }

    /// What the rows push along each train if this one, and nothing else, goes at a rate of 1 that they are not asked to keep.
    pub fn respond_to_train(&mut self, train: usize, pushes: &mut [f64]) {
        let Some(clique) = self.trains.iter().find(|clique| clique.index == train) else { return };
        self.x.fill(0.0);
        for part in &clique.parts {
            let first = self.factor.first(part.node);
            for k in 0..self.factor.size(part.node) {
                self.x[first + k] = -self.coefficients[part.at + k];
            }
        }
        self.factor.forward(&mut self.x);
        // A train stands on the ground, and so does all that it is in a loop with.
        self.x[self.factor.first(self.factor.border())..].fill(0.0);
        self.factor.backward(&mut self.x);
        self.push_trains(pushes);
    }

    #[inline(always)]
    fn push_trains(&self, pushes: &mut [f64]) {
        for clique in &self.trains {
            for part in &clique.parts {
                let first = self.factor.first(part.node);
                for k in 0..self.factor.size(part.node) {
                    pushes[clique.index] += self.x[first + k] * self.coefficients[part.at + k];
                }
            }
        }
    }
}

/// Matrix times vector, where the matrix is that of a body on which nothing hangs.
#[inline(always)]
fn mul_alone(m: &Mat6, v: &Vec6) -> Vec6 {
    let mut out = [m[0][0] * v[0], m[0][0] * v[1], m[0][0] * v[2], 0.0, 0.0, 0.0];
    for k in 3..6 {
        out[k] = m[k][3] * v[3] + m[k][4] * v[4] + m[k][5] * v[5];
    }
    out
}

/// Adds a row of J times some columns of W.
#[inline(always)]
fn add_product(entries: &mut [f64], j: &Vec6, w: &[f64]) {
    let n = entries.len();
    let (a, b, c) = (&w[..n], &w[n..2 * n], &w[2 * n..3 * n]);
    let (d, e, f) = (&w[3 * n..4 * n], &w[4 * n..5 * n], &w[5 * n..6 * n]);
    for l in 0..n {
        entries[l] += j[0] * a[l] + j[1] * b[l] + j[2] * c[l] + j[3] * d[l] + j[4] * e[l] + j[5] * f[l];
    }
}

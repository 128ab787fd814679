//! One component of a figure's graph that has loops: its elimination, in the letters of `loops.rs`.

use super::block::for_rows;
use super::graph::Component;
use super::groups::Groups;
use super::loops::{GATHERING, LoopRow, Span};
use super::sparse::{RIM, Sparse};
use super::trains::Trains;
use soffio_math::spatial::{Articulated, Mat6, NUMBERS, Vec6, add_scaled, dot, inverse, mul};

/// A joint or coupling of the component.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    pub span: Span,
    /// Where its numbers are in `g` and `lambda`.
    at: usize,
    /// Does it close a loop of those before it?
    closes: bool,
}

/// The part of a node's rows that is on one body.
#[derive(Clone, Copy, Debug)]
struct Part {
    node: usize,
    /// Which of the rows' parts it is.
    index: usize,
    /// Where its blocks begin in `j` and W, or its f.
    at: usize,
}

/// A body or a train, and the parts on it.
#[derive(Clone, Debug)]
pub(super) struct Member {
    index: usize,
    parts: Vec<Part>,
    /// Items of the blocks of each part with itself and those after it.
    items: Vec<usize>,
}

/// The component and its factor. Nothing allocates after [`Cluster::new`].
#[derive(Clone, Debug)]
pub(super) struct Cluster {
    top: Option<usize>,
    /// Parts on the top, with the items of their blocks.
    on_top: Vec<(Part, usize)>,
    /// Joints and couplings, in the order of elimination.
    pub nodes: Vec<Node>,
    bodies: Vec<Member>,
    pub trains: Vec<Member>,
    /// Parts on bodies whose a is given: driven ones, wheels of trains.
    given: Vec<(usize, Part)>,
    /// A⁻¹ by bodies; does nothing hang on each?
    inverses: Vec<Mat6>,
    leaves: Vec<bool>,
    /// J by parts and rows; W on the component's bodies by parts, column by column: six for each row.
    j: Vec<Vec6>,
    w: Vec<f64>,
    /// f of the rows by trains.
    shares: Vec<f64>,
    pub factor: Sparse,
    /// d, then λ.
    x: Vec<f64>,
}

impl Part {
    /// Copies its blocks of J.
    #[inline(always)]
    fn copy(&self, node: Node, rows: &[LoopRow], factor: &Sparse, j: &mut [Vec6]) {
        let own = &node.span.of(rows)[..factor.size(self.node)];
        for (j, row) in j[self.at..].iter_mut().zip(own) {
            *j = row.parts[self.index].1;
        }
    }
}

impl Member {
    fn new(index: usize) -> Self {
        Self { index, parts: Vec::new(), items: Vec::new() }
    }

    fn clique(&self) -> Vec<usize> {
        self.parts.iter().map(|part| part.node).collect()
    }

    /// Parts go by the order of elimination from here on.
    fn place(&mut self, places: &[usize], factor: &Sparse) {
        self.parts.iter_mut().for_each(|part| part.node = places[part.node]);
        self.parts.sort_unstable_by_key(|part| part.node);
        for (k, part) in self.parts.iter().enumerate() {
            self.items.extend(self.parts[k..].iter().map(|other| factor.place(part.node, other.node)));
        }
    }

    /// Each two parts on it, the earlier first, and the item of their block.
    fn pairs(&self) -> impl Iterator<Item = (Part, Part, usize)> {
        let pairs = self
            .parts
            .iter()
            .enumerate()
            .flat_map(|(k, part)| self.parts[k..].iter().map(move |other| (*part, *other)));
        pairs.zip(&self.items).map(|((part, other), &item)| (part, other, item))
    }
}

impl Cluster {
    /// Of a component whose joints and couplings have these rows; `hangs` says on which bodies anything hangs.
    pub fn new(
        component: &Component,
        spans: &[Span],
        rows: &[LoopRow],
        trains: &Trains,
        hangs: impl Fn(usize) -> bool,
    ) -> Self {
        let spans: Vec<Span> = component.ties.iter().map(|&tie| spans[tie]).collect();
        let mut bodies: Vec<Member> = component.bodies.iter().map(|&body| Member::new(body)).collect();
        let mut of_trains: Vec<Member> = component.trains.iter().map(|&train| Member::new(train)).collect();
        let (mut on_top, mut given, mut blocks, mut shares) = (Vec::new(), Vec::new(), 0, 0);
        // What is joined so far: the top with all that is given comes first, then the bodies.
        let mut joined = Groups::new(component.bodies.len() + 1);
        let mut closes = Vec::new();
        for (node, span) in spans.iter().enumerate() {
            // A joint of one body is one to the world.
            let mut touched = if rows[span.first].parts.len() == 1 { vec![0] } else { Vec::new() };
            for (index, &(body, _)) in rows[span.first].parts.iter().enumerate() {
                let part = Part { node, index, at: blocks };
                blocks += span.count;
                if component.top == Some(body) {
                    on_top.push(part);
                    touched.push(0);
                } else if let Some(k) = component.bodies.iter().position(|&own| own == body) {
                    bodies[k].parts.push(part);
                    touched.push(k + 1);
                } else {
                    given.push((body, part));
                    touched.push(0);
                    let train = component.trains.iter().position(|&own| trains.of(body) == Some(own));
                    let new = |&k: &usize| of_trains[k].parts.last().is_none_or(|part| part.node != node);
                    if let Some(k) = train.filter(new) {
                        of_trains[k].parts.push(Part { node, index, at: shares });
                        shares += span.count;
                    }
                }
            }
            closes.push(touched.iter().all(|&end| joined.first(end) == joined.first(touched[0])));
            joined.join_all(touched);
        }
        let members = || bodies.iter().chain(&of_trains);
        let cliques: Vec<Vec<usize>> = members().map(Member::clique).collect();
        let capacities: Vec<usize> = spans.iter().map(|span| span.count).collect();
        let mut rimmed = vec![false; spans.len()];
        on_top.iter().for_each(|part: &Part| rimmed[part.node] = true);
        let (factor, order) = Sparse::new(&capacities, &cliques, &rimmed);
        let mut places = vec![0; order.len()];
        order.iter().enumerate().for_each(|(place, &node)| places[node] = place);
        bodies.iter_mut().chain(&mut of_trains).for_each(|member| member.place(&places, &factor));
        let mut placed = |part: Part| Part { node: places[part.node], ..part };
        Self {
            top: component.top,
            on_top: on_top.into_iter().map(&mut placed).map(|p| (p, factor.place(p.node, factor.rim()))).collect(),
            nodes: order
                .iter()
                .map(|&k| Node { span: spans[k], at: rows[spans[k].first].at, closes: closes[k] })
                .collect(),
            given: given.into_iter().map(|(body, part)| (body, placed(part))).collect(),
            inverses: vec![[[0.0; 6]; 6]; bodies.len()],
            leaves: component.bodies.iter().map(|&body| !hangs(body)).collect(),
            bodies,
            trains: of_trains,
            j: vec![[0.0; 6]; blocks],
            w: vec![0.0; 6 * blocks],
            shares: vec![0.0; shares],
            x: vec![0.0; factor.unknowns()],
            factor,
        }
    }

    /// Factors K for these rows and lays what is left of them on the articulated mass of the top. Does the figure gather?
    #[inline(always)]
    pub fn factor(&mut self, rows: &[LoopRow], articulated: &mut [[f64; NUMBERS]], trains: &Trains, gathering: bool) {
        let Self { nodes, factor, j, w, .. } = self;
        factor.begin(|node| nodes[node].span.of(rows).iter().take_while(|row| row.active).count());
        for part in self.bodies.iter().flat_map(|member| &member.parts) {
            part.copy(nodes[part.node], rows, factor, j);
        }
        for (_, part) in &self.given {
            part.copy(nodes[part.node], rows, factor, j);
        }
        for (k, member) in self.bodies.iter().enumerate() {
            let mass = Articulated::of_numbers(&articulated[member.index]);
            self.inverses[k] = if self.leaves[k] { mass.inverse_alone() } else { inverse(&mass.matrix()) };
            for part in &member.parts {
                let own = &j[part.at..part.at + factor.size(part.node)];
                let columns = &mut w[6 * part.at..][..6 * own.len()];
                for (l, j) in own.iter().enumerate() {
                    let answer =
                        if self.leaves[k] { mul_alone(&self.inverses[k], j) } else { mul(&self.inverses[k], j) };
                    for c in 0..6 {
                        columns[c * own.len() + l] = answer[c];
                    }
                }
            }
            for (first, second, item) in member.pairs() {
                let (own, others) = (factor.size(first.node), factor.size(second.node));
                let (j, w) = (&j[first.at..first.at + own], &w[6 * second.at..][..6 * others]);
                for_rows!(others, others => {
                    for (k, block) in j.iter().enumerate() {
                        add_product(&mut factor.row(first.node, k, item)[..others], block, &w[..6 * others]);
                    }
                });
            }
        }
        self.add_trains(rows, trains);
        let Self { nodes, factor, .. } = self;
        for &(part, item) in &self.on_top {
            for (k, row) in nodes[part.node].span.of(rows)[..factor.size(part.node)].iter().enumerate() {
                factor.row(part.node, k, item).copy_from_slice(&row.parts[part.index].1);
            }
        }
        for (index, node) in nodes.iter().enumerate() {
            let size = factor.size(index);
            let own = &node.span.of(rows)[..size];
            for k in 0..size {
                let item = factor.own(index);
                let entries = &mut factor.row(index, k, item)[k..];
                if gathering && node.closes {
                    entries[0] *= 1.0 + GATHERING;
                }
                for (entry, row) in entries.iter_mut().zip(&own[k..]) {
                    *entry += row.compliance[k];
                }
            }
        }
        factor.factor();
        if let Some(top) = self.top {
            let (rim, item) = (factor.rim(), factor.own(factor.rim()));
            let mut left: Mat6 = [[0.0; RIM]; RIM];
            for (k, row) in left.iter_mut().enumerate() {
                row.copy_from_slice(factor.row(rim, k, item));
            }
            for (sum, left) in articulated[top].iter_mut().zip(Articulated::of_matrix(&left).numbers()) {
                *sum -= left;
            }
        }
    }

    /// Adds what trains answer.
    #[inline(always)]
    fn add_trains(&mut self, rows: &[LoopRow], trains: &Trains) {
        let Self { nodes, factor, shares, .. } = self;
        for member in &self.trains {
            for part in &member.parts {
                for (f, row) in shares[part.at..].iter_mut().zip(nodes[part.node].span.of(rows)) {
                    let own = row.parts.iter().filter_map(|part| trains.share(part));
                    *f = own.filter(|(train, _)| *train == member.index).map(|(_, f)| f).sum();
                }
            }
            for (first, second, item) in member.pairs() {
                for k in 0..factor.size(first.node) {
                    let entries = factor.row(first.node, k, item);
                    for (entry, f) in entries.iter_mut().zip(&shares[second.at..]) {
                        *entry += trains.response(member.index, shares[first.at + k], *f);
                    }
                }
            }
        }
    }

    /// The way up: what the rows push on the top into `b`. `a` has the accelerations of what is given.
    #[inline(always)]
    pub fn up(&mut self, b: &mut [Vec6], g: &[f64], a: &[Vec6]) {
        let Self { nodes, factor, j, w, x, .. } = self;
        for (index, node) in nodes.iter().enumerate() {
            let (first, size) = (factor.first(index), factor.size(index));
            x[first..first + size].copy_from_slice(&g[node.at..node.at + size]);
        }
        for member in &self.bodies {
            for part in &member.parts {
                let (first, size) = (factor.first(part.node), factor.size(part.node));
                let (x, w) = (&mut x[first..first + size], &w[6 * part.at..][..6 * size]);
                for c in 0..6 {
                    for (x, w) in x.iter_mut().zip(&w[c * size..]) {
                        *x -= w * b[member.index][c];
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
        let rim = factor.first(factor.rim());
        x[rim..].fill(0.0);
        factor.forward(x);
        if let (Some(top), Some(left)) = (self.top, x[rim..].first_chunk::<RIM>()) {
            add_scaled(&mut b[top], -1.0, left);
        }
    }

    /// The way down: the rows' `lambda`, the bodies' `a`, and what the rows push along each train.
    #[inline(always)]
    pub fn down(&mut self, b: &[Vec6], lambda: &mut [f64], a: &mut [Vec6], pushes: &mut [f64]) {
        let Self { nodes, factor, x, .. } = self;
        let rim = factor.first(factor.rim());
        match self.top {
            Some(top) => x[rim..].copy_from_slice(&a[top]),
            None => x[rim..].fill(0.0),
        }
        factor.backward(x);
        for (index, node) in nodes.iter().enumerate() {
            let (first, size) = (factor.first(index), factor.size(index));
            lambda[node.at..node.at + size].copy_from_slice(&x[first..first + size]);
        }
        for (member, inverse) in self.bodies.iter().zip(&self.inverses) {
            let mut out = mul(inverse, &b[member.index]);
            for part in &member.parts {
                let (first, size) = (factor.first(part.node), factor.size(part.node));
                let x = &x[first..first + size];
                let w = &self.w[6 * part.at..][..6 * size];
                for (c, out) in out.iter_mut().enumerate() {
                    for (x, w) in x.iter().zip(&w[c * size..]) {
                        *out += w * x;
                    }
                }
            }
            a[member.index] = out;
        }
        self.push_trains(pushes);
    }

    /// What the rows push along each train if this one, and nothing else, goes at a rate of 1 that they are not asked to keep.
    pub fn answer_train(&mut self, train: usize, pushes: &mut [f64]) {
        let Some(member) = self.trains.iter().find(|member| member.index == train) else { return };
        self.x.fill(0.0);
        for part in &member.parts {
            let first = self.factor.first(part.node);
            for k in 0..self.factor.size(part.node) {
                self.x[first + k] = -self.shares[part.at + k];
            }
        }
        self.factor.forward(&mut self.x);
        // A train stands on the ground, and so does all that it is in a loop with.
        self.x[self.factor.first(self.factor.rim())..].fill(0.0);
        self.factor.backward(&mut self.x);
        self.push_trains(pushes);
    }

    #[inline(always)]
    fn push_trains(&self, pushes: &mut [f64]) {
        for member in &self.trains {
            for part in &member.parts {
                let first = self.factor.first(part.node);
                for k in 0..self.factor.size(part.node) {
                    pushes[member.index] += self.x[first + k] * self.shares[part.at + k];
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

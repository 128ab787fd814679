//! Factor of one loop component: its rows' blocks on bodies and trains.

use super::biconnected::Component;
use super::sparse_structure::SparseFactor;
use super::{LoopRow, Span};
use crate::articulation::disjoint_sets::DisjointSets;
use crate::articulation::trains::Trains;
use soffio_math::spatial::{Mat6, Vec6};

/// A joint or coupling of the component.
#[derive(Clone, Copy, Debug)]
pub(super) struct Node {
    /// Its rows.
    pub span: Span,
    /// Where its numbers are in `g` and `lambda`.
    pub at: usize,
    /// Does it close a loop of those before it?
    pub closes: bool,
}

/// The part of a node's rows that is on one body.
#[derive(Clone, Copy, Debug)]
pub(super) struct RowBlockRef {
    /// Index of the node.
    pub node: usize,
    /// Which of the rows' parts it is.
    pub index: usize,
    /// Where its blocks begin in `j` or W, or its f.
    pub at: usize,
}

/// A body or a train, and the parts on it.
#[derive(Clone, Debug)]
pub(super) struct Clique {
    /// Index of the body or train.
    pub index: usize,
    /// Parts of rows on it.
    pub parts: Vec<RowBlockRef>,
    /// Items of the blocks of each part with itself and those after it.
    pub items: Vec<usize>,
}

/// The component and its factor. Nothing allocates after [`Cluster::new`].
#[derive(Clone, Debug)]
pub(super) struct Cluster {
    /// Body that the component hangs on, nearest to the root; `None`: the world.
    pub top: Option<usize>,
    /// Parts on the top, with the items of their blocks.
    pub on_top: Vec<(RowBlockRef, usize)>,
    /// Joints and couplings, in the order of elimination.
    pub nodes: Vec<Node>,
    /// Bodies with the parts on them.
    pub bodies: Vec<Clique>,
    /// Gear trains with the parts on them.
    pub trains: Vec<Clique>,
    /// Parts on bodies whose a is given: driven ones, wheels of trains.
    pub given: Vec<(usize, RowBlockRef)>,
    /// A⁻¹ by bodies.
    pub inverses: Vec<Mat6>,
    /// Does nothing hang on each body?
    pub leaves: Vec<bool>,
    /// J on bodies with given accelerations, by parts and rows.
    pub j: Vec<Vec6>,
    /// W by parts, column by column: six for each row.
    pub w: Vec<f64>,
    /// f of the rows by trains.
    pub coefficients: Vec<f64>,
    /// Factor of the rows' matrix.
    pub factor: SparseFactor,
    /// e, then λ.
    pub x: Vec<f64>,
}

impl Clique {
    fn new(index: usize) -> Self {
        Self { index, parts: Vec::new(), items: Vec::new() }
    }

    fn clique(&self) -> Vec<usize> {
        self.parts.iter().map(|part| part.node).collect()
    }

    /// Parts go by the order of elimination from here on.
    fn place(&mut self, places: &[usize], factor: &SparseFactor) {
        self.parts.iter_mut().for_each(|part| part.node = places[part.node]);
        self.parts.sort_unstable_by_key(|part| part.node);
        for (k, part) in self.parts.iter().enumerate() {
            self.items.extend(self.parts[k..].iter().map(|other| factor.place(part.node, other.node)));
        }
    }

    /// Each two parts on it, the earlier first, and the item of their block.
    pub fn pairs(&self) -> impl Iterator<Item = (RowBlockRef, RowBlockRef, usize)> {
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
        let mut bodies: Vec<Clique> = component.bodies.iter().map(|&body| Clique::new(body)).collect();
        let mut of_trains: Vec<Clique> = component.trains.iter().map(|&train| Clique::new(train)).collect();
        let (mut on_top, mut given, mut blocks, mut coefficients) = (Vec::new(), Vec::new(), 0, 0);
        // What is joined so far: the top with all that is given comes first, then the bodies.
        let mut joined = DisjointSets::new(component.bodies.len() + 1);
        let mut closes = Vec::new();
        for (node, span) in spans.iter().enumerate() {
            // A joint of one body is one to the world.
            let mut touched = if rows[span.first].parts.len() == 1 { vec![0] } else { Vec::new() };
            for (index, &(body, _)) in rows[span.first].parts.iter().enumerate() {
                let part = RowBlockRef { node, index, at: blocks };
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
                        of_trains[k].parts.push(RowBlockRef { node, index, at: coefficients });
                        coefficients += span.count;
                    }
                }
            }
            closes.push(touched.iter().all(|&end| joined.first(end) == joined.first(touched[0])));
            joined.join_all(touched);
        }
        let cliques_of = || bodies.iter().chain(&of_trains);
        let cliques: Vec<Vec<usize>> = cliques_of().map(Clique::clique).collect();
        let capacities: Vec<usize> = spans.iter().map(|span| span.count).collect();
        let mut bordered = vec![false; spans.len()];
        on_top.iter().for_each(|part: &RowBlockRef| bordered[part.node] = true);
        let (factor, order) = SparseFactor::new(&capacities, &cliques, &bordered);
        let mut places = vec![0; order.len()];
        order.iter().enumerate().for_each(|(place, &node)| places[node] = place);
        bodies.iter_mut().chain(&mut of_trains).for_each(|member| member.place(&places, &factor));
        let mut placed = |part: RowBlockRef| RowBlockRef { node: places[part.node], ..part };
        Self {
            top: component.top,
            on_top: on_top.into_iter().map(&mut placed).map(|p| (p, factor.place(p.node, factor.border()))).collect(),
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
            coefficients: vec![0.0; coefficients],
            x: vec![0.0; factor.unknowns()],
            factor,
        }
    }
}

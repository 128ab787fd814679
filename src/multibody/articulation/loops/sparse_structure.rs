//! Sparse block factorisation A = Uᵀ D U of a symmetric positive semi-definite matrix in minimum-degree order.
//!
//! Unknowns come in *nodes* (the rows of a joint), of which cliques are given: all pairs in a clique may have a block in A.
//! Eliminating a node makes a clique of those that it has blocks with. The order is found once: next is always the node that
//! stands with the fewest unknowns (W. Tinney, J. Walker, Proc. IEEE 55, 1967), so that loops side by side cost what one costs,
//! and a net of n knots about n^1.5. A *panel* holds the rows of U of one node: its own columns, then those of the nodes that come
//! later and have blocks with it, in order. With the panel P of a node, pivots D,
//!
//! ```text
//! A ← A − Pᵀ D⁻¹ P        among the later nodes
//! ```
//!
//! After all nodes comes the *rim*: six columns B beside A, that are not eliminated. Their Schur complement is −Bᵀ A⁻¹ B, and of
//! a right-hand side d there −Bᵀ A⁻¹ d.
//!
//! A pivot that is a tiny share of what its row had before says that the row repeats others: it gets 0, so that its
//! unknown comes out 0 and the others share the work. Sizes of nodes may change from factor to factor up to their capacity.
//! Nothing allocates after [`SparseFactor::new`].

use std::collections::BTreeSet;

/// Columns of the rim.
pub const BORDER: usize = 6;

/// Columns that follow each other in two panels.
#[derive(Clone, Copy, Debug)]
pub(super) struct ColumnRun {
    /// First item of the eliminated node's panel.
    pub from: usize,
    /// Number of items.
    pub count: usize,
    /// First item of the panel that is changed.
    pub to: usize,
}

/// Structure and factor.
#[derive(Clone, Debug)]
pub(super) struct SparseFactor {
    /// Where the items of each node's panel begin: itself, later nodes, the rim.
    pub begins: Vec<usize>,
    /// The node of each item.
    pub items: Vec<usize>,
    /// Its first column in the panel; counted again where sizes change.
    pub columns: Vec<usize>,
    /// Where the runs of each item begin in `runs`.
    pub run_begins: Vec<usize>,
    /// The runs of all items.
    pub runs: Vec<ColumnRun>,
    /// Number of unknowns of each node now.
    pub sizes: Vec<usize>,
    /// Number of columns of each node's panel.
    pub widths: Vec<usize>,
    /// Where each node's unknowns begin.
    pub unknowns: Vec<usize>,
    /// Where each node's panel begins in `entries`.
    pub panels: Vec<usize>,
    /// Entries of all panels.
    pub entries: Vec<f64>,
    /// 1/D, or 0.
    pub pivots: Vec<f64>,
}

/// The order of elimination of these cliques' nodes, and with each the nodes that come later and have blocks with it.
fn least_degree(capacities: &[usize], cliques: &[Vec<usize>], bordered: &[bool]) -> (Vec<usize>, Vec<Vec<usize>>) {
    let n = capacities.len();
    let mut beside = vec![BTreeSet::new(); n];
    let join = |beside: &mut Vec<BTreeSet<usize>>, clique: &[usize]| {
        for &node in clique {
            beside[node].extend(clique.iter().copied().filter(|&other| other != node));
        }
    };
    cliques.iter().for_each(|clique| join(&mut beside, clique));
    let mut bordered = bordered.to_vec();
    let degree = |beside: &[BTreeSet<usize>], bordered: &[bool], node: usize| {
        beside[node].iter().map(|&other| capacities[other]).sum::<usize>() + if bordered[node] { BORDER } else { 0 }
    };
    let mut waiting: BTreeSet<(usize, usize)> = (0..n).map(|node| (degree(&beside, &bordered, node), node)).collect();
    let (mut order, mut later) = (Vec::with_capacity(n), vec![Vec::new(); n]);
    while let Some((_, node)) = waiting.pop_first() {
        let clique: Vec<usize> = beside[node].iter().copied().collect();
        for &other in &clique {
            waiting.remove(&(degree(&beside, &bordered, other), other));
        }
        join(&mut beside, &clique);
        for &other in &clique {
            beside[other].remove(&node);
            bordered[other] |= bordered[node];
        }
        for &other in &clique {
            waiting.insert((degree(&beside, &bordered, other), other));
        }
        order.push(node);
        later[node] = clique;
        if bordered[node] {
            later[node].push(n);
        }
    }
    (order, later)
}

impl SparseFactor {
    /// Structure of nodes of these capacities, with blocks among those of a clique, and beside the rim where `rimmed`. The nodes
    /// are counted in the order of elimination from here on; returned is which of those given each of them is.
    pub fn new(capacities: &[usize], cliques: &[Vec<usize>], bordered: &[bool]) -> (Self, Vec<usize>) {
        let n = capacities.len();
        let (order, later) = least_degree(capacities, cliques, bordered);
        // The rim comes last.
        let mut place = vec![n; n + 1];
        order.iter().enumerate().for_each(|(at, &node)| place[node] = at);
        let capacity = |at: usize| order.get(at).map_or(BORDER, |&node| capacities[node]);
        let mut sparse = Self {
            begins: vec![0],
            items: Vec::new(),
            columns: Vec::new(),
            run_begins: vec![0],
            runs: Vec::new(),
            sizes: vec![0; n + 1],
            widths: vec![0; n + 1],
            unknowns: vec![0],
            panels: vec![0],
            entries: Vec::new(),
            pivots: Vec::new(),
        };
        for (at, node) in order.iter().copied().chain([n]).enumerate() {
            let mut items = vec![at];
            items.extend(later.get(node).into_iter().flatten().map(|&other| place[other]));
            items.sort_unstable();
            let width: usize = items.iter().map(|&item| capacity(item)).sum();
            sparse.unknowns.push(sparse.unknowns[at] + capacity(at));
            sparse.panels.push(sparse.panels[at] + capacity(at) * width);
            sparse.items.extend(items);
            sparse.begins.push(sparse.items.len());
        }
        sparse.columns.resize(sparse.items.len(), 0);
        for at in 0..=n {
            sparse.find_runs(at);
        }
        sparse.entries.resize(sparse.panels[n + 1], 0.0);
        sparse.pivots.resize(sparse.unknowns[n + 1], 0.0);
        (sparse, order)
    }

    /// For each item of a node's panel, where that panel's later items are in the item's own.
    fn find_runs(&mut self, at: usize) {
        let items = self.begins[at]..self.begins[at + 1];
        for first in items.clone() {
            let own = if first == items.start { items.end } else { first };
            let mut last: Option<ColumnRun> = None;
            for item in own..items.end {
                let to = self.place(self.items[first], self.items[item]);
                match &mut last {
                    Some(run) if run.to + run.count == to => run.count += 1,
                    _ => {
                        self.runs.extend(last);
                        last = Some(ColumnRun { from: item, count: 1, to });
                    }
                }
            }
            self.runs.extend(last);
            self.run_begins.push(self.runs.len());
        }
    }

    /// Which item a later node (or itself) is in a node's panel.
    ///
    /// # Panics
    /// Where the two have no block.
    pub fn place(&self, node: usize, other: usize) -> usize {
        let items = &self.items[self.begins[node]..self.begins[node + 1]];
        let found = items.binary_search(&other);
        self.begins[node] + found.unwrap_or_else(|_| panic!("nodes {node} and {other} have no block"))
    }

    /// Which item a node is in its own panel.
    #[inline(always)]
    pub fn own(&self, node: usize) -> usize {
        self.begins[node]
    }

    /// How many nodes there are; also the number of the rim.
    pub fn border(&self) -> usize {
        self.sizes.len() - 1
    }

    /// How many numbers the factor has room for.
    pub fn numbers(&self) -> usize {
        self.entries.len()
    }

    /// How many unknowns there is room for, the rim's among them.
    pub fn unknowns(&self) -> usize {
        self.pivots.len()
    }

    /// Where the unknowns of a node begin.
    #[inline(always)]
    pub fn first(&self, node: usize) -> usize {
        self.unknowns[node]
    }

    /// Unknowns of a node now.
    #[inline(always)]
    pub fn size(&self, node: usize) -> usize {
        self.sizes[node]
    }

    /// Begins a matrix of nothing, with nodes of these sizes.
    #[inline(always)]
    pub fn begin(&mut self, size: impl Fn(usize) -> usize) {
        let mut same = self.sizes[self.border()] == BORDER;
        for node in 0..self.border() {
            let size = size(node);
            same &= self.sizes[node] == size;
            self.sizes[node] = size;
        }
        if !same {
            self.place_columns();
        }
        for node in 0..=self.border() {
            let begin = self.panels[node];
            self.entries[begin..begin + self.sizes[node] * self.widths[node]].fill(0.0);
        }
    }

    /// Counts columns for the present sizes.
    fn place_columns(&mut self) {
        let border = self.border();
        self.sizes[border] = BORDER;
        for node in 0..=border {
            let mut width = 0;
            for item in self.begins[node]..self.begins[node + 1] {
                self.columns[item] = width;
                width += self.sizes[self.items[item]];
            }
            self.widths[node] = width;
        }
    }

    /// The columns of an item in one row of a node's panel.
    #[inline(always)]
    pub fn row(&mut self, node: usize, k: usize, item: usize) -> &mut [f64] {
        let begin = self.panels[node] + k * self.widths[node] + self.columns[item];
        &mut self.entries[begin..begin + self.sizes[self.items[item]]]
    }

    /// The number on the diagonal of a node's row.
    #[inline(always)]
    pub fn diagonal(&mut self, node: usize, k: usize) -> &mut f64 {
        &mut self.entries[self.panels[node] + k * (self.widths[node] + 1)]
    }
}

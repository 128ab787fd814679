//! A sparse factor A = Uᵀ D U of a symmetric positive semi-definite matrix of blocks, in an order of least degree.
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
//! After all nodes comes the *rim*: six columns B beside A, that are not eliminated. What is left of them is −Bᵀ A⁻¹ B, and of
//! a right-hand side d there −Bᵀ A⁻¹ d.
//!
//! A pivot that is a tiny share of what its row had before says that the row repeats others: it gets 0, so that its
//! unknown comes out 0 and the others share the work. Sizes of nodes may change from factor to factor up to their capacity.
//! Nothing allocates after [`Sparse::new`].

use std::collections::BTreeSet;

/// A pivot below this share of its row alone says that the row repeats others: far above what rounding leaves of it, far below
/// what a light body between heavy ones has.
const REDUNDANT: f64 = 1e-9;
/// Columns of the rim.
pub const RIM: usize = 6;

/// Calls a method for the rows of a node: all at once where joints often have so many, else one by one.
macro_rules! rows_at_once {
    ($size:expr, $each:expr, $sparse:ident.$method:ident($node:expr $(, $x:expr)?)) => {
        match $size {
            3 => $sparse.$method::<3>($node, 0 $(, $x)?),
            4 => $sparse.$method::<4>($node, 0 $(, $x)?),
            5 => $sparse.$method::<5>($node, 0 $(, $x)?),
            6 => $sparse.$method::<6>($node, 0 $(, $x)?),
            _ => {
                for k in $each {
                    $sparse.$method::<1>($node, k $(, $x)?);
                }
            }
        }
    };
}

/// Columns that follow each other in two panels.
#[derive(Clone, Copy, Debug)]
struct Run {
    /// First item of the eliminated node's panel, and how many.
    from: usize,
    count: usize,
    /// First item of the panel that is changed.
    to: usize,
}

/// Structure and factor.
#[derive(Clone, Debug)]
pub struct Sparse {
    /// Where the items of each node's panel begin: itself, later nodes, the rim.
    begins: Vec<usize>,
    /// The node of each item.
    items: Vec<usize>,
    /// Its first column in the panel; counted anew where sizes change.
    columns: Vec<usize>,
    /// Where the runs of each item begin, and the runs.
    run_begins: Vec<usize>,
    runs: Vec<Run>,
    /// Unknowns of each node now, columns of its panel, where its unknowns and its panel begin.
    sizes: Vec<usize>,
    widths: Vec<usize>,
    unknowns: Vec<usize>,
    panels: Vec<usize>,
    entries: Vec<f64>,
    /// 1/D, or 0.
    pivots: Vec<f64>,
}

/// The order of elimination of these cliques' nodes, and with each the nodes that come later and have blocks with it.
fn least_degree(capacities: &[usize], cliques: &[Vec<usize>], rimmed: &[bool]) -> (Vec<usize>, Vec<Vec<usize>>) {
    let n = capacities.len();
    let mut beside = vec![BTreeSet::new(); n];
    let join = |beside: &mut Vec<BTreeSet<usize>>, clique: &[usize]| {
        for &node in clique {
            beside[node].extend(clique.iter().copied().filter(|&other| other != node));
        }
    };
    cliques.iter().for_each(|clique| join(&mut beside, clique));
    let mut rimmed = rimmed.to_vec();
    let degree = |beside: &[BTreeSet<usize>], rimmed: &[bool], node: usize| {
        beside[node].iter().map(|&other| capacities[other]).sum::<usize>() + if rimmed[node] { RIM } else { 0 }
    };
    let mut waiting: BTreeSet<(usize, usize)> = (0..n).map(|node| (degree(&beside, &rimmed, node), node)).collect();
    let (mut order, mut later) = (Vec::with_capacity(n), vec![Vec::new(); n]);
    while let Some((_, node)) = waiting.pop_first() {
        let clique: Vec<usize> = beside[node].iter().copied().collect();
        for &other in &clique {
            waiting.remove(&(degree(&beside, &rimmed, other), other));
        }
        join(&mut beside, &clique);
        for &other in &clique {
            beside[other].remove(&node);
            rimmed[other] |= rimmed[node];
        }
        for &other in &clique {
            waiting.insert((degree(&beside, &rimmed, other), other));
        }
        order.push(node);
        later[node] = clique;
        if rimmed[node] {
            later[node].push(n);
        }
    }
    (order, later)
}

impl Sparse {
    /// Structure of nodes of these capacities, with blocks among those of a clique, and beside the rim where `rimmed`. The nodes
    /// are counted in the order of elimination from here on; returned is which of those given each of them is.
    pub fn new(capacities: &[usize], cliques: &[Vec<usize>], rimmed: &[bool]) -> (Self, Vec<usize>) {
        let n = capacities.len();
        let (order, later) = least_degree(capacities, cliques, rimmed);
        // The rim comes last.
        let mut place = vec![n; n + 1];
        order.iter().enumerate().for_each(|(at, &node)| place[node] = at);
        let capacity = |at: usize| order.get(at).map_or(RIM, |&node| capacities[node]);
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
            let mut last: Option<Run> = None;
            for item in own..items.end {
                let to = self.place(self.items[first], self.items[item]);
                match &mut last {
                    Some(run) if run.to + run.count == to => run.count += 1,
                    _ => {
                        self.runs.extend(last);
                        last = Some(Run { from: item, count: 1, to });
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
    pub fn rim(&self) -> usize {
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
        let mut same = self.sizes[self.rim()] == RIM;
        for node in 0..self.rim() {
            let size = size(node);
            same &= self.sizes[node] == size;
            self.sizes[node] = size;
        }
        if !same {
            self.lay_out();
        }
        for node in 0..=self.rim() {
            let begin = self.panels[node];
            self.entries[begin..begin + self.sizes[node] * self.widths[node]].fill(0.0);
        }
    }

    /// Counts columns for the present sizes.
    fn lay_out(&mut self) {
        let rim = self.rim();
        self.sizes[rim] = RIM;
        for node in 0..=rim {
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

    /// Factors in place.
    #[inline(always)]
    pub fn factor(&mut self) {
        // What each row has before stands where its pivot will.
        for node in 0..self.rim() {
            for k in 0..self.sizes[node] {
                self.pivots[self.unknowns[node] + k] = *self.diagonal(node, k);
            }
        }
        for node in 0..self.rim() {
            self.eliminate_rows(node);
            rows_at_once!(self.sizes[node], 0..self.sizes[node], self.pass_on(node));
        }
    }

    /// Makes the rows of a node's panel those of U.
    #[inline(always)]
    fn eliminate_rows(&mut self, node: usize) {
        let (width, first) = (self.widths[node], self.unknowns[node]);
        let panel = &mut self.entries[self.panels[node]..][..self.sizes[node] * width];
        for l in 0..self.sizes[node] {
            let (upper, lower) = panel.split_at_mut(l * width);
            let (row, pivots) = (&mut lower[l..width], &mut self.pivots[first..=first + l]);
            match l {
                0 => {}
                1 => subtract_upper::<1>(row, upper, (width, l), pivots),
                2 => subtract_upper::<2>(row, upper, (width, l), pivots),
                3 => subtract_upper::<3>(row, upper, (width, l), pivots),
                4 => subtract_upper::<4>(row, upper, (width, l), pivots),
                5 => subtract_upper::<5>(row, upper, (width, l), pivots),
                _ => {
                    for k in 0..l {
                        subtract_upper::<1>(row, &upper[k * width..], (width, l), &pivots[k..]);
                    }
                }
            }
            let held = row[0] > REDUNDANT * pivots[l];
            pivots[l] = if held { 1.0 / row[0] } else { 0.0 };
        }
    }

    /// Takes N rows of a node, from the `k`th on, from what the later nodes have among each other.
    #[inline(always)]
    fn pass_on<const N: usize>(&mut self, node: usize, k: usize) {
        let (done, rest) = self.entries.split_at_mut(self.panels[node + 1]);
        let width = self.widths[node];
        let panel = &done[self.panels[node] + k * width..];
        let pivots = &self.pivots[self.unknowns[node] + k..][..N];
        let mut rows = [panel; N];
        for (k, row) in rows.iter_mut().enumerate() {
            *row = &panel[k * width..][..width];
        }
        for item in self.begins[node] + 1..self.begins[node + 1] {
            let other = self.items[item];
            let runs = &self.runs[self.run_begins[item]..self.run_begins[item + 1]];
            let (begin, others) = (self.panels[other] - self.panels[node + 1], self.widths[other]);
            for b in 0..self.sizes[other] {
                let (row, column) = (&mut rest[begin + b * others..][..others], self.columns[item] + b);
                let mut shares = [0.0; N];
                for k in 0..N {
                    shares[k] = rows[k][column] * pivots[k];
                }
                for run in runs {
                    let (from, last) = (self.columns[run.from], run.from + run.count - 1);
                    let count = self.columns[last] + self.sizes[self.items[last]] - from;
                    subtract(&mut row[self.columns[run.to]..][..count], &shares, &rows, from);
                }
            }
        }
    }

    /// Was a row left out?
    pub fn is_redundant(&self, node: usize, k: usize) -> bool {
        k < self.sizes[node] && self.pivots[self.unknowns[node] + k] == 0.0
    }

    /// N rows of a node's panel, from the `k`th on.
    #[inline(always)]
    fn rows<const N: usize>(&self, node: usize, k: usize) -> [&[f64]; N] {
        let width = self.widths[node];
        let panel = &self.entries[self.panels[node] + k * width..];
        let mut rows = [panel; N];
        for (k, row) in rows.iter_mut().enumerate() {
            *row = &panel[k * width..][..width];
        }
        rows
    }

    /// The way on: what each right-hand side leaves to the later ones.
    #[inline(always)]
    pub fn forward(&self, x: &mut [f64]) {
        for node in 0..self.rim() {
            rows_at_once!(self.sizes[node], 0..self.sizes[node], self.forward_of(node, x));
        }
    }

    #[inline(always)]
    fn forward_of<const N: usize>(&self, node: usize, k: usize, x: &mut [f64]) {
        let (rows, first) = (self.rows::<N>(node, k), self.unknowns[node] + k);
        let (done, rest) = x.split_at_mut(self.unknowns[node + 1]);
        let own = &mut done[first..][..self.sizes[node] - k];
        let mut shares = [0.0; N];
        for m in 0..N {
            shares[m] = own[m] * self.pivots[first + m];
            for l in m + 1..own.len() {
                own[l] -= shares[m] * rows[m][k + l];
            }
        }
        for item in self.begins[node] + 1..self.begins[node + 1] {
            let other = self.items[item];
            let to = self.unknowns[other] - self.unknowns[node + 1];
            subtract(&mut rest[to..to + self.sizes[other]], &shares, &rows, self.columns[item]);
        }
    }

    /// The way back: the unknowns, where those of the rim are given.
    #[inline(always)]
    pub fn backward(&self, x: &mut [f64]) {
        for node in (0..self.rim()).rev() {
            rows_at_once!(self.sizes[node], (0..self.sizes[node]).rev(), self.backward_of(node, x));
        }
    }

    #[inline(always)]
    fn backward_of<const N: usize>(&self, node: usize, k: usize, x: &mut [f64]) {
        let (rows, first) = (self.rows::<N>(node, k), self.unknowns[node] + k);
        let (done, rest) = x.split_at_mut(self.unknowns[node + 1]);
        let own = &mut done[first..][..self.sizes[node] - k];
        let mut sums = [0.0; N];
        for item in self.begins[node] + 1..self.begins[node + 1] {
            let other = self.items[item];
            let from = self.unknowns[other] - self.unknowns[node + 1];
            add_products(&mut sums, &rest[from..from + self.sizes[other]], &rows, self.columns[item]);
        }
        for m in (0..N).rev() {
            let mut sum = own[m] - sums[m];
            for l in m + 1..own.len() {
                sum -= rows[m][k + l] * own[l];
            }
            own[m] = sum * self.pivots[first + m];
        }
    }
}

/// Adds rows times x, as far as x goes, the rows from a column on.
#[inline(always)]
fn add_products<const N: usize>(sums: &mut [f64; N], x: &[f64], rows: &[&[f64]; N], from: usize) {
    let n = x.len();
    let mut cut = *rows;
    for row in &mut cut {
        *row = &row[from..from + n];
    }
    for i in 0..n {
        for k in 0..N {
            sums[k] += cut[k][i] * x[i];
        }
    }
}

/// Takes the first N rows of a panel of some width from a later one, that is given from a column on.
#[inline(always)]
fn subtract_upper<const N: usize>(row: &mut [f64], panel: &[f64], (width, column): (usize, usize), pivots: &[f64]) {
    let (mut rows, mut shares) = ([panel; N], [0.0; N]);
    for k in 0..N {
        rows[k] = &panel[k * width..][..width];
        shares[k] = rows[k][column] * pivots[k];
    }
    subtract(row, &shares, &rows, column);
}

/// x − Σ shares · rows, as far as x goes, the rows from a column on.
#[inline(always)]
fn subtract<const N: usize>(x: &mut [f64], shares: &[f64; N], rows: &[&[f64]; N], from: usize) {
    let n = x.len();
    let mut cut = *rows;
    for row in &mut cut {
        *row = &row[from..from + n];
    }
    for i in 0..n {
        let mut sum = x[i];
        for k in 0..N {
            sum -= shares[k] * cut[k][i];
        }
        x[i] = sum;
    }
}

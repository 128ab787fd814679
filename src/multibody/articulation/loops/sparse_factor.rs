//! Numeric factorisation and triangular solves of the sparse factor (`sparse_structure.rs`).

use super::sparse_structure::SparseFactor;

/// A pivot below this share of its row alone says that the row repeats others: far above what rounding leaves of it, far below
/// what a light body between heavy ones has.
const REDUNDANT: f64 = 1e-9;

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

impl SparseFactor {
    /// Factors in place.
    #[inline(always)]
    pub fn factor(&mut self) {
        // What each row has before stands where its pivot will.
        for node in 0..self.border() {
            for k in 0..self.sizes[node] {
                self.pivots[self.unknowns[node] + k] = *self.diagonal(node, k);
            }
        }
        for node in 0..self.border() {
            self.eliminate_rows(node);
            rows_at_once!(self.sizes[node], 0..self.sizes[node], self.update_later(node));
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
            let independent = row[0] > REDUNDANT * pivots[l];
            pivots[l] = if independent { 1.0 / row[0] } else { 0.0 };
        }
    }

    /// Takes N rows of a node, from the `k`th on, from what the later nodes have among each other.
    #[inline(always)]
    fn update_later<const N: usize>(&mut self, node: usize, k: usize) {
        let (done, later) = self.entries.split_at_mut(self.panels[node + 1]);
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
                let (row, column) = (&mut later[begin + b * others..][..others], self.columns[item] + b);
                let mut multipliers = [0.0; N];
                for k in 0..N {
                    multipliers[k] = rows[k][column] * pivots[k];
                }
                for run in runs {
                    let (from, last) = (self.columns[run.from], run.from + run.count - 1);
                    let count = self.columns[last] + self.sizes[self.items[last]] - from;
                    subtract(&mut row[self.columns[run.to]..][..count], &multipliers, &rows, from);
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
        for node in 0..self.border() {
            rows_at_once!(self.sizes[node], 0..self.sizes[node], self.forward_of(node, x));
        }
    }

    #[inline(always)]
    fn forward_of<const N: usize>(&self, node: usize, k: usize, x: &mut [f64]) {
        let (rows, first) = (self.rows::<N>(node, k), self.unknowns[node] + k);
        let (done, later) = x.split_at_mut(self.unknowns[node + 1]);
        let own = &mut done[first..][..self.sizes[node] - k];
        let mut multipliers = [0.0; N];
        for m in 0..N {
            multipliers[m] = own[m] * self.pivots[first + m];
            for l in m + 1..own.len() {
                own[l] -= multipliers[m] * rows[m][k + l];
            }
        }
        for item in self.begins[node] + 1..self.begins[node + 1] {
            let other = self.items[item];
            let to = self.unknowns[other] - self.unknowns[node + 1];
            subtract(&mut later[to..to + self.sizes[other]], &multipliers, &rows, self.columns[item]);
        }
    }

    /// The way back: the unknowns, where those of the rim are given.
    #[inline(always)]
    pub fn backward(&self, x: &mut [f64]) {
        for node in (0..self.border()).rev() {
            rows_at_once!(self.sizes[node], (0..self.sizes[node]).rev(), self.backward_of(node, x));
        }
    }

    #[inline(always)]
    fn backward_of<const N: usize>(&self, node: usize, k: usize, x: &mut [f64]) {
        let (rows, first) = (self.rows::<N>(node, k), self.unknowns[node] + k);
        let (done, later) = x.split_at_mut(self.unknowns[node + 1]);
        let own = &mut done[first..][..self.sizes[node] - k];
        let mut sums = [0.0; N];
        for item in self.begins[node] + 1..self.begins[node + 1] {
            let other = self.items[item];
            let from = self.unknowns[other] - self.unknowns[node + 1];
            add_products(&mut sums, &later[from..from + self.sizes[other]], &rows, self.columns[item]);
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
    let (mut rows, mut multipliers) = ([panel; N], [0.0; N]);
    for k in 0..N {
        rows[k] = &panel[k * width..][..width];
        multipliers[k] = rows[k][column] * pivots[k];
    }
    subtract(row, &multipliers, &rows, column);
}

/// x − Σ shares · rows, as far as x goes, the rows from a column on.
#[inline(always)]
fn subtract<const N: usize>(x: &mut [f64], multipliers: &[f64; N], rows: &[&[f64]; N], from: usize) {
    let n = x.len();
    let mut cut = *rows;
    for row in &mut cut {
        *row = &row[from..from + n];
    }
    for i in 0..n {
        let mut sum = x[i];
        for k in 0..N {
            sum -= multipliers[k] * cut[k][i];
        }
        x[i] = sum;
    }
}

//! Closed loops and couplings: the rows that a tree cannot hold, by a small dense system (Baraff 1996, second half).
//!
//! Let H be the tree's system and G the rows of the joints that close loops. Their multipliers μ obey
//!
//! ```text
//! S μ = g − G a₀        S = G R + Γ        R = H⁻¹ Gᵀ        a = a₀ + R μ
//! ```
//!
//! with a₀ the tree's own answer. Only the *skeleton* matters for S and G a₀: the bodies on the ways from the loops'
//! bodies to their roots. So a loop row costs a walk over the skeleton when factored, and a solve costs one way up
//! and one way down over all bodies whatever the number of loops, plus walks over the skeleton.
//!
//! Rows that repeat others (a planar four-bar of hinges has three) get the multiplier 0, as in the tree.

use std::ops::Range;

use super::block::RowVec;
use super::cholesky::Cholesky;
use super::quads::Quads;
use super::quads::response;
use super::trains::Trains;
use super::tree::Tree;
use soffio_math::spatial::{Vec6, add_scaled, dot};

/// A pivot below this share of its row's answer alone says that the row repeats others. Loop rows pass
/// through a whole tree solve, so more is rounded off than within one joint.
const REDUNDANT: f64 = 1e-9;

/// Γ of rows outside the tree while a figure gathers, as a share of their answer alone. On its way together a figure
/// passes places where its rows almost repeat each other but do not agree; what little holds them there must not decide.
pub const GATHERING: f64 = 1e-4;

/// One row outside the tree, at the present configuration.
#[derive(Clone, Debug)]
pub struct LoopRow {
    /// Where its numbers are in `g` and `lambda`.
    pub at: usize,
    /// Does it act now?
    pub active: bool,
    /// J: a block per body that it touches.
    pub parts: Vec<(usize, Vec6)>,
    /// Which row of its joint it is; those before it stand before it here.
    pub place: usize,
    /// Γ with the rows of its joint, from the first to itself.
    pub compliance: RowVec,
    /// Is it a coupling of a train, which the train itself holds?
    pub held: bool,
    /// J M⁻¹ Jᵀ with the mass of its bodies alone, when it was last asked: a measure, which need not be of this moment.
    pub alone: f64,
}

impl LoopRow {
    /// Is it between bodies that sleep?
    pub fn sleeps(&self, asleep: &[bool]) -> bool {
        self.parts.iter().any(|(body, _)| asleep[*body])
    }

    /// Adds the Γ of the `k`th acting row to a matrix.
    #[inline(always)]
    pub fn add_compliance(&self, k: usize, matrix: &mut Cholesky) {
        for (l, gamma) in self.compliance[..=self.place].iter().enumerate() {
            *matrix.entry(k, k - self.place + l) += gamma;
        }
    }

    /// Row times the bodies' coordinates.
    #[inline(always)]
    fn times(&self, a: &[Vec6]) -> f64 {
        self.parts.iter().map(|(body, block)| dot(block, &a[*body])).sum()
    }
}

/// The loop rows of a figure and their factor.
#[derive(Clone, Debug)]
pub struct Loops {
    /// Every row that there may be.
    pub rows: Vec<LoopRow>,
    driven: Vec<bool>,
    skeleton: Vec<usize>,
    /// Which rows touch the skeleton, and not trains alone.
    hangs: Vec<bool>,
    /// Numbers of the joints by which the skeleton's bodies hang.
    numbers: Vec<Range<usize>>,
    /// Bodies of trains that rows touch, how many trains there are, and f of the active rows, row by row.
    carried: Vec<usize>,
    trains: usize,
    shares: Vec<f64>,
    /// What the rows push along each train.
    pushes: Vec<f64>,
    /// What they push along each train for a rate of each that they are not asked to keep; empty until it is asked for.
    answers: Vec<f64>,
    /// Indices of the active rows.
    active: Vec<usize>,
    factor: Cholesky,
    mu: Vec<f64>,
    b: Vec<Vec6>,
    a: Vec<Vec6>,
    h: Vec<f64>,
}

impl Loops {
    /// Room for these rows; `count` numbers are in `lambda`, `numbers` says where a joint's are.
    pub fn new(
        rows: Vec<LoopRow>,
        (tree, trains): (&Tree, &Trains),
        driven: &[bool],
        (count, numbers): (usize, impl Fn(usize) -> Range<usize>),
    ) -> Self {
        let n = rows.len();
        let room = if n > 0 { driven.len() } else { 0 };
        let own = rows.iter().filter(|row| !row.held);
        let touched = own.flat_map(|row| row.parts.iter().map(|(body, _)| *body));
        let ways = tree.paths(touched);
        let (carried, skeleton): (Vec<usize>, Vec<usize>) = ways.into_iter().partition(|&body| trains.has(body));
        let hangs = rows.iter().map(|row| row.parts.iter().any(|(body, _)| skeleton.contains(body))).collect();
        Self {
            hangs,
            numbers: skeleton.iter().filter_map(|&body| tree.joint_of(body)).map(numbers).collect(),
            skeleton,
            carried,
            trains: trains.count(),
            shares: vec![0.0; n * trains.count()],
            pushes: vec![0.0; trains.count()],
            answers: Vec::with_capacity(trains.count() * trains.count()),
            driven: driven.to_vec(),
            active: Vec::with_capacity(n),
            factor: Cholesky::with_room(n, REDUNDANT),
            mu: vec![0.0; n],
            b: vec![[0.0; 6]; room],
            a: vec![[0.0; 6]; room],
            h: vec![0.0; if n > 0 { count } else { 0 }],
            rows,
        }
    }

    /// Was this row found to repeat others at the last factorisation?
    pub fn is_redundant(&self, row: usize) -> bool {
        self.active.iter().position(|&r| r == row).is_some_and(|k| self.factor.is_redundant(k))
    }

    /// Factors S for the active rows; the tree must have been factored for these bodies. Does the figure gather? Are
    /// the rows' own answers to be measured anew?
    #[inline(always)]
    pub fn factor(&mut self, (tree, trains): (&Tree, &Trains), quads: &Quads, (gathering, anew): (bool, bool)) {
        for &body in &self.carried {
            (self.a[body], self.b[body]) = ([0.0; 6], [0.0; 6]);
        }
        self.answers.clear();
        self.active.clear();
        self.active.extend((0..self.rows.len()).filter(|&row| self.rows[row].active));
        let n = self.active.len();
        if self.trains > 0 {
            for (k, &row) in self.active.iter().enumerate() {
                let shares = &mut self.shares[k * self.trains..][..self.trains];
                shares.fill(0.0);
                for (train, f) in self.rows[row].parts.iter().filter_map(|part| trains.share(part)) {
                    shares[train] += f;
                }
            }
        }
        self.factor.begin(n);
        for l in 0..n {
            for &body in &self.skeleton {
                self.b[body] = [0.0; 6];
                self.a[body] = [0.0; 6];
            }
            if self.hangs[self.active[l]] {
                for (body, block) in &self.rows[self.active[l]].parts {
                    add_scaled(&mut self.b[*body], 1.0, block);
                }
                for &body in self.skeleton.iter().rev() {
                    tree.up(body, &mut self.b, None, &mut self.h);
                }
                for &body in &self.skeleton {
                    tree.down(body, &self.b, None, &mut self.h, &mut self.a);
                }
            }
            for k in l..n {
                let (f, g) = (&self.shares[k * self.trains..], &self.shares[l * self.trains..]);
                let mut both = 0.0;
                for (train, (f, g)) in f.iter().zip(g).take(self.trains).enumerate() {
                    if *f != 0.0 && *g != 0.0 {
                        both += trains.response(train, *f, *g);
                    }
                }
                *self.factor.entry(k, l) = self.rows[self.active[k]].times(&self.a) + both;
            }
        }
        for k in 0..n {
            let row = &mut self.rows[self.active[k]];
            if anew {
                row.alone = response(&row.parts, &self.driven, quads);
            }
            self.factor.measure(k, row.alone);
            *self.factor.entry(k, k) += if gathering { GATHERING * row.alone } else { 0.0 };
            row.add_compliance(k, &mut self.factor);
        }
        self.factor.factor();
    }

    /// Between the tree's way up (`b`, `lambda`) and its way down: finds μ and lays Gᵀ μ on `b` and `lambda`, so that
    /// the way down gives the whole answer. `a` lends the given accelerations of driven bodies.
    #[inline(always)]
    pub fn correct(&mut self, tree: &Tree, b: &mut [Vec6], g: &[f64], a: &[Vec6], lambda: &mut [f64]) {
        self.pushes.fill(0.0);
        let n = self.active.len();
        if n == 0 {
            return;
        }
        for numbers in &self.numbers {
            self.h[numbers.clone()].copy_from_slice(&lambda[numbers.clone()]);
        }
        for &body in &self.skeleton {
            self.a[body] = if self.driven[body] { a[body] } else { [0.0; 6] };
        }
        for &body in &self.carried {
            self.a[body] = a[body];
        }
        for &body in &self.skeleton {
            tree.down(body, b, Some(g), &mut self.h, &mut self.a);
        }
        for k in 0..n {
            let row = &self.rows[self.active[k]];
            self.mu[k] = g[row.at] - row.times(&self.a);
        }
        self.factor.solve(&mut self.mu[..n]);
        for &body in &self.skeleton {
            self.b[body] = [0.0; 6];
        }
        for k in 0..n {
            for (body, block) in &self.rows[self.active[k]].parts {
                add_scaled(&mut self.b[*body], self.mu[k], block);
            }
        }
        for numbers in &self.numbers {
            self.h[numbers.clone()].fill(0.0);
        }
        for &body in self.skeleton.iter().rev() {
            tree.up(body, &mut self.b, None, &mut self.h);
        }
        for &body in &self.skeleton {
            add_scaled(&mut b[body], 1.0, &self.b[body]);
        }
        for (sum, h) in self.numbers.iter().flat_map(|numbers| numbers.clone().map(|k| (k, self.h[k]))) {
            lambda[sum] += h;
        }
        for k in 0..n {
            lambda[self.rows[self.active[k]].at] = self.mu[k];
            for (push, share) in self.pushes.iter_mut().zip(&self.shares[k * self.trains..]) {
                *push += self.mu[k] * share;
            }
        }
    }

    /// As [`Loops::correct`], for an impulse that only trains feel, whose own answers they have already. Contacts ask often, and
    /// there are few trains: what a rate of each of them calls up is found once.
    pub fn correct_trains(&mut self, trains: &mut Trains) {
        if self.answers.is_empty() {
            self.find_answers();
        }
        let pushes = self.pushes.iter_mut().zip(self.answers.chunks_exact(self.trains.max(1)));
        for (push, answers) in pushes {
            *push = answers.iter().enumerate().map(|(train, answer)| answer * trains.rate(train)).sum();
        }
        for (train, push) in self.pushes.iter().enumerate().filter(|(_, push)| **push != 0.0) {
            trains.add_push(train, *push);
        }
    }

    /// −F S⁻¹ Fᵀ with F the rows' f by trains.
    fn find_answers(&mut self) {
        let (n, count) = (self.active.len(), self.trains);
        self.answers.resize(count * count, 0.0);
        for train in 0..count {
            let share = |k: usize, of: usize| self.shares[k * count + of];
            if (0..n).all(|k| share(k, train) == 0.0) {
                continue;
            }
            (0..n).for_each(|k| self.mu[k] = -share(k, train));
            self.factor.solve(&mut self.mu[..n]);
            for to in 0..count {
                self.answers[to * count + train] = (0..n).map(|k| self.mu[k] * share(k, to)).sum();
            }
        }
    }

    /// What the rows push along each train's coordinate, after [`Loops::correct`].
    pub fn pushes(&self) -> &[f64] {
        &self.pushes
    }
}

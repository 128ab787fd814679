//! Open joints give way to touches: what is still being drawn together is soft in the contact problem.
//!
//! The joints' factor holds every row, J δ = 0. For rows R that are open that is wrong: a body that the stabiliser draws
//! on to an obstacle would be wedged between the two. But rows that pass nothing on would let what lies on a floor lie
//! there: its support is felt at the joint. So an open row yields to the impulse that it carries, Ċ = −γ λ, by a share
//! β of what it would yield alone, γ = β/S_rr, and β is such that about a figure's weight outweighs the pull:
//!
//! ```text
//! β = min(½, ω₀² |C| / 2g)       soft where it is wide open, hard as it closes
//! ```
//!
//! With b the impulses of the touches, e_r a unit row of the right-hand side, λ(·) the solved multipliers of the rows R,
//!
//! ```text
//! S = (λ(e_r))_r        Λ_j = λ(b_j) of the touches' row j        B = diag S_rr (1 + 1/β_r) off which S is S
//! solve with g_R = y, B y = −Λ P:  g = −γ (Λ P + S y)             W_soft = W + Λᵀ B⁻¹ Λ
//! ```
//!
//! as J_i M⁻¹ Jᵀ K⁻¹ e_r = −Λ_ri for K = J M⁻¹ Jᵀ. One solve more for each open row, and only while there are any.

use crate::articulation::{Cholesky, System};

/// 2g: the pull that a touch of about a figure's weight outweighs, m/s².
const WEIGHT: f64 = 20.0;
/// Largest β.
const SOFTEST: f64 = 0.5;
/// Most rows that are soft; of a figure with more open ones the others hold, as if they were closed.
const MOST_OPEN: usize = 192;
/// A pivot below this share of its row's diagonal is rounding: the row repeats others.
const REPEATS: f64 = 1e-10;

/// The open rows and their part in the touches' answer.
#[derive(Clone, Debug)]
pub(super) struct OpenJoints {
    /// The open rows, each with its β.
    rows: Vec<(usize, f64)>,
    room: usize,
    /// 1/ω₀ of the figure's stabiliser, s.
    time: f64,
    factor: Cholesky,
    /// Λ and S⁻¹ Λ, column by column.
    lambda: Vec<f64>,
    solved: Vec<f64>,
}

impl OpenJoints {
    /// Room for the open rows of a system with this many rows, and for about so many columns of touches.
    pub fn new(rows: usize, time: f64, columns: usize) -> Self {
        let room = rows.min(MOST_OPEN);
        Self {
            rows: Vec::with_capacity(room),
            room,
            time,
            factor: Cholesky::with_room(room, REPEATS),
            lambda: Vec::with_capacity(room * columns),
            solved: Vec::with_capacity(room * columns),
        }
    }

    /// Makes room for so many columns.
    pub fn make_room(&mut self, columns: usize) {
        for numbers in [&mut self.lambda, &mut self.solved] {
            numbers.clear();
            numbers.resize(self.rows.len() * columns, 0.0);
        }
    }

    /// Are there no open rows?
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Finds the open rows of the system's last evaluation, and factors B.
    pub fn find(&mut self, system: &mut System) {
        self.rows.clear();
        let soft = |(row, pull): (usize, f64)| (row, (pull / WEIGHT).min(SOFTEST));
        self.rows.extend(system.open_rows(self.time).take(self.room).map(soft));
        let n = self.rows.len();
        self.factor.begin(n);
        for j in 0..n {
            system.b.fill([0.0; 6]);
            if j == 0 {
                // Sets the answer of driven bodies to nothing.
                system.solve_impulse();
                system.b.fill([0.0; 6]);
            }
            system.g.fill(0.0);
            let (row, softness) = self.rows[j];
            system.g[row] = 1.0;
            system.solve();
            for i in j..n {
                *self.factor.entry(i, j) = system.lambda[self.rows[i].0];
            }
            *self.factor.entry(j, j) *= 1.0 + 1.0 / softness;
            self.factor.measure(j, system.lambda[row]);
        }
        if n > 0 {
            self.factor.factor();
        }
    }

    /// Takes the multipliers of a column that has just been solved.
    pub fn take(&mut self, column: usize, system: &System) {
        let n = self.rows.len();
        let (lambda, solved) = (&mut self.lambda[column * n..][..n], &mut self.solved[column * n..][..n]);
        for (lambda, &(row, _)) in lambda.iter_mut().zip(&self.rows) {
            *lambda = system.lambda[row];
        }
        solved.copy_from_slice(lambda);
        self.factor.solve(solved);
    }

    /// What softness adds to W between two rows of the touches.
    pub fn adds(&self, row: usize, column: usize) -> f64 {
        let n = self.rows.len();
        let (left, right) = (&self.lambda[row * n..][..n], &self.solved[column * n..][..n]);
        left.iter().zip(right).map(|(x, y)| x * y).sum()
    }

    /// Solves for the answer to the impulses in the system's `b`, which are P in the columns.
    pub fn solve(&self, p: impl Iterator<Item = f64>, system: &mut System) {
        if self.rows.is_empty() {
            system.solve_impulse();
            return;
        }
        let n = self.rows.len();
        system.g.fill(0.0);
        for (column, p) in p.enumerate().filter(|(_, p)| *p != 0.0) {
            for (&(row, _), y) in self.rows.iter().zip(&self.solved[column * n..][..n]) {
                system.g[row] -= y * p;
            }
        }
        system.solve();
    }
}

//! Open joints pass no impulse on: what is still being drawn together is free in the contact problem.
//!
//! The joints' factor holds every row, J δ = 0. For rows R that are open that is wrong: the stabiliser that draws them
//! together is soft, and a body that it draws on to an obstacle would be wedged between the two. With b the impulses of
//! the touches, e_r a unit row of the right-hand side, and λ(·) the solved multipliers of the rows R,
//!
//! ```text
//! S = (λ(e_r))_r        Λ_j = λ(b_j) of the touches' row j
//! solve with g_R = y, S y = −Λ P:  the rows R carry nothing        W_free = W + Λᵀ S⁻¹ Λ
//! ```
//!
//! as J_i M⁻¹ Jᵀ K⁻¹ e_r = −Λ_ri for K = J M⁻¹ Jᵀ. One solve more for each open row, and only while there are any.

use crate::articulation::{Cholesky, System};

/// Most rows that are freed; of a figure with more open ones the others hold, as if they were closed.
const MOST_OPEN: usize = 192;
/// A pivot below this share of its row's diagonal is rounding: the row repeats others.
const REPEATS: f64 = 1e-10;

/// The open rows and their part in the touches' answer.
#[derive(Clone, Debug)]
pub(super) struct Open {
    rows: Vec<usize>,
    room: usize,
    factor: Cholesky,
    /// Λ and S⁻¹ Λ, column by column.
    lambda: Vec<f64>,
    solved: Vec<f64>,
}

impl Open {
    /// Room for the open rows of a system with this many rows, and this many rows of touches.
    pub fn new(rows: usize, touches: usize) -> Self {
        let room = rows.min(MOST_OPEN);
        Self {
            rows: Vec::with_capacity(room),
            room,
            factor: Cholesky::with_room(room, REPEATS),
            lambda: vec![0.0; room * touches],
            solved: vec![0.0; room * touches],
        }
    }

    /// Are there no open rows?
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Finds the open rows of the system's last evaluation, and factors S.
    pub fn find(&mut self, system: &mut System) {
        self.rows.clear();
        self.rows.extend(system.open_rows().take(self.room));
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
            system.g[self.rows[j]] = 1.0;
            system.solve();
            for i in j..n {
                *self.factor.entry(i, j) = system.lambda[self.rows[i]];
            }
            self.factor.measure(j, system.lambda[self.rows[j]]);
        }
        if n > 0 {
            self.factor.factor();
        }
    }

    /// Takes the multipliers of a column that has just been solved.
    pub fn take(&mut self, column: usize, system: &System) {
        let n = self.rows.len();
        let (lambda, solved) = (&mut self.lambda[column * n..][..n], &mut self.solved[column * n..][..n]);
        for (lambda, &row) in lambda.iter_mut().zip(&self.rows) {
            *lambda = system.lambda[row];
        }
        solved.copy_from_slice(lambda);
        self.factor.solve(solved);
    }

    /// What freeing adds to W between two rows of the touches.
    pub fn adds(&self, row: usize, column: usize) -> f64 {
        let n = self.rows.len();
        let (left, right) = (&self.lambda[row * n..][..n], &self.solved[column * n..][..n]);
        left.iter().zip(right).map(|(x, y)| x * y).sum()
    }

    /// Solves for the answer to the impulses in the system's `b`, which are P in the touches' rows.
    pub fn solve(&self, p: &[f64], system: &mut System) {
        if self.rows.is_empty() {
            system.solve_impulse();
            return;
        }
        let n = self.rows.len();
        system.g.fill(0.0);
        for (column, p) in p.iter().enumerate().filter(|(_, p)| **p != 0.0) {
            for (&row, y) in self.rows.iter().zip(&self.solved[column * n..][..n]) {
                system.g[row] -= y * p;
            }
        }
        system.solve();
    }
}

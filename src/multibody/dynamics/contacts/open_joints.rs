//! Open joints in the contact problem: joints that the stabiliser is still closing (Baumgarte) yield to contacts.
//!
//! The joints' factor holds every row, J δ = 0. For open rows R that is wrong: a body that the stabiliser pulls towards an
//! obstacle would be wedged between both. Rows that transmit nothing are wrong too: a floor would support a body that its joint
//! should lift. So an open row yields to the impulse that it carries, Ċ = −γ λ, by a fraction β of its own response,
//! γ = β/S_rr. β is chosen so that about the articulation's weight outweighs the pull:
//!
//! ```text
//! β = min(½, ω₀² |C| / 2g)       soft where it is wide open, hard as it closes
//! ```
//!
//! With b the impulses of the contacts, e_r a unit row of the right-hand side, λ(·) the solved multipliers of the rows R,
//!
//! ```text
//! S = (λ(e_r))_r        Λ_j = λ(b_j) of the contacts' row j        B = diag S_rr (1 + 1/β_r) off which S is S
//! solve with g_R = y, B y = −Λ P:  g = −γ (Λ P + S y)             W_soft = W + Λᵀ B⁻¹ Λ
//! ```
//!
//! because J_i M⁻¹ Jᵀ K⁻¹ e_r = −Λ_ri for K = J M⁻¹ Jᵀ. This takes one more solve for each open row, and only while there are any.

use crate::articulation::{Cholesky, System};

/// 2g, about: the pull that a contact force of the articulation's weight outweighs, m/s².
const PULL: f64 = 20.0;
/// Largest β.
const MAX_SOFTNESS: f64 = 0.5;
/// Rows that can be soft at once; further open rows hold as if they were closed.
const MAX_OPEN_ROWS: usize = 192;
/// A pivot below this fraction of its row's diagonal is rounding: the row depends on others.
const DEPENDENT: f64 = 1e-10;

/// The joints' rows and the stabiliser that closes them.
#[derive(Clone, Copy, Debug)]
pub(in crate::dynamics) struct Stabilization {
    /// Rows of all joints.
    pub rows: usize,
    /// 1/ω₀, s.
    pub time: f64,
}

/// The open rows and what they change in the contact problem.
#[derive(Clone, Debug)]
pub(super) struct OpenJoints {
    /// The open rows, each with its β.
    rows: Vec<(usize, f64)>,
    capacity: usize,
    /// 1/ω₀ of the stabiliser, s.
    time: f64,
    factor: Cholesky,
    /// Λ and B⁻¹ Λ, column by column.
    lambda: Vec<f64>,
    solved: Vec<f64>,
}

impl OpenJoints {
    /// Capacity for the open rows of these joints, and for about so many columns of contacts.
    pub fn new(Stabilization { rows, time }: Stabilization, columns: usize) -> Self {
        let capacity = rows.min(MAX_OPEN_ROWS);
        Self {
            rows: Vec::with_capacity(capacity),
            capacity,
            time,
            factor: Cholesky::with_room(capacity, DEPENDENT),
            lambda: Vec::with_capacity(capacity * columns),
            solved: Vec::with_capacity(capacity * columns),
        }
    }

    /// Begins so many columns.
    pub fn begin_columns(&mut self, columns: usize) {
        for numbers in [&mut self.lambda, &mut self.solved] {
            numbers.clear();
            numbers.resize(self.rows.len() * columns, 0.0);
        }
    }

    /// Whether no row is open.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Finds the open rows at the system's last evaluation, and factors B.
    pub fn find(&mut self, system: &mut System) {
        self.rows.clear();
        let soft = |(row, pull): (usize, f64)| (row, (pull / PULL).min(MAX_SOFTNESS));
        self.rows.extend(system.open_rows(self.time).take(self.capacity).map(soft));
        let n = self.rows.len();
        self.factor.begin(n);
        for j in 0..n {
            system.b.fill([0.0; 6]);
            if j == 0 {
                // Sets the response of kinematic bodies to zero.
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

    /// Takes the multipliers of a column that the system has just solved.
    pub fn take_column(&mut self, column: usize, system: &System) {
        let n = self.rows.len();
        let (lambda, solved) = (&mut self.lambda[column * n..][..n], &mut self.solved[column * n..][..n]);
        for (lambda, &(row, _)) in lambda.iter_mut().zip(&self.rows) {
            *lambda = system.lambda[row];
        }
        solved.copy_from_slice(lambda);
        self.factor.solve(solved);
    }

    /// The element that softness adds to W between two rows of the contacts.
    pub fn addition(&self, row: usize, column: usize) -> f64 {
        let n = self.rows.len();
        let (left, right) = (&self.lambda[row * n..][..n], &self.solved[column * n..][..n]);
        left.iter().zip(right).map(|(x, y)| x * y).sum()
    }

    /// Solves for the response to the impulses in the system's `b`, which are `p` in the columns.
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

//! Active-set (semismooth Newton) step of the contact problem: all contacts of an island at once, each a little soft.
//!
//! Every contact has a regularised impulse P⁺(u) (`contact_law.rs`), and the coordinates z of the island obey
//!
//! ```text
//! g(z) = z − Bᵀ (P⁺(u) − P₀) = 0        u = u₀ + B z        ∂g/∂z = 1 + Bᵀ D B
//! ```
//!
//! P⁺ becomes the next P if that reduces the residual: an augmented Lagrangian (P. Alart, A. Curnier, "A mixed formulation for
//! frictional contact problems prone to Newton like solution methods", 1991). The softness does not change the solution, only how
//! fast P gets there, and it falls with each step. The matrix is always invertible: for redundant contacts, such as the four feet
//! of a box, the impulses nearest to the last ones come out.
//!
//! There are two kinds of steps ([`ActiveSetKind`]). With each contact's whole friction cone, g is the gradient of a convex
//! function (compare A. Castro, F. Permenter, X. Han, "An unconstrained convex formulation of compliant contact", 2022, for soft
//! contact): Newton's method with a line search always converges, but sliding contacts lift off. With the present branch of each
//! law, sliding is exact and convergence quadratic, but a step may be too long; it is halved until |g| falls.

use super::contact_law::{ActiveBranch, RegularizedInput};
use super::contact_solver::{ContactSolver, Iterate, ProblemView, add_transposed, multiply};
use super::islands::Island;
use crate::dynamics::work_budget::NEWTON_CONTACT_OPERATIONS;
use soffio_math::{DMat3, DVec3};

/// When the Newton iteration of one step and its line searches end.
struct Tuning {
    /// Newton steps at most.
    newton_steps: usize,
    /// The gradient may keep this fraction of the residual at the start.
    gradient: f64,
    /// The iteration stalls when so many steps each leave more than this fraction of the gradient: rounding.
    stalled_steps: usize,
    stalled: f64,
    /// A step is halved at most so often.
    halvings: usize,
    /// Trials of the search along a convex step.
    trials: usize,
    /// Fraction of the gradient that a full step must remove; of the slope that the line search may leave.
    decrease: f64,
}

const TUNING: Tuning =
    Tuning { newton_steps: 20, gradient: 0.01, stalled_steps: 2, stalled: 0.5, halvings: 4, trials: 10, decrease: 0.1 };

/// Which branch of its law each contact is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ActiveSetKind {
    /// The whole friction cone: convex.
    Convex,
    /// The branch of the present iterate.
    Current,
}

/// One active-set step.
#[derive(Clone, Copy, Debug)]
pub(super) struct ActiveSetStep {
    /// Which branch of the contact law each contact takes.
    pub kind: ActiveSetKind,
    /// Softness of each contact as a fraction of its effective inverse mass.
    pub softness: f64,
}

/// What a step achieved.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum StepProgress {
    /// The residual is smaller.
    Improved,
    /// It is not; the impulses are as before.
    None,
}

impl ContactSolver {
    /// Solves for all contacts of an island at once from the present impulses, in at most `newton_steps` Newton steps, which are
    /// counted down.
    pub(super) fn active_set_step(
        &mut self,
        view: ProblemView,
        island: &Island,
        ActiveSetStep { kind, softness }: ActiveSetStep,
        newton_steps: &mut usize,
    ) -> StepProgress {
        let own = &view.islands.contacts[island.contacts.clone()];
        let all = island.coordinates.clone();
        self.update_velocities(view, island);
        let residual = self.residual(view, own);
        for &contact in own {
            let iterate = &mut self.iterates[contact];
            let Iterate { law, inverse_mass, p, u, .. } = &*iterate;
            iterate.branch = match kind {
                ActiveSetKind::Convex => law.convex_branch(inverse_mass, *p, iterate.excess(*u)),
                ActiveSetKind::Current => law.active_branch(inverse_mass, *p, iterate.excess(*u)),
            };
            let rho = (softness * iterate.inverse_mass.largest()).recip();
            (iterate.branch_velocity, iterate.rho) = (iterate.u, rho);
        }
        let operations = self.newton_step_operations(view, island);
        let mut size = self.find_gradient(view, island);
        let (mut least, mut stalled) = (size, 0);
        // A contact's velocity is at most √k times the error of z.
        let k = own.iter().fold(0.0, |max: f64, &contact| max.max(self.iterates[contact].inverse_mass.largest()));
        let enough = TUNING.gradient * residual / k.sqrt();
        for step in 0..TUNING.newton_steps {
            if size <= enough || *newton_steps == 0 || stalled == TUNING.stalled_steps {
                break;
            }
            *newton_steps -= 1;
            self.operations += operations;
            let same = |contact: &usize| self.iterates[*contact].d == self.iterates[*contact].factored;
            if step == 0 || !own.iter().all(same) {
                self.factor(view, island);
            }
            for (step, g) in self.step[all.clone()].iter_mut().zip(&self.gradient[all.clone()]) {
                *step = -g;
            }
            self.hessian.solve(&mut self.step[all.clone()]);
            for &contact in own {
                self.iterates[contact].direction = multiply(view, contact, &self.step);
            }
            size = match kind {
                ActiveSetKind::Convex => self.search_line(view, island),
                ActiveSetKind::Current => self.backtrack(view, island, size),
            };
            stalled = if size > TUNING.stalled * least { stalled + 1 } else { 0 };
            least = least.min(size);
        }
        for &contact in own {
            self.update_law(view, contact);
            let iterate = &mut self.iterates[contact];
            (iterate.p, iterate.plus) = (iterate.law.project(iterate.plus), iterate.p);
        }
        self.update_velocities(view, island);
        if self.residual(view, own) < residual {
            return StepProgress::Improved;
        }
        own.iter().for_each(|&contact| self.iterates[contact].p = self.iterates[contact].plus);
        self.update_velocities(view, island);
        StepProgress::None
    }

    /// P⁺, D and g at the present z. Returns |g|.
    fn find_gradient(&mut self, view: ProblemView, island: &Island) -> f64 {
        let all = island.coordinates.clone();
        self.gradient[all.clone()].fill(0.0);
        for &contact in &view.islands.contacts[island.contacts.clone()] {
            // A contact point comes before its rolling resistance.
            let normal_impulse =
                view.contacts[contact].bounding_point().map_or(0.0, |point| self.iterates[point].plus.x);
            let iterate = &mut self.iterates[contact];
            let Iterate { rho, p, u, branch_velocity, .. } = *iterate;
            let input = RegularizedInput {
                rho,
                impulse: p,
                velocity: iterate.excess(u),
                change: u - branch_velocity,
                normal_impulse,
            };
            (iterate.plus, iterate.d) = iterate.branch.regularized(input);
            add_transposed(view, contact, iterate.applied - iterate.plus, &mut self.gradient);
        }
        let mut square = 0.0;
        for (g, z) in self.gradient[all.clone()].iter_mut().zip(&self.z[all]) {
            *g += z;
            square += *g * *g;
        }
        square.sqrt()
    }

    /// Backtracking line search: halves the Newton step until the gradient, of this `size`, falls. Returns |g| there.
    fn backtrack(&mut self, view: ProblemView, island: &Island, size: f64) -> f64 {
        let all = island.coordinates.clone();
        let (mut fraction, mut taken, mut found) = (1.0, 0.0, size);
        for _ in 0..TUNING.halvings {
            let more = fraction - taken;
            for (z, s) in self.z[all.clone()].iter_mut().zip(&self.step[all.clone()]) {
                *z += more * s;
            }
            for &contact in &view.islands.contacts[island.contacts.clone()] {
                let iterate = &mut self.iterates[contact];
                iterate.u += more * iterate.direction;
            }
            taken = fraction;
            found = self.find_gradient(view, island);
            if found <= (1.0 - TUNING.decrease * fraction) * size {
                break;
            }
            fraction *= 0.5;
        }
        found
    }

    /// Line search of a convex step: to about where the slope along it is zero. Returns |g| there.
    fn search_line(&mut self, view: ProblemView, island: &Island) -> f64 {
        let own = &view.islands.contacts[island.contacts.clone()];
        let all = island.coordinates.clone();
        let (mut linear, mut square) = (0.0, 0.0);
        for (z, s) in self.z[all.clone()].iter().zip(&self.step[all.clone()]) {
            linear += z * s;
            square += s * s;
        }
        let iterates = &self.iterates;
        let slope = |fraction: f64| {
            own.iter().fold(linear + fraction * square, |sum, &contact| {
                let i = &iterates[contact];
                let u = i.u + fraction * i.direction;
                let input = RegularizedInput {
                    rho: i.rho,
                    impulse: i.p,
                    velocity: i.excess(u),
                    change: u - i.branch_velocity,
                    normal_impulse: 0.0,
                };
                let (plus, _) = i.branch.regularized(input);
                sum - i.direction.dot(plus - i.applied)
            })
        };
        let begin = slope(0.0);
        let mut fraction = 1.0;
        let mut end = slope(fraction);
        if end > TUNING.decrease * begin.abs() {
            // Regula falsi, Illinois variant.
            let (mut low, mut high) = ((0.0, begin), (fraction, end));
            for _ in 0..TUNING.trials {
                fraction = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
                end = slope(fraction);
                if end.abs() <= TUNING.decrease * begin.abs() {
                    break;
                }
                if end < 0.0 {
                    low = (fraction, end);
                    high.1 *= 0.5;
                } else {
                    high = (fraction, end);
                    low.1 *= 0.5;
                }
            }
        }
        for (z, s) in self.z[all.clone()].iter_mut().zip(&self.step[all]) {
            *z += fraction * s;
        }
        for &contact in own {
            let iterate = &mut self.iterates[contact];
            iterate.u += fraction * iterate.direction;
        }
        self.find_gradient(view, island)
    }

    /// Operations of one Newton step, about.
    pub(super) fn newton_step_operations(&self, view: ProblemView, island: &Island) -> u64 {
        let base = island.coordinates.start;
        let length = |&node: &usize| {
            let (size, place) = (view.coordinates.nodes[node].size, view.islands.first_coordinate[node] - base);
            let row = place + size - (view.islands.envelope_start[node] - base);
            2 * (size * row * row) as u64
        };
        let rows: u64 = view.islands.order_of(island).iter().map(length).sum();
        rows + NEWTON_CONTACT_OPERATIONS * island.contacts.len() as u64
    }

    /// ∂g/∂z and its factor.
    fn factor(&mut self, view: ProblemView, island: &Island) {
        let ProblemView { coordinates, islands, .. } = view;
        let base = island.coordinates.start;
        let order = islands.order_of(island);
        self.hessian.begin(order.iter().flat_map(|&node| {
            let first = islands.envelope_start[node] - base;
            std::iter::repeat_n(first, coordinates.nodes[node].size)
        }));
        for row in 0..island.coordinates.len() {
            self.hessian.from(row, row).column[0] = 1.0;
        }
        for &contact in &islands.contacts[island.contacts.clone()] {
            self.iterates[contact].factored = self.iterates[contact].d;
            let Iterate { d, branch, .. } = self.iterates[contact];
            if d != DMat3::ZERO {
                self.add_product(view, base, Product { left: contact, right: contact, d });
            }
            if let (Some(point), ActiveBranch::Follows { along, .. }) =
                (view.contacts[contact].bounding_point(), branch)
                && along != DVec3::ZERO
            {
                let normal = self.iterates[point].d.row(0);
                let d = DMat3::from_cols(normal.x * along, normal.y * along, normal.z * along);
                self.add_product(view, base, Product { left: contact, right: point, d });
            }
        }
        self.hessian.factor();
    }

    /// Adds a product of two contacts with the same nodes to the matrix of an island whose coordinates begin at `base`.
    fn add_product(
        &mut self,
        ProblemView { contacts, coordinates, islands }: ProblemView,
        base: usize,
        Product { left, right, d }: Product,
    ) {
        let (a, b) = (&contacts[left], &contacts[right]);
        let [blocks_a, blocks_b] = [a, b].map(|contact| coordinates.blocks_of(contact));
        for (p, p_b) in blocks_a.iter().zip(blocks_b) {
            debug_assert_eq!(p.node, p_b.node);
            let size_p = coordinates.nodes[p.node].size;
            let at_p = islands.first_coordinate[p.node] - base;
            let (left, left_b) = (coordinates.matrix(p, a.rows.len()), coordinates.matrix(p_b, b.rows.len()));
            for (q, q_b) in blocks_a.iter().zip(blocks_b) {
                let (at_q, size_q) = (islands.first_coordinate[q.node] - base, coordinates.nodes[q.node].size);
                // A mechanism that joints hold fast has no coordinates.
                if at_q > at_p || size_q == 0 {
                    continue;
                }
                let (right, right_b) = (coordinates.matrix(q, a.rows.len()), coordinates.matrix(q_b, b.rows.len()));
                for i in 0..size_p {
                    // Row i of Bₚᵀ D and column i of D Bₚ.
                    let before = d.transpose() * take_column(left, a.rows.len(), size_p, i);
                    let after = d * take_column(left_b, b.rows.len(), size_p, i);
                    let end = if at_p == at_q { i + 1 } else { size_q };
                    let lines = self.hessian.from(at_p + i, at_q);
                    for (k, own) in right_b.chunks_exact(size_q).enumerate() {
                        lines.row[..end].iter_mut().zip(own).for_each(|(row, own)| *row += before[k] * own);
                    }
                    for (k, own) in right.chunks_exact(size_q).enumerate() {
                        lines.column[..end].iter_mut().zip(own).for_each(|(column, own)| *column += after[k] * own);
                    }
                }
            }
        }
    }
}

/// Bₐᵀ D B_b of two contacts.
struct Product {
    left: usize,
    right: usize,
    d: DMat3,
}

/// A column of a block's matrix, which has one to three rows.
fn take_column(matrix: &[f64], rows: usize, size: usize, column: usize) -> DVec3 {
    let at = |row: usize| if row < rows { matrix[row * size + column] } else { 0.0 };
    DVec3::new(at(0), at(1), at(2))
}

//! Leaps: all touches of an island solved at once, each giving way a little, by Newton's method.
//!
//! With the softness of `law.rs`, every touch has an impulse P⁺(u), and the coordinates z of the island obey
//!
//! ```text
//! g(z) = z − Bᵀ (P⁺(u) − P₀) = 0        u = u₀ + B z        ∂g/∂z = 1 + Bᵀ D B
//! ```
//!
//! P⁺ becomes the next P if that brings the touches nearer to their laws: an augmented Lagrangian (P. Alart, A. Curnier, "A mixed
//! formulation for frictional contact problems prone to Newton like solution methods", 1991). The softness is not in the
//! answer, it says how fast P gets there; it falls with each P. The matrix has an inverse whatever touches there are: four feet of a
//! box, or bodies on hinges, need no choice among them, and of impulses that do the same the ones nearest to the last come out.
//!
//! There are two kinds. Where each contact may have any impulse of its cone, g is the gradient of a convex function (A. Castro, F.
//! Permenter, X. Han, "An unconstrained convex formulation of compliant contact", 2022, has the same for soft contact): Newton's
//! steps, cut by a search along them, always arrive; but what slides lifts off. Where each goes on as it does now, sliding is exact
//! and convergence quadratic; but a step may be too long, and is halved until g gets less.

use super::contact_law::ActiveBranch;
use super::contact_solver::{ContactSolver, Iterate, ProblemView, add_transposed, times};
use super::islands::Island;
use crate::dynamics::work_budget::NEWTON_CONTACT_OPERATIONS;
use soffio_math::{DMat3, DVec3};

/// Newton's steps of a leap at most, and the share of what was missed that a gradient may leave.
const MAX_NEWTON_STEPS: usize = 20;
const FLAT: f64 = 0.01;
/// It stands still, or has come to rounding, where so many steps each leave more than this share of it.
const IDLE: usize = 2;
const LITTLE: f64 = 0.5;
/// A step is halved so often until it takes this share off the gradient; or trials of a search for where a slope along it is left
/// with this share.
const HALVINGS: usize = 4;
const TRIALS: usize = 10;
const LESS: f64 = 0.1;

/// How touches are taken in a leap: each may do anything, as far as that is convex, or goes on as now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum ActiveSetKind {
    Convex,
    AsNow,
}

impl ContactSolver {
    /// Solves for all touches at once, each as soft as this, from where they stand. Answers whether that brought them nearer
    /// to their laws; else they stay as they were.
    pub(super) fn active_set_step(
        &mut self,
        view: ProblemView,
        island: &Island,
        (kind, softness): (ActiveSetKind, f64),
        left: &mut usize,
    ) -> bool {
        let own = &view.islands.contacts[island.contacts.clone()];
        let all = island.coordinates.clone();
        self.follow(view, island);
        let missed = self.missed(view, own);
        for &contact in own {
            let iterate = &mut self.iterates[contact];
            let Iterate { law, answer, p, u, .. } = &*iterate;
            iterate.branch = match kind {
                ActiveSetKind::Convex => law.convex_branch(answer, *p, iterate.over(*u)),
                ActiveSetKind::AsNow => law.active_branch(answer, *p, iterate.over(*u)),
            };
            (iterate.from, iterate.rho) = (iterate.u, (softness * iterate.answer.most()).recip());
        }
        let operations = self.newton_step_operations(view, island);
        let mut size = self.find_gradient(view, island);
        let (mut least, mut idle) = (size, 0);
        // A velocity of touches is at most √k times what z lacks.
        let k = own.iter().fold(0.0, |most: f64, &contact| most.max(self.iterates[contact].answer.most()));
        let flat = FLAT * missed / k.sqrt();
        for step in 0..MAX_NEWTON_STEPS {
            if size <= flat || *left == 0 || idle == IDLE {
                break;
            }
            *left -= 1;
            self.operations += operations;
            let same = |contact: &usize| self.iterates[*contact].d == self.iterates[*contact].factored;
            if step == 0 || !own.iter().all(same) {
                self.factor(view, island);
            }
            for (step, g) in self.step[all.clone()].iter_mut().zip(&self.gradient[all.clone()]) {
                *step = -g;
            }
            self.h.solve(&mut self.step[all.clone()]);
            for &contact in own {
                self.iterates[contact].along = times(view, contact, &self.step);
            }
            size = match kind {
                ActiveSetKind::Convex => self.go_down(view, island),
                ActiveSetKind::AsNow => self.go(view, island, size),
            };
            idle = if size > LITTLE * least { idle + 1 } else { 0 };
            least = least.min(size);
        }
        for &contact in own {
            self.renew_law(view, contact);
            let iterate = &mut self.iterates[contact];
            (iterate.p, iterate.plus) = (iterate.law.project(iterate.plus), iterate.p);
        }
        self.follow(view, island);
        let better = self.missed(view, own) < missed;
        if !better {
            own.iter().for_each(|&contact| self.iterates[contact].p = self.iterates[contact].plus);
            self.follow(view, island);
        }
        better
    }

    /// P⁺, D and g where things stand. Answers |g|.
    fn find_gradient(&mut self, view: ProblemView, island: &Island) -> f64 {
        let all = island.coordinates.clone();
        self.gradient[all.clone()].fill(0.0);
        for &contact in &view.islands.contacts[island.contacts.clone()] {
            // A point stands before its couple.
            let press = view.contacts[contact].twist.map_or(0.0, |twist| self.iterates[twist.of].plus.x);
            let iterate = &mut self.iterates[contact];
            let Iterate { rho, p, u, from, .. } = *iterate;
            (iterate.plus, iterate.d) = iterate.branch.regularized(rho, p, (iterate.over(u), u - from), press);
            add_transposed(view, contact, iterate.before - iterate.plus, &mut self.gradient);
        }
        let mut square = 0.0;
        for (g, z) in self.gradient[all.clone()].iter_mut().zip(&self.z[all]) {
            *g += z;
            square += *g * *g;
        }
        square.sqrt()
    }

    /// Goes along the step as far as the gradient, of this size, gets less. Answers its size there.
    fn go(&mut self, view: ProblemView, island: &Island, size: f64) -> f64 {
        let all = island.coordinates.clone();
        let (mut far, mut gone, mut left) = (1.0, 0.0, size);
        for _ in 0..HALVINGS {
            let more = far - gone;
            for (z, s) in self.z[all.clone()].iter_mut().zip(&self.step[all.clone()]) {
                *z += more * s;
            }
            for &contact in &view.islands.contacts[island.contacts.clone()] {
                let iterate = &mut self.iterates[contact];
                iterate.u += more * iterate.along;
            }
            gone = far;
            left = self.find_gradient(view, island);
            if left <= (1.0 - LESS * far) * size {
                break;
            }
            far *= 0.5;
        }
        left
    }

    /// Goes along the step to where the function whose gradient it is is least, about. Answers the size of the gradient there.
    fn go_down(&mut self, view: ProblemView, island: &Island) -> f64 {
        let own = &view.islands.contacts[island.contacts.clone()];
        let all = island.coordinates.clone();
        let (mut linear, mut square) = (0.0, 0.0);
        for (z, s) in self.z[all.clone()].iter().zip(&self.step[all.clone()]) {
            linear += z * s;
            square += s * s;
        }
        let iterates = &self.iterates;
        let slope = |far: f64| {
            own.iter().fold(linear + far * square, |sum, &contact| {
                let i = &iterates[contact];
                let u = i.u + far * i.along;
                let (plus, _) = i.branch.regularized(i.rho, i.p, (i.over(u), u - i.from), 0.0);
                sum - i.along.dot(plus - i.before)
            })
        };
        let begin = slope(0.0);
        let mut far = 1.0;
        let mut end = slope(far);
        if end > LESS * begin.abs() {
            // Regula falsi in the way of Illinois.
            let (mut low, mut high) = ((0.0, begin), (far, end));
            for _ in 0..TRIALS {
                far = (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1);
                end = slope(far);
                if end.abs() <= LESS * begin.abs() {
                    break;
                }
                if end < 0.0 {
                    low = (far, end);
                    high.1 *= 0.5;
                } else {
                    high = (far, end);
                    low.1 *= 0.5;
                }
            }
        }
        for (z, s) in self.z[all.clone()].iter_mut().zip(&self.step[all]) {
            *z += far * s;
        }
        for &contact in own {
            let iterate = &mut self.iterates[contact];
            iterate.u += far * iterate.along;
        }
        self.find_gradient(view, island)
    }

    /// Operations of one of Newton's steps, about.
    pub(super) fn newton_step_operations(&self, view: ProblemView, island: &Island) -> u64 {
        let base = island.coordinates.start;
        let length = |&node: &usize| {
            let (size, place) = (view.coordinates.nodes[node].size, view.islands.place[node] - base);
            let row = place + size - (view.islands.reach[node] - base);
            2 * (size * row * row) as u64
        };
        let rows: u64 = view.islands.order_of(island).iter().map(length).sum();
        rows + NEWTON_CONTACT_OPERATIONS * island.contacts.len() as u64
    }

    /// H and its factor.
    fn factor(&mut self, view: ProblemView, island: &Island) {
        let ProblemView { coordinates, islands, .. } = view;
        let base = island.coordinates.start;
        let order = islands.order_of(island);
        self.h.begin(order.iter().flat_map(|&node| {
            let first = islands.reach[node] - base;
            std::iter::repeat_n(first, coordinates.nodes[node].size)
        }));
        for row in 0..island.coordinates.len() {
            self.h.arms(row, row).1[0] = 1.0;
        }
        for &contact in &islands.contacts[island.contacts.clone()] {
            self.iterates[contact].factored = self.iterates[contact].d;
            let Iterate { d, branch, .. } = self.iterates[contact];
            if d != DMat3::ZERO {
                self.add_product(view, base, (contact, contact), d);
            }
            if let (Some(twist), ActiveBranch::Follows { along, .. }) = (view.contacts[contact].twist, branch)
                && along != DVec3::ZERO
            {
                let press = self.iterates[twist.of].d.row(0);
                let with_press = DMat3::from_cols(press.x * along, press.y * along, press.z * along);
                self.add_product(view, base, (contact, twist.of), with_press);
            }
        }
        self.h.factor();
    }

    /// Adds Bₐᵀ D B_b of two touches with the same parts to H, whose coordinates begin at `base`.
    fn add_product(
        &mut self,
        ProblemView { contacts, coordinates, islands }: ProblemView,
        base: usize,
        (a, b): (usize, usize),
        d: DMat3,
    ) {
        let (a, b) = (&contacts[a], &contacts[b]);
        let [parts_a, parts_b] = [a, b].map(|contact| coordinates.parts_of(contact));
        for (p, p_b) in parts_a.iter().zip(parts_b) {
            debug_assert_eq!(p.node, p_b.node);
            let size_p = coordinates.nodes[p.node].size;
            let at_p = islands.place[p.node] - base;
            let (left, left_b) = (coordinates.block(p, a.rows), coordinates.block(p_b, b.rows));
            for (q, q_b) in parts_a.iter().zip(parts_b) {
                let (at_q, size_q) = (islands.place[q.node] - base, coordinates.nodes[q.node].size);
                // A mechanism that joints hold fast has no coordinates.
                if at_q > at_p || size_q == 0 {
                    continue;
                }
                let (right, right_b) = (coordinates.block(q, a.rows), coordinates.block(q_b, b.rows));
                for i in 0..size_p {
                    // Row i of Bₚᵀ D and column i of D Bₚ.
                    let before = d.transpose() * take(left, a.rows, size_p, i);
                    let after = d * take(left_b, b.rows, size_p, i);
                    let end = if at_p == at_q { i + 1 } else { size_q };
                    let (row, upright) = self.h.arms(at_p + i, at_q);
                    for (k, own) in right_b.chunks_exact(size_q).enumerate() {
                        row[..end].iter_mut().zip(own).for_each(|(row, own)| *row += before[k] * own);
                    }
                    for (k, own) in right.chunks_exact(size_q).enumerate() {
                        upright[..end].iter_mut().zip(own).for_each(|(upright, own)| *upright += after[k] * own);
                    }
                }
            }
        }
    }
}

/// A column of a part's matrix.
fn take(block: &[f64], rows: usize, size: usize, column: usize) -> DVec3 {
    let at = |row: usize| if row < rows { block[row * size + column] } else { 0.0 };
    DVec3::new(at(0), at(1), at(2))
}

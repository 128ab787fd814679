//! Solves the contact problem island by island: sweeps find who presses, sticks and slides, Newton's method the impulses.
//!
//! With the coordinates z of `coordinates.rs` and the laws of `law.rs`, impulses and velocities obey
//!
//! ```text
//! z = Bᵀ (P − P₀)        u = u₀ + B z        P by its law
//! ```
//!
//! A *sweep* (block Gauss–Seidel; M. Jean, The non-smooth contact dynamics method, 1999) goes from touch to touch, each exact for
//! itself. Sweeps settle who does what long before they find the impulses, above all in stacks and where heavy bodies lie on
//! light ones. So after every few of them all touches are solved at once, each giving way a little (`Law::soft`):
//!
//! ```text
//! g(z) = z − Bᵀ (P⁺(u) − P₀) = 0        ∂g/∂z = 1 + Bᵀ D B
//! ```
//!
//! by Newton's method, and P⁺ becomes the next P if that brings the touches nearer to their laws: an augmented Lagrangian (P. Alart,
//! A. Curnier, "A mixed formulation for frictional contact problems prone to Newton like solution methods", 1991). The softness is
//! not in the answer, it says how fast P gets there; it falls with each P. The matrix has an inverse whatever touches there are:
//! four feet of a box, or bodies on hinges, need no choice among them, and of impulses that do the same the ones nearest to the
//! last come out. A touch's normal impulse bounds its couple: that bound is taken from the last sweep.

use super::coordinates::Coordinates;
use super::envelope::Envelope;
use super::islands::{Island, Islands};
use super::law::{Answer, Doing, Law};
use super::touch::{ROUNDING, Touch};
use crate::dynamics::effort::{SOLVED, SWEPT};
use soffio_math::{DMat3, DVec3};

/// Touches agree with their laws when none would change a velocity of its own by more than this, m/s (a resting body creeps by
/// less than a hundredth of a micrometre a minute), or by more than this share of it.
const SETTLED: f64 = 1e-11;
const AGREES: f64 = 1e-8;
/// They nearly do by this, or by this share of the velocities that impulses make alone: good enough to begin from.
const NEARLY: f64 = 1e-5;
const NEARLY_SHARE: f64 = 1e-7;
/// What moves may miss them by this: a third of a micrometre a step.
const GOOD: f64 = 1e-4;
/// Dear leaps are worth it from here on.
const NEAR: f64 = 1e-3;
/// Operations of a step of Newton's method up to which it is cheap: in towers, walls and all that a visitor moves at once. A heap of
/// fifty boxes has few steps, and sweeps instead.
const CHEAP: u64 = 200_000;
/// Steps that a solve may take in an island where they are cheap, and where they are dear.
const MOST_STEPS: usize = 40;
const FEW_STEPS: usize = 2;
/// Softness of touches in shares of their own answer: of the first leap, the least, and what it falls by with each leap that helps.
const SOFTEST: f64 = 1e-3;
const HARDEST: f64 = 1e-7;
const HARDER: f64 = 1e-2;
/// A leap that leaves more than this share of what was missed helps little.
const ENOUGH: f64 = 0.3;
/// Sweeps after such a leap, and leaps at most; then the best impulses so far are taken.
const SWEEPS: usize = 8;
const MOST_LEAPS: usize = 6;
/// Newton's steps of a leap at most, and the share of what was missed that a gradient may leave.
const LEAP_STEPS: usize = 20;
const FLAT: f64 = 0.01;
/// A step is halved so often until it takes this share off the gradient; or trials of a search for where a slope along it is left
/// with this share.
const HALVINGS: usize = 4;
const TRIALS: usize = 10;
const LESS: f64 = 0.1;

/// How touches are taken in a leap: each may do anything, as far as that is convex, or goes on as now.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Leap {
    Convex,
    AsNow,
}

/// A touch on the way to its impulse.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Iterate {
    /// Velocity before anything but P₀ acts, and at present, m/s.
    pub start: DVec3,
    pub u: DVec3,
    /// u along a step.
    along: DVec3,
    /// P, the best P so far, P⁺, and P₀, N s.
    pub p: DVec3,
    best: DVec3,
    plus: DVec3,
    pub before: DVec3,
    /// Least velocity along the normal, m/s.
    pub least: f64,
    law: Law,
    answer: Answer,
    /// What it is taken to go on doing in a leap, from this velocity, with this ρ.
    doing: Doing,
    from: DVec3,
    rho: f64,
    /// D, and that of the factor at hand.
    d: DMat3,
    factored: DMat3,
}

impl Iterate {
    /// A touch that has its first velocity and impulse.
    pub fn new(touch: &Touch, start: DVec3) -> Self {
        let (p, before, least) = (touch.before, touch.before, touch.least);
        Self { start, u: start, p, before, least, answer: touch.answer, ..Self::default() }
    }

    /// A touch that is to open by `goal` or more, from nothing.
    pub fn pushed(touch: &Touch, goal: f64, law: Law) -> Self {
        Self { least: goal, answer: touch.answer, law, ..Self::default() }
    }

    /// Begins from a touch's impulse, under this law.
    pub fn begin(&mut self, touch: &Touch, law: Law) {
        (self.p, self.least, self.law) = (touch.impulse, touch.least, law);
    }

    /// u less the least velocity.
    fn over(&self, u: DVec3) -> DVec3 {
        DVec3::new(u.x - self.least, u.y, u.z)
    }

    /// By how much an impulse would change the touch's own velocity beyond what is rounding, m/s.
    fn misses(&self, to: DVec3) -> f64 {
        let change = (self.answer.k * (to - self.p)).abs().max_element();
        change - AGREES * self.u.length() - ROUNDING * self.answer.k.x_axis.x * self.p.x
    }
}

/// The touches of a problem as the solver sees them.
#[derive(Clone, Copy)]
pub(super) struct View<'a> {
    pub touches: &'a [Touch],
    pub coordinates: &'a Coordinates,
    pub islands: &'a Islands,
}

/// The solver. Impulses go in and come out in its iterates.
#[derive(Clone, Debug, Default)]
pub(super) struct Newton {
    pub iterates: Vec<Iterate>,
    /// z, g and Newton's step, coordinate by coordinate.
    z: Vec<f64>,
    gradient: Vec<f64>,
    step: Vec<f64>,
    h: Envelope,
    /// Operations so far (`dynamics/effort.rs`).
    pub effort: u64,
}

impl Newton {
    /// Room for about so many touches of so many bodies.
    pub fn with_room(touches: usize, bodies: usize) -> Self {
        let coordinates = 6 * bodies.min(2 * touches);
        Self {
            iterates: Vec::with_capacity(touches),
            z: Vec::with_capacity(coordinates),
            gradient: Vec::with_capacity(coordinates),
            step: Vec::with_capacity(coordinates),
            h: Envelope::with_room(coordinates, 6 * coordinates.min(16)),
            effort: 0,
        }
    }

    /// Begins a problem: all impulses are P₀, all velocities u₀.
    pub fn begin(&mut self, count: usize) {
        for numbers in [&mut self.z, &mut self.gradient, &mut self.step] {
            numbers.clear();
            numbers.resize(count, 0.0);
        }
    }

    /// Solves for all impulses from where they stand. Answers whether they agree with the laws.
    pub fn solve(&mut self, view: View) -> bool {
        view.islands.islands.iter().fold(true, |settled, island| settled & self.solve_island(view, island))
    }

    fn solve_island(&mut self, view: View, island: &Island) -> bool {
        let own = &view.islands.touches[island.touches.clone()];
        self.follow(view, island);
        let mut best = self.missed(view, own);
        if best <= SETTLED {
            return true;
        }
        self.keep(own);
        let scale = |this: &Self| {
            let alone = |touch: &usize| this.iterates[*touch].answer.k.x_axis.x * this.iterates[*touch].p.x;
            own.iter().map(alone).fold(0.0, f64::max)
        };
        let cheap = self.step_effort(view, island) <= CHEAP;
        let mut left = if cheap { MOST_STEPS } else { FEW_STEPS };
        let (mut softness, mut kind) = (SOFTEST, Leap::Convex);
        for _ in 0..MOST_LEAPS {
            let (mut better, mut missed, begun) = (false, best, best);
            if left > 0 && (cheap || best <= NEAR) {
                better = self.leap(view, island, (kind, softness), &mut left);
                missed = self.missed(view, own);
                softness = if better { (softness * HARDER).max(HARDEST) } else { SOFTEST };
            }
            let helps = better && (missed <= ENOUGH * begun || missed <= NEARLY);
            if !helps {
                kind = if kind == Leap::Convex { Leap::AsNow } else { Leap::Convex };
                for _ in 0..SWEEPS {
                    if missed <= SETTLED {
                        break;
                    }
                    missed = self.sweep(view, own);
                }
            }
            if missed < best {
                best = missed;
                self.keep(own);
            }
            if best <= SETTLED || (!better && best <= NEARLY + NEARLY_SHARE * scale(self)) {
                break;
            }
        }
        own.iter().for_each(|&touch| self.iterates[touch].p = self.iterates[touch].best);
        self.follow(view, island);
        best <= GOOD + NEARLY_SHARE * scale(self)
    }

    /// Operations of one of Newton's steps, about.
    fn step_effort(&self, view: View, island: &Island) -> u64 {
        let base = island.coordinates.start;
        let length = |&node: &usize| {
            let (size, place) = (view.coordinates.nodes[node].size, view.islands.place[node] - base);
            let row = place + size - (view.islands.reach[node] - base);
            2 * (size * row * row) as u64
        };
        let rows: u64 = view.islands.order_of(island).iter().map(length).sum();
        rows + SOLVED * island.touches.len() as u64
    }

    fn keep(&mut self, own: &[usize]) {
        own.iter().for_each(|&touch| self.iterates[touch].best = self.iterates[touch].p);
    }

    /// Takes a couple's bounds from its point's impulse.
    fn renew_law(&mut self, view: View, touch: usize) {
        if let Law::Couple(_) = self.iterates[touch].law
            && let Some(twist) = view.touches[touch].twist
        {
            self.iterates[touch].law = view.touches[touch].law(self.iterates[twist.of].p.x);
        }
    }

    /// By how much touches miss their laws at most, each by what a step of its own would change, m/s.
    fn missed(&mut self, view: View, own: &[usize]) -> f64 {
        let mut most: f64 = 0.0;
        for &touch in own {
            self.renew_law(view, touch);
            let iterate = &self.iterates[touch];
            most = most.max(iterate.misses(iterate.law.relax(&iterate.answer, iterate.p, iterate.over(iterate.u))));
        }
        most
    }

    /// Lets touch after touch satisfy its law. Answers by how much they missed it at most, m/s.
    fn sweep(&mut self, view: View, own: &[usize]) -> f64 {
        let mut most: f64 = 0.0;
        self.effort += SWEPT * own.len() as u64;
        for &touch in own {
            self.renew_law(view, touch);
            self.iterates[touch].u = self.iterates[touch].start + times(view, touch, &self.z);
            let iterate = &mut self.iterates[touch];
            let to = iterate.law.relax(&iterate.answer, iterate.p, iterate.over(iterate.u));
            most = most.max(iterate.misses(to));
            let change = to - iterate.p;
            iterate.p = to;
            add_transposed(view, touch, change, &mut self.z);
        }
        most
    }

    /// Solves for all touches at once, each as soft as this, from where they stand. Answers whether that brought them nearer
    /// to their laws; else they stay as they were.
    fn leap(&mut self, view: View, island: &Island, (kind, softness): (Leap, f64), left: &mut usize) -> bool {
        let own = &view.islands.touches[island.touches.clone()];
        let all = island.coordinates.clone();
        self.follow(view, island);
        let missed = self.missed(view, own);
        for &touch in own {
            let iterate = &mut self.iterates[touch];
            let Iterate { law, answer, p, u, .. } = &*iterate;
            iterate.doing = match kind {
                Leap::Convex => law.may_do(answer, *p, iterate.over(*u)),
                Leap::AsNow => law.doing(answer, *p, iterate.over(*u)),
            };
            (iterate.from, iterate.rho) = (iterate.u, (softness * iterate.answer.most()).recip());
        }
        let mut size = self.find_gradient(view, island);
        // A velocity of touches is at most √k times what z lacks.
        let k = own.iter().fold(0.0, |most: f64, &touch| most.max(self.iterates[touch].answer.most()));
        let flat = FLAT * missed / k.sqrt();
        for step in 0..LEAP_STEPS {
            if size <= flat || *left == 0 {
                break;
            }
            *left -= 1;
            let same = |touch: &usize| self.iterates[*touch].d == self.iterates[*touch].factored;
            if step == 0 || !own.iter().all(same) {
                self.factor(view, island);
            }
            for (step, g) in self.step[all.clone()].iter_mut().zip(&self.gradient[all.clone()]) {
                *step = -g;
            }
            self.h.solve(&mut self.step[all.clone()]);
            for &touch in own {
                self.iterates[touch].along = times(view, touch, &self.step);
            }
            size = match kind {
                Leap::Convex => self.go_down(view, island),
                Leap::AsNow => self.go(view, island, size),
            };
        }
        for &touch in own {
            let iterate = &mut self.iterates[touch];
            (iterate.p, iterate.plus) = (iterate.law.allowed(iterate.plus), iterate.p);
        }
        self.follow(view, island);
        let better = self.missed(view, own) < missed;
        if !better {
            own.iter().for_each(|&touch| self.iterates[touch].p = self.iterates[touch].plus);
            self.follow(view, island);
        }
        better
    }

    /// P⁺, D and g where things stand. Answers |g|.
    fn find_gradient(&mut self, view: View, island: &Island) -> f64 {
        let all = island.coordinates.clone();
        self.gradient[all.clone()].fill(0.0);
        for &touch in &view.islands.touches[island.touches.clone()] {
            let iterate = &mut self.iterates[touch];
            let Iterate { rho, p, u, from, .. } = *iterate;
            (iterate.plus, iterate.d) = iterate.doing.soft(rho, p, iterate.over(u), u - from);
            add_transposed(view, touch, iterate.before - iterate.plus, &mut self.gradient);
        }
        let mut square = 0.0;
        for (g, z) in self.gradient[all.clone()].iter_mut().zip(&self.z[all]) {
            *g += z;
            square += *g * *g;
        }
        square.sqrt()
    }

    /// Goes along the step as far as the gradient, of this size, gets less. Answers its size there.
    fn go(&mut self, view: View, island: &Island, size: f64) -> f64 {
        let all = island.coordinates.clone();
        let (mut far, mut gone, mut left) = (1.0, 0.0, size);
        for _ in 0..HALVINGS {
            let more = far - gone;
            for (z, s) in self.z[all.clone()].iter_mut().zip(&self.step[all.clone()]) {
                *z += more * s;
            }
            for &touch in &view.islands.touches[island.touches.clone()] {
                let iterate = &mut self.iterates[touch];
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
    fn go_down(&mut self, view: View, island: &Island) -> f64 {
        let own = &view.islands.touches[island.touches.clone()];
        let all = island.coordinates.clone();
        let (mut linear, mut square) = (0.0, 0.0);
        for (z, s) in self.z[all.clone()].iter().zip(&self.step[all.clone()]) {
            linear += z * s;
            square += s * s;
        }
        let iterates = &self.iterates;
        let slope = |far: f64| {
            own.iter().fold(linear + far * square, |sum, &touch| {
                let i = &iterates[touch];
                let u = i.u + far * i.along;
                let (plus, _) = i.doing.soft(i.rho, i.p, i.over(u), u - i.from);
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
        for &touch in own {
            let iterate = &mut self.iterates[touch];
            iterate.u += far * iterate.along;
        }
        self.find_gradient(view, island)
    }

    /// Lets coordinates and velocities of an island follow from its impulses.
    pub fn follow(&mut self, view: View, island: &Island) {
        let own = &view.islands.touches[island.touches.clone()];
        self.z[island.coordinates.clone()].fill(0.0);
        for &touch in own {
            let Iterate { p, before, .. } = self.iterates[touch];
            add_transposed(view, touch, p - before, &mut self.z);
        }
        for &touch in own {
            self.iterates[touch].u = self.iterates[touch].start + times(view, touch, &self.z);
        }
    }

    /// H and its factor.
    fn factor(&mut self, view: View, island: &Island) {
        let View { coordinates, islands, .. } = view;
        let base = island.coordinates.start;
        let order = islands.order_of(island);
        self.h.begin(order.iter().flat_map(|&node| {
            let first = islands.reach[node] - base;
            std::iter::repeat_n(first, coordinates.nodes[node].size)
        }));
        for row in 0..island.coordinates.len() {
            self.h.arms(row, row).1[0] = 1.0;
        }
        for &touch in &islands.touches[island.touches.clone()] {
            let iterate = &mut self.iterates[touch];
            iterate.factored = iterate.d;
            let d = iterate.d;
            if d == DMat3::ZERO {
                continue;
            }
            let own = &view.touches[touch];
            let parts = coordinates.parts_of(own);
            for p in parts {
                let (of_p, size_p) = (coordinates.block(p, own.rows), coordinates.nodes[p.node].size);
                let at_p = islands.place[p.node] - base;
                for q in parts {
                    let at_q = islands.place[q.node] - base;
                    let (of_q, size_q) = (coordinates.block(q, own.rows), coordinates.nodes[q.node].size);
                    // A mechanism that joints hold fast has no coordinates.
                    if at_q > at_p || size_q == 0 {
                        continue;
                    }
                    for i in 0..size_p {
                        let column = take(of_p, own.rows, size_p, i);
                        // Row i of Bₚᵀ D and column i of D Bₚ.
                        let (before, after) = (d.transpose() * column, d * column);
                        let end = if at_p == at_q { i + 1 } else { size_q };
                        let (row, upright) = self.h.arms(at_p + i, at_q);
                        let (row, upright) = (&mut row[..end], &mut upright[..end]);
                        for (k, b) in of_q.chunks_exact(size_q).enumerate() {
                            let (before, after) = (before[k], after[k]);
                            for ((row, upright), b) in row.iter_mut().zip(&mut *upright).zip(b) {
                                *row += before * b;
                                *upright += after * b;
                            }
                        }
                    }
                }
            }
        }
        self.effort += SOLVED * island.touches.len() as u64 + self.h.factor();
    }
}

/// B z of a touch.
#[inline]
fn times(view: View, touch: usize, z: &[f64]) -> DVec3 {
    let own = &view.touches[touch];
    let mut u = DVec3::ZERO;
    for part in view.coordinates.parts_of(own) {
        let size = view.coordinates.nodes[part.node].size;
        let z = &z[view.islands.place[part.node]..][..size];
        let block = view.coordinates.block(part, own.rows);
        // Most are three rows of six: a point of a free body.
        if let (Some(rows), Some(z)) = (block.as_chunks::<6>().0.first_chunk::<3>(), z.first_chunk::<6>())
            && block.len() == 18
            && size == 6
        {
            let row = |b: &[f64; 6]| {
                let sum = |k: usize| b[k] * z[k] + b[k + 3] * z[k + 3];
                sum(0) + sum(1) + sum(2)
            };
            u += DVec3::new(row(&rows[0]), row(&rows[1]), row(&rows[2]));
            continue;
        }
        for (k, row) in block.chunks_exact(size.max(1)).enumerate() {
            u[k] += row.iter().zip(z).map(|(b, z)| b * z).sum::<f64>();
        }
    }
    u
}

/// Adds Bᵀ p of a touch.
#[inline]
fn add_transposed(view: View, touch: usize, p: DVec3, z: &mut [f64]) {
    if p == DVec3::ZERO {
        return;
    }
    let own = &view.touches[touch];
    for part in view.coordinates.parts_of(own) {
        let size = view.coordinates.nodes[part.node].size;
        let z = &mut z[view.islands.place[part.node]..][..size];
        let block = view.coordinates.block(part, own.rows);
        if size == 6
            && block.len() == 18
            && let Some(rows) = block.as_chunks::<6>().0.first_chunk::<3>()
        {
            for (k, z) in z.iter_mut().enumerate() {
                *z += rows[0][k] * p.x + rows[1][k] * p.y + rows[2][k] * p.z;
            }
            continue;
        }
        for (k, row) in block.chunks_exact(size.max(1)).enumerate() {
            for (z, b) in z.iter_mut().zip(row) {
                *z += b * p[k];
            }
        }
    }
}

/// A column of a part's matrix.
fn take(block: &[f64], rows: usize, size: usize, column: usize) -> DVec3 {
    let at = |row: usize| if row < rows { block[row * size + column] } else { 0.0 };
    DVec3::new(at(0), at(1), at(2))
}

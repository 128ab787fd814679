//! Solves the contact problem island by island: sweeps find who presses, sticks and slides, leaps (`leap.rs`) the impulses.
//!
//! With the coordinates z of `coordinates.rs` and the laws of `law.rs`, impulses and velocities obey
//!
//! ```text
//! z = Bᵀ (P − P₀)        u = u₀ + B z        P by its law
//! ```
//!
//! A *sweep* (block Gauss–Seidel; M. Jean, The non-smooth contact dynamics method, 1999) goes from touch to touch, each exact for
//! itself. Sweeps settle who does what long before they find the impulses, above all in stacks and where heavy bodies lie on
//! light ones; a *leap* solves for all touches at once. Sweeps come first; then leaps go on while they help, and where one does not,
//! sweeps are made and the other kind of leap is tried. Whatever is taken has brought the touches nearer to their laws. A touch's normal impulse bounds
//! its couple: that bound is taken from the last sweep.

use super::active_set_step::Leap;
use super::contact::{ROUNDING, Touch};
use super::contact_law::{Answer, Doing, Law};
use super::envelope::Envelope;
use super::islands::{Island, Islands};
use super::reduced_coordinates::Coordinates;
use crate::dynamics::work_budget::SWEPT;
use soffio_math::{DMat3, DVec3};

/// Touches agree with their laws when none would change a velocity of its own by more than this, m/s (a resting body creeps by
/// less than a hundredth of a micrometre a minute), or by more than this share of it.
const SETTLED: f64 = 1e-11;
const AGREES: f64 = 1e-8;
/// They nearly do by this, or by this share of the velocities that impulses make alone: where steps are dear, that will do.
const NEARLY: f64 = 1e-5;
const NEARLY_SHARE: f64 = 1e-7;
/// Impulses that miss them by this, or by this share of the velocities that they make alone, are better to begin from than none.
const GOOD: f64 = 1e-4;
const GOOD_SHARE: f64 = 0.01;
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
/// Kinds of leaps.
const KINDS: usize = 2;
/// Sweeps at first and after a leap that helps little, and leaps at most, where steps are cheap and where they are dear; then the
/// best impulses so far are taken.
const SWEEPS: usize = 5;
const MOST_LEAPS: usize = 12;
const FEW_LEAPS: usize = 6;
/// A touch on the way to its impulse.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Iterate {
    /// Velocity before anything but P₀ acts, and at present, m/s.
    pub start: DVec3,
    pub u: DVec3,
    /// u along a step.
    pub(super) along: DVec3,
    /// P, the best P so far, P⁺, and P₀, N s.
    pub p: DVec3,
    pub(super) best: DVec3,
    pub(super) plus: DVec3,
    pub before: DVec3,
    /// Least velocity along the normal, m/s.
    pub least: f64,
    pub(super) law: Law,
    pub(super) answer: Answer,
    /// What it is taken to go on doing in a leap, from this velocity, with this ρ.
    pub(super) doing: Doing,
    pub(super) from: DVec3,
    pub(super) rho: f64,
    /// D, and that of the factor at hand.
    pub(super) d: DMat3,
    pub(super) factored: DMat3,
    /// Is P good enough to begin from next time?
    pub good: bool,
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
    pub(super) fn over(&self, u: DVec3) -> DVec3 {
        DVec3::new(u.x - self.least, u.y, u.z)
    }

    /// By how much an impulse would change the touch's own velocity beyond what is rounding, m/s.
    fn misses(&self, to: DVec3) -> f64 {
        let change = (self.answer.k * (to - self.p)).abs().max_element();
        self.answer.arm * (change - AGREES * self.u.length() - ROUNDING * self.answer.k.x_axis.x * self.p.x)
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
    pub(super) z: Vec<f64>,
    pub(super) gradient: Vec<f64>,
    pub(super) step: Vec<f64>,
    pub(super) h: Envelope,
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

    /// Solves for all impulses from where they stand.
    pub fn solve(&mut self, view: View) {
        for island in &view.islands.islands {
            let good = self.solve_island(view, island);
            view.islands.touches[island.touches.clone()].iter().for_each(|&touch| self.iterates[touch].good = good);
        }
    }

    /// Answers whether the impulses are good enough to begin from next time.
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
        let (mut left, leaps) = if cheap { (MOST_STEPS, MOST_LEAPS) } else { (FEW_STEPS, FEW_LEAPS) };
        let (mut softness, mut kind, mut idle, mut mark) = (SOFTEST, Leap::AsNow, 0, best);
        for leap in 0..leaps {
            // Sweeps come first: they go on from where the touches were, where several impulses obey the laws.
            if leap == 0 || idle > 0 {
                let _ = (0..SWEEPS).find(|_| self.sweep(view, own) <= SETTLED);
                let missed = self.missed(view, own);
                best = self.keep_better(own, missed, best);
            }
            let begun = best;
            let mut better = false;
            if best > SETTLED && left > 0 && (cheap || best <= NEAR) {
                better = self.leap(view, island, (kind, softness), &mut left);
                let missed = self.missed(view, own);
                best = self.keep_better(own, missed, best);
            }
            if better && best <= ENOUGH * begun {
                (idle, softness) = (0, (softness * HARDER).max(HARDEST));
            } else {
                // Hard touches make much of rounding.
                (idle, softness) = (idle + 1, SOFTEST);
                kind = if kind == Leap::Convex { Leap::AsNow } else { Leap::Convex };
            }
            let ends = if cheap {
                // Both kinds and the sweeps between them have brought little: rounding, or touches that have no answer.
                idle > 0 && idle % KINDS == 0 && best > ENOUGH * std::mem::replace(&mut mark, best)
            } else {
                idle > 0 && best <= NEARLY + NEARLY_SHARE * scale(self)
            };
            if best <= SETTLED || ends {
                break;
            }
        }
        own.iter().for_each(|&touch| self.iterates[touch].p = self.iterates[touch].best);
        self.follow(view, island);
        best <= GOOD + GOOD_SHARE * scale(self)
    }

    /// Keeps the impulses as they are if they miss the laws by less than the best so far. Answers what the best miss.
    fn keep_better(&mut self, own: &[usize], missed: f64, best: f64) -> f64 {
        if missed < best {
            self.keep(own);
        }
        best.min(missed)
    }

    fn keep(&mut self, own: &[usize]) {
        own.iter().for_each(|&touch| self.iterates[touch].best = self.iterates[touch].p);
    }

    /// Takes a couple's bounds from its point's impulse.
    pub(super) fn renew_law(&mut self, view: View, touch: usize) {
        if let Law::Couple(..) = self.iterates[touch].law
            && let Some(twist) = view.touches[touch].twist
        {
            self.iterates[touch].law = view.touches[touch].law(self.iterates[twist.of].p.x);
        }
    }

    /// By how much touches miss their laws at most, each by what a step of its own would change, m/s.
    pub(super) fn missed(&mut self, view: View, own: &[usize]) -> f64 {
        let mut most: f64 = 0.0;
        for &touch in own {
            self.renew_law(view, touch);
            let iterate = &self.iterates[touch];
            most = worse(most, iterate.misses(iterate.law.relax(&iterate.answer, iterate.p, iterate.over(iterate.u))));
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
            most = worse(most, iterate.misses(to));
            let change = to - iterate.p;
            iterate.p = to;
            add_transposed(view, touch, change, &mut self.z);
        }
        most
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
}

/// The larger of two; what is no number is larger than any.
fn worse(most: f64, other: f64) -> f64 {
    if other <= most {
        most
    } else if other.is_nan() {
        f64::INFINITY
    } else {
        other
    }
}

/// B z of a touch.
#[inline]
pub(super) fn times(view: View, touch: usize, z: &[f64]) -> DVec3 {
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
pub(super) fn add_transposed(view: View, touch: usize, p: DVec3, z: &mut [f64]) {
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

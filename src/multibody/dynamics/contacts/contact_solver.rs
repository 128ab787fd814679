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

use super::active_set_step::ActiveSetKind;
use super::contact::{Contact, ROUNDING};
use super::contact_law::{ActiveBranch, ContactLaw, EffectiveInverseMass};
use super::envelope::Envelope;
use super::islands::{Island, Islands};
use super::reduced_coordinates::Coordinates;
use crate::dynamics::work_budget::SWEEP_CONTACT_OPERATIONS;
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
const MAX_ACTIVE_SET_STEPS: usize = 12;
const MAX_ACTIVE_SET_STEPS_LARGE: usize = 6;
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
    pub(super) law: ContactLaw,
    pub(super) answer: EffectiveInverseMass,
    /// What it is taken to go on doing in a leap, from this velocity, with this ρ.
    pub(super) branch: ActiveBranch,
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
    pub fn new(contact: &Contact, start: DVec3) -> Self {
        let (p, before, least) = (contact.before, contact.before, contact.least);
        Self { start, u: start, p, before, least, answer: contact.answer, ..Self::default() }
    }

    /// A touch that is to open by `goal` or more, from nothing.
    pub fn pushed(contact: &Contact, goal: f64, law: ContactLaw) -> Self {
        Self { least: goal, answer: contact.answer, law, ..Self::default() }
    }

    /// Begins from a touch's impulse, under this law.
    pub fn begin(&mut self, contact: &Contact, law: ContactLaw) {
        (self.p, self.least, self.law) = (contact.impulse, contact.least, law);
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
pub(super) struct ProblemView<'a> {
    pub contacts: &'a [Contact],
    pub coordinates: &'a Coordinates,
    pub islands: &'a Islands,
}

/// The solver. Impulses go in and come out in its iterates.
#[derive(Clone, Debug, Default)]
pub(super) struct ContactSolver {
    pub iterates: Vec<Iterate>,
    /// z, g and Newton's step, coordinate by coordinate.
    pub(super) z: Vec<f64>,
    pub(super) gradient: Vec<f64>,
    pub(super) step: Vec<f64>,
    pub(super) h: Envelope,
    /// Operations so far (`dynamics/operations.rs`).
    pub operations: u64,
}

impl ContactSolver {
    /// Room for about so many touches of so many bodies.
    pub fn with_room(contacts: usize, bodies: usize) -> Self {
        let coordinates = 6 * bodies.min(2 * contacts);
        Self {
            iterates: Vec::with_capacity(contacts),
            z: Vec::with_capacity(coordinates),
            gradient: Vec::with_capacity(coordinates),
            step: Vec::with_capacity(coordinates),
            h: Envelope::with_room(coordinates, 6 * coordinates.min(16)),
            operations: 0,
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
    pub fn solve(&mut self, view: ProblemView) {
        for island in &view.islands.islands {
            let good = self.solve_island(view, island);
            view.islands.contacts[island.contacts.clone()]
                .iter()
                .for_each(|&contact| self.iterates[contact].good = good);
        }
    }

    /// Answers whether the impulses are good enough to begin from next time.
    fn solve_island(&mut self, view: ProblemView, island: &Island) -> bool {
        let own = &view.islands.contacts[island.contacts.clone()];
        self.follow(view, island);
        let mut best = self.missed(view, own);
        if best <= SETTLED {
            return true;
        }
        self.keep(own);
        let scale = |this: &Self| {
            let alone = |contact: &usize| this.iterates[*contact].answer.k.x_axis.x * this.iterates[*contact].p.x;
            own.iter().map(alone).fold(0.0, f64::max)
        };
        let cheap = self.newton_step_operations(view, island) <= CHEAP;
        let (mut left, leaps) =
            if cheap { (MOST_STEPS, MAX_ACTIVE_SET_STEPS) } else { (FEW_STEPS, MAX_ACTIVE_SET_STEPS_LARGE) };
        let (mut softness, mut kind, mut idle, mut mark) = (SOFTEST, ActiveSetKind::AsNow, 0, best);
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
                better = self.active_set_step(view, island, (kind, softness), &mut left);
                let missed = self.missed(view, own);
                best = self.keep_better(own, missed, best);
            }
            if better && best <= ENOUGH * begun {
                (idle, softness) = (0, (softness * HARDER).max(HARDEST));
            } else {
                // Hard touches make much of rounding.
                (idle, softness) = (idle + 1, SOFTEST);
                kind = if kind == ActiveSetKind::Convex { ActiveSetKind::AsNow } else { ActiveSetKind::Convex };
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
        own.iter().for_each(|&contact| self.iterates[contact].p = self.iterates[contact].best);
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
        own.iter().for_each(|&contact| self.iterates[contact].best = self.iterates[contact].p);
    }

    /// Takes a couple's bounds from its point's impulse.
    pub(super) fn renew_law(&mut self, view: ProblemView, contact: usize) {
        if let ContactLaw::Couple(..) = self.iterates[contact].law
            && let Some(twist) = view.contacts[contact].twist
        {
            self.iterates[contact].law = view.contacts[contact].law(self.iterates[twist.of].p.x);
        }
    }

    /// By how much touches miss their laws at most, each by what a step of its own would change, m/s.
    pub(super) fn missed(&mut self, view: ProblemView, own: &[usize]) -> f64 {
        let mut most: f64 = 0.0;
        for &contact in own {
            self.renew_law(view, contact);
            let iterate = &self.iterates[contact];
            most = worse(most, iterate.misses(iterate.law.relax(&iterate.answer, iterate.p, iterate.over(iterate.u))));
        }
        most
    }

    /// Lets touch after touch satisfy its law. Answers by how much they missed it at most, m/s.
    fn sweep(&mut self, view: ProblemView, own: &[usize]) -> f64 {
        let mut most: f64 = 0.0;
        self.operations += SWEEP_CONTACT_OPERATIONS * own.len() as u64;
        for &contact in own {
            self.renew_law(view, contact);
            self.iterates[contact].u = self.iterates[contact].start + times(view, contact, &self.z);
            let iterate = &mut self.iterates[contact];
            let to = iterate.law.relax(&iterate.answer, iterate.p, iterate.over(iterate.u));
            most = worse(most, iterate.misses(to));
            let change = to - iterate.p;
            iterate.p = to;
            add_transposed(view, contact, change, &mut self.z);
        }
        most
    }

    /// Lets coordinates and velocities of an island follow from its impulses.
    pub fn follow(&mut self, view: ProblemView, island: &Island) {
        let own = &view.islands.contacts[island.contacts.clone()];
        self.z[island.coordinates.clone()].fill(0.0);
        for &contact in own {
            let Iterate { p, before, .. } = self.iterates[contact];
            add_transposed(view, contact, p - before, &mut self.z);
        }
        for &contact in own {
            self.iterates[contact].u = self.iterates[contact].start + times(view, contact, &self.z);
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
pub(super) fn times(view: ProblemView, contact: usize, z: &[f64]) -> DVec3 {
    let own = &view.contacts[contact];
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
pub(super) fn add_transposed(view: ProblemView, contact: usize, p: DVec3, z: &mut [f64]) {
    if p == DVec3::ZERO {
        return;
    }
    let own = &view.contacts[contact];
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

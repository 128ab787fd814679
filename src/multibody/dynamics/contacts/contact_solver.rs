//! Contact solver: block Gauss–Seidel sweeps and semismooth Newton (active-set) steps, island by island.
//!
//! With the coordinates z of `reduced_coordinates.rs` and the laws of `contact_law.rs`, impulses and velocities obey
//!
//! ```text
//! z = Bᵀ (P − P₀)        u = u₀ + B z        P by its law
//! ```
//!
//! A *sweep* (nonlinear block Gauss–Seidel; M. Jean, "The non-smooth contact dynamics method", 1999) solves contact after contact,
//! each exactly. Sweeps find which contacts press, stick and slide long before they find the impulses, above all in stacks and
//! where heavy bodies lie on light ones. An *active-set step* (`active_set_step.rs`) then solves all contacts of an island at once.
//!
//! Sweeps come first. Active-set steps follow as long as they help. Where one does not, the solver sweeps and tries the other kind
//! of step. It keeps the impulses of the smallest residual. A contact point's normal impulse bounds its rolling resistance; that
//! bound is taken from the last sweep.

use super::active_set_step::{ActiveSetKind, ActiveSetStep, StepProgress};
use super::contact::{Contact, ROUNDING};
use super::contact_law::{ActiveBranch, ContactLaw, EffectiveInverseMass};
use super::envelope::Envelope;
use super::islands::{Island, Islands};
use super::reduced_coordinates::ReducedCoordinates;
use crate::dynamics::work_budget::SWEEP_CONTACT_OPERATIONS;
use soffio_math::{DMat3, DVec3};

/// A bound of residuals: an absolute one, and one relative to the velocities that single impulses make.
struct Tolerance {
    /// m/s.
    absolute: f64,
    relative: f64,
}

impl Tolerance {
    /// The bound where the largest velocity of a single impulse is `scale`, m/s.
    fn at(&self, scale: f64) -> f64 {
        self.absolute + self.relative * scale
    }
}

/// How long the solver works and when it is done.
struct Tuning {
    /// Residual of a converged solve, m/s: a resting body then creeps by less than 0.01 µm a minute.
    converged: f64,
    /// A residual below this fraction of the contact's own velocity is rounding.
    rounding_of_velocity: f64,
    /// Enough in a large island, where more steps cost too much.
    converged_large: Tolerance,
    /// Impulses within this are a better start for the next solve than none.
    warm_start: Tolerance,
    /// In a large island, Newton steps begin at this residual, m/s.
    newton_large: f64,
    /// An island is large when one Newton step takes more operations. Towers, walls and all that a visitor moves at once are
    /// below; a heap of fifty boxes is above.
    large_operations: u64,
    /// Newton steps of one solve in a small and in a large island.
    newton_steps: usize,
    newton_steps_large: usize,
    /// Active-set steps of one solve in a small and in a large island.
    active_set_steps: usize,
    active_set_steps_large: usize,
    /// Gauss–Seidel sweeps at first, and after a step that helps little.
    sweeps: usize,
    /// Softness of contacts, as a fraction of their inverse mass: of the first step, its factor after each step that helps, and
    /// the least.
    softness: f64,
    softness_factor: f64,
    min_softness: f64,
    /// A step that leaves more than this fraction of the residual helps little.
    helps: f64,
}

/// Measured on towers, walls, heaps, gears and chains of the tests and of `bench`.
const TUNING: Tuning = Tuning {
    converged: 1e-11,
    rounding_of_velocity: 1e-8,
    converged_large: Tolerance { absolute: 1e-5, relative: 1e-7 },
    warm_start: Tolerance { absolute: 1e-4, relative: 0.01 },
    newton_large: 1e-3,
    large_operations: 200_000,
    newton_steps: 40,
    newton_steps_large: 2,
    active_set_steps: 12,
    active_set_steps_large: 6,
    sweeps: 5,
    softness: 1e-3,
    softness_factor: 1e-2,
    min_softness: 1e-7,
    helps: 0.3,
};

/// Kinds of active-set steps.
const KINDS: usize = 2;

/// How a solve ended, by its residual.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum SolveOutcome {
    /// All laws hold to rounding.
    Converged,
    /// Accurate enough to start the next solve from.
    Approximate,
    /// Not accurate enough for that.
    #[default]
    Inaccurate,
}

impl SolveOutcome {
    /// Whether the impulses are a good start for the next solve.
    pub fn is_warm_start(self) -> bool {
        self != Self::Inaccurate
    }
}

/// State of one contact during a solve.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Iterate {
    /// u₀, m/s.
    pub start: DVec3,
    /// u, m/s.
    pub u: DVec3,
    /// B times the Newton step, m/s.
    pub(super) direction: DVec3,
    /// P, N s.
    pub p: DVec3,
    /// The P of the smallest residual so far, N s.
    pub(super) best: DVec3,
    /// P⁺, N s.
    pub(super) plus: DVec3,
    /// P₀, N s.
    pub applied: DVec3,
    /// t: least allowed normal velocity, m/s.
    pub min_velocity: f64,
    pub(super) law: ContactLaw,
    pub(super) inverse_mass: EffectiveInverseMass,
    /// Branch that the active-set step assumes, and u where it was chosen, m/s.
    pub(super) branch: ActiveBranch,
    pub(super) branch_velocity: DVec3,
    /// ρ, kg.
    pub(super) rho: f64,
    /// D, and the D of the factored matrix, kg.
    pub(super) d: DMat3,
    pub(super) factored: DMat3,
    /// How the last solve of its island ended.
    pub outcome: SolveOutcome,
}

impl Iterate {
    /// A contact with its initial velocity and the impulse that has acted.
    pub fn new(contact: &Contact, start: DVec3) -> Self {
        let (p, applied, min_velocity) = (contact.applied, contact.applied, contact.min_velocity);
        Self { start, u: start, p, applied, min_velocity, inverse_mass: contact.inverse_mass, ..Self::default() }
    }

    /// A contact at rest that is to open at `min_velocity` (m/s) or faster.
    pub fn opening(contact: &Contact, min_velocity: f64, law: ContactLaw) -> Self {
        Self { min_velocity, inverse_mass: contact.inverse_mass, law, ..Self::default() }
    }

    /// Starts from a contact's impulse, under this law.
    pub fn begin(&mut self, contact: &Contact, law: ContactLaw) {
        (self.p, self.min_velocity, self.law) = (contact.impulse, contact.min_velocity, law);
    }

    /// u less the least allowed velocity, m/s.
    pub(super) fn excess(&self, u: DVec3) -> DVec3 {
        DVec3::new(u.x - self.min_velocity, u.y, u.z)
    }

    /// Residual: the change of the contact's velocity by the impulse that its law asks for, less rounding, m/s.
    fn residual(&self, to: DVec3) -> f64 {
        let change = (self.inverse_mass.k * (to - self.p)).abs().max_element();
        let rounding = ROUNDING * self.inverse_mass.k.x_axis.x * self.p.x;
        self.inverse_mass.arm * (change - TUNING.rounding_of_velocity * self.u.length() - rounding)
    }
}

/// The problem as the solver reads it.
#[derive(Clone, Copy)]
pub(super) struct ProblemView<'a> {
    /// The contacts.
    pub contacts: &'a [Contact],
    /// Their reduced coordinates.
    pub coordinates: &'a ReducedCoordinates,
    /// The islands that they form.
    pub islands: &'a Islands,
}

/// The contact solver. Impulses go in and come out in its iterates.
#[derive(Clone, Debug, Default)]
pub(super) struct ContactSolver {
    /// State of each contact during the solution.
    pub iterates: Vec<Iterate>,
    /// z, the gradient g and the Newton step, by coordinates.
    pub(super) z: Vec<f64>,
    pub(super) gradient: Vec<f64>,
    pub(super) step: Vec<f64>,
    pub(super) hessian: Envelope,
    /// Operations so far (`dynamics/work_budget.rs`).
    pub operations: u64,
}

impl ContactSolver {
    /// Capacity for about so many contacts of so many bodies.
    pub fn with_capacity(contacts: usize, bodies: usize) -> Self {
        let coordinates = 6 * bodies.min(2 * contacts);
        Self {
            iterates: Vec::with_capacity(contacts),
            z: Vec::with_capacity(coordinates),
            gradient: Vec::with_capacity(coordinates),
            step: Vec::with_capacity(coordinates),
            hessian: Envelope::with_capacity(coordinates, 6 * coordinates.min(16)),
            operations: 0,
        }
    }

    /// Begins a problem of `count` coordinates: all impulses are P₀, all velocities u₀.
    pub fn begin(&mut self, count: usize) {
        for numbers in [&mut self.z, &mut self.gradient, &mut self.step] {
            numbers.clear();
            numbers.resize(count, 0.0);
        }
    }

    /// Solves for all impulses from the present ones.
    pub fn solve(&mut self, view: ProblemView) {
        for island in &view.islands.islands {
            let outcome = self.solve_island(view, island);
            let own = &view.islands.contacts[island.contacts.clone()];
            own.iter().for_each(|&contact| self.iterates[contact].outcome = outcome);
        }
    }

    fn solve_island(&mut self, view: ProblemView, island: &Island) -> SolveOutcome {
        let own = &view.islands.contacts[island.contacts.clone()];
        self.update_velocities(view, island);
        let mut best = self.residual(view, own);
        if best <= TUNING.converged {
            return SolveOutcome::Converged;
        }
        self.store_best(own);
        let scale = |this: &Self| {
            let alone = |contact: &usize| this.iterates[*contact].inverse_mass.k.x_axis.x * this.iterates[*contact].p.x;
            own.iter().map(alone).fold(0.0, f64::max)
        };
        let is_small = self.newton_step_operations(view, island) <= TUNING.large_operations;
        let (mut newton_steps, steps) = if is_small {
            (TUNING.newton_steps, TUNING.active_set_steps)
        } else {
            (TUNING.newton_steps_large, TUNING.active_set_steps_large)
        };
        let (mut softness, mut kind) = (TUNING.softness, ActiveSetKind::Current);
        // Steps in a row that helped little, and the residual where both kinds were last tried.
        let (mut idle, mut mark) = (0, best);
        for step in 0..steps {
            // Of several solutions, sweeps stay near the one at the start.
            if step == 0 || idle > 0 {
                let _ = (0..TUNING.sweeps).find(|_| self.sweep(view, own) <= TUNING.converged);
                let residual = self.residual(view, own);
                best = self.keep_better(own, residual, best);
            }
            let before = best;
            let mut progress = StepProgress::None;
            if best > TUNING.converged && newton_steps > 0 && (is_small || best <= TUNING.newton_large) {
                progress = self.active_set_step(view, island, ActiveSetStep { kind, softness }, &mut newton_steps);
                let residual = self.residual(view, own);
                best = self.keep_better(own, residual, best);
            }
            if progress == StepProgress::Improved && best <= TUNING.helps * before {
                (idle, softness) = (0, (softness * TUNING.softness_factor).max(TUNING.min_softness));
            } else {
                // Hard contacts amplify rounding.
                (idle, softness) = (idle + 1, TUNING.softness);
                kind = if kind == ActiveSetKind::Convex { ActiveSetKind::Current } else { ActiveSetKind::Convex };
            }
            let ends = if is_small {
                // Both kinds, and the sweeps between them, helped little: rounding, or there is no solution.
                idle > 0 && idle % KINDS == 0 && best > TUNING.helps * std::mem::replace(&mut mark, best)
            } else {
                idle > 0 && best <= TUNING.converged_large.at(scale(self))
            };
            if best <= TUNING.converged || ends {
                break;
            }
        }
        own.iter().for_each(|&contact| self.iterates[contact].p = self.iterates[contact].best);
        self.update_velocities(view, island);
        if best <= TUNING.converged {
            SolveOutcome::Converged
        } else if best <= TUNING.warm_start.at(scale(self)) {
            SolveOutcome::Approximate
        } else {
            SolveOutcome::Inaccurate
        }
    }

    /// Stores the present impulses if their residual is smaller than the best one. Returns the smaller of both.
    fn keep_better(&mut self, own: &[usize], residual: f64, best: f64) -> f64 {
        if residual < best {
            self.store_best(own);
        }
        best.min(residual)
    }

    fn store_best(&mut self, own: &[usize]) {
        own.iter().for_each(|&contact| self.iterates[contact].best = self.iterates[contact].p);
    }

    /// Takes the bound of a rolling resistance from the normal impulse of its point.
    pub(super) fn update_law(&mut self, view: ProblemView, contact: usize) {
        if let ContactLaw::Rolling { .. } = self.iterates[contact].law
            && let Some(point) = view.contacts[contact].bounding_point()
        {
            self.iterates[contact].law = view.contacts[contact].law(self.iterates[point].p.x);
        }
    }

    /// Largest residual of these contacts, m/s.
    pub(super) fn residual(&mut self, view: ProblemView, own: &[usize]) -> f64 {
        let mut largest: f64 = 0.0;
        for &contact in own {
            self.update_law(view, contact);
            let iterate = &self.iterates[contact];
            let to = iterate.law.relax(&iterate.inverse_mass, iterate.p, iterate.excess(iterate.u));
            largest = larger(largest, iterate.residual(to));
        }
        largest
    }

    /// One Gauss–Seidel sweep. Returns the largest residual met on it, m/s.
    fn sweep(&mut self, view: ProblemView, own: &[usize]) -> f64 {
        let mut largest: f64 = 0.0;
        self.operations += SWEEP_CONTACT_OPERATIONS * own.len() as u64;
        for &contact in own {
            self.update_law(view, contact);
            self.iterates[contact].u = self.iterates[contact].start + multiply(view, contact, &self.z);
            let iterate = &mut self.iterates[contact];
            let to = iterate.law.relax(&iterate.inverse_mass, iterate.p, iterate.excess(iterate.u));
            largest = larger(largest, iterate.residual(to));
            let change = to - iterate.p;
            iterate.p = to;
            add_transposed(view, contact, change, &mut self.z);
        }
        largest
    }

    /// Finds the coordinates and velocities of an island from its impulses.
    pub fn update_velocities(&mut self, view: ProblemView, island: &Island) {
        let own = &view.islands.contacts[island.contacts.clone()];
        self.z[island.coordinates.clone()].fill(0.0);
        for &contact in own {
            let Iterate { p, applied, .. } = self.iterates[contact];
            add_transposed(view, contact, p - applied, &mut self.z);
        }
        for &contact in own {
            self.iterates[contact].u = self.iterates[contact].start + multiply(view, contact, &self.z);
        }
    }
}

/// The larger of two; NaN counts as infinite.
fn larger(largest: f64, other: f64) -> f64 {
    if other <= largest {
        largest
    } else if other.is_nan() {
        f64::INFINITY
    } else {
        other
    }
}

/// B z of a contact.
#[inline]
pub(super) fn multiply(view: ProblemView, contact: usize, z: &[f64]) -> DVec3 {
    let own = &view.contacts[contact];
    let mut u = DVec3::ZERO;
    for block in view.coordinates.blocks_of(own) {
        let size = view.coordinates.nodes[block.node].size;
        let z = &z[view.islands.first_coordinate[block.node]..][..size];
        let matrix = view.coordinates.matrix(block, own.rows.len());
        // Most are three rows of six: a point of a free body.
        if let (Some(rows), Some(z)) = (matrix.as_chunks::<6>().0.first_chunk::<3>(), z.first_chunk::<6>())
            && matrix.len() == 18
            && size == 6
        {
            let row = |b: &[f64; 6]| {
                let sum = |k: usize| b[k] * z[k] + b[k + 3] * z[k + 3];
                sum(0) + sum(1) + sum(2)
            };
            u += DVec3::new(row(&rows[0]), row(&rows[1]), row(&rows[2]));
            continue;
        }
        for (k, row) in matrix.chunks_exact(size.max(1)).enumerate() {
            u[k] += row.iter().zip(z).map(|(b, z)| b * z).sum::<f64>();
        }
    }
    u
}

/// Adds Bᵀ p of a contact to `z`.
#[inline]
pub(super) fn add_transposed(view: ProblemView, contact: usize, p: DVec3, z: &mut [f64]) {
    if p == DVec3::ZERO {
        return;
    }
    let own = &view.contacts[contact];
    for block in view.coordinates.blocks_of(own) {
        let size = view.coordinates.nodes[block.node].size;
        let z = &mut z[view.islands.first_coordinate[block.node]..][..size];
        let matrix = view.coordinates.matrix(block, own.rows.len());
        if size == 6
            && matrix.len() == 18
            && let Some(rows) = matrix.as_chunks::<6>().0.first_chunk::<3>()
        {
            for (k, z) in z.iter_mut().enumerate() {
                *z += rows[0][k] * p.x + rows[1][k] * p.y + rows[2][k] * p.z;
            }
            continue;
        }
        for (k, row) in matrix.chunks_exact(size.max(1)).enumerate() {
            for (z, b) in z.iter_mut().zip(row) {
                *z += b * p[k];
            }
        }
    }
}

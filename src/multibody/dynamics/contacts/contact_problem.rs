//! The contact problem: a nonlinear complementarity problem for the impulses of all contacts at once, joints held.
//!
//! Signorini's condition of unilateral contact and Coulomb's friction cone, as in nonsmooth contact dynamics (J. J. Moreau 1988;
//! M. Jean 1999). J are the Jacobian rows of all contacts, H the joints' system, u = J v the contact velocities, P the impulses,
//! and t the least allowed normal velocities:
//!
//! ```text
//! u = u₀ + W (P − P₀)        W = J H⁻¹ Jᵀ       (P₀ has already acted)
//! 0 ≤ P_n ⟂ u_n − t ≥ 0      no pull, no approach, no push where it opens          (Signorini)
//! |P_T| ≤ μ P_n              u_T = 0 inside the cone, P_T = −μ P_n u_T/|u_T| on it  (Coulomb)
//! ```
//!
//! W is never formed as a whole. `reduced_coordinates.rs` factors it by bodies and mechanisms, `islands.rs` finds independent
//! parts, and `contact_solver.rs` solves them. W is only positive semi-definite (four feet of a box, bodies on hinges): the
//! velocities are unique where there is friction, and redundant impulses are those nearest to the solver's start.

use super::contact::{Contact, ContactKind, LOCKED, PROXIMAL};
use super::contact_law::{ContactLaw, EffectiveInverseMass};
use super::contact_solver::{ContactSolver, Iterate, ProblemView};
use super::islands::{Island, Islands};
use super::jacobian_row::JacobianRow;
use super::open_joints::Stabilization;
use super::reduced_coordinates::{Mechanisms, ReducedCoordinates};
use crate::articulation::System;
use crate::dynamics::work_budget::CONTACT_OPERATIONS;
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{angular, linear, vec6};
use soffio_math::{DMat3, DVec3};

/// Capacity for contacts; more of them at once make lists grow.
const CAPACITY: usize = 256;

/// Displacements are found as velocities over this time, s: the solver's tolerance of 10⁻⁵ m/s is then 10 nm.
const PUSH_TIME: f64 = 1e-3;

/// All contacts of one moment, their rows, and the solver.
#[derive(Clone, Debug)]
pub(super) struct ContactProblem {
    /// The contacts.
    pub contacts: Vec<Contact>,
    /// Their rows, contact by contact.
    pub rows: Vec<JacobianRow>,
    coordinates: ReducedCoordinates,
    islands: Islands,
    solver: ContactSolver,
    /// Impulse of each row.
    impulses: Vec<f64>,
    /// Operations so far (`dynamics/work_budget.rs`).
    pub operations: u64,
}

impl ContactProblem {
    /// Capacity for about this many contacts among these mechanisms.
    pub fn new(contacts: usize, mechanisms: Mechanisms, stabilization: Stabilization) -> Self {
        let (contacts, bodies) = (contacts.min(CAPACITY), mechanisms.count());
        Self {
            contacts: Vec::with_capacity(contacts),
            rows: Vec::with_capacity(3 * contacts),
            solver: ContactSolver::with_capacity(contacts, bodies),
            coordinates: ReducedCoordinates::new(mechanisms, contacts, stabilization),
            islands: Islands::with_capacity(bodies, contacts),
            impulses: Vec::with_capacity(3 * contacts),
            operations: 0,
        }
    }

    /// Removes all contacts.
    pub fn clear(&mut self) {
        self.contacts.clear();
        self.rows.clear();
    }

    /// Adds a contact with its rows.
    pub fn push(&mut self, mut contact: Contact, rows: &[JacobianRow]) {
        (contact.rows.start, contact.rows.end) = (self.rows.len(), self.rows.len() + rows.len());
        self.rows.extend_from_slice(rows);
        self.contacts.push(contact);
    }

    /// Finds coordinates, islands and inverse masses at the bodies' present state, where the joints must be factored. All
    /// impulses are those that have acted.
    pub fn assemble(&mut self, system: &mut System, bodies: &[RigidBody]) {
        let Self { contacts, rows, coordinates, islands, solver, .. } = self;
        coordinates.assemble(contacts, rows, system, bodies);
        islands.find(coordinates, contacts);
        self.operations += CONTACT_OPERATIONS * contacts.len() as u64;
        solver.begin(coordinates.nodes.iter().map(|node| node.size).sum());
        solver.iterates.clear();
        for index in 0..contacts.len() {
            contacts[index].find_inverse_mass(coordinates);
            if let Some(point) = contacts[index].bounding_point() {
                let push = contacts[point].inverse_mass.k.x_axis.x;
                contacts[index].inverse_mass.arm = (push / contacts[index].inverse_mass.largest().max(LOCKED)).sqrt();
            }
            let contact = &contacts[index];
            let rate = |k: usize| if k < contact.rows.len() { rows[contact.rows.start + k].rate(bodies) } else { 0.0 };
            let start = DVec3::new(rate(0), rate(1), rate(2));
            solver.iterates.push(Iterate::new(contact, start));
        }
    }

    /// Sets every impulse to the contact's own initial guess.
    pub fn start_from_initial(&mut self) {
        self.contacts.iter_mut().for_each(|contact| contact.impulse = contact.initial);
    }

    /// Velocity of a contact (n, t, b) under the impulses last solved for, m/s.
    pub fn velocity(&self, contact: usize) -> DVec3 {
        self.solver.iterates[contact].u
    }

    /// Approach speed of a contact at the fraction `s` of a substep that began at `start`, m/s. Forces change it evenly.
    pub fn approach(&self, contact: usize, s: f64, start: &[RigidBody]) -> f64 {
        let (first, last) = (self.rows[self.contacts[contact].rows.start].rate(start), self.velocity(contact).x);
        -(first + s * (last - first))
    }

    /// Finds all velocities from the present impulses.
    pub fn update_velocities(&mut self) {
        for (contact, iterate) in self.contacts.iter().zip(&mut self.solver.iterates) {
            iterate.p = contact.impulse;
        }
        let view = ProblemView { contacts: &self.contacts, coordinates: &self.coordinates, islands: &self.islands };
        for island in &self.islands.islands {
            self.solver.update_velocities(view, island);
        }
    }

    /// Solves for all impulses from the present ones: first with all clutches sticking, then with those slipping that would
    /// carry too much. Where teeth jam both may be possible; then clutches stick.
    pub fn solve(&mut self) {
        loop {
            self.solve_with(|contact, contacts| {
                contact.law(contact.bounding_point().map_or(0.0, |point| contacts[point].impulse.x))
            });
            let mut slipped = false;
            for contact in &mut self.contacts {
                let ContactKind::Clutch { max_impulse, slips, .. } = &mut contact.kind else { continue };
                if !*slips && contact.impulse.x.abs() > *max_impulse {
                    (*slips, slipped) = (true, true);
                }
            }
            if !slipped {
                return;
            }
        }
    }

    /// Solves for the friction of contact points alone, their normal impulses given.
    pub fn solve_friction(&mut self) {
        self.solve_with(|contact, _| match contact.kind {
            ContactKind::Point { friction, .. } if contact.inverse_mass.tangential > LOCKED => {
                ContactLaw::Friction { max: friction * contact.impulse.x }
            }
            _ => ContactLaw::Fixed,
        })
    }

    fn solve_with(&mut self, law: impl Fn(&Contact, &[Contact]) -> ContactLaw) {
        let Self { contacts, coordinates, islands, solver, .. } = self;
        for (contact, iterate) in contacts.iter().zip(&mut solver.iterates) {
            iterate.begin(contact, law(contact, contacts));
        }
        solver.solve(ProblemView { contacts, coordinates, islands });
        self.operations += std::mem::take(&mut solver.operations);
        for (contact, iterate) in contacts.iter_mut().zip(&solver.iterates) {
            contact.impulse = iterate.p;
        }
    }

    /// Change of kinetic energy by the impulses beyond P₀, J: (P − P₀)·(u₀ + u)/2.
    pub fn work(&self) -> f64 {
        let work = |iterate: &Iterate| (iterate.p - iterate.applied).dot(0.5 * (iterate.start + iterate.u));
        self.solver.iterates.iter().map(work).sum()
    }

    /// Whether the impulse of a contact is accurate enough to start from next time.
    pub fn is_warm_start(&self, contact: usize) -> bool {
        self.solver.iterates[contact].outcome.is_warm_start()
    }

    /// Iterates of all contacts but rolling resistances, whose velocities are rad/s.
    fn translational(&self) -> impl Iterator<Item = &Iterate> {
        let all = self.contacts.iter().zip(&self.solver.iterates);
        all.filter(|(contact, _)| contact.bounding_point().is_none()).map(|(_, iterate)| iterate)
    }

    /// Largest change of a contact's velocity by the impulses beyond P₀, m/s.
    pub fn largest_change(&self) -> f64 {
        let largest = |max: f64, iterate: &Iterate| max.max((iterate.u - iterate.start).abs().max_element());
        self.translational().fold(0.0, largest)
    }

    /// Slip of the fastest contact, m/s.
    pub fn largest_slip(&self) -> f64 {
        self.translational().fold(0.0, |max: f64, iterate| max.max(iterate.u.with_x(0.0).length()))
    }

    /// Applies P − P₀ to the bodies' velocities.
    pub fn apply(&mut self, system: &mut System, bodies: &mut [RigidBody]) {
        self.take_changes();
        self.push_all(system);
        self.coordinates.solve_impulses(&self.impulses, system);
        system.apply_velocity(bodies);
        // Removes what rounding left to the joints, where large impulses cancel.
        system.solve_velocity(bodies);
        system.apply_velocity(bodies);
    }

    /// Applies P − P₀ and closes the joints in velocity by one solve. While joints are open it does what
    /// [`ContactProblem::apply`] does.
    pub fn apply_closing(&mut self, system: &mut System, bodies: &mut [RigidBody]) {
        if self.has_open_joints() {
            return self.apply(system, bodies);
        }
        self.take_changes();
        self.push_all(system);
        system.solve_velocity_under(bodies);
        system.apply_velocity(bodies);
    }

    /// P − P₀ of each row.
    fn take_changes(&mut self) {
        self.impulses.clear();
        for contact in &self.contacts {
            let change = contact.impulse - contact.applied;
            self.impulses.extend((0..contact.rows.len()).map(|k| change[k]));
        }
    }

    /// Adds the rows' impulses to the right-hand side.
    fn push_all(&self, system: &mut System) {
        system.b.fill([0.0; 6]);
        for (row, impulse) in self.rows.iter().zip(&self.impulses).filter(|(_, impulse)| **impulse != 0.0) {
            for (body, block) in row.ends.iter().flatten() {
                system.push_impulse(*body, block, *impulse);
            }
        }
    }

    /// Whether joints were open, and hence soft, at the last assembly.
    pub fn has_open_joints(&self) -> bool {
        self.coordinates.has_open_joints()
    }

    /// Sets all impulses in the islands of these contacts to zero: those of impacts are no forces to continue.
    pub fn discard_impact_impulses(&mut self, contacts: impl Iterator<Item = usize>) {
        for impact in contacts {
            let with = |island: &&Island| self.islands.contacts[island.contacts.clone()].binary_search(&impact).is_ok();
            if let Some(island) = self.islands.islands.iter().find(with) {
                for &contact in &self.islands.contacts[island.contacts.clone()] {
                    self.contacts[contact].impulse = DVec3::ZERO;
                }
            }
        }
    }

    /// Moves bodies apart by the displacement of least kinetic energy that brings every gap up to `depth` (m, negative), without
    /// friction and by `max` (m) at most. It is the same problem with the velocities of [`PUSH_TIME`] for displacements.
    /// Momentum and angular momentum are kept.
    pub fn push_out(&mut self, depth: f64, max: f64, system: &mut System, bodies: &mut [RigidBody]) {
        let Self { contacts, coordinates, islands, solver, impulses, .. } = self;
        for (contact, iterate) in contacts.iter().zip(&mut solver.iterates) {
            let moves = contact.inverse_mass.k.x_axis.x > LOCKED;
            let law = if moves { ContactLaw::Unilateral } else { ContactLaw::Fixed };
            *iterate = Iterate::opening(contact, (depth - contact.gap).min(max) / PUSH_TIME, law);
        }
        solver.solve(ProblemView { contacts, coordinates, islands });
        impulses.clear();
        for (contact, iterate) in contacts.iter().zip(&solver.iterates) {
            let along = |k: usize| if k == 0 { PUSH_TIME * iterate.p.x } else { 0.0 };
            impulses.extend((0..contact.rows.len()).map(along));
        }
        self.push_all(system);
        self.coordinates.solve_impulses(&self.impulses, system);
        for (body, a) in bodies.iter_mut().zip(&system.a) {
            // The spin's angular momentum keeps its direction.
            let spin = body.inertia_world() * body.angular_velocity;
            body.displace(linear(a), angular(a));
            body.angular_velocity = body.inertia_world().inverse() * spin;
        }
        // Bodies that pass each other at v and are moved by p gain the angular momentum p × v: each gives half of it back.
        system.b.fill([0.0; 6]);
        for contact in self.contacts.iter().filter(|contact| contact.point_pair().is_some()) {
            if let [Some((a, along)), Some((b, _)), _] = self.rows[contact.rows.start].ends {
                let passing = bodies[a].velocity - bodies[b].velocity;
                let impulse = self.impulses[contact.rows.start];
                let back = vec6(DVec3::ZERO, (-0.5 * impulse * linear(&along)).cross(passing));
                system.push_impulse(a, &back, 1.0);
                system.push_impulse(b, &back, 1.0);
            }
        }
        system.solve_impulse();
        system.apply_velocity(bodies);
    }
}

impl Contact {
    /// Takes the contact's own block of W and the largest eigenvalue of its tangential part.
    fn find_inverse_mass(&mut self, coordinates: &ReducedCoordinates) {
        let mut k = [[0.0; 3]; 3];
        for block in coordinates.blocks_of(self) {
            let size = coordinates.nodes[block.node].size;
            let matrix = coordinates.matrix(block, self.rows.len());
            for i in 0..self.rows.len() {
                for j in 0..self.rows.len() {
                    let (row, column) = (&matrix[i * size..][..size], &matrix[j * size..][..size]);
                    k[i][j] += row.iter().zip(column).map(|(x, y)| x * y).sum::<f64>();
                }
            }
        }
        let (a, d, b) = (k[1][1], k[2][2], k[1][2]);
        let (k, trace) = (DMat3::from_cols_array_2d(&k), k[0][0] + a + d);
        let inverse = (k + DMat3::from_diagonal(DVec3::splat(PROXIMAL * trace.max(LOCKED)))).inverse();
        let tangential = 0.5 * (a + d) + (0.25 * (a - d) * (a - d) + b * b).sqrt();
        self.inverse_mass = EffectiveInverseMass { k, inverse, tangential, arm: 1.0 };
    }
}

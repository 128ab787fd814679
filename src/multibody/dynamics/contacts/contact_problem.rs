//! The contact problem: impulses of all touching points and bounds at once, joints held.
//!
//! Symbols: J the rows of all touches (per point: normal n, then two tangents; per bound of a limit: one), H the
//! joints' system, u = J v the velocities of the touches, P their impulses, t the least normal velocities allowed:
//!
//! ```text
//! u = u₀ + W (P − P₀)        W = J H⁻¹ Jᵀ       (P₀ has already acted)
//! 0 ≤ P_n ⟂ u_n − t ≥ 0      no pull, no approach, no push where it opens          (Signorini)
//! |P_T| ≤ μ P_n              u_T = 0 inside the cone, P_T = −μ P_n u_T/|u_T| on it  (Coulomb)
//! ```
//!
//! W is never formed as a whole: `coordinates.rs` writes it as what few coordinates of each body or mechanism answer, `islands.rs`
//! finds what hangs together, `newton.rs` solves. W is only positive semi-definite (four feet of a box, bodies on hinges); the
//! velocities that come out are unique where friction is, and the split among redundant feet is the one nearest to where the
//! solver began.

use super::contact::{Contact, LOCKED, PROXIMAL, Source};
use super::contact_law::{ContactLaw, EffectiveInverseMass};
use super::contact_solver::{ContactSolver, Iterate, ProblemView};
use super::islands::{Island, Islands};
use super::jacobian_row::JacobianRow;
use super::reduced_coordinates::{Coordinates, Mechanisms};
use crate::articulation::System;
use crate::dynamics::work_budget::CONTACT_OPERATIONS;
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{angular, linear, vec6};
use soffio_math::{DMat3, DVec3};

/// Room for so many touches at once; more make lists grow.
const ROOM: usize = 256;

/// Time in which bodies are moved out of each other, as far as the solver's bounds of velocities go, s: 10⁻⁵ m/s are 10 nm.
const PUSH_TIME: f64 = 1e-3;

/// All touches of one moment.
#[derive(Clone, Debug)]
pub(super) struct ContactProblem {
    pub contacts: Vec<Contact>,
    pub rows: Vec<JacobianRow>,
    coordinates: Coordinates,
    islands: Islands,
    newton: ContactSolver,
    /// Impulse of each row.
    impulses: Vec<f64>,
    /// Operations so far (`dynamics/operations.rs`).
    pub operations: u64,
}

impl ContactProblem {
    /// Room for about this many touches at a time, of a figure of these mechanisms whose joints have this many rows and are
    /// drawn together with this time constant (s).
    pub fn new(contacts: usize, mechanisms: Mechanisms, joints: (usize, f64)) -> Self {
        let (contacts, bodies) = (contacts.min(ROOM), mechanisms.count());
        Self {
            contacts: Vec::with_capacity(contacts),
            rows: Vec::with_capacity(3 * contacts),
            newton: ContactSolver::with_room(contacts, bodies),
            coordinates: Coordinates::new(mechanisms, contacts, joints),
            islands: Islands::with_room(bodies, contacts),
            impulses: Vec::with_capacity(3 * contacts),
            operations: 0,
        }
    }

    /// Empties it.
    pub fn clear(&mut self) {
        self.contacts.clear();
        self.rows.clear();
    }

    /// Adds a touch with its rows.
    pub fn push(&mut self, mut contact: Contact, rows: &[JacobianRow]) {
        (contact.first, contact.rows) = (self.rows.len(), rows.len());
        self.rows.extend_from_slice(rows);
        self.contacts.push(contact);
    }

    /// Finds what moves how, at the bodies' present state; the joints must be factored there. All impulses are what acted before.
    pub fn assemble(&mut self, system: &mut System, bodies: &[RigidBody]) {
        let Self { contacts, rows, coordinates, islands, newton, .. } = self;
        coordinates.assemble(contacts, rows, system, bodies);
        islands.find(coordinates, contacts);
        self.operations += CONTACT_OPERATIONS * contacts.len() as u64;
        newton.begin(coordinates.nodes.iter().map(|node| node.size).sum());
        newton.iterates.clear();
        for index in 0..contacts.len() {
            contacts[index].find_inverse_mass(coordinates);
            if let Some(twist) = contacts[index].twist {
                let push = contacts[twist.of].k().x_axis.x;
                contacts[index].answer.arm = (push / contacts[index].answer.most().max(LOCKED)).sqrt();
            }
            let contact = &contacts[index];
            let rate = |k: usize| if k < contact.rows { rows[contact.first + k].rate(bodies) } else { 0.0 };
            let start = DVec3::new(rate(0), rate(1), rate(2));
            newton.iterates.push(Iterate::new(contact, start));
        }
    }

    /// Lets every touch begin from its own `begin`.
    pub fn begin(&mut self) {
        self.contacts.iter_mut().for_each(|contact| contact.impulse = contact.begin);
    }

    /// Velocity of a touch (n, t, b) under the impulses last solved for or followed, m/s.
    pub fn velocity(&self, contact: usize) -> DVec3 {
        self.newton.iterates[contact].u
    }

    /// How fast a touch of what met at the share `s` of a substep that began so approached there, m/s; forces change that evenly.
    pub fn approach(&self, contact: usize, s: f64, start: &[RigidBody]) -> f64 {
        let (first, last) = (self.rows[self.contacts[contact].first].rate(start), self.velocity(contact).x);
        -(first + s * (last - first))
    }

    /// Lets all velocities follow from the impulses as they are.
    pub fn follow(&mut self) {
        for (contact, iterate) in self.contacts.iter().zip(&mut self.newton.iterates) {
            iterate.p = contact.impulse;
        }
        let view = ProblemView { contacts: &self.contacts, coordinates: &self.coordinates, islands: &self.islands };
        for island in &self.islands.islands {
            self.newton.follow(view, island);
        }
    }

    /// Solves for all impulses from where they stand: first as if all clutches took hold, then with those slipping that would carry
    /// too much. Where teeth jam, both may be possible; then they hold.
    pub fn solve(&mut self) {
        loop {
            self.solve_by(|contact, contacts| {
                contact.law(contact.twist.map_or(0.0, |twist| contacts[twist.of].impulse.x))
            });
            let mut gives = false;
            for contact in &mut self.contacts {
                let Some(grip) = &mut contact.grip else { continue };
                if !grip.slips && contact.impulse.x.abs() > grip.most {
                    (grip.slips, gives) = (true, true);
                }
            }
            if !gives {
                return;
            }
        }
    }

    /// Solves for friction alone, the normal impulses given.
    pub fn solve_friction(&mut self) {
        self.solve_by(|contact, _| {
            let free = contact.rows == 3 && contact.answer.across > LOCKED;
            if free { ContactLaw::Friction(contact.friction * contact.impulse.x) } else { ContactLaw::Still }
        })
    }

    fn solve_by(&mut self, law: impl Fn(&Contact, &[Contact]) -> ContactLaw) {
        let Self { contacts, coordinates, islands, newton, .. } = self;
        for (contact, iterate) in contacts.iter().zip(&mut newton.iterates) {
            iterate.begin(contact, law(contact, contacts));
        }
        newton.solve(ProblemView { contacts, coordinates, islands });
        self.operations += std::mem::take(&mut newton.operations);
        for (contact, iterate) in contacts.iter_mut().zip(&newton.iterates) {
            contact.impulse = iterate.p;
        }
    }

    /// Change of kinetic energy by the impulses so far, of which P₀ acted earlier, J: (P − P₀)·(u₀ + u)/2.
    pub fn work(&self) -> f64 {
        let work = |contact: &Iterate| (contact.p - contact.before).dot(0.5 * (contact.start + contact.u));
        self.newton.iterates.iter().map(work).sum()
    }

    /// Is the impulse of a touch good enough to begin from next time?
    pub fn is_good(&self, contact: usize) -> bool {
        self.newton.iterates[contact].good
    }

    fn points(&self) -> impl Iterator<Item = &Iterate> {
        self.contacts
            .iter()
            .zip(&self.newton.iterates)
            .filter(|(contact, _)| contact.twist.is_none())
            .map(|(_, own)| own)
    }

    /// Largest velocity that the impulses give any touch beyond what acted before, m/s.
    pub fn largest_change(&self) -> f64 {
        self.points().fold(0.0, |most: f64, contact| most.max((contact.u - contact.start).abs().max_element()))
    }

    /// Slip of the fastest touch, m/s.
    pub fn largest_slip(&self) -> f64 {
        self.points().fold(0.0, |most: f64, contact| most.max(contact.u.with_x(0.0).length()))
    }

    /// Applies P − P₀ to the bodies' velocities.
    pub fn apply(&mut self, system: &mut System, bodies: &mut [RigidBody]) {
        self.take_changes();
        self.push_all(system);
        self.coordinates.answer(&self.impulses, system);
        system.apply_velocity(bodies);
        // What rounding has left to the joints where much is taken up by little.
        system.solve_velocity(bodies);
        system.apply_velocity(bodies);
    }

    /// The same, and what joints lacked in speed before, by one solve; for joints that all hold.
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
            let change = contact.impulse - contact.before;
            self.impulses.extend((0..contact.rows).map(|k| change[k]));
        }
    }

    /// Lays the rows' impulses on the bodies.
    fn push_all(&self, system: &mut System) {
        system.b.fill([0.0; 6]);
        for (row, impulse) in self.rows.iter().zip(&self.impulses).filter(|(_, impulse)| **impulse != 0.0) {
            for (body, block) in row.ends.iter().flatten() {
                system.push_impulse(*body, block, *impulse);
            }
        }
    }

    /// Are there joints that give way, at the last assembly?
    pub fn has_open_joints(&self) -> bool {
        self.coordinates.has_open_joints()
    }

    /// Takes all impulses for nothing that goes on in the islands of these touches: impacts are not forces.
    pub fn discard_impact_impulses(&mut self, contacts: impl Iterator<Item = usize>) {
        for struck in contacts {
            let with = |island: &&Island| self.islands.contacts[island.contacts.clone()].binary_search(&struck).is_ok();
            if let Some(island) = self.islands.islands.iter().find(with) {
                for &contact in &self.islands.contacts[island.contacts.clone()] {
                    self.contacts[contact].impulse = DVec3::ZERO;
                }
            }
        }
    }

    /// Least displacement, in kinetic energy, that brings every gap below `depth` up to it: pushes only, no friction.
    /// Momentum and angular momentum are kept. It is the same problem with the velocities of [`PUSH_TIME`] for ways.
    pub fn push_out(&mut self, depth: f64, most: f64, system: &mut System, bodies: &mut [RigidBody]) {
        let Self { contacts, coordinates, islands, newton, impulses, .. } = self;
        for (contact, iterate) in contacts.iter().zip(&mut newton.iterates) {
            let law = if contact.answer.k.x_axis.x > LOCKED { ContactLaw::Bound } else { ContactLaw::Still };
            *iterate = Iterate::pushed(contact, (depth - contact.gap).min(most) / PUSH_TIME, law);
        }
        newton.solve(ProblemView { contacts, coordinates, islands });
        impulses.clear();
        for (contact, iterate) in contacts.iter().zip(&newton.iterates) {
            impulses.extend((0..contact.rows).map(|k| if k == 0 { PUSH_TIME * iterate.p.x } else { 0.0 }));
        }
        self.push_all(system);
        self.coordinates.answer(&self.impulses, system);
        for (body, a) in bodies.iter_mut().zip(&system.a) {
            // Its spin's momentum stays where it points.
            let spin = body.inertia_world() * body.angular_velocity;
            body.displace(linear(a), angular(a));
            body.angular_velocity = body.inertia_world().inverse() * spin;
        }
        // Bodies that pass each other at v are moved by a push p: p × v of angular momentum goes back to them in halves.
        system.b.fill([0.0; 6]);
        for contact in self.contacts.iter().filter(|contact| matches!(contact.source, Source::Pair(_))) {
            if let [Some((a, along)), Some((b, _)), _] = self.rows[contact.first].ends {
                let passes = bodies[a].velocity - bodies[b].velocity;
                let back = vec6(DVec3::ZERO, (-0.5 * self.impulses[contact.first] * linear(&along)).cross(passes));
                system.push_impulse(a, &back, 1.0);
                system.push_impulse(b, &back, 1.0);
            }
        }
        system.solve_impulse();
        system.apply_velocity(bodies);
    }
}

impl Contact {
    /// Takes the touch's own block of W, and what of it lies across the normal at most.
    fn find_inverse_mass(&mut self, coordinates: &Coordinates) {
        let mut k = [[0.0; 3]; 3];
        for part in coordinates.parts_of(self) {
            let size = coordinates.nodes[part.node].size;
            let block = coordinates.block(part, self.rows);
            for i in 0..self.rows {
                for j in 0..self.rows {
                    let (row, column) = (&block[i * size..][..size], &block[j * size..][..size]);
                    k[i][j] += row.iter().zip(column).map(|(x, y)| x * y).sum::<f64>();
                }
            }
        }
        let (a, d, b) = (k[1][1], k[2][2], k[1][2]);
        let (k, trace) = (DMat3::from_cols_array_2d(&k), k[0][0] + a + d);
        let inverse = (k + DMat3::from_diagonal(DVec3::splat(PROXIMAL * trace.max(LOCKED)))).inverse();
        let across = 0.5 * (a + d) + (0.25 * (a - d) * (a - d) + b * b).sqrt();
        self.answer = EffectiveInverseMass { k, inverse, across, arm: 1.0 };
    }
}

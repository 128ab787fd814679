//! A substep in which impacts and resting contact are solved together, at its end: Moreau's time stepping.
//!
//! Where a step has no time left to follow impacts one by one (`dynamics/operations.rs`), the bodies go through what is left of
//! it as if nothing were in their way. At its end one contact problem has the touches of what rests and of what met on the way (J. J.
//! Moreau, "Unilateral contact and dry friction in finite freedom dynamics", 1988), with
//!
//! ```text
//! u_n ≥ −e u_n⁻      for what met, u_n⁻ the velocity at which it came when it met (Newton's restitution)
//! u_n ≥ t            for what rests, as in `rest.rs`
//! ```
//!
//! If that would give energy, which Newton's law can do with friction, nothing bounces. Then bodies are moved, as little as can be in
//! the norm of kinetic energy, to where no surfaces overlap, and where what bounced at the share s of the substep has come since:
//!
//! ```text
//! gap ≥ 0        gap ≥ e u (1 − s) h, u the approach
//! ```
//!
//! Every impact keeps its own time in its event. Clutches that hold go on holding: impacts are over before one slips.

use super::contact::Source;
use super::impact::Impact;
use super::resting_contact::LAYER;
use super::state::Contacts;
use crate::articulation::System;
use crate::collision::{Pair, TOUCH, TimeOfImpact};
use soffio_geometry::bodies::RigidBody;
use soffio_math::{DVec3, Pose};

/// Cosine between the normals at the meeting and at the end above which the side is the same.
const SAME_SIDE: f64 = 0.5;

/// Bodies are moved out of each other by no more than this at once, m.
const FARTHEST: f64 = 0.05;

/// What met on the way, and its touches in the problem.
#[derive(Clone, Copy, Debug)]
pub(super) struct PendingImpact {
    source: Source,
    /// Share of the substep.
    s: f64,
    contacts: (usize, usize),
    /// Approach, m/s, and how it ends.
    speed: f64,
    e: f64,
    rests: bool,
}

impl Contacts {
    /// A body that sleeps and is met on the way between two states.
    pub(in crate::dynamics) fn sleeper_hit(&mut self, before: &[RigidBody], after: &[RigidBody]) -> Option<usize> {
        self.near.find(before, after, &self.sleeping.bodies);
        for near in 0..self.near.list.len() {
            let pair = self.near.list[near];
            let sleeper = self.sleeping.one_of(self.surfaces.bodies_of(pair));
            if sleeper.is_some() && self.meets(pair, before, after).is_some() {
                return sleeper;
            }
        }
        None
    }

    /// Ends a substep of `h` seconds from the time `begun` of the step, under [`Contacts::press`]: puts velocities and places right for
    /// all that rests or met on the way, and appends the impacts. The joints must be factored at the bodies' present state.
    pub(in crate::dynamics) fn finish_time_step(
        &mut self,
        (begun, h): (f64, f64),
        start: &[RigidBody],
        system: &mut System,
        bodies: &mut [RigidBody],
        impacts: &mut Vec<Impact>,
    ) {
        let torque_work = self.forces.correct_contact_torque(h, start, system, bodies);
        self.collect_contacts(h, system, bodies);
        let resting = self.problem.contacts.len();
        self.find_pending_impacts(start, bodies);
        self.problem.assemble(system, bodies);
        let mut met = std::mem::take(&mut self.pending_impacts);
        for impact in &mut met {
            let (first, end) = impact.contacts;
            for contact in first..end {
                self.problem.contacts[contact].least = self.problem.approach(contact, impact.s, start).max(0.0);
            }
            impact.speed =
                self.problem.contacts[first..end].iter().fold(0.0, |most: f64, contact| most.max(contact.least));
            let at = begun + impact.s * h;
            (impact.e, impact.rests) = self.classify_impact(impact.source, at, impact.speed);
            self.problem.contacts[first..end].iter_mut().for_each(|contact| contact.least *= impact.e);
        }
        self.problem.begin();
        self.problem.solve();
        if !met.is_empty() && self.problem.work() > 0.0 {
            for contact in &mut self.problem.contacts[resting..] {
                contact.least = 0.0;
            }
            met.iter_mut().for_each(|impact| impact.e = 0.0);
            self.problem.begin();
            self.problem.solve();
        }
        self.slip = self.problem.largest_slip();
        self.work.recent = self.forces.work(start, bodies) + torque_work + self.problem.work();
        self.problem.apply_closing(system, bodies);
        for impact in &met {
            let own = impact.contacts;
            let mut impact = self.impact_event(impact.source, begun + impact.s * h, own, impact.speed, impact.rests);
            let sum =
                self.problem.contacts[own.0..own.1].iter().fold(DVec3::ZERO, |sum, contact| sum + contact.impulse);
            impact.impulse = sum.length();
            impacts.push(impact);
        }
        self.resting.record_depths(&self.problem.contacts[..resting], &self.surfaces, &self.sleeping);
        for impact in met.iter().filter(|impact| !impact.rests) {
            let since = impact.e * impact.speed * (1.0 - impact.s) * h;
            // What is to open so far lies so much deeper.
            self.problem.contacts[impact.contacts.0..impact.contacts.1]
                .iter_mut()
                .for_each(|contact| contact.gap -= since);
        }
        self.problem.discard_impact_impulses(met.iter().filter(|impact| !impact.rests).map(|impact| impact.contacts.0));
        self.forces.remember(&self.problem, (h, true), start, bodies);
        if self.problem.contacts.iter().any(|contact| contact.gap < -LAYER) {
            self.problem.push_out(-0.5 * LAYER, FARTHEST, system, bodies);
        }
        self.pending_impacts = met;
    }

    /// Finds what met on the way and does not rest, with its touches at the end.
    fn find_pending_impacts(&mut self, before: &[RigidBody], after: &[RigidBody]) {
        self.pending_impacts.clear();
        self.near.find(before, after, &self.sleeping.bodies);
        for near in 0..self.near.list.len() {
            let pair = self.near.list[near];
            let Some(toi) = self.meets(pair, before, after) else { continue };
            let first = self.problem.contacts.len();
            self.push_met(pair, &toi, after);
            let contacts = (first, self.problem.contacts.len());
            let source = Source::Pair(pair);
            self.pending_impacts.push(PendingImpact { source, s: toi.s, contacts, speed: 0.0, e: 0.0, rests: false });
        }
        for bound in 0..self.limits.count() {
            if self.limits.resting(bound) || self.limits.sleeps(bound) {
                continue;
            }
            if let Some(s) = self.limits.crossing(bound, before, after, &self.near.sweeps) {
                let first = self.problem.contacts.len();
                self.push_bound(bound, after);
                let source = Source::Bound(bound);
                self.pending_impacts.push(PendingImpact {
                    source,
                    s,
                    contacts: (first, first + 1),
                    speed: 0.0,
                    e: 0.0,
                    rests: false,
                });
            }
        }
    }

    /// Adds the touches of a pair that met: those that are closed at the end where they lie on the side they met on, else the
    /// point where they met, as far as the bodies have gone past each other.
    fn push_met(&mut self, pair: usize, toi: &TimeOfImpact, after: &[RigidBody]) {
        let Pair { a, b } = self.surfaces.pairs[pair].pair;
        let normal = toi.proximity.normal;
        let manifold = self.surfaces.manifold(pair, after);
        if manifold.normal.dot(normal) > SAME_SIDE {
            let nearest = manifold.points().iter().fold(f64::INFINITY, |least, at| least.min(at.gap));
            for at in manifold.points().iter().filter(|at| at.gap <= TOUCH.max(nearest)) {
                self.surfaces.push_point(&mut self.problem, pair, (at.point, manifold.normal, at.gap), after);
            }
        } else {
            let [p, q] = [a, b].map(|collider| {
                let sweep = self.near.sweep(&self.surfaces, collider).pose(toi.s);
                let pose = self.surfaces.colliders[collider].body.map_or(Pose::IDENTITY, |body| after[body].pose());
                pose.point(sweep.inverse_point(toi.proximity.point))
            });
            let gap = toi.proximity.gap + (p - q).dot(normal);
            self.surfaces.push_point(&mut self.problem, pair, (0.5 * (p + q), normal, gap), after);
        }
    }
}

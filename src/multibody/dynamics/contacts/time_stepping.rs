//! Moreau's time stepping: a substep whose impacts and resting contacts are solved together at its end.
//!
//! Where a step has no time left to resolve impacts one by one (`dynamics/work_budget.rs`), the bodies are integrated without
//! contacts. At the end one contact problem has the resting contacts and the impacts of the substep (J. J. Moreau, "Unilateral
//! contact and dry friction in finite freedom dynamics", 1988), with
//!
//! ```text
//! u_n ≥ −e u_n⁻      for impacts, u_n⁻ the approach velocity at first contact (Newton's restitution)
//! u_n ≥ t            for resting contacts, as in `resting_contact.rs`
//! ```
//!
//! If that would add energy, which Newton's law can do with friction, nothing bounces. Then the bodies are moved by the least
//! displacement in the norm of kinetic energy until no surfaces overlap and bounced pairs have separated. For an impact at the
//! fraction s of the substep with the approach speed u,
//!
//! ```text
//! gap ≥ 0        gap ≥ e u (1 − s) h
//! ```
//!
//! The event of each impact has its own time. Sticking clutches stay so: impacts are over before one slips.

use super::contact::{ContactSource, IndexRange};
use super::contact_forces::SolvedSubstep;
use super::impact::Impact;
use super::impact_solver::{Bounce, ReportedImpact};
use super::resting_contact::LAYER;
use super::state::Contacts;
use super::surfaces::PointGeometry;
use crate::articulation::System;
use crate::collision::{CONTACT_MARGIN, ColliderPair, TimeOfImpact};
use crate::dynamics::step::SubstepSpan;
use soffio_geometry::bodies::RigidBody;
use soffio_math::{DVec3, Pose};

/// Surfaces overlap on the side of their first contact where the cosine of both normals is larger.
const SAME_SIDE: f64 = 0.5;

/// Farthest that bodies are moved apart after one substep, m.
const MAX_PUSH: f64 = 0.05;

/// An impact within the substep.
#[derive(Clone, Copy, Debug)]
pub(super) struct PendingImpact {
    source: ContactSource,
    /// Fraction of the substep.
    s: f64,
    /// Its contacts in the problem.
    contacts: IndexRange,
    /// Approach speed, m/s.
    speed: f64,
    restitution: f64,
    comes_to_rest: bool,
}

impl PendingImpact {
    fn new(source: ContactSource, s: f64, contacts: IndexRange) -> Self {
        Self { source, s, contacts, speed: 0.0, restitution: 0.0, comes_to_rest: false }
    }
}

impl Contacts {
    /// A sleeping body that a body in motion reaches between two states.
    pub(in crate::dynamics) fn sleeper_reached(&mut self, before: &[RigidBody], after: &[RigidBody]) -> Option<usize> {
        self.nearby.find(before, after, &self.sleeping.bodies);
        for index in 0..self.nearby.list.len() {
            let pair = self.nearby.list[index];
            let sleeper = self.sleeping.one_of(self.surfaces.bodies_of(pair));
            if sleeper.is_some() && self.time_of_impact(pair, before, after).is_some() {
                return sleeper;
            }
        }
        None
    }

    /// Ends a time step under [`Contacts::apply_contact_forces`]: corrects velocities and positions by all impacts and resting
    /// contacts, and appends the impacts. The joints must be factored at the bodies' present state.
    pub(in crate::dynamics) fn finish_time_step(
        &mut self,
        span: SubstepSpan,
        start: &[RigidBody],
        system: &mut System,
        bodies: &mut [RigidBody],
        impacts: &mut Vec<Impact>,
    ) {
        let h = span.h;
        let torque_work = self.forces.correct_contact_torque(h, start, system, bodies);
        self.collect_contacts(h, system, bodies);
        let resting = self.problem.contacts.len();
        self.find_pending_impacts(start, bodies);
        self.problem.assemble(system, bodies);
        let mut pending = std::mem::take(&mut self.pending_impacts);
        for impact in &mut pending {
            let approach = |this: &Self, contact: usize| this.problem.approach(contact, impact.s, start).max(0.0);
            let all = impact.contacts.range();
            impact.speed = all.clone().fold(0.0, |max: f64, contact| max.max(approach(self, contact)));
            let Bounce { restitution, comes_to_rest } =
                self.classify_impact(impact.source, span.start + impact.s * h, impact.speed);
            for contact in all {
                self.problem.contacts[contact].min_velocity = approach(self, contact) * restitution;
            }
            (impact.restitution, impact.comes_to_rest) = (restitution, comes_to_rest);
        }
        self.problem.start_from_initial();
        self.problem.solve();
        if !pending.is_empty() && self.problem.work() > 0.0 {
            for contact in &mut self.problem.contacts[resting..] {
                contact.min_velocity = 0.0;
            }
            pending.iter_mut().for_each(|impact| impact.restitution = 0.0);
            self.problem.start_from_initial();
            self.problem.solve();
        }
        self.slip = self.problem.largest_slip();
        self.work.recent = self.forces.work(start, bodies) + torque_work + self.problem.work();
        self.problem.apply_closing(system, bodies);
        for impact in &pending {
            let PendingImpact { source, s, contacts, speed, comes_to_rest, .. } = *impact;
            let mut event =
                self.impact_event(ReportedImpact { source, time: span.start + s * h, contacts, speed, comes_to_rest });
            let own = &self.problem.contacts[contacts.range()];
            event.impulse = own.iter().fold(DVec3::ZERO, |sum, contact| sum + contact.impulse).length();
            impacts.push(event);
        }
        self.resting.record_depths(&self.problem.contacts[..resting], &self.surfaces, &self.sleeping);
        for impact in pending.iter().filter(|impact| !impact.comes_to_rest) {
            let separation = impact.restitution * impact.speed * (1.0 - impact.s) * h;
            // A gap to be opened counts as penetration.
            let own = &mut self.problem.contacts[impact.contacts.range()];
            own.iter_mut().for_each(|contact| contact.gap -= separation);
        }
        let bounced = pending.iter().filter(|impact| !impact.comes_to_rest);
        self.problem.discard_impact_impulses(bounced.map(|impact| impact.contacts.start));
        self.forces.store(&self.problem, SolvedSubstep { h, accepted: true, start }, bodies);
        if self.problem.contacts.iter().any(|contact| contact.gap < -LAYER) {
            self.problem.push_out(-0.5 * LAYER, MAX_PUSH, system, bodies);
        }
        self.pending_impacts = pending;
    }

    /// Finds the impacts of pairs and bounds that do not rest, and adds their contacts at the end to the problem.
    fn find_pending_impacts(&mut self, before: &[RigidBody], after: &[RigidBody]) {
        self.pending_impacts.clear();
        self.nearby.find(before, after, &self.sleeping.bodies);
        for index in 0..self.nearby.list.len() {
            let pair = self.nearby.list[index];
            let Some(toi) = self.time_of_impact(pair, before, after) else { continue };
            let start = self.problem.contacts.len();
            self.push_impact_points(pair, &toi, after);
            let contacts = IndexRange { start, end: self.problem.contacts.len() };
            self.pending_impacts.push(PendingImpact::new(ContactSource::Surfaces(pair), toi.s, contacts));
        }
        for bound in 0..self.limits.count() {
            if self.limits.is_resting(bound) || self.limits.is_asleep(bound) {
                continue;
            }
            if let Some(s) = self.limits.crossing(bound, before, after, &self.nearby.sweeps) {
                let start = self.problem.contacts.len();
                self.push_bound(bound, after);
                let contacts = IndexRange { start, end: start + 1 };
                self.pending_impacts.push(PendingImpact::new(ContactSource::Limit(bound), s, contacts));
            }
        }
    }

    /// Adds the contact points of a pair with an impact. These are the closed points at the end, if the surfaces overlap on the
    /// side of their first contact; else the point of first contact, with the distance that the bodies have passed each other.
    fn push_impact_points(&mut self, pair: usize, toi: &TimeOfImpact, after: &[RigidBody]) {
        let ColliderPair { a, b } = self.surfaces.pairs[pair].pair;
        let normal = toi.proximity.normal;
        let manifold = self.surfaces.manifold(pair, after);
        if manifold.normal.dot(normal) > SAME_SIDE {
            let nearest = manifold.points().iter().fold(f64::INFINITY, |least, at| least.min(at.gap));
            for at in manifold.points().iter().filter(|at| at.gap <= CONTACT_MARGIN.max(nearest)) {
                let at = PointGeometry { point: at.point, normal: manifold.normal, gap: at.gap };
                self.surfaces.push_point(&mut self.problem, pair, at, after);
            }
        } else {
            let [p, q] = [a, b].map(|collider| {
                let sweep = self.nearby.sweep(&self.surfaces, collider).pose(toi.s);
                let pose = self.surfaces.colliders[collider].body.map_or(Pose::IDENTITY, |body| after[body].pose());
                pose.point(sweep.inverse_point(toi.proximity.point))
            });
            let at = PointGeometry { point: 0.5 * (p + q), normal, gap: toi.proximity.gap + (p - q).dot(normal) };
            self.surfaces.push_point(&mut self.problem, pair, at, after);
        }
    }
}

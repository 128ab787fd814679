//! Impact resolution: simultaneous impacts of two bodies through the joints, with restitution and friction.
//!
//! An impact at one point follows its path of stick and slip (`dynamics/impact_law.rs`). An impact at several points of the same two
//! bodies, such as a box that lands flat, is one event: the contact problem gives the impulses P_c of compression, which end all
//! approach. Restitution then scales each normal impulse to (1 + e) P_c (Poisson), and friction follows it. With friction,
//! Poisson's law may return more than e² of the energy that compression took. The whole impulse is then (1 + s) P_c with s ≤ e,
//! which never does: with P_c·u₀ ≤ 0 and D ≥ 0 the work of friction,
//!
//! ```text
//! ΔE(s) = (1 + s) P_c·u₀ + ½ (1 + s)² (−P_c·u₀ − D) ≤ ½ (1 − s²) P_c·u₀ ≤ 0
//! ```
//!
//! Impacts propagate: a pair that approaches after one has the next, in a fixed order. Of a row of balls the last one leaves.

use super::contact::{Contact, ContactKind, ContactSource, IndexRange, LOCKED};
use super::contact_problem::ContactProblem;
use super::earliest_impact::EarliestImpact;
use super::impact::{Impact, ImpactKind};
use super::jacobian_row::point_rows;
use super::open_joints::Stabilization;
use super::reduced_coordinates::Mechanisms;
use super::state::Contacts;
use super::surfaces::PointGeometry;
use crate::articulation::System;
use crate::collision::{CONTACT_MARGIN, ManifoldPoint};
use crate::dynamics::impact_law::impulse;
use crate::dynamics::limits::BoundRow;
use crate::dynamics::step::SubstepSpan;
use soffio_geometry::bodies::RigidBody;
use soffio_math::{DMat3, DVec3};

/// Slower approaches do not bounce and make no sound, m/s (rad/s at a limit of an angle).
pub(super) const REST_SPEED: f64 = 4e-3;
/// Bounces nearer in time than this (s) and slower than that (m/s) become one contact: nobody hears them apart.
const CHATTER_TIME: f64 = 5e-3;
const CHATTER_SPEED: f64 = 0.03;
/// Points of the same two bodies that touch within this time have one impact, s: one sample of sound.
const SIMULTANEOUS: f64 = 1.0 / 48_000.0;
/// 1/ω₀ of the stabiliser for [`resolve_point_impact`], s; its joints are closed.
const STABILIZATION_TIME: f64 = 0.04;
/// Impacts that may follow from one.
const MAX_PROPAGATED: usize = 256;

/// An impact at one point of two bodies.
#[derive(Clone, Copy, Debug)]
pub struct PointImpact {
    /// World point of the impact, m.
    pub point: DVec3,
    /// Unit, from the second body to the first.
    pub normal: DVec3,
    /// The bodies; `None` is the world.
    pub bodies: [Option<usize>; 2],
    /// Coulomb coefficient.
    pub friction: f64,
    /// Energetic coefficient of restitution, 0 … 1.
    pub restitution: f64,
}

/// The result of an impact, in the frame (t, b, n) of `math::tangents`.
#[derive(Clone, Copy, Debug)]
pub struct PointImpactResult {
    /// Impulse on the first body, N s.
    pub impulse: DVec3,
    /// Velocity of the first body relative to the second before, m/s.
    pub velocity: DVec3,
    /// Effective inverse mass, joints included, 1/kg.
    pub k: DMat3,
}

/// Restitution of an impact, and whether its contact comes to rest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounce {
    /// Coefficient of restitution.
    pub restitution: f64,
    /// The contact rests from now on.
    pub comes_to_rest: bool,
}

/// An impact whose event is to be reported.
#[derive(Clone, Copy, Debug)]
pub(super) struct ReportedImpact {
    /// What has collided.
    pub source: ContactSource,
    /// Seconds after the beginning of the step.
    pub time: f64,
    /// Its contacts in the problem.
    pub contacts: IndexRange,
    /// Approach speed, m/s.
    pub speed: f64,
    /// Does the contact rest from now on?
    pub comes_to_rest: bool,
}

/// Resolves one impact at one point: three solves for the effective inverse mass, one for the response. The joints must be
/// factored at the bodies' present state. `None` where joints hold the point or nothing approaches.
pub fn resolve_point_impact(
    impact: &PointImpact,
    system: &mut System,
    bodies: &mut [RigidBody],
) -> Option<PointImpactResult> {
    let mechanisms = Mechanisms::new(system.constraints(), system.kinematic());
    let stabilization = Stabilization { rows: system.states().len(), time: STABILIZATION_TIME };
    let mut problem = ContactProblem::new(1, mechanisms, stabilization);
    let kind = ContactKind::Point { pair: 0, friction: impact.friction, full_slip: 0.0 };
    let contact = Contact::new(kind, impact.point, impact.normal, 0.0);
    problem.push(contact, &point_rows(impact.point, impact.normal, impact.bodies, bodies));
    problem.assemble(system, bodies);
    let result = resolve_single_contact(&mut problem, impact.restitution)?;
    problem.apply(system, bodies);
    Some(result)
}

/// Finds the impulse of a problem of one contact point or limit.
fn resolve_single_contact(problem: &mut ContactProblem, restitution: f64) -> Option<PointImpactResult> {
    let contact = problem.contacts[0];
    let u = problem.velocity(0);
    let k = contact.inverse_mass.k;
    if k.x_axis.x < LOCKED || u.x >= 0.0 {
        return None;
    }
    let ContactKind::Point { friction, .. } = contact.kind else {
        problem.contacts[0].impulse = DVec3::X * (-(1.0 + restitution) * u.x / k.x_axis.x);
        problem.update_velocities();
        let impulse = DVec3::Z * problem.contacts[0].impulse.x;
        return Some(PointImpactResult { impulse, velocity: DVec3::Z * u.x, k });
    };
    // From (n, t, b) to (t, b, n).
    let reorder = |v: DVec3| DVec3::new(v.y, v.z, v.x);
    let k = DMat3::from_cols(reorder(k.y_axis), reorder(k.z_axis), reorder(k.x_axis));
    let velocity = reorder(u);
    let p = impulse(&k, velocity, friction, restitution);
    problem.contacts[0].impulse = DVec3::new(p.z, p.x, p.y);
    problem.update_velocities();
    Some(PointImpactResult { impulse: p, velocity, k })
}

impl Contacts {
    /// Resolves an impact at the bodies' present state and all impacts that follow from it. `at` is its time in the step and the
    /// length of the substep. The joints must be factored there.
    pub(in crate::dynamics) fn resolve_impact(
        &mut self,
        impact: &EarliestImpact,
        at: SubstepSpan,
        system: &mut System,
        bodies: &mut [RigidBody],
        impacts: &mut Vec<Impact>,
    ) {
        let SubstepSpan { start: time, h } = at;
        // Impacts change velocities, not positions: the nearby pairs stay the same.
        self.nearby.find(bodies, bodies, &self.sleeping.bodies);
        let mut next = Some(impact.source);
        for _ in 0..MAX_PROPAGATED {
            let Some(source) = next else { break };
            self.impacts_left = self.impacts_left.saturating_sub(1);
            self.collect_approaching(source, bodies);
            if self.problem.contacts.is_empty() {
                // It touches without approach: a resting contact begins.
                self.resting.set(source, true, &mut self.limits);
                self.collect_all(source, bodies);
                self.problem.assemble(system, bodies);
                let contacts = IndexRange { start: 0, end: self.problem.contacts.len() };
                if contacts.len() > 0 {
                    impacts.push(self.impact_event(ReportedImpact {
                        source,
                        time,
                        contacts,
                        speed: 0.0,
                        comes_to_rest: true,
                    }));
                }
                break;
            }
            self.problem.assemble(system, bodies);
            self.bounce(time, impacts);
            self.work.total += self.problem.work();
            self.problem.apply(system, bodies);
            next = self.approaching(bodies);
        }
        if self.has_resting_contacts() {
            self.remove_residual_approach(h, system, bodies);
        }
    }

    /// Seconds until the bodies of an impact are half into the contact layer, from their present state. Negative where they have
    /// passed it; 0 where they hardly approach.
    pub(in crate::dynamics) fn time_to_contact(&mut self, impact: &EarliestImpact, bodies: &[RigidBody]) -> f64 {
        let (gap, speed) = match impact.source {
            ContactSource::Limit(bound) => {
                let BoundRow { gap, row, .. } = self.limits.row(bound, bodies);
                (gap, -row.rate(bodies))
            }
            ContactSource::Surfaces(pair) => {
                let manifold = self.surfaces.manifold(pair, bodies);
                let nearest = |a: ManifoldPoint, b: &ManifoldPoint| if b.gap < a.gap { *b } else { a };
                let at = manifold.points()[1..].iter().fold(manifold.points[0], nearest);
                (at.gap, -self.surfaces.velocity_at(pair, at.point, bodies).dot(manifold.normal))
            }
        };
        if speed > REST_SPEED { (gap - 0.5 * CONTACT_MARGIN) / speed } else { 0.0 }
    }

    /// Collects all approaching contacts between the two bodies of a source.
    fn collect_approaching(&mut self, source: ContactSource, bodies: &[RigidBody]) {
        self.problem.clear();
        match source {
            ContactSource::Limit(bound) => self.push_bound(bound, bodies),
            ContactSource::Surfaces(pair) => {
                // Pairs of the same two bodies are next to each other.
                let two = self.surfaces.bodies_of(pair);
                let same = |other: &usize| self.surfaces.bodies_of(*other) == two;
                let first = (0..pair).rev().take_while(same).last().unwrap_or(pair);
                let end = (pair + 1..self.surfaces.pairs.len()).take_while(same).last().unwrap_or(pair);
                for other in first..=end {
                    if other == pair || self.surfaces.may_touch(other, bodies) {
                        self.collect_pair(other, other == pair, bodies);
                    }
                }
            }
        }
    }

    /// Collects all contacts of a source, whatever their velocity.
    fn collect_all(&mut self, source: ContactSource, bodies: &[RigidBody]) {
        match source {
            ContactSource::Limit(bound) => self.push_bound(bound, bodies),
            ContactSource::Surfaces(pair) => {
                let manifold = self.surfaces.manifold(pair, bodies);
                for at in manifold.points() {
                    let at = PointGeometry { point: at.point, normal: manifold.normal, gap: at.gap };
                    self.surfaces.push_point(&mut self.problem, pair, at, bodies);
                }
            }
        }
    }

    /// Collects the points of a pair that approach and are closed, or will be within a sample. A pair `with_impact` has one at
    /// least.
    fn collect_pair(&mut self, pair: usize, with_impact: bool, bodies: &[RigidBody]) {
        let manifold = self.surfaces.manifold(pair, bodies);
        let nearest = manifold.points().iter().fold(f64::INFINITY, |least, p| least.min(p.gap));
        for at in manifold.points() {
            let speed = -self.surfaces.velocity_at(pair, at.point, bodies).dot(manifold.normal);
            if speed > 0.0 && (at.gap <= CONTACT_MARGIN + SIMULTANEOUS * speed || (with_impact && at.gap == nearest)) {
                let at = PointGeometry { point: at.point, normal: manifold.normal, gap: at.gap };
                self.surfaces.push_point(&mut self.problem, pair, at, bodies);
            }
        }
    }

    /// Finds the impulses of the problem's contacts, reports the impacts, and decides which contacts rest from now on.
    fn bounce(&mut self, time: f64, impacts: &mut Vec<Impact>) {
        // Contacts are in the order of their sources.
        let count = self.problem.contacts.len();
        let mut min_restitution: f64 = 1.0;
        let mut start = 0;
        let first_impact = impacts.len();
        while start < count {
            let Some(source) = self.problem.contacts[start].source() else { break };
            let differs = |&i: &usize| self.problem.contacts[i].source() != Some(source);
            let end = (start..count).find(differs).unwrap_or(count);
            let speed = (start..end).fold(0.0, |max: f64, contact| max.max(-self.problem.velocity(contact).x));
            let Bounce { restitution, comes_to_rest } = self.classify_impact(source, time, speed);
            min_restitution = min_restitution.min(restitution);
            for contact in &mut self.problem.contacts[start..end] {
                contact.restitution = restitution;
            }
            let contacts = IndexRange { start, end };
            impacts.push(self.impact_event(ReportedImpact { source, time, contacts, speed, comes_to_rest }));
            start = end;
        }
        if count == 1 {
            let restitution = self.problem.contacts[0].restitution;
            let _ = resolve_single_contact(&mut self.problem, restitution);
        } else {
            bounce_together(&mut self.problem, min_restitution);
        }
        for impact in &mut impacts[first_impact..] {
            let own = |contact: &&Contact| match contact.point_pair() {
                Some(pair) => {
                    let colliders = self.surfaces.pairs[pair].pair;
                    impact.colliders == Some([colliders.a, colliders.b])
                }
                None => true,
            };
            let sum = self.problem.contacts.iter().filter(own).fold(DVec3::ZERO, |sum, contact| sum + contact.impulse);
            impact.impulse = sum.length();
        }
    }

    /// Restitution of an impact at this approach speed (m/s), and whether its contact rests from now on.
    pub(super) fn classify_impact(&mut self, source: ContactSource, time: f64, speed: f64) -> Bounce {
        let now = self.clock + time;
        let last = match source {
            ContactSource::Surfaces(pair) => &mut self.resting.last_impact[pair],
            ContactSource::Limit(bound) => self.limits.last_impact(bound),
        };
        let chatters = now - *last < CHATTER_TIME && speed < CHATTER_SPEED;
        *last = now;
        let comes_to_rest = speed < REST_SPEED || chatters || self.impacts_left == 0;
        let restitution = match source {
            ContactSource::Surfaces(pair) => self.surfaces.pairs[pair].restitution,
            ContactSource::Limit(bound) => self.limits.restitution(bound),
        };
        self.resting.set(source, comes_to_rest, &mut self.limits);
        Bounce { restitution: if comes_to_rest { 0.0 } else { restitution }, comes_to_rest }
    }

    /// The event of an impact; its impulse is not known yet.
    pub(super) fn impact_event(&self, reported: ReportedImpact) -> Impact {
        let ReportedImpact { source, time, contacts, speed, comes_to_rest } = reported;
        let contacts = &self.problem.contacts[contacts.range()];
        let middle = contacts.iter().fold(DVec3::ZERO, |sum, contact| sum + contact.point) / contacts.len() as f64;
        let (bodies, colliders, moving) = match source {
            ContactSource::Surfaces(pair) => {
                let at = self.surfaces.pairs[pair].pair;
                (self.surfaces.bodies_of(pair), Some([at.a, at.b]), ImpactKind::Impact)
            }
            ContactSource::Limit(bound) => (self.limits.bodies(bound), None, ImpactKind::Stop),
        };
        Impact {
            time,
            kind: if comes_to_rest { ImpactKind::RestingContact } else { moving },
            bodies,
            colliders,
            point: middle,
            normal: contacts[0].normal,
            impulse: 0.0,
            speed,
            mass: 1.0 / contacts[0].inverse_mass.k.x_axis.x.max(LOCKED),
        }
    }

    /// A closed contact that approaches too fast to rest.
    fn approaching(&mut self, bodies: &[RigidBody]) -> Option<ContactSource> {
        for index in 0..self.nearby.list.len() {
            let pair = self.nearby.list[index];
            if !self.surfaces.may_touch(pair, bodies) {
                continue;
            }
            let manifold = self.surfaces.manifold(pair, bodies);
            let approaches = |at: &ManifoldPoint| {
                at.gap <= CONTACT_MARGIN
                    && self.surfaces.velocity_at(pair, at.point, bodies).dot(manifold.normal) < -REST_SPEED
            };
            if manifold.points().iter().any(approaches) {
                return Some(ContactSource::Surfaces(pair));
            }
        }
        let approaches =
            |b: &usize| !self.limits.is_asleep(*b) && self.limits.approaches(*b, bodies, CONTACT_MARGIN, REST_SPEED);
        (0..self.limits.count()).find(approaches).map(ContactSource::Limit)
    }
}

/// One impact at several contacts, each with its own restitution, of which `min_restitution` is the least.
fn bounce_together(problem: &mut ContactProblem, min_restitution: f64) {
    let max_restitution = problem.contacts.iter().fold(0.0, |max: f64, contact| max.max(contact.restitution));
    // Compression ends all approach.
    problem.solve();
    if max_restitution == 0.0 {
        return;
    }
    let compression = problem.work();
    for contact in &mut problem.contacts {
        contact.initial = contact.impulse;
        contact.impulse.x *= 1.0 + contact.restitution;
    }
    problem.solve_friction();
    if problem.work() > compression * (1.0 - max_restitution * max_restitution) {
        for contact in &mut problem.contacts {
            contact.impulse = (1.0 + min_restitution) * contact.initial;
        }
        problem.update_velocities();
    }
}

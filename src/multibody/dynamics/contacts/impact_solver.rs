//! Hits: what touches and approaches at one time, resolved body pair by body pair through the joints.
//!
//! A hit at one point follows its path of stick and slip (`impulse`). A hit at several points of the same two bodies
//! (a box that lands flat) is one event: the contact problem gives the impulses P_c of compression, which end all
//! approach; restitution then brings each normal impulse to (1 + e) P_c (Poisson) and friction follows it. If that
//! would give back more than e² of what compression took (friction can do so with Poisson's law), the whole impulse
//! is (1 + s) P_c with s ≤ e instead, which never does: with P_c·u₀ ≤ 0 and D ≥ 0 the work of friction,
//!
//! ```text
//! ΔE(s) = (1 + s) P_c·u₀ + ½ (1 + s)² (−P_c·u₀ − D) ≤ ½ (1 − s²) P_c·u₀ ≤ 0
//! ```
//!
//! Hits travel: what approaches after one is hit next, in a fixed order, so that of a row of balls the last one leaves.

use super::contact::{Contact, LOCKED, Source};
use super::contact_problem::ContactProblem;
use super::earliest_impact::EarliestImpact;
use super::impact::{Impact, ImpactKind};
use super::jacobian_row::point_rows;
use super::reduced_coordinates::Mechanisms;
use super::state::Contacts;
use crate::articulation::System;
use crate::collision::{ManifoldPoint, TOUCH};
use crate::dynamics::impulse::impulse;
use soffio_geometry::bodies::RigidBody;
use soffio_math::{DMat3, DVec3};

/// Slower approaches do not bounce and make no sound, m/s (rad/s at a limit of an angle).
pub(super) const REST_SPEED: f64 = 4e-3;
/// Bounces nearer in time than this, and slower than that, are one contact: no ear tells them apart, s and m/s.
const CHATTER_TIME: f64 = 5e-3;
const CHATTER_SPEED: f64 = 0.03;
/// Points of the same two bodies that meet within this time are hit together, s: one sample of sound.
const ONE_TIME: f64 = 1.0 / 48_000.0;
/// 1/ω₀ with which joints of a figure that is struck by hand gather, s: none of them is open.
const GATHERS: f64 = 0.04;
/// Hits that travel from one, at most.
const MAX_IMPACTS_PROPAGATED: usize = 256;

/// Where and how two bodies are struck against each other.
#[derive(Clone, Copy, Debug)]
pub struct PointImpact {
    /// World, m.
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

/// What a strike did, in the frame (t, b, n) of `math::tangents`.
#[derive(Clone, Copy, Debug)]
pub struct PointImpactResult {
    /// Impulse on the first body, N s.
    pub impulse: DVec3,
    /// Relative velocity before, m/s.
    pub velocity: DVec3,
    /// Effective inverse mass, joints included, 1/kg.
    pub k: DMat3,
}

/// Resolves one hit at one point: three solves for the effective mass, one for the answer. The joints must be
/// factored at the bodies' present state. `None` where joints hold the point or nothing approaches.
pub fn resolve_point_impact(
    impact: &PointImpact,
    system: &mut System,
    bodies: &mut [RigidBody],
) -> Option<PointImpactResult> {
    let mechanisms = Mechanisms::new(system.constraints(), system.driven());
    let mut problem = ContactProblem::new(1, mechanisms, (system.states().len(), GATHERS));
    let contact = Contact::new(Source::Pair(0), impact.point, impact.normal, 0.0, impact.friction);
    problem.push(contact, &point_rows(impact.point, impact.normal, impact.bodies, bodies));
    problem.assemble(system, bodies);
    let struck = resolve_single_contact(&mut problem, impact.restitution)?;
    problem.apply(system, bodies);
    Some(struck)
}

/// The impulse of a problem of one touch.
fn resolve_single_contact(problem: &mut ContactProblem, restitution: f64) -> Option<PointImpactResult> {
    let contact = problem.contacts[0];
    let u = problem.velocity(0);
    let k = contact.k();
    if k.x_axis.x < LOCKED || u.x >= 0.0 {
        return None;
    }
    if contact.rows == 1 {
        problem.contacts[0].impulse = DVec3::X * (-(1.0 + restitution) * u.x / k.x_axis.x);
        problem.follow();
        return Some(PointImpactResult {
            impulse: DVec3::Z * problem.contacts[0].impulse.x,
            velocity: DVec3::Z * u.x,
            k: *k,
        });
    }
    // From (n, t, b) to (t, b, n).
    let turn = |v: DVec3| DVec3::new(v.y, v.z, v.x);
    let k = DMat3::from_cols(turn(k.y_axis), turn(k.z_axis), turn(k.x_axis));
    let velocity = turn(u);
    let p = impulse(&k, velocity, contact.friction, restitution);
    problem.contacts[0].impulse = DVec3::new(p.z, p.x, p.y);
    problem.follow();
    Some(PointImpactResult { impulse: p, velocity, k })
}

impl Contacts {
    /// Resolves a hit at the bodies' present state and all that it sets off; `h` is the length of a substep. The
    /// joints must be factored there.
    pub(in crate::dynamics) fn resolve_impact(
        &mut self,
        hit: &EarliestImpact,
        (time, h): (f64, f64),
        system: &mut System,
        bodies: &mut [RigidBody],
        impacts: &mut Vec<Impact>,
    ) {
        // Hits change speeds, not places: what is near stays so.
        self.near.find(bodies, bodies, &self.sleeping.bodies);
        let mut next = Some(hit.source);
        for _ in 0..MAX_IMPACTS_PROPAGATED {
            let Some(source) = next else { break };
            self.impacts_left = self.impacts_left.saturating_sub(1);
            self.collect(source, bodies);
            if self.problem.contacts.is_empty() {
                // It touches, but nothing approaches: what little there is belongs to rest.
                self.resting.set_source(source, true, &mut self.limits);
                self.collect_all(source, bodies);
                self.problem.assemble(system, bodies);
                let contacts = self.problem.contacts.len();
                impacts.extend((contacts > 0).then(|| self.impact_event(source, time, (0, contacts), 0.0, true)));
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

    /// Seconds until what is to be hit is half into the touching layer, at the bodies' present state: sweeps go straight,
    /// bodies do not. Negative where they have passed it; 0 where it cannot be told.
    pub(in crate::dynamics) fn time_to_contact(&mut self, hit: &EarliestImpact, bodies: &[RigidBody]) -> f64 {
        let (gap, speed) = match hit.source {
            Source::Bound(bound) => {
                let (gap, row, _) = self.limits.row(bound, bodies);
                (gap, -row.rate(bodies))
            }
            Source::Pair(pair) => {
                let manifold = self.surfaces.manifold(pair, bodies);
                let nearest = |a: ManifoldPoint, b: &ManifoldPoint| if b.gap < a.gap { *b } else { a };
                let at = manifold.points()[1..].iter().fold(manifold.points[0], nearest);
                (at.gap, -self.surfaces.velocity_at(pair, at.point, bodies).dot(manifold.normal))
            }
        };
        if speed > REST_SPEED { (gap - 0.5 * TOUCH) / speed } else { 0.0 }
    }

    /// All touches that approach between the two bodies of a source.
    fn collect(&mut self, source: Source, bodies: &[RigidBody]) {
        self.problem.clear();
        match source {
            Source::Bound(bound) => self.push_bound(bound, bodies),
            Source::Pair(pair) => {
                // Pairs of the same two bodies stand together.
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

    /// All touches of a source, however they move.
    fn collect_all(&mut self, source: Source, bodies: &[RigidBody]) {
        match source {
            Source::Bound(bound) => self.push_bound(bound, bodies),
            Source::Pair(pair) => {
                let manifold = self.surfaces.manifold(pair, bodies);
                for at in manifold.points() {
                    self.surfaces.push_point(&mut self.problem, pair, (at.point, manifold.normal, at.gap), bodies);
                }
            }
        }
    }

    /// Touches of a pair that approach and are closed, or will be within a sample. A pair that was found to hit has
    /// one at least.
    fn collect_pair(&mut self, pair: usize, hits: bool, bodies: &[RigidBody]) {
        let manifold = self.surfaces.manifold(pair, bodies);
        let nearest = manifold.points().iter().fold(f64::INFINITY, |least, p| least.min(p.gap));
        for at in manifold.points() {
            let speed = -self.surfaces.velocity_at(pair, at.point, bodies).dot(manifold.normal);
            if speed > 0.0 && (at.gap <= TOUCH + ONE_TIME * speed || (hits && at.gap == nearest)) {
                self.surfaces.push_point(&mut self.problem, pair, (at.point, manifold.normal, at.gap), bodies);
            }
        }
    }

    /// Finds the impulses of the problem's touches, says what they do, and decides what rests from now on.
    fn bounce(&mut self, time: f64, impacts: &mut Vec<Impact>) {
        // Touches stand in the order of their sources.
        let count = self.problem.contacts.len();
        let mut least_e: f64 = 1.0;
        let mut first = 0;
        let began = impacts.len();
        while first < count {
            let source = self.problem.contacts[first].source;
            let end = (first..count).find(|&i| self.problem.contacts[i].source != source).unwrap_or(count);
            let speed = (first..end).fold(0.0, |most: f64, contact| most.max(-self.problem.velocity(contact).x));
            let (e, rests) = self.classify_impact(source, time, speed);
            least_e = least_e.min(e);
            for contact in &mut self.problem.contacts[first..end] {
                // The rounds leave this alone; restitution reads it.
                contact.least = e;
            }
            impacts.push(self.impact_event(source, time, (first, end), speed, rests));
            first = end;
        }
        if count == 1 {
            let e = self.problem.contacts[0].least;
            self.problem.contacts[0].least = 0.0;
            let _ = resolve_single_contact(&mut self.problem, e);
        } else {
            bounce_together(&mut self.problem, least_e);
        }
        for impact in &mut impacts[began..] {
            let own = |contact: &&Contact| match contact.source {
                Source::Pair(pair) => {
                    let colliders = self.surfaces.pairs[pair].pair;
                    impact.colliders == Some([colliders.a, colliders.b])
                }
                Source::Bound(_) => true,
            };
            let sum = self.problem.contacts.iter().filter(own).fold(DVec3::ZERO, |sum, contact| sum + contact.impulse);
            impact.impulse = sum.length();
        }
    }

    /// Restitution of a hit at this speed, and whether it is the beginning of rest.
    pub(super) fn classify_impact(&mut self, source: Source, time: f64, speed: f64) -> (f64, bool) {
        let now = self.clock + time;
        let last = match source {
            Source::Pair(pair) => &mut self.resting.last_hit[pair],
            Source::Bound(bound) => self.limits.last_hit(bound),
        };
        let chatters = now - *last < CHATTER_TIME && speed < CHATTER_SPEED;
        *last = now;
        let rests = speed < REST_SPEED || chatters || self.impacts_left == 0;
        let e = match source {
            Source::Pair(pair) => self.surfaces.pairs[pair].restitution,
            Source::Bound(bound) => self.limits.restitution(bound),
        };
        self.resting.set_source(source, rests, &mut self.limits);
        (if rests { 0.0 } else { e }, rests)
    }

    /// The event of touches `first..end`, all of one source; its impulse is not known yet.
    pub(super) fn impact_event(
        &self,
        source: Source,
        time: f64,
        (first, end): (usize, usize),
        speed: f64,
        rests: bool,
    ) -> Impact {
        let contacts = &self.problem.contacts[first..end];
        let middle = contacts.iter().fold(DVec3::ZERO, |sum, t| sum + t.point) / contacts.len() as f64;
        let (bodies, colliders, moving) = match source {
            Source::Pair(pair) => {
                let at = self.surfaces.pairs[pair].pair;
                (self.surfaces.bodies_of(pair), Some([at.a, at.b]), ImpactKind::Impact)
            }
            Source::Bound(bound) => (self.limits.bodies(bound), None, ImpactKind::Stop),
        };
        Impact {
            time,
            kind: if rests { ImpactKind::RestingContact } else { moving },
            bodies,
            colliders,
            point: middle,
            normal: contacts[0].normal,
            impulse: 0.0,
            speed,
            mass: 1.0 / contacts[0].k().x_axis.x.max(LOCKED),
        }
    }

    /// What touches now and approaches too fast to be taken out without bounce.
    fn approaching(&mut self, bodies: &[RigidBody]) -> Option<Source> {
        for near in 0..self.near.list.len() {
            let pair = self.near.list[near];
            if !self.surfaces.may_touch(pair, bodies) {
                continue;
            }
            let manifold = self.surfaces.manifold(pair, bodies);
            let hits = |at: &ManifoldPoint| {
                at.gap <= TOUCH && self.surfaces.velocity_at(pair, at.point, bodies).dot(manifold.normal) < -REST_SPEED
            };
            if manifold.points().iter().any(hits) {
                return Some(Source::Pair(pair));
            }
        }
        let approaches = |b: &usize| !self.limits.sleeps(*b) && self.limits.approaches(*b, bodies, TOUCH, REST_SPEED);
        (0..self.limits.count()).find(approaches).map(Source::Bound)
    }
}

/// One hit at several touches; each touch's `least` holds its restitution, which goes over to `begin.x`.
fn bounce_together(problem: &mut ContactProblem, least_e: f64) {
    let mut most: f64 = 0.0;
    for contact in &mut problem.contacts {
        most = most.max(contact.least);
        (contact.begin.x, contact.least) = (contact.least, 0.0);
    }
    // Compression ends all approach.
    problem.solve();
    if most == 0.0 {
        return;
    }
    let compressed = problem.work();
    for contact in &mut problem.contacts {
        let e = contact.begin.x;
        contact.begin = contact.impulse;
        contact.impulse.x *= 1.0 + e;
    }
    problem.solve_friction();
    if problem.work() > compressed * (1.0 - most * most) {
        problem.contacts.iter_mut().for_each(|contact| contact.impulse = (1.0 + least_e) * contact.begin);
        problem.follow();
    }
}

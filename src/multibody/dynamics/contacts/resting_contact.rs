//! Rest: the forces of all touches over a substep, found so that contact holds at its end.
//!
//! The bodies are integrated under the forces f that held them last; where that leaves them, the contact problem is
//! solved for the impulses P = h f + ΔP that make the velocities right there (no approach, no pull, Coulomb's cone),
//! with the touches as they lie *there*, so that rolling and curved surfaces need no terms of their own. If ΔP is so
//! large that it should have moved the bodies during the substep, the substep is integrated again under P/h; else ΔP
//! is applied and P/h is where the next substep begins. A body at rest therefore feels exactly its support, does not
//! move, and costs one pass.
//!
//! What has sunk into the touching layer, by less than a micrometre in ordinary motion, rises slowly; what lies deeper is
//! moved out at once through the same matrix. Where surfaces curve so much that a substep sinks in, a shorter one is
//! taken.

use super::contact::{Contact, Grip, Source};
use super::contact_forces::{ContactForce, NEAR, in_frame};
use super::jacobian_row::{point_rows, rolling_resistance_rows};
use super::state::Contacts;
use crate::articulation::System;
use crate::collision::TOUCH;
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;

/// What rests and opens farther than this is apart again, m or rad.
const RELEASE_GAP: f64 = 5e-5;
/// Passes over one substep at most, but for one more where a rest proves false.
const PASSES: usize = 3;
/// A pass that is the last one whatever it finds.
pub(in crate::dynamics) const LAST_PASS: usize = usize::MAX;
/// Displacement within a substep that another pass is worth, m.
const MISSED: f64 = 1e-6;
/// What rests may close a gap that is wider than the touching layer, within one substep.
pub(super) const LAYER: f64 = TOUCH;
/// What rests stays where it is in the touching layer up to this height, m; so what is put exactly on a floor does not move. At a
/// bound, which is one number and no surface, m or rad.
const HIGHEST: f64 = 0.5 * LAYER;
const HIGHEST_AT_BOUND: f64 = 0.25 * LAYER;
/// What rests slides no farther than this in one substep, m.
const SLIDE: f64 = 2e-3;
/// What sinks deeper than this in a substep asks for a shorter one, m: as teeth do that go round an edge.
const FINE: f64 = 1e-6;
/// The same while joints are open, where impulses at the end of a substep hold what falls in it, m.
const FALL: f64 = 1e-5;
/// The next substep is to sink this share of it.
const SAFELY: f64 = 0.6;
const FASTEST_GROWTH: f64 = 2.0;
/// Less sinking than this says nothing of longer substeps, m: a hit cuts a substep at its time, right to some nanometres.
const SEEN: f64 = 1e-9;
/// What rests does not sink deeper than this in one substep, m.
const SUNK: f64 = 2e-5;
/// No approach is as fast as this, m/s.
const FREE: f64 = 1e9;
/// Time in which what has sunk rises into the touching layer, s: at micrometres a second, and its work is known.
const RISE: f64 = 0.02;
/// Farthest that sunken bodies are moved out in one substep, m.
pub(super) const MOST_PUSH: f64 = 1e-3;

/// What is to be done about a pass over a substep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::dynamics) enum PassOutcome {
    /// Nothing: it stands. Were bodies moved out of each other?
    Accepted { moved: bool },
    /// Integrate it again, under better forces.
    Repeat,
    /// Integrate a shorter one: surfaces curve too much for the forces to stand still.
    Shorten,
    /// Integrate it anew: a clutch gives way.
    ClutchSlips,
}

impl Contacts {
    /// Notes what clutches carry by the last solve, of forces.
    pub(in crate::dynamics) fn record_clutch_loads(&mut self, system: &System) {
        self.clutches.record_loads(system);
    }

    /// Does anything rest, or has a force to be taken back?
    pub(in crate::dynamics) fn has_resting_contacts(&self) -> bool {
        let rests = self.resting.count() > self.sleeping.at_rest;
        rests || !self.forces.held.is_empty() || self.clutches.slipping().next().is_some()
    }

    /// Longest substep in which what rests tips little and, unless contact is solved `together`, passes no feature of what it slides
    /// on, s.
    pub(in crate::dynamics) fn longest_substep(&self, together: bool) -> f64 {
        if self.resting.at_rest.iter().all(|&pair| self.sleeping.sleep(self.surfaces.bodies_of(pair))) {
            return f64::INFINITY;
        }
        let sliding = if together { f64::INFINITY } else { (SLIDE / self.slip).min(self.fine) };
        sliding.min(self.forces.longest_substep())
    }

    /// Lays the forces that hold what rests out for a substep of `h` seconds. While joints are open there are none: the
    /// stabiliser would answer each with its opposite, and both would grow. Impulses at the substep's end do instead.
    pub(in crate::dynamics) fn prepare_contact_forces(&mut self, h: f64, system: &System) {
        if self.has_resting_contacts() && system.open_rows(self.stabilization_time).next().is_some() {
            self.forces.held.clear();
        }
        self.forces.prepare_contact_forces(h);
    }

    /// The same for a substep that is gone through but once: what was an impulse is no force.
    pub(in crate::dynamics) fn prepare_contact_forces_once(&mut self, h: f64, system: &System) {
        self.forces.drop_short(h);
        self.prepare_contact_forces(h, system);
    }

    /// At the end of a pass over a substep of `h` seconds under [`Contacts::press`]: finds the forces that would have held.
    /// Where the substep stands, velocities and places are put right, the joints' velocities too. The joints must be factored at
    /// the bodies' present state, or as near to it as a substep ends, and the clutches weighed.
    pub(in crate::dynamics) fn finish_pass(
        &mut self,
        (h, pass, shortens): (f64, usize, bool),
        start: &[RigidBody],
        system: &mut System,
        bodies: &mut [RigidBody],
    ) -> PassOutcome {
        if !self.has_resting_contacts() {
            return if self.forces.slip_overloaded(&mut self.clutches, self.limits.count(), system) {
                PassOutcome::ClutchSlips
            } else {
                PassOutcome::Accepted { moved: false }
            };
        }
        let torque_work = self.forces.correct_contact_torque(h, start, system, bodies);
        let lost = self.collect_contacts(h, system, bodies);
        self.problem.assemble(system, bodies);
        self.problem.begin();
        self.problem.solve();
        let missed = lost || 0.5 * h * self.problem.largest_change() > MISSED;
        let last = pass >= PASSES || !missed || self.problem.has_open_joints();
        if last {
            // What sinks grows as the substep's square.
            let (sunk, fine) = (self.deepest_sinking(), if self.problem.has_open_joints() { FALL } else { FINE });
            let square = if sunk > SEEN { SAFELY * fine / sunk } else { f64::INFINITY };
            self.fine = (h * square.sqrt()).min(FASTEST_GROWTH * self.fine);
            if shortens && sunk > fine && (0..self.problem.contacts.len()).all(|contact| self.problem.is_good(contact))
            {
                return PassOutcome::Shorten;
            }
        }
        let stands = pass > PASSES || (last && !self.releases_sunken());
        if stands {
            self.slip = self.problem.largest_slip();
            self.work.recent = self.forces.work(start, bodies) + torque_work + self.problem.work();
            self.problem.apply_closing(system, bodies);
            self.clutches.add_loads(h, system);
            // Forces of a pass that nobody goes through again are not good enough for a clutch to slip by them.
            if pass != LAST_PASS && self.forces.slip_overloaded(&mut self.clutches, self.limits.count(), system) {
                return PassOutcome::ClutchSlips;
            }
        }
        if stands {
            self.resting.record_depths(&self.problem.contacts, &self.surfaces, &self.sleeping);
        }
        self.forces.remember(&self.problem, (h, stands), start, bodies);
        if !stands {
            return PassOutcome::Repeat;
        }
        let moved = self.problem.contacts.iter().any(|contact| contact.gap < -LAYER);
        if moved {
            self.problem.push_out(-0.5 * LAYER, MOST_PUSH, system, bodies);
        }
        PassOutcome::Accepted { moved }
    }

    /// How deep what rests has sunk in within the substep, m.
    fn deepest_sinking(&self) -> f64 {
        let sunk = |contact: &Contact| match contact.source {
            Source::Pair(pair) => self.resting.depth[pair] - contact.gap,
            Source::Bound(_) => 0.0,
        };
        self.problem.contacts.iter().map(sunk).fold(0.0, f64::max)
    }

    /// What was taken to rest and has sunk in within this substep met where nobody looked: it is apart, so that its
    /// hit is found. Answers whether there was such a pair.
    fn releases_sunken(&mut self) -> bool {
        let mut any = false;
        for index in 0..self.problem.contacts.len() {
            let contact = &mut self.problem.contacts[index];
            let Source::Pair(pair) = contact.source else { continue };
            // Once a step: a pair hit in this one has been looked at.
            if contact.gap < self.resting.depth[pair] - SUNK && self.resting.last_hit[pair] < self.clock {
                contact.impulse = DVec3::ZERO;
                any = true;
                self.resting.set(pair, false);
            }
        }
        any
    }

    /// Takes out what approach hits have left to what rests, without bounce and without memory. The joints must be
    /// factored at the bodies' present state.
    pub(super) fn remove_residual_approach(&mut self, h: f64, system: &mut System, bodies: &mut [RigidBody]) {
        self.collect_contacts(h, system, bodies);
        for contact in &mut self.problem.contacts {
            (contact.before, contact.impulse, contact.begin) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        }
        self.problem.assemble(system, bodies);
        self.problem.solve();
        self.slip = self.problem.largest_slip();
        self.work.total += self.problem.work();
        self.problem.apply(system, bodies);
    }

    /// Collects all touches of what rests into the problem, each with the impulse that held it; releases what has
    /// opened. Answers whether a force that has acted belongs to no touch any more.
    pub(super) fn collect_contacts(&mut self, h: f64, system: &System, bodies: &[RigidBody]) -> bool {
        self.problem.clear();
        let mut at_rest = 0;
        while at_rest < self.resting.at_rest.len() {
            let pair = self.resting.at_rest[at_rest];
            if self.sleeping.sleep(self.surfaces.bodies_of(pair)) {
                at_rest += 1;
                continue;
            }
            let manifold = self.surfaces.manifold(pair, bodies);
            let nearest = manifold.points().iter().fold(f64::INFINITY, |least, p| least.min(p.gap));
            if nearest > RELEASE_GAP {
                self.resting.set(pair, false);
                continue;
            }
            at_rest += 1;
            for at in manifold.points() {
                self.surfaces.push_point(&mut self.problem, pair, (at.point, manifold.normal, at.gap), bodies);
            }
        }
        for bound in 0..self.limits.count() {
            if self.limits.resting(bound) && !self.limits.sleeps(bound) {
                if self.limits.gap(bound, bodies) > RELEASE_GAP {
                    self.resting.set_bound(bound, false, &mut self.limits);
                } else {
                    self.push_bound(bound, bodies);
                }
            }
        }
        for index in 0..self.problem.contacts.len() {
            if let Source::Pair(pair) = self.problem.contacts[index].source
                && !self.surfaces.pairs[pair].resistance.is_none()
            {
                let bodies = self.surfaces.bodies_of(pair);
                self.problem.push_twist(index, bodies, self.surfaces.pairs[pair].resistance);
            }
        }
        self.push_clutches(h, system);
        for contact in self.problem.contacts.iter_mut().filter(|contact| contact.pushes()) {
            // What has sunk rises gently, and what is higher in the layer comes down; a wider gap may close within the substep.
            let highest = if matches!(contact.source, Source::Bound(_)) { HIGHEST_AT_BOUND } else { HIGHEST };
            let sunk = (contact.gap.clamp(0.0, highest) - contact.gap).clamp(-0.5 * LAYER, LAYER);
            contact.least = sunk / RISE - (contact.gap - LAYER).max(0.0) / h;
        }
        self.warm_start(h, system, bodies)
    }

    /// Gives each held force to the nearest touch of its pair. Where that is farther than a point can go, the force is
    /// taken back where it acted, and the rounds only begin from it; the answer is whether there are such.
    fn warm_start(&mut self, h: f64, system: &System, bodies: &[RigidBody]) -> bool {
        let mut lost = false;
        let present = self.problem.contacts.len();
        for index in 0..self.forces.held.len() {
            let held = self.forces.held[index];
            let near = NEAR + 2.0 * h * held.ends.iter().flatten().map(|lever| lever.speed(bodies)).sum::<f64>();
            let mut best = (None, f64::INFINITY);
            for contact in &mut self.problem.contacts[..present] {
                let far = contact.point.distance(held.point);
                if held.belongs_to(contact) && far <= best.1 {
                    best = (Some(contact), far);
                }
            }
            let follows = best.1 <= near;
            if let Some(contact) = best.0 {
                let impulse = h * in_frame(contact, &held);
                contact.begin += impulse;
                if follows {
                    contact.before += impulse;
                    contact.follows = Some(held.point);
                }
            }
            if !follows {
                lost = true;
                self.take_back(&held, h, system, bodies);
            }
        }
        for contact in &mut self.problem.contacts {
            contact.impulse = contact.before;
        }
        lost
    }

    /// Adds a touch that may approach at any speed, so that the rounds take its impulse away.
    fn take_back(&mut self, held: &ContactForce, h: f64, system: &System, bodies: &[RigidBody]) {
        let size = held.force.length();
        let row = match held.source {
            Source::Pair(pair) if held.couple => {
                rolling_resistance_rows(held.acting(self.forces.span) / size, self.surfaces.bodies_of(pair))[0]
            }
            Source::Pair(pair) => {
                point_rows(held.point, held.acting(self.forces.span) / size, self.surfaces.bodies_of(pair), bodies)[0]
            }
            Source::Bound(bound) => match bound.checked_sub(self.limits.count()) {
                Some(clutch) => self.clutches.row(clutch, held.force.x.signum(), system),
                None => self.limits.row(bound, bodies).1,
            },
        };
        let mut contact = Contact::new(held.source, held.point, DVec3::ZERO, f64::INFINITY, 0.0);
        contact.before.x = h * size;
        contact.least = -FREE;
        self.problem.push(contact, &[row]);
    }

    /// Adds what slips to the problem of a substep of `h` seconds.
    fn push_clutches(&mut self, h: f64, system: &System) {
        for (index, clutch) in self.clutches.slipping() {
            // Nothing is moved out of it: it has no gap to speak of.
            let source = Source::Bound(self.limits.count() + index);
            let mut contact = Contact::new(source, DVec3::ZERO, DVec3::ZERO, f64::INFINITY, 0.0);
            contact.grip = Some(Grip { clutch: index, most: clutch.torque * h, slips: false });
            self.problem.push(contact, &[self.clutches.row(index, 1.0, system)]);
        }
    }

    /// Lets hold what has come to rest in a substep of `h` seconds that stands. Did anything? Then rows act that did not.
    pub(in crate::dynamics) fn stick(&mut self, h: f64, system: &mut System, bodies: &[RigidBody]) -> bool {
        let mut any = false;
        for contact in &self.problem.contacts {
            let Some(grip) = contact.grip.filter(|grip| !grip.slips) else { continue };
            let constraint = self.clutches.stick(grip.clutch, contact.impulse.x / h);
            system.take_hold(constraint, bodies);
            self.forces.held.retain(|held| held.source != contact.source);
            any = true;
        }
        any
    }
}

//! Resting contact: contact forces over whole substeps, found so that every contact law holds at the substep's end.
//!
//! The bodies are integrated under the forces f of the last substep. At the end the contact problem is solved for the impulses
//! P = h f + ΔP that make the velocities right there (no approach, no pull, Coulomb's cone). Contacts are taken as they are at the
//! end, so rolling and curved surfaces need no terms of their own. If ΔP is large enough to have moved the bodies within the
//! substep, it is integrated again under P/h. Otherwise ΔP is applied, and the next substep starts with P/h. A body at rest
//! therefore feels exactly its support, does not move, and costs one pass.
//!
//! Penetration within the contact layer, below a micrometre in ordinary motion, is removed slowly; deeper penetration is removed
//! at once through the same matrix. Where surfaces curve so much that bodies sink in within a substep, it is shortened.

use super::contact::{Contact, ContactKind, ForceSource};
use super::contact_forces::{ContactForce, SAME_POINT, SolvedSubstep};
use super::jacobian_row::{point_rows, rolling_resistance_rows};
use super::state::Contacts;
use super::surfaces::PointGeometry;
use crate::articulation::System;
use crate::collision::CONTACT_MARGIN;
use crate::dynamics::step::ImpactScheme;
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;

/// Contact slop, m: resting contacts are held anywhere within this gap. A wider gap may close within one substep.
pub(super) const LAYER: f64 = CONTACT_MARGIN;
/// Farthest that bodies are moved apart after one substep, m.
pub(super) const MAX_PUSH: f64 = 1e-3;

/// Thresholds of resting contact, m unless stated.
struct Tuning {
    /// A resting contact that opens farther is released (rad at a limit of an angle).
    release_gap: f64,
    /// Passes over one substep, but for one more where a resting contact proves false.
    max_passes: usize,
    /// Displacement within a substep that is worth another pass.
    pass_error: f64,
    /// Resting contacts stay where they are up to this gap: bodies put exactly on a floor do not move.
    highest: f64,
    /// The same at a bound of a limit, rad or m.
    highest_at_limit: f64,
    /// Farthest slip in one substep.
    slip: f64,
    /// Deeper sinking within a substep asks for a shorter one: teeth that turn about an edge.
    sinking: f64,
    /// The same while joints are open, when only impulses at a substep's end hold falling bodies.
    sinking_open: f64,
    /// The next substep aims at this fraction of the allowed sinking.
    sinking_safety: f64,
    /// Largest growth of a substep's length by less sinking, as a factor.
    growth: f64,
    /// Less sinking is the error of an impact's time and does not bound the next substep.
    negligible_sinking: f64,
    /// A contact that sinks deeper in one substep was not resting: its impact is searched for.
    false_rest: f64,
    /// Time constant in which penetration is removed, s: micrometres a second.
    recovery_time: f64,
    /// Faster than any approach, m/s.
    unbounded_speed: f64,
}

/// Measured on the stacks, heaps, gears and rolling balls of the tests.
const TUNING: Tuning = Tuning {
    release_gap: 5e-5,
    max_passes: 3,
    pass_error: 1e-6,
    highest: 0.5 * LAYER,
    highest_at_limit: 0.25 * LAYER,
    slip: 2e-3,
    sinking: 1e-6,
    sinking_open: 1e-5,
    sinking_safety: 0.6,
    growth: 2.0,
    negligible_sinking: 1e-9,
    false_rest: 2e-5,
    recovery_time: 0.02,
    unbounded_speed: 1e9,
};

/// One pass over a substep.
#[derive(Clone, Copy, Debug)]
pub(in crate::dynamics) struct Pass {
    /// Length of the substep, s.
    pub h: f64,
    /// 1 of the first pass.
    pub number: usize,
    /// The work budget allows no further pass: this one is accepted.
    pub is_last: bool,
    /// The substep may be shortened.
    pub may_shorten: bool,
}

/// The outcome of a pass over a substep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::dynamics) enum PassOutcome {
    /// It is accepted.
    Accepted {
        /// Overlapping bodies were moved apart.
        pushed_apart: bool,
    },
    /// Integrate the substep again, under better forces.
    Repeat,
    /// Integrate a shorter substep: surfaces curve too much for constant forces.
    Shorten,
    /// Integrate the substep again: a clutch slips.
    ClutchSlips,
}

impl Contacts {
    /// Takes the loads of sticking clutches from the last solve of forces.
    pub(in crate::dynamics) fn record_clutch_loads(&mut self, system: &System) {
        self.clutches.record_loads(system);
    }

    /// Whether any contact rests, any clutch slips, or any force of the last substep still acts.
    pub(in crate::dynamics) fn has_resting_contacts(&self) -> bool {
        let any_rests = self.resting.count() > self.sleeping.resting;
        any_rests || !self.forces.active.is_empty() || self.clutches.slipping().next().is_some()
    }

    /// Longest substep in which no body tips far, s. With event-driven impacts it is also one in which sliding contacts pass no
    /// feature of their surfaces.
    pub(in crate::dynamics) fn longest_substep(&self, scheme: ImpactScheme) -> f64 {
        if self.resting.pairs.iter().all(|&pair| self.sleeping.both(self.surfaces.bodies_of(pair))) {
            return f64::INFINITY;
        }
        let sliding = match scheme {
            ImpactScheme::EventDriven => (TUNING.slip / self.slip).min(self.sinking_limit),
            ImpactScheme::TimeStepping => f64::INFINITY,
        };
        sliding.min(self.forces.longest_substep())
    }

    /// Prepares the forces of resting contacts for a substep of `h` seconds. While joints are open there are none: the stabiliser
    /// would oppose each force, and both would grow. Impulses at the substep's end act instead.
    pub(in crate::dynamics) fn prepare_contact_forces(&mut self, h: f64, system: &System) {
        if self.has_resting_contacts() && system.open_rows(self.stabilization_time).next().is_some() {
            self.forces.active.clear();
        }
        self.forces.prepare(h);
    }

    /// Prepares the forces for a substep that is integrated only once, without those that were impulses.
    pub(in crate::dynamics) fn prepare_contact_forces_once(&mut self, h: f64, system: &System) {
        self.forces.remove_impulsive(h);
        self.prepare_contact_forces(h, system);
    }

    /// Ends a pass over a substep under [`Contacts::apply_contact_forces`]: finds the forces that would have satisfied the contact
    /// laws. If the pass is accepted, velocities and positions are corrected, those of the joints too. The joints must be factored
    /// at the bodies' present state, or as near to it as a substep ends, and the clutches' loads recorded.
    pub(in crate::dynamics) fn finish_pass(
        &mut self,
        pass: Pass,
        start: &[RigidBody],
        system: &mut System,
        bodies: &mut [RigidBody],
    ) -> PassOutcome {
        let Pass { h, number, is_last, may_shorten } = pass;
        if !self.has_resting_contacts() {
            return if self.forces.slip_overloaded(&mut self.clutches, system) {
                PassOutcome::ClutchSlips
            } else {
                PassOutcome::Accepted { pushed_apart: false }
            };
        }
        let torque_work = self.forces.correct_contact_torque(h, start, system, bodies);
        let lost = self.collect_contacts(h, system, bodies);
        self.problem.assemble(system, bodies);
        self.problem.start_from_initial();
        self.problem.solve();
        let inaccurate = lost || 0.5 * h * self.problem.largest_change() > TUNING.pass_error;
        let final_pass = is_last || number >= TUNING.max_passes || !inaccurate || self.problem.has_open_joints();
        if final_pass {
            // Sinking grows as the square of the substep.
            let allowed = if self.problem.has_open_joints() { TUNING.sinking_open } else { TUNING.sinking };
            let sunk = self.deepest_sinking();
            let square =
                if sunk > TUNING.negligible_sinking { TUNING.sinking_safety * allowed / sunk } else { f64::INFINITY };
            self.sinking_limit = (h * square.sqrt()).min(TUNING.growth * self.sinking_limit);
            let mut all = 0..self.problem.contacts.len();
            if may_shorten && sunk > allowed && all.all(|contact| self.problem.is_warm_start(contact)) {
                return PassOutcome::Shorten;
            }
        }
        let accepted = is_last || number > TUNING.max_passes || (final_pass && !self.release_sunken());
        if accepted {
            self.slip = self.problem.largest_slip();
            self.work.recent = self.forces.work(start, bodies) + torque_work + self.problem.work();
            self.problem.apply_closing(system, bodies);
            self.clutches.add_loads(h, system);
            // Forces of the budget's last pass are too inaccurate for a clutch to slip by them.
            if !is_last && self.forces.slip_overloaded(&mut self.clutches, system) {
                return PassOutcome::ClutchSlips;
            }
            self.resting.record_depths(&self.problem.contacts, &self.surfaces, &self.sleeping);
        }
        self.forces.store(&self.problem, SolvedSubstep { h, accepted, start }, bodies);
        if !accepted {
            return PassOutcome::Repeat;
        }
        let pushed_apart = self.problem.contacts.iter().any(|contact| contact.gap < -LAYER);
        if pushed_apart {
            self.problem.push_out(-0.5 * LAYER, MAX_PUSH, system, bodies);
        }
        PassOutcome::Accepted { pushed_apart }
    }

    /// Largest increase of a resting contact's penetration within the substep, m.
    fn deepest_sinking(&self) -> f64 {
        let sunk = |contact: &Contact| match contact.point_pair() {
            Some(pair) => self.resting.depth[pair] - contact.gap,
            None => 0.0,
        };
        self.problem.contacts.iter().map(sunk).fold(0.0, f64::max)
    }

    /// Releases resting pairs that sank in within this substep: they met where nothing was searched for, and their impact is to
    /// be found. Returns whether there is any.
    fn release_sunken(&mut self) -> bool {
        let mut any = false;
        for index in 0..self.problem.contacts.len() {
            let contact = &mut self.problem.contacts[index];
            let Some(pair) = contact.point_pair() else { continue };
            // Once a step: a pair with an impact in this step has been searched for.
            if contact.gap < self.resting.depth[pair] - TUNING.false_rest && self.resting.last_impact[pair] < self.clock
            {
                contact.impulse = DVec3::ZERO;
                any = true;
                self.resting.set_pair(pair, false);
            }
        }
        any
    }

    /// Removes the approach that impacts left to resting contacts, without bounce. The joints must be factored at the bodies'
    /// present state.
    pub(super) fn remove_residual_approach(&mut self, h: f64, system: &mut System, bodies: &mut [RigidBody]) {
        self.collect_contacts(h, system, bodies);
        for contact in &mut self.problem.contacts {
            (contact.applied, contact.impulse, contact.initial) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        }
        self.problem.assemble(system, bodies);
        self.problem.solve();
        self.slip = self.problem.largest_slip();
        self.work.total += self.problem.work();
        self.problem.apply(system, bodies);
    }

    /// Collects all resting contacts into the problem, each with the impulse of its last force, and releases those that have
    /// opened. Returns whether the contact of any force is gone.
    pub(super) fn collect_contacts(&mut self, h: f64, system: &System, bodies: &[RigidBody]) -> bool {
        self.problem.clear();
        let mut index = 0;
        while index < self.resting.pairs.len() {
            let pair = self.resting.pairs[index];
            if self.sleeping.both(self.surfaces.bodies_of(pair)) {
                index += 1;
                continue;
            }
            let manifold = self.surfaces.manifold(pair, bodies);
            let nearest = manifold.points().iter().fold(f64::INFINITY, |least, p| least.min(p.gap));
            if nearest > TUNING.release_gap {
                self.resting.set_pair(pair, false);
                continue;
            }
            index += 1;
            for at in manifold.points() {
                let at = PointGeometry { point: at.point, normal: manifold.normal, gap: at.gap };
                self.surfaces.push_point(&mut self.problem, pair, at, bodies);
            }
        }
        for bound in 0..self.limits.count() {
            if self.limits.is_resting(bound) && !self.limits.is_asleep(bound) {
                if self.limits.gap(bound, bodies) > TUNING.release_gap {
                    self.resting.set_bound(bound, false, &mut self.limits);
                } else {
                    self.push_bound(bound, bodies);
                }
            }
        }
        let points_and_limits = self.problem.contacts.len();
        for index in 0..points_and_limits {
            if let Some(pair) = self.problem.contacts[index].point_pair()
                && !self.surfaces.pairs[pair].resistance.is_none()
            {
                let bodies = self.surfaces.bodies_of(pair);
                self.problem.push_rolling_resistance(index, bodies, self.surfaces.pairs[pair].resistance);
            }
        }
        self.push_clutches(h, system);
        for contact in &mut self.problem.contacts[..points_and_limits] {
            // Penetration is removed slowly, and contacts high in the layer come down. A wider gap may close within the substep.
            let is_limit = matches!(contact.kind, ContactKind::Limit { .. });
            let highest = if is_limit { TUNING.highest_at_limit } else { TUNING.highest };
            let sunk = (contact.gap.clamp(0.0, highest) - contact.gap).clamp(-0.5 * LAYER, LAYER);
            contact.min_velocity = sunk / TUNING.recovery_time - (contact.gap - LAYER).max(0.0) / h;
        }
        self.warm_start(h, system, bodies)
    }

    /// Gives each force to the nearest contact of its source. If that is farther than the point can have moved, the force is
    /// removed where it acted, and only the solver's start contains it. Returns whether there is any such force.
    fn warm_start(&mut self, h: f64, system: &System, bodies: &[RigidBody]) -> bool {
        let mut lost = false;
        let present = self.problem.contacts.len();
        for index in 0..self.forces.active.len() {
            let force = self.forces.active[index];
            let near = SAME_POINT + 2.0 * h * force.arms.iter().flatten().map(|arm| arm.speed(bodies)).sum::<f64>();
            let mut nearest = (None, f64::INFINITY);
            for contact in &mut self.problem.contacts[..present] {
                let distance = contact.point.distance(force.point);
                if force.source == contact.force_source() && distance <= nearest.1 {
                    nearest = (Some(contact), distance);
                }
            }
            let continues = nearest.1 <= near;
            if let Some(contact) = nearest.0 {
                let impulse = h * force.in_frame(contact);
                contact.initial += impulse;
                if continues {
                    contact.applied += impulse;
                    contact.previous_point = Some(force.point);
                }
            }
            if !continues {
                lost = true;
                self.remove_force(&force, h, system, bodies);
            }
        }
        for contact in &mut self.problem.contacts {
            contact.impulse = contact.applied;
        }
        lost
    }

    /// Adds a contact that may approach at any speed, so that the solver unloads its impulse.
    fn remove_force(&mut self, force: &ContactForce, h: f64, system: &System, bodies: &[RigidBody]) {
        let magnitude = force.force.length();
        let direction = force.acting(self.forces.substep) / magnitude;
        let row = match force.source {
            ForceSource::Rolling(pair) => rolling_resistance_rows(direction, self.surfaces.bodies_of(pair))[0],
            ForceSource::Point(pair) => point_rows(force.point, direction, self.surfaces.bodies_of(pair), bodies)[0],
            ForceSource::Clutch(clutch) => self.clutches.row(clutch, force.force.x.signum(), system),
            ForceSource::Limit(bound) => self.limits.row(bound, bodies).row,
        };
        let kind = ContactKind::Removed { source: force.source };
        let mut contact = Contact::without_gap(kind, force.point, DVec3::ZERO);
        contact.applied.x = h * magnitude;
        contact.min_velocity = -TUNING.unbounded_speed;
        self.problem.push(contact, &[row]);
    }

    /// Adds the slipping clutches to the problem of a substep of `h` seconds.
    fn push_clutches(&mut self, h: f64, system: &System) {
        for (index, clutch) in self.clutches.slipping() {
            let kind = ContactKind::Clutch { clutch: index, max_impulse: clutch.torque * h, slips: false };
            let row = self.clutches.row(index, 1.0, system);
            self.problem.push(Contact::without_gap(kind, DVec3::ZERO, DVec3::ZERO), &[row]);
        }
    }

    /// Lets clutches stick that came to rest in an accepted substep of `h` seconds. Returns whether any does: its row then acts
    /// again.
    pub(in crate::dynamics) fn stick_clutches(&mut self, h: f64, system: &mut System, bodies: &[RigidBody]) -> bool {
        let mut any = false;
        for contact in &self.problem.contacts {
            let ContactKind::Clutch { clutch, slips: false, .. } = contact.kind else { continue };
            let constraint = self.clutches.stick(clutch, contact.impulse.x / h);
            system.let_stick(constraint, bodies);
            self.forces.active.retain(|force| force.source != ForceSource::Clutch(clutch));
            any = true;
        }
        any
    }
}

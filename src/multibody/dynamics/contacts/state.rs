//! All contacts of an articulation and their state between substeps.

use super::contact::{Contact, ContactKind};
use super::contact_forces::ContactForces;
use super::contact_problem::ContactProblem;
use super::impact::SurfacePair;
use super::impact_solver::REST_SPEED;
use super::nearby_pairs::NearbyPairs;
use super::open_joints::Stabilization;
use super::reduced_coordinates::Mechanisms;
use super::resting_pairs::RestingSet;
use super::sleeping_bodies::SleepingBodies;
use super::surfaces::Surfaces;
use super::time_stepping::PendingImpact;
use crate::articulation::{Constraint, Limit};
use crate::collision::{CONTACT_MARGIN, Collider, ColliderPair, ManifoldPoint};
use crate::dynamics::clutches::Clutches;
use crate::dynamics::limits::{BoundRow, Limits};
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_math::spatial::Vec6;

/// Impacts resolved at their own time in one step; further ones begin resting contact.
const MAX_IMPACTS: usize = 64;

/// Capacity for impacts within one time step; more make the list grow.
const PENDING_IMPACTS: usize = 64;

/// All contacts of an articulation: surfaces, limits and clutches, and the forces between them.
#[derive(Clone, Debug)]
pub struct Contacts {
    pub(super) surfaces: Surfaces,
    pub(super) nearby: NearbyPairs,
    pub(super) resting: RestingSet,
    pub(super) limits: Limits,
    pub(super) clutches: Clutches,
    pub(super) problem: ContactProblem,
    pub(super) forces: ContactForces,
    pub(super) sleeping: SleepingBodies,
    pub(super) work: Work,
    /// Impacts of the last time step.
    pub(super) pending_impacts: Vec<PendingImpact>,
    /// 1/ω₀ of the stabiliser, s.
    pub(super) stabilization_time: f64,
    /// When the present step began, s.
    pub(super) clock: f64,
    /// Slip of the fastest resting contact, m/s.
    pub(super) slip: f64,
    /// Longest substep in which resting contacts sink in little, by the last substep, s.
    pub(super) sinking_limit: f64,
    /// Impacts that may still be resolved in the present step.
    pub(super) impacts_left: usize,
}

/// Work of impacts and resting contacts, J; losses make it negative.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Work {
    /// Of all substeps before.
    pub total: f64,
    /// Of resting contacts over the present substep, which an impact may still cut.
    pub recent: f64,
}

/// What contacts are made of.
#[derive(Clone, Debug)]
pub(in crate::dynamics) struct ContactSetup<'a> {
    /// All colliders.
    pub colliders: &'a [Collider],
    /// The pairs of colliders that can touch.
    pub pairs: Vec<SurfacePair>,
    /// All joint limits.
    pub limits: &'a [Limit],
    /// All constraints, clutches among them.
    pub constraints: &'a [Constraint],
    /// The bodies in their start state.
    pub bodies: &'a [RigidBody],
    /// Whether each body is kinematic.
    pub is_kinematic: &'a [bool],
    /// How open contacts are closed.
    pub stabilization: Stabilization,
}

impl Contacts {
    /// The contacts of an articulation; none rests yet.
    pub(in crate::dynamics) fn new(setup: ContactSetup) -> Self {
        let ContactSetup { colliders, pairs, limits, constraints, bodies, is_kinematic, stabilization } = setup;
        let limits = Limits::new(limits, bodies);
        let clutches = Clutches::new(constraints);
        let rolling = pairs.iter().filter(|surface| !surface.resistance.is_none()).count();
        let contacts = crate::collision::MANIFOLD_POINTS * (pairs.len() + rolling) + limits.count() + clutches.count();
        let problem = ContactProblem::new(contacts, Mechanisms::new(constraints, is_kinematic), stabilization);
        let bare: Vec<ColliderPair> = pairs.iter().map(|surface| surface.pair).collect();
        Self {
            nearby: NearbyPairs::new(colliders, &bare, bodies.len()),
            resting: RestingSet::new(pairs.len()),
            surfaces: Surfaces::new(colliders, pairs, bodies),
            forces: ContactForces::new(contacts, problem.contacts.capacity(), bodies.len()),
            sleeping: SleepingBodies::new(bodies.len()),
            limits,
            clutches,
            problem,
            work: Work::default(),
            pending_impacts: Vec::with_capacity(PENDING_IMPACTS),
            stabilization_time: stabilization.time,
            clock: 0.0,
            slip: 0.0,
            sinking_limit: f64::INFINITY,
            impacts_left: MAX_IMPACTS,
        }
    }

    /// Begins a step at the time `now`, s.
    pub(in crate::dynamics) fn begin_step(&mut self, now: f64) {
        self.impacts_left = MAX_IMPACTS;
        self.nearby.measured = 0;
        self.clock = now;
    }

    /// Adds the forces of resting contacts to the bodies' wrenches, each at its point in the middle of the substep.
    pub(in crate::dynamics) fn apply_contact_forces(&self, external: &mut [Vec6]) {
        self.forces.apply(external);
    }

    /// Keeps the forces at the start of a substep, in case it is repeated.
    pub(in crate::dynamics) fn begin_substep(&mut self) {
        self.forces.begin_substep(&self.clutches);
    }

    /// Ends a substep: counts full turns of limits up to the bodies' present state.
    pub(in crate::dynamics) fn end_substep(&mut self, bodies: &[RigidBody]) {
        self.limits.follow(bodies);
        self.work.total += std::mem::take(&mut self.work.recent);
    }

    /// Discards the work of the present substep, which an impact cuts.
    pub(in crate::dynamics) fn cut_substep(&mut self) {
        self.work.recent = 0.0;
    }

    /// Operations since the last call (`dynamics/work_budget.rs`).
    pub(in crate::dynamics) fn take_operations(&mut self) -> u64 {
        std::mem::take(&mut self.problem.operations)
    }

    /// Number of pairs of colliders measured in the present step: those whose boxes overlapped.
    pub(in crate::dynamics) fn measured(&self) -> usize {
        self.nearby.measured
    }

    /// Whether there are no pairs and no limits.
    pub(in crate::dynamics) fn is_empty(&self) -> bool {
        self.surfaces.pairs.is_empty() && self.limits.count() == 0
    }

    /// The clutches.
    pub(in crate::dynamics) fn clutches(&self) -> &Clutches {
        &self.clutches
    }

    /// Work of all impacts and resting contacts so far, J.
    pub(in crate::dynamics) fn work(&self) -> f64 {
        self.work.total
    }

    /// Puts pairs that touch without approach at the start in resting contact.
    pub(in crate::dynamics) fn find_resting_contacts(&mut self, bodies: &[RigidBody]) {
        self.nearby.find(bodies, bodies, &self.sleeping.bodies);
        for index in 0..self.nearby.list.len() {
            let pair = self.nearby.list[index];
            let manifold = self.surfaces.manifold(pair, bodies);
            let speed = |at: &ManifoldPoint| self.surfaces.velocity_at(pair, at.point, bodies).dot(manifold.normal);
            let mut closed = manifold.points().iter().filter(|at| at.gap <= CONTACT_MARGIN).peekable();
            if closed.peek().is_some() && closed.all(|at| speed(at).abs() < REST_SPEED) {
                self.resting.set_pair(pair, true);
            }
        }
    }

    /// Ends all resting contact, for bodies that were moved.
    pub(in crate::dynamics) fn restart(&mut self, bodies: &[RigidBody]) {
        self.resting.clear();
        self.forces.clear();
        self.sleeping.resting = 0;
        self.sinking_limit = f64::INFINITY;
        self.limits.restart(bodies);
    }

    /// Adds a bound of a limit to the problem.
    pub(super) fn push_bound(&mut self, bound: usize, bodies: &[RigidBody]) {
        let BoundRow { gap, row, point } = self.limits.row(bound, bodies);
        self.problem.push(Contact::new(ContactKind::Limit { bound }, point, DVec3::ZERO, gap), &[row]);
    }
}

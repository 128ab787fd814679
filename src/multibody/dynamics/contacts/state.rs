//! All that can touch in a figure, and its state.

use super::contact::{Contact, Source};
use super::contact_forces::ContactForces;
use super::contact_problem::ContactProblem;
use super::impact::SurfacePair;
use super::impact_solver::REST_SPEED;
use super::nearby_pairs::NearbyPairs;
use super::reduced_coordinates::Mechanisms;
use super::resting_pairs::RestingSet;
use super::sleeping_bodies::SleepingBodies;
use super::surfaces::Surfaces;
use super::time_stepping::PendingImpact;
use crate::articulation::{Constraint, Limit};
use crate::collision::{Collider, ManifoldPoint, Pair, TOUCH};
use crate::dynamics::clutches::Clutches;
use crate::dynamics::limits::Limits;
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_math::spatial::Vec6;

/// Hits resolved at their own time in one step; what is hit further rests.
const MOST_IMPACTS: usize = 64;

/// Room for what meets in one substep; more makes the list grow.
const PENDING_IMPACTS_CAPACITY: usize = 64;

/// All that can touch in a figure, and its state.
#[derive(Clone, Debug)]
pub struct Contacts {
    pub(super) surfaces: Surfaces,
    pub(super) near: NearbyPairs,
    pub(super) resting: RestingSet,
    pub(super) limits: Limits,
    pub(super) clutches: Clutches,
    pub(super) problem: ContactProblem,
    pub(super) forces: ContactForces,
    pub(super) sleeping: SleepingBodies,
    pub(super) work: Work,
    /// What met on the way of the last substep that was solved together.
    pub(super) pending_impacts: Vec<PendingImpact>,
    /// 1/ω₀ of the figure's stabiliser, s.
    pub(super) stabilization_time: f64,
    /// When the present step began, s.
    pub(super) clock: f64,
    /// Slip of the fastest touch that rests, m/s.
    pub(super) slip: f64,
    /// Longest substep in which what rests sinks in by little, by the last one, s.
    pub(super) fine: f64,
    /// Hits that may yet be resolved in the present step.
    pub(super) impacts_left: usize,
}

/// Work of hits and resting contacts, J; losses make it negative.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Work {
    /// Of all so far.
    pub total: f64,
    /// Of resting contacts over the present substep: it may yet be cut by a hit.
    pub recent: f64,
}

impl Contacts {
    /// The contacts of a figure with these colliders, limits and clutches among its constraints, whose joints have this many
    /// rows and are drawn together with this time constant (s).
    pub fn new(
        colliders: &[Collider],
        pairs: Vec<SurfacePair>,
        (limits, constraints): (&[Limit], &[Constraint]),
        (bodies, is_kinematic): (&[RigidBody], &[bool]),
        joints: (usize, f64),
    ) -> Self {
        let limits = Limits::new(limits, bodies);
        let clutches = Clutches::new(constraints);
        let turning = pairs.iter().filter(|surface| !surface.resistance.is_none()).count();
        let contacts = crate::collision::MANIFOLD_POINTS * (pairs.len() + turning) + limits.count() + clutches.count();
        let problem = ContactProblem::new(contacts, Mechanisms::new(constraints, is_kinematic), joints);
        let bare: Vec<Pair> = pairs.iter().map(|surface| surface.pair).collect();
        Self {
            near: NearbyPairs::new(colliders, &bare, bodies.len()),
            resting: RestingSet::new(pairs.len()),
            surfaces: Surfaces::new(colliders, pairs, bodies),
            forces: ContactForces::new(contacts, problem.contacts.capacity(), bodies.len()),
            sleeping: SleepingBodies::new(bodies.len()),
            limits,
            clutches,
            problem,
            work: Work::default(),
            pending_impacts: Vec::with_capacity(PENDING_IMPACTS_CAPACITY),
            stabilization_time: joints.1,
            clock: 0.0,
            slip: 0.0,
            fine: f64::INFINITY,
            impacts_left: MOST_IMPACTS,
        }
    }

    /// Begins a step at the time `now`, s.
    pub(in crate::dynamics) fn begin_step(&mut self, now: f64) {
        self.impacts_left = MOST_IMPACTS;
        self.near.measured = 0;
        self.clock = now;
    }

    /// Adds the forces that hold what rests, each at where its point will be in the middle of the substep.
    pub(in crate::dynamics) fn apply_contact_forces(&self, external: &mut [Vec6]) {
        self.forces.apply_contact_forces(external);
    }

    /// Keeps the forces that the substep begins with, for the case that it is gone through again.
    pub(in crate::dynamics) fn begin_substep(&mut self) {
        self.forces.begin_substep(&self.clutches);
    }

    /// Ends a substep: turns are counted on from where the bodies are now.
    pub(in crate::dynamics) fn end_substep(&mut self, bodies: &[RigidBody]) {
        self.limits.follow(bodies);
        self.work.total += std::mem::take(&mut self.work.recent);
    }

    /// The present substep has not been: it is cut by a hit.
    pub(in crate::dynamics) fn cut_substep(&mut self) {
        self.work.recent = 0.0;
    }

    /// Operations since this was last asked (`dynamics/operations.rs`).
    pub(in crate::dynamics) fn take_operations(&mut self) -> u64 {
        std::mem::take(&mut self.problem.operations)
    }

    /// How many pairs of colliders have been measured in the present step: those whose boxes overlapped.
    pub(in crate::dynamics) fn measured(&self) -> usize {
        self.near.measured
    }

    /// Is there nothing that could meet or reach a bound?
    pub(in crate::dynamics) fn is_empty(&self) -> bool {
        self.surfaces.pairs.is_empty() && self.limits.count() == 0
    }

    /// The clutches.
    pub(in crate::dynamics) fn clutches(&self) -> &Clutches {
        &self.clutches
    }

    /// Work of all hits and resting contacts so far, J.
    pub(in crate::dynamics) fn work(&self) -> f64 {
        self.work.total
    }

    /// Finds what touches where the figure begins and does not hit: it rests from the first substep on.
    pub(in crate::dynamics) fn find_resting_contacts(&mut self, bodies: &[RigidBody]) {
        self.near.find(bodies, bodies, &self.sleeping.bodies);
        for near in 0..self.near.list.len() {
            let pair = self.near.list[near];
            let manifold = self.surfaces.manifold(pair, bodies);
            let speed = |at: &ManifoldPoint| self.surfaces.velocity_at(pair, at.point, bodies).dot(manifold.normal);
            let mut closed = manifold.points().iter().filter(|at| at.gap <= TOUCH).peekable();
            if closed.peek().is_some() && closed.all(|at| speed(at).abs() < REST_SPEED) {
                self.resting.set(pair, true);
            }
        }
    }

    /// Forgets all rest, for bodies that were put elsewhere.
    pub(in crate::dynamics) fn forget(&mut self, bodies: &[RigidBody]) {
        self.resting.forget();
        self.forces.forget();
        self.sleeping.at_rest = 0;
        self.fine = f64::INFINITY;
        self.limits.forget(bodies);
    }

    /// Adds a bound of a limit to the problem, its value `gap` away.
    pub(super) fn push_bound(&mut self, bound: usize, bodies: &[RigidBody]) {
        let (gap, row, point) = self.limits.row(bound, bodies);
        let contact = Contact::new(Source::Bound(bound), point, DVec3::ZERO, gap, 0.0);
        self.problem.push(contact, &[row]);
    }
}

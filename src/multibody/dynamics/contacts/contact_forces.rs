//! Contact forces of resting contacts from one substep to the next: where they act, and how their arms move with the bodies.

use super::contact::{Contact, ForceSource};
use super::contact_problem::ContactProblem;
use super::jacobian_row::MAX_ROW_BODIES;
use crate::articulation::System;
use crate::dynamics::clutches::{Clutches, SlippedClutch};
use crate::dynamics::joint_loads::least_inertia_across;
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{Vec6, add_scaled, angular, linear, vec6};
use soffio_math::{DQuat, DVec3, rotation, rotation_vector, tangents};

/// Contact points nearer than this continue each other, however slow their bodies, m.
pub(super) const SAME_POINT: f64 = 1e-4;
/// Lengths of substeps that differ by less than this fraction are equal.
const SAME_LENGTH: f64 = 1e-9;
/// Displacements of a substep are extrapolated by this factor at most: those of a very short one may be jumps.
const MAX_EXTRAPOLATION: f64 = 4.0;
/// Lines of action nearer than this coincide, m: rounding.
const IN_LINE: f64 = 1e-14;
/// Largest phase ω h of a tipping body in one substep, rad: a light body under a heavy one.
const TIPPING_PHASE: f64 = 1.0;
/// Capacity for forces of sleeping bodies, and of those that wake: sixteen times as many as are solved for at once.
const CAPACITY: usize = 1024;

/// The force of one resting contact, found in the last substep in which it acted.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactForce {
    /// Which contact exerts it.
    pub source: ForceSource,
    /// World point at which it acts, m.
    pub point: DVec3,
    /// World force (N) or, of a rolling resistance, couple (N m) on the first body; in x along the row of a limit or clutch.
    pub force: DVec3,
    /// Length of the substep in which it was found, s.
    pub substep: f64,
    /// World normal at `point`.
    pub normal: DVec3,
    /// Rotation vector of the normal over a substep of that length, rad.
    normal_rotation: DVec3,
    /// How it acts on its bodies.
    pub arms: [Option<ContactArm>; MAX_ROW_BODIES],
}

/// How a contact force acts on one body.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactArm {
    /// Index of the body.
    pub body: usize,
    /// Wrench of a unit force of a limit or clutch, and its change over a substep of that length.
    jacobian: Vec6,
    jacobian_change: Vec6,
    /// From the body's centre of mass to the contact point, m.
    offset: DVec3,
    /// Displacement of the contact point relative to the centre over a substep of that length, m.
    pub displacement: DVec3,
}

/// A substep whose forces are stored.
#[derive(Clone, Copy, Debug)]
pub(super) struct SolvedSubstep<'a> {
    /// Length, s.
    pub h: f64,
    /// It is accepted; else it is integrated again from its start.
    pub accepted: bool,
    /// The bodies at its start.
    pub start: &'a [RigidBody],
}

/// The forces of all resting contacts. Nothing here allocates after [`ContactForces::new`].
#[derive(Clone, Debug)]
pub(super) struct ContactForces {
    /// Those of bodies that are awake.
    pub active: Vec<ContactForce>,
    /// Those at the start of the present substep, while a sticking clutch may yet slip.
    at_start: Vec<ContactForce>,
    /// Those of the last pass.
    previous: Vec<ContactForce>,
    /// Those of sleeping bodies.
    pub asleep: Vec<ContactForce>,
    /// Length of the substep for which they are prepared, s.
    pub substep: f64,
    /// ω² at which each body would tip over under its forces, and the greatest, 1/s².
    tipping: Vec<f64>,
    max_tipping: f64,
}

impl ContactForces {
    /// Capacity for the forces of so many contacts, of which `at_once` are solved for together.
    pub fn new(contacts: usize, at_once: usize, bodies: usize) -> Self {
        let capacity = contacts.min(CAPACITY);
        Self {
            active: Vec::with_capacity(capacity),
            at_start: Vec::with_capacity(capacity),
            previous: Vec::with_capacity(at_once),
            asleep: Vec::with_capacity(capacity),
            substep: 0.0,
            tipping: vec![0.0; bodies],
            max_tipping: 0.0,
        }
    }

    /// Removes all forces.
    pub fn clear(&mut self) {
        self.active.clear();
        self.asleep.clear();
    }

    /// Prepares the forces for a substep of `h` seconds.
    pub fn prepare(&mut self, h: f64) {
        if (h - self.substep).abs() > SAME_LENGTH * h {
            self.substep = h;
        }
    }

    /// Removes forces of substeps much shorter than `h` seconds: they are impulses rather than forces.
    pub fn remove_impulsive(&mut self, h: f64) {
        self.active.retain(|force| force.substep > 0.5 * h);
    }

    /// Longest substep in which no body tips far, s.
    pub fn longest_substep(&self) -> f64 {
        TIPPING_PHASE / self.max_tipping.sqrt()
    }

    /// Sets which bodies sleep: their forces are kept aside, and those of bodies that woke act again.
    pub fn set_asleep(&mut self, asleep: &[bool]) {
        let sleeps = |force: &ContactForce| force.arms.iter().flatten().any(|arm| asleep[arm.body]);
        let transfer = |from: &mut Vec<ContactForce>, to: &mut Vec<ContactForce>, which: bool| {
            to.extend(from.iter().filter(|force| sleeps(force) == which));
            from.retain(|force| sleeps(force) != which);
        };
        transfer(&mut self.active, &mut self.asleep, true);
        transfer(&mut self.asleep, &mut self.active, false);
    }

    /// Adds the forces to the bodies' wrenches, each at its point in the middle of the substep.
    pub fn apply(&self, external: &mut [Vec6]) {
        for (body, wrench) in self.wrenches() {
            add_scaled(&mut external[body], 1.0, &wrench);
        }
    }

    fn wrenches(&self) -> impl Iterator<Item = (usize, Vec6)> {
        self.active.iter().flat_map(|force| force.wrenches(self.substep))
    }

    /// Work of the forces between two states of the bodies, J.
    pub fn work(&self, start: &[RigidBody], end: &[RigidBody]) -> f64 {
        let work = |(body, wrench): (usize, Vec6)| {
            let (from, to) = (&start[body], &end[body]);
            let change = to.rotation * from.rotation.conjugate();
            let angle = rotation_vector(if change.w < 0.0 { -change } else { change });
            linear(&wrench).dot(to.position - from.position) + angular(&wrench).dot(angle)
        };
        self.wrenches().map(work).sum()
    }

    /// Restores angular momentum: gives both bodies of each contact the angular impulse that their forces missed, because the
    /// arms were constant over the substep. Returns its work, J.
    ///
    /// With x̄ a body's mean position over the substep, r the arm of the force F on it, and p̄ = ½ (x̄_a + r_a + x̄_b + r_b), body i
    /// misses h (p̄ − x̄_i − r_i) × F_i. Both forces then act along one line through p̄. For constant acceleration
    /// x̄ = ½ (x₀ + x₁) − h (v₁ − v₀)/12 is exact.
    pub fn correct_contact_torque(
        &self,
        h: f64,
        start: &[RigidBody],
        system: &mut System,
        bodies: &mut [RigidBody],
    ) -> f64 {
        system.b.fill([0.0; 6]);
        let (mut any, mut work) = (false, 0.0);
        for force in &self.active {
            let ([Some(a), Some(b), _], ForceSource::Point(_)) = (&force.arms, force.source) else {
                continue;
            };
            let extrapolation = force.extrapolation(self.substep);
            let mean_point = |arm: &ContactArm| {
                let (from, to) = (&start[arm.body], &bodies[arm.body]);
                let mean = 0.5 * (from.position + to.position) - (to.velocity - from.velocity) * (h / 12.0);
                mean + arm.offset + extrapolation * arm.displacement
            };
            let acting = force.acting(self.substep);
            let apart = mean_point(b) - mean_point(a);
            if apart.length_squared() <= IN_LINE * IN_LINE {
                continue;
            }
            let missing = (0.5 * h) * apart.cross(acting);
            // Each is half of the distance from p̄, and the forces are opposite: both miss the same angular impulse.
            for arm in [a, b] {
                system.push_impulse(arm.body, &vec6(DVec3::ZERO, missing), 1.0);
                let spin = |bodies: &[RigidBody]| bodies[arm.body].angular_velocity;
                work += 0.5 * missing.dot(spin(start) + spin(bodies));
            }
            any = true;
        }
        if any {
            system.solve_impulse();
            system.apply_velocity(bodies);
        }
        work
    }

    /// Stores the forces of a solved problem, for the next substep or to repeat this one. Impulses that are no accurate start are
    /// left out.
    pub fn store(&mut self, problem: &ContactProblem, substep: SolvedSubstep, bodies: &[RigidBody]) {
        let SolvedSubstep { h, accepted, start } = substep;
        self.previous.clear();
        std::mem::swap(&mut self.previous, &mut self.active);
        self.max_tipping = 0.0;
        if problem.has_open_joints() {
            return;
        }
        self.tipping.fill(0.0);
        for (index, contact) in problem.contacts.iter().enumerate() {
            if contact.impulse == DVec3::ZERO || !problem.is_warm_start(index) {
                continue;
            }
            let source = contact.force_source();
            let continues =
                |force: &&ContactForce| force.source == source && contact.previous_point == Some(force.point);
            let previous = self.previous.iter().find(continues);
            let row = &problem.rows[contact.rows.start];
            let body_displacement = |body: usize| bodies[body].position - start[body].position;
            let ends = || row.ends.iter().flatten();
            // A new point moves with its bodies' centres of mass.
            let mean = || ends().map(|(body, _)| body_displacement(*body)).sum::<DVec3>() / ends().count() as f64;
            let displacement = previous.map_or_else(mean, |force| contact.point - force.point);
            // The normal turns with curved surfaces. Forces and arms are stored as they are where the next pass starts.
            let normal_rotation = previous.map_or(DVec3::ZERO, |force| force.normal.cross(contact.normal));
            let arm = |end: usize| {
                let (body, block) = row.ends[end]?;
                let (offset, relative) =
                    (contact.point - bodies[body].position, displacement - body_displacement(body));
                let before = previous.and_then(|force| force.arms[end]).map_or(block, |arm| arm.jacobian);
                let jacobian_change = std::array::from_fn(|k| block[k] - before[k]);
                let (offset, jacobian) = if accepted { (offset, block) } else { (offset - relative, before) };
                Some(ContactArm { body, jacobian, jacobian_change, offset, displacement: relative })
            };
            let back = if accepted { DQuat::IDENTITY } else { rotation(-normal_rotation) };
            self.active.push(ContactForce {
                source,
                point: if accepted { contact.point } else { contact.point - displacement },
                force: back * world_impulse(contact) / h,
                substep: h,
                normal: back * contact.normal,
                normal_rotation,
                arms: std::array::from_fn(arm),
            });
        }
        // A force f that is constant while its body tips about a point at the arm r accelerates it with ω² = |f| |r|/I⊥.
        for force in self.active.iter().filter(|force| matches!(force.source, ForceSource::Point(_))) {
            for arm in force.arms.iter().flatten() {
                let inertia = least_inertia_across(&bodies[arm.body].inertia_world(), arm.offset);
                let tipping = &mut self.tipping[arm.body];
                *tipping += force.force.length() * arm.offset.length() / inertia;
                self.max_tipping = self.max_tipping.max(*tipping);
            }
        }
    }

    /// Keeps the forces at the start of a substep, in case a clutch slips and it is repeated.
    pub fn begin_substep(&mut self, clutches: &Clutches) {
        if clutches.any_sticks() {
            self.at_start.clone_from(&self.active);
        }
    }

    /// Lets overloaded clutches slip at the end of a pass. Returns whether any does; the forces are then those at the substep's
    /// start and those that the clutches carried, for a repetition of the substep.
    pub fn slip_overloaded(&mut self, clutches: &mut Clutches, system: &mut System) -> bool {
        let Self { active, at_start, substep, .. } = self;
        let slips = clutches.slip_overloaded(system, |SlippedClutch { clutch, row, carried }| {
            let arm = |(body, jacobian)| ContactArm {
                body,
                jacobian,
                jacobian_change: [0.0; 6],
                offset: DVec3::ZERO,
                displacement: DVec3::ZERO,
            };
            at_start.push(ContactForce {
                source: ForceSource::Clutch(clutch),
                point: DVec3::ZERO,
                force: DVec3::X * carried,
                substep: *substep,
                normal: DVec3::ZERO,
                normal_rotation: DVec3::ZERO,
                arms: row.ends.map(|end| end.map(arm)),
            });
        });
        if slips {
            active.clone_from(at_start);
        }
        slips
    }
}

impl ContactForce {
    /// Its wrenches on its bodies in a substep of `h` seconds, N and N m about their centres of mass.
    fn wrenches(&self, h: f64) -> impl Iterator<Item = (usize, Vec6)> {
        let (force, extrapolation) = (self.acting(h), self.extrapolation(h));
        self.arms.iter().zip([1.0, -1.0, 0.0]).filter_map(move |(arm, sign)| {
            let arm = arm.as_ref()?;
            let wrench = match self.source {
                ForceSource::Rolling(_) => vec6(DVec3::ZERO, sign * force),
                ForceSource::Point(_) => {
                    vec6(sign * force, (arm.offset + extrapolation * arm.displacement).cross(sign * force))
                }
                ForceSource::Limit(_) | ForceSource::Clutch(_) => {
                    std::array::from_fn(|k| (arm.jacobian[k] + extrapolation * arm.jacobian_change[k]) * self.force.x)
                }
            };
            Some((arm.body, wrench))
        })
    }

    /// The force, turned with the normal to the middle of a substep of `h` seconds, N.
    pub fn acting(&self, h: f64) -> DVec3 {
        rotation(self.extrapolation(h) * self.normal_rotation) * self.force
    }

    /// Half a substep of `h` seconds over the substep in which its displacements were found.
    fn extrapolation(&self, h: f64) -> f64 {
        0.5 * (h / self.substep).min(MAX_EXTRAPOLATION)
    }

    /// The force in the frame (n, t, b) of a contact that continues it, turned with the normal.
    pub fn in_frame(&self, contact: &Contact) -> DVec3 {
        match self.source {
            ForceSource::Point(_) | ForceSource::Rolling(_) => {
                let (t, b) = tangents(contact.normal);
                let force = rotation(self.normal.cross(contact.normal)) * self.force;
                DVec3::new(force.dot(contact.normal), force.dot(t), force.dot(b))
            }
            ForceSource::Limit(_) | ForceSource::Clutch(_) => DVec3::new(self.force.x, 0.0, 0.0),
        }
    }
}

impl ContactArm {
    /// Largest speed of its contact point, m/s.
    pub fn speed(&self, bodies: &[RigidBody]) -> f64 {
        let body = &bodies[self.body];
        body.velocity.length() + body.angular_velocity.length() * self.offset.length()
    }
}

/// Impulse of a contact in the world, N s; in x along the row of a limit or clutch.
fn world_impulse(contact: &Contact) -> DVec3 {
    match contact.force_source() {
        ForceSource::Point(_) | ForceSource::Rolling(_) => {
            let (t, b) = tangents(contact.normal);
            contact.impulse.x * contact.normal + contact.impulse.y * t + contact.impulse.z * b
        }
        ForceSource::Limit(_) | ForceSource::Clutch(_) => contact.impulse,
    }
}

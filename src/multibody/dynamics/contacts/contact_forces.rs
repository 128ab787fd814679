//! The forces that hold what rests, from one substep to the next: where they act, and how their levers move with the bodies.

use super::contact::{Contact, Source};
use super::contact_problem::ContactProblem;
use super::jacobian_row::MAX_ROW_BODIES;
use crate::articulation::System;
use crate::dynamics::clutches::Clutches;
use crate::dynamics::joint_loads::least_inertia_across;
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{Vec6, add_scaled, angular, linear, vec6};
use soffio_math::{DQuat, DVec3, rotation, rotation_vector, tangents};

/// Points nearer than this are one, however slow their bodies, m.
pub(super) const NEAR: f64 = 1e-4;
/// Substeps whose lengths differ by less than this share are of one length.
const SAME_SPAN: f64 = 1e-9;
/// Ways found in a substep are not drawn out farther than this: what moved in a very short one may be a jump.
const MOST_STRETCH: f64 = 4.0;
/// Forces that pass each other by less than this are on one line, m: rounding.
const IN_LINE: f64 = 1e-14;
/// Largest phase ω h of a body that tips under the forces that hold it, in one substep, rad: a light body under a heavy one.
const TIP_PHASE: f64 = 1.0;
/// Room for forces of what sleeps, and of what wakes again: sixteen times as many as are solved for at once.
const MOST_KEPT: usize = 1024;

/// Force that holds a touch, from the last substep that it was needed in.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactForce {
    pub source: Source,
    /// Is it a couple, which has no lever?
    pub couple: bool,
    /// World point, m.
    pub point: DVec3,
    /// World force on the first body, N, or couple, N m; a bound's along its row in x.
    pub force: DVec3,
    /// Length of the substep that it was found in, s.
    pub span: f64,
    /// Normal where it acted so, and the rotation vector of its turn in a substep of that length, rad.
    pub normal: DVec3,
    turn: DVec3,
    /// How it acts on its bodies.
    pub ends: [Option<ContactArm>; MAX_ROW_BODIES],
}

/// One end of a held force.
#[derive(Clone, Copy, Debug)]
pub(super) struct ContactArm {
    pub body: usize,
    /// Wrench of a bound per unit force, and its change in a substep of that length.
    block: Vec6,
    block_change: Vec6,
    /// From the body's centre to the point of a contact, m, and its way in a substep of that length.
    arm: DVec3,
    pub way: DVec3,
}

/// All forces that hold what rests. Nothing here allocates after [`ContactForces::new`].
#[derive(Clone, Debug)]
pub(super) struct ContactForces {
    pub held: Vec<ContactForce>,
    /// Those that the present substep begins with, where a clutch holds that may yet give way.
    began: Vec<ContactForce>,
    /// Those before them.
    former: Vec<ContactForce>,
    /// Those among bodies that sleep.
    pub kept: Vec<ContactForce>,
    /// Length of the substep that they are laid out for, s.
    pub span: f64,
    /// Greatest ω² with which a body under the forces that hold it would tip out of its place, 1/s², and those of the bodies.
    tips: f64,
    tipping: Vec<f64>,
}

impl ContactForces {
    /// Room for those of so many touches, and for as many as are solved for at once.
    pub fn new(contacts: usize, at_once: usize, bodies: usize) -> Self {
        let room = contacts.min(MOST_KEPT);
        Self {
            held: Vec::with_capacity(room),
            began: Vec::with_capacity(room),
            former: Vec::with_capacity(at_once),
            kept: Vec::with_capacity(room),
            span: 0.0,
            tips: 0.0,
            tipping: vec![0.0; bodies],
        }
    }

    /// Forgets all of them.
    pub fn forget(&mut self) {
        self.held.clear();
        self.kept.clear();
    }

    /// Lays them out for a substep of `h` seconds.
    pub fn prepare_contact_forces(&mut self, h: f64) {
        if (h - self.span).abs() > SAME_SPAN * h {
            self.span = h;
        }
    }

    /// Forgets those found in much shorter substeps than `h` seconds: they are impulses rather than forces.
    pub fn drop_short(&mut self, h: f64) {
        self.held.retain(|held| held.span > 0.5 * h);
    }

    /// Longest substep in which no body tips far, s.
    pub fn longest_substep(&self) -> f64 {
        TIP_PHASE / self.tips.sqrt()
    }

    /// Keeps apart those among bodies that sleep, and takes up again those of bodies that have woken.
    pub fn let_sleep(&mut self, asleep: &[bool]) {
        let sleeps = |held: &ContactForce| held.ends.iter().flatten().any(|lever| asleep[lever.body]);
        let moves = |from: &mut Vec<ContactForce>, to: &mut Vec<ContactForce>, which: bool| {
            to.extend(from.iter().filter(|held| sleeps(held) == which));
            from.retain(|held| sleeps(held) != which);
        };
        moves(&mut self.held, &mut self.kept, true);
        moves(&mut self.kept, &mut self.held, false);
    }

    /// Adds the forces that hold what rests, each at where its point will be in the middle of the substep.
    pub fn apply_contact_forces(&self, external: &mut [Vec6]) {
        for (body, wrench) in self.wrenches() {
            add_scaled(&mut external[body], 1.0, &wrench);
        }
    }

    fn wrenches(&self) -> impl Iterator<Item = (usize, Vec6)> {
        self.held.iter().flat_map(|held| held.wrenches(self.span))
    }

    /// Work of those forces between two states of the bodies, J.
    pub fn work(&self, start: &[RigidBody], end: &[RigidBody]) -> f64 {
        let work = |(body, wrench): (usize, Vec6)| {
            let (from, to) = (&start[body], &end[body]);
            let turn = to.rotation * from.rotation.conjugate();
            let turn = rotation_vector(if turn.w < 0.0 { -turn } else { turn });
            linear(&wrench).dot(to.position - from.position) + angular(&wrench).dot(turn)
        };
        self.wrenches().map(work).sum()
    }

    /// Lets the two forces of each held pair act on one line: turns their bodies by what the levers, which stood still for
    /// the substep, have missed. With x̄ a body's mean place over it, r the lever that the force F on it had, and
    /// p̄ = ½ (x̄_a + r_a + x̄_b + r_b), body i lacks h (p̄ − x̄_i − r_i) × F_i; then angular momentum is kept as both turn
    /// about p̄. For motion of constant acceleration x̄ = ½ (x₀ + x₁) − h (v₁ − v₀)/12 without error. Answers the work, J.
    pub fn correct_contact_torque(
        &self,
        h: f64,
        start: &[RigidBody],
        system: &mut System,
        bodies: &mut [RigidBody],
    ) -> f64 {
        system.b.fill([0.0; 6]);
        let (mut any, mut work) = (false, 0.0);
        for held in &self.held {
            let ([Some(a), Some(b), _], Source::Pair(_), false) = (&held.ends, held.source, held.couple) else {
                continue;
            };
            let stretch = held.stretch(self.span);
            let place = |lever: &ContactArm| {
                let (from, to) = (&start[lever.body], &bodies[lever.body]);
                let mean = 0.5 * (from.position + to.position) - (to.velocity - from.velocity) * (h / 12.0);
                mean + lever.arm + stretch * lever.way
            };
            let force = held.acting(self.span);
            let apart = place(b) - place(a);
            if apart.length_squared() <= IN_LINE * IN_LINE {
                continue;
            }
            let lacks = (0.5 * h) * apart.cross(force);
            // Half the way to p̄ for either, with opposite forces: the same torque on both.
            for lever in [a, b] {
                system.push_impulse(lever.body, &vec6(DVec3::ZERO, lacks), 1.0);
                let spin = |bodies: &[RigidBody]| bodies[lever.body].angular_velocity;
                work += 0.5 * lacks.dot(spin(start) + spin(bodies));
            }
            any = true;
        }
        if any {
            system.solve_impulse();
            system.apply_velocity(bodies);
        }
        work
    }

    /// Remembers the forces, to begin the next substep or this one anew, as far as they are good enough to begin from.
    pub fn remember(
        &mut self,
        problem: &ContactProblem,
        (h, stands): (f64, bool),
        start: &[RigidBody],
        bodies: &[RigidBody],
    ) {
        self.former.clear();
        std::mem::swap(&mut self.former, &mut self.held);
        self.tips = 0.0;
        if problem.has_open_joints() {
            return;
        }
        self.tipping.fill(0.0);
        for (index, contact) in problem.contacts.iter().enumerate() {
            if contact.impulse == DVec3::ZERO || !problem.is_good(index) {
                continue;
            }
            let former =
                self.former.iter().find(|held| held.belongs_to(contact) && contact.follows == Some(held.point));
            let row = &problem.rows[contact.first];
            let gone = |body: usize| bodies[body].position - start[body].position;
            let ends = || row.ends.iter().flatten();
            // A new point goes with its bodies' centres.
            let mean = || ends().map(|(body, _)| gone(*body)).sum::<DVec3>() / ends().count() as f64;
            let along = former.map_or_else(mean, |held| contact.point - held.point);
            // The normal turns as surfaces curve: forces and levers are kept as they are at the start of what comes.
            let turn = former.map_or(DVec3::ZERO, |held| held.normal.cross(contact.normal));
            let lever = |end: usize| {
                let (body, block) = row.ends[end]?;
                let (arm, way) = (contact.point - bodies[body].position, along - gone(body));
                let before = former.and_then(|held| held.ends[end]).map_or(block, |lever| lever.block);
                let block_change = std::array::from_fn(|k| block[k] - before[k]);
                let (arm, block) = if stands { (arm, block) } else { (arm - way, before) };
                Some(ContactArm { body, block, block_change, arm, way })
            };
            let back = if stands { DQuat::IDENTITY } else { rotation(-turn) };
            self.held.push(ContactForce {
                source: contact.source,
                couple: contact.twist.is_some(),
                point: if stands { contact.point } else { contact.point - along },
                force: back * world(contact) / h,
                span: h,
                normal: back * contact.normal,
                turn,
                ends: std::array::from_fn(lever),
            });
        }
        // A force f that stands still while its body tips about a point at the arm r drives it on with ω² = |f| |r|/I⊥.
        for held in self.held.iter().filter(|held| matches!(held.source, Source::Pair(_)) && !held.couple) {
            for lever in held.ends.iter().flatten() {
                let inertia = least_inertia_across(&bodies[lever.body].inertia_world(), lever.arm);
                let tipping = &mut self.tipping[lever.body];
                *tipping += held.force.length() * lever.arm.length() / inertia;
                self.tips = self.tips.max(*tipping);
            }
        }
    }

    /// Keeps the forces that the substep begins with, for the case that it is gone through again.
    pub fn begin_substep(&mut self, clutches: &Clutches) {
        if clutches.any_holds() {
            self.began.clone_from(&self.held);
        }
    }

    /// Lets slip what carries too much at the end of a pass. Did anything? Then the substep is to be gone through
    /// again, and begins as it did, with what the clutch carried.
    pub fn slip_overloaded(&mut self, clutches: &mut Clutches, bounds: usize, system: &mut System) -> bool {
        let Self { held, began, span, .. } = self;
        let slips = clutches.slip_overloaded(system, |index, row, load| {
            let still =
                |(body, block)| ContactArm { body, block, block_change: [0.0; 6], arm: DVec3::ZERO, way: DVec3::ZERO };
            began.push(ContactForce {
                source: Source::Bound(bounds + index),
                couple: false,
                point: DVec3::ZERO,
                force: DVec3::X * load,
                span: *span,
                normal: DVec3::ZERO,
                turn: DVec3::ZERO,
                ends: row.ends.map(|end| end.map(still)),
            });
        });
        if slips {
            held.clone_from(began);
        }
        slips
    }
}

impl ContactForce {
    /// Can a touch be what it has held?
    pub fn belongs_to(&self, contact: &Contact) -> bool {
        self.source == contact.source && self.couple == contact.twist.is_some()
    }

    /// The bodies it acts on and its wrenches there in a substep of `h` seconds, N and N m about their centres.
    fn wrenches(&self, h: f64) -> impl Iterator<Item = (usize, Vec6)> {
        let (force, stretch) = (self.acting(h), self.stretch(h));
        self.ends.iter().zip([1.0, -1.0, 0.0]).filter_map(move |(lever, sign)| {
            let lever = lever.as_ref()?;
            let wrench = match self.source {
                Source::Pair(_) if self.couple => vec6(DVec3::ZERO, sign * force),
                Source::Pair(_) => vec6(sign * force, (lever.arm + stretch * lever.way).cross(sign * force)),
                Source::Bound(_) => {
                    std::array::from_fn(|k| (lever.block[k] + stretch * lever.block_change[k]) * self.force.x)
                }
            };
            Some((lever.body, wrench))
        })
    }

    /// Its force as the normal will stand in the middle of a substep of `h` seconds, N.
    pub fn acting(&self, h: f64) -> DVec3 {
        rotation(self.stretch(h) * self.turn) * self.force
    }

    /// Half a substep of `h` seconds, in spans of the one in which its ways were found.
    fn stretch(&self, h: f64) -> f64 {
        0.5 * (h / self.span).min(MOST_STRETCH)
    }
}

impl ContactArm {
    /// How fast its point can move, m/s.
    pub fn speed(&self, bodies: &[RigidBody]) -> f64 {
        let body = &bodies[self.body];
        body.velocity.length() + body.angular_velocity.length() * self.arm.length()
    }
}

/// A touch's impulse or couple in the world; a bound's along its row in x.
fn world(contact: &Contact) -> DVec3 {
    match contact.source {
        Source::Pair(_) => {
            let (t, b) = tangents(contact.normal);
            contact.impulse.x * contact.normal + contact.impulse.y * t + contact.impulse.z * b
        }
        Source::Bound(_) => contact.impulse,
    }
}

/// A held force in a touch's own frame (n, t, b), turned with the normal.
pub(super) fn in_frame(contact: &Contact, held: &ContactForce) -> DVec3 {
    match contact.source {
        Source::Pair(_) => {
            let (t, b) = tangents(contact.normal);
            let force = rotation(held.normal.cross(contact.normal)) * held.force;
            DVec3::new(force.dot(contact.normal), force.dot(t), force.dot(b))
        }
        Source::Bound(_) => DVec3::new(held.force.x, 0.0, 0.0),
    }
}

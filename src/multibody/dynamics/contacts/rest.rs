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

use super::problem::{Problem, Source, Touch};
use super::twist::twist_rows;
use super::{Contacts, Held, Lever, RELEASE_GAP, point_rows};
use crate::articulation::System;
use crate::collision::TOUCH;
use crate::dynamics::loads::least_inertia_across;
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{Vec6, add_scaled, angular, linear, vec6};
use soffio_math::{DQuat, DVec3, rotation, rotation_vector, tangents};

/// Passes over one substep at most, but for one more where a rest proves false.
const PASSES: usize = 3;
/// Displacement within a substep that another pass is worth, m.
const MISSED: f64 = 1e-6;
/// What rests may close a gap that is wider than the touching layer, within one substep.
const LAYER: f64 = TOUCH;
/// What rests slides no farther than this in one substep, m.
const SLIDE: f64 = 2e-3;
/// Largest phase ω h of a body that tips under the forces that hold it, in one substep, rad: a light body under a heavy one.
const TIP_PHASE: f64 = 1.0;
/// What sinks deeper than this in a substep asks for a shorter one, m: as teeth do that go round an edge.
const FINE: f64 = 1e-6;
/// What rests does not sink deeper than this in one substep, m.
const SUNK: f64 = 2e-5;
/// Points nearer than this are one, however slow their bodies, m.
const NEAR: f64 = 1e-4;
/// Substeps whose lengths differ by less than this share are of one length.
const SAME_SPAN: f64 = 1e-9;
/// Ways found in a substep are not drawn out farther than this: what moved in a very short one may be a jump.
const MOST_STRETCH: f64 = 4.0;
/// Forces that pass each other by less than this are on one line, m: rounding.
const IN_LINE: f64 = 1e-14;
/// No approach is as fast as this, m/s.
const FREE: f64 = 1e9;
/// Time in which what rests rises to the middle of the touching layer, s: at micrometres a second, and its work is
/// known.
const RISE: f64 = 0.02;
/// Farthest that sunken bodies are moved out in one substep, m.
const MOST_PUSH: f64 = 1e-3;

/// What is to be done about a pass over a substep.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::dynamics) enum Verdict {
    /// Nothing: it stands. Were bodies moved out of each other?
    Stands { moved: bool },
    /// Integrate it again, under better forces.
    Again,
    /// Integrate a shorter one: surfaces curve too much for the forces to stand still.
    Shorter,
    /// Integrate it anew: a clutch gives way.
    Slips,
}

impl Contacts {
    /// Notes what clutches carry by the last solve, of forces.
    pub(in crate::dynamics) fn weigh(&mut self, system: &System) {
        self.clutches.weigh(system);
    }

    /// Does anything rest, or has a force to be taken back?
    pub(in crate::dynamics) fn anything_rests(&self) -> bool {
        let rests = self.at_rest.len() + self.bounds_at_rest > self.asleep_at_rest;
        rests || !self.held.is_empty() || self.clutches.slipping().next().is_some()
    }

    /// Longest substep in which what rests passes no feature of what it slides on, s.
    pub(in crate::dynamics) fn longest_substep(&self) -> f64 {
        if self.at_rest.iter().all(|&pair| self.sleeps(pair)) {
            return f64::INFINITY;
        }
        (SLIDE / self.slip).min(TIP_PHASE / self.tips.sqrt())
    }

    /// Lays the forces that hold what rests out for a substep of `h` seconds. While joints are open there are none: the
    /// stabiliser would answer each with its opposite, and both would grow. Impulses at the substep's end do instead.
    pub(in crate::dynamics) fn lay_out(&mut self, h: f64, system: &System) {
        if self.anything_rests() && system.open_rows(self.gathering_time).next().is_some() {
            self.held.clear();
        }
        if (h - self.span).abs() > SAME_SPAN * h {
            self.span = h;
        }
    }

    /// Adds the forces that hold what rests, each at where its point will be in the middle of the substep.
    pub(in crate::dynamics) fn press(&self, external: &mut [Vec6]) {
        for (body, wrench) in self.wrenches() {
            add_scaled(&mut external[body], 1.0, &wrench);
        }
    }

    fn wrenches(&self) -> impl Iterator<Item = (usize, Vec6)> {
        self.held.iter().flat_map(|held| held.wrenches(self.span))
    }

    /// Work of those forces between two states of the bodies, J.
    fn pressed(&self, start: &[RigidBody], end: &[RigidBody]) -> f64 {
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
    fn straighten(&mut self, h: f64, start: &[RigidBody], system: &mut System, bodies: &mut [RigidBody]) -> f64 {
        system.b.fill([0.0; 6]);
        let (mut any, mut work) = (false, 0.0);
        for held in &self.held {
            let ([Some(a), Some(b), _], Source::Pair(_), false) = (&held.ends, held.source, held.couple) else {
                continue;
            };
            let stretch = held.stretch(self.span);
            let place = |lever: &Lever| {
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

    /// At the end of a pass over a substep of `h` seconds under [`Contacts::press`]: finds the forces that would have held.
    /// Where the substep stands, velocities and places are put right, the joints' velocities too. The joints must be factored at
    /// the bodies' present state, or as near to it as a substep ends, and the clutches weighed.
    pub(in crate::dynamics) fn settle(
        &mut self,
        (h, pass, shortens): (f64, usize, bool),
        start: &[RigidBody],
        system: &mut System,
        bodies: &mut [RigidBody],
    ) -> Verdict {
        if !self.anything_rests() {
            return if self.give_way(system) { Verdict::Slips } else { Verdict::Stands { moved: false } };
        }
        let straightened = self.straighten(h, start, system, bodies);
        let lost = self.gather(h, system, bodies);
        self.problem.assemble(system, bodies);
        self.problem.begin();
        let settled = self.problem.among_clutches(Problem::solve_anew);
        let missed = lost || 0.5 * h * self.problem.largest_change() > MISSED;
        let last = pass >= PASSES || !missed || self.problem.has_open_joints();
        if last && shortens && settled && self.sinks(FINE) {
            return Verdict::Shorter;
        }
        let stands = pass > PASSES || (last && !self.releases_sunken());
        if stands {
            self.slip = self.problem.largest_slip();
            self.recent_work = self.pressed(start, bodies) + straightened + self.problem.work();
            self.problem.apply_closing(system, bodies);
            self.clutches.weigh_more(h, system);
            if self.give_way(system) {
                return Verdict::Slips;
            }
        }
        self.hold((h, settled, stands), start, bodies);
        if !stands {
            return Verdict::Again;
        }
        let moved = self.problem.touches.iter().any(|touch| touch.gap < -LAYER);
        if moved {
            self.problem.push_out(-LAYER, MOST_PUSH, system, bodies);
        }
        Verdict::Stands { moved }
    }

    /// Has anything that rests sunk in by more than this within the substep?
    fn sinks(&self, most: f64) -> bool {
        self.problem.touches.iter().any(|touch| match touch.source {
            Source::Pair(pair) => touch.gap < self.depth[pair] - most,
            Source::Bound(_) => false,
        })
    }

    /// What was taken to rest and has sunk in within this substep met where nobody looked: it is apart, so that its
    /// hit is found. Answers whether there was such a pair.
    fn releases_sunken(&mut self) -> bool {
        let mut any = false;
        for index in 0..self.problem.touches.len() {
            let touch = &mut self.problem.touches[index];
            let Source::Pair(pair) = touch.source else { continue };
            // Once a step: a pair hit in this one has been looked at.
            if touch.gap < self.depth[pair] - SUNK && self.last_hit[pair] < self.clock {
                touch.impulse = DVec3::ZERO;
                any = true;
                self.set_resting(pair, false);
            }
        }
        any
    }

    /// Takes out what approach hits have left to what rests, without bounce and without memory. The joints must be
    /// factored at the bodies' present state.
    pub(super) fn steady(&mut self, h: f64, system: &mut System, bodies: &mut [RigidBody]) {
        self.gather(h, system, bodies);
        for touch in &mut self.problem.touches {
            (touch.before, touch.impulse, touch.begin) = (DVec3::ZERO, DVec3::ZERO, DVec3::ZERO);
        }
        self.problem.assemble(system, bodies);
        self.problem.among_clutches(Problem::solve);
        self.slip = self.problem.largest_slip();
        self.work += self.problem.work();
        self.problem.apply(system, bodies);
    }

    /// Collects all touches of what rests into the problem, each with the impulse that held it; releases what has
    /// opened. Answers whether a force that has acted belongs to no touch any more.
    fn gather(&mut self, h: f64, system: &System, bodies: &[RigidBody]) -> bool {
        self.problem.clear();
        let mut at_rest = 0;
        while at_rest < self.at_rest.len() {
            let pair = self.at_rest[at_rest];
            if self.sleeps(pair) {
                at_rest += 1;
                continue;
            }
            let manifold = self.manifold(pair, bodies);
            let nearest = manifold.points().iter().fold(f64::INFINITY, |least, p| least.min(p.gap));
            if nearest > RELEASE_GAP {
                self.set_resting(pair, false);
                continue;
            }
            at_rest += 1;
            for at in manifold.points() {
                self.push_point(pair, at.point, manifold.normal, at.gap, bodies);
            }
        }
        for bound in 0..self.limits.count() {
            if self.limits.resting(bound) && !self.limits.sleeps(bound) {
                if self.limits.gap(bound, bodies) > RELEASE_GAP {
                    self.set_bound_resting(bound, false);
                } else {
                    self.push_bound(bound, bodies);
                }
            }
        }
        for index in 0..self.problem.touches.len() {
            if let Source::Pair(pair) = self.problem.touches[index].source
                && !self.pairs[pair].resistance.is_none()
            {
                let bodies = self.bodies_of(pair);
                self.problem.push_twist(index, bodies, self.pairs[pair].resistance);
            }
        }
        self.push_clutches(h, system);
        for touch in self.problem.touches.iter_mut().filter(|touch| touch.pushes()) {
            // Gently to the middle of the layer; a wider gap may close within the substep.
            let sunk = (0.5 * LAYER - touch.gap).clamp(-0.5 * LAYER, LAYER);
            touch.least = sunk / RISE - (touch.gap - LAYER).max(0.0) / h;
        }
        self.warm_start(h, system, bodies)
    }

    /// Gives each held force to the nearest touch of its pair. Where that is farther than a point can go, the force is
    /// taken back where it acted, and the rounds only begin from it; the answer is whether there are such.
    fn warm_start(&mut self, h: f64, system: &System, bodies: &[RigidBody]) -> bool {
        let mut lost = false;
        let present = self.problem.touches.len();
        for index in 0..self.held.len() {
            let held = self.held[index];
            let near = NEAR + 2.0 * h * held.ends.iter().flatten().map(|lever| lever.speed(bodies)).sum::<f64>();
            let mut best = (None, f64::INFINITY);
            for touch in &mut self.problem.touches[..present] {
                let far = touch.point.distance(held.point);
                if held.belongs_to(touch) && far <= best.1 {
                    best = (Some(touch), far);
                }
            }
            let follows = best.1 <= near;
            if let Some(touch) = best.0 {
                let impulse = h * in_frame(touch, &held);
                touch.begin += impulse;
                if follows {
                    touch.before += impulse;
                    touch.follows = Some(held.point);
                }
            }
            if !follows {
                lost = true;
                self.take_back(&held, h, system, bodies);
            }
        }
        for touch in &mut self.problem.touches {
            touch.impulse = touch.before;
        }
        lost
    }

    /// Adds a touch that may approach at any speed, so that the rounds take its impulse away.
    fn take_back(&mut self, held: &Held, h: f64, system: &System, bodies: &[RigidBody]) {
        let size = held.force.length();
        let row = match held.source {
            Source::Pair(pair) if held.couple => twist_rows(held.acting(self.span) / size, self.bodies_of(pair))[0],
            Source::Pair(pair) => {
                point_rows(held.point, held.acting(self.span) / size, self.bodies_of(pair), bodies)[0]
            }
            Source::Bound(bound) => match bound.checked_sub(self.limits.count()) {
                Some(clutch) => self.clutches.row(clutch, held.force.x.signum(), system),
                None => self.limits.row(bound, bodies).1,
            },
        };
        let mut touch = Touch::new(held.source, held.point, DVec3::ZERO, f64::INFINITY, 0.0);
        touch.before.x = h * size;
        touch.least = -FREE;
        self.problem.push(touch, &[row]);
    }

    /// Remembers the forces, to begin the next substep or this one anew; those of rounds that did not settle are no
    /// place to begin from.
    fn hold(&mut self, (h, settled, stands): (f64, bool, bool), start: &[RigidBody], bodies: &[RigidBody]) {
        self.former.clear();
        std::mem::swap(&mut self.former, &mut self.held);
        if stands {
            for at in 0..self.at_rest.len() {
                let pair = self.at_rest[at];
                if !self.sleeps(pair) {
                    self.depth[pair] = 0.0;
                }
            }
            for touch in &self.problem.touches {
                if let Source::Pair(pair) = touch.source {
                    self.depth[pair] = self.depth[pair].min(touch.gap);
                }
            }
        }
        self.tips = 0.0;
        if !settled || self.problem.has_open_joints() {
            return;
        }
        self.tipping.fill(0.0);
        for touch in &self.problem.touches {
            if touch.impulse == DVec3::ZERO {
                continue;
            }
            let former = self.former.iter().find(|held| held.belongs_to(touch) && touch.follows == Some(held.point));
            let row = &self.problem.rows[touch.first];
            let gone = |body: usize| bodies[body].position - start[body].position;
            let ends = || row.ends.iter().flatten();
            // A new point goes with its bodies' centres.
            let mean = || ends().map(|(body, _)| gone(*body)).sum::<DVec3>() / ends().count() as f64;
            let along = former.map_or_else(mean, |held| touch.point - held.point);
            // The normal turns as surfaces curve: forces and levers are kept as they are at the start of what comes.
            let turn = former.map_or(DVec3::ZERO, |held| held.normal.cross(touch.normal));
            let lever = |end: usize| {
                let (body, block) = row.ends[end]?;
                let (arm, way) = (touch.point - bodies[body].position, along - gone(body));
                let before = former.and_then(|held| held.ends[end]).map_or(block, |lever| lever.block);
                let block_change = std::array::from_fn(|k| block[k] - before[k]);
                let (arm, block) = if stands { (arm, block) } else { (arm - way, before) };
                Some(Lever { body, block, block_change, arm, way })
            };
            let back = if stands { DQuat::IDENTITY } else { rotation(-turn) };
            self.held.push(Held {
                source: touch.source,
                couple: touch.twist.is_some(),
                point: if stands { touch.point } else { touch.point - along },
                force: back * world(touch) / h,
                span: h,
                normal: back * touch.normal,
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
}

impl Held {
    /// Can a touch be what it has held?
    fn belongs_to(&self, touch: &Touch) -> bool {
        self.source == touch.source && self.couple == touch.twist.is_some()
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
    fn acting(&self, h: f64) -> DVec3 {
        rotation(self.stretch(h) * self.turn) * self.force
    }

    /// Half a substep of `h` seconds, in spans of the one in which its ways were found.
    fn stretch(&self, h: f64) -> f64 {
        0.5 * (h / self.span).min(MOST_STRETCH)
    }
}

impl Lever {
    /// How fast its point can move, m/s.
    fn speed(&self, bodies: &[RigidBody]) -> f64 {
        let body = &bodies[self.body];
        body.velocity.length() + body.angular_velocity.length() * self.arm.length()
    }
}

/// A touch's impulse or couple in the world; a bound's along its row in x.
fn world(touch: &Touch) -> DVec3 {
    match touch.source {
        Source::Pair(_) => {
            let (t, b) = tangents(touch.normal);
            touch.impulse.x * touch.normal + touch.impulse.y * t + touch.impulse.z * b
        }
        Source::Bound(_) => touch.impulse,
    }
}

/// A held force in a touch's own frame (n, t, b), turned with the normal.
fn in_frame(touch: &Touch, held: &Held) -> DVec3 {
    match touch.source {
        Source::Pair(_) => {
            let (t, b) = tangents(touch.normal);
            let force = rotation(held.normal.cross(touch.normal)) * held.force;
            DVec3::new(force.dot(touch.normal), force.dot(t), force.dot(b))
        }
        Source::Bound(_) => DVec3::new(held.force.x, 0.0, 0.0),
    }
}

//! What bodies that were moved by place alone meet: moved out by depth, thrown back by impulse (method 3.5, 2.3).
//!
//! **Place.** Pair by pair, the deepest point first, the bodies are moved apart along the normal until they just touch.
//! By the source's rule it is the body itself that moves (two free ones by their masses) and the joints are adjusted
//! again; with the tree's solve the whole figure gives way, by the row J of the contact and the joints' factor H,
//!
//! ```text
//! δ = H⁻¹ Jᵀ d/(J H⁻¹ Jᵀ)        d the depth
//! ```
//!
//! Limits are rows of the same kind.
//!
//! **Speed.** The velocity that the step's way stands for is taken before anything is moved out, so that being moved out
//! throws nothing. Each point that met and approaches then gets the impulse of `dynamics::impulse` (Coulomb's cone,
//! Stronge's restitution), with the effective mass of the joints as they stand at the step's end.
//!
//! What rests is answered by the laws of `sphere.rs` where its surfaces resist turning, or it is a ball and the method the
//! source's.
//!
//! What met in the step before, there or on the same side of the same two bodies, and comes no faster than gravity brings
//! it within a step or two is at rest: it does not bounce and tells nothing. A ball in a hollow lies on one slope after
//! the other.

use super::compulsive::Compulsive;
use super::sphere::{Moves, Patch, Push, resist};
use crate::articulation::System;
use crate::dynamics::impulse::impulse;
use crate::dynamics::{Contacts, Dynamics, Impact, ImpactKind, MAX_ROW_BODIES, SweptContact, rolling_rows};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{Vec6, add_scaled, angular, dot, linear, vec6};
use soffio_math::{DMat3, DVec3, tangents};

/// Points that are looked at in one step at most.
const MOST_MET: usize = 256;
/// Slower approaches do not bounce, m/s or rad/s; what gravity gives within [`REST_STEPS`] steps is added.
const REST_SPEED: f64 = 4e-3;
const REST_STEPS: f64 = 2.0;
/// Cosine between the normals of two touches on the same side.
const SAME_SIDE: f64 = 0.9;
/// Answers smaller than this are none: joints hold the point, 1/kg.
const LOCKED: f64 = 1e-9;
/// Depths that are left as they are, m or rad.
const LEVEL: f64 = 1e-9;

/// How a point answers.
struct Law {
    restitution: f64,
    /// Does it lie rather than hit?
    rests: bool,
    /// Do balls slide by the source's slip ratio?
    by_ratio: bool,
    /// Length of the step, s.
    dt: f64,
}

impl Law {
    /// Do the laws of `sphere.rs` answer what met?
    fn resists(&self, met: &SweptContact) -> bool {
        self.rests && (!met.resistance.is_none() || (self.by_ratio && rolling_ball(met).is_some()))
    }
}

/// What touches in a procedural step.
#[derive(Clone, Debug)]
pub(super) struct Touches {
    /// At the end of the joints' adjustment, and those of a later look.
    met: Vec<SweptContact>,
    again: Vec<SweptContact>,
    /// What met in the step before.
    last: Vec<SweptContact>,
    /// Answers to the three rows of a point, and to those of its couple.
    columns: [Vec<Vec6>; 3],
    turns: [Vec<Vec6>; 3],
}

impl Touches {
    pub fn new(dynamics: &Dynamics) -> Self {
        let sources = dynamics.contacts().source_count();
        let room = if sources == 0 { 0 } else { MOST_MET };
        let bodies = if sources == 0 { 0 } else { dynamics.bodies.len() };
        Self {
            met: Vec::with_capacity(room),
            again: Vec::with_capacity(room),
            last: Vec::with_capacity(room),
            columns: std::array::from_fn(|_| vec![[0.0; 6]; bodies]),
            turns: std::array::from_fn(|_| vec![[0.0; 6]; bodies]),
        }
    }

    /// Is there anything that could touch?
    pub fn is_empty(&self) -> bool {
        self.met.capacity() == 0
    }

    /// Has this touched in the step before?
    fn lies(&self, met: &SweptContact) -> bool {
        let same_side = |last: &SweptContact| {
            met.colliders.is_some() && last.bodies == met.bodies && last.normal.dot(met.normal) > SAME_SIDE
        };
        self.last.iter().any(|last| last.source == met.source || same_side(last))
    }

    /// Looks what met on the way between two states; true where something has to be moved out.
    pub fn look(&mut self, contacts: &mut Contacts, before: &[RigidBody], after: &[RigidBody], first: bool) -> bool {
        let met = if first { &mut self.met } else { &mut self.again };
        contacts.find_swept_contacts(before, after, met);
        let order = |a: &SweptContact, b: &SweptContact| {
            a.s.total_cmp(&b.s).then(a.source.cmp(&b.source)).then(b.depth.total_cmp(&a.depth))
        };
        met.sort_unstable_by(order);
        met.iter().any(|met| met.depth > LEVEL)
    }

    /// Moves what met out through the joints, which hold to first order.
    pub fn move_out(&mut self, system: &mut System, bodies: &mut [RigidBody], first: bool) {
        system.evaluate(bodies);
        system.factor();
        let met = if first { &self.met } else { &self.again };
        let sum = &mut self.columns[2];
        sum.fill([0.0; 6]);
        for met in met {
            // What was moved for the others has moved this one too.
            let depth = met.depth - along(&met.ends, sum);
            let answer = if depth > LEVEL && met.depth > LEVEL { answer(system, &met.ends) } else { 0.0 };
            if answer > LOCKED {
                for (sum, a) in sum.iter_mut().zip(&system.a) {
                    add_scaled(sum, depth / answer, a);
                }
            }
        }
        for (body, delta) in bodies.iter_mut().zip(&self.columns[2]) {
            body.displace(linear(delta), angular(delta));
        }
    }

    /// Moves what met out by itself, the source's way, as far as it has not been moved out of the others already: a ball in a
    /// hollow of four slopes would leap.
    pub fn back_up(
        &mut self,
        mover: &mut Compulsive,
        system: &System,
        contacts: &Contacts,
        bodies: &mut [RigidBody],
        first: bool,
    ) {
        let met = if first { &self.met } else { &self.again };
        let starts = &mut self.columns[2];
        starts.iter_mut().zip(bodies.iter()).for_each(|(start, body)| *start = vec6(body.position, DVec3::ZERO));
        let mut done = None;
        for met in met.iter().filter(|met| met.depth > LEVEL) {
            let way =
                |(body, block): &(usize, Vec6)| linear(block).dot(bodies[*body].position - linear(&starts[*body]));
            let depth = met.depth - met.ends.iter().flatten().map(way).sum::<f64>();
            // The deepest point of a pair stands for it.
            if done != Some(met.source) && depth > LEVEL {
                mover.back_up(&SweptContact { depth, ..*met }, system, contacts, bodies);
            }
            done = Some(met.source);
        }
    }

    /// Throws back what met and approaches, and tells it. Answers whether friction has moved bodies by place, so that joints
    /// are to be closed again.
    pub fn bounce(
        &mut self,
        system: &mut System,
        bodies: &mut [RigidBody],
        before: &[RigidBody],
        ((dt, gravity), by_ratio): ((f64, f64), bool),
        impacts: &mut Vec<Impact>,
    ) -> bool {
        let mut shifted = false;
        system.evaluate(bodies);
        system.factor();
        let slow = REST_SPEED + REST_STEPS * gravity * dt;
        let already = impacts.len();
        for index in 0..self.met.len() {
            let mut met = self.met[index];
            met.point = on_the_ball(&met, bodies).unwrap_or(met.point);
            let lies = self.lies(&met);
            // A limit has ended the way already: how fast it was reached says the state before.
            let stops = met.colliders.is_none() && !lies;
            let speed = (-met.rate(bodies)).max(if stops { -met.rate(before) } else { 0.0 });
            let rests = speed < REST_SPEED || (lies && speed < slow);
            if speed > 0.0 {
                let restitution = if rests { 0.0 } else { met.restitution };
                let law = Law { restitution, rests, by_ratio, dt };
                let (push, mass) = self.push(system, &met, &law, speed, bodies);
                shifted |= law.resists(&met);
                let told = impacts[already..]
                    .iter_mut()
                    .find(|told| told.colliders == met.colliders && told.bodies == met.bodies);
                match told {
                    Some(told) => told.impulse += push,
                    None if lies && rests => {}
                    None => impacts.push(Impact {
                        time: met.s * dt,
                        kind: match (rests, met.colliders) {
                            (true, _) => ImpactKind::RestingContact,
                            (false, Some(_)) => ImpactKind::Impact,
                            (false, None) => ImpactKind::Stop,
                        },
                        bodies: met.bodies,
                        colliders: met.colliders,
                        point: met.point,
                        normal: met.normal,
                        impulse: push,
                        speed,
                        mass,
                    }),
                }
            }
        }
        std::mem::swap(&mut self.met, &mut self.last);
        shifted
    }

    /// The impulse of one point or bound, given to the bodies; its size (N s) and the effective mass (kg).
    fn push(
        &mut self,
        system: &mut System,
        met: &SweptContact,
        law: &Law,
        speed: f64,
        bodies: &mut [RigidBody],
    ) -> (f64, f64) {
        if met.colliders.is_none() {
            let answer = answer(system, &met.ends);
            if answer <= LOCKED {
                return (0.0, 0.0);
            }
            let push = ((law.restitution * speed - met.rate(bodies)) / answer).max(0.0);
            system.a.iter_mut().flatten().for_each(|a| *a *= push);
            system.apply_velocity(bodies);
            return ((1.0 + law.restitution) * speed / answer, 1.0 / answer);
        }
        let (t, b) = tangents(met.normal);
        let rows = [t, b, met.normal].map(|axis| point_row(met, axis, bodies));
        let mut k = DMat3::ZERO;
        for (index, row) in rows.iter().enumerate() {
            answer(system, row);
            *k.col_mut(index) = DVec3::from_array(rows.map(|row| along(&row, &system.a)));
            self.columns[index].copy_from_slice(&system.a);
        }
        if k.z_axis.z <= LOCKED {
            return (0.0, 0.0);
        }
        let velocity = DVec3::from_array(rows.map(|row| SweptContact { ends: row, ..*met }.rate(bodies)));
        let p = impulse(&k, velocity, met.friction, law.restitution);
        if !law.resists(met) {
            add(bodies, &self.columns, p);
            return (p.length(), 1.0 / k.z_axis.z);
        }
        let by_ratio = law.by_ratio && rolling_ball(met).is_some();
        let Push { force, couple } = self.resist(system, met, (k, velocity, p), by_ratio, bodies);
        add(bodies, &self.columns, force);
        add(bodies, &self.turns, couple);
        // The way of a step goes with the velocity at its end, as under all other forces: what lies still stays.
        for (columns, p) in [(&self.columns, force.with_z(0.0)), (&self.turns, couple)] {
            for (index, body) in bodies.iter_mut().enumerate() {
                let (way, turn) = sum(columns, p, index);
                body.displace(law.dt * way, law.dt * turn);
            }
        }
        (force.length(), 1.0 / k.z_axis.z)
    }
}

impl Touches {
    /// Force and couple of a resting point, of which Coulomb's answer is known.
    fn resist(
        &mut self,
        system: &mut System,
        met: &SweptContact,
        (point, slip, p): (DMat3, DVec3, DVec3),
        by_ratio: bool,
        bodies: &[RigidBody],
    ) -> Push {
        let [n, t, b] = rolling_rows(met);
        let rows = [t, b, n];
        let (mut mixed, mut turn, mut center) = (DMat3::ZERO, DMat3::ZERO, DMat3::ZERO);
        let axes = {
            let (t, b) = tangents(met.normal);
            [t, b, met.normal]
        };
        let points = axes.map(|axis| point_row(met, axis, bodies));
        // The ball's centre over the surface under it: the contact point's velocity but for the ball's own turn.
        let ball = rolling_ball(met);
        let middles = axes.map(|axis| {
            let mut row = point_row(met, axis, bodies);
            let own = row.iter_mut().flatten().filter(|(body, _)| Some(*body) == ball);
            own.for_each(|(_, block)| *block = vec6(linear(block), DVec3::ZERO));
            row
        });
        for (index, row) in rows.iter().enumerate() {
            answer(system, row);
            *mixed.col_mut(index) = DVec3::from_array(points.map(|row| along(&row, &system.a)));
            *turn.col_mut(index) = DVec3::from_array(rows.map(|row| along(&row, &system.a)));
            self.turns[index].copy_from_slice(&system.a);
            *center.col_mut(index) = DVec3::from_array(middles.map(|row| along(&row, &self.columns[index])));
        }
        let rate = |row| SweptContact { ends: row, ..*met }.rate(bodies);
        let moves =
            Moves { slip, center: DVec3::from_array(middles.map(rate)), turn: DVec3::from_array(rows.map(rate)) };
        resist(met, &Patch { point, mixed, turn, center }, moves, p, by_ratio)
    }
}

/// The body that is a ball on something that is none.
fn rolling_ball(met: &SweptContact) -> Option<usize> {
    match met.balls {
        [Some(_), None] => met.bodies[0],
        [None, Some(_)] => met.bodies[1],
        _ => None,
    }
}

/// Where a ball touches now that it has been moved out.
fn on_the_ball(met: &SweptContact, bodies: &[RigidBody]) -> Option<DVec3> {
    let place = |side: usize| {
        let ((center, radius), body) = (met.balls[side]?, met.bodies[side]?);
        let inward = if side == 0 { -radius } else { radius };
        Some(bodies[body].pose().point(center) + inward * met.normal)
    };
    place(0).or_else(|| place(1))
}

/// Gives the bodies impulses (t, b, n) along columns of answers.
fn add(bodies: &mut [RigidBody], columns: &[Vec<Vec6>; 3], p: DVec3) {
    for (index, body) in bodies.iter_mut().enumerate() {
        let [t, b, n] = columns.each_ref().map(|column| &column[index]);
        for (push, column) in p.to_array().into_iter().zip([t, b, n]) {
            body.velocity += push * linear(column);
            body.angular_velocity += push * angular(column);
        }
    }
}

/// What impulses (t, b, n) along columns of answers change of a body's velocities.
fn sum(columns: &[Vec<Vec6>; 3], p: DVec3, index: usize) -> (DVec3, DVec3) {
    let [t, b, n] = columns.each_ref().map(|column| &column[index]);
    let of = |part: fn(&Vec6) -> DVec3| p.x * part(t) + p.y * part(b) + p.z * part(n);
    (of(linear), of(angular))
}

/// Solves for what the figure answers to a unit impulse along a row; how far that goes along the row itself.
fn answer(system: &mut System, ends: &[Option<(usize, Vec6)>; MAX_ROW_BODIES]) -> f64 {
    system.b.fill([0.0; 6]);
    for (body, block) in ends.iter().flatten() {
        system.push_impulse(*body, block, 1.0);
    }
    system.solve_impulse();
    along(ends, &system.a)
}

/// A row times the bodies' coordinates.
fn along(ends: &[Option<(usize, Vec6)>; MAX_ROW_BODIES], a: &[Vec6]) -> f64 {
    ends.iter().flatten().map(|(body, block)| dot(block, &a[*body])).sum()
}

/// The row of a point along an axis.
fn point_row(met: &SweptContact, axis: DVec3, bodies: &[RigidBody]) -> [Option<(usize, Vec6)>; MAX_ROW_BODIES] {
    let end = |body: Option<usize>, sign: f64| {
        let along = sign * axis;
        body.map(|i| (i, vec6(along, (met.point - bodies[i].position).cross(along))))
    };
    [end(met.bodies[0], 1.0), end(met.bodies[1], -1.0), None]
}

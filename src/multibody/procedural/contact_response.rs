//! Contact response of position-based motion: separation by position projection, then impulses (method 3.5, 2.3).
//!
//! **Position.** Pair by pair, the deepest point first, bodies are moved apart along the normal until they just
//! touch. Relaxation moves the bodies themselves (two free ones by their masses) and closes the joints again.
//! TreeSolve moves the whole mechanism, by the row J of the contact and the joints' factor H,
//!
//! ```text
//! δ = H⁻¹ Jᵀ d/(J H⁻¹ Jᵀ)        d the depth
//! ```
//!
//! Violated limits are rows of the same kind.
//!
//! **Velocity.** Velocities are derived from the step's displacement before separation, so separation adds no speed.
//! Each approaching contact gets the impulse of `dynamics::impulse` (Coulomb's cone, Stronge's restitution), with the
//! effective mass of the joints at the step's end.
//!
//! Resting contacts follow `resting_friction.rs` where their surfaces have rolling resistance, or for balls with
//! Relaxation.
//!
//! A contact rests if it approaches no faster than the step's forces accelerate in a step or two: a shorter bounce than a step is like
//! rest. It does not bounce. Nor is it reported, if it, or one on the same side of the same two bodies, existed in the previous
//! step. A ball in a hollow rests on one slope after the other.

use super::resting_friction::{ContactImpulse, ContactMobility, ContactVelocity, resting_impulse};
use crate::articulation::System;
use crate::dynamics::impact_law::impulse;
use crate::dynamics::{Contacts, Dynamics, Impact, ImpactKind, MAX_ROW_BODIES, SweptContact, rolling_rows};
use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::{Vec6, add_scaled, angular, dot, linear, vec6};
use soffio_math::{DMat3, DVec3, tangents};

/// Most contacts of one step.
const MAX_CONTACTS: usize = 256;
/// Approach speed below which contacts do not bounce, m/s or rad/s; what forces have given in [`RESTING_STEPS`] steps such as this is
/// added.
const RESTING_SPEED: f64 = 4e-3;
const RESTING_STEPS: f64 = 2.0;
/// Least cosine between the normals of two contacts on the same side.
const SAME_SIDE: f64 = 0.9;
/// Effective inverse mass below which the joints lock a contact, 1/kg.
const LOCKED: f64 = 1e-9;
/// Share of the friction limit below which a contact sticks; the rest is rounding.
const STICKING: f64 = 0.999;
/// Penetration that is tolerated, m or rad.
const PENETRATION_TOLERANCE: f64 = 1e-9;

/// Which pass of separation detects contacts or moves bodies apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SeparationPass {
    /// Its contacts also get impulses.
    First,
    /// A later one of the same step: its contacts are separated only.
    Repeated,
}

/// Friction of balls that rest on a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum FrictionLaw {
    /// Coulomb's law.
    Coulomb,
    /// The source's law of the slip ratio (`resting_friction.rs`).
    SlipRatio,
}

/// Parameters of a step's impulses.
#[derive(Clone, Copy, Debug)]
pub(super) struct ResponseStep {
    /// Length of the step, s.
    pub dt: f64,
    /// Friction of resting balls.
    pub friction: FrictionLaw,
}

/// Response of one contact.
struct Response {
    restitution: f64,
    /// Whether the contact rests.
    resting: bool,
    /// Whether balls follow the source's slip ratio.
    slip_ratio: bool,
    /// Length of the step, s.
    dt: f64,
}

impl Response {
    /// Whether `resting_friction.rs` applies to a contact.
    fn resists(&self, contact: &SweptContact) -> bool {
        self.resting && (!contact.resistance.is_none() || (self.slip_ratio && rolling_ball(contact).is_some()))
    }
}

/// Contacts of a position-based step.
#[derive(Clone, Debug)]
pub(super) struct ContactResponse {
    /// Contacts of the first pass, and of a later one.
    current: Vec<SweptContact>,
    later_contacts: Vec<SweptContact>,
    /// Contacts of the previous step.
    previous: Vec<SweptContact>,
    /// Responses to unit impulses along the three axes of a contact, and to unit couples.
    force_columns: [Vec<Vec6>; 3],
    couple_columns: [Vec<Vec6>; 3],
}

impl ContactResponse {
    /// Room for the contacts of these dynamics; none is known yet.
    pub fn new(dynamics: &Dynamics) -> Self {
        let sources = dynamics.contacts().source_count();
        let capacity = if sources == 0 { 0 } else { MAX_CONTACTS };
        let bodies = if sources == 0 { 0 } else { dynamics.bodies.len() };
        Self {
            current: Vec::with_capacity(capacity),
            later_contacts: Vec::with_capacity(capacity),
            previous: Vec::with_capacity(capacity),
            force_columns: std::array::from_fn(|_| vec![[0.0; 6]; bodies]),
            couple_columns: std::array::from_fn(|_| vec![[0.0; 6]; bodies]),
        }
    }

    /// Whether no contacts are possible.
    pub fn is_empty(&self) -> bool {
        self.current.capacity() == 0
    }

    /// Whether this contact existed in the previous step.
    fn was_touching(&self, contact: &SweptContact) -> bool {
        let same_side = |previous: &SweptContact| {
            contact.colliders.is_some()
                && previous.bodies == contact.bodies
                && previous.normal.dot(contact.normal) > SAME_SIDE
        };
        self.previous.iter().any(|previous| previous.source == contact.source || same_side(previous))
    }

    /// Finds the contacts of the motion between two states; true if any penetrates.
    pub fn detect(
        &mut self,
        contacts: &mut Contacts,
        before: &[RigidBody],
        after: &[RigidBody],
        pass: SeparationPass,
    ) -> bool {
        let found = if pass == SeparationPass::First { &mut self.current } else { &mut self.later_contacts };
        contacts.find_swept_contacts(before, after, found);
        let order = |a: &SweptContact, b: &SweptContact| {
            a.s.total_cmp(&b.s).then(a.source.cmp(&b.source)).then(b.depth.total_cmp(&a.depth))
        };
        found.sort_unstable_by(order);
        let penetrates = found.iter().any(|contact| contact.depth > PENETRATION_TOLERANCE);
        if pass == SeparationPass::Repeated {
            // What separation brings to a limit stops there too.
            for contact in self.later_contacts.iter().filter(|contact| contact.colliders.is_none()) {
                if self.current.iter().all(|known| known.source != contact.source) {
                    self.current.push(*contact);
                }
            }
        }
        penetrates
    }

    /// Separates penetrating contacts by moving the whole mechanism; joints hold to first order.
    pub fn separate_through_joints(&mut self, system: &mut System, bodies: &mut [RigidBody], pass: SeparationPass) {
        system.evaluate(bodies);
        system.factor();
        let found = if pass == SeparationPass::First { &self.current } else { &self.later_contacts };
        let sum = &mut self.force_columns[2];
        sum.fill([0.0; 6]);
        for contact in found {
            // Separation of the others has moved this one too.
            let depth = contact.depth - along(&contact.ends, sum);
            let inverse_mass = if depth > PENETRATION_TOLERANCE && contact.depth > PENETRATION_TOLERANCE {
                respond(system, &contact.ends)
            } else {
                0.0
            };
            if inverse_mass > LOCKED {
                for (sum, a) in sum.iter_mut().zip(&system.a) {
                    add_scaled(sum, depth / inverse_mass, a);
                }
            }
        }
        for (body, delta) in bodies.iter_mut().zip(&self.force_columns[2]) {
            body.displace(linear(delta), angular(delta));
        }
    }

    /// Applies impulses to approaching contacts, and reports them. Returns whether friction has displaced bodies, so
    /// that joints must be closed again.
    pub fn apply_impulses(
        &mut self,
        system: &mut System,
        bodies: &mut [RigidBody],
        before: &[RigidBody],
        step: ResponseStep,
        impacts: &mut Vec<Impact>,
    ) -> bool {
        let ResponseStep { dt, friction } = step;
        let slip_ratio = friction == FrictionLaw::SlipRatio;
        let mut displaced = false;
        system.evaluate(bodies);
        system.factor();
        let already = impacts.len();
        for index in 0..self.current.len() {
            let mut contact = self.current[index];
            contact.point = on_the_ball(&contact, bodies).unwrap_or(contact.point);
            let was_touching = self.was_touching(&contact);
            // The limit has stopped the motion already: its speed is that of the state before.
            let stops = contact.colliders.is_none() && !was_touching;
            let [earlier, now] = [before, &*bodies].map(|bodies| -contact.rate(bodies));
            let speed = now.max(if stops { earlier } else { 0.0 });
            // What a contact of the step before has left is no new hit.
            let left = if was_touching { earlier.max(0.0) } else { 0.0 };
            let resting = speed < left + RESTING_SPEED + RESTING_STEPS * (now - earlier).max(0.0);
            if speed > 0.0 {
                let restitution = if resting { 0.0 } else { contact.restitution };
                let response = Response { restitution, resting, slip_ratio, dt };
                let (push, mass) = self.push(system, &contact, &response, speed, bodies);
                displaced |= resting;
                let reported = impacts[already..]
                    .iter_mut()
                    .find(|reported| reported.colliders == contact.colliders && reported.bodies == contact.bodies);
                match reported {
                    Some(reported) => reported.impulse += push,
                    None if was_touching && resting => {}
                    None => impacts.push(Impact {
                        time: contact.s * dt,
                        kind: match (resting, contact.colliders) {
                            (true, _) => ImpactKind::RestingContact,
                            (false, Some(_)) => ImpactKind::Impact,
                            (false, None) => ImpactKind::Stop,
                        },
                        bodies: contact.bodies,
                        colliders: contact.colliders,
                        point: contact.point,
                        normal: contact.normal,
                        impulse: push,
                        speed,
                        mass,
                    }),
                }
            }
        }
        std::mem::swap(&mut self.current, &mut self.previous);
        displaced
    }

    /// Applies the impulse of one contact or limit. Returns its size (N s) and the effective mass (kg).
    fn push(
        &mut self,
        system: &mut System,
        contact: &SweptContact,
        response: &Response,
        speed: f64,
        bodies: &mut [RigidBody],
    ) -> (f64, f64) {
        if contact.colliders.is_none() {
            let inverse_mass = respond(system, &contact.ends);
            if inverse_mass <= LOCKED {
                return (0.0, 0.0);
            }
            let push = ((response.restitution * speed - contact.rate(bodies)) / inverse_mass).max(0.0);
            system.a.iter_mut().flatten().for_each(|a| *a *= push);
            system.apply_velocity(bodies);
            return ((1.0 + response.restitution) * speed / inverse_mass, 1.0 / inverse_mass);
        }
        let (t, b) = tangents(contact.normal);
        let rows = [t, b, contact.normal].map(|axis| point_row(contact, axis, bodies));
        let mut k = DMat3::ZERO;
        for (index, row) in rows.iter().enumerate() {
            respond(system, row);
            *k.col_mut(index) = DVec3::from_array(rows.map(|row| along(&row, &system.a)));
            self.force_columns[index].copy_from_slice(&system.a);
        }
        if k.z_axis.z <= LOCKED {
            return (0.0, 0.0);
        }
        let velocity = DVec3::from_array(rows.map(|row| SweptContact { ends: row, ..*contact }.rate(bodies)));
        let p = impulse(&k, velocity, contact.friction, response.restitution);
        let ContactImpulse { force, couple } = if response.resists(contact) {
            let slip_ratio = response.slip_ratio && rolling_ball(contact).is_some();
            self.resting_impulse(system, contact, (k, velocity, p), slip_ratio, bodies)
        } else {
            ContactImpulse { force: p, couple: DVec3::ZERO }
        };
        add(bodies, &self.force_columns, force);
        if couple != DVec3::ZERO {
            add(bodies, &self.couple_columns, couple);
        }
        let sticks = force.truncate().length() < STICKING * contact.friction * force.z;
        if response.resting && (sticks || response.resists(contact)) {
            // As under all other forces, the displacement of a step follows the velocity at its end: a body at rest stays.
            self.displace(bodies, (force.with_z(0.0), couple), response.dt);
        }
        (force.length(), 1.0 / k.z_axis.z)
    }
}

impl ContactResponse {
    /// Moves all bodies by what tangential impulses and couples of the last contact change in `dt` s.
    fn displace(&self, bodies: &mut [RigidBody], (force, couple): (DVec3, DVec3), dt: f64) {
        for (columns, p) in [(&self.force_columns, force), (&self.couple_columns, couple)] {
            if p == DVec3::ZERO {
                continue;
            }
            for (index, body) in bodies.iter_mut().enumerate() {
                let (displacement, rotation) = sum(columns, p, index);
                body.displace(dt * displacement, dt * rotation);
            }
        }
    }

    /// Impulse of a resting contact whose Coulomb impulse is known.
    fn resting_impulse(
        &mut self,
        system: &mut System,
        contact: &SweptContact,
        (point, slip, p): (DMat3, DVec3, DVec3),
        slip_ratio: bool,
        bodies: &[RigidBody],
    ) -> ContactImpulse {
        let [n, t, b] = rolling_rows(contact);
        let rows = [t, b, n];
        let (mut mixed, mut rotation, mut center) = (DMat3::ZERO, DMat3::ZERO, DMat3::ZERO);
        let axes = {
            let (t, b) = tangents(contact.normal);
            [t, b, contact.normal]
        };
        let points = axes.map(|axis| point_row(contact, axis, bodies));
        // Velocity of the ball's centre over the surface: the contact point's without the ball's own rotation.
        let ball = rolling_ball(contact);
        let middles = axes.map(|axis| {
            let mut row = point_row(contact, axis, bodies);
            let own = row.iter_mut().flatten().filter(|(body, _)| Some(*body) == ball);
            own.for_each(|(_, block)| *block = vec6(linear(block), DVec3::ZERO));
            row
        });
        for (index, row) in rows.iter().enumerate() {
            respond(system, row);
            *mixed.col_mut(index) = DVec3::from_array(points.map(|row| along(&row, &system.a)));
            *rotation.col_mut(index) = DVec3::from_array(rows.map(|row| along(&row, &system.a)));
            self.couple_columns[index].copy_from_slice(&system.a);
            *center.col_mut(index) = DVec3::from_array(middles.map(|row| along(&row, &self.force_columns[index])));
        }
        let rate = |row| SweptContact { ends: row, ..*contact }.rate(bodies);
        let moves = ContactVelocity {
            slip,
            center: DVec3::from_array(middles.map(rate)),
            rotation: DVec3::from_array(rows.map(rate)),
        };
        resting_impulse(contact, &ContactMobility { point, mixed, rotation, center }, moves, p, slip_ratio)
    }
}

/// The body that is a ball on something else, if exactly one is.
fn rolling_ball(contact: &SweptContact) -> Option<usize> {
    match contact.balls {
        [Some(_), None] => contact.bodies[0],
        [None, Some(_)] => contact.bodies[1],
        _ => None,
    }
}

/// Contact point of a ball after separation.
fn on_the_ball(contact: &SweptContact, bodies: &[RigidBody]) -> Option<DVec3> {
    let place = |side: usize| {
        let ((center, radius), body) = (contact.balls[side]?, contact.bodies[side]?);
        let inward = if side == 0 { -radius } else { radius };
        Some(bodies[body].pose().point(center) + inward * contact.normal)
    };
    place(0).or_else(|| place(1))
}

/// Applies impulses (t, b, n) by their response columns.
fn add(bodies: &mut [RigidBody], force_columns: &[Vec<Vec6>; 3], p: DVec3) {
    for (index, body) in bodies.iter_mut().enumerate() {
        let [t, b, n] = force_columns.each_ref().map(|column| &column[index]);
        for (push, column) in p.to_array().into_iter().zip([t, b, n]) {
            body.velocity += push * linear(column);
            body.angular_velocity += push * angular(column);
        }
    }
}

/// Velocity change of a body by impulses (t, b, n).
fn sum(force_columns: &[Vec<Vec6>; 3], p: DVec3, index: usize) -> (DVec3, DVec3) {
    let [t, b, n] = force_columns.each_ref().map(|column| &column[index]);
    let of = |part: fn(&Vec6) -> DVec3| p.x * part(t) + p.y * part(b) + p.z * part(n);
    (of(linear), of(angular))
}

/// Solves for the response to a unit impulse along a row; returns the row's effective inverse mass.
fn respond(system: &mut System, ends: &[Option<(usize, Vec6)>; MAX_ROW_BODIES]) -> f64 {
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
fn point_row(contact: &SweptContact, axis: DVec3, bodies: &[RigidBody]) -> [Option<(usize, Vec6)>; MAX_ROW_BODIES] {
    let end = |body: Option<usize>, sign: f64| {
        let along = sign * axis;
        body.map(|i| (i, vec6(along, (contact.point - bodies[i].position).cross(along))))
    };
    [end(contact.bodies[0], 1.0), end(contact.bodies[1], -1.0), None]
}

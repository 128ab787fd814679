//! Contact reports: surfaces pressed together at the end of a step, their normal force and slip, for scraping and rolling sounds.

use super::contact::ForceSource;
use super::contact_forces::ContactForce;
use super::state::Contacts;
use crate::collision::ColliderPair;
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;

/// A contact point with its force and velocities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactReport {
    /// Index of the pair of surfaces in the articulation.
    pub pair: usize,
    /// The two bodies; `None` is the world.
    pub bodies: [Option<usize>; 2],
    /// World point of the contact, m.
    pub point: DVec3,
    /// Unit, from the second collider to the first.
    pub normal: DVec3,
    /// Force along the normal, N.
    pub normal_force: f64,
    /// Velocity of the first surface relative to the second in their common plane, m/s.
    pub slip: DVec3,
    /// Velocity of the contact point over the first and over the second surface, in that plane, m/s. Both are the distance
    /// rolled a second for a rolling wheel; one is zero for a scraping corner.
    pub roll: [DVec3; 2],
}

impl Contacts {
    /// Every contact point with a force at the end of the last substep, in a fixed order.
    pub fn contact_reports<'a>(&'a self, bodies: &'a [RigidBody]) -> impl Iterator<Item = ContactReport> + 'a {
        self.forces.active.iter().chain(&self.forces.asleep).filter_map(|force| match force.source {
            ForceSource::Point(pair) => Some(self.report(pair, force, bodies)),
            _ => None,
        })
    }

    fn report(&self, pair: usize, force: &ContactForce, bodies: &[RigidBody]) -> ContactReport {
        let ColliderPair { a, b } = self.surfaces.pairs[pair].pair;
        let [first, second] = [a, b].map(|collider| self.surfaces.colliders[collider].body);
        let velocity = |body: Option<usize>| {
            body.map_or(DVec3::ZERO, |b| {
                let body = &bodies[b];
                body.velocity + body.angular_velocity.cross(force.point - body.position)
            })
        };
        let tangential = |v: DVec3| v - v.dot(force.normal) * force.normal;
        let (one, other) = (velocity(first), velocity(second));
        // Displacement of the point over the substep in which the force was found.
        let point_velocity = force
            .arms
            .iter()
            .flatten()
            .next()
            .map_or(DVec3::ZERO, |arm| arm.displacement / force.substep + bodies[arm.body].velocity);
        ContactReport {
            pair,
            bodies: [first, second],
            point: force.point,
            normal: force.normal,
            normal_force: force.force.dot(force.normal),
            slip: tangential(one - other),
            roll: [tangential(point_velocity - one), tangential(point_velocity - other)],
        }
    }
}

//! What presses on what at the end of a step, how hard, and how fast it slides: what scraping and rolling sound from.

use super::contact::Source;
use super::contact_forces::ContactForce;
use super::state::Contacts;
use crate::collision::Pair;
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;

/// A point where two surfaces press on each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactReport {
    /// Index of the pair among the figure's.
    pub pair: usize,
    /// The two bodies; `None` is the world.
    pub bodies: [Option<usize>; 2],
    /// World, m.
    pub point: DVec3,
    /// Unit, from the second collider to the first.
    pub normal: DVec3,
    /// What presses, along the normal, N.
    pub normal_force: f64,
    /// Velocity of the first surface over the second in their common plane, m/s.
    pub slip: DVec3,
    /// Velocity of the point itself over the first and over the second surface, in that plane, m/s: both are the way of
    /// a wheel that rolls, one is nothing where one corner scrapes.
    pub roll: [DVec3; 2],
}

impl Contacts {
    /// Every touch that the last substep ended with, in a fixed order.
    pub fn contact_reports<'a>(&'a self, bodies: &'a [RigidBody]) -> impl Iterator<Item = ContactReport> + 'a {
        self.forces.held.iter().chain(&self.forces.kept).filter_map(|held| match held.source {
            Source::Pair(pair) if !held.couple => Some(self.pressed_pair(pair, held, bodies)),
            _ => None,
        })
    }

    fn pressed_pair(&self, pair: usize, held: &ContactForce, bodies: &[RigidBody]) -> ContactReport {
        let Pair { a, b } = self.surfaces.pairs[pair].pair;
        let [first, second] = [a, b].map(|collider| self.surfaces.colliders[collider].body);
        let velocity = |body: Option<usize>| {
            body.map_or(DVec3::ZERO, |b| {
                let body = &bodies[b];
                body.velocity + body.angular_velocity.cross(held.point - body.position)
            })
        };
        let across = |v: DVec3| v - v.dot(held.normal) * held.normal;
        let (one, other) = (velocity(first), velocity(second));
        // The way of the point in the substep that it was found in; a world that stands still has no lever.
        let way = held
            .ends
            .iter()
            .flatten()
            .next()
            .map_or(DVec3::ZERO, |lever| lever.way / held.span + bodies[lever.body].velocity);
        ContactReport {
            pair,
            bodies: [first, second],
            point: held.point,
            normal: held.normal,
            normal_force: held.force.dot(held.normal),
            slip: across(one - other),
            roll: [across(way - one), across(way - other)],
        }
    }
}

//! Forces on the bodies: gravity, springs, damping, the gyroscopic torque, and what is handed in from outside.

use crate::articulation::block::{Vec6, vec6};
use crate::articulation::{Anchor, Spring};
use crate::bodies::RigidBody;
use crate::math::DVec3;

/// Damping rates of a body, 1/s: force −c m v, torque −c I ω.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Damping {
    /// Of the centre's velocity.
    pub linear: f64,
    /// Of the angular velocity.
    pub angular: f64,
}

/// Sum of all forces on each body into `b`: linear part N, angular part N m about the centre of mass.
pub fn collect(
    bodies: &[RigidBody],
    gravity: DVec3,
    damping: &[Damping],
    springs: &[Spring],
    external: &[Vec6],
    b: &mut [Vec6],
) {
    for (index, body) in bodies.iter().enumerate() {
        let momentum = body.inertia_world() * body.angular_velocity;
        let force = body.properties.mass * (gravity - damping[index].linear * body.velocity);
        let torque = -body.angular_velocity.cross(momentum) - damping[index].angular * momentum;
        b[index] = vec6(force, torque);
        for k in 0..6 {
            b[index][k] += external[index][k];
        }
    }
    for spring in springs {
        let ((pa, va), (pb, vb)) = (end(&spring.a, bodies), end(&spring.b, bodies));
        let (length, Some(along)) = ((pb - pa).length(), (pb - pa).try_normalize()) else { continue };
        let pull = spring.stiffness * (length - spring.rest_length) + spring.damping * (vb - va).dot(along);
        push(&spring.a, pa, pull * along, bodies, b);
        push(&spring.b, pb, -pull * along, bodies, b);
    }
}

/// Kinetic energy, potential energy in gravity (zero at the world's origin) and in springs, J.
pub fn energy(bodies: &[RigidBody], gravity: DVec3, springs: &[Spring]) -> f64 {
    let moving: f64 = bodies.iter().map(|b| b.kinetic_energy() - b.properties.mass * gravity.dot(b.position)).sum();
    let stretched: f64 = springs
        .iter()
        .map(|s| {
            let stretch = (end(&s.b, bodies).0 - end(&s.a, bodies).0).length() - s.rest_length;
            0.5 * s.stiffness * stretch * stretch
        })
        .sum();
    moving + stretched
}

fn end(anchor: &Anchor, bodies: &[RigidBody]) -> (DVec3, DVec3) {
    match anchor.body {
        Some(index) => {
            let p = bodies[index].position + bodies[index].arm(anchor.point);
            (p, bodies[index].velocity_at(p))
        }
        None => (anchor.point, DVec3::ZERO),
    }
}

fn push(anchor: &Anchor, at: DVec3, force: DVec3, bodies: &[RigidBody], b: &mut [Vec6]) {
    let Some(index) = anchor.body else { return };
    let wrench = vec6(force, (at - bodies[index].position).cross(force));
    for k in 0..6 {
        b[index][k] += wrench[k];
    }
}

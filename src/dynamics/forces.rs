//! Forces on the bodies: gravity, springs, damping, the gyroscopic torque, and what is handed in from outside.

use crate::articulation::block::{Vec6, vec6};
use crate::articulation::{Anchor, Spring, SpringKind};
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
        let SpringKind::Linear { a, b: other } = &spring.kind else { continue };
        let ((pa, va), (pb, vb)) = (end(a, bodies), end(other, bodies));
        let (length, Some(along)) = ((pb - pa).length(), (pb - pa).try_normalize()) else { continue };
        let pull = spring.stiffness.at(0.0).value * (length - spring.rest.at(0.0).value)
            + spring.damping.at(0.0).value * (vb - va).dot(along);
        push(a, pa, pull * along, bodies, b);
        push(other, pb, -pull * along, bodies, b);
    }
}

/// Kinetic energy, potential energy in gravity (zero at the world's origin) and in springs, J.
pub fn energy(bodies: &[RigidBody], gravity: DVec3, springs: &[Spring]) -> f64 {
    let moving: f64 = bodies.iter().map(|b| b.kinetic_energy() - b.properties.mass * gravity.dot(b.position)).sum();
    let stretched: f64 = springs
        .iter()
        .map(|s| {
            let SpringKind::Linear { a, b } = &s.kind else { return 0.0 };
            let stretch = (end(b, bodies).0 - end(a, bodies).0).length() - s.rest.at(0.0).value;
            0.5 * s.stiffness.at(0.0).value * stretch * stretch
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

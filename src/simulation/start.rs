//! How an exhibit starts.

use super::carrying::Carrying;
use super::input::Settings;
use soffio_exhibit::Exhibit;
use soffio_geometry::bodies::RigidBody;
use soffio_multibody::dynamics::forces::Damping;
use soffio_multibody::dynamics::{self, Articulation, Dynamics};

/// The exhibit's bodies as they start, a clock's at the hour.
pub(super) fn start_bodies(exhibit: &Exhibit, settings: &Settings) -> Vec<RigidBody> {
    let body = |body: &soffio_exhibit::Body| RigidBody {
        velocity: body.velocity,
        angular_velocity: body.angular_velocity,
        ..RigidBody::at_rest(body.properties, body.pose)
    };
    let mut bodies: Vec<RigidBody> = exhibit.bodies.iter().map(body).collect();
    if let (Some(clock), Some(time)) = (&exhibit.clock, settings.clock) {
        clock.set(time, &mut bodies);
    }
    bodies
}

/// Whoever carries the hands of a clock to the time, where there is one to be set.
pub(super) fn start_carrying(exhibit: &Exhibit, settings: &Settings, bodies: &[RigidBody]) -> Option<Carrying> {
    let (clock, time) = exhibit.clock.as_ref().zip(settings.clock)?;
    Some(Carrying::new(clock, bodies, time))
}

/// The exhibit's figure at its start, to be moved by itself: without air, hands and sound.
pub fn start_dynamics(exhibit: &Exhibit, settings: &Settings) -> Dynamics {
    let figure = Articulation {
        bodies: start_bodies(exhibit, settings),
        damping: exhibit
            .bodies
            .iter()
            .map(|body| Damping { linear: body.linear_damping, angular: body.angular_damping })
            .collect(),
        constraints: &exhibit.constraints,
        limits: &exhibit.limits,
        springs: &exhibit.springs,
        kinematic_bodies: &exhibit.drives,
        colliders: &exhibit.colliders,
        pairs: exhibit.pairs().meet.into_iter().map(|pair| exhibit.surface_pair(pair)).collect(),
    };
    let dynamics = dynamics::Settings {
        gravity: exhibit.gravity,
        friction: settings.friction,
        stabilization_time: exhibit.stabilization_time,
        integrator: exhibit.integrator,
        solver: exhibit.solver,
    };
    Dynamics::new(figure, dynamics)
}

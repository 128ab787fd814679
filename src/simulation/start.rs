//! Start of an exhibit: its bodies and dynamics.

use super::clock_setting::ClockSetting;
use super::input::Settings;
use soffio_exhibit::Exhibit;
use soffio_geometry::bodies::RigidBody;
use soffio_multibody::dynamics::forces::Damping;
use soffio_multibody::dynamics::{self, Articulation, Dynamics};

/// The exhibit's bodies at their start; a clock's show the hour.
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

/// The clock setting of a run, if the exhibit has a clock and the run has a time of day.
pub(super) fn start_clock_setting(
    exhibit: &Exhibit,
    settings: &Settings,
    bodies: &[RigidBody],
) -> Option<ClockSetting> {
    let (clock, time) = exhibit.clock.as_ref().zip(settings.clock)?;
    Some(ClockSetting::new(clock, bodies, time))
}

/// The exhibit's dynamics at its start, for use without wind, pointers and sound.
pub fn start_dynamics(exhibit: &Exhibit, settings: &Settings) -> Dynamics {
    let articulation = Articulation {
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
        pairs: exhibit.collider_pairs().meet.into_iter().map(|pair| exhibit.surface_pair(pair)).collect(),
    };
    let dynamics = dynamics::Settings {
        gravity: exhibit.gravity,
        friction: settings.friction,
        stabilization_time: exhibit.stabilization_time,
        integrator: exhibit.integrator,
        solver: exhibit.solver,
    };
    Dynamics::new(articulation, dynamics)
}

//! Start of an exhibit: its bodies and dynamics.

use super::clock_setting::ClockSetting;
use super::input::Settings;
use soffio_exhibit::Exhibit;
use soffio_geometry::bodies::RigidBody;
use soffio_math::Interpolation;
use soffio_multibody::articulation::Limit;
use soffio_multibody::dynamics::forces::Damping;
use soffio_multibody::dynamics::{self, Articulation, Dynamics, KeyframeMotion, KinematicBody};

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

/// The exhibit's dynamics at its start, for use without wind, pointers and sound. All bodies move by it.
pub fn start_dynamics(exhibit: &Exhibit, settings: &Settings) -> Dynamics {
    start_dynamics_of(exhibit, settings, &vec![true; exhibit.bodies.len()])
}

/// The same, in which only the bodies that are `own` move, and the others stand where they start.
pub(super) fn start_dynamics_of(exhibit: &Exhibit, settings: &Settings, own: &[bool]) -> Dynamics {
    let is_kinematic = |body: usize| exhibit.drives.iter().any(|drive| drive.body == body);
    let standing = (0..own.len()).filter(|&body| !own[body] && !is_kinematic(body)).map(|body| KinematicBody {
        body,
        motion: KeyframeMotion {
            keys: vec![(0.0, exhibit.bodies[body].pose)],
            interpolation: Interpolation::Step,
            repeat: false,
        },
    });
    let kinematic_bodies: Vec<KinematicBody> = exhibit.drives.iter().cloned().chain(standing).collect();
    let is_own = |body: Option<usize>| body.is_some_and(|body| own[body] || is_kinematic(body));
    let pairs = exhibit.collider_pairs().meet.into_iter();
    let pairs = pairs.filter(|pair| [pair.a, pair.b].iter().any(|&collider| is_own(exhibit.colliders[collider].body)));
    let limits = exhibit.limits.iter().filter(|limit| (0..own.len()).any(|body| own[body] && limit.kind.acts_on(body)));
    let limits: Vec<Limit> = limits.cloned().collect();
    let articulation = Articulation {
        bodies: start_bodies(exhibit, settings),
        damping: exhibit
            .bodies
            .iter()
            .map(|body| Damping { linear: body.linear_damping, angular: body.angular_damping })
            .collect(),
        constraints: &exhibit.constraints,
        limits: &limits,
        springs: &exhibit.springs,
        kinematic_bodies: &kinematic_bodies,
        colliders: &exhibit.colliders,
        pairs: pairs.map(|pair| exhibit.surface_pair(pair)).collect(),
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

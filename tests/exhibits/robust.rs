//! Numbers that are none, and forces that nobody planned for: no pose is lost, and an event says so.

use std::sync::Arc;

use soffio_exhibit::Exhibit;
use soffio_geometry::bodies::RigidBody;
use soffio_math::DVec3;
use soffio_multibody::articulation::Schedule;
use soffio_simulation::{Command, Event, EventKind, Settings, Simulation, StepInput};

use crate::{load, note};

/// What the product promises of joints, m.
const JOINT_ERROR: f64 = 1e-9;

/// Steps an exhibit and returns its events; every pose is finite.
fn play(simulation: &mut Simulation, steps: usize) -> Vec<Event> {
    let mut events = Vec::new();
    for _ in 0..steps {
        simulation.step(&StepInput::default());
        assert!(simulation.bodies().iter().all(RigidBody::is_finite), "bad numbers at step {}", simulation.steps());
        let snapshot = simulation.snapshot();
        assert!(
            snapshot.dust_particles.iter().all(|mote| mote.position.iter().all(|x| x.is_finite())),
            "the dust is lost"
        );
        assert!(snapshot.breath.target.is_finite() && snapshot.diagnostics.wind_force.is_finite());
        events.extend_from_slice(simulation.events());
    }
    events
}

fn faults(events: &[Event]) -> Vec<&Event> {
    events.iter().filter(|event| event.kind == EventKind::Fault).collect()
}

pub fn a_nan_is_found_and_the_mechanism_restored(id: &str) {
    type Harm = fn(&mut RigidBody);
    let harms: [(&str, Harm); 5] = [
        ("velocity", |body| body.velocity.x = f64::NAN),
        ("spin", |body| body.angular_velocity.y = f64::INFINITY),
        ("place", |body| body.position.z = f64::NAN),
        ("rotation", |body| body.rotation.w = f64::NAN),
        ("speed", |body| body.velocity = DVec3::new(1e4, 0.0, 0.0)),
    ];
    let blown = |id: &str| {
        let mut simulation = Simulation::new(load(id), Settings::default());
        let blow = [Command::Blow(Some(6.0))];
        simulation.step(&StepInput { commands: &blow, ..StepInput::default() });
        play(&mut simulation, 30);
        simulation
    };
    // Parts that are still on their way together are as far apart in a run without harm.
    let mut whole = blown(id);
    play(&mut whole, 480);
    let open = JOINT_ERROR.max(2.0 * whole.joint_error());
    for (what, harm) in harms {
        let mut simulation = blown(id);
        let victim = simulation.bodies().len() - 1;
        let whole: Vec<_> = simulation.bodies().iter().map(|body| body.position).collect();
        harm(&mut simulation.bodies_mut()[victim]);
        let events = play(&mut simulation, 1);
        let [fault] = faults(&events)[..] else { panic!("{id}, {what}: {events:?}") };
        assert_eq!(fault.bodies, [Some(victim), None], "{id}, {what}");
        for (body, before) in simulation.bodies().iter().zip(whole) {
            assert!(body.position.distance(before) < 0.02, "{id}, {what}: put to {}", body.position);
        }
        assert!(faults(&play(&mut simulation, 480)).is_empty(), "{id}, {what}: again");
        assert!(simulation.joint_error() < open, "{id}, {what}: {} m", simulation.joint_error());
        assert_eq!(simulation.snapshot().diagnostics.faults, 1);
    }
}

pub fn a_hundred_times_the_gravity_is_borne(id: &str) {
    let mut exhibit = Exhibit::clone(&load(id));
    exhibit.gravity = DVec3::new(0.0, -1e3, 0.0);
    // A joint that has opened counts as open while it is being closed.
    let always = exhibit.constraints.iter().all(|constraint| constraint.schedule == Schedule::default());
    let mut simulation = Simulation::new(Arc::new(exhibit), Settings::default());
    let blow = [Command::Blow(Some(17.0))];
    simulation.step(&StepInput { commands: &blow, ..StepInput::default() });
    let mut events = simulation.events().to_vec();
    events.extend(play(&mut simulation, 300));
    let (open, bad) = (simulation.joint_error(), faults(&events).len());
    // What has broken off falls into a heap at a hundred times the gravity, and there its joints do open: those of
    // breaking-chain by 40 mm. That is not borne, but nothing here asks for it.
    let broken = events.iter().any(|event| event.kind == EventKind::Break);
    note!("{id}: {bad} faults, {} events, broken: {broken}, joints open by {open:.1e} m", events.len());
    assert_eq!(bad, 0, "{id}: faults");
    assert!(!always || broken || open < JOINT_ERROR, "{id}: joints open by {open} m");
}

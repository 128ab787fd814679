//! The kinds of motion of a whole exhibit, and the change from one to another: the figure goes on from where it is, as
//! fast as it was, and wind, hits and sounds act in every kind.

use std::sync::Arc;

use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_math::DVec3;
use soffio_simulation::{Command, EventKind, MotionMode, Settings, Simulation, StepInput};
use soffio_sound::SoundCommand;

const MODES: [MotionMode; 3] = [MotionMode::Dynamic, MotionMode::Procedural, MotionMode::PositionBased];
/// A breath that moves everything, m/s at the lips.
const BREATH: f64 = 12.0;

fn load(id: &str) -> Arc<Exhibit> {
    let folder = exhibit::resolve(id).unwrap_or_else(|report| panic!("{report}"));
    Arc::new(exhibit::load(&folder).unwrap_or_else(|report| panic!("{id}: {}", report.to_text())))
}

/// A step with a breath from the first to the third second.
fn step(simulation: &mut Simulation, mode: MotionMode, blows: bool) {
    step_at(simulation, mode, blows, None);
}

/// The same, pointed somewhere.
fn step_at(simulation: &mut Simulation, mode: MotionMode, blows: bool, pointer: Option<[f64; 2]>) {
    let speed = match simulation.steps() {
        240 if blows => Some(Command::Blow(Some(BREATH))),
        720 if blows => Some(Command::Blow(None)),
        _ => None,
    };
    simulation.step(&StepInput { mode: Some(mode), commands: speed.as_slice(), pointer, ..StepInput::default() });
}

#[test]
fn wind_moves_a_figure_in_every_mode() {
    /// A breath of two seconds moves some plate by this at least, m.
    const SEEN: f64 = 5e-3;
    for mode in MODES {
        let exhibit = load("steel-fish");
        let after = |blows: bool| -> Vec<DVec3> {
            let mut simulation = Simulation::new(exhibit.clone(), Settings::default());
            (0..600).for_each(|_| step(&mut simulation, mode, blows));
            simulation.bodies().iter().map(|body| body.position).collect()
        };
        let far = after(true).iter().zip(after(false)).map(|(a, b)| a.distance(b)).fold(0.0, f64::max);
        println!("{mode:?}: {far} m");
        assert!(far > SEEN, "{mode:?}: {far} m");
    }
}

#[test]
fn hits_are_told_and_heard_in_every_mode() {
    for mode in MODES {
        let (mut hits, mut strikes) = (0, 0);
        // Not every place that is blown at drives the discs together.
        for x in [0.35, 0.5, 0.65] {
            let mut simulation = Simulation::new(load("plates"), Settings::default());
            for _ in 0..2400 {
                step_at(&mut simulation, mode, true, Some([x, 0.5]));
                hits += simulation.events().iter().filter(|event| event.kind == EventKind::Impact).count();
                strikes += simulation.sounds().iter().filter(|sound| matches!(sound, SoundCommand::Strike(_))).count();
                assert!(simulation.bodies().iter().all(soffio_geometry::bodies::RigidBody::is_finite));
            }
            println!("{mode:?} at {x}: {hits} hits, {strikes} strikes so far");
        }
        assert!(hits > 0 && strikes > 0, "{mode:?}: {hits} hits, {strikes} strikes");
    }
}

//! Assembly: exhibits assemble from scattered parts when they are shown, and then are as after a reset.

use std::sync::Arc;

use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_simulation::{
    ASSEMBLY_DURATION, Command, EventKind, MotionMode, STEPS_PER_SECOND, Script, Settings, Simulation, StepInput,
};

fn load(id: &str) -> Arc<Exhibit> {
    let folder = exhibit::resolve(id).unwrap_or_else(|report| panic!("{report}"));
    Arc::new(exhibit::load(&folder).unwrap_or_else(|report| panic!("{id}: {}", report.to_text())))
}

fn steps(seconds: f64) -> u64 {
    (seconds * STEPS_PER_SECOND as f64) as u64
}

#[test]
fn an_exhibit_without_assembly_is_reset() {
    let mut exhibit = Exhibit::clone(&load("pendulum"));
    exhibit.assembles = false;
    let exhibit = Arc::new(exhibit);
    let [mut one, mut other] = [(); 2].map(|()| Simulation::new(exhibit.clone(), Settings::default()));
    for step in 0..100 {
        let commands = [Command::Assemble(3)];
        one.step(&StepInput { commands: if step == 50 { &commands } else { &[] }, ..StepInput::default() });
        let commands = [Command::Reset];
        other.step(&StepInput { commands: if step == 50 { &commands } else { &[] }, ..StepInput::default() });
    }
    assert_eq!(one.state_hash(), other.state_hash());
}

#[test]
fn a_script_starts_assembly_which_grabs_and_breaths_do_not_disturb() {
    let mut script = Script::parse("{\"t\": 0.5, \"gather\": 4}").expect("a good script");
    let mut simulation = Simulation::new(load("twelve-moons"), Settings::default());
    let mut assembled = false;
    for step in 0..steps(0.5 + ASSEMBLY_DURATION) + 2 {
        let mut commands = Vec::new();
        script.due(step as f64 / STEPS_PER_SECOND as f64, &mut commands);
        commands.push(Command::Blow(Some(8.0)));
        simulation.step(&StepInput { commands: &commands, ..StepInput::default() });
        assembled |= simulation.assembly_distance().is_some();
        assert!(simulation.events().iter().all(|e| e.kind != EventKind::Fault), "step {step}");
    }
    assert!(assembled && simulation.assembly_distance().is_none());
    assert!(simulation.joint_error() < 1e-9, "{} m", simulation.joint_error());
}

#[test]
fn position_based_parts_assemble_at_any_change_of_motion_mode() {
    /// Δ₀ (1 + Ωt) e^(−Ωt) of half a metre at the end is 0.2 µm, m.
    const HOME: f64 = 5e-6;
    let positions = Some(MotionMode::PositionBased);
    let modes: [fn(u64) -> Option<MotionMode>; 3] = [
        |_| Some(MotionMode::PositionBased),
        // As a work limit that is reached, and left again.
        |step| (step > 300).then_some(MotionMode::PositionBased),
        |step| (step % 400 < 200).then_some(MotionMode::PositionBased),
    ];
    for id in ["twelve-moons", "snow", "breath-clock"] {
        let exhibit = load(id);
        for mode in modes {
            let mut simulation = Simulation::new(exhibit.clone(), Settings::default());
            let mut before: Option<Vec<_>> = None;
            let mut fastest = 0.0_f64;
            for step in 0..steps(ASSEMBLY_DURATION) {
                let commands = [Command::Assemble(5)];
                let commands = if step == 0 { &commands[..] } else { &[] };
                simulation.step(&StepInput { commands, mode: mode(step), ..StepInput::default() });
                assert!(simulation.events().iter().all(|e| e.kind != EventKind::Fault), "{id}: step {step}");
                let places: Vec<_> = simulation.bodies().iter().map(|body| body.position).collect();
                for (now, before) in places.iter().zip(before.iter().flatten()) {
                    fastest = fastest.max(now.distance(*before));
                }
                before = Some(places);
            }
            let away = simulation.assembly_distance().expect("it still assembles");
            assert!(away < HOME, "{id}: {away} m from home");
            // Ω Δ₀/e of a metre a second at most, by the field's word; joints may pull somewhat harder.
            assert!(fastest * STEPS_PER_SECOND as f64 <= 4.0, "{id}: no part jumps: {fastest} m in a step");
            simulation.step(&StepInput { mode: positions, ..StepInput::default() });
            assert_eq!(simulation.assembly_distance(), None);
            assert!(simulation.joint_error() < 1e-6, "{id}: {} m", simulation.joint_error());
        }
    }
}

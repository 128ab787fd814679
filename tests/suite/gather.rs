//! Exhibits gather themselves from scattered parts when they come on, and then are as after a reset.

use std::sync::Arc;

use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_simulation::{
    Command, EventKind, GATHERING_LASTS, STEPS_PER_SECOND, Script, Settings, Simulation, StepInput,
};

fn load(id: &str) -> Arc<Exhibit> {
    let folder = exhibit::resolve(id).unwrap_or_else(|report| panic!("{report}"));
    Arc::new(exhibit::load(&folder).unwrap_or_else(|report| panic!("{id}: {}", report.render(false))))
}

fn steps(seconds: f64) -> u64 {
    (seconds * STEPS_PER_SECOND as f64) as u64
}

#[test]
fn what_may_not_gather_is_reset() {
    let mut exhibit = Exhibit::clone(&load("pendulum"));
    exhibit.gathers = false;
    let exhibit = Arc::new(exhibit);
    let [mut one, mut other] = [(); 2].map(|()| Simulation::new(exhibit.clone(), Settings::default()));
    for step in 0..100 {
        let commands = [Command::Gather(3)];
        one.step(&StepInput { commands: if step == 50 { &commands } else { &[] }, ..StepInput::default() });
        let commands = [Command::Reset];
        other.step(&StepInput { commands: if step == 50 { &commands } else { &[] }, ..StepInput::default() });
    }
    assert_eq!(one.state_hash(), other.state_hash());
}

#[test]
fn a_script_gathers_and_a_hand_and_a_breath_do_not_hinder_it() {
    let mut script = Script::parse("{\"t\": 0.5, \"gather\": 4}").expect("a good script");
    let mut simulation = Simulation::new(load("twelve-moons"), Settings::default());
    let mut gathered = false;
    for step in 0..steps(0.5 + GATHERING_LASTS) + 2 {
        let mut commands = Vec::new();
        script.due(step as f64 / STEPS_PER_SECOND as f64, &mut commands);
        commands.push(Command::Blow(Some(8.0)));
        simulation.step(&StepInput { commands: &commands, ..StepInput::default() });
        gathered |= simulation.gathers_from().is_some();
        assert!(simulation.events().iter().all(|e| e.kind != EventKind::Fault), "step {step}");
    }
    assert!(gathered && simulation.gathers_from().is_none());
    assert!(simulation.joint_error() < 1e-9, "{} m", simulation.joint_error());
}

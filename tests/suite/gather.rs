//! Exhibits gather themselves from scattered parts when they come on, and then are as after a reset.

use std::sync::Arc;

use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_simulation::{
    Command, EventKind, GATHERING_LASTS, STEPS_PER_SECOND, Script, Settings, Simulation, StepInput,
};

/// Where the farthest part begins, at least, m; and where all are in the end: Δ₀ (1 + Ωt) e^(−Ωt) of half a metre is 0.2 µm.
const SCATTERED: f64 = 0.01;
const HOME: f64 = 5e-6;
/// Parts of one figure belong together long before that: what joints are open by after twelve of their time constants, m;
/// 13 e^(−12) of half a metre is 0.04 mm.
const TOGETHER: f64 = 2e-4;

fn load(id: &str) -> Arc<Exhibit> {
    let folder = exhibit::resolve(id).unwrap_or_else(|report| panic!("{report}"));
    Arc::new(exhibit::load(&folder).unwrap_or_else(|report| panic!("{id}: {}", report.render(false))))
}

fn steps(seconds: f64) -> u64 {
    (seconds * STEPS_PER_SECOND as f64) as u64
}

#[test]
fn every_exhibit_gathers_itself_in_a_few_seconds() {
    for id in exhibit::ids() {
        let exhibit = load(&id);
        for seed in [1, 2] {
            let mut simulation = Simulation::new(exhibit.clone(), Settings::default());
            let (mut first, mut last, mut open) = (0.0_f64, f64::INFINITY, 0.0);
            for step in 0..steps(GATHERING_LASTS) {
                let commands = [Command::Gather(seed)];
                let commands = if step == 0 { &commands[..] } else { &[] };
                simulation.step(&StepInput { commands, ..StepInput::default() });
                assert!(
                    simulation.events().iter().all(|e| e.kind != EventKind::Fault),
                    "{id}, seed {seed}: step {step}"
                );
                assert!(
                    simulation.sounds().iter().all(|s| !matches!(s, soffio_sound::SoundCommand::Strike(_))),
                    "{id}"
                );
                last = simulation.gathers_from().unwrap_or_else(|| panic!("{id} does not gather"));
                first = first.max(last);
                if step == steps(2.0 / 3.0 * GATHERING_LASTS) {
                    open = simulation.joint_error();
                }
            }
            println!("{id}, seed {seed}: from {:.0} mm to {last:.1e} m, joints open by {open:.1e} m", 1e3 * first);
            assert!(first > SCATTERED, "{id}, seed {seed}: parts begin {first} m away");
            assert!(open < TOGETHER, "{id}, seed {seed}: joints open by {open} m");
            assert!(last < HOME, "{id}, seed {seed}: {last} m from home");
            // Then it is the exhibit at its start.
            let mut anew = Simulation::new(exhibit.clone(), Settings::default());
            simulation.step(&StepInput::default());
            anew.step(&StepInput::default());
            assert_eq!(simulation.gathers_from(), None, "{id}");
            assert_eq!(simulation.bodies(), anew.bodies(), "{id}, seed {seed}");
        }
    }
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

//! Assembly: an exhibit assembles from scattered parts when it is shown, and is then as after a reset.

use soffio_simulation::{ASSEMBLY_DURATION, Command, EventKind, STEPS_PER_SECOND, Settings, Simulation, StepInput};

use crate::{load, note};

/// Smallest initial distance of the farthest part, m.
const SCATTERED: f64 = 0.01;
/// Largest final distance of any part, m: Δ₀ (1 + Ωt) e^(−Ωt) of half a metre is 0.2 µm.
const HOME: f64 = 5e-6;
/// Largest gap of a joint after twelve of its time constants, long before that, m: 13 e^(−12) of half a metre is 0.04 mm.
const TOGETHER: f64 = 2e-4;

fn steps(seconds: f64) -> u64 {
    (seconds * STEPS_PER_SECOND as f64) as u64
}

pub fn assembles_in_a_few_seconds(id: &str) {
    let exhibit = load(id);
    for seed in [1, 2] {
        let mut simulation = Simulation::new(exhibit.clone(), Settings::default());
        let (mut first, mut last, mut open) = (0.0_f64, f64::INFINITY, 0.0);
        for step in 0..steps(ASSEMBLY_DURATION) {
            let commands = [Command::Assemble(seed)];
            let commands = if step == 0 { &commands[..] } else { &[] };
            simulation.step(&StepInput { commands, ..StepInput::default() });
            assert!(simulation.events().iter().all(|e| e.kind != EventKind::Fault), "{id}, seed {seed}: step {step}");
            assert!(simulation.sounds().iter().all(|s| !matches!(s, soffio_sound::SoundCommand::Strike(_))), "{id}");
            last = simulation.assembly_distance().unwrap_or_else(|| panic!("{id} does not assemble"));
            first = first.max(last);
            if step == steps(2.0 / 3.0 * ASSEMBLY_DURATION) {
                open = simulation.joint_error();
            }
        }
        note!("{id}, seed {seed}: from {:.0} mm to {last:.1e} m, joints open by {open:.1e} m", 1e3 * first);
        assert!(first > SCATTERED, "{id}, seed {seed}: parts begin {first} m away");
        assert!(open < TOGETHER, "{id}, seed {seed}: joints open by {open} m");
        assert!(last < HOME, "{id}, seed {seed}: {last} m from home");
        // Then it is the exhibit at its start.
        let mut fresh = Simulation::new(exhibit.clone(), Settings::default());
        simulation.step(&StepInput::default());
        fresh.step(&StepInput::default());
        assert_eq!(simulation.assembly_distance(), None, "{id}");
        assert_eq!(simulation.bodies(), fresh.bodies(), "{id}, seed {seed}");
    }
}

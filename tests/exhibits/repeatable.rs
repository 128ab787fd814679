//! The same run is the same to the bit, again and after a reset; and a step asks for no memory.

use std::path::Path;
use std::sync::Arc;

use assert_no_alloc::assert_no_alloc;
use soffio_exhibit::Exhibit;
use soffio_offline::feed::WavFeed;
use soffio_offline::wav;
use soffio_simulation::{self as simulation, Script, Settings, Simulation, StepInput};

use crate::{load, note};

/// A run with a recorded breath, `seed` and a pointer that wanders.
fn hash_after(exhibit: &Arc<Exhibit>, steps: usize, seed: u64) -> u64 {
    let mut simulation = Simulation::new(exhibit.clone(), Settings { seed, ..Settings::default() });
    let mut breath = strong();
    for step in 0..steps {
        let pointer = Some([0.3 + 0.4 * step as f64 / steps as f64, 0.5]);
        simulation.step(&StepInput { microphone: Some(breath.microphone()), pointer, ..StepInput::default() });
    }
    simulation.state_hash()
}

fn strong() -> WavFeed {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits/steel-fish/breaths/strong.wav");
    let recording = wav::read(path).expect("a shipped breath");
    WavFeed::new(recording.samples, recording.sample_rate)
}

pub fn a_run_repeats_itself_within_a_process(id: &str) {
    let exhibit = load(id);
    let first = hash_after(&exhibit, 1_500, 5);
    assert_eq!(first, hash_after(&exhibit, 1_500, 5), "{id}");
    assert_ne!(first, hash_after(&exhibit, 1_500, 6), "{id}: the gusts are those of the seed");
}

pub fn a_reset_gives_the_first_run_again(id: &str) {
    let exhibit = load(id);
    let settings = Settings { wind: false, ..Settings::default() };
    let mut simulation = Simulation::new(exhibit.clone(), settings);
    let run = |simulation: &mut Simulation, reset: bool| {
        for step in 0..700 {
            let commands = [simulation::Command::Reset];
            let commands = if reset && step == 0 { &commands[..] } else { &[] };
            simulation.step(&StepInput { commands, ..StepInput::default() });
        }
        simulation.bodies().to_vec()
    };
    let first = run(&mut simulation, false);
    assert!(first == run(&mut simulation, true), "{id} is another one after a reset");
}

/// The allocator that watches is that of `main.rs`; it acts in debug builds.
pub fn a_step_asks_for_no_memory_once_it_is_warm(id: &str) {
    /// A breath is heard, the lists have been used, the chain has not broken yet.
    const WARM: usize = 240;
    let mut simulation = Simulation::new(load(id), Settings::default());
    let text = std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/gusts.jsonl"))
        .expect("the script");
    // The reset of the script builds the figure again; until then nothing may.
    let text: Vec<&str> = text.lines().take_while(|line| !line.contains("reset")).collect();
    let mut script = Script::parse(&text.join("\n")).expect("a good script");
    let mut commands = Vec::with_capacity(8);
    let mut breath = strong();
    let mut seen = 0;
    for step in 0..24 * 240 {
        commands.clear();
        script.due(step as f64 / 240.0, &mut commands);
        let pointer = script.aim();
        let microphone = Some(breath.microphone());
        let input = StepInput { microphone, pointer, commands: &commands, ..StepInput::default() };
        if step < WARM {
            simulation.step(&input);
        } else {
            assert_no_alloc(|| simulation.step(&input));
        }
        seen += simulation.events().len();
    }
    note!("{id}: {seen} events");
}

//! What a step of an exhibit costs: motion, wind, a hard breath, sound.

use std::hint::black_box;
use std::sync::Arc;

use cpu_time::ThreadTime;
use serde::Serialize;

use crate::commands::failure::{Failure, Outcome};
use crate::commands::setup::open;
use soffio_exhibit::Exhibit;
use soffio_simulation::{Command, SAMPLE_RATE, SAMPLES_PER_STEP, STEPS_PER_SECOND, Settings, Simulation, StepInput};
use soffio_sound::{SoundCommand, Synth};

/// Rounds of each measurement; the best is reported, as the machine's other work can only add.
const ROUNDS: usize = 3;
/// A hard breath, m/s at the lips.
const HARD: f64 = 17.0;

/// Costs of one exhibit, thread CPU time, best of three.
#[derive(Serialize)]
struct Row {
    exhibit: String,
    bodies: usize,
    colliders: usize,
    /// µs per step of motion alone: no wind, no friction.
    motion_us: f64,
    /// µs per step with the wind model and still air.
    still_us: f64,
    /// µs per step in a hard breath.
    breath_us: f64,
    /// µs of sound per step (200 samples) in the same breath.
    sound_us: f64,
    /// Integration substeps of the last step of the breath.
    substeps: u32,
    /// Times faster than real time in a hard breath, sound included.
    real_time_factor: f64,
}

/// Measures the named exhibits, or all that are shipped.
pub fn run(names: &[String], seconds: f64, json: bool) -> Outcome {
    let names = if names.is_empty() { soffio_exhibit::ids() } else { names.to_vec() };
    if names.is_empty() {
        return Err(Failure::input("there is no exhibit here; run this where the folder `exhibits` is, or name one"));
    }
    if !json {
        println!(
            "{:<16} {:>6} {:>9} {:>9} {:>9} {:>9} {:>9} {:>8} {:>9}",
            "exhibit", "bodies", "colliders", "motion", "still", "breath", "sound", "substeps", "x real"
        );
    }
    for name in names {
        let row = measure(&open(&name)?, seconds)?;
        if json {
            println!("{}", serde_json::to_string(&row).map_err(Failure::input)?);
        } else {
            println!(
                "{:<16} {:>6} {:>9} {:>6.1} us {:>6.1} us {:>6.1} us {:>6.1} us {:>8} {:>9.1}",
                row.exhibit,
                row.bodies,
                row.colliders,
                row.motion_us,
                row.still_us,
                row.breath_us,
                row.sound_us,
                row.substeps,
                row.real_time_factor
            );
        }
    }
    Ok(())
}

fn measure(exhibit: &Arc<Exhibit>, seconds: f64) -> Result<Row, Failure> {
    let steps = (seconds * STEPS_PER_SECOND as f64).ceil() as u64;
    let blow = [Command::Blow(Some(HARD))];
    let still = Settings::default();
    let bare = Settings { wind: false, friction: false, ..still };
    let (motion_us, _, _) = time(exhibit, bare, &[], steps);
    let (still_us, _, _) = time(exhibit, still, &[], steps);
    let (breath_us, sounds, substeps) = time(exhibit, still, &blow, steps);
    let mut sound_us = f64::INFINITY;
    for _ in 0..ROUNDS {
        let mut synth = Synth::new(SAMPLE_RATE, &exhibit.instruments, still.seed).map_err(Failure::input)?;
        let mut block = vec![0.0; 2 * SAMPLES_PER_STEP as usize];
        let start = ThreadTime::now();
        for step in &sounds {
            step.iter().for_each(|&sound| synth.command(sound));
            synth.render(&mut block);
            black_box(&block);
        }
        sound_us = sound_us.min(1e6 * start.elapsed().as_secs_f64() / steps as f64);
    }
    Ok(Row {
        exhibit: exhibit.id.clone(),
        bodies: exhibit.bodies.len(),
        colliders: exhibit.colliders.len(),
        motion_us,
        still_us,
        breath_us,
        sound_us,
        substeps,
        real_time_factor: 1e6 / (STEPS_PER_SECOND as f64 * (breath_us + sound_us)),
    })
}

/// µs per step, best of the rounds; the sounds of each step and the last step's substeps.
fn time(
    exhibit: &Arc<Exhibit>,
    settings: Settings,
    commands: &[Command],
    steps: u64,
) -> (f64, Vec<Vec<SoundCommand>>, u32) {
    let mut best = f64::INFINITY;
    let (mut sounds, mut substeps) = (Vec::new(), 0);
    for _ in 0..ROUNDS {
        let mut simulation = Simulation::new(exhibit.clone(), settings);
        sounds = Vec::with_capacity(steps as usize);
        let start = ThreadTime::now();
        for step in 0..steps {
            simulation.step(&StepInput { commands: if step == 0 { commands } else { &[] }, ..StepInput::default() });
            sounds.push(simulation.sounds().to_vec());
        }
        best = best.min(1e6 * start.elapsed().as_secs_f64() / steps as f64);
        substeps = simulation.snapshot().diagnostics.substeps;
    }
    (best, sounds, substeps)
}

//! Cost of a step of an exhibit: motion, wind, a hard breath, sound; and its slowest steps under all loads.

use std::hint::black_box;
use std::sync::Arc;

use cpu_time::ThreadTime;
use serde::Serialize;

use crate::commands::failure::{Failure, Outcome};
use crate::commands::setup::open;
use soffio_exhibit::Exhibit;
use soffio_offline::load::{HARDEST_BREATH, LoadReport, LoadTimes, StressLoad, loads};
use soffio_offline::scene::times::timed;
use soffio_simulation::{Command, SAMPLE_RATE, SAMPLES_PER_STEP, STEPS_PER_SECOND, Settings, Simulation, StepInput};
use soffio_sound::{SoundCommand, Synth};

/// Rounds of each measurement; the best is reported, as other load on the machine can only add.
const ROUNDS: usize = 3;

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
    /// ms to read and check the exhibit's files, to build the simulation, and to build its instruments.
    load_ms: f64,
    start_ms: f64,
    instruments_ms: f64,
    /// Step times in a hard breath, in a fast drag and in the assembly, where the exhibit has these; and in all of them.
    hard_breath: Option<LoadReport>,
    drag: Option<LoadReport>,
    assembly: Option<LoadReport>,
    all: Option<LoadReport>,
}

/// Measures the named exhibits, or all shipped ones, for so many seconds and seeds. Fails if a step takes longer than `within`
/// ms.
pub fn run(names: &[String], (seconds, seeds): (f64, u64), within: Option<f64>, json: bool) -> Outcome {
    let names = if names.is_empty() { soffio_exhibit::ids() } else { names.to_vec() };
    if names.is_empty() {
        return Err(Failure::input("there is no exhibit here; run this where the folder `exhibits` is, or name one"));
    }
    if !json {
        println!(
            "{:<20} {:>6} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>8} {:>7} | {:>9} {:>9} {:>9}  worst step",
            "exhibit",
            "bodies",
            "colliders",
            "load",
            "motion",
            "still",
            "breath",
            "sound",
            "substeps",
            "x real",
            "p50",
            "p99",
            "p100"
        );
    }
    let mut late = Vec::new();
    for name in names {
        let row = measure(&open(&name)?, seconds, seeds)?;
        if let (Some(within), Some(all)) = (within, &row.all)
            && all.times.p100_us > 1e3 * within
        {
            late.push(format!("{} ({:.2} ms in a {})", row.exhibit, 1e-3 * all.times.p100_us, all.worst_load));
        }
        if json {
            println!("{}", serde_json::to_string(&row).map_err(Failure::input)?);
        } else {
            print!(
                "{:<20} {:>6} {:>9} {:>6.0} ms {:>6.1} us {:>6.1} us {:>6.1} us {:>6.1} us {:>8} {:>7.0} | ",
                row.exhibit,
                row.bodies,
                row.colliders,
                row.load_ms + row.start_ms + row.instruments_ms,
                row.motion_us,
                row.still_us,
                row.breath_us,
                row.sound_us,
                row.substeps,
                row.real_time_factor
            );
            match &row.all {
                Some(LoadReport { times, worst_load, worst_at_s }) => println!(
                    "{:>6.0} us {:>6.0} us {:>6.0} us  {worst_load}, step {} ({worst_at_s:.2} s)",
                    times.p50_us, times.p99_us, times.p100_us, times.worst_step
                ),
                None => println!("none"),
            }
        }
    }
    if let (Some(within), false) = (within, late.is_empty()) {
        return Err(Failure::input(format!("steps take longer than {within} ms: {}", late.join(", "))));
    }
    Ok(())
}

fn measure(exhibit: &Arc<Exhibit>, seconds: f64, seeds: u64) -> Result<Row, Failure> {
    let steps = (seconds * STEPS_PER_SECOND as f64).ceil() as u64;
    let blow = [Command::Blow(Some(HARDEST_BREATH))];
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
    let folder = exhibit.folder.clone();
    let load_ms = best_ms(|| soffio_exhibit::load(&folder));
    let start_ms = best_ms(|| Simulation::new(exhibit.clone(), still));
    let instruments_ms = best_ms(|| Synth::new(SAMPLE_RATE, &exhibit.instruments, still.seed));
    let times: Vec<LoadTimes> =
        loads(exhibit, seeds, seconds).into_iter().map(|load| LoadTimes::measure(exhibit, load, ROUNDS)).collect();
    let of = |kind: fn(&StressLoad) -> bool| LoadReport::of(times.iter().filter(|times| kind(&times.load)));
    Ok(Row {
        hard_breath: of(|load| matches!(load, StressLoad::Breath(_))),
        drag: of(|load| matches!(load, StressLoad::Drag)),
        assembly: of(|load| matches!(load, StressLoad::Assembly(_))),
        all: LoadReport::of(&times),
        exhibit: exhibit.id.clone(),
        bodies: exhibit.bodies.len(),
        colliders: exhibit.colliders.len(),
        motion_us,
        still_us,
        breath_us,
        sound_us,
        substeps,
        load_ms,
        start_ms,
        instruments_ms,
        real_time_factor: 1e6 / (STEPS_PER_SECOND as f64 * (breath_us + sound_us)),
    })
}

/// ms to make something, best of the rounds.
fn best_ms<T>(make: impl Fn() -> T) -> f64 {
    (0..ROUNDS).map(|_| 1e3 * timed(|| black_box(make())).0).fold(f64::INFINITY, f64::min)
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

//! Cost of position-based motion: a mobile of 127 joints that is dragged by one plate, compared with a published value, and
//! shipped exhibits compared with dynamics, step by step in turns.

use std::hint::black_box;
use std::sync::Arc;

use cpu_time::ThreadTime;
use serde::Serialize;

use crate::commands::failure::{Failure, Outcome};
use crate::commands::setup::open;
use soffio_exhibit::Exhibit;
use soffio_math::{DVec3, sincos};
use soffio_multibody::dynamics::{Dynamics, Integrator, Solver};
use soffio_multibody::procedural::{GrabTarget, PositionSolver, Procedural};
use soffio_offline::load::HARDEST_BREATH;
use soffio_offline::scene::make;
use soffio_simulation::{Command, MotionMode, STEPS_PER_SECOND, Settings, Simulation, StepInput};

/// The mobile: its joints, and the seed of its sizes.
const JOINTS: usize = 127;
const SEED: u64 = 1;
/// The plate goes round an ellipse of this half width and height, m, at this rate, rad/s: 0.3 m/s at most.
const WIDE: f64 = 0.15;
const HIGH: f64 = 0.08;
const RATE: f64 = 2.0;
/// A frame is a step of the simulation, s.
const DT: f64 = 1.0 / STEPS_PER_SECOND as f64;
/// Each frame's least time of the rounds counts, as other load on the machine can only add.
const ROUNDS: usize = 5;
/// A mobile of 127 constraints by position-based rigid body dynamics, µs a step (C. Deul, P. Charrier, J. Bender,
/// Computer Animation and Virtual Worlds 2014).
const PUBLISHED: f64 = 830.0;
/// Share of the cost of dynamics below which the kiosk's governor may choose position-based motion.
const CHEAPER: f64 = 0.7;

/// The drag.
#[derive(Serialize)]
struct Drag {
    joints: usize,
    /// Frame, s.
    dt: f64,
    method: &'static str,
    /// Time of a frame, µs of thread CPU time: median and maximum.
    median_us: f64,
    most_us: f64,
    /// Passes of a frame: mean, and most.
    passes: f64,
    most_passes: u32,
    /// Worst joint and worst miss of any frame, m.
    residual_m: f64,
    missed_m: f64,
    /// The published time over the median.
    ratio: f64,
}

/// An exhibit with dynamics and with position-based motion.
#[derive(Serialize)]
struct Beside {
    exhibit: String,
    bodies: usize,
    /// Median time of a step, µs.
    dynamic_us: f64,
    position_based_us: f64,
    procedural_us: f64,
    /// Ratios to dynamics.
    position_based_ratio: f64,
    procedural_ratio: f64,
    /// The first ratio in a hard breath, including the wind, as the kiosk's governor measures it; and whether the governor may
    /// choose position-based motion.
    breath_ratio: f64,
    governor_may_choose: bool,
}

/// Measures and prints.
pub fn run(names: &[String], seconds: f64, json: bool) -> Outcome {
    for method in [PositionSolver::TreeSolve, PositionSolver::Relaxation] {
        let drag = drag(seconds, method);
        if json {
            println!("{}", serde_json::to_string(&drag).map_err(Failure::input)?);
        } else {
            println!(
                "drag of {} joints, {:<14} frame {:.5} s: {:>6.1} us (at most {:.1}), {:.2} passes (at most {}), joints \
                 {:.1e} m, hand {:.1e} m; published {PUBLISHED} us: x {:.1}",
                drag.joints,
                drag.method,
                drag.dt,
                drag.median_us,
                drag.most_us,
                drag.passes,
                drag.most_passes,
                drag.residual_m,
                drag.missed_m,
                drag.ratio
            );
        }
    }
    let names = if names.is_empty() { soffio_exhibit::ids() } else { names.to_vec() };
    for name in names {
        let row = beside(&open(&name)?, seconds);
        if json {
            println!("{}", serde_json::to_string(&row).map_err(Failure::input)?);
        } else {
            println!(
                "{:<20} {:>3} bodies: dynamics {:>6.1} us a step, position-based {:>6.1} us (x {:.2}), procedural {:>6.1} us (x {:.2}); \
                 in a hard breath x {:.2}{}",
                row.exhibit,
                row.bodies,
                row.dynamic_us,
                row.position_based_us,
                row.position_based_ratio,
                row.procedural_us,
                row.procedural_ratio,
                row.breath_ratio,
                if row.governor_may_choose { "" } else { ", not worth it" }
            );
        }
    }
    Ok(())
}

fn name(method: PositionSolver) -> &'static str {
    match method {
        PositionSolver::TreeSolve => MotionMode::PositionBased.name(),
        PositionSolver::Relaxation => MotionMode::Procedural.name(),
    }
}

/// Drags the last plate of the mobile, which starts at rest.
fn drag(seconds: f64, method: PositionSolver) -> Drag {
    let mut scene = make::mobile(JOINTS, SEED);
    for body in &mut scene.bodies {
        (body.linvel, body.angvel) = ([0.0; 3], [0.0; 3]);
    }
    let start = scene.dynamics(Integrator::Auto, Solver::Sparse);
    let body = JOINTS - 1;
    let rest = start.bodies[body].position;
    let point = start.bodies[body].pose().inverse_point(rest);
    let place = |t: f64| {
        let (s, c) = sincos(RATE * t);
        rest + DVec3::new(WIDE * s, HIGH * (1.0 - c), 0.0)
    };
    let frames = (seconds / DT).ceil() as usize;
    let mut times = vec![f64::INFINITY; frames];
    let mut row = Drag {
        joints: start.system().joints().len(),
        dt: DT,
        method: name(method),
        median_us: 0.0,
        most_us: 0.0,
        passes: 0.0,
        most_passes: 0,
        residual_m: 0.0,
        missed_m: 0.0,
        ratio: 0.0,
    };
    for _ in 0..ROUNDS {
        let (mut dynamics, mut impacts) = (scene.dynamics(Integrator::Auto, Solver::Sparse), Vec::new());
        let mut mover = mover(&dynamics, method);
        let still = vec![[0.0; 6]; dynamics.bodies.len()];
        row.passes = 0.0;
        for (frame, best) in times.iter_mut().enumerate() {
            let grabs = [GrabTarget { body, point, target: place(DT * (frame + 1) as f64) }];
            let began = ThreadTime::now();
            black_box(mover.step(&mut dynamics, DT, &still, &grabs, &mut impacts));
            *best = best.min(1e6 * began.elapsed().as_secs_f64());
            let report = mover.report();
            row.passes += f64::from(report.passes) / frames as f64;
            row.most_passes = row.most_passes.max(report.passes);
            row.residual_m = row.residual_m.max(dynamics.joint_error());
            row.missed_m = row.missed_m.max(report.grab_error);
        }
    }
    row.most_us = times.iter().copied().fold(0.0, f64::max);
    row.median_us = median(&mut times);
    row.ratio = PUBLISHED / row.median_us;
    row
}

fn mover(dynamics: &Dynamics, method: PositionSolver) -> Procedural {
    Procedural::new(dynamics, soffio_multibody::procedural::Settings { method, ..Default::default() })
}

fn median(times: &mut [f64]) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Runs an exhibit in each kind of motion: without wind, and in a hard breath.
fn beside(exhibit: &Arc<Exhibit>, seconds: f64) -> Beside {
    const STILL: [MotionMode; 3] = [MotionMode::Dynamic, MotionMode::PositionBased, MotionMode::Procedural];
    const BREATH: [MotionMode; 2] = [MotionMode::Dynamic, MotionMode::PositionBased];
    let without_wind = Settings { wind: false, ..Settings::default() };
    let [dynamic_us, position_based_us, procedural_us] = medians(exhibit, seconds, without_wind, STILL, None);
    let [dynamic, position_based] = medians(exhibit, seconds, Settings::default(), BREATH, Some(HARDEST_BREATH));
    let breath_ratio = position_based / dynamic;
    Beside {
        exhibit: exhibit.id.clone(),
        bodies: exhibit.bodies.len(),
        dynamic_us,
        position_based_us,
        procedural_us,
        position_based_ratio: position_based_us / dynamic_us,
        procedural_ratio: procedural_us / dynamic_us,
        breath_ratio,
        governor_may_choose: breath_ratio <= CHEAPER,
    }
}

/// µs of the middle step in each kind of motion, one step of each in turn, under a breath of this speed (m/s).
fn medians<const N: usize>(
    exhibit: &Arc<Exhibit>,
    seconds: f64,
    settings: Settings,
    modes: [MotionMode; N],
    breath: Option<f64>,
) -> [f64; N] {
    let steps = (seconds * STEPS_PER_SECOND as f64).ceil() as usize;
    let mut times = modes.map(|_| vec![f64::INFINITY; steps]);
    for _ in 0..ROUNDS {
        let mut runs = modes.map(|mode| (mode, Simulation::new(exhibit.clone(), settings)));
        for step in 0..steps {
            let blow = [Command::Blow(breath)];
            let commands = if step == 0 { &blow[..] } else { &[] };
            for ((mode, run), times) in runs.iter_mut().zip(&mut times) {
                let began = ThreadTime::now();
                run.step(&StepInput { mode: Some(*mode), commands, ..StepInput::default() });
                times[step] = times[step].min(1e6 * began.elapsed().as_secs_f64());
            }
        }
    }
    times.map(|mut times| median(&mut times))
}

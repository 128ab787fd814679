//! Runs a scene in an engine: rounds that measure total time, one pass that measures the motion, and rounds that
//! measure each step's time.
//!
//! Time is processor time of the thread, and the best of the rounds counts, since other work on the machine only adds
//! time. The rounds of several engines can alternate ([`Best::run_round`]), so that a slow spell of the machine affects
//! all of them.

use std::hint::black_box;

use cpu_time::ThreadTime;

use super::format::PhysicsScene;
use super::measure::{BodyState, Observer, Report, hash};
use super::record::BenchRecord;
use super::times::StepTimes;
use soffio_multibody::dynamics::{Dynamics, Impact, Integrator, Solver};

/// Number of timing rounds.
pub const ROUNDS: usize = 3;
/// Processor time of one round, s: a round ends after it, or with the scene.
const ROUND_TIME: f64 = 2.0;
/// Processor time between two readings of the clock, s; a reading costs less than a thousandth of it.
const CLOCK_INTERVAL: f64 = 1e-3;

/// A scene in an engine.
pub trait Engine {
    /// Advances by one step; false if the engine failed.
    fn step(&mut self) -> bool;
    /// Number of substeps of the last step.
    fn substeps(&self) -> u32;
    /// Number of sleeping bodies after the last step.
    fn asleep(&self) -> usize {
        0
    }
    /// The bodies' states in the scene's order.
    fn states(&self, out: &mut Vec<BodyState>);
}

/// This engine as an [`Engine`].
pub struct Soffio {
    dynamics: Dynamics,
    dt: f64,
    still: Vec<[f64; 6]>,
    impacts: Vec<Impact>,
}

impl Soffio {
    /// A scene in its start state, simulated in steps of `dt` s.
    pub fn new(scene: &PhysicsScene, dt: f64, integrator: Integrator, solver: Solver) -> Self {
        let dynamics = scene.dynamics(integrator, solver);
        Self { still: vec![[0.0; 6]; scene.bodies.len()], dynamics, dt, impacts: Vec::new() }
    }
}

impl Engine for Soffio {
    fn step(&mut self) -> bool {
        self.dynamics.step(self.dt, &self.still, &mut self.impacts).is_none()
    }

    fn substeps(&self) -> u32 {
        self.dynamics.substeps()
    }

    fn asleep(&self) -> usize {
        (0..self.dynamics.bodies.len()).filter(|&body| self.dynamics.is_asleep(body)).count()
    }

    fn states(&self, out: &mut Vec<BodyState>) {
        out.clear();
        out.extend(self.dynamics.bodies.iter().map(BodyState::from));
    }
}

/// Limits of a measurement.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Most simulated seconds.
    pub seconds: f64,
    /// Most processor time of the pass that measures the motion, s.
    pub budget: f64,
}

/// Result of an observed run.
#[derive(Clone, Debug)]
pub struct Observation {
    /// Simulated time, s.
    pub sim_s: f64,
    /// Mean substeps of a step.
    pub substeps: f64,
    /// Measures of the motion.
    pub report: Report,
    /// Number of sleeping bodies at the end.
    pub asleep: usize,
    /// Time of each step.
    pub times: StepTimes,
}

/// Runs `engine` in steps of `dt` and observes each; ends with the scene, at a limit, or when the motion diverges.
pub fn observe(scene: &PhysicsScene, engine: &mut (impl Engine + ?Sized), dt: f64, limits: Limits) -> Observation {
    let mut observer = Observer::new(scene);
    observer.set_end_time(limits.seconds);
    let mut times = StepTimes::default();
    let mut states = Vec::with_capacity(scene.bodies.len());
    let start = ThreadTime::now();
    let (mut steps, mut substeps) = (0, 0);
    engine.states(&mut states);
    while steps < step_count(scene, dt, limits.seconds) {
        let valid = times.time(|| engine.step());
        steps += 1;
        substeps += u64::from(engine.substeps());
        engine.states(&mut states);
        let t = steps as f64 * dt;
        if !valid {
            observer.set_diverged(t);
        }
        if !observer.observe(t, &states) || start.elapsed().as_secs_f64() > limits.budget {
            break;
        }
    }
    let substeps = substeps as f64 / steps.max(1) as f64;
    Observation { sim_s: steps as f64 * dt, substeps, report: observer.report(&states), asleep: engine.asleep(), times }
}

/// Number of steps of `dt` in the scene's duration or in `seconds`, whichever is less; at least one.
pub fn step_count(scene: &PhysicsScene, dt: f64, seconds: f64) -> u64 {
    (scene.duration.min(seconds) / dt).round().max(1.0) as u64
}

/// One timing round.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Timed {
    steps: u64,
    /// Processor time of all steps, s.
    seconds: f64,
    /// Hash of the final states.
    hash: u64,
}

/// Runs an engine for at most `steps` steps and about `most` s of processor time; at least one step.
fn time_round(engine: &mut (impl Engine + ?Sized), steps: u64, most: f64) -> Timed {
    let (mut done, mut chunk) = (0, 1);
    let start = ThreadTime::now();
    let mut elapsed = 0.0;
    loop {
        let before = elapsed;
        let now = chunk.min(steps - done);
        for _ in 0..now {
            black_box(engine.step());
        }
        done += now;
        elapsed = start.elapsed().as_secs_f64();
        if done >= steps || elapsed >= most {
            break;
        }
        if elapsed - before < CLOCK_INTERVAL {
            chunk *= 2;
        }
    }
    let mut states = Vec::new();
    engine.states(&mut states);
    Timed { steps: done, seconds: elapsed, hash: hash(&states) }
}

/// The best of several rounds of the same steps.
#[derive(Clone, Copy, Debug, Default)]
pub struct Best {
    first: Option<Timed>,
    seconds: f64,
    agree: bool,
}

impl Best {
    /// Runs one more round of `steps` steps. If the first exceeds the time of a round, it ends there, and the others
    /// run as many steps.
    pub fn run_round(&mut self, engine: &mut (impl Engine + ?Sized), steps: u64, limits: Limits) {
        match self.first {
            None => {
                let timed = time_round(engine, steps, limits.budget.min(ROUND_TIME));
                *self = Self { first: Some(timed), seconds: timed.seconds, agree: true };
            }
            Some(first) => {
                let timed = time_round(engine, first.steps, f64::INFINITY);
                self.seconds = self.seconds.min(timed.seconds);
                self.agree &= timed.hash == first.hash;
            }
        }
    }

    /// Steps of each round.
    pub fn steps(&self) -> u64 {
        self.first.map_or(0, |timed| timed.steps)
    }

    /// Are the final states of all rounds bit-identical?
    pub fn agree(&self) -> bool {
        self.agree
    }

    /// µs per step.
    pub fn us_per_step(&self) -> f64 {
        1e6 * self.seconds / self.steps() as f64
    }
}

/// Measures this engine on a scene: timing rounds, then the observed pass.
pub fn measure(scene: &PhysicsScene, dt: f64, integrator: Integrator, solver: Solver, limits: Limits) -> BenchRecord {
    let engine = || Soffio::new(scene, dt, integrator, solver);
    let mut best = Best::default();
    for _ in 0..ROUNDS {
        best.run_round(&mut engine(), step_count(scene, dt, limits.seconds), limits);
    }
    let mut watched = observe(scene, &mut engine(), dt, limits);
    for _ in 1..ROUNDS {
        watched.times.repeat(&mut engine());
    }
    let config = config(integrator, solver);
    BenchRecord::new(["soffio", env!("CARGO_PKG_VERSION"), &config], scene, dt, &best, &watched)
}

/// Name of this engine's settings in a record.
pub fn config(integrator: Integrator, solver: Solver) -> String {
    let integrator = match integrator {
        Integrator::Auto => "auto",
        Integrator::Fast => "fast",
        Integrator::RungeKutta => "runge-kutta",
        Integrator::Precise => "precise",
    };
    let solver = match solver {
        Solver::Sparse => "sparse",
        Solver::Dense => "dense",
    };
    format!("{integrator}/{solver}")
}

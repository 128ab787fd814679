//! Runs a scene in an engine: rounds that measure only time, one pass that measures what comes out, and rounds that
//! measure every step's time.
//!
//! Time is processor time of the thread, so other work on the machine counts less; the best of the rounds is told, as
//! other work can only add. The rounds of several engines can take turns ([`Best::round`]), so that a slow spell of the
//! machine hits all of them.

use std::hint::black_box;

use cpu_time::ThreadTime;

use super::format::Scene;
use super::measure::{Observer, Report, State, hash};
use super::row::Row;
use super::times::StepTimes;
use soffio_multibody::dynamics::{Dynamics, Impact, Integrator, Solver};

/// Rounds of a measurement of time.
pub const ROUNDS: usize = 3;
/// Processor time of one round, s: a round ends here, or with the scene.
const ROUND_TIME: f64 = 2.0;
/// Processor time between two looks at the clock, s: a look costs less than a thousandth of it.
const LOOK: f64 = 1e-3;

/// A scene in an engine.
pub trait Engine {
    /// Advances by one step; false if the engine had to give up the motion.
    fn step(&mut self) -> bool;
    /// Substeps that the last step took.
    fn substeps(&self) -> u32;
    /// Bodies that sleep after the last step.
    fn asleep(&self) -> usize {
        0
    }
    /// The bodies' states in the scene's order.
    fn states(&self, out: &mut Vec<State>);
}

/// This engine.
pub struct Soffio {
    dynamics: Dynamics,
    dt: f64,
    still: Vec<[f64; 6]>,
    impacts: Vec<Impact>,
}

impl Soffio {
    /// A scene at its start, to be run in steps of `dt` s.
    pub fn new(scene: &Scene, dt: f64, integrator: Integrator, solver: Solver) -> Self {
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

    fn states(&self, out: &mut Vec<State>) {
        out.clear();
        out.extend(self.dynamics.bodies.iter().map(State::from));
    }
}

/// How long a measurement may take.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Most simulated seconds.
    pub seconds: f64,
    /// Most processor time of the pass that measures the motion, s.
    pub budget: f64,
}

/// A motion that was watched.
#[derive(Clone, Debug)]
pub struct Watched {
    /// Simulated time, s.
    pub sim_s: f64,
    /// Mean substeps of a step.
    pub substeps: f64,
    /// What it came to.
    pub report: Report,
    /// Bodies that slept at the end.
    pub asleep: usize,
    /// Time of each step.
    pub times: StepTimes,
}

/// Runs `engine` in steps of `dt` and watches each; it ends with the scene, at a limit, or when the motion diverges.
pub fn watch(scene: &Scene, engine: &mut (impl Engine + ?Sized), dt: f64, limits: Limits) -> Watched {
    let mut observer = Observer::new(scene);
    observer.ends(limits.seconds);
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
            observer.gave_up(t);
        }
        if !observer.see(t, &states) || start.elapsed().as_secs_f64() > limits.budget {
            break;
        }
    }
    let substeps = substeps as f64 / steps.max(1) as f64;
    Watched { sim_s: steps as f64 * dt, substeps, report: observer.report(&states), asleep: engine.asleep(), times }
}

/// Steps of `dt` in the scene's time or `seconds`, whichever is less; one at least.
pub fn step_count(scene: &Scene, dt: f64, seconds: f64) -> u64 {
    (scene.duration.min(seconds) / dt).round().max(1.0) as u64
}

/// One measurement of time.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Timed {
    steps: u64,
    /// Processor time of them all, s.
    seconds: f64,
    /// Bits of the states after the last one.
    hash: u64,
}

/// Runs an engine for at most `steps` steps and about `most` s of processor time; one step at least.
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
        if elapsed - before < LOOK {
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
    /// Runs one more round of `steps` steps. If the first takes longer than a round may, it ends there, and the others
    /// run the steps that it ran.
    pub fn round(&mut self, engine: &mut (impl Engine + ?Sized), steps: u64, limits: Limits) {
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

    /// Did all rounds end in the same bits?
    pub fn agree(&self) -> bool {
        self.agree
    }

    /// µs per step.
    pub fn us_per_step(&self) -> f64 {
        1e6 * self.seconds / self.steps() as f64
    }
}

/// Measures this engine on a scene: rounds of time, then the pass that watches.
pub fn measure(scene: &Scene, dt: f64, integrator: Integrator, solver: Solver, limits: Limits) -> Row {
    let engine = || Soffio::new(scene, dt, integrator, solver);
    let mut best = Best::default();
    for _ in 0..ROUNDS {
        best.round(&mut engine(), step_count(scene, dt, limits.seconds), limits);
    }
    let mut watched = watch(scene, &mut engine(), dt, limits);
    for _ in 1..ROUNDS {
        watched.times.again(&mut engine());
    }
    let config = config(integrator, solver);
    Row::new(["soffio", env!("CARGO_PKG_VERSION"), &config], scene, dt, &best, &watched)
}

/// How this engine's settings are called in a row.
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

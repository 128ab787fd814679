//! Stress loads: simulation inputs under which an exhibit must meet its deadline, and the time of each step.
//!
//! | load | what happens |
//! |---|---|
//! | assembly | the exhibit is shown and assembles from parts that a seed has scattered |
//! | breath | a breath of 17 m/s at the lips without end |
//! | drag | a pointer grabs one body after another at its centre, drags it back and forth, and releases it |
//!
//! The exhibit keeps its own motion mode: a late step does not switch it.

use std::fmt;
use std::sync::Arc;

use serde::Serialize;

use super::scene::times::{StepTimes, TimesReport};
use soffio_exhibit::Exhibit;
use soffio_math::{PI, sin};
use soffio_simulation::{ASSEMBLY_DURATION, Command, PointerGrab, STEPS_PER_SECOND, Settings, Simulation, StepInput};

/// Speed of the hardest breath at the lips, m/s.
pub const HARDEST_BREATH: f64 = 17.0;
/// Time that is simulated after the assembly, s.
const BREATH_START: f64 = 0.5;
/// Most bodies that are dragged.
const MAX_GRABBED: usize = 8;
/// Time that each body is dragged, and time that it flies before the next one is grabbed, s.
const GRAB_SECONDS: f64 = 1.0;
const THROW_SECONDS: f64 = 0.25;
/// Frequencies (Hz) of the drag, horizontal and vertical, and its amplitudes in picture widths and heights: faster than
/// any body can follow.
const DRAG_FREQUENCIES: [f64; 2] = [2.0, 3.0];
const DRAG_AMPLITUDES: [f64; 2] = [0.4, 0.3];

/// A stress load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StressLoad {
    /// Assembly from parts scattered by this seed.
    Assembly(u64),
    /// The hardest breath for this time, s.
    Breath(f64),
    /// Fast drags.
    Drag,
}

impl fmt::Display for StressLoad {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Assembly(seed) => write!(f, "assembly of seed {seed}"),
            Self::Breath(_) => write!(f, "hard breath"),
            Self::Drag => write!(f, "fast drag"),
        }
    }
}

/// All loads of an exhibit: breath, drag, and assemblies of so many seeds.
pub fn loads(exhibit: &Exhibit, seeds: u64, breath_seconds: f64) -> Vec<StressLoad> {
    let drag = (exhibit.touch.permitted && !movable(exhibit).is_empty()).then_some(StressLoad::Drag);
    let assembly = (0..if exhibit.assembles { seeds } else { 0 }).map(StressLoad::Assembly);
    [StressLoad::Breath(breath_seconds)].into_iter().chain(drag).chain(assembly).collect()
}

/// Indices of the bodies that can be grabbed.
fn movable(exhibit: &Exhibit) -> Vec<usize> {
    let is_kinematic = |body: usize| exhibit.drives.iter().any(|drive| drive.body == body);
    (0..exhibit.bodies.len()).filter(|&body| !is_kinematic(body)).collect()
}

/// An exhibit under a load.
pub struct LoadRun {
    /// The simulation of the exhibit.
    pub simulation: Simulation,
    load: StressLoad,
    /// Bodies that are dragged, in turn.
    bodies: Vec<usize>,
    step: usize,
}

impl LoadRun {
    /// Starts a run of the exhibit under this load, with the default settings, which are a kiosk's.
    pub fn new(exhibit: &Arc<Exhibit>, load: StressLoad) -> Self {
        let movable = movable(exhibit);
        let dragged = MAX_GRABBED.min(movable.len());
        let bodies = (0..dragged).map(|i| movable[i * movable.len() / dragged]).collect();
        Self { simulation: Simulation::new(exhibit.clone(), Settings::default()), load, bodies, step: 0 }
    }

    /// Number of simulation steps (1/240 s) of the whole run.
    pub fn steps(&self) -> usize {
        let seconds = match self.load {
            StressLoad::Assembly(_) => ASSEMBLY_DURATION + BREATH_START,
            StressLoad::Breath(seconds) => seconds,
            StressLoad::Drag => self.bodies.len() as f64 * (GRAB_SECONDS + THROW_SECONDS),
        };
        (seconds * STEPS_PER_SECOND as f64).ceil() as usize
    }

    /// Advances by a step.
    pub fn step(&mut self) {
        let command = match self.load {
            StressLoad::Assembly(seed) => Some(Command::Assemble(seed)),
            StressLoad::Breath(_) => Some(Command::Blow(Some(HARDEST_BREATH))),
            StressLoad::Drag => None,
        };
        let command = command.filter(|_| self.step == 0);
        let hand = (self.load == StressLoad::Drag).then(|| self.hand()).flatten();
        self.simulation.step(&StepInput {
            commands: command.as_slice(),
            pointer_grabs: hand.as_slice(),
            ..StepInput::default()
        });
        self.step += 1;
    }

    /// The pointer grab in the coming step; `None` while the released body flies.
    fn hand(&self) -> Option<PointerGrab> {
        let t = self.step as f64 / STEPS_PER_SECOND as f64;
        let turn = (t / (GRAB_SECONDS + THROW_SECONDS)) as usize;
        let held = t - turn as f64 * (GRAB_SECONDS + THROW_SECONDS);
        let body = *self.bodies.get(turn)?;
        let swing = |k: usize| 0.5 + DRAG_AMPLITUDES[k] * sin(2.0 * PI * DRAG_FREQUENCIES[k] * held);
        (held < GRAB_SECONDS).then(|| PointerGrab { id: turn as u64, at: [swing(0), swing(1)], body: Some(body) })
    }
}

/// Step times under one load.
pub struct LoadTimes {
    /// The load.
    pub load: StressLoad,
    /// The least time of each step over all rounds.
    pub times: StepTimes,
}

impl LoadTimes {
    /// Runs a load `rounds` times, at least once.
    pub fn measure(exhibit: &Arc<Exhibit>, load: StressLoad, rounds: usize) -> Self {
        let mut times = StepTimes::default();
        let mut run = LoadRun::new(exhibit, load);
        (0..run.steps()).for_each(|_| times.time(|| run.step()));
        for _ in 1..rounds {
            let mut run = LoadRun::new(exhibit, load);
            times.repeat_with(|_| run.step());
        }
        Self { load, times }
    }
}

/// Summary of the step times under several loads.
#[derive(Clone, Debug, Serialize)]
pub struct LoadReport {
    /// Times of all steps; the slowest step counts from the start of its load.
    #[serde(flatten)]
    pub times: TimesReport,
    /// Load of the slowest step.
    pub worst_load: String,
    /// Start of the slowest step within its load, s.
    pub worst_at_s: f64,
}

impl LoadReport {
    /// The summary of some loads; `None` where there are none.
    pub fn of<'a>(loads: impl IntoIterator<Item = &'a LoadTimes>) -> Option<Self> {
        let loads: Vec<&LoadTimes> = loads.into_iter().collect();
        let all: StepTimes = loads.iter().flat_map(|load| load.times.us().iter().copied()).collect();
        let mut times = all.report();
        let mut worst = times.worst_step;
        let load = loads.iter().find(|load| {
            let steps = load.times.us().len();
            let here = worst < steps;
            worst -= if here { 0 } else { steps };
            here
        })?;
        times.worst_step = worst;
        let worst_at_s = worst as f64 / STEPS_PER_SECOND as f64;
        Some(Self { times, worst_load: load.load.to_string(), worst_at_s })
    }
}

//! The loads under which an exhibit must keep up with time, as inputs of a simulation, and the time that each step takes.
//!
//! | load | what happens |
//! |---|---|
//! | assembly | the exhibit comes on: its parts gather from where a seed scatters them, and it begins |
//! | breath | a breath of 17 m/s at the lips that does not end |
//! | drag | a hand takes one body after another by its centre, drags it back and forth, and lets it go |
//!
//! Motion is the exhibit's own: nothing chooses another kind of motion when a step is slow.

use std::fmt;
use std::sync::Arc;

use serde::Serialize;

use super::scene::times::{StepTimes, TimesReport};
use soffio_exhibit::Exhibit;
use soffio_math::{PI, sin};
use soffio_simulation::{ASSEMBLY_DURATION, Command, PointerGrab, STEPS_PER_SECOND, Settings, Simulation, StepInput};

/// A hard breath, m/s at the lips.
pub const HARD: f64 = 17.0;
/// What is watched after the parts have gathered, s.
const BEGINS: f64 = 0.5;
/// Bodies that are dragged, at most.
const DRAGGED: usize = 8;
/// For how long each is held, and how long it then flies before the next one is taken, s.
const HELD: f64 = 1.0;
const THROWN: f64 = 0.25;
/// Swings of the hand to the side and up and down, Hz, and how wide, picture widths and heights: faster than anything can
/// follow.
const SWINGS: [f64; 2] = [2.0, 3.0];
const WIDE: [f64; 2] = [0.4, 0.3];

/// A load.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Load {
    /// The parts gather from where this seed scatters them.
    Assembly(u64),
    /// A hard breath of so many seconds.
    Breath(f64),
    /// A fast hand.
    Drag,
}

impl fmt::Display for Load {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Assembly(seed) => write!(f, "assembly of seed {seed}"),
            Self::Breath(_) => write!(f, "hard breath"),
            Self::Drag => write!(f, "fast drag"),
        }
    }
}

/// All loads that an exhibit can be under: breath, drag, and assembly of so many seeds.
pub fn loads(exhibit: &Exhibit, seeds: u64, breath_seconds: f64) -> Vec<Load> {
    let drag = (exhibit.touch.permitted && !movable(exhibit).is_empty()).then_some(Load::Drag);
    let assembly = (0..if exhibit.gathers { seeds } else { 0 }).map(Load::Assembly);
    [Load::Breath(breath_seconds)].into_iter().chain(drag).chain(assembly).collect()
}

/// Bodies that a hand can take.
fn movable(exhibit: &Exhibit) -> Vec<usize> {
    let driven = |body: usize| exhibit.drives.iter().any(|drive| drive.body == body);
    (0..exhibit.bodies.len()).filter(|&body| !driven(body)).collect()
}

/// An exhibit under a load, from its start.
pub struct LoadRun {
    /// The exhibit in motion.
    pub simulation: Simulation,
    load: Load,
    /// Bodies that are dragged, in turn.
    bodies: Vec<usize>,
    step: usize,
}

impl LoadRun {
    /// At the start, with the settings of a kiosk.
    pub fn new(exhibit: &Arc<Exhibit>, load: Load) -> Self {
        let movable = movable(exhibit);
        let dragged = DRAGGED.min(movable.len());
        let bodies = (0..dragged).map(|i| movable[i * movable.len() / dragged]).collect();
        Self { simulation: Simulation::new(exhibit.clone(), Settings::default()), load, bodies, step: 0 }
    }

    /// Steps of the whole run.
    pub fn steps(&self) -> usize {
        let seconds = match self.load {
            Load::Assembly(_) => ASSEMBLY_DURATION + BEGINS,
            Load::Breath(seconds) => seconds,
            Load::Drag => self.bodies.len() as f64 * (HELD + THROWN),
        };
        (seconds * STEPS_PER_SECOND as f64).ceil() as usize
    }

    /// Advances by a step.
    pub fn step(&mut self) {
        let command = match self.load {
            Load::Assembly(seed) => Some(Command::Assemble(seed)),
            Load::Breath(_) => Some(Command::Blow(Some(HARD))),
            Load::Drag => None,
        };
        let command = command.filter(|_| self.step == 0);
        let hand = (self.load == Load::Drag).then(|| self.hand()).flatten();
        self.simulation.step(&StepInput {
            commands: command.as_slice(),
            pointer_grabs: hand.as_slice(),
            ..StepInput::default()
        });
        self.step += 1;
    }

    /// The hand in the coming step; `None` while what was thrown flies.
    fn hand(&self) -> Option<PointerGrab> {
        let t = self.step as f64 / STEPS_PER_SECOND as f64;
        let turn = (t / (HELD + THROWN)) as usize;
        let held = t - turn as f64 * (HELD + THROWN);
        let body = *self.bodies.get(turn)?;
        let swing = |k: usize| 0.5 + WIDE[k] * sin(2.0 * PI * SWINGS[k] * held);
        (held < HELD).then(|| PointerGrab { id: turn as u64, at: [swing(0), swing(1)], body: Some(body) })
    }
}

/// Step times under one load.
pub struct LoadTimes {
    /// Which.
    pub load: Load,
    /// Of each step the least time of all rounds.
    pub times: StepTimes,
}

impl LoadTimes {
    /// Runs a load so many times, once at least.
    pub fn measure(exhibit: &Arc<Exhibit>, load: Load, rounds: usize) -> Self {
        let mut times = StepTimes::default();
        let mut run = LoadRun::new(exhibit, load);
        (0..run.steps()).for_each(|_| times.time(|| run.step()));
        for _ in 1..rounds {
            let mut run = LoadRun::new(exhibit, load);
            times.again_by(|_| run.step());
        }
        Self { load, times }
    }
}

/// Step times under several loads, in short.
#[derive(Clone, Debug, Serialize)]
pub struct LoadReport {
    /// Of all steps together; the worst is counted from the beginning of its load.
    #[serde(flatten)]
    pub times: TimesReport,
    /// The load of the longest step.
    pub worst_load: String,
    /// When it began within the load, s.
    pub worst_at_s: f64,
}

impl LoadReport {
    /// Of some loads; `None` where there are none.
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

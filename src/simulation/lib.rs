//! The simulation: everything that moves, and the only way time advances.
//!
//! One step is 1/240 s and 200 audio samples: breath → aim → wind → motion with its impacts → events and sounds →
//! dust. Whatever varies is in [`StepInput`]; nothing here reads a clock, a file or a device, so a live run and an
//! offline one with the same inputs are the same run, bit for bit.
//!
//! It never draws, plays or records: it returns a [`Snapshot`] for pictures, sound commands for a synthesizer, and events.
//! After its first steps it allocates nothing.
//!
//! | type | is |
//! |---|---|
//! | [`Simulation`] | all that moves of one exhibit |
//! | [`StepInput`] | everything that may differ between two steps: microphone, pointer, hands, commands, mode |
//! | [`Settings`] | constants of a run: seed, breath profile, wind |
//! | [`Snapshot`], [`Event`] | what a step leaves to see, and what happened in it |
//! | [`Script`] | inputs over time, one JSON object a line |
//! | [`record`] | the inputs of a live day, and their replay |
//!
//! ```
//! use std::path::Path;
//! use std::sync::Arc;
//!
//! use soffio_simulation::{Command, STEPS_PER_SECOND, Settings, Simulation, StepInput};
//!
//! let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../exhibits/pendulum");
//! let exhibit = Arc::new(soffio_exhibit::load(&folder).expect("a shipped exhibit"));
//! let run = || {
//!     let mut simulation = Simulation::new(exhibit.clone(), Settings::default());
//!     let blow = [Command::Blow(Some(6.0))]; // m/s at the lips, from now on
//!     simulation.step(&StepInput { commands: &blow, ..StepInput::default() });
//!     (1..STEPS_PER_SECOND).for_each(|_| simulation.step(&StepInput::default()));
//!     simulation.state_hash()
//! };
//! assert_eq!(run(), run(), "the same inputs are the same run, bit for bit");
//! ```

mod aim;
mod air;
mod calm;
mod carrying;
mod contact_sound;
mod emit;
mod event;
mod eye;
mod gather;
mod hands;
mod input;
mod inspect;
mod leaning;
mod merge;
mod motes;
mod motion;
mod onset;
mod rate;
pub mod record;
mod script;
mod snapshot;
mod sonify;
mod source;
mod start;
mod step;

pub use event::{Event, EventKind, Part};
pub use gather::LASTS as GATHERING_LASTS;
pub use hands::Hand;
pub use input::{CENTRE, Command, Microphone, MotionMode, Profile, Settings, StepInput};
pub use inspect::{BodyState, Inspection, JointState, Look, WindSample};
pub use motes::Mote;
pub use rate::{SAMPLE_RATE, SAMPLES_PER_STEP, STEPS_PER_SECOND};
pub use script::{Script, ScriptError};
pub use snapshot::{AimRing, BreathView, Diagnostics, Snapshot};
pub use start::start_dynamics;
pub use step::Simulation;

//! The simulation: everything that moves, at a fixed time step.
//!
//! One step is 1/240 s and 200 audio samples: breath → aim → wind → motion with its impacts → events and sounds → dust
//! particles. [`StepInput`] holds everything that varies. The crate reads no clock, file or device, so a live run and an offline
//! one with the same inputs agree bit for bit.
//!
//! It does not draw, play or record: it returns a [`Snapshot`] for pictures, sound commands for a synthesizer, and events.
//! [`Simulation::step`] says when a step allocates.
//!
//! | type | meaning |
//! |---|---|
//! | [`Simulation`] | one exhibit in motion |
//! | [`StepInput`] | inputs of one step: microphone, pointer, grabs, commands, solver |
//! | [`Settings`] | constants of a run: seed, breath profile, wind |
//! | [`Snapshot`], [`Event`] | state after a step, and its events |
//! | [`Script`] | actions over time, one JSON object a line |
//! | [`record`] | inputs of a live day, and their replay |
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
//! assert_eq!(run(), run(), "the same inputs give the same run, bit for bit");
//! ```

mod aim;
mod aim_assist;
mod air;
mod air_sound;
mod assembly;
mod camera;
mod charts;
mod clock_setting;
mod contact_sound;
mod dust_particles;
mod emit;
mod event;
mod idle_damping;
mod impact_merge;
mod input;
mod inspect;
mod motion;
mod motion_group;
mod motion_sound;
mod onset_compensation;
mod pointer_grabs;
mod rate;
pub mod record;
mod script;
mod signals;
mod snapshot;
mod sonify;
mod source;
mod start;
mod step;

pub use assembly::DURATION as ASSEMBLY_DURATION;
pub use charts::{CURVE_POINTS, CurveView};
pub use dust_particles::DustParticle;
pub use event::{Event, EventKind, EventSource};
pub use input::{CENTRE, Command, Microphone, MotionMode, Profile, Settings, StepInput};
pub use inspect::{BodyState, Inspection, InspectionScope, JointState, WindSample};
pub use pointer_grabs::PointerGrab;
pub use rate::{SAMPLE_RATE, SAMPLES_PER_STEP, STEPS_PER_SECOND};
pub use script::{Script, ScriptError};
pub use snapshot::{AimRing, BreathView, Diagnostics, Snapshot};
pub use start::start_dynamics;
pub use step::Simulation;

//! The simulation: everything that moves, and the only way time advances.
//!
//! One step is 1/240 s and 200 audio samples: breath → aim → wind → motion with its impacts → events and sounds →
//! dust. Whatever varies is in [`StepInput`]; nothing here reads a clock, a file or a device, so a live run and an
//! offline one with the same inputs are the same run, bit for bit.

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

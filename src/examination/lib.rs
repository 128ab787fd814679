//! Examination of a breath detector: breaths, draughts and noises with known answers, and a table with 95 % bounds.
//!
//! ```text
//! soundscape: Scenario, Breath, Draught → Stage → Microphone → Take ─┐
//! subject: Detector (any) ───────────────────────────────────────────┴→ listening → tally → table
//! ```
//!
//! [`battery::run`] runs everything over a [`subject::Detector`]. A breath is *clear* if its air has 1 m/s or more at a capsule and
//! lies 10 dB or more over the room in some octave band, after the microphone. It counts as detected if the detector reports a
//! speed between arrival and 0.3 s after the end, and none before the flow began at the lips.
//!
//! The sounds share nothing with those that train a detector. Takes run in parallel; the table does not depend on their order.
//!
//! ```no_run
//! use soffio_examination::battery::{Battery, run};
//! use soffio_examination::subject::Today;
//!
//! let table = run(&|rate| Box::new(Today::new(rate)), &Battery { size: 0.1, capsules: 1, seed: 1, only: None });
//! println!("{table}");
//! ```

pub mod battery;
mod breaths;
mod bystanders;
pub mod listening;
pub mod subject;
pub mod tally;

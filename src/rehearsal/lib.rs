//! Rehearsal of a synthetic gallery day: visitors, a crowd, staff and the kiosk's own echo around the whole pipeline, in a closed loop.
//! The kiosk is scored by its pictures and its sound.
//!
//! ```text
//! day (programme) → visitor ─┐
//!            crowd, air ─────┤ venue → microphone → kiosk_under_test ─┬→ video_observer → pictures ──┐
//!   echo_path ← loudspeaker ─┘                                       └→ audio_observer → output ────┴→ scorer → report
//!            ↑                                                                            │
//!            └────────────────────────────────────────────────────────────────────────────┘
//! ```
//!
//! Speakers, rooms and breaths use seeds that training never uses ([`FIRST_VALIDATION_SEED`](soffio_soundscape::FIRST_VALIDATION_SEED)).
//! The same seed gives the same day and, on one computer, the same report. Nothing reads a clock.
//!
//! It never opens a device: microphone, loudspeaker and time of day are computed. It writes no file; the program prints its
//! [`report`]. It draws pictures, so it needs a Vulkan driver, which may be a software one.
//!
//! The main types are [`Rehearsal`] (the settings), [`day::Day`] (the programme), [`visitor::Visit`] (one visitor) and [`scorer`]
//! (whether the exhibit responds). [`run()`] rehearses with pictures; [`run_detector()`] runs the detector alone over the same day.
//!
//! ```
//! use soffio_rehearsal::day::Day;
//!
//! // The programme of one hour with three exhibits; attract mode begins after two minutes.
//! let day = |seed| Day::new(seed, 3600.0, 3, Some(120.0));
//! assert!(!day(1).entries.is_empty());
//! let begins = |seed| day(seed).entries.iter().map(|entry| entry.visit.arrives).collect::<Vec<f64>>();
//! assert_eq!(begins(1), begins(1), "the same seed gives the same day");
//! assert_ne!(begins(1), begins(2));
//! ```

mod audio_observer;
mod blocks;
mod breath_snr;
mod control_run;
pub mod day;
pub mod detector_only;
mod echo_path;
mod kiosk_under_test;
mod loudness;
mod rate;
mod rehearsal;
pub mod report;
mod run;
pub mod scorer;
mod venue;
mod video_observer;
pub mod visitor;

pub use detector_only::run_detector;
pub use echo_path::ROOMS;
pub use rehearsal::{Rehearsal, RehearsalError, featured_exhibits};
pub use run::run;
pub use venue::{Crowd, recorded};

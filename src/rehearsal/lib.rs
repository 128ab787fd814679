//! A synthetic gallery day: visitors, a crowd, staff and the kiosk's own loudspeaker around the whole pipeline, in a closed
//! loop, judged by what leaves the kiosk.
//!
//! ```text
//! day (who comes, when) → visitor ─┐
//!                  crowd, air ─────┤ house → microphone → machine (all that runs live) ─┬→ eyes → pictures ──┐
//!          room ← loudspeaker ─────┘                                                   └→ ears → loudspeaker ┴→ judge → report
//!            ↑                                                                                   │
//!            └───────────────────────────────────────────────────────────────────────────────────┘
//! ```
//!
//! Speakers, rooms and breaths come from seeds that no training uses
//! ([`EXAM`](soffio_soundscape::EXAM)). The same seed gives the same day and, on one machine, the same report; nothing here asks what time it is.
//!
//! It never opens a device: microphone and loudspeaker are computed, and so is the time of day. It writes no file; the
//! program prints its [`report`]. It draws pictures, so it needs a Vulkan driver, software or not.
//!
//! The main types are [`Rehearsal`] (what is rehearsed), [`day::Day`] (who comes when, and what staff do),
//! [`visitor::Visit`] (one visitor) and [`judge`] (whether a visitor was answered). [`run()`] rehearses with pictures;
//! [`listen()`] lets the detector alone hear the same day.
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

mod blocks;
pub mod day;
mod ears;
mod eyes;
mod house;
pub mod judge;
pub mod listening;
mod loudness;
mod machine;
mod rate;
mod rehearsal;
pub mod report;
mod room;
mod run;
mod standing;
mod twin;
pub mod visitor;

pub use house::{Crowd, recorded};
pub use listening::listen;
pub use rehearsal::{Rehearsal, RehearsalError, featured_exhibits};
pub use room::ROOMS;
pub use run::run;

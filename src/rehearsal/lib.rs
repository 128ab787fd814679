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
//! Speakers, rooms and breaths come from seeds that no training of the ear uses ([`EXAM`](soffio_soundscape::EXAM)). The same seed gives the same
//! day and, on one machine, the same report; nothing here asks what time it is.

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

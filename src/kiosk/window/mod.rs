//! The window: handles events and draws frames.
//!
//! In the gallery it fills the screen, hides the cursor, and cannot be closed by a visitor; only the staff panel or a signal
//! from the terminal ends it. In a window on a desk (`--windowed`) it closes like any window.
//!
//! The window thread owns the state in `app`. It never waits for the simulation, a disk or the network. It sends to the
//! simulation through [`Inbox`](crate::step::inbox::Inbox) alone.

mod app;
mod events;
mod exhibits;
mod fleet;
mod frame;
pub mod frame_pacing;
pub mod idle_rendering;
mod launch;
mod parts;
pub mod quality_tiers;
mod requests;
mod run;
mod screen;
pub mod shader_watcher;
mod timing;
mod venue;
mod visit;

pub use launch::{Ended, Launch, Missing};
pub use run::{event_loop, run};

//! The window: events in, pictures out.
//!
//! In the gallery it fills the screen, hides the cursor and cannot be closed by anything that a visitor can press;
//! only the staff panel leads out, or a signal from the terminal. On somebody's desk (`--windowed`) it closes like
//! any window.
//!
//! The window thread owns what is in `app`; it never waits for the simulation, a disk or the network. The
//! simulation learns of it through [`Inbox`](crate::step::inbox::Inbox) alone.

mod app;
mod asked;
mod day;
mod events;
mod fleet;
mod ground;
mod parts;
mod picture;
pub mod rest;
pub mod rhythm;
mod run;
mod screen;
pub mod tiers;
mod timing;
mod visit;
pub mod workbench;
mod works;

pub use ground::{Ended, Ground, Missing};
pub use run::{event_loop, run};

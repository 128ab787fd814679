//! One simulation step of the kiosk: who blows, visitor, recording or attract script, and what becomes of the exhibit.
//!
//! A function of its state and its inputs. It never reads a clock, a device, a file or a window, so that a recorded run
//! repeats to the bit.

pub mod breaths;
pub mod captions;
pub mod command;
pub mod controls;
pub mod governor;
pub mod inbox;
pub mod moments;
mod pointing;
pub mod stage;
pub mod stillness;
pub mod voice;

//! One simulation step of the kiosk: the source of the breath (visitor, recording or attract script), and the exhibit's motion.
//!
//! It depends only on its state and inputs. It never reads a clock, a device, a file or a window, so that a recorded run
//! repeats to the bit.

pub mod breaths;
pub mod captions;
pub mod command;
pub mod controls;
pub mod frame_interpolation;
pub mod governor;
pub mod idle_detection;
pub mod inbox;
pub mod instruments;
mod pointing;
pub mod stage;

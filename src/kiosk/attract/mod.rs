//! Attract mode: plays the exhibit's script while nobody is there.
//!
//! It knows the steps and seconds since the last input. It never reads a clock and never moves a body: it returns commands
//! and camera angles, which the stage applies.

pub mod camera_sway;
pub mod script;

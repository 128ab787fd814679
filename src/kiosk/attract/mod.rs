//! Attract mode: what the kiosk shows while nobody is there.
//!
//! Knows steps and seconds since the last input. It never looks at a clock and never moves a body itself: it returns
//! commands and camera turns, and whoever steps the simulation carries them out.

pub mod drift;
pub mod script;

//! What the kiosk hears, plays and is played by.

pub mod audio;
pub mod controllers;

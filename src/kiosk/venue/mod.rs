//! The venue: opening hours and cleaning, loudness, the exhibits on offer, the configuration file, and the acoustic
//! self-test of foam, loudspeaker and microphone.
//!
//! Says what the house allows. It never draws and never steps the simulation.

pub mod care;
pub mod chirp;
pub mod chirping;
pub mod house;
pub mod loudness;
pub mod shelf;
pub mod site;

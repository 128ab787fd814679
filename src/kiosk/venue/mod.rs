//! The venue: opening hours and cleaning, loudness, the catalog of exhibits, the configuration file, and the audio
//! self-test of foam, loudspeaker and microphone.
//!
//! It decides what visitors may do at this time. It never draws and never steps the simulation.

pub mod catalog;
pub mod loudness;
pub mod quarantine;
pub mod self_test;
pub mod self_test_run;
pub mod site;
pub mod state;
pub mod sweep;
pub mod trial;

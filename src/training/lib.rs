//! Training of the breath detector.
//!
//! ```text
//! generator (physics of breath, draughts, rooms, microphones) → examples (the detector's own front end) → boosting (trees)
//!     → model (audio/models/breath.safetensors)
//! ```
//!
//! This is a developer's tool, `soffio-training`, and not part of the kiosk. Its generator shares no code with the one that examines
//! the detector (`soffio-soundscape`), so that a score says something. It opens no device. The same seed trains the same weights,
//! bit for bit, on any number of threads.
//!
//! | module | holds |
//! |---|---|
//! | [`generator`] | scenes with labels, from physics |
//! | [`examples`] | scenes as the detector measures them, with targets |
//! | [`boosting`] | growth of decision trees |
//! | [`model`] | from examples to a model, its file and its hash |
//! | [`commands`] | the command line |

pub mod boosting;
pub mod commands;
pub mod examples;
pub mod generator;
pub mod model;
pub mod parallel;

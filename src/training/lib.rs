//! Training of the breath detector.
//!
//! ```text
//! generator (physics of breath, draughts, rooms, microphones) → examples (the detector's own front end) → descent (Adam)
//!     ⊢ gradient (backpropagation through time)                → model (audio/models/breath.safetensors)
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
//! | [`gradient`] | loss and its gradient |
//! | [`descent`] | stochastic gradient descent with a fixed order of operations |
//! | [`model`] | weights as a file, and their hash |
//! | [`commands`] | the command line |

pub mod commands;
pub mod descent;
pub mod examples;
pub mod generator;
pub mod gradient;
pub mod model;
pub mod parallel;

//! The pages over the picture: wall label, invitation, the page behind "More", and the same things read aloud, in every
//! language and direction of writing.
//!
//! Drawn from a [`Scene`](overlay::Scene) that the window fills. Pages report what was pressed; they never change the
//! kiosk themselves and never see the simulation thread.

pub mod read_aloud;
pub mod bidi;
pub mod fonts;
mod groups;
pub mod languages;
pub mod menu;
pub mod overlay;
pub mod canvas;
pub mod speech_synthesis;
pub mod speech_text;
pub mod words;

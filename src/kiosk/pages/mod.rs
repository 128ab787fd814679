//! Visitors' pages over the picture: wall label, invitation, the page behind "More", and reading aloud, in every language and
//! writing direction.
//!
//! Pages are drawn from a [`Scene`](overlay::Scene) that the window fills. They report requests; they neither change the kiosk
//! nor access the simulation thread.

pub mod bidi;
pub mod canvas;
pub mod fonts;
mod groups;
pub mod languages;
pub mod menu;
pub mod overlay;
pub mod read_aloud;
pub mod speech_synthesis;
pub mod speech_text;
pub mod ui_strings;

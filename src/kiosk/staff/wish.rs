//! What staff ask of the kiosk, by a press on the panel.

use crate::step::voice::Trial;

/// What staff ask of the kiosk.
#[derive(Clone, Debug, PartialEq)]
pub enum Wish {
    /// Put everything back to where it started.
    Reset,
    /// Load the exhibit from its folder again.
    Reload,
    /// Silence, or an end of it.
    Mute,
    /// From the configured hours to night, to day, and back.
    Night,
    /// All input off while the glass is cleaned.
    Clean,
    /// Open while the house is closed, or close again.
    Open,
    /// The loudspeaker chirps to the microphone.
    Chirp,
    /// The foam is a new one.
    FoamChanged,
    /// What chirps tell from now on is how it should be.
    ListenAnew,
    /// Show the work with this id.
    Show(String),
    /// Let it be heard.
    Try(Trial),
    /// End the kiosk.
    Close,
}

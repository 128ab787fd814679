//! Actions that staff choose on the panel.

use crate::step::instruments::Audition;

/// An action of staff.
#[derive(Clone, Debug, PartialEq)]
pub enum StaffAction {
    /// Reset the exhibit to its start.
    Reset,
    /// Load the exhibit from its folder again.
    Reload,
    /// Mute or unmute.
    Mute,
    /// Switch from the configured hours to night, to day, and back.
    Night,
    /// Switch all input off while the screen is cleaned.
    Clean,
    /// Open the kiosk outside opening hours, or close it again.
    Open,
    /// Run the audio self-test.
    SelfTest,
    /// The foam was changed.
    FoamChanged,
    /// Measure a new reference of the self-test.
    ResetSelfTest,
    /// Show the exhibit with this id.
    Show(String),
    /// Play a sound.
    PlaySound(Audition),
    /// End the kiosk.
    Close,
}

//! The panel's pages, one a file: each draws itself from a [`PanelInput`](super::PanelInput) and remembers what it needs.

pub(super) mod bodies;
mod display;
pub(super) mod exhibits;
pub(super) mod keypad;
pub(super) mod log;
pub(super) mod microphone;
pub(super) mod parameters;
mod plot;
pub(super) mod sound;
mod states;
pub(super) mod status;
pub(super) mod style;
pub(super) mod test;
pub(super) mod wind;

use crate::pages::ui_strings::TextId;

/// A page of the panel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Page {
    /// Is it well? And what staff do every day.
    #[default]
    Status,
    /// Which works, in which order.
    Exhibits,
    /// Bodies, joints, energy.
    Bodies,
    /// Where the breath goes.
    Wind,
    /// Instruments, tried through the loudspeaker.
    Sound,
    /// The work's numbers.
    Parameters,
    /// Levels, gain, what to do about it.
    Microphone,
    /// Glass, loudspeakers, microphone.
    Test,
    /// What was logged.
    Log,
}

impl Page {
    /// All of them, in the order of their tabs.
    pub const ALL: [Self; 9] = [
        Self::Status,
        Self::Exhibits,
        Self::Bodies,
        Self::Wind,
        Self::Sound,
        Self::Parameters,
        Self::Microphone,
        Self::Test,
        Self::Log,
    ];

    /// The text on its tab.
    pub(super) fn title(self) -> TextId {
        match self {
            Self::Status => TextId::StaffPageStatus,
            Self::Exhibits => TextId::StaffPageExhibits,
            Self::Bodies => TextId::StaffPageBodies,
            Self::Wind => TextId::StaffPageWind,
            Self::Sound => TextId::StaffPageSound,
            Self::Parameters => TextId::StaffPageParameters,
            Self::Microphone => TextId::StaffPageMicrophone,
            Self::Test => TextId::StaffPageTest,
            Self::Log => TextId::StaffPageLog,
        }
    }
}

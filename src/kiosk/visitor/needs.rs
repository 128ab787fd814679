//! What a visitor needs otherwise, for this visit: larger type, more contrast, a breath that need not be held, a pointer that
//! need not press, less motion, a look round the work.
//!
//! The site says what everybody finds; a visitor changes it on the page behind "More"; whoever comes next finds the
//! site's again.

use soffio_config::Visit;

/// How a visitor wants to read.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Reading {
    /// Large type?
    pub large: bool,
    /// Type black on white?
    pub contrast: bool,
}

/// What a visitor has chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// How to read.
    pub reading: Reading,
    /// A press begins the breath, the next one ends it.
    pub press_once: bool,
    /// Resting the pointer presses; then a press begins the breath too, as there is nothing to hold.
    pub dwell: bool,
    /// No change of scene in which parts fly together, no dust in the air, gentler attract mode.
    pub calm: bool,
    /// Looks round the work: a pull beside it turns the camera.
    pub round: bool,
}

impl Needs {
    /// Does a press begin the breath and the next one end it?
    pub fn once(&self) -> bool {
        self.press_once || self.dwell
    }

    /// As the site has it.
    pub fn of(site: &Visit) -> Self {
        let Visit { press_once, dwell, calm, .. } = *site;
        Self { reading: Reading::default(), press_once, dwell, calm, round: false }
    }
}

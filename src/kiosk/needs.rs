//! What a visitor needs otherwise, for this visit: larger type, more contrast, a breath that need not be held, less motion.
//!
//! The site says what everybody finds; a visitor changes it on the page behind "More"; whoever comes next finds the
//! site's again.

use super::page::Reading;
use crate::config::Visit;

/// What a visitor has chosen.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// How to read.
    pub reading: Reading,
    /// A press begins the breath, the next one ends it.
    pub press_once: bool,
    /// No change of scene in which parts fly together, no dust in the air, gentler attract mode.
    pub calm: bool,
}

impl Needs {
    /// As the site has it.
    pub fn of(site: &Visit) -> Self {
        Self { reading: Reading::default(), press_once: site.press_once, calm: site.calm }
    }
}

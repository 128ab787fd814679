//! Accessibility settings of a visit: larger type, more contrast, a breath that need not be held, dwell clicking, reduced
//! motion, looking around the exhibit.
//!
//! The site's configuration sets the defaults. A visitor changes them on the page behind "More", and they are reset after the
//! visit.

use soffio_config::Visit;

/// Settings of the text.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TextSettings {
    /// Large type?
    pub large: bool,
    /// Black on white?
    pub contrast: bool,
}

/// Accessibility settings of a visit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AccessibilitySettings {
    /// Settings of the text.
    pub text: TextSettings,
    /// A press begins the breath, the next one ends it.
    pub press_once: bool,
    /// Dwell clicking: resting the pointer presses. A press then begins the breath, as there is nothing to hold.
    pub dwell: bool,
    /// No assembly animation, no dust in the air, gentler attract mode.
    pub reduced_motion: bool,
    /// Look around the exhibit: a pull beside it turns the camera.
    pub look_around: bool,
}

impl AccessibilitySettings {
    /// Does a press begin the breath and the next one end it?
    pub fn presses_once(&self) -> bool {
        self.press_once || self.dwell
    }

    /// Defaults of the site.
    pub fn of(site: &Visit) -> Self {
        let Visit { press_once, dwell, reduced_motion, .. } = *site;
        Self { text: TextSettings::default(), press_once, dwell, reduced_motion, look_around: false }
    }
}

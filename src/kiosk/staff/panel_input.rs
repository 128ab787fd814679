//! Input of the staff panel.

use std::path::Path;

use crate::fleet::persisted::PersistedState;
use crate::live::LiveState;
use crate::pages::ui_strings::UiStrings;
use crate::staff::log::Log;
use crate::venue::state::VenueState;
use soffio_config::Config;
use soffio_exhibit::View;

/// Measurements of the window.
#[derive(Clone, Copy, Debug)]
pub struct WindowStats<'a> {
    /// Name and kind of the graphics adapter.
    pub adapter: &'a str,
    /// Mean time between frames, s.
    pub frame_s: f64,
    /// Size of the window, pixels.
    pub size: [u32; 2],
    /// Seconds since the kiosk began.
    pub time: f64,
    /// Latency from the last breath's first wind to its first frame, s.
    pub onset_latency_s: f64,
}

/// Input of the staff panel.
pub struct PanelInput<'a> {
    /// The latest state of the simulation.
    pub frame: &'a LiveState,
    /// The camera of the picture.
    pub view: View,
    /// Measurements of the window.
    pub vitals: WindowStats<'a>,
    /// The site's configuration.
    pub site: &'a Config,
    /// File that the panel's settings are saved in: that of staff in the folder of the state, or without one the configuration itself;
    /// `None` for the built-in configuration.
    pub file: Option<&'a Path>,
    /// Problems of the configuration: mistakes, old names, and keys that wait for a restart.
    pub config_problems: &'a [String],
    /// Why the files of the exhibit on show do not load; the last valid version is shown.
    pub exhibit_problem: Option<&'a str>,
    /// Ids of the exhibits that visitors can choose from.
    pub exhibit_ids: &'a [&'a str],
    /// State of the venue.
    pub venue: &'a VenueState,
    /// Persisted state, with the results of the self-test.
    pub persisted: &'a PersistedState,
    /// Lines of the log.
    pub log: &'a Log,
    /// Inputs so far.
    pub activity: u64,
    /// Texts in the staff's language.
    pub texts: &'a UiStrings,
    /// Is this a window on a desk, not the gallery?
    pub on_desk: bool,
    /// Points per millimetre of the screen.
    pub points_per_mm: f32,
}

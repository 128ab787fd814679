//! What the panel is drawn from.

use std::path::Path;

use crate::fleet::kept::Kept;
use crate::live::Frame;
use crate::staff::log::Log;
use crate::venue::house::House;
use soffio_config::Config;
use soffio_exhibit::View;

/// What the window knows besides the simulation.
#[derive(Clone, Copy, Debug)]
pub struct Vitals<'a> {
    /// Name and kind of the graphics adapter.
    pub adapter: &'a str,
    /// Mean time from picture to picture, s.
    pub frame_s: f64,
    /// Pixels.
    pub size: [u32; 2],
    /// Seconds since the kiosk began.
    pub time: f64,
    /// From the last breath's first wind to its first picture, s.
    pub sight_s: f64,
}

/// What the panel is drawn from.
pub struct Sight<'a> {
    /// The latest moments.
    pub frame: &'a Frame,
    /// The camera of the picture.
    pub view: View,
    /// The window's own numbers.
    pub vitals: Vitals<'a>,
    /// The site's configuration, and its file where it has one.
    pub site: &'a Config,
    /// See above.
    pub file: Option<&'a Path>,
    /// What staff should know of it: what is wrong with the file, what waits for a restart.
    pub site_says: &'a [String],
    /// Why the work on show does not load as its files stand now; the last good one is shown.
    pub work_says: Option<&'a str>,
    /// Ids of the works that visitors can choose from.
    pub works: &'a [&'a str],
    /// Is it open, is it cleaned?
    pub house: &'a House,
    /// What is kept: of foam and chirps, too.
    pub kept: &'a Kept,
    /// What was logged.
    pub log: &'a Log,
    /// Inputs so far.
    pub activity: u64,
    /// Is this somebody's desk and not the gallery?
    pub on_desk: bool,
    /// Points per millimetre of glass.
    pub points_per_mm: f32,
}

//! What a run of the kiosk is given, and how it ends.

use std::path::PathBuf;

use crate::fleet::Fleet;
use crate::live::Report;
use crate::staff::log::Log;
use crate::venue::site::Overrides;
use soffio_config::Config;

/// What a kiosk runs on, beside its exhibits.
pub struct Ground {
    /// The site's configuration as this run has it.
    pub config: Config,
    /// What the command line says over its file.
    pub overrides: Overrides,
    /// Its file, which is watched; `None` for the one that is built in.
    pub file: Option<PathBuf>,
    /// What is wrong with that file, where the run has the last good configuration instead.
    pub problem: Option<String>,
    /// What is logged.
    pub log: Log,
    /// What is counted, kept and told.
    pub fleet: Fleet,
    /// The graphics device is destroyed once, after so many seconds: a rehearsal of its loss.
    pub lose_device_at: Option<f64>,
    /// A folder of shaders that somebody works on.
    pub shaders: Option<PathBuf>,
}

/// Why there is no live kiosk.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Missing {
    /// No display to open a window on.
    Display(String),
    /// No graphics adapter that can draw into the window.
    Graphics(String),
}

/// How a live kiosk ended.
#[derive(Clone, Debug)]
pub enum Ended {
    /// By itself, by staff, or by closing a window on a desk.
    Done(Report),
    /// By a signal from outside.
    Interrupted,
    /// Something broke.
    Failed(String),
}

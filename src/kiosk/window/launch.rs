//! Inputs of a run of the kiosk, and how it ends.

use std::path::PathBuf;

use crate::fleet::Fleet;
use crate::live::Report;
use crate::staff::log::Log;
use crate::venue::site::Overrides;
use soffio_config::Config;

/// Inputs of a run, besides the exhibits.
pub struct Launch {
    /// The site's configuration, with the options of the command line applied.
    pub config: Config,
    /// Options of the command line that take precedence over the file.
    pub overrides: Overrides,
    /// File of the configuration, which is watched; `None` for the built-in one.
    pub file: Option<PathBuf>,
    /// Folder of the state, in which the settings of staff are; `None` without one.
    pub state: Option<PathBuf>,
    /// Problems of that file, if the run uses the last valid configuration instead.
    pub problem: Option<String>,
    /// Old names in that file, each with its place and remedy.
    pub warnings: Vec<String>,
    /// The log.
    pub log: Log,
    /// Counters, persisted state and reports.
    pub fleet: Fleet,
    /// Time after which the graphics device is destroyed once, s, to test its loss.
    pub lose_device_at: Option<f64>,
    /// Folder of shaders that are reloaded when they change.
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

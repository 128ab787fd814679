//! A run of the kiosk from its window's opening to its end.

use std::path::PathBuf;
use std::sync::atomic::AtomicBool;

use winit::event_loop::EventLoop;

use super::app::App;
use crate::fleet::Fleet;
use crate::live::{Options, Report};
use crate::staff::log::Log;
use crate::venue::shelf::Places;
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

/// Shows an exhibit, and lets visitors choose among those of `places`, until somebody ends it. `interrupted` is set by a
/// signal from outside.
pub fn run(ground: Ground, places: &Places, options: Options, interrupted: &AtomicBool) -> Result<Ended, Missing> {
    let events = event_loop().map_err(Missing::Display)?;
    let mut app = App::new(ground, places, options, (&events, interrupted));
    app.go_on();
    let looped = events.run_app(&mut app).map_err(|error| error.to_string());
    app.end(looped)
}

/// The connection to the display; the error is the system's reason alone, without the place in its library.
pub fn event_loop() -> Result<EventLoop<()>, String> {
    EventLoop::new().map_err(|error| error.to_string().rsplit(": ").next().unwrap_or_default().to_owned())
}

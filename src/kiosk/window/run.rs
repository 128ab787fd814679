//! A run of the kiosk from its window's opening to its end.

use std::sync::atomic::AtomicBool;

use winit::event_loop::EventLoop;

use super::app::App;
use super::launch::{Ended, Launch, Missing};
use crate::live::Options;
use crate::venue::catalog::ExhibitSource;

/// Runs the kiosk until it is ended. Visitors choose among the exhibits of `places`. `interrupted` is set by a signal of the
/// system.
///
/// # Errors
/// There is no display, or no graphics adapter that can draw to its window.
pub fn run(
    ground: Launch,
    places: &ExhibitSource,
    options: Options,
    interrupted: &AtomicBool,
) -> Result<Ended, Missing> {
    let events = event_loop().map_err(Missing::Display)?;
    let mut app = App::new(ground, places, options, &events, interrupted);
    app.restore_state();
    let looped = events.run_app(&mut app).map_err(|error| error.to_string());
    app.end(looped)
}

/// The connection to the display; the error is the system's reason.
///
/// # Errors
/// There is no display; the system's reason.
pub fn event_loop() -> Result<EventLoop<()>, String> {
    EventLoop::new().map_err(|error| error.to_string().rsplit(": ").next().unwrap_or_default().to_owned())
}

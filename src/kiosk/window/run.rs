//! A run of the kiosk from its window's opening to its end.

use std::sync::atomic::AtomicBool;

use winit::event_loop::EventLoop;

use super::app::App;
use super::ground::{Ended, Ground, Missing};
use crate::live::Options;
use crate::venue::shelf::Places;

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

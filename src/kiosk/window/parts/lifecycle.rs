//! Start and end of a run, and the reason for its end.

use std::sync::atomic::{AtomicBool, Ordering};

use winit::event_loop::{ActiveEventLoop, EventLoopProxy};

use crate::live::Options;
use crate::window::launch::Missing;

/// Start and end of a run.
pub(crate) struct Lifecycle<'a> {
    /// Set by a signal of the system.
    pub interrupted: &'a AtomicBool,
    /// Options of the run, until there is a window.
    pub waiting: Option<Options>,
    /// Wakes the event loop from idle rendering.
    pub waker: EventLoopProxy<()>,
    /// What was missing at the start, if anything was.
    pub missing: Option<Missing>,
    /// Why the run fails, once it does.
    pub failure: Option<String>,
}

impl Lifecycle<'_> {
    /// Was there a signal of the system?
    pub fn is_interrupted(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }

    /// Callback for the simulation when an idle picture begins to move.
    pub fn wakes(&self) -> impl Fn() + Send + use<> {
        let waker = self.waker.clone();
        move || {
            let _ = waker.send_event(());
        }
    }

    /// Ends the run for this reason.
    pub fn fail(&mut self, events: &ActiveEventLoop, error: String) {
        self.failure = Some(error);
        events.exit();
    }

    /// Ends the run because display or graphics are missing.
    pub fn miss(&mut self, events: &ActiveEventLoop, missing: Missing) {
        self.missing = Some(missing);
        events.exit();
    }
}

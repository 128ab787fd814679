//! How a run begins, what may end it, and why it ended.

use std::sync::atomic::{AtomicBool, Ordering};

use winit::event_loop::{ActiveEventLoop, EventLoopProxy};

use crate::live::Options;
use crate::window::ground::Missing;

/// The run's beginning and end.
pub(crate) struct Life<'a> {
    /// Set by a signal from outside.
    pub interrupted: &'a AtomicBool,
    /// The run, until there is a window to show it in.
    pub waiting: Option<Options>,
    /// Lets the simulation end a rest.
    pub waker: EventLoopProxy<()>,
    pub missing: Option<Missing>,
    pub failure: Option<String>,
}

impl Life<'_> {
    /// Was there a signal?
    pub fn is_interrupted(&self) -> bool {
        self.interrupted.load(Ordering::Relaxed)
    }

    /// What the simulation calls when something begins to move. A window that is gone needs no waking.
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

    /// Something that a kiosk needs is not there.
    pub fn miss(&mut self, events: &ActiveEventLoop, missing: Missing) {
        self.missing = Some(missing);
        events.exit();
    }
}

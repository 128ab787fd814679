//! What the window thread and the simulation thread share: two small values, each behind a lock that is held for a copy.

use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::frame::Frame;
use crate::step::inbox::Inbox;

/// What both threads see.
pub(super) struct Shared {
    /// From the window to the simulation.
    pub inbox: Mutex<Inbox>,
    /// From the simulation to the window.
    pub frame: Mutex<Arc<Frame>>,
    /// The run is to end.
    pub stop: AtomicBool,
}

/// A poisoned lock holds a whole value all the same: every writer replaces it at once.
pub(super) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Seconds after midnight, by the clock on the wall.
pub(super) fn local_time() -> Option<f64> {
    let now = jiff::Zoned::now();
    Some(f64::from(3600 * i32::from(now.hour()) + 60 * i32::from(now.minute()) + i32::from(now.second())))
}

/// Why a trace is missing.
pub(super) fn trace_error(error: std::io::Error) -> String {
    format!("the trace cannot be written: {error}")
}

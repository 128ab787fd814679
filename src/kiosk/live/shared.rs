//! Values shared by the window thread and the simulation thread, each behind a lock that is held for a copy.

use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use super::live_state::LiveState;
use crate::step::inbox::Inbox;

/// Shared values.
pub(super) struct Shared {
    /// From the window to the simulation.
    pub inbox: Mutex<Inbox>,
    /// From the simulation to the window.
    pub frame: Mutex<Arc<LiveState>>,
    /// The run is to end.
    pub stop: AtomicBool,
}

/// Locks a mutex. A poisoned one still holds a whole value, because every writer replaces it at once.
pub(super) fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Local time, s after midnight.
pub(super) fn local_time() -> Option<f64> {
    let now = jiff::Zoned::now();
    Some(f64::from(3600 * i32::from(now.hour()) + 60 * i32::from(now.minute()) + i32::from(now.second())))
}

/// Message of a failed trace.
pub(super) fn trace_error(error: std::io::Error) -> String {
    format!("the trace cannot be written: {error}")
}

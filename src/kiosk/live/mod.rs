//! The simulation thread: wall clock, microphone and loudspeaker around a [`Stage`].
//!
//! The thread wakes at step boundaries, takes all samples that the microphone has delivered, steps, and publishes. The samples
//! are spread evenly over the due steps, so that the latency never grows. The window never waits for a step, and the simulation
//! never for a frame: they share two small values, each under a mutex held for a copy. Only the clock, the devices and the
//! files are here; the step itself is in [`Stage`].

mod live_state;
pub mod microphone;
mod options;
pub mod recording;
mod shared;
pub mod step_scheduler;
mod thread;

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};
use std::thread::JoinHandle;

use crate::step::command::KioskCommand;
use crate::step::controls::Controls;
use crate::step::inbox::Inbox;
use crate::step::stage::Stage;
pub use live_state::{LiveState, Onset, RunStatus};
pub use options::{Options, Report};
use recording::Recording;
use shared::{Shared, local_time, lock, trace_error};
use soffio_offline::trace::{DEFAULT_FPS, TraceWriter};
use soffio_simulation::Settings;
use thread::{Files, Thread};

/// A running simulation.
pub struct Live {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<Result<Report, String>>>,
}

impl Live {
    /// Starts the thread, for a picture of this aspect (width over height). `wake` is called in the step in which an idle
    /// picture begins to move.
    ///
    /// # Errors
    /// The thread, a record or a trace cannot be started; the reason.
    pub fn start(options: Options, aspect: f64, wake: impl Fn() + Send + 'static) -> Result<Self, String> {
        let site = &options.site;
        let settings = Settings { clock: local_time(), ..site.settings };
        let mut stage = Stage::new(options.exhibit.clone(), settings, options.recording.clone(), site.idle_s);
        options.ambient_spread.into_iter().for_each(|ambient_spread| stage.recall(ambient_spread));
        let trace = match &options.trace {
            Some(path) => Some(TraceWriter::create(path, &options.exhibit, DEFAULT_FPS).map_err(trace_error)?),
            None => None,
        };
        let mut record = options.record.as_deref().map(Recording::create).transpose()?;
        if let Some(record) = &mut record {
            record.begin(&options.exhibit, settings);
        }
        let frame = LiveState { hears: options.recording.is_some(), ..LiveState::new(&stage) };
        let closed = options.closed;
        let controls = Controls { aspect, closed, inert: closed, ..Controls::default() };
        let shared = Arc::new(Shared {
            inbox: Mutex::new(Inbox::new(controls)),
            frame: Mutex::new(Arc::new(frame)),
            stop: AtomicBool::new(false),
        });
        let theirs = shared.clone();
        let files = Files { trace, record };
        let thread = std::thread::Builder::new()
            .name("soffio-sim".into())
            .spawn(move || Thread::new(stage, files, options, theirs, Box::new(wake)).run())
            .map_err(|error| format!("the simulation thread does not start: {error}"))?;
        Ok(Self { shared, thread: Some(thread) })
    }

    /// Inbox of the next step: controls to overwrite, and the queue of commands. Hold the lock briefly.
    pub fn inbox(&self) -> MutexGuard<'_, Inbox> {
        lock(&self.shared.inbox)
    }

    /// Sends a command; never waits.
    pub fn send(&self, command: KioskCommand) {
        self.inbox().send(command);
    }

    /// The latest state.
    pub fn frame(&self) -> Arc<LiveState> {
        lock(&self.shared.frame).clone()
    }

    /// Has the run ended by itself?
    pub fn is_over(&self) -> bool {
        self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// Ends the run and waits for its files.
    ///
    /// # Errors
    /// A file cannot be completed, or the thread has failed; the reason.
    pub fn finish(mut self) -> Result<Report, String> {
        self.join().unwrap_or_else(|| Ok(Report::default()))
    }

    fn join(&mut self) -> Option<Result<Report, String>> {
        self.shared.stop.store(true, Ordering::Relaxed);
        let ended = self.thread.take()?.join();
        Some(ended.unwrap_or_else(|_| Err("the simulation thread crashed; see the log above".into())))
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        self.join();
    }
}

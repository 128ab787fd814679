//! The simulation thread: the wall clock, the microphone and the loudspeaker around a [`Stage`].
//!
//! The thread wakes at step boundaries, consumes everything that the microphone has delivered since (spread evenly
//! over the steps due, so that the way from breath to wind never grows), steps, and publishes. The window never
//! waits for a step and the simulation never for a picture: both sides share two small values under a mutex held
//! for a copy. Only the clock, the devices and the trace file are here; what a step does is in [`Stage`].

mod frame;
pub mod microphone;
pub mod pace;
pub mod recording;
mod thread;

use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread::JoinHandle;

use crate::live::recording::Recording;
use crate::step::stage::{Controls, Stage};
use crate::venue::site::Site;
pub use frame::{Frame, Load, Onset};
use soffio_exhibit::Exhibit;
use soffio_offline::feed::WavFeed;
use soffio_offline::trace::{DEFAULT_FPS, TraceWriter};
use soffio_simulation::{MotionMode, Settings};
use thread::Thread;

/// What a run is made of.
pub struct Options {
    /// What is shown first.
    pub exhibit: Arc<Exhibit>,
    /// What the site says.
    pub site: Site,
    /// Is the house closed when the run begins?
    pub closed: bool,
    /// A recording in the microphone's place.
    pub recording: Option<WavFeed>,
    /// End after so many steps.
    pub steps: Option<u64>,
    /// Where the trace goes.
    pub trace: Option<PathBuf>,
    /// Where the record goes.
    pub record: Option<PathBuf>,
    /// What moves the exhibits; `None` is their own choice.
    pub mode: Option<MotionMode>,
}

/// How a run ended.
#[derive(Clone, Debug, Default, serde::Serialize)]
pub struct Report {
    /// Steps done.
    pub steps: u64,
    /// Steps of time that were dropped because the machine was too slow.
    pub dropped: u64,
    /// Impacts of the last exhibit.
    pub impacts: u64,
    /// Gaps of microphone and loudspeaker.
    pub xruns: u64,
    /// A-weighted mean level of all that was played, dB of a full-scale sine; null for silence.
    pub level_dba: Option<f64>,
    /// Says whether two runs are the same run.
    #[serde(serialize_with = "hex")]
    pub state_hash: u64,
}

/// A running simulation.
pub struct Live {
    shared: Arc<Shared>,
    thread: Option<JoinHandle<Result<Report, String>>>,
}

struct Shared {
    controls: Mutex<Controls>,
    frame: Mutex<Arc<Frame>>,
    stop: AtomicBool,
}

impl Live {
    /// Starts the thread, for a picture of this shape (width over height). `wake` is called in the step in which what stood
    /// still begins to move.
    pub fn start(options: Options, aspect: f64, wake: impl Fn() + Send + 'static) -> Result<Self, String> {
        let site = &options.site;
        let settings = Settings { clock: local_time(), ..site.settings };
        let stage = Stage::new(options.exhibit.clone(), settings, options.recording.clone(), site.idle_s);
        let trace = match &options.trace {
            Some(path) => Some(TraceWriter::create(path, &options.exhibit, DEFAULT_FPS).map_err(trace_error)?),
            None => None,
        };
        let mut record = options.record.as_deref().map(Recording::create).transpose()?;
        if let Some(record) = &mut record {
            record.begin(&options.exhibit, settings);
        }
        let frame = Frame { hears: options.recording.is_some(), ..Frame::new(&stage) };
        let shared = Arc::new(Shared {
            controls: Mutex::new(Controls {
                aspect,
                closed: options.closed,
                inert: options.closed,
                ..Controls::default()
            }),
            frame: Mutex::new(Arc::new(frame)),
            stop: AtomicBool::new(false),
        });
        let theirs = shared.clone();
        let thread = std::thread::Builder::new()
            .name("simulation".into())
            .spawn(move || Thread::new(stage, (trace, record), options, (theirs, Box::new(wake))).run())
            .map_err(|error| format!("the simulation thread does not start: {error}"))?;
        Ok(Self { shared, thread: Some(thread) })
    }

    /// What the visitor does. Hold it briefly.
    pub fn controls(&self) -> MutexGuard<'_, Controls> {
        lock(&self.shared.controls)
    }

    /// The latest moments.
    pub fn frame(&self) -> Arc<Frame> {
        lock(&self.shared.frame).clone()
    }

    /// Has the run ended by itself?
    pub fn is_over(&self) -> bool {
        self.thread.as_ref().is_none_or(JoinHandle::is_finished)
    }

    /// Ends the run and waits for its files.
    pub fn finish(mut self) -> Result<Report, String> {
        self.join().unwrap_or_else(|| Ok(Report::default()))
    }

    fn join(&mut self) -> Option<Result<Report, String>> {
        self.shared.stop.store(true, Ordering::Relaxed);
        let ended = self.thread.take()?.join();
        Some(ended.unwrap_or_else(|_| Err("the simulation thread died; see the log above".into())))
    }
}

impl Drop for Live {
    fn drop(&mut self) {
        self.join();
    }
}

/// A poisoned lock holds a whole value all the same: every writer replaces it at once.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Seconds after midnight, by the clock on the wall.
fn local_time() -> Option<f64> {
    let now = jiff::Zoned::now();
    Some(f64::from(3600 * i32::from(now.hour()) + 60 * i32::from(now.minute()) + i32::from(now.second())))
}

/// A hash as text: JSON numbers lose bits beyond 2⁵³.
fn hex<S: serde::Serializer>(hash: &u64, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(&format!("{hash:016x}"))
}

fn trace_error(error: std::io::Error) -> String {
    format!("the trace cannot be written: {error}")
}

//! Event logs: one JSON object for each line.

use std::io::{self, Write};
use std::path::Path;
use std::sync::Arc;

use serde::Serialize;

use super::atomic_file::AtomicFile;
use soffio_exhibit::Exhibit;
use soffio_simulation::Event;

#[derive(Serialize)]
struct EventLine<'a> {
    t: f64,
    sample: u64,
    kind: &'static str,
    bodies: [Option<&'a str>; 2],
    point: [f64; 3],
    normal: [f64; 3],
    impulse: f64,
    speed: f64,
    /// Name of the constraint or spring that broke or was triggered.
    #[serde(skip_serializing_if = "Option::is_none")]
    part: Option<&'a str>,
}

/// Writes an event log during a run.
pub struct EventWriter {
    file: AtomicFile,
    exhibit: Arc<Exhibit>,
}

impl EventWriter {
    /// Creates a log of the exhibit's events.
    ///
    /// # Errors
    /// The file cannot be created.
    pub fn create(path: &Path, exhibit: &Arc<Exhibit>) -> io::Result<Self> {
        Ok(Self { file: AtomicFile::create(path)?, exhibit: exhibit.clone() })
    }

    /// Adds the events of a step.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn push(&mut self, events: &[Event]) -> io::Result<()> {
        for event in events {
            let line = EventLine {
                t: event.t,
                sample: event.sample,
                kind: event.kind.name(),
                bodies: event.bodies.map(|body| body.map(|index| self.exhibit.bodies[index].name.as_str())),
                point: event.point.to_array(),
                normal: event.normal.to_array(),
                impulse: event.impulse,
                speed: event.speed,
                part: event.source.map(|part| part.name(&self.exhibit)),
            };
            serde_json::to_writer(&mut self.file, &line)?;
            self.file.write_all(b"\n")?;
        }
        Ok(())
    }

    /// Completes the file.
    ///
    /// # Errors
    /// The file cannot be written or renamed.
    pub fn finish(self) -> io::Result<()> {
        self.file.finish()
    }
}

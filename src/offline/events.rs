//! Event logs: one JSON object a line.

use std::io::{self, Write};
use std::path::Path;

use serde::Serialize;

use super::whole_file::WholeFile;
use crate::exhibit::Exhibit;
use crate::simulation::Event;

#[derive(Serialize)]
struct Line<'a> {
    t: f64,
    sample: u64,
    kind: &'static str,
    bodies: [Option<&'a str>; 2],
    point: [f64; 3],
    normal: [f64; 3],
    impulse: f64,
    speed: f64,
}

/// Writes an event log while a run goes on.
pub struct EventWriter {
    file: WholeFile,
    names: Vec<String>,
}

impl EventWriter {
    /// Begins a log of the exhibit's events.
    pub fn create(path: &Path, exhibit: &Exhibit) -> io::Result<Self> {
        let names = exhibit.bodies.iter().map(|body| body.name.clone()).collect();
        Ok(Self { file: WholeFile::create(path)?, names })
    }

    /// Adds the events of a step.
    pub fn push(&mut self, events: &[Event]) -> io::Result<()> {
        for event in events {
            let line = Line {
                t: event.t,
                sample: event.sample,
                kind: event.kind.name(),
                bodies: event.bodies.map(|body| body.map(|index| self.names[index].as_str())),
                point: event.point.to_array(),
                normal: event.normal.to_array(),
                impulse: event.impulse,
                speed: event.speed,
            };
            serde_json::to_writer(&mut self.file, &line)?;
            self.file.write_all(b"\n")?;
        }
        Ok(())
    }

    /// Puts the file in its place.
    pub fn finish(self) -> io::Result<()> {
        self.file.finish()
    }
}

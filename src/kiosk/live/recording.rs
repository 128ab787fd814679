//! The record of a live run (`soffio kiosk --record`): all inputs of the simulation, for `soffio replay`.
//!
//! It is written to FILE.part and renamed when the run ends; after a crash the part misses at most a second. If it cannot be
//! written, the record ends with an error in the log, and the run continues.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use soffio_exhibit::Exhibit;
use soffio_simulation::record::Recorder;
use soffio_simulation::{STEPS_PER_SECOND, Settings};

use crate::step::stage::Stage;

/// A record that is being written.
pub struct Recording {
    recorder: Recorder,
    /// `None` after a failed write.
    out: Option<BufWriter<File>>,
    path: PathBuf,
}

impl Recording {
    /// Begins a record that will be at `path`. The error says why the file cannot be created.
    ///
    /// # Errors
    /// The file cannot be created; the reason.
    pub fn create(path: &Path) -> Result<Self, String> {
        let file = File::create(growing(path)).map_err(|error| {
            format!("cannot write the record {}: {error}; check the folder and its permissions", path.display())
        })?;
        let mut recording =
            Self { recorder: Recorder::default(), out: Some(BufWriter::new(file)), path: path.to_path_buf() };
        recording.write(&Recorder::head());
        Ok(recording)
    }

    /// An exhibit begins.
    pub fn begin(&mut self, exhibit: &Exhibit, settings: Settings) {
        let line = self.recorder.begin(&exhibit.id, settings);
        self.write(&line);
    }

    /// Records the step that the stage has just done.
    pub fn record(&mut self, stage: &Stage) {
        let now = stage.snapshot();
        if let Some(line) = self.recorder.step(now.step - 1, &stage.recorded_input(), now.breath.speed) {
            self.write(&line);
        }
        if now.step.is_multiple_of(STEPS_PER_SECOND) {
            self.attempt(|out| out.flush());
        }
    }

    /// The exhibit has ended.
    pub fn end(&mut self, stage: &Stage) {
        self.write(&Recorder::end(stage.snapshot().step, stage.state_hash()));
    }

    /// Completes the record and gives it its name.
    pub fn finish(mut self) {
        self.attempt(|out| out.flush());
        if self.out.is_some()
            && let Err(error) = std::fs::rename(growing(&self.path), &self.path)
        {
            tracing::error!("the record stays {}: {error}", growing(&self.path).display());
        }
    }

    fn write(&mut self, line: &str) {
        self.attempt(|out| writeln!(out, "{line}"));
    }

    fn attempt(&mut self, action: impl FnOnce(&mut BufWriter<File>) -> std::io::Result<()>) {
        if let Some(out) = &mut self.out
            && let Err(error) = action(out)
        {
            tracing::error!("the record ends here, in {}: {error}", growing(&self.path).display());
            self.out = None;
        }
    }
}

/// Path of the incomplete record.
fn growing(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".part");
    name.into()
}

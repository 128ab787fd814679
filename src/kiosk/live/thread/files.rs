//! Files that a run writes: the trace of its first exhibit, and the record of all inputs.

use super::super::recording::Recording;
use super::super::shared::trace_error;
use crate::step::stage::Stage;
use soffio_offline::trace::TraceWriter;

/// Trace and record, where requested.
pub(in crate::live) struct Files {
    /// Trace of the poses.
    pub trace: Option<TraceWriter>,
    /// Record of the inputs.
    pub record: Option<Recording>,
}

impl Files {
    /// Records a step.
    pub(super) fn record(&mut self, stage: &Stage) {
        if let Some(record) = &mut self.record {
            record.record(stage);
        }
    }

    /// Adds the present state to the trace.
    pub(super) fn write_trace(&mut self, stage: &Stage) -> Result<(), String> {
        match &mut self.trace {
            Some(trace) => trace.push(stage.snapshot()).map_err(trace_error),
            None => Ok(()),
        }
    }

    /// The run of the exhibit on show has ended.
    pub(super) fn end(&mut self, stage: &Stage) {
        if let Some(record) = &mut self.record {
            record.end(stage);
        }
    }

    /// An exhibit starts. A trace ends, as it holds one run only.
    pub(super) fn begin(&mut self, stage: &Stage) {
        if let Some(record) = &mut self.record {
            record.begin(stage.exhibit(), *stage.settings());
        }
        if let Some(trace) = self.trace.take() {
            match trace.finish() {
                Ok(_) => tracing::warn!("the trace ends here: the exhibit restarts"),
                Err(error) => tracing::error!("{error}"),
            }
        }
    }

    /// Ends both, at the end of the thread.
    pub(super) fn finish(&mut self, stage: &Stage) -> Result<(), String> {
        if let Some(trace) = self.trace.take() {
            trace.finish().map_err(trace_error)?;
        }
        if let Some(mut record) = self.record.take() {
            record.end(stage);
            record.finish();
        }
        Ok(())
    }
}

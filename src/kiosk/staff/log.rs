//! The log: its last lines, in memory, for the staff panel, and a writer to stderr that never waits for a reader.
//!
//! A pipe that nobody reads is full after 64 KiB, and the next write to it waits for ever. So a thread of its own writes to stderr. Where
//! it falls behind by `WAITING` lines, further lines are dropped and counted.

use std::collections::VecDeque;
use std::fmt::{self, Write as _};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

use tracing::field::{Field, Visit};
use tracing::{Event, Level, Subscriber};
use tracing_appender::non_blocking::{ErrorCounter, NonBlocking, NonBlockingBuilder, WorkerGuard};
use tracing_subscriber::layer::{Context, Layer};

/// Number of stored lines.
pub const CAPACITY: usize = 400;
/// Longest line, characters; longer ones are cut.
pub const LONGEST: usize = 2000;

/// Lines that may wait for stderr: an hour of warnings, and 2 MB at most.
const WAITING: usize = 1000;

/// One entry.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LogLine {
    /// Local time.
    pub time: jiff::civil::Time,
    /// Severity.
    pub level: Level,
    /// Message.
    pub text: String,
}

/// The lines, shared by writers and readers.
#[derive(Clone, Debug, Default)]
pub struct Log {
    lines: Arc<Mutex<VecDeque<LogLine>>>,
    /// Counts the lines that stderr did not take; set with its writer.
    dropped: Arc<OnceLock<ErrorCounter>>,
}

impl Log {
    /// Adds a line; a full log drops its oldest.
    pub fn push(&self, line: LogLine) {
        let mut lines = self.lines();
        if lines.len() >= CAPACITY {
            lines.pop_front();
        }
        lines.push_back(LogLine { text: line.text.chars().take(LONGEST).collect(), ..line });
    }

    /// The stored lines, the oldest first. Hold the lock briefly.
    pub fn lines(&self) -> MutexGuard<'_, VecDeque<LogLine>> {
        self.lines.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A writer to `out`, on a thread of its own. It writes what waits, for a second at most, when the guard is dropped.
    pub fn writer(&self, out: impl std::io::Write + Send + 'static) -> (NonBlocking, WorkerGuard) {
        let builder = NonBlockingBuilder::default().buffered_lines_limit(WAITING).thread_name("soffio-log");
        let (writer, guard) = builder.finish(out);
        // A second writer in one process is not counted.
        let _ = self.dropped.set(writer.error_counter());
        (writer, guard)
    }

    /// Number of lines that were dropped since nobody read stderr.
    pub fn dropped(&self) -> usize {
        self.dropped.get().map_or(0, ErrorCounter::dropped_lines)
    }
}

impl<S: Subscriber> Layer<S> for Log {
    fn on_event(&self, event: &Event<'_>, _: Context<'_, S>) {
        let mut said = EventText(String::new());
        event.record(&mut said);
        self.push(LogLine { time: jiff::Zoned::now().time(), level: *event.metadata().level(), text: said.0 });
    }
}

/// Text of an event.
struct EventText(String);

impl Visit for EventText {
    fn record_debug(&mut self, field: &Field, value: &dyn fmt::Debug) {
        // Writing to a string does not fail.
        let _ = match field.name() {
            "message" => write!(self.0, "{value:?}"),
            name => write!(self.0, " {name}={value:?}"),
        };
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;
    use std::sync::mpsc::{Receiver, channel};

    use super::*;

    /// A pipe that nobody reads until its sender is dropped.
    struct Stuck(Receiver<()>);

    impl Write for Stuck {
        fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
            let _ = self.0.recv();
            Ok(bytes.len())
        }

        fn flush(&mut self) -> std::io::Result<()> {
            Ok(())
        }
    }

    #[test]
    fn where_nobody_reads_stderr_lines_are_dropped_and_counted_and_nobody_waits() {
        const WRITTEN: usize = 3 * WAITING;
        let (end, stuck) = channel();
        let log = Log::default();
        let (mut writer, _guard) = log.writer(Stuck(stuck));
        for _ in 0..WRITTEN {
            writer.write_all(b"a line\n").expect("never refused");
        }
        // One line is in the pipe; the thread may not have taken it yet.
        let dropped = WRITTEN - WAITING;
        assert!((dropped - 1..=dropped).contains(&log.dropped()), "{} of {WRITTEN}", log.dropped());
        drop(end);
    }
}

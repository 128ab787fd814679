//! The last lines of the log, in memory, for the staff panel.

use std::collections::VecDeque;
use std::fmt::{self, Write as _};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tracing::field::{Field, Visit};
use tracing::{Event, Level, Subscriber};
use tracing_subscriber::layer::{Context, Layer};

/// Number of stored lines.
pub const CAPACITY: usize = 400;
/// Longest line, characters; longer ones are cut.
pub const LONGEST: usize = 2000;

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
pub struct Log(Arc<Mutex<VecDeque<LogLine>>>);

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
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
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

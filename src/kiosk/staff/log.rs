//! The last lines of the log, in memory, for the staff panel: what a curator without a terminal would read there.

use std::collections::VecDeque;
use std::fmt::{self, Write as _};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use tracing::field::{Field, Visit};
use tracing::{Event, Level, Subscriber};
use tracing_subscriber::layer::{Context, Layer};

/// Lines that are kept.
pub const KEPT: usize = 400;
/// Longest line, characters: a report of many problems is cut.
pub const LONGEST: usize = 2000;

/// One entry.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Line {
    /// Local time.
    pub time: jiff::civil::Time,
    /// How grave it is.
    pub level: Level,
    /// What was said.
    pub text: String,
}

/// The lines, shared by all who write and whoever reads.
#[derive(Clone, Debug, Default)]
pub struct Log(Arc<Mutex<VecDeque<Line>>>);

impl Log {
    /// Adds a line; the oldest goes where there are too many.
    pub fn push(&self, line: Line) {
        let mut lines = self.lines();
        if lines.len() >= KEPT {
            lines.pop_front();
        }
        lines.push_back(Line { text: line.text.chars().take(LONGEST).collect(), ..line });
    }

    /// All that is kept, the oldest first. Hold it briefly.
    pub fn lines(&self) -> MutexGuard<'_, VecDeque<Line>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl<S: Subscriber> Layer<S> for Log {
    fn on_event(&self, event: &Event<'_>, _: Context<'_, S>) {
        let mut said = Said(String::new());
        event.record(&mut said);
        self.push(Line { time: jiff::Zoned::now().time(), level: *event.metadata().level(), text: said.0 });
    }
}

/// The words of an event.
struct Said(String);

impl Visit for Said {
    fn record_debug(&mut self, field: &Field, value: &dyn fmt::Debug) {
        // Writing to a string does not fail.
        let _ = match field.name() {
            "message" => write!(self.0, "{value:?}"),
            name => write!(self.0, " {name}={value:?}"),
        };
    }
}

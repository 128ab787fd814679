//! Diagnostics: each problem says where it is, what is wrong, why, and what to do. A report lists them all.
//!
//! Shown on a terminal with the source line (miette), or as JSON. The codes are stable and listed in [`super::codes`].

use std::collections::BTreeMap;
use std::fmt;
use std::io::IsTerminal;
use std::ops::Range;
use std::sync::Arc;

use miette::{GraphicalReportHandler, GraphicalTheme, LabeledSpan, MietteDiagnostic, NamedSource};
use serde::Serialize;

use super::codes::Code;
use super::printable;

/// Most problems that are shown as text. Each is found again in the whole source, and nobody reads more at once.
const MAX_SHOWN: usize = 100;

/// Severity of a problem.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "lowercase")]
pub enum Severity {
    /// The exhibit runs, but something is probably a mistake.
    Warning,
    /// The exhibit cannot run.
    Error,
}

/// A place in a text file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Location {
    /// Name of the file as it was opened.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// Range of bytes, for the excerpt.
    #[serde(skip)]
    pub span: Range<usize>,
}

/// One problem.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Diagnostic {
    /// Stable code, such as `E0207`.
    pub code: &'static str,
    /// Error or warning.
    pub severity: Severity,
    /// What is wrong.
    pub message: String,
    /// Why it matters here; shown under the excerpt.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub label: String,
    /// What to do about it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub help: Option<String>,
    /// Place of the problem; `None` where it concerns a whole file without lines, which the message names.
    #[serde(flatten, skip_serializing_if = "Option::is_none")]
    pub location: Option<Location>,
}

impl Diagnostic {
    /// A problem without a place.
    pub fn new(code: Code, message: impl Into<String>) -> Self {
        Self {
            code: code.name,
            severity: if code.name.starts_with('E') { Severity::Error } else { Severity::Warning },
            message: message.into(),
            label: String::new(),
            help: None,
            location: None,
        }
    }

    /// Sets what to do.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }

    /// Sets the text under the excerpt.
    pub fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// Is it an error?
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }
}

/// All problems of one load, in the order of the file, with the texts that they refer to.
#[derive(Clone, Debug, Default)]
pub struct Report {
    /// The problems.
    pub diagnostics: Vec<Diagnostic>,
    sources: BTreeMap<String, Arc<str>>,
}

impl Report {
    /// A report of one problem.
    pub fn single(diagnostic: Diagnostic) -> Self {
        Self { diagnostics: vec![diagnostic], sources: BTreeMap::new() }
    }

    /// A report of problems in one text file.
    pub fn in_file(file: &str, text: Arc<str>, mut diagnostics: Vec<Diagnostic>) -> Self {
        diagnostics.sort_by_key(|d| d.location.as_ref().map_or(usize::MAX, |l| l.span.start));
        Self { diagnostics, sources: BTreeMap::from([(file.to_owned(), text)]) }
    }

    /// Is any of them an error?
    pub fn has_errors(&self) -> bool {
        self.diagnostics.iter().any(Diagnostic::is_error)
    }

    /// Does it contain a problem with this code?
    pub fn has(&self, code: Code) -> bool {
        self.diagnostics.iter().any(|d| d.code == code.name)
    }

    /// Adds all problems of another report.
    pub fn absorb(&mut self, other: Self) {
        self.diagnostics.extend(other.diagnostics);
        self.sources.extend(other.sources);
    }

    /// A JSON array with an object for each problem: `code`, `severity`, `message`, `label`, `help`, `file`, `line`,
    /// `column`.
    pub fn to_json(&self) -> serde_json::Value {
        // Plain strings and numbers cannot fail to serialise.
        serde_json::to_value(&self.diagnostics).unwrap_or_default()
    }

    /// The problems as text without colours.
    pub fn to_text(&self) -> String {
        self.render(GraphicalTheme::unicode_nocolor())
    }

    /// The problems as text for the standard error stream: coloured if that is a terminal.
    pub fn to_terminal_text(&self) -> String {
        let is_terminal = std::io::stderr().is_terminal();
        self.render(if is_terminal { GraphicalTheme::unicode() } else { GraphicalTheme::unicode_nocolor() })
    }

    fn render(&self, theme: GraphicalTheme) -> String {
        let handler = GraphicalReportHandler::new_themed(theme).with_links(false).with_width(110);
        let mut text = String::new();
        for diagnostic in self.diagnostics.iter().take(MAX_SHOWN) {
            if handler.render_report(&mut text, self.to_miette(diagnostic).as_ref()).is_err() {
                text.push_str(&printable::line(&diagnostic.message));
            }
            text.push('\n');
        }
        if let Some(more) = self.diagnostics.len().checked_sub(MAX_SHOWN).filter(|more| *more > 0) {
            text.push_str(&format!("and {more} more problems; mend these first\n"));
        }
        text
    }

    /// The one place where text of files comes to a terminal: all of it is made printable here.
    fn to_miette(&self, diagnostic: &Diagnostic) -> miette::Report {
        let mut dressed = MietteDiagnostic::new(printable::line(&diagnostic.message)).with_code(diagnostic.code);
        dressed.severity = Some(match diagnostic.severity {
            Severity::Error => miette::Severity::Error,
            Severity::Warning => miette::Severity::Warning,
        });
        dressed.help = diagnostic.help.as_deref().map(|help| printable::lines(help).into_owned());
        let placed = diagnostic.location.as_ref().and_then(|at| Some((at, self.sources.get(&at.file)?)));
        let Some((at, text)) = placed else { return miette::Report::new(dressed) };
        let label = if diagnostic.label.is_empty() { "here" } else { &diagnostic.label };
        // Escapes are longer than what they stand for, so the place moves.
        let moved = |byte: usize| printable::lines(&text[..text.floor_char_boundary(byte)]).len();
        let label = LabeledSpan::at(moved(at.span.start)..moved(at.span.end), printable::line(label));
        let source = NamedSource::new(printable::line(&at.file), printable::lines(text).into_owned());
        miette::Report::new(dressed.with_label(label)).with_source_code(source)
    }
}

impl From<Vec<Diagnostic>> for Report {
    fn from(diagnostics: Vec<Diagnostic>) -> Self {
        Self { diagnostics, sources: BTreeMap::new() }
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.to_terminal_text())
    }
}

impl std::error::Error for Report {}

/// The names most similar to `wanted` (Jaro–Winkler), best first, at most three.
pub fn similar_names<'a>(wanted: &str, names: impl Iterator<Item = &'a str>) -> Vec<&'a str> {
    /// Jaro–Winkler similarity below which two names count as unrelated.
    const SIMILARITY: f64 = 0.75;
    let lower = wanted.to_lowercase();
    let mut scored: Vec<(f64, &str)> = names
        .map(|name| (strsim::jaro_winkler(&lower, &name.to_lowercase()), name))
        .filter(|(score, _)| *score >= SIMILARITY)
        .collect();
    scored.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(b.1)));
    scored.dedup_by_key(|(_, name)| *name);
    scored.into_iter().take(3).map(|(_, name)| name).collect()
}

/// A list for messages: `"a", "b" or "c"`.
pub fn quoted(names: &[&str]) -> String {
    names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ")
}

//! Timbres of an exhibit's own folder: `timbres/<name>.toml`.
//!
//! All files there are read and checked, whether a sound names them or not, so that a curator hears of each mistake at once. One of
//! the name of a shipped timbre goes before it.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use super::budget::Budget;
use super::codes;
use super::diagnostic::{Diagnostic, Location, Report};
use super::files;
use soffio_sound::{Preset, TimbreError};

/// Folder of the timbres inside an exhibit's folder.
pub const FOLDER: &str = "timbres";
/// Largest file, bytes: the bound of the format.
const LARGEST: u64 = 1 << 20;
/// Memory of a parsed timbre over its size, as of a sidecar.
const PARSED: u64 = 200;
/// Most files: far more than an exhibit has instruments.
const MOST: usize = 256;

/// The timbres of one folder.
#[derive(Debug, Default)]
pub(super) struct OwnTimbres {
    files: BTreeMap<String, OwnTimbre>,
    problems: Vec<Diagnostic>,
}

/// One file.
#[derive(Debug)]
struct OwnTimbre {
    /// Its path, for messages.
    path: String,
    text: Arc<str>,
    /// `None` where it is not valid.
    preset: Option<Arc<Preset>>,
}

impl OwnTimbres {
    /// Reads and checks all files of an exhibit's folder.
    pub fn read(folder: &Path, budget: &Budget) -> Self {
        let mut own = Self::default();
        let Ok(entries) = std::fs::read_dir(folder.join(FOLDER)) else { return own };
        let mut names: Vec<String> =
            entries.flatten().filter_map(|entry| entry.file_name().into_string().ok()).collect();
        // The order of a folder is that of the disk.
        names.sort();
        let wanted = names.iter().filter(|name| !name.starts_with('.'));
        for name in wanted.filter_map(|name| name.strip_suffix(".toml")).take(MOST) {
            let relative = format!("{FOLDER}/{name}.toml");
            if let Err(problem) = own.read_file(name, folder, &relative, budget) {
                own.problems.push(problem);
            }
        }
        own
    }

    fn read_file(&mut self, name: &str, folder: &Path, relative: &str, budget: &Budget) -> Result<(), Diagnostic> {
        let path = folder.join(relative).display().to_string();
        let file = files::open_inside(folder, relative)?.within(LARGEST)?;
        budget.charge(PARSED * file.size()).map_err(|excess| excess.diagnostic(&path))?;
        let bytes = file.read()?;
        let text = String::from_utf8(bytes).map_err(|error| {
            Diagnostic::new(codes::SYNTAX, format!("{path} is not UTF-8: {error}")).help("save it as UTF-8")
        })?;
        let parsed = Preset::parse(name, &text);
        let (preset, error) = match parsed {
            Ok(preset) => (Some(Arc::new(preset)), None),
            Err(error) => (None, Some(error)),
        };
        self.files.insert(name.to_owned(), OwnTimbre { path, text: text.into(), preset });
        match error {
            Some(error) => Err(self.problem(name, &error)),
            None => Ok(()),
        }
    }

    /// Names of all files, valid or not.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.files.keys().map(String::as_str)
    }

    /// Whether there is a file of this name, valid or not.
    pub fn has(&self, name: &str) -> bool {
        self.files.contains_key(name)
    }

    /// The timbre of a valid file.
    pub fn preset(&self, name: &str) -> Option<Arc<Preset>> {
        self.files.get(name)?.preset.clone()
    }

    /// All valid ones.
    pub fn presets(&self) -> Vec<Arc<Preset>> {
        self.files.values().filter_map(|file| file.preset.clone()).collect()
    }

    /// A problem of a file, at its line.
    pub fn problem(&self, name: &str, error: &TimbreError) -> Diagnostic {
        let message = format!("timbre \"{name}\", {}: {}", error.key, error.problem);
        let problem = Diagnostic::new(codes::BROKEN_TIMBRE, message)
            .help(format!("mend {FOLDER}/{name}.toml; `soffio sound` plays it alone"));
        let Some(file) = self.files.get(name) else { return problem };
        let line = error.line.or_else(|| Preset::line_of(&file.text, &error.key)).unwrap_or(1);
        let start: usize = file.text.split_inclusive('\n').take(line - 1).map(str::len).sum();
        let length = file.text[start..].lines().next().map_or(0, str::len);
        let location = Location { file: file.path.clone(), line, column: 1, span: start..start + length };
        Diagnostic { location: Some(location), ..problem }
    }

    /// The problems found in reading, with the texts of all files.
    pub fn into_report(self) -> Report {
        let mut report = Report::from(self.problems);
        for file in self.files.into_values() {
            report.absorb(Report::in_file(&file.path, file.text, Vec::new()));
        }
        report
    }
}

//! `soffio check --fix`: rewrites files with old names. Comments and layout stay; a file without old names is not touched.

use std::io::Write as _;
use std::path::{Path, PathBuf};

use super::failure::Failure;
use soffio_exhibit::renamed::{self, FileKind};
use soffio_exhibit::{self as exhibit, Report, SIDECAR, files};
use soffio_offline::atomic_file::AtomicFile;

/// Most bytes of a file: physics scenes are the longest.
const MAX_BYTES: u64 = 64 << 20;

/// A file that is going to be rewritten.
struct Rewrite {
    file: PathBuf,
    text: String,
    /// What changes, a line each.
    changes: Vec<String>,
}

/// Rewrites the files at these paths. Either all of them are written or, where one has a problem, none.
pub(super) fn run(paths: &[String]) -> Result<(), Failure> {
    let mut rewrites = Vec::new();
    for path in paths {
        let Some((file, kind)) = target(path) else { continue };
        match plan(&file, kind)? {
            Some(rewrite) => rewrites.push(rewrite),
            None => eprintln!("{}: no old names", file.display()),
        }
    }
    let ready = rewrites.iter().map(Rewrite::write_aside).collect::<Result<Vec<_>, _>>()?;
    for (rewrite, aside) in rewrites.iter().zip(ready) {
        aside.finish_durably().map_err(Failure::input)?;
        rewrite.changes.iter().for_each(|change| eprintln!("{change}"));
    }
    Ok(())
}

/// The file behind a path, and its kind; `None` for a file that has no names to fix, such as a model.
fn target(path: &str) -> Option<(PathBuf, FileKind)> {
    let file = Path::new(path);
    match file.extension().and_then(|extension| extension.to_str()).unwrap_or_default() {
        "toml" if file.file_name().is_some_and(|name| name == SIDECAR) => Some((file.into(), FileKind::Sidecar)),
        "toml" => Some((file.into(), FileKind::Configuration)),
        "json" => Some((file.into(), FileKind::Scene)),
        "glb" | "gltf" => None,
        _ => exhibit::resolve(path).ok().map(|folder| (folder.join(SIDECAR), FileKind::Sidecar)),
    }
}

/// What there is to rewrite in a file; `None` where it has no old name.
fn plan(file: &Path, kind: FileKind) -> Result<Option<Rewrite>, Failure> {
    let cannot = |why: &dyn std::fmt::Display| Failure::input(format!("{} cannot be rewritten: {why}", file.display()));
    let text = files::read_text(file, MAX_BYTES).map_err(|problem| Failure::input(Report::single(problem)))?;
    if let Err(why) = well_formed(kind, &text) {
        return Err(cannot(&format!("{why}; `soffio check` says where")));
    }
    let updated = renamed::update(kind, &text);
    if updated.replacements.is_empty() {
        return Ok(None);
    }
    if let Err(why) = well_formed(kind, &updated.text) {
        let names = updated.replacements.iter().map(ToString::to_string).collect::<Vec<_>>().join(", ");
        return Err(cannot(&format!("{names}, and the new name is there already; delete one of the two ({why})")));
    }
    let changes = updated.replacements.iter().map(|change| {
        let before = &text[..change.span.start];
        let line = before.matches('\n').count() + 1;
        let column = before.chars().rev().take_while(|c| *c != '\n').count() + 1;
        format!("{}:{line}:{column}: {change}: rewritten", file.display())
    });
    let changes = changes.collect();
    Ok(Some(Rewrite { file: file.into(), text: updated.text.into_owned(), changes }))
}

/// Can the grammar of the text be read?
fn well_formed(kind: FileKind, text: &str) -> Result<(), String> {
    match kind {
        FileKind::Configuration | FileKind::Sidecar => {
            text.parse::<toml::Table>().map(drop).map_err(|error| error.message().to_owned())
        }
        FileKind::Scene => serde_json::from_str::<serde::de::IgnoredAny>(text).map(drop).map_err(|e| e.to_string()),
    }
}

impl Rewrite {
    /// Writes the text beside the file, or beside the one that it links to, with the same permissions.
    fn write_aside(&self) -> Result<AtomicFile, Failure> {
        let write = || {
            let mut aside = AtomicFile::create(&self.file)?;
            aside.write_all(self.text.as_bytes())?;
            Ok(aside)
        };
        write().map_err(|error: std::io::Error| Failure::input(error))
    }
}

//! Paths: an exhibit reads only files in its own folder; ids are looked up in the folders of exhibits.

use std::path::{Component, Path, PathBuf};

use super::codes;
use super::diagnostic::{Diagnostic, Report, quoted, similar_names};

/// File name of the sidecar in an exhibit folder.
pub const SIDECAR: &str = "exhibit.toml";

/// A hint that names similar files in the folder of `path`.
pub(super) fn in_its_place(path: &Path) -> String {
    let entries = path.parent().map(folder_or_here).and_then(|folder| std::fs::read_dir(folder).ok());
    let mut names: Vec<String> = entries
        .into_iter()
        .flat_map(|entries| entries.flatten())
        .filter(|entry| entry.path().is_file())
        .map(|entry| entry.file_name())
        .filter(|name| Path::new(name).extension() == path.extension())
        .map(|name| name.to_string_lossy().into_owned())
        .collect();
    names.sort();
    let wanted = path.file_name().unwrap_or_default().to_string_lossy();
    meant(&wanted, &names).unwrap_or_else(|| "copy it there, or name an existing file".to_owned())
}

/// A hint that names the entries of `names` that `wanted` may mean; empty where there are none.
fn meant(wanted: &str, names: &[String]) -> Option<String> {
    /// Most names listed in a message.
    const SHOWN: usize = 40;
    match similar_names(wanted, names.iter().map(String::as_str)).as_slice() {
        [] if names.is_empty() => None,
        [] if names.len() > SHOWN => Some(format!("available: {} and others", names[..SHOWN].join(", "))),
        [] => Some(format!("available: {}", names.join(", "))),
        likely => Some(format!("did you mean {}?", quoted(likely))),
    }
}

/// The file `relative` inside `folder`.
///
/// # Errors
/// Where the path contains `..`, is absolute, is a network address, or is a link that leads out of the folder.
pub fn inside(folder: &Path, relative: &str) -> Result<PathBuf, Diagnostic> {
    let outside = |why: &str| {
        Diagnostic::new(codes::OUTSIDE, format!("the path \"{relative}\" {why}"))
            .help("put the file into the exhibit folder and give its path from there")
    };
    if relative.contains("://") || relative.contains('\\') {
        return Err(outside("is not a path inside the exhibit folder"));
    }
    let path = Path::new(relative);
    if !path.components().all(|part| matches!(part, Component::Normal(_) | Component::CurDir)) {
        return Err(outside("leaves the exhibit folder"));
    }
    let full = folder.join(path);
    if let (Ok(real), Ok(base)) = (full.canonicalize(), folder_or_here(folder).canonicalize())
        && !real.starts_with(&base)
    {
        return Err(outside("is a link that leads out of the exhibit folder"));
    }
    Ok(full)
}

pub(super) fn folder_or_here(folder: &Path) -> &Path {
    if folder.as_os_str().is_empty() { Path::new(".") } else { folder }
}

/// A URI path with its percent-encoded characters decoded.
pub fn percent_decoded(uri: &str) -> String {
    let bytes = uri.as_bytes();
    let mut out = Vec::with_capacity(bytes.len());
    let mut i = 0;
    while i < bytes.len() {
        let hex = (bytes[i] == b'%').then(|| uri.get(i + 1..i + 3)).flatten();
        match hex.and_then(|hex| u8::from_str_radix(hex, 16).ok()) {
            Some(byte) => {
                out.push(byte);
                i += 3;
            }
            None => {
                out.push(bytes[i]);
                i += 1;
            }
        }
    }
    String::from_utf8_lossy(&out).into_owned()
}

/// Folder of the exhibits installed with the program: `../share/soffio/exhibits` beside its own folder.
fn installed() -> Option<PathBuf> {
    let program = std::env::current_exe().ok()?;
    Some(program.parent()?.parent()?.join("share/soffio/exhibits")).filter(|folder| folder.is_dir())
}

/// The folder of exhibits that a site's configuration names; if it does not exist, the one installed with the program.
pub fn exhibits_folder(folder: &Path) -> PathBuf {
    let missing = folder.is_relative() && !folder.is_dir();
    installed().filter(|_| missing).unwrap_or_else(|| folder.to_path_buf())
}

/// Folders of exhibits: `exhibits/` here or above, beside the program, installed with it, or in the source tree of a
/// debug build.
fn catalog_folders() -> Vec<PathBuf> {
    let mut catalog_folders = Vec::new();
    let mut from = |start: Option<PathBuf>| {
        if let Some(start) = start {
            catalog_folders
                .extend(start.ancestors().map(|folder| folder.join("exhibits")).filter(|folder| folder.is_dir()));
        }
    };
    from(std::env::current_dir().ok());
    from(std::env::current_exe().ok().and_then(|program| program.parent().map(Path::to_path_buf)));
    if cfg!(debug_assertions) {
        from(Some(PathBuf::from(env!("CARGO_MANIFEST_DIR"))));
    }
    catalog_folders.extend(installed());
    catalog_folders
}

/// Ids of the exhibits that can be found.
pub fn ids() -> Vec<String> {
    let mut ids: Vec<String> = catalog_folders()
        .iter()
        .filter_map(|shelf| std::fs::read_dir(shelf).ok())
        .flat_map(|entries| entries.flatten())
        .filter(|entry| entry.path().join(SIDECAR).is_file())
        .map(|entry| entry.file_name().to_string_lossy().into_owned())
        .filter(|id| !id.starts_with('.'))
        .collect();
    ids.sort();
    ids.dedup();
    ids
}

/// The folder of an exhibit: an id under `exhibits/`, or a folder.
///
/// # Errors
/// There is no such folder; the report names similar ids.
pub fn resolve(id_or_folder: &str) -> Result<PathBuf, Report> {
    let folder = PathBuf::from(id_or_folder);
    if folder.join(SIDECAR).is_file() {
        return Ok(folder);
    }
    let is_id = !id_or_folder.is_empty() && !id_or_folder.contains(['/', '\\', '.']);
    let found = catalog_folders().into_iter().map(|shelf| shelf.join(id_or_folder)).find(|f| f.join(SIDECAR).is_file());
    if let (true, Some(found)) = (is_id, found) {
        return Ok(found);
    }
    if folder.is_dir() {
        let message = format!("the folder {id_or_folder} has no {}", SIDECAR);
        let help = "`soffio new` creates an exhibit, `soffio import` makes one from a model";
        return Err(Report::single(Diagnostic::new(codes::NO_EXHIBIT, message).help(help)));
    }
    let help = meant(id_or_folder, &ids())
        .unwrap_or_else(|| "there is no folder exhibits/ here, above, or beside the program".to_owned());
    let message = format!("no exhibit \"{id_or_folder}\": it is neither an id under exhibits/ nor a folder");
    Err(Report::single(Diagnostic::new(codes::NO_EXHIBIT, message).help(help)))
}

//! The typefaces of overlay and panel: a light sans for Latin, Greek and Cyrillic from the panel library, and for
//! Chinese, Japanese and Korean the first of some well-known open fonts that the system has.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::{FontData, FontDefinitions, FontFamily};

/// Files that hold Hangul, Kana and Han, best first, with the face to take from a collection.
const EAST_ASIAN: &[(&str, u32)] = &[
    ("NotoSansCJK-Light.ttc", 1),
    ("NotoSansCJK-Regular.ttc", 1),
    ("NotoSansKR-Light.otf", 0),
    ("NotoSansKR-Regular.otf", 0),
    ("NotoSansKR-Regular.ttf", 0),
    ("NanumGothicLight.ttf", 0),
    ("NanumGothic.ttf", 0),
    ("NanumBarunGothic.ttf", 0),
    ("UnDotum.ttf", 0),
    ("DroidSansFallbackFull.ttf", 0),
    ("DroidSansFallback.ttf", 0),
];

/// Folders that hold a system's fonts.
const FOLDERS: &[&str] = &["/usr/share/fonts", "/usr/local/share/fonts", "/run/host/fonts"];

/// Deepest folder that is looked into.
const DEPTH: usize = 5;

/// The East Asian font of this system, with the face to take from it.
pub fn find_east_asian() -> Option<(PathBuf, u32)> {
    let home = std::env::var_os("HOME").map(|home| PathBuf::from(home).join(".local/share/fonts"));
    let folders = home.into_iter().chain(FOLDERS.iter().map(PathBuf::from));
    let files: Vec<PathBuf> = folders.flat_map(|folder| files_below(&folder, DEPTH)).collect();
    EAST_ASIAN.iter().find_map(|&(name, face)| {
        let file = files.iter().find(|file| file.file_name().is_some_and(|found| found == name))?;
        Some((file.clone(), face))
    })
}

/// The fonts for the panel library, the system's East Asian font as the last resort of every family.
pub fn definitions() -> FontDefinitions {
    let mut fonts = FontDefinitions::default();
    let Some((file, face)) = find_east_asian() else { return fonts };
    match std::fs::read(&file) {
        Ok(bytes) => {
            let data = FontData { index: face, ..FontData::from_owned(bytes) };
            fonts.font_data.insert("east-asian".into(), Arc::new(data));
            for family in [FontFamily::Proportional, FontFamily::Monospace] {
                fonts.families.entry(family).or_default().push("east-asian".into());
            }
        }
        Err(error) => tracing::warn!("{}: {error}", file.display()),
    }
    fonts
}

/// All files below a folder; unreadable folders hold none.
fn files_below(folder: &Path, depth: usize) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut files = Vec::new();
    for path in entries.flatten().map(|entry| entry.path()) {
        if !path.is_dir() {
            files.push(path);
        } else if depth > 0 {
            files.extend(files_below(&path, depth - 1));
        }
    }
    files
}

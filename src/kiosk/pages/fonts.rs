//! Fonts of pages and staff panel.
//!
//! Latin, Greek and Cyrillic use the panel library's light sans-serif. Chinese, Japanese and Korean, Hebrew, and Arabic use the
//! first installed one of some well-known open fonts.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::{FontData, FontDefinitions, FontFamily};

/// Font files with Hangul, Kana and Han, best first, with the index of the face in a collection.
/// Debian's Droid Sans Fallback is left out, as it lacks Hangul.
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
];

/// Font files with Hebrew, and with Arabic and its joined forms, best first.
const HEBREW: &[(&str, u32)] = &[
    ("NotoSansHebrew-Light.ttf", 0),
    ("NotoSansHebrew-Regular.ttf", 0),
    ("NotoSansHebrew-VF.ttf", 0),
    ("DejaVuSans.ttf", 0),
];
const ARABIC: &[(&str, u32)] = &[
    ("NotoSansArabic-Light.ttf", 0),
    ("NotoSansArabic-Regular.ttf", 0),
    ("NotoNaskhArabic-Regular.ttf", 0),
    ("DejaVuSans.ttf", 0),
];

/// Folders of the system's fonts.
const FOLDERS: &[&str] = &["/usr/share/fonts", "/usr/local/share/fonts", "/run/host/fonts"];

/// Depth to which folders are searched.
const DEPTH: usize = 5;

/// A script for which the panel library has no glyphs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Script {
    /// Chinese, Japanese and Korean.
    EastAsian,
    /// Hebrew.
    Hebrew,
    /// Arabic, Persian and Urdu.
    Arabic,
}

impl Script {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::EastAsian, Self::Hebrew, Self::Arabic];

    /// Name of its font in the panel library.
    fn name(self) -> &'static str {
        match self {
            Self::EastAsian => "east-asian",
            Self::Hebrew => "hebrew",
            Self::Arabic => "arabic",
        }
    }

    fn files(self) -> &'static [(&'static str, u32)] {
        match self {
            Self::EastAsian => EAST_ASIAN,
            Self::Hebrew => HEBREW,
            Self::Arabic => ARABIC,
        }
    }
}

/// This system's font file for a script, and the index of the face in it.
pub fn find(script: Script) -> Option<(PathBuf, u32)> {
    first_installed(&installed(), script)
}

/// All files in the system's font folders.
fn installed() -> Vec<PathBuf> {
    let home = std::env::var_os("HOME").map(|home| PathBuf::from(home).join(".local/share/fonts"));
    let folders = home.into_iter().chain(FOLDERS.iter().map(PathBuf::from));
    folders.flat_map(|folder| files_below(&folder, DEPTH)).collect()
}

fn first_installed(files: &[PathBuf], script: Script) -> Option<(PathBuf, u32)> {
    script.files().iter().find_map(|&(name, face)| {
        let file = files.iter().find(|file| file.file_name().is_some_and(|found| found == name))?;
        Some((file.clone(), face))
    })
}

/// Font definitions for the panel library: the system's fonts for other scripts are the last fallback of every family.
pub fn definitions() -> FontDefinitions {
    let mut fonts = FontDefinitions::default();
    let files = installed();
    for script in Script::ALL {
        let Some((file, face)) = first_installed(&files, script) else { continue };
        match std::fs::read(&file) {
            Ok(bytes) => {
                let data = FontData { index: face, ..FontData::from_owned(bytes) };
                fonts.font_data.insert(script.name().into(), Arc::new(data));
                for family in [FontFamily::Proportional, FontFamily::Monospace] {
                    fonts.families.entry(family).or_default().push(script.name().into());
                }
            }
            Err(error) => tracing::warn!("{}: {error}", file.display()),
        }
    }
    fonts
}

/// All files below a folder; unreadable folders count as empty.
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

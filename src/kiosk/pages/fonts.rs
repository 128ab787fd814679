//! The typefaces of overlay and panel: a light sans for Latin, Greek and Cyrillic from the panel library, and for Chinese,
//! Japanese and Korean, for Hebrew and for Arabic the first of some well-known open fonts that the system has.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use egui::{FontData, FontDefinitions, FontFamily};

/// Files that hold Hangul, Kana and Han, best first, with the face to take from a collection.
/// Droid Sans Fallback is none of them: as Debian has it, it lacks Hangul.
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

/// Files that hold Hebrew, and Arabic with its joined forms, best first.
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

/// Folders that hold a system's fonts.
const FOLDERS: &[&str] = &["/usr/share/fonts", "/usr/local/share/fonts", "/run/host/fonts"];

/// Deepest folder that is looked into.
const DEPTH: usize = 5;

/// What is written in scripts that the panel library has no letters for.
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

    /// As the panel library calls its font.
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

/// This system's font for a script, and the face to take from it.
pub fn find(script: Script) -> Option<(PathBuf, u32)> {
    first_installed(&installed(), script)
}

/// Files of all fonts of this system.
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

/// The fonts for the panel library, the system's fonts for other scripts as the last resort of every family.
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

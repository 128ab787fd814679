//! Model making: sheet metal, wire and wood from stated dimensions, balanced mobiles, glTF files and sidecars.
//!
//! The shipped exhibits (`exhibits/forge`) and new ones of curators (`soffio new`) are made by the same code.
//! Invariant: no clock, no unseeded randomness, software transcendentals, so the same dimensions give the same bytes on
//! any machine. Only drawings ([`drawing`]) use arithmetic of other crates.
//!
//! The crate writes no file: it returns the files of a folder ([`ExhibitFolder`]), which the program writes. It does
//! not simulate.
//!
//! | module | holds |
//! |---|---|
//! | [`starter`], [`template`], [`notes`] | new folders of `soffio new`: a mobile, a chime, a copy, an empty exhibit |
//! | [`imported`], [`khr`] | sidecars for glTF models from elsewhere |
//! | [`drawing`], [`outline`] | outlines from SVG, splines, rings |
//! | [`solid`], [`piece`], [`stock_parts`] | sheet metal, turned parts and wire, with their mass |
//! | [`mobile`], [`tree`], [`hanging`] | balanced branches and their loads |
//! | [`glb`], [`model_writer`] | the glTF writer |
//!
//! ```
//! use soffio_authoring::{id_problem, starter};
//!
//! assert!(id_problem("my-mobile").is_none());
//! assert!(id_problem("My mobile!").is_some());
//!
//! let made = starter::empty("my-mobile");
//! let names: Vec<&str> = made.files.iter().map(|file| file.name.as_str()).collect();
//! assert!(names.contains(&"exhibit.toml"), "{names:?}");
//! assert_eq!(made.files, starter::empty("my-mobile").files, "the same input gives the same bytes");
//! ```

use soffio_exhibit::diagnostic::Diagnostic;

pub mod chimes;
pub mod drawing;
pub mod glb;
pub mod hanging;
pub mod imported;
pub mod khr;
mod khr_joint;
pub mod mobile;
pub mod model_writer;
mod nodes;
pub mod notes;
pub mod outline;
pub mod piece;
pub mod plate_mobile;
pub mod solid;
pub mod starter;
pub mod stock_parts;
pub mod template;
pub mod texts;
pub mod tree;

/// A file of an exhibit folder.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FolderFile {
    /// Path inside the folder.
    pub name: String,
    /// Contents.
    pub bytes: Vec<u8>,
}

/// The files of a new exhibit, not yet written to disk.
#[derive(Clone, Debug, Default)]
pub struct ExhibitFolder {
    /// All files of the folder.
    pub files: Vec<FolderFile>,
    /// Messages for the curator, one line each.
    pub remarks: Vec<String>,
}

impl ExhibitFolder {
    /// The two files of a plain exhibit: `exhibit.toml` and `<id>.glb`.
    fn files_of(id: &str, sidecar: String, model: Vec<u8>) -> Vec<FolderFile> {
        vec![
            FolderFile { name: soffio_exhibit::SIDECAR.into(), bytes: sidecar.into_bytes() },
            FolderFile { name: format!("{id}.glb"), bytes: model },
        ]
    }
}

/// Reports a wrong id: ids are lower-case letters, digits and hyphens, at most 64.
pub fn id_problem(id: &str) -> Option<Diagnostic> {
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit();
    let good = id.len() <= 64 && id.starts_with(plain) && id.chars().all(|c| plain(c) || c == '-');
    (!good).then(|| {
        Diagnostic::new(soffio_exhibit::codes::NEW, format!("\"{id}\" is not an id for an exhibit"))
            .help("use lower-case letters, digits and hyphens, such as \"red-mobile\"")
    })
}

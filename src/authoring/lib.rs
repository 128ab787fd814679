//! Models made from stated dimensions: sheet metal, wire, wood, and where they balance; glTF and sidecars written down.
//!
//! The shipped exhibits (`exhibits/forge`) and those that a curator begins (`soffio new`) are made by the same code.
//! Invariant: no clock, no randomness without a stated seed, software transcendentals: the same dimensions give the same
//! bytes on any machine. Drawings alone ([`drawing`]) pass through arithmetic that is not ours.

use soffio_exhibit::diagnostic::Diagnostic;

pub mod chimes;
pub mod drawing;
pub mod given;
pub mod glb;
pub mod hung;
pub mod imported;
pub mod khr;
mod khr_joint;
pub mod mobile;
pub mod model_writer;
mod nodes;
pub mod notes;
pub mod outline;
pub mod piece;
pub mod solid;
pub mod starter;
pub mod stock;
pub mod template;
pub mod tree;
pub mod words;

/// A file of an exhibit folder: its name there, and what it holds.
pub type File = (String, Vec<u8>);

/// What is made for a new exhibit.
#[derive(Clone, Debug, Default)]
pub struct Made {
    /// All files of the folder.
    pub files: Vec<File>,
    /// What the maker should know, a line each.
    pub remarks: Vec<String>,
}

/// Is this an id: lower-case letters, digits and hyphens, at most 64 of them?
pub fn id_problem(id: &str) -> Option<Diagnostic> {
    let plain = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit();
    let good = id.len() <= 64 && id.starts_with(plain) && id.chars().all(|c| plain(c) || c == '-');
    (!good).then(|| {
        Diagnostic::new(soffio_exhibit::codes::NEW, format!("\"{id}\" is no id for an exhibit"))
            .help("use lower-case letters, digits and hyphens, such as \"red-mobile\"")
    })
}

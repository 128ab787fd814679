//! Recordings of a venue: breaths and its noise, as WAV files beside a table `labels.csv`.
//!
//! `soffio-record-breaths` makes such a folder, and `soffio breath fit` reads it. The table names no person.

use std::path::Path;

use serde::{Deserialize, Serialize};

use super::atomic_file::AtomicFile;
use super::wav::{self, Recording};

/// Name of the table in the folder.
pub const LABELS: &str = "labels.csv";

/// What a recording holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Kind {
    /// One breath, after a second or more of the room.
    Breath,
    /// The room without people.
    EmptyRoom,
    /// The room with visitors, none of whom blows at the microphone.
    FullRoom,
}

/// A row of the table.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Label {
    /// Name of the file, beside the table.
    pub file: String,
    /// What it holds.
    pub kind: Kind,
    /// From the lips to the microphone, cm.
    pub distance_cm: Option<f64>,
    /// Between the breath and the line to the microphone, degrees.
    pub angle_deg: Option<f64>,
    /// Group of age of who blows: `child`, `adult`, `old`, or empty.
    #[serde(default)]
    pub age_group: String,
}

/// Reads the table and its recordings.
///
/// # Errors
/// Says which file or row is wrong, and what to do.
pub fn read(folder: &Path) -> Result<Vec<(Label, Recording)>, String> {
    let path = folder.join(LABELS);
    let mut table = csv::Reader::from_path(&path).map_err(|error| {
        format!("{}: {error}. Name a folder that `soffio-record-breaths` has made.", path.display())
    })?;
    let labels: Vec<Label> = table.deserialize().collect::<Result<_, _>>().map_err(|error| {
        format!(
            "{}: {error}. Columns: file, kind (breath, empty_room or full_room), distance_cm, angle_deg, age_group.",
            path.display()
        )
    })?;
    let recorded = |label: Label| match wav::read(folder.join(&label.file)) {
        Ok(recording) => Ok((label, recording)),
        Err(error) => Err(error.to_string()),
    };
    labels.into_iter().map(recorded).collect()
}

/// Writes the table in place of the one before, whole or not at all.
///
/// # Errors
/// The file cannot be written.
pub fn write_labels(folder: &Path, labels: &[Label]) -> std::io::Result<()> {
    let file = AtomicFile::create(&folder.join(LABELS))?;
    let mut table = csv::Writer::from_writer(file.reopen()?);
    labels.iter().try_for_each(|label| table.serialize(label))?;
    table.flush()?;
    file.finish()
}

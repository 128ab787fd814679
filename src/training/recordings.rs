//! Reader of a folder of labelled recordings: `labels.csv` and the WAVs it names.
//!
//! Columns that are read, by name: file, label, expected (blow, not_blow, ambiguous), onset_s, offset_s, level, snr_db,
//! group. A recording without a group is a group of its own.

use std::path::Path;

use soffio_offline::wav;
use soffio_soundscape::{Breath, Kind, Take};

/// Labels of sounds that must never trigger.
const IMPULSES: [&str; 4] = ["impulse", "plosive_pop", "clap", "handling_thump"];

/// Reads a folder of labelled recordings.
///
/// # Errors
/// Names the file or line that is wrong.
pub fn read(folder: &Path) -> Result<Vec<Take>, String> {
    let path = folder.join("labels.csv");
    let table = std::fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let mut lines = table.lines();
    let names: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let column = |name: &str| {
        let missing = || format!("{}: has no column \"{name}\"", path.display());
        names.iter().position(|n| *n == name).ok_or_else(missing)
    };
    let [file, label, expected, group] = [column("file")?, column("label")?, column("expected")?, column("group")?];
    let [onset, offset, level, snr] = ["onset_s", "offset_s", "level", "snr_db"].map(|name| column(name).ok());
    lines
        .enumerate()
        .map(|(i, line)| {
            // Only the last column (notes) may hold commas.
            let cell: Vec<&str> = line.splitn(names.len(), ',').collect();
            if cell.len() < names.len() {
                return Err(format!(
                    "{}: line {} has {} columns of {}",
                    path.display(),
                    i + 2,
                    cell.len(),
                    names.len()
                ));
            }
            let number = |column: Option<usize>| column.and_then(|c| cell[c].parse::<f64>().ok());
            let kind = match cell[expected] {
                "blow" => Kind::Blow,
                "not_blow" if IMPULSES.contains(&cell[label]) => Kind::Impulse,
                "not_blow" => Kind::Noise,
                _ => Kind::Ambiguous,
            };
            let recording = wav::read(folder.join(cell[file])).map_err(|error| error.to_string())?;
            let span = number(onset).zip(number(offset)).filter(|_| kind == Kind::Blow);
            let breath =
                span.map(|(onset, offset)| Breath { onset, offset, strength: 0.0, snr_db: number(snr), faint: false });
            Ok(Take {
                name: cell[file].into(),
                group: if cell[group].is_empty() { cell[file].into() } else { cell[group].into() },
                label: cell[label].into(),
                kind,
                breaths: breath.into_iter().collect(),
                level: number(level),
                left: recording.samples,
                right: None,
                played: Vec::new(),
                events: Vec::new(),
                sample_rate: recording.sample_rate,
            })
        })
        .collect()
}

//! A session: consent, ten breaths, the empty and the full room.

use std::io::{BufRead, Write};
use std::path::Path;

use soffio_offline::venue_recordings::{self, Kind, Label};
use soffio_offline::wav;

/// Length of the recording of a breath, s: the room for two seconds, then the breath.
pub const BREATH_S: f64 = 7.0;

/// Samples of a recording.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Recorded {
    /// Samples of each channel, full scale ±1.
    pub channels: Vec<Vec<f32>>,
    /// Sample rate, Hz.
    pub sample_rate: u32,
}

/// How much is recorded.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// Number of breaths.
    pub breaths: usize,
    /// Length of each recording of the room, s.
    pub ambient_s: f64,
}

/// Guides through a session: asks on `out`, reads answers from `answers`, and writes recordings of `record` to the folder. The table is
/// written after each recording, so nothing is lost if the session ends early.
///
/// # Errors
/// Nobody consented, the microphone is silent, or a file cannot be written.
pub fn guide(
    folder: &Path,
    plan: Plan,
    answers: &mut dyn BufRead,
    out: &mut dyn Write,
    record: &mut dyn FnMut(f64) -> Result<Recorded, String>,
) -> Result<(), String> {
    let mut ask = |question: &str| -> Result<String, String> {
        let mut line = String::new();
        write!(out, "{question} ").and_then(|()| out.flush()).map_err(|error| error.to_string())?;
        match answers.read_line(&mut line) {
            Ok(0) => Err("the session ended: no more answers".to_owned()),
            Ok(_) => Ok(line.trim().to_owned()),
            Err(error) => Err(error.to_string()),
        }
    };
    let consent = ask(&format!(
        "This records the microphone into {}: {} breaths of {BREATH_S:.0} s, and {:.0} s each of the empty and the full room.\n\
         It writes WAV files and a table with distance, angle and group of age, and no names. Delete the folder to undo it.\n\
         Put up a notice while the room is recorded. Does everybody who will be heard agree? (yes/no)",
        folder.display(),
        plan.breaths,
        plan.ambient_s
    ))?;
    if consent != "yes" {
        return Err("nothing was recorded".to_owned());
    }
    std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut labels: Vec<Label> = Vec::new();
    let mut keep = |label: Label, recorded: &Recorded| -> Result<(), String> {
        let count = recorded.channels.len();
        let longest = recorded.channels.iter().map(Vec::len).max().unwrap_or(0);
        let frame = |i: usize| recorded.channels.iter().map(move |channel| channel.get(i).copied().unwrap_or(0.0));
        let samples: Vec<f32> = (0..longest).flat_map(frame).collect();
        wav::write_float(folder.join(&label.file), count as u16, recorded.sample_rate, &samples)
            .map_err(|error| error.to_string())?;
        labels.push(label);
        venue_recordings::write_labels(folder, &labels).map_err(|error| format!("{}: {error}", folder.display()))
    };
    let ambient = |file: &str, kind| Label {
        file: file.to_owned(),
        kind,
        distance_cm: None,
        angle_deg: None,
        age_group: String::new(),
    };
    ask("The empty room: be silent, with ventilation and loudspeakers as always. Press Enter to begin.")?;
    keep(ambient("empty-room.wav", Kind::EmptyRoom), &record(plan.ambient_s)?)?;
    for number in 1..=plan.breaths {
        let question = format!(
            "Breath {number} of {}: distance from lips to microphone in cm, angle beside it in degrees, child, adult or old? \
             For example: 30 0 adult",
            plan.breaths
        );
        let (distance, angle, age) = loop {
            if let Some(read) = position(&ask(&question)?) {
                break read;
            }
        };
        ask("Press Enter, wait two seconds, then blow once as a visitor would.")?;
        let label = Label {
            file: format!("breath-{number:02}.wav"),
            kind: Kind::Breath,
            distance_cm: Some(distance),
            angle_deg: Some(angle),
            age_group: age,
        };
        keep(label, &record(BREATH_S)?)?;
    }
    ask("The full room: come back when there are visitors, none of whom blows. Press Enter to begin.")?;
    keep(ambient("full-room.wav", Kind::FullRoom), &record(plan.ambient_s)?)?;
    ask(&format!("Done. `soffio breath fit {}` sets the detector. Press Enter to end.", folder.display()))?;
    Ok(())
}

/// Distance, angle and group of age, as in "30 0 adult".
fn position(answer: &str) -> Option<(f64, f64, String)> {
    let mut words = answer.split_whitespace();
    let mut number = |low, high| words.next()?.parse::<f64>().ok().filter(|x| (low..=high).contains(x));
    let (distance, angle) = (number(1.0, 300.0)?, number(0.0, 180.0)?);
    let age = words.next().filter(|word| ["child", "adult", "old"].contains(word))?;
    Some((distance, angle, age.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PLAN: Plan = Plan { breaths: 2, ambient_s: 3.0 };

    fn run(folder: &Path, answers: &str) -> (Result<(), String>, String) {
        let mut out = Vec::new();
        let mut record = |seconds: f64| {
            let channel = vec![0.25; (8000.0 * seconds) as usize];
            Ok(Recorded { channels: vec![channel.clone(), channel], sample_rate: 8000 })
        };
        let result = guide(folder, PLAN, &mut answers.as_bytes(), &mut out, &mut record);
        (result, String::from_utf8_lossy(&out).into_owned())
    }

    #[test]
    fn without_consent_nothing_is_written() {
        let folder = tempfile::tempdir().expect("a folder");
        let inner = folder.path().join("inner");
        let (result, said) = run(&inner, "no\n");
        assert!(result.is_err_and(|why| why.contains("nothing was recorded")) && !inner.exists());
        assert!(said.contains("no names"), "{said}");
    }

    #[test]
    fn a_session_leaves_recordings_and_a_table_that_can_be_read() {
        let folder = tempfile::tempdir().expect("a folder");
        let (result, said) = run(folder.path(), "yes\n\nnear\n30 0 adult\n\n45 20 child\n\n\n\n");
        assert_eq!(result, Ok(()), "{said}");
        let takes = venue_recordings::read(folder.path()).expect("the table and its files");
        let kinds: Vec<Kind> = takes.iter().map(|(label, _)| label.kind).collect();
        assert_eq!(kinds, [Kind::EmptyRoom, Kind::Breath, Kind::Breath, Kind::FullRoom]);
        assert_eq!((takes[2].0.distance_cm, takes[2].0.angle_deg), (Some(45.0), Some(20.0)));
        assert_eq!((takes[2].0.age_group.as_str(), takes[1].1.duration()), ("child", BREATH_S));
        assert!(takes[1].1.capsules.is_some(), "both channels");
    }

    #[test]
    fn a_session_that_ends_early_keeps_what_it_has() {
        let folder = tempfile::tempdir().expect("a folder");
        let (result, _) = run(folder.path(), "yes\n\n30 0 adult\n\n");
        assert!(result.is_err());
        assert_eq!(venue_recordings::read(folder.path()).expect("a table").len(), 2);
    }
}

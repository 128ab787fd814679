//! The kiosk's numbers for whoever watches many machines: a file in the text format of Prometheus, for the textfile
//! collector of its node exporter. No port is opened, and nothing in it is about a visitor.

use std::fmt::Write as _;
use std::io::Write as _;
use std::path::PathBuf;
use std::sync::mpsc::{Sender, channel};
use std::time::{Duration, Instant};

use super::live::Load;
use crate::audio_io::DeviceState;
use crate::offline::whole_file::WholeFile;
use crate::simulation::MotionMode;

/// Between two files.
const EVERY: Duration = Duration::from_secs(15);

/// Writes the numbers, on a thread of its own: a slow disk does not make the simulation late.
pub struct Metrics {
    to: Option<Sender<String>>,
    written: Option<Instant>,
}

impl Metrics {
    /// To this file; nowhere where its path is empty.
    pub fn start(path: PathBuf) -> Self {
        let off = Self { to: None, written: None };
        if path.as_os_str().is_empty() {
            return off;
        }
        let (to, from) = channel::<String>();
        let write = move || {
            let mut failed = false;
            for text in from {
                let result = WholeFile::create(&path).and_then(|mut file| {
                    file.write_all(text.as_bytes())?;
                    file.finish()
                });
                // Once for all that follow alike.
                if let Err(error) = &result
                    && !failed
                {
                    tracing::warn!("metrics: {error}");
                }
                failed = result.is_err();
            }
        };
        match std::thread::Builder::new().name("metrics".into()).spawn(write) {
            Ok(_) => Self { to: Some(to), ..off },
            Err(error) => {
                tracing::warn!("metrics: {error}");
                off
            }
        }
    }

    /// Writes them when they are due.
    pub fn tend(&mut self, load: &Load) {
        let Some(to) = &self.to else { return };
        if self.written.is_none_or(|at| at.elapsed() >= EVERY) {
            self.written = Some(Instant::now());
            // The thread ends with the sender only.
            let _ = to.send(text(load));
        }
    }
}

/// The numbers as text.
pub fn text(load: &Load) -> String {
    let mut out = String::new();
    let mut number = |name: &str, kind: &str, help: &str, value: f64| {
        if value.is_finite() {
            // Writing to a string does not fail.
            let _ = write!(out, "# HELP {name} {help}\n# TYPE {name} {kind}\n{name} {value}\n");
        }
    };
    let works = |state: &DeviceState| f64::from(u8::from(matches!(state, DeviceState::Ok { .. })));
    let (audio, loud) = (&load.audio, &load.loudness);
    number("soffio_up", "gauge", "1 while the kiosk runs", 1.0);
    number("soffio_step_seconds", "gauge", "Mean time of a simulation step lately", load.step_s);
    let by_places = load.mode != MotionMode::Dynamic;
    number("soffio_moved_by_places", "gauge", "0 by the laws, 1 by places", f64::from(u8::from(by_places)));
    number("soffio_motion_changes_total", "counter", "Changes between the two", load.mode_changes as f64);
    number("soffio_steps_dropped_total", "counter", "Steps of time that were dropped", load.dropped as f64);
    number("soffio_audio_xruns_total", "counter", "Gaps of microphone and loudspeaker", audio.xruns as f64);
    number("soffio_loudspeaker_openings_total", "counter", "Times a loudspeaker was opened", audio.openings as f64);
    number("soffio_loudspeaker_ok", "gauge", "Does it play", works(&audio.output));
    number("soffio_microphone_ok", "gauge", "Does it listen", works(&audio.input));
    number("soffio_volume_db", "gauge", "Volume, dB of full scale", loud.volume_db);
    number("soffio_muted", "gauge", "Muted by staff", f64::from(u8::from(loud.muted)));
    number("soffio_night", "gauge", "The night's sound", f64::from(u8::from(loud.night)));
    number("soffio_volume_eased_db", "gauge", "Taken off because the last minute was too loud", loud.eased_db);
    let spans = ["minute", "day"];
    for (i, span) in spans.iter().enumerate() {
        let name = format!("soffio_level_{span}_db");
        number(&name, "gauge", "A-weighted mean level, dB of a full-scale sine", loud.level_db[i]);
        let name = format!("soffio_laeq_{span}_db");
        let help = "A-weighted mean level at the visitor's ear, dB(A)";
        number(&name, "gauge", help, loud.laeq_db[i].unwrap_or(f64::NAN));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_is_a_line_of_the_format_and_silence_is_left_out() {
        let mut load = Load::default();
        load.loudness.level_db = [f64::NEG_INFINITY, -31.5];
        load.audio.xruns = 3;
        let text = text(&load);
        assert!(
            text.contains("\nsoffio_audio_xruns_total 3\n") && text.contains("\nsoffio_level_day_db -31.5\n"),
            "{text}"
        );
        assert!(!text.contains("soffio_level_minute_db") && !text.contains("laeq") && !text.contains("inf"), "{text}");
        for line in text.lines().filter(|line| !line.starts_with('#')) {
            let (name, value) = line.split_once(' ').expect("a name and a number");
            assert!(name.bytes().all(|b| b.is_ascii_lowercase() || b == b'_'), "{line}");
            assert!(value.parse::<f64>().is_ok(), "{line}");
        }
    }
}

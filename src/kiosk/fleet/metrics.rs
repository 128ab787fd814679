//! The kiosk's numbers for whoever watches many machines: a file in the text format of Prometheus, for the textfile
//! collector of its node exporter. No port is opened, and nothing in it is about a visitor.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use crate::fleet::kept::Kept;
use crate::fleet::visits::{DWELL_S, FRAME_S, Histogram};
use crate::fleet::writer::Writer;
use crate::live::Frame;
use crate::venue::care::Verdict;
use soffio_devices::audio::DeviceState;
use soffio_simulation::MotionMode;
use soffio_sound::BANDS;

/// Between two files.
const EVERY: Duration = Duration::from_secs(15);

/// Writes the numbers.
pub struct Metrics {
    writer: Option<Writer>,
    written: Option<Instant>,
}

impl Metrics {
    /// To this file; nowhere where its path is empty.
    pub fn start(path: PathBuf) -> Self {
        Self { writer: (!path.as_os_str().is_empty()).then(|| Writer::start("metrics", path)), written: None }
    }

    /// Writes them when they are due; `text` is asked for then.
    pub fn tend(&mut self, now: Instant, text: impl FnOnce() -> String) {
        let Some(writer) = &self.writer else { return };
        if self.written.is_none_or(|at| now.duration_since(at) >= EVERY) {
            self.written = Some(now);
            // What the disk is too slow for is told 15 s later.
            writer.write(text());
        }
    }
}

/// What is told beside the simulation's own moment.
pub struct Numbers<'a> {
    /// Counted over all runs.
    pub kept: &'a Kept,
    /// Times from picture to picture, of this run.
    pub frames: &'a Histogram,
    /// Safe mode?
    pub safe: bool,
    /// Was what was read last, a configuration or a work, good?
    pub reloads: bool,
    /// Breaths that a foam lasts for; 0 where nobody counts them.
    pub foam_lasts: u32,
    /// Id of the work on show, and its version.
    pub content: (&'a str, &'a str),
}

/// The numbers as text.
pub fn text(frame: &Frame, numbers: &Numbers) -> String {
    let mut page = Page(String::new());
    machine(&mut page, frame, numbers);
    sound(&mut page, frame);
    care(&mut page, numbers);
    visitors(&mut page, numbers);
    page.0
}

fn machine(page: &mut Page, frame: &Frame, numbers: &Numbers) {
    let (load, now) = (&frame.load, &frame.current.diagnostics);
    page.number("up", "gauge", "1 while the kiosk runs", 1.0);
    page.number("starts_total", "counter", "Starts of the kiosk", numbers.kept.starts as f64);
    page.number("safe_mode", "gauge", "Safe mode after a crash loop", flag(numbers.safe));
    page.number("last_reload_success", "gauge", "Was what was read last good", flag(numbers.reloads));
    let labels: [(&str, &str); 2] = [("exhibit", numbers.content.0), ("version", numbers.content.1)];
    page.labelled("content_info", "gauge", "What is on show", &[(&labels, 1.0)]);
    page.histogram("frame_seconds", "Time from picture to picture", FRAME_S, numbers.frames);
    page.number("physics_step_seconds", "gauge", "Mean time of a simulation step lately", load.step_s);
    page.number("constraint_error_max", "gauge", "Largest error of any joint now, m", now.joint_error);
    page.number(
        "faults_total",
        "counter",
        "Figures put back after bad numbers, of the work on show",
        now.faults as f64,
    );
    let modes = [MotionMode::Dynamic, MotionMode::Procedural, MotionMode::PositionBased];
    let labels = modes.map(|mode| ([("mode", mode.name())], flag(mode == load.mode)));
    let rows: Vec<Row> = labels.iter().map(|(label, moves)| (&label[..], *moves)).collect();
    page.labelled("solver_mode", "gauge", "What moves the work, 1 for that which does", &rows);
    page.number("solver_mode_changes_total", "counter", "Changes between the two", load.mode_changes as f64);
    page.number("steps_dropped_total", "counter", "Steps of time that were dropped", load.dropped as f64);
}

fn sound(page: &mut Page, frame: &Frame) {
    let (audio, loud) = (&frame.load.audio, &frame.load.loudness);
    let works = |state: &DeviceState| flag(matches!(state, DeviceState::Ok { .. }));
    page.number("audio_xruns_total", "counter", "Gaps of microphone and loudspeaker", audio.xruns as f64);
    if frame.hears {
        let level = frame.current.breath.estimate.level_dbfs;
        page.number("audio_input_level_dbfs", "gauge", "Level of the microphone, dB of full scale", level);
    }
    page.number("mic_ok", "gauge", "Does the microphone listen", works(&audio.input));
    page.number("loudspeaker_ok", "gauge", "Does the loudspeaker play", works(&audio.output));
    if let Some(state) = &audio.hearing_loop {
        page.number("hearing_loop_ok", "gauge", "Does the hearing loop play", works(state));
    }
    page.number("loudspeaker_openings_total", "counter", "Times a loudspeaker was opened", audio.openings as f64);
    page.number("volume_db", "gauge", "Volume, dB of full scale", loud.volume_db);
    page.number("muted", "gauge", "Muted by staff", flag(loud.muted));
    page.number("night", "gauge", "The night's sound", flag(loud.night));
    page.number("volume_eased_db", "gauge", "Taken off because the last minute was too loud", loud.eased_db);
    for (i, span) in ["minute", "day"].iter().enumerate() {
        let help = "A-weighted mean level, dB of a full-scale sine";
        page.number(&format!("level_{span}_db"), "gauge", help, loud.level_db[i]);
        let help = "A-weighted mean level at the visitor's ear, dB(A)";
        page.number(&format!("laeq_{span}_db"), "gauge", help, loud.laeq_db[i].unwrap_or(f64::NAN));
    }
}

fn care(page: &mut Page, numbers: &Numbers) {
    let kept = numbers.kept;
    let foam = kept.care.foam(kept.tally.breaths());
    page.number("foam_blows", "gauge", "Breaths at the microphone since its foam was changed", foam as f64);
    page.number("foam_lasts_blows", "gauge", "Breaths that a foam lasts for, 0 for ever", numbers.foam_lasts.into());
    let Some((verdict, _)) = &kept.care.last else { return };
    let labels = Verdict::NAMES.map(|name| ([("verdict", name)], flag(name == verdict.name())));
    let rows: Vec<Row> = labels.iter().map(|(label, is)| (&label[..], *is)).collect();
    page.labelled("chirp", "gauge", "What the last chirp says, 1 for what it is", &rows);
    page.number("chirp_bad", "gauge", "Does the last chirp ask for somebody", flag(verdict.is_bad()));
    let bands = BANDS.map(|hz| hz.to_string());
    let known = bands.iter().zip(kept.care.change_db).filter_map(|(hz, db)| Some(([("hz", hz.as_str())], db?)));
    let labels: Vec<_> = known.collect();
    let rows: Vec<Row> = labels.iter().map(|(label, db)| (&label[..], *db)).collect();
    page.labelled("chirp_change_db", "gauge", "The last chirp over the first clean ones, by octave", &rows);
}

fn visitors(page: &mut Page, numbers: &Numbers) {
    let tally = &numbers.kept.tally;
    page.number("sessions_total", "counter", "Visits that have ended", tally.visits as f64);
    page.histogram("dwell_seconds", "How long visits were", DWELL_S, &tally.dwell);
    for (name, help, key, counts) in [
        ("blows_total", "Breaths by their source", "source", &tally.blows),
        ("language_total", "Visits by the language shown last", "lang", &tally.languages),
    ] {
        let labels: Vec<_> = counts.iter().map(|(label, count)| ([(key, label.as_str())], *count as f64)).collect();
        let rows: Vec<Row> = labels.iter().map(|(label, count)| (&label[..], *count)).collect();
        page.labelled(name, "counter", help, &rows);
    }
}

fn flag(is: bool) -> f64 {
    f64::from(u8::from(is))
}

/// Labels and the number that they tell apart from others of the same name.
type Row<'a> = (&'a [(&'a str, &'a str)], f64);

/// Text in Prometheus' format. Writing to a string does not fail.
struct Page(String);

impl Page {
    fn head(&mut self, name: &str, kind: &str, help: &str) {
        let _ = writeln!(self.0, "# HELP kiosk_{name} {help}\n# TYPE kiosk_{name} {kind}");
    }

    /// A number; one that is not finite is left out.
    fn number(&mut self, name: &str, kind: &str, help: &str, value: f64) {
        if value.is_finite() {
            self.head(name, kind, help);
            let _ = writeln!(self.0, "kiosk_{name} {value}");
        }
    }

    /// Numbers that labels tell apart.
    fn labelled(&mut self, name: &str, kind: &str, help: &str, rows: &[Row]) {
        if rows.is_empty() {
            return;
        }
        self.head(name, kind, help);
        for (labels, value) in rows {
            let quoted = |text: &str| text.replace('\\', "\\\\").replace('"', "\\\"").replace('\n', "\\n");
            let labels: Vec<String> = labels.iter().map(|(key, text)| format!("{key}=\"{}\"", quoted(text))).collect();
            let _ = writeln!(self.0, "kiosk_{name}{{{}}} {value}", labels.join(","));
        }
    }

    fn histogram(&mut self, name: &str, help: &str, bounds: &[f64], histogram: &Histogram) {
        self.head(name, "histogram", help);
        let mut below = 0;
        for (i, bound) in bounds.iter().enumerate() {
            below += histogram.counts.get(i).copied().unwrap_or_default();
            let _ = writeln!(self.0, "kiosk_{name}_bucket{{le=\"{bound}\"}} {below}");
        }
        let (total, sum) = (histogram.total(), histogram.sum);
        let _ = writeln!(
            self.0,
            "kiosk_{name}_bucket{{le=\"+Inf\"}} {total}\nkiosk_{name}_sum {sum}\nkiosk_{name}_count {total}"
        );
    }
}

//! Metrics in the text format of Prometheus: a file for the textfile collector of its node exporter. No port is opened, and
//! nothing in it identifies a visitor.

use std::fmt::Write as _;
use std::path::PathBuf;
use std::time::{Duration, Instant};

use crate::fleet::persisted::PersistedState;
use crate::fleet::visits::{DWELL_S, FRAME_S, Histogram};
use crate::fleet::writer::Writer;
use crate::live::LiveState;
use crate::venue::self_test::Verdict;
use soffio_devices::audio::DeviceState;
use soffio_offline::atomic_file::Readers;
use soffio_simulation::MotionMode;
use soffio_sound::BANDS;

/// Time between two files.
const EVERY: Duration = Duration::from_secs(15);

/// Writes the metrics.
pub struct Metrics {
    writer: Option<Writer>,
    written: Option<Instant>,
}

impl Metrics {
    /// Writes to this file; nowhere if the path is empty.
    pub fn start(path: PathBuf) -> Self {
        Self {
            writer: (!path.as_os_str().is_empty()).then(|| Writer::start("metrics", path, Readers::Everyone)),
            written: None,
        }
    }

    /// Writes the file when it is due; `text` is called only then.
    pub fn update(&mut self, now: Instant, text: impl FnOnce() -> String) {
        let Some(writer) = &self.writer else { return };
        if self.written.is_none_or(|at| now.duration_since(at) >= EVERY) {
            self.written = Some(now);
            // If the disk is too slow, the next file comes 15 s later.
            writer.write(text());
        }
    }
}

/// Values of the metrics besides the state of the simulation.
pub struct MetricsInput<'a> {
    /// State and counters over all runs.
    pub persisted: &'a PersistedState,
    /// Times between frames of this run.
    pub frames: &'a Histogram,
    /// Does the kiosk run in safe mode?
    pub safe: bool,
    /// Was the last reloaded file, a configuration or an exhibit, valid?
    pub reloads: bool,
    /// Lines of the log that were dropped since nobody read them.
    pub dropped_lines: usize,
    /// Number of breaths after which the microphone's foam is changed; 0: no limit.
    pub foam_lasts: u32,
    /// The exhibit on show.
    pub content: ContentVersion<'a>,
}

/// An exhibit in the version that is on show.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ContentVersion<'a> {
    /// Id of the exhibit.
    pub exhibit: &'a str,
    /// Hash of its sidecar, in hexadecimal digits.
    pub version: &'a str,
}

/// The metrics as text.
pub fn text(frame: &LiveState, numbers: &MetricsInput) -> String {
    let mut page = MetricsText(String::new());
    machine(&mut page, frame, numbers);
    sound(&mut page, frame);
    self_test(&mut page, numbers);
    visitors(&mut page, numbers);
    page.0
}

fn machine(page: &mut MetricsText, frame: &LiveState, numbers: &MetricsInput) {
    let (load, now) = (&frame.load, &frame.current.diagnostics);
    page.number("up", "gauge", "1 while the kiosk runs", 1.0);
    page.number("starts_total", "counter", "Starts of the kiosk", numbers.persisted.starts as f64);
    page.number("safe_mode", "gauge", "Safe mode after a crash loop", flag(numbers.safe));
    page.number("last_reload_success", "gauge", "1 if the last reloaded file was valid", flag(numbers.reloads));
    let labels: [(&str, &str); 2] = [("exhibit", numbers.content.exhibit), ("version", numbers.content.version)];
    page.labelled("content_info", "gauge", "What is on show", &[(&labels, 1.0)]);
    page.histogram("frame_seconds", "Time between two frames", FRAME_S, numbers.frames);
    page.number("physics_step_seconds", "gauge", "Recent mean time of a simulation step", load.step_s);
    page.number("constraint_error_max", "gauge", "Largest error of any joint now, m", now.joint_error);
    page.number(
        "faults_total",
        "counter",
        "Mechanisms of the exhibit on show that were reset after invalid numbers",
        now.faults as f64,
    );
    let modes = [MotionMode::Dynamic, MotionMode::Procedural, MotionMode::PositionBased];
    let labels = modes.map(|mode| ([("mode", mode.name())], flag(mode == load.mode)));
    let rows: Vec<LabelledValue> = labels.iter().map(|(label, moves)| (&label[..], *moves)).collect();
    page.labelled("solver_mode", "gauge", "Solver of the exhibit on show, 1 for the one in use", &rows);
    page.number("solver_mode_changes_total", "counter", "Changes of the solver", load.mode_changes as f64);
    page.number("steps_dropped_total", "counter", "Simulation steps that were dropped", load.dropped as f64);
    let dropped = numbers.dropped_lines as f64;
    page.number("log_lines_dropped_total", "counter", "Lines of the log that nobody read in time", dropped);
}

fn sound(page: &mut MetricsText, frame: &LiveState) {
    let (audio, loud) = (&frame.load.audio, &frame.load.loudness);
    let is_open = |state: &DeviceState| flag(matches!(state, DeviceState::Ok { .. }));
    page.number("audio_xruns_total", "counter", "Gaps in the sound of microphone and loudspeaker", audio.xruns as f64);
    if frame.hears {
        let level = frame.current.breath.estimate.level_dbfs;
        page.number("audio_input_level_dbfs", "gauge", "Level of the microphone, dB of full scale", level);
    }
    page.number("mic_ok", "gauge", "1 while the microphone is open", is_open(&audio.input));
    page.number("output_ok", "gauge", "1 while the sound output plays", is_open(&audio.output));
    if let Some(state) = &audio.hearing_loop {
        page.number("hearing_loop_ok", "gauge", "1 while the hearing loop plays", is_open(state));
    }
    page.number("output_openings_total", "counter", "Times a sound output was opened", audio.openings as f64);
    page.number("volume_db", "gauge", "Volume, dB of full scale", loud.volume_db);
    page.number("muted", "gauge", "Muted by staff", flag(loud.muted));
    page.number("night", "gauge", "1 while the sound is in night mode", flag(loud.night));
    page.number(
        "exposure_attenuation_db",
        "gauge",
        "Attenuation that keeps the exposure limit, dB",
        loud.exposure_attenuation_db,
    );
    for (i, span) in ["minute", "day"].iter().enumerate() {
        let help = "A-weighted mean level, dB of a full-scale sine";
        page.number(&format!("level_{span}_db"), "gauge", help, loud.level_db[i]);
        let help = "A-weighted mean level at the listening position, dB(A)";
        page.number(&format!("laeq_{span}_db"), "gauge", help, loud.laeq_db[i].unwrap_or(f64::NAN));
    }
}

fn self_test(page: &mut MetricsText, numbers: &MetricsInput) {
    let persisted = numbers.persisted;
    let foam = persisted.self_test.foam_breaths(persisted.counters.breaths());
    page.number("foam_blows", "gauge", "Breaths at the microphone since its foam was changed", foam as f64);
    page.number("foam_lasts_blows", "gauge", "Breaths for which a foam lasts, 0: no limit", numbers.foam_lasts.into());
    let Some((verdict, _)) = &persisted.self_test.last else { return };
    let labels = Verdict::NAMES.map(|name| ([("verdict", name)], flag(name == verdict.name())));
    let rows: Vec<LabelledValue> = labels.iter().map(|(label, is)| (&label[..], *is)).collect();
    page.labelled("audio_self_test", "gauge", "Verdict of the last audio self-test, 1 for the one given", &rows);
    page.number(
        "audio_self_test_bad",
        "gauge",
        "1 if the last audio self-test needs attention",
        flag(verdict.is_bad()),
    );
    let bands = BANDS.map(|hz| hz.to_string());
    let known =
        bands.iter().zip(persisted.self_test.change_db).filter_map(|(hz, db)| Some(([("hz", hz.as_str())], db?)));
    let labels: Vec<_> = known.collect();
    let rows: Vec<LabelledValue> = labels.iter().map(|(label, db)| (&label[..], *db)).collect();
    page.labelled(
        "audio_self_test_change_db",
        "gauge",
        "Change of the last audio self-test from its reference, by octave, dB",
        &rows,
    );
}

fn visitors(page: &mut MetricsText, numbers: &MetricsInput) {
    let counters = &numbers.persisted.counters;
    page.number("sessions_total", "counter", "Visits that have ended", counters.visits as f64);
    page.histogram("dwell_seconds", "How long visits were", DWELL_S, &counters.dwell);
    for (name, help, key, counts) in [
        ("blows_total", "Breaths by their source", "source", &counters.blows),
        ("language_total", "Visits by the language shown last", "lang", &counters.languages),
    ] {
        let labels: Vec<_> = counts.iter().map(|(label, count)| ([(key, label.as_str())], *count as f64)).collect();
        let rows: Vec<LabelledValue> = labels.iter().map(|(label, count)| (&label[..], *count)).collect();
        page.labelled(name, "counter", help, &rows);
    }
}

fn flag(is: bool) -> f64 {
    f64::from(u8::from(is))
}

/// Labels and value of one sample of a metric.
type LabelledValue<'a> = (&'a [(&'a str, &'a str)], f64);

/// Text in the format of Prometheus. Writing to a string does not fail.
struct MetricsText(String);

impl MetricsText {
    fn head(&mut self, name: &str, kind: &str, help: &str) {
        let _ = writeln!(self.0, "# HELP kiosk_{name} {help}\n# TYPE kiosk_{name} {kind}");
    }

    /// A metric with one value; one that is not finite is left out.
    fn number(&mut self, name: &str, kind: &str, help: &str, value: f64) {
        if value.is_finite() {
            self.head(name, kind, help);
            let _ = writeln!(self.0, "kiosk_{name} {value}");
        }
    }

    /// A metric with labelled values.
    fn labelled(&mut self, name: &str, kind: &str, help: &str, rows: &[LabelledValue]) {
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

//! `soffio breath`: runs the blow detector alone over recordings.
//!
//! It prints one JSON line per file, or with `--csv` one row per step of the simulation (1/240 s) of a single file.

use std::io::Write;
use std::path::PathBuf;

use serde::Serialize;

mod fit;

use super::failure::{Failure, Outcome};
use soffio_detector::{BlowDetector, BlowEstimate, Reason};
use soffio_offline::feed::WavFeed;
use soffio_offline::wav::{self, Recording};
use soffio_simulation::STEPS_PER_SECOND;

/// Runs the blow detector alone over WAV files.
///
/// Example: soffio breath exhibits/steel-fish/breaths/*.wav
#[derive(clap::Args, Debug, Default)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub struct Args {
    #[command(subcommand)]
    command: Option<Command>,
    /// Recordings: PCM 8–32 bit or float, 8–192 kHz.
    #[arg(required = true, value_name = "FILE.wav")]
    files: Vec<PathBuf>,
    /// Rows `t,speed,confidence` at 240 Hz instead of a summary; one file.
    #[arg(long)]
    csv: bool,
    /// With --csv: a fourth column with the reason of the decision.
    #[arg(long, requires = "csv")]
    reasons: bool,
}

/// What `soffio breath` does other than judge recordings.
#[derive(clap::Subcommand, Debug)]
enum Command {
    Fit(fit::Args),
}

/// Summary of one recording.
#[derive(Debug, PartialEq, Serialize)]
pub struct Summary {
    /// Path of the recording, as given.
    pub file: String,
    /// A breath was detected.
    pub blow: bool,
    /// Time of the first detection, s.
    pub onset_s: Option<f64>,
    /// Highest speed at the lips, m/s.
    pub peak: f64,
    /// Mean speed at the lips during breaths, m/s.
    pub mean: f64,
    /// Time with wind, s.
    pub seconds_blowing: f64,
    /// Number of separate breaths.
    pub triggers: usize,
}

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    if let Some(Command::Fit(args)) = args.command {
        return fit::run(&args);
    }
    if args.csv && args.files.len() != 1 {
        let message = format!("breath: --csv takes one file, {} were given. Name one.", args.files.len());
        return Err(Failure { code: 2, message });
    }
    let mut out = std::io::stdout().lock();
    let mut problems = Vec::new();
    for path in &args.files {
        match wav::read(path) {
            Err(error) => problems.push(error.to_string()),
            Ok(recording) => {
                let steps = steps(&recording);
                let written = if args.csv {
                    write_rows(&mut out, &steps, args.reasons)
                } else {
                    let summary = summarise(path.display().to_string(), &steps);
                    let line = serde_json::to_string(&summary).map_err(Failure::input)?;
                    writeln!(out, "{line}")
                };
                match written {
                    // A closed pipe (`| head`) is not an error.
                    Err(error) if error.kind() == std::io::ErrorKind::BrokenPipe => return Ok(()),
                    other => other.map_err(|error| Failure::input(format!("cannot write the output: {error}")))?,
                }
            }
        }
    }
    if problems.is_empty() { Ok(()) } else { Err(Failure::input(problems.join("\nsoffio: "))) }
}

/// Time, s, and estimate at the end of every step of 1/240 s, and at the end of the recording.
pub fn steps(recording: &Recording) -> Vec<(f64, BlowEstimate)> {
    let mut detector = BlowDetector::new(recording.sample_rate);
    let mut feed = WavFeed::from(recording);
    let mut rows = Vec::new();
    while !feed.is_over() {
        feed.microphone().feed(&mut detector);
        rows.push(((rows.len() + 1) as f64 / STEPS_PER_SECOND as f64, detector.estimate()));
    }
    rows
}

/// Summary of the steps of one recording.
pub fn summarise(file: String, steps: &[(f64, BlowEstimate)]) -> Summary {
    let blowing = || steps.iter().filter(|(_, e)| e.speed > 0.0);
    let count = blowing().count();
    let began = |pair: &&[(f64, BlowEstimate)]| pair[0].1.speed == 0.0 && pair[1].1.speed > 0.0;
    let from_start = steps.first().is_some_and(|(_, e)| e.speed > 0.0);
    Summary {
        file,
        blow: count > 0,
        onset_s: blowing().next().map(|(t, _)| *t),
        peak: blowing().map(|(_, e)| e.speed).fold(0.0, f64::max),
        mean: blowing().fold(0.0, |sum, (_, e)| sum + e.speed) / count.max(1) as f64,
        seconds_blowing: count as f64 / STEPS_PER_SECOND as f64,
        triggers: steps.windows(2).filter(began).count() + usize::from(from_start),
    }
}

fn write_rows(out: &mut impl Write, steps: &[(f64, BlowEstimate)], reasons: bool) -> std::io::Result<()> {
    writeln!(out, "t,speed,confidence{}", if reasons { ",reason" } else { "" })?;
    for (t, estimate) in steps {
        write!(out, "{t:.6},{:.4},{:.4}", estimate.speed, estimate.confidence)?;
        if reasons {
            write!(out, ",{}", word(estimate.reason))?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// Name of a reason.
fn word(reason: Reason) -> &'static str {
    match reason {
        Reason::NoSignal => "no-signal",
        Reason::Settling => "settling",
        Reason::Quiet => "quiet",
        Reason::Voiced => "voiced",
        Reason::OtherSound => "other-sound",
        Reason::Pending => "pending",
        Reason::Blow => "blow",
        Reason::LoudspeakerEcho => "loudspeaker-echo",
        Reason::Fault => "fault",
    }
}

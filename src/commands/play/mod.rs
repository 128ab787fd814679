//! `soffio play`.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use clap::ValueEnum;

use super::arguments::{SolverArg, parse_seconds};
use super::failure::{Failure, Outcome};
use super::setup;
use soffio_exhibit::Exhibit;
use soffio_offline::compare;
use soffio_offline::feed::WavFeed;
use soffio_offline::play::{Play, PlayError};
use soffio_offline::wav;
use soffio_simulation::{MotionMode, Profile, STEPS_PER_SECOND, Script, Settings};

#[cfg(feature = "kiosk")]
mod filming;
pub mod outputs;

use outputs::Outputs;

/// Seconds of a run without a recording, and after the end of one.
const TAIL: f64 = 5.0;

/// Runs an exhibit offline: faster than real time, and deterministic.
#[derive(clap::Args, Debug)]
#[command(after_help = "Examples:\n  soffio play steel-fish --breath blow.wav --audio out.wav --trace out.csv\n  \
                        soffio play wind-chimes --script visit.jsonl --video visit.mp4 --size 640x360 --fps 30\n  \
                        soffio play chains --seconds 20 --compare --plot apart.png")]
pub struct Args {
    /// Id under `exhibits/`, or a folder.
    exhibit: String,
    /// Recorded breath in place of the microphone; two channels are two microphones.
    #[arg(long, value_name = "WAV")]
    breath: Option<PathBuf>,
    /// Aim of the breath, picture coordinates: 0,0 top left, 1,1 bottom right.
    #[arg(long, value_name = "X,Y", value_parser = parse_aim, allow_hyphen_values = true, conflicts_with = "script")]
    aim: Option<[f64; 2]>,
    /// Actions of a visitor over time, JSON lines.
    #[arg(long, value_name = "FILE")]
    script: Option<PathBuf>,
    /// How a breath becomes wind.
    #[arg(long, value_enum, default_value_t = ProfileArg::Gallery)]
    profile: ProfileArg,
    /// No wind of any kind.
    #[arg(long)]
    no_wind: bool,
    /// Length; default is the recording's or script's length and 5 s.
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds, allow_negative_numbers = true)]
    seconds: Option<f64>,
    /// How motion is solved.
    #[arg(long, value_enum, default_value_t)]
    solver: SolverArg,
    /// Time of day at the start, to which a clock sets its hands, such as 14:35.
    #[arg(long, value_name = "H:MM", value_parser = soffio_exhibit::clock::time_of_day)]
    clock: Option<f64>,
    /// Seed of all random numbers.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    outputs: Outputs,
    /// Runs the exhibit with dynamics and with another solver (`--solver procedural` or `position-based`, the default here)
    /// from the same input, and reports the differences.
    #[arg(long, conflicts_with_all = COMPARE_LEAVES)]
    compare: bool,
    /// Differences in each frame: positions, rotations, energies, events.
    #[arg(long, value_name = "OUT.csv", requires = "compare")]
    out: Option<PathBuf>,
    /// Plot of the differences over time.
    #[arg(long, value_name = "OUT.png", requires = "compare")]
    plot: Option<PathBuf>,
}

/// Outputs of a single run that a comparison does not have.
#[cfg(feature = "kiosk")]
const COMPARE_LEAVES: [&str; 6] = ["audio", "dry", "trace", "events", "frames", "video"];
#[cfg(not(feature = "kiosk"))]
const COMPARE_LEAVES: [&str; 4] = ["audio", "dry", "trace", "events"];

/// Breath profile on the command line.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum ProfileArg {
    /// The breath arrives at once, with a gain for a child's gentle breath.
    Gallery,
    /// The physics of a real jet: gain 1, and the jet's front travels.
    Physical,
}

/// Reads `x,y`.
///
/// # Errors
/// The text is not of this form, or a coordinate is outside 0 … 1.
pub fn parse_aim(text: &str) -> Result<[f64; 2], String> {
    let wrong = || format!("\"{text}\" is no aim; write two numbers from 0 to 1, as in 0.4,0.5");
    let (x, y) = text.split_once(',').ok_or_else(wrong)?;
    let read = |part: &str| part.trim().parse::<f64>().ok().filter(|v| (0.0..=1.0).contains(v));
    Ok([read(x).ok_or_else(wrong)?, read(y).ok_or_else(wrong)?])
}

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    let exhibit = setup::open(&args.exhibit)?;
    let recording = args.breath.as_ref().map(wav::read).transpose().map_err(Failure::input)?;
    let script = args.script.as_ref().map(|path| read_script(path, &exhibit)).transpose()?;
    let recorded_s = recording.as_ref().map_or(0.0, wav::Recording::duration);
    let script_s = script.as_ref().map_or(0.0, Script::duration);
    let seconds = args.seconds.unwrap_or(recorded_s.max(script_s) + TAIL);
    let settings = Settings {
        profile: match args.profile {
            ProfileArg::Gallery => Profile::Gallery,
            ProfileArg::Physical => Profile::Physical,
        },
        seed: args.seed,
        wind: !args.no_wind,
        clock: args.clock,
        ..setup::settings()?
    };
    let solver = if args.compare && args.solver == SolverArg::Auto { SolverArg::PositionBased } else { args.solver };
    if let Some(message) = solver.refusal(&exhibit) {
        return Err(Failure { code: 2, message });
    }
    let mode = match (args.compare, args.solver) {
        (true, SolverArg::Auto) => Some(MotionMode::PositionBased),
        (true, SolverArg::Dynamics) => {
            let message = "--compare compares dynamics with --solver procedural or position-based".into();
            return Err(Failure { code: 2, message });
        }
        _ => args.solver.mode(),
    };
    let play = Play {
        settings,
        mode,
        breath: recording.as_ref().map(WavFeed::from),
        aim: args.aim,
        script,
        seconds,
        aspect: args.outputs.aspect(),
        reverb: setup::reverb()?,
        fps: args.outputs.fps,
        ..Play::default()
    };
    let stop = Arc::new(AtomicBool::new(false));
    setup::stop_on_ctrl_c(&stop);
    let progress = setup::progress_bar((seconds * STEPS_PER_SECOND as f64).round() as u64);
    if args.compare {
        let compared = compare::run(&exhibit, play, &stop, |step| progress.set_position(step));
        progress.finish_and_clear();
        return report(compared, &args, &exhibit);
    }
    let summary = args.outputs.perform(&exhibit, play, &stop, &progress);
    progress.finish_and_clear();
    println!("{}", serde_json::to_string(&summary?).map_err(Failure::input)?);
    Ok(())
}

/// Writes the requested files of a comparison, and its summary as one line.
fn report(compared: Result<compare::Comparison, PlayError>, args: &Args, exhibit: &Exhibit) -> Outcome {
    let compared = compared.map_err(Failure::of_run)?;
    if let Some(path) = &args.out {
        compared.write_csv(path).map_err(Failure::input)?;
    }
    if let Some(path) = &args.plot {
        compared.write_picture(path, exhibit).map_err(Failure::of_run)?;
    }
    println!("{}", serde_json::to_string(&compared.summary).map_err(Failure::input)?);
    Ok(())
}

fn read_script(path: &PathBuf, exhibit: &Exhibit) -> Result<Script, Failure> {
    let name = path.display();
    let text = std::fs::read_to_string(path)
        .map_err(|e| Failure::input(format!("cannot read the script {name}: {e}; check the path")))?;
    let script = Script::parse(&text).and_then(|script| script.fits(exhibit).map(|()| script));
    script.map_err(|e| Failure::input(format!("{name}, {e}")))
}

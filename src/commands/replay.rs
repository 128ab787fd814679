//! `soffio replay`.

use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::failure::{Failure, Outcome};
use super::play::outputs::Outputs;
use super::setup::{open, progress_bar, reverb, stop_on_ctrl_c};
use soffio_offline::play::{Play, Summary};
use soffio_simulation::STEPS_PER_SECOND;
use soffio_simulation::record::{self, RecordSection};

/// Repeats a recorded live run to the bit, and says whether it ends in the same state.
#[derive(clap::Args, Debug)]
#[command(
    after_help = "Example:\n  soffio kiosk --record day.jsonl\n  soffio replay day.jsonl --part 3 --audio part.wav \
                        --video part.mp4"
)]
pub struct Args {
    /// Record written by `soffio kiosk --record`.
    record: PathBuf,
    /// Only this part, from 1: each exhibit that was shown is a part [default: all].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..))]
    part: Option<u64>,
    #[command(flatten)]
    outputs: Outputs,
}

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    let name = args.record.display();
    let text = std::fs::read_to_string(&args.record)
        .map_err(|e| Failure::input(format!("cannot read the record {name}: {e}; check the path")))?;
    let parts = record::parse(&text).map_err(|e| Failure::input(format!("{name}, {e}")))?;
    let count = parts.len();
    let wanted = args.part.map(|part| part as usize);
    if wanted.is_some_and(|part| part > count) {
        return Err(Failure { code: 2, message: format!("{name} has {count} parts; --part is from 1 to {count}") });
    }
    if args.outputs.wants_files() && wanted.is_none() && count != 1 {
        let message = format!("{name} has {count} parts and files hold one run; choose it with --part, from 1");
        return Err(Failure { code: 2, message });
    }
    let stop = Arc::new(AtomicBool::new(false));
    stop_on_ctrl_c(&stop);
    let mut differ = Vec::new();
    for (number, part) in (1..).zip(parts).filter(|(number, _)| wanted.is_none_or(|wanted| wanted == *number)) {
        let recorded = part.end.clone();
        let summary = again(&args.outputs, part, &stop).map_err(|Failure { code, message }| Failure {
            code,
            message: format!("part {number} of {name}: {message}"),
        })?;
        println!("{}", serde_json::to_string(&summary).map_err(Failure::input)?);
        match recorded {
            Some(end) if end.state != summary.state_hash => {
                differ.push(format!("part {number} ends in {}, the live run in {}", summary.state_hash, end.state));
            }
            Some(_) => {}
            None => eprintln!("soffio: part {number} is incomplete; it was run to its end"),
        }
    }
    if differ.is_empty() {
        return Ok(());
    }
    let help = "the exhibit or the program has changed since, or the file was edited";
    Err(Failure::input(format!("{name}: {}; {help}", differ.join("; "))))
}

/// Runs a part again.
fn again(outputs: &Outputs, part: RecordSection, stop: &AtomicBool) -> Result<Summary, Failure> {
    let exhibit = open(&part.begin.exhibit)?;
    let play = Play {
        settings: part.begin.settings,
        seconds: part.steps() as f64 / STEPS_PER_SECOND as f64,
        reverb: reverb()?,
        recorded: Some(part),
        ..Play::default()
    };
    let progress = progress_bar((play.seconds * STEPS_PER_SECOND as f64).round() as u64);
    let summary = outputs.perform(&exhibit, play, stop, &progress);
    progress.finish_and_clear();
    summary
}

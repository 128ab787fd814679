//! `soffio rehearse`: a rehearsal of a gallery day, with a report.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::failure::{Failure, Outcome};
use super::setup::{progress_bar, stop_on_ctrl_c};
use soffio_detector::BlowSettings;
use soffio_kiosk::venue::site::Site;
use soffio_offline::wav;
use soffio_rehearsal::{
    Crowd, ROOMS, Rehearsal, RehearsalError, featured_exhibits, recorded, run as rehearse, run_detector,
};

/// Longest day, h.
const LONGEST_H: f64 = 24.0;

/// Rehearses a gallery day with hundreds of synthetic visitors, a crowd, staff and the kiosk's own echo, and scores the kiosk's
/// pictures and sound.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Example: soffio rehearse --hours 8 --room hall
         soffio rehearse --hours 0.5 --seed 7 --crowd our-gallery/recordings --json
         soffio rehearse --detector-only --capsules 1

A visit is answered when a blow, or a hold, visibly changes the exhibit within 0.3 s, with at least three times as much motion in
the second after it as in the second before, and no false trigger in the ten seconds before. At least 95 % of all visits
and 85 % of every group must be answered, without a false trigger all day; otherwise the exit code is 1.")]
pub struct Args {
    /// Length of the day.
    #[arg(long, value_name = "H", default_value_t = 8.0, value_parser = parse_hours, allow_negative_numbers = true)]
    hours: f64,
    /// Seed of visitors and sounds.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The room: cabinet, gallery, hall or draughty-hall.
    #[arg(long, value_name = "NAME", default_value = "gallery", value_parser = clap::builder::PossibleValuesParser::new(ROOMS.map(|(name, ..)| name)))]
    room: String,
    /// Capsules of the microphone; the manual advises two.
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=2))]
    capsules: u8,
    /// A folder of WAVs of your own crowd instead of a synthetic one, at the microphone's level and without breaths.
    #[arg(long, value_name = "WAV-DIR")]
    crowd: Option<PathBuf>,
    /// Run the detector alone, without exhibits, sound or pictures. Reports detected and missed breaths, latency and false triggers
    /// in a few minutes.
    #[arg(long)]
    detector_only: bool,
    /// Old name of --detector-only.
    #[arg(long = "ear", hide = true)]
    old_detector_only: bool,
    /// One JSON object instead of the table.
    #[arg(long)]
    json: bool,
}

fn parse_hours(text: &str) -> Result<f64, String> {
    let hours = text.parse::<f64>().ok().filter(|h| (0.05..=LONGEST_H).contains(h));
    hours
        .ok_or_else(|| format!("\"{text}\" is not a length of a day; give hours from 0.05 to {LONGEST_H}, such as 0.5"))
}

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    let config = super::setup::config(None)?;
    let crowd = args.crowd.as_deref().map_or(Ok(Crowd::Made), recordings)?;
    let rehearsal = Rehearsal {
        exhibits: featured_exhibits(&config).map_err(Failure::input)?,
        site: Site::new(&config, args.seed),
        room: args.room,
        capsules: args.capsules.into(),
        crowd,
        hours: args.hours,
        seed: args.seed,
    };
    if args.old_detector_only {
        eprintln!("soffio: --ear is now called --detector-only; the old name will be removed");
    }
    if args.detector_only || args.old_detector_only {
        let report = run_detector(rehearsal, &BlowSettings::default()).map_err(failure)?;
        return print_report(&report, args.json);
    }
    let stop = Arc::new(AtomicBool::new(false));
    stop_on_ctrl_c(&stop);
    let progress = progress_bar((3600.0 * args.hours) as u64);
    let report = rehearse(rehearsal, &stop, |second| progress.set_position(second));
    progress.finish_and_clear();
    let report = report.map_err(failure)?;
    print_report(&report, args.json)?;
    if report.failures.is_empty() {
        Ok(())
    } else {
        // The report names the missed bars.
        Err(Failure { code: 1, message: String::new() })
    }
}

fn failure(error: RehearsalError) -> Failure {
    match error {
        RehearsalError::Pictures(error) => Failure::of_picture(error),
        RehearsalError::Interrupted => Failure { code: 130, message: "interrupted; there is no report".into() },
        RehearsalError::Room { .. } => Failure { code: 2, message: error.to_string() },
    }
}

/// Prints one JSON object, or the table.
fn print_report(report: &(impl serde::Serialize + std::fmt::Display), json: bool) -> Outcome {
    if json {
        println!("{}", serde_json::to_string(report).map_err(Failure::input)?);
    } else {
        print!("{report}");
    }
    Ok(())
}

/// All WAVs of a folder, in the order of their names.
fn recordings(folder: &Path) -> Result<Crowd, Failure> {
    let unreadable = |error: std::io::Error| Failure::input(format!("{}: {error}; check the path", folder.display()));
    let entries = std::fs::read_dir(folder).map_err(unreadable)?;
    let mut files = entries.map(|entry| entry.map(|e| e.path())).collect::<Result<Vec<_>, _>>().map_err(unreadable)?;
    files.retain(|file| file.extension().is_some_and(|e| e.eq_ignore_ascii_case("wav")));
    files.sort();
    let takes = files.iter().map(wav::read).collect::<Result<Vec<_>, _>>().map_err(Failure::input)?;
    recorded(&takes).map_err(|why| Failure::input(format!("{}: {why}", folder.display())))
}

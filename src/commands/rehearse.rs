//! `soffio rehearse`.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use super::failure::{Failure, Outcome};
use super::setup::{progress_bar, stop_on_ctrl_c};
use soffio_detector::BlowSettings;
use soffio_kiosk::venue::site::Site;
use soffio_offline::wav;
use soffio_rehearsal::{Crowd, ROOMS, Rehearsal, RehearsalError, featured_exhibits, listen, recorded, run as rehearse};

/// Longest day, h.
const LONGEST_H: f64 = 24.0;

/// Rehearses a gallery day: hundreds of made visitors, a crowd, staff, and the kiosk that hears itself; judged by what is
/// seen and heard of it.
#[derive(clap::Args, Debug)]
#[command(after_help = "\
Example: soffio rehearse --hours 8 --room hall
         soffio rehearse --hours 0.5 --seed 7 --crowd our-gallery/recordings --json
         soffio rehearse --ear --capsules 1

Visits count as answered when a blow, or a hold, visibly changes the work within 0.3 s, three times as much moves in the second
after it as in the second before, and the kiosk has answered nobody in the ten seconds before. 95 % of all visits and 85 %
of every group are asked for, and not one answer to nobody all day; otherwise the exit code is 1.")]
pub struct Args {
    /// Length of the day.
    #[arg(long, value_name = "H", default_value_t = 8.0, value_parser = parse_hours, allow_negative_numbers = true)]
    hours: f64,
    /// Another day: other visitors, other sounds.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The room: cabinet, gallery or hall.
    #[arg(long, value_name = "NAME", default_value = "gallery", value_parser = clap::builder::PossibleValuesParser::new(ROOMS.map(|(name, ..)| name)))]
    room: String,
    /// Capsules of the microphone: two are what the manual advises.
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=2))]
    capsules: u8,
    /// A folder of WAVs, recordings of your own crowd, in the place of made ones; microphone's level, nobody blowing.
    #[arg(long, value_name = "WAV-DIR")]
    crowd: Option<PathBuf>,
    /// Only its ear: no work, no sound, no pictures. In a few minutes: who is heard, how soon, and wind without breath.
    #[arg(long)]
    ear: bool,
    /// One JSON object instead of the table.
    #[arg(long)]
    json: bool,
}

fn parse_hours(text: &str) -> Result<f64, String> {
    let hours = text.parse::<f64>().ok().filter(|h| (0.05..=LONGEST_H).contains(h));
    hours.ok_or_else(|| format!("\"{text}\" is no length of a day; write hours from 0.05 to {LONGEST_H}, as in 0.5"))
}

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    let config = super::setup::config(None)?;
    let crowd = args.crowd.as_deref().map_or(Ok(Crowd::Made), recordings)?;
    let rehearsal = Rehearsal {
        works: featured_exhibits(&config).map_err(Failure::input)?,
        site: Site::new(&config, args.seed),
        room: args.room,
        capsules: args.capsules.into(),
        crowd,
        hours: args.hours,
        seed: args.seed,
    };
    if args.ear {
        let heard = listen(rehearsal, &BlowSettings::default()).map_err(failure)?;
        return say(&heard, args.json);
    }
    let stop = Arc::new(AtomicBool::new(false));
    stop_on_ctrl_c(&stop);
    let progress = progress_bar((3600.0 * args.hours) as u64);
    let report = rehearse(rehearsal, &stop, |second| progress.set_position(second));
    progress.finish_and_clear();
    let report = report.map_err(failure)?;
    say(&report, args.json)?;
    if report.failures.is_empty() {
        Ok(())
    } else {
        // The report has said which.
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

/// One JSON object, or the table.
fn say(report: &(impl serde::Serialize + std::fmt::Display), json: bool) -> Outcome {
    if json {
        println!("{}", serde_json::to_string(report).map_err(Failure::input)?);
    } else {
        print!("{report}");
    }
    Ok(())
}

/// All WAVs of a folder, in the order of their names.
fn recordings(folder: &Path) -> Result<Crowd, Failure> {
    let unread = |error: std::io::Error| Failure::input(format!("{}: {error}; check the path", folder.display()));
    let entries = std::fs::read_dir(folder).map_err(unread)?;
    let mut files = entries.map(|entry| entry.map(|e| e.path())).collect::<Result<Vec<_>, _>>().map_err(unread)?;
    files.retain(|file| file.extension().is_some_and(|e| e.eq_ignore_ascii_case("wav")));
    files.sort();
    let takes = files.iter().map(wav::read).collect::<Result<Vec<_>, _>>().map_err(Failure::input)?;
    recorded(&takes).map_err(|why| Failure::input(format!("{}: {why}", folder.display())))
}

//! `soffio-training day`: a rehearsed day with the detector alone.

use std::path::PathBuf;

use soffio_config::Config;
use soffio_kiosk::venue::site::Site;
use soffio_rehearsal::{Crowd, Rehearsal, featured_exhibits, run_detector};

use super::detector_from_tables::detector;
use super::failure::{Failure, Outcome};

/// Runs the detector alone over a rehearsed day: detected and missed breaths, latency, and false triggers.
///
/// Example: soffio-training day --hours 8 --table out/table.rs
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Length of the day.
    #[arg(long, value_name = "H", default_value_t = 8.0)]
    hours: f64,
    /// Seed of visitors and sounds.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The room: cabinet, gallery or hall.
    #[arg(long, value_name = "NAME", default_value = "gallery")]
    room: String,
    /// Capsules of the microphone.
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=2))]
    capsules: u8,
    /// A table from `soffio-training train` instead of the shipped one; several of a kind are averaged.
    #[arg(long, value_name = "FILE.rs")]
    table: Vec<PathBuf>,
    /// One JSON object instead of the table.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: Args) -> Outcome {
    let config = Config::load(None).map_err(Failure::input)?.config;
    let rehearsal = Rehearsal {
        exhibits: featured_exhibits(&config).map_err(Failure::input)?,
        site: Site::new(&config, args.seed),
        room: args.room,
        capsules: args.capsules.into(),
        crowd: Crowd::Made,
        hours: args.hours,
        seed: args.seed,
    };
    let report = run_detector(rehearsal, &detector(&args.table)?).map_err(Failure::input)?;
    if args.json {
        println!("{}", serde_json::to_string(&report).map_err(Failure::input)?);
    } else {
        print!("{report}");
    }
    Ok(())
}

//! `soffio-training day`: a rehearsed day for the detector alone.

use std::path::PathBuf;

use soffio_config::Config;
use soffio_kiosk::venue::site::Site;
use soffio_rehearsal::{Crowd, Rehearsal, featured_exhibits, listen};

use super::failure::{Failure, Outcome};
use super::tables_given::detector;

/// Lets the detector listen to a rehearsed day: who is heard, how soon, and wind without breath.
///
/// Example: soffio-training day --hours 8 --table out/table.rs
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Length of the day.
    #[arg(long, value_name = "H", default_value_t = 8.0)]
    hours: f64,
    /// Another day: other visitors, other sounds.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// The room: cabinet, gallery or hall.
    #[arg(long, value_name = "NAME", default_value = "gallery")]
    room: String,
    /// Capsules of the microphone.
    #[arg(long, value_name = "N", default_value_t = 2, value_parser = clap::value_parser!(u8).range(1..=2))]
    capsules: u8,
    /// A table that `soffio-training train` wrote, in place of the shipped one; of more than one of a kind, the mean.
    #[arg(long, value_name = "FILE.rs")]
    table: Vec<PathBuf>,
    /// One JSON object instead of the table.
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: Args) -> Outcome {
    let config = Config::load(None).map_err(Failure::input)?.config;
    let rehearsal = Rehearsal {
        works: featured_exhibits(&config).map_err(Failure::input)?,
        site: Site::new(&config, args.seed),
        room: args.room,
        capsules: args.capsules.into(),
        crowd: Crowd::Made,
        hours: args.hours,
        seed: args.seed,
    };
    let heard = listen(rehearsal, &detector(&args.table)?).map_err(Failure::input)?;
    if args.json {
        println!("{}", serde_json::to_string(&heard).map_err(Failure::input)?);
    } else {
        print!("{heard}");
    }
    Ok(())
}

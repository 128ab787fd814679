//! `soffio-training score`: marks the detector, with 95 % bounds.

use std::path::PathBuf;

use soffio_soundscape::Take;
use soffio_soundscape::scenes::Hearing;

use super::failure::{Failure, Outcome};
use super::tables_given::detector;
use crate::score::Table;
use crate::{course, recordings};
use soffio_soundscape::statistics::spearman;

/// Mark the blow detector on a folder of labelled recordings, or on made scenes that it never learnt from.
///
/// Example: soffio-training score --generated --hours 3
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Folders of labelled recordings (labels.csv).
    #[arg(required_unless_present = "generated", value_name = "FOLDER")]
    folders: Vec<PathBuf>,
    /// Made scenes: museum, knocks, breaths by distance and angle, breaths in noise, the kiosk itself.
    #[arg(long)]
    generated: bool,
    /// Hours of each kind of made scene.
    #[arg(long, default_value_t = 3.0)]
    hours: f64,
    /// Only the kinds whose name has one of these words in it, such as "museum,kiosk".
    #[arg(long, value_delimiter = ',', requires = "generated", value_name = "WORDS")]
    only: Vec<String>,
    /// Changes the made scenes.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Two capsules in made scenes.
    #[arg(long)]
    stereo: bool,
    /// Louder or quieter, dB.
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true)]
    gain: f64,
    /// A table that `soffio-training train` wrote, in place of the ear's own; of more than one of a kind, the mean.
    #[arg(long, value_name = "FILE.rs")]
    table: Vec<PathBuf>,
    /// Tell every mistake.
    #[arg(long)]
    remarks: bool,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Outcome {
    let settings = detector(&args.table)?;
    for folder in &args.folders {
        if !folder.join("labels.csv").is_file() {
            return Err(Failure::input(format!(
                "{}: no labels.csv is there. Name a folder that has one, such as `soffio-training make` writes, or take \
                 --generated.",
                folder.display()
            )));
        }
        let takes = recordings::read(folder).map_err(Failure::input)?;
        let takes: Vec<Take> =
            if args.gain == 0.0 { takes } else { takes.iter().map(|take| take.with_gain(args.gain)).collect() };
        let (mut table, mut remarks) = (Table::default(), Vec::new());
        let verdicts = course::marked(&settings, &takes, &mut table, &mut remarks);
        println!("{}\n{table}", folder.display());
        let with_level = |prefix: &str| {
            let ladder = takes.iter().zip(&verdicts).filter(|(t, _)| t.group == prefix && !t.breaths.is_empty());
            ladder.filter_map(|(t, v)| Some((t.level?, v.answers.first()?.mean_speed))).collect::<Vec<_>>()
        };
        let mut ladders: Vec<&str> =
            takes.iter().map(|t| t.group.as_str()).filter(|g| g.starts_with("ladder")).collect();
        ladders.dedup();
        for ladder in ladders {
            println!("{ladder:38} rank correlation {:.3}", spearman(&with_level(ladder)));
        }
        tell(args, &remarks);
    }
    if args.generated {
        let hearing = Hearing { gain_db: args.gain, stereo: args.stereo };
        let asked = |row: &str| args.only.is_empty() || args.only.iter().any(|word| row.contains(word));
        let (table, remarks) = course::examined(&settings, args.hours, args.seed, hearing, asked);
        if table.0.is_empty() {
            let rows: Vec<String> = course::exam(args.hours).into_iter().map(|(row, ..)| row).collect();
            return Err(Failure::input(format!(
                "--only: no kind has that in its name. There are: {}.",
                rows.join("; ")
            )));
        }
        println!("made scenes, {} h each, seed {}\n{table}", args.hours, args.seed);
        tell(args, &remarks);
    }
    Ok(())
}

fn tell(args: &Args, remarks: &[String]) {
    if args.remarks {
        remarks.iter().for_each(|remark| println!("  {remark}"));
    }
}

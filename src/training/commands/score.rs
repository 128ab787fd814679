//! `soffio-training score`: scores the detector, with 95 % bounds.

use std::path::PathBuf;

use soffio_soundscape::Take;
use soffio_soundscape::scenes::Hearing;

use super::detector_from_tables::detector;
use super::failure::{Failure, Outcome};
use crate::score::Table;
use crate::{pipeline, recordings};
use soffio_soundscape::statistics::spearman;

/// Scores the blow detector on a folder of labelled recordings, or on synthetic validation scenes.
///
/// Example: soffio-training score --generated --hours 3
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Folders of labelled recordings (labels.csv).
    #[arg(required_unless_present = "generated", value_name = "FOLDER")]
    folders: Vec<PathBuf>,
    /// Synthetic scenes: museum, knocks, breaths by distance and angle, breaths in noise, the kiosk itself.
    #[arg(long)]
    generated: bool,
    /// Hours of each kind of synthetic scene.
    #[arg(long, default_value_t = 3.0)]
    hours: f64,
    /// Only the kinds whose name contains one of these words, such as "museum,kiosk".
    #[arg(long, value_delimiter = ',', requires = "generated", value_name = "WORDS")]
    only: Vec<String>,
    /// Seed of the synthetic scenes.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Two capsules in synthetic scenes.
    #[arg(long)]
    stereo: bool,
    /// Change of the microphone's gain, dB.
    #[arg(long, default_value_t = 0.0, allow_negative_numbers = true)]
    gain: f64,
    /// A table from `soffio-training train` instead of the shipped one; several of a kind are averaged.
    #[arg(long, value_name = "FILE.rs")]
    table: Vec<PathBuf>,
    /// Print every error of the detector.
    #[arg(long)]
    remarks: bool,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Outcome {
    let settings = detector(&args.table)?;
    for folder in &args.folders {
        if !folder.join("labels.csv").is_file() {
            return Err(Failure::input(format!(
                "{}: it contains no labels.csv. Name a folder that does, such as one from `soffio-training make`, or use \
                 --generated.",
                folder.display()
            )));
        }
        let takes = recordings::read(folder).map_err(Failure::input)?;
        let takes: Vec<Take> =
            if args.gain == 0.0 { takes } else { takes.iter().map(|take| take.with_gain(args.gain)).collect() };
        let (mut table, mut remarks) = (Table::default(), Vec::new());
        let scores = pipeline::score_takes(&settings, &takes, &mut table, &mut remarks);
        println!("{}\n{table}", folder.display());
        let with_level = |prefix: &str| {
            let ladder = takes.iter().zip(&scores).filter(|(t, _)| t.group == prefix && !t.breaths.is_empty());
            ladder.filter_map(|(t, s)| Some((t.level?, s.breaths.first()?.mean_speed))).collect::<Vec<_>>()
        };
        let mut ladders: Vec<&str> =
            takes.iter().map(|t| t.group.as_str()).filter(|g| g.starts_with("ladder")).collect();
        ladders.dedup();
        for ladder in ladders {
            println!("{ladder:38} rank correlation {:.3}", spearman(&with_level(ladder)));
        }
        print_remarks(args, &remarks);
    }
    if args.generated {
        let hearing = Hearing { gain_db: args.gain, stereo: args.stereo };
        let selected = |row: &str| args.only.is_empty() || args.only.iter().any(|word| row.contains(word));
        let (table, remarks) = pipeline::validate(&settings, args.hours, args.seed, hearing, selected);
        if table.0.is_empty() {
            let rows: Vec<String> = pipeline::validation_set(args.hours).into_iter().map(|(row, ..)| row).collect();
            return Err(Failure::input(format!(
                "--only: no kind of scene has such a word in its name. The kinds are: {}.",
                rows.join("; ")
            )));
        }
        println!("synthetic scenes, {} h each, seed {}\n{table}", args.hours, args.seed);
        print_remarks(args, &remarks);
    }
    Ok(())
}

fn print_remarks(args: &Args, remarks: &[String]) {
    if args.remarks {
        remarks.iter().for_each(|remark| println!("  {remark}"));
    }
}

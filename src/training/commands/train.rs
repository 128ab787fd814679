//! `soffio-training train`: learns the frame model anew.

use std::io::Write as _;
use std::path::PathBuf;

use soffio_detector::BlowSettings;
use soffio_offline::atomic_file::AtomicFile;
use soffio_soundscape::Take;
use soffio_soundscape::scenes::Hearing;

use super::failure::{Failure, Outcome};
use super::tables_given::detector;
use crate::course::{self, Course};
use crate::descent::{self, Subject};
use crate::{recordings, tables};

/// Train the blow detector's model on made scenes and on labelled recordings, and write its table.
///
/// Example: soffio-training train --data ../shared/breath --cross-validate --out src/detector/table.rs
///
/// Example: soffio-training train --capsules 2 --size 0.1 --worlds 3 --out src/detector/pair_table.rs
#[derive(clap::Args, Debug)]
pub struct Args {
    /// A folder of labelled recordings (labels.csv).
    #[arg(long, value_name = "FOLDER")]
    data: Option<PathBuf>,
    /// Which network: that of one spectrum (1), or that which weighs what two capsules make of it (2).
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=2))]
    capsules: u8,
    /// Where the table goes; without it nothing is written.
    #[arg(long, value_name = "FILE.rs")]
    out: Option<PathBuf>,
    /// Go on with the present ear, instead of one that knows nothing; what is written is a mean of both.
    #[arg(long)]
    go_on: bool,
    /// Go on with this table in place of the present ear's; of more than one, with the mean.
    #[arg(long, value_name = "FILE.rs", requires = "go_on")]
    table: Vec<PathBuf>,
    /// Share of the present ear in that mean, 0 to 1: the more, the less of what it knew is forgotten.
    #[arg(long, default_value_t = 0.5, value_parser = share, requires = "go_on")]
    keep: f64,
    /// Lessons, each in new worlds, twice as many as the last one.
    #[arg(long, default_value_t = 4)]
    lessons: u64,
    /// Worlds of speakers and rooms in the first lesson.
    #[arg(long, default_value_t = 6)]
    worlds: u64,
    /// Size of each world: 1 is an hour and a half of museum, and the rest in proportion.
    #[arg(long, default_value_t = 0.5)]
    size: f64,
    /// Rounds over all examples after each lesson.
    #[arg(long, default_value_t = 6)]
    rounds: usize,
    /// Changes everything that is drawn.
    #[arg(long, default_value_t = 19)]
    seed: u64,
    /// First mark models on recordings whose groups they have not met.
    #[arg(long, requires = "data")]
    cross_validate: bool,
    /// Mark what was learnt on so many hours of each kind of made scene, before and after the recordings.
    #[arg(long, default_value_t = 0.0)]
    exam: f64,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Outcome {
    match args.capsules {
        2 => teach(&descent::TWO, args),
        _ => teach(&descent::ONE, args),
    }
}

fn teach<const IN: usize, const FIRST: usize, const SECOND: usize>(
    subject: &Subject<IN, FIRST, SECOND>,
    args: &Args,
) -> Outcome {
    let known: Vec<Take> = match &args.data {
        Some(folder) => recordings::read(folder).map_err(Failure::input)?,
        None => Vec::new(),
    };
    let Args { lessons, worlds, size, rounds, seed, .. } = *args;
    let began = if args.go_on { (subject.of)(&detector(&args.table)?).clone() } else { descent::untaught() };
    let course = Course { keep: args.keep, lessons, worlds, size, rounds, seed };
    let made = course::learn(subject, &course, began, |lesson, learnt| {
        println!("lesson {}: {} examples, loss {:.4}", lesson + 1, learnt.examples.len(), learnt.loss);
        if lesson + 1 == lessons {
            examine(args, &course::ear(subject, &learnt.network));
        }
    });
    if args.cross_validate {
        let (table, remarks) = course::cross_validated(subject, &course, &made, &known);
        println!("recordings, each by a model that has not met its group\n{table}");
        remarks.iter().for_each(|remark| println!("  {remark}"));
    }
    let Some(path) = &args.out else { return Ok(()) };
    let network = if known.is_empty() {
        course::joined(&course, &made.began, made.network)
    } else {
        let known: Vec<_> = known.iter().collect();
        let (network, loss) = course::refined(subject, &course, &made, &known, course::FOLDS);
        println!("with recordings: loss {loss:.4}");
        network
    };
    examine(args, &course::ear(subject, &network));
    let fail = |error: std::io::Error| Failure::input(format!("{}: {error}", path.display()));
    let file = AtomicFile::create(path).map_err(fail)?;
    let table = tables::written(subject, &network);
    file.reopen().and_then(|mut out| out.write_all(table.as_bytes())).map_err(fail)?;
    file.finish().map_err(fail)
}

/// A share, 0 … 1.
fn share(given: &str) -> Result<f64, String> {
    let share = given.parse::<f64>().ok().filter(|share| (0.0..=1.0).contains(share));
    share.ok_or_else(|| format!("{given:?} is no share. Give a number from 0 to 1."))
}

/// Marks an ear on made scenes.
fn examine(args: &Args, ear: &BlowSettings) {
    if args.exam > 0.0 {
        let plain = Hearing { gain_db: 0.0, stereo: args.capsules == 2 };
        let (table, _) = course::examined(ear, args.exam, args.seed, plain, |_| true);
        println!("{table}");
    }
}

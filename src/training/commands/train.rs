//! `soffio-training train`: trains the networks of the detector.

use std::io::Write as _;
use std::path::PathBuf;

use soffio_detector::BlowSettings;
use soffio_offline::atomic_file::AtomicFile;
use soffio_soundscape::Take;
use soffio_soundscape::scenes::Hearing;

use super::detector_from_tables::detector;
use super::failure::{Failure, Outcome};
use crate::descent::{self, NetworkSpec};
use crate::pipeline::{self, TrainingSettings};
use crate::{recordings, tables};

/// Trains the blow detector's network on synthetic scenes and on labelled recordings, and writes its table.
///
/// Example: soffio-training train --data ../shared/breath --cross-validate --out src/detector/table.rs
///
/// Example: soffio-training train --capsules 2 --size 0.1 --scenarios 3 --out src/detector/dual_mic_table.rs
#[derive(clap::Args, Debug)]
pub struct Args {
    /// A folder of labelled recordings (labels.csv).
    #[arg(long, value_name = "FOLDER")]
    data: Option<PathBuf>,
    /// Network: that of one spectrum (1), or that of a dual microphone (2).
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=2))]
    capsules: u8,
    /// File for the table; without it nothing is written.
    #[arg(long, value_name = "FILE.rs")]
    out: Option<PathBuf>,
    /// Continue from the shipped network instead of random weights; the result is a mean of both.
    #[arg(long, alias = "go-on")]
    resume: bool,
    /// Continue from this table instead of the shipped one; several are averaged.
    #[arg(long, value_name = "FILE.rs", requires = "resume")]
    table: Vec<PathBuf>,
    /// Share of the initial network in that mean, 0 to 1: a larger share forgets less.
    #[arg(long, default_value_t = 0.5, value_parser = share, requires = "resume")]
    keep: f64,
    /// Iterations of training, each with twice as many new scenarios as the last one.
    #[arg(long, alias = "lessons", default_value_t = 4)]
    iterations: u64,
    /// Scenarios of the first iteration.
    #[arg(long, alias = "worlds", default_value_t = 6)]
    scenarios: u64,
    /// Size of each scenario: 1 is an hour and a half of museum, and the other scenes in proportion.
    #[arg(long, default_value_t = 0.5)]
    size: f64,
    /// Epochs over all examples after each iteration.
    #[arg(long, alias = "rounds", default_value_t = 6)]
    epochs: usize,
    /// Seed of everything random.
    #[arg(long, default_value_t = 19)]
    seed: u64,
    /// First score the recordings by cross-validation, each by a model that was not trained on its group.
    #[arg(long, requires = "data")]
    cross_validate: bool,
    /// Score the network on this many hours of each kind of synthetic scene, before and after training with recordings.
    #[arg(long, alias = "exam", value_name = "HOURS", default_value_t = 0.0)]
    validate: f64,
}

/// Renamed options of this command, old and new; the old ones are still accepted.
pub(super) const RENAMED: [(&str, &str); 5] = [
    ("--go-on", "--resume"),
    ("--lessons", "--iterations"),
    ("--worlds", "--scenarios"),
    ("--rounds", "--epochs"),
    ("--exam", "--validate"),
];

/// Runs the command.
pub(super) fn run(args: &Args) -> Outcome {
    match args.capsules {
        2 => train_network(&descent::DUAL_MIC, args),
        _ => train_network(&descent::SINGLE_MIC, args),
    }
}

fn train_network<const IN: usize, const FIRST: usize, const SECOND: usize>(
    spec: &NetworkSpec<IN, FIRST, SECOND>,
    args: &Args,
) -> Outcome {
    let recordings: Vec<Take> = match &args.data {
        Some(folder) => recordings::read(folder).map_err(Failure::input)?,
        None => Vec::new(),
    };
    let Args { iterations, scenarios, size, epochs, seed, .. } = *args;
    let initial = if args.resume { (spec.get)(&detector(&args.table)?).clone() } else { descent::untrained() };
    let settings = TrainingSettings { keep: args.keep, iterations, scenarios, size, epochs, seed };
    let synthetic = pipeline::learn(spec, &settings, initial, |iteration, trained| {
        println!("iteration {}: {} examples, loss {:.4}", iteration + 1, trained.examples.len(), trained.loss);
        if iteration + 1 == iterations {
            validate(args, &pipeline::settings_with(spec, &trained.network));
        }
    });
    if args.cross_validate {
        let (table, remarks) = pipeline::cross_validated(spec, &settings, &synthetic, &recordings);
        println!("recordings, each by a model that was not trained on its group\n{table}");
        remarks.iter().for_each(|remark| println!("  {remark}"));
    }
    let Some(path) = &args.out else { return Ok(()) };
    let network = if recordings.is_empty() {
        pipeline::blend_with_initial(&settings, &synthetic.initial, synthetic.network)
    } else {
        let recordings: Vec<_> = recordings.iter().collect();
        let (network, loss) = pipeline::refine(spec, &settings, &synthetic, &recordings, pipeline::FOLDS);
        println!("with recordings: loss {loss:.4}");
        network
    };
    validate(args, &pipeline::settings_with(spec, &network));
    let fail = |error: std::io::Error| Failure::input(format!("{}: {error}", path.display()));
    let file = AtomicFile::create(path).map_err(fail)?;
    let table = tables::written(spec, &network);
    file.reopen().and_then(|mut out| out.write_all(table.as_bytes())).map_err(fail)?;
    file.finish().map_err(fail)
}

/// Parses a share, 0 … 1.
fn share(given: &str) -> Result<f64, String> {
    let share = given.parse::<f64>().ok().filter(|share| (0.0..=1.0).contains(share));
    share.ok_or_else(|| format!("{given:?} is not a share. Give a number from 0 to 1."))
}

/// Scores a detector on synthetic validation scenes.
fn validate(args: &Args, detector: &BlowSettings) {
    if args.validate > 0.0 {
        let plain = Hearing { gain_db: 0.0, stereo: args.capsules == 2 };
        let (table, _) = pipeline::validate(detector, args.validate, args.seed, plain, |_| true);
        println!("{table}");
    }
}

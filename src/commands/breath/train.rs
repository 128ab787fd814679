//! `soffio breath train`: learns the frame model anew.

use std::io::Write as _;
use std::path::PathBuf;

use super::super::{Failure, Outcome};
use crate::offline::ear::course::{self, Course};
use crate::offline::ear::{Take, recordings, train};
use crate::offline::whole_file::WholeFile;
use crate::wind::blow::Rules;

/// Train the blow detector's model on made scenes and on labelled recordings, and write its table.
///
/// Example: soffio breath train --data ../shared/breath --cross-validate --out src/wind/blow/table.rs
#[derive(clap::Args, Debug)]
pub struct Args {
    /// A folder of labelled recordings (labels.csv).
    #[arg(long, value_name = "FOLDER")]
    data: Option<PathBuf>,
    /// Where the table goes; without it nothing is written.
    #[arg(long, value_name = "FILE.rs")]
    out: Option<PathBuf>,
    /// Worlds of speakers and rooms.
    #[arg(long, default_value_t = 6)]
    worlds: u64,
    /// Hours of museum in each world, and the rest in proportion.
    #[arg(long, default_value_t = 1.0)]
    size: f64,
    /// Rounds over all examples.
    #[arg(long, default_value_t = 5)]
    rounds: usize,
    /// Changes everything that is drawn.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// First mark models on recordings whose groups they have not met.
    #[arg(long, requires = "data")]
    cross_validate: bool,
}

/// Runs the command.
pub fn run(args: &Args) -> Outcome {
    let known: Vec<Take> = match &args.data {
        Some(folder) => recordings::read(folder).map_err(Failure::input)?,
        None => Vec::new(),
    };
    let course = Course { worlds: args.worlds, size: args.size, rounds: args.rounds, seed: args.seed };
    let made = course::made_examples(&course);
    println!("{} examples from {} worlds", made.len(), args.worlds);
    if args.cross_validate {
        let (table, remarks) = course::cross_validated(&course, &made, &known, &Rules::default());
        println!("{table}");
        remarks.iter().for_each(|remark| println!("  {remark}"));
    }
    let Some(path) = &args.out else { return Ok(()) };
    let (model, loss) = course::taught_model(&course, &made, &known.iter().collect::<Vec<_>>(), course::FOLDS);
    println!("loss {loss:.4}");
    let fail = |error: std::io::Error| Failure::input(format!("{}: {error}", path.display()));
    let file = WholeFile::create(path).map_err(fail)?;
    file.reopen().and_then(|mut out| out.write_all(train::table(&model).as_bytes())).map_err(fail)?;
    file.finish().map_err(fail)
}

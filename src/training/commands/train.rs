//! `soffio-training train`: trains the detector's model on the training generator's scenes.

use std::path::PathBuf;
use std::time::Instant;

use super::failure::{Failure, Outcome};
use crate::{examples, model};

/// Trains the breath detector's model and writes its weights. The same options make the same bits on any machine.
///
/// Example: soffio-training train --out audio/models/breath.safetensors
#[derive(clap::Args, Debug)]
pub struct Args {
    /// File for the weights; without it only their hash is printed.
    #[arg(long, value_name = "FILE.safetensors")]
    out: Option<PathBuf>,
    /// Number of scenes.
    #[arg(long, default_value_t = 900)]
    scenes: u64,
    /// Trees of the log-odds.
    #[arg(long, default_value_t = 300)]
    trees: usize,
    /// Trees of the speed.
    #[arg(long, default_value_t = 120)]
    speed_trees: usize,
    /// Seed of everything random.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Outcome {
    let began = Instant::now();
    let examples = examples::of_seed(args.seed, args.scenes);
    eprintln!("{} examples in {:.0} s", examples.levels.len(), began.elapsed().as_secs_f64());
    let model = model::trained(&examples, args.trees, args.speed_trees, args.seed);
    eprintln!("trained in {:.0} s", began.elapsed().as_secs_f64());
    println!("{}", model::hash(&model));
    let Some(path) = &args.out else { return Ok(()) };
    let facts = [("seed", args.seed), ("scenes", args.scenes), ("trees", args.trees as u64)];
    let facts = facts.map(|(name, fact)| (name, fact.to_string()));
    let file = model::written(&model, &facts).map_err(Failure::input)?;
    std::fs::write(path, file).map_err(|error| Failure::input(format!("{}: {error}", path.display())))
}

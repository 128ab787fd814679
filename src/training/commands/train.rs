//! `soffio-training train`: trains the detector's network on the training generator's scenes.

use std::path::PathBuf;
use std::time::Instant;

use soffio_detector::network::Network;

use super::failure::{Failure, Outcome};
use crate::{descent, examples, model};

/// First scene that is never trained on: it measures the loss on new scenes.
const FIRST_NEW_SCENE: u64 = 1_000_000;

/// Trains the breath detector's network and writes its weights. The same options make the same bits on any machine.
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
    /// Times that each scene is seen.
    #[arg(long, default_value_t = 12)]
    epochs: usize,
    /// Seed of everything random.
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Outcome {
    let began = Instant::now();
    let scenes = examples::of_seed(args.seed, 0..args.scenes);
    let new = examples::of_seed(args.seed, FIRST_NEW_SCENE..FIRST_NEW_SCENE + args.scenes.div_ceil(20));
    let hours = scenes.iter().map(Vec::len).sum::<usize>() as f64 * soffio_detector::spectrum::FRAME_S / 3600.0;
    eprintln!("{} scenes, {hours:.2} h, made in {:.0} s", scenes.len(), began.elapsed().as_secs_f64());
    let mut network = descent::initial(&scenes, args.seed);
    descent::train(&mut network, &scenes, args.epochs, args.seed, |epoch, loss, network: &Network| {
        let new = descent::loss(network, &new);
        eprintln!("epoch {}: loss {loss:.4}, on new scenes {new:.4}, {:.0} s", epoch + 1, began.elapsed().as_secs_f64());
    });
    println!("{}", model::hash(&mut network));
    let Some(path) = &args.out else { return Ok(()) };
    let facts = [("seed", args.seed.to_string()), ("scenes", args.scenes.to_string()), ("epochs", args.epochs.to_string())];
    let file = model::written(&mut network, &facts).map_err(Failure::input)?;
    std::fs::write(path, file).map_err(|error| Failure::input(format!("{}: {error}", path.display())))
}

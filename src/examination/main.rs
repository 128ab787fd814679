//! Examines the kiosk's breath detector and prints the table.

use clap::{Parser, ValueEnum};
use soffio_examination::battery::{Battery, Part, run};
use soffio_examination::subject::Today;

/// Examines the kiosk's breath detector with synthetic breaths, draughts and museums.
#[derive(Parser)]
struct Arguments {
    /// Number and length of takes relative to the full size.
    #[arg(long, default_value_t = 0.1)]
    size: f64,
    /// Capsules of the microphone, 1 or 2.
    #[arg(long, default_value_t = 1, value_parser = clap::value_parser!(u8).range(1..=2))]
    capsules: u8,
    /// Seed of all sounds.
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Only one part of the battery.
    #[arg(long)]
    only: Option<Only>,
    /// Prints JSON instead of a table.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum Only {
    Breaths,
    Microphones,
    Noises,
    Draughts,
    Kiosk,
}

fn main() {
    let Arguments { size, capsules, seed, only, json } = Arguments::parse();
    let only = only.map(|only| match only {
        Only::Breaths => Part::Breaths,
        Only::Microphones => Part::Microphones,
        Only::Noises => Part::Noises,
        Only::Draughts => Part::Draughts,
        Only::Kiosk => Part::Kiosk,
    });
    let battery = Battery { size, capsules: capsules.into(), seed, only };
    let tally = run(&|rate| Box::new(Today::new(rate)), &battery);
    if json {
        let lines = serde_json::to_string_pretty(&tally.lines()).unwrap_or_default();
        println!("{lines}");
    } else {
        println!("size {size}, capsules {capsules}, seed {seed}{tally}");
    }
}

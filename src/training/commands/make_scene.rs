//! `soffio-training make-scene`: one scene of the training, to listen to and to look at.

use std::fmt::Write as _;
use std::path::PathBuf;

use super::failure::{Failure, Outcome};
use crate::generator::{Scene, scene};

/// Writes a scene of the training as a WAV, and its labels beside it as two CSV files.
///
/// Example: soffio-training make-scene 1 7 out/scene.wav
#[derive(clap::Args, Debug)]
pub struct Args {
    /// Seed of all scenes.
    seed: u64,
    /// Number of the scene.
    index: u64,
    /// WAV: two capsules, and what the kiosk plays as a third channel. Beside it appear OUT.air.csv (air and level every
    /// 10 ms) and OUT.breaths.csv.
    out: PathBuf,
}

/// Runs the command.
pub(super) fn run(args: &Args) -> Outcome {
    let scene = scene(args.seed, args.index);
    write_wave(args, &scene).map_err(|error| Failure::input(format!("{}: {error}", args.out.display())))?;
    let mut air = String::from("s,air,over_db\n");
    for (ms, (speed, over)) in scene.air.iter().zip(&scene.over_db).enumerate().step_by(10) {
        let _ = writeln!(air, "{:.2},{speed:.3},{over:.1}", ms as f64 * 1e-3);
    }
    let mut breaths =
        String::from("manner,lips_from,lips_to,capsule_from,capsule_to,lips_speed,peak_air,distance,angle_deg\n");
    for b in &scene.breaths {
        let _ = writeln!(
            breaths,
            "{},{:.3},{:.3},{:.3},{:.3},{:.2},{:.3},{:.3},{:.1}",
            b.manner, b.lips.0, b.lips.1, b.capsule.0, b.capsule.1, b.lips_speed, b.peak_air, b.distance, b.angle_deg
        );
    }
    for (name, text) in [("air.csv", air), ("breaths.csv", breaths)] {
        let path = args.out.with_extension(name);
        std::fs::write(&path, text).map_err(|error| Failure::input(format!("{}: {error}", path.display())))?;
    }
    println!("{}: {}, {} breaths", args.out.display(), scene.kind, scene.breaths.len());
    Ok(())
}

fn write_wave(args: &Args, scene: &Scene) -> Result<(), hound::Error> {
    let channels: Vec<&[f32]> =
        scene.capsules.iter().chain([&scene.played]).filter(|c| !c.is_empty()).map(Vec::as_slice).collect();
    let spec = hound::WavSpec {
        channels: channels.len() as u16,
        sample_rate: scene.rate,
        bits_per_sample: 32,
        sample_format: hound::SampleFormat::Float,
    };
    let mut file = hound::WavWriter::create(&args.out, spec)?;
    for i in 0..scene.capsules[0].len() {
        for channel in &channels {
            file.write_sample(channel.get(i).copied().unwrap_or(0.0))?;
        }
    }
    file.finalize()
}

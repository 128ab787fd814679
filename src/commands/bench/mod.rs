//! `soffio bench`.

mod exhibits;
#[cfg(feature = "kiosk")]
mod likeness;
#[cfg(feature = "kiosk")]
mod picture;
mod procedural;
mod scenes;
mod sound;
mod wind;

use std::path::PathBuf;

use clap::ValueEnum;

use super::arguments::parse_seconds;
#[cfg(feature = "kiosk")]
use super::arguments::parse_size;
use super::failure::Outcome;
use soffio_multibody::dynamics::{Integrator, Solver};
use soffio_offline::scene::Limits;

/// Default simulated time of an exhibit, s.
const EXHIBIT_SECONDS: f64 = 10.0;
/// Default simulated time of its frames, s; sixty frames a second.
#[cfg(feature = "kiosk")]
const PICTURE_SECONDS: f64 = 2.0;

/// Measures the cost of simulation steps, sounds and frames.
///
/// By default of exhibits: still air, motion without wind, a hard breath and its sound, and the slowest steps in a hard breath,
/// in a fast drag and in the assembly. Options measure a physics scene with its accuracy, mechanisms of growing size, wind on
/// many patches, thousands of partials, position-based motion, or frames.
#[derive(clap::Args, Debug)]
#[command(
    after_help = "Examples:\n  soffio bench steel-fish --json\n  soffio bench --seeds 100 --within 4.17\n  soffio bench --scene chain.json --dt 0.001 --json\n  \
                        soffio bench --linear\n  soffio bench --wind\n  soffio bench --sound\n  \
                        soffio bench --procedural\n  soffio bench steel-fish --picture 1920x1080\n  soffio bench strikers --likeness 640x360"
)]
pub struct Args {
    /// Ids under `exhibits/`, or folders; default is every shipped exhibit.
    #[arg(conflicts_with_all = ["scene", "linear", "wind", "sound"])]
    exhibits: Vec<String>,
    /// A scene, JSON of the format `soffio-scene/1` (or `isaac-bench-scene/1`); more than one may be given.
    #[arg(long, value_name = "FILE.json")]
    scene: Vec<PathBuf>,
    /// Cost per body in chains and binary trees of 10, 100, 1,000 and 10,000 bodies.
    #[arg(long, conflicts_with = "scene")]
    linear: bool,
    /// Cost of the wind on 10,000 patches among 5,000 triangles, compared with testing every triangle.
    #[arg(long, conflicts_with_all = ["scene", "linear"])]
    wind: bool,
    /// Cost of partials at each instruction set, and of the heaviest scene: 48 bodies with 6,328 partials, and slides with 235.
    #[arg(long, conflicts_with_all = ["scene", "linear", "wind"])]
    sound: bool,
    /// Cost of position-based motion: a dragged mobile of 127 joints, and exhibits compared with dynamics.
    #[arg(long, conflicts_with_all = ["scene", "linear", "wind", "sound"])]
    procedural: bool,
    /// Cost of a frame of this size in a hard breath: processor time of the whole program, including a software driver.
    #[cfg(feature = "kiosk")]
    #[arg(long, value_name = "WxH", value_parser = parse_size, conflicts_with_all = ["scene", "linear", "wind", "sound", "procedural"])]
    picture: Option<(u32, u32)>,
    /// Likeness of the live picture to the reference (`soffio render --reference`) in pictures of this size, at rest and in a
    /// breath: mean FLIP.
    #[cfg(feature = "kiosk")]
    #[arg(long, value_name = "WxH", value_parser = parse_size, conflicts_with_all = ["scene", "linear", "wind", "sound", "procedural", "picture"])]
    likeness: Option<(u32, u32)>,
    /// Folder for the pictures of `--likeness`.
    #[cfg(feature = "kiosk")]
    #[arg(long, value_name = "DIR", requires = "likeness")]
    pictures: Option<PathBuf>,
    /// Time step of a scene, s; default are those in the scene.
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds, allow_negative_numbers = true, requires = "scene")]
    dt: Option<f64>,
    /// Integrator of a scene.
    #[arg(long, value_enum, default_value_t = IntegratorArg::Auto)]
    integrator: IntegratorArg,
    /// Linear solver of a scene.
    #[arg(long, value_enum, default_value_t = SolverArg::Sparse)]
    solver: SolverArg,
    /// Assemblies of an exhibit, each from parts scattered by a seed of its own.
    #[arg(long, value_name = "N", default_value_t = 5, conflicts_with_all = ["scene", "linear", "wind", "sound", "procedural"])]
    seeds: u64,
    /// Longest allowed step of an exhibit, ms; the command fails if one takes longer.
    #[arg(long, value_name = "MS", conflicts_with_all = ["scene", "linear", "wind", "sound", "procedural"])]
    within: Option<f64>,
    /// Simulated seconds: of each measurement of an exhibit (10 if not given; 2 of pictures), at most of a scene.
    #[arg(long, value_parser = parse_seconds, allow_negative_numbers = true)]
    seconds: Option<f64>,
    /// Processor time after which the pass that measures a scene's accuracy ends, s.
    #[arg(long, value_name = "SECONDS", value_parser = parse_seconds, allow_negative_numbers = true, default_value_t = 60.0)]
    budget: f64,
    /// One JSON object a line.
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum IntegratorArg {
    Auto,
    Fast,
    RungeKutta,
    Precise,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum SolverArg {
    Sparse,
    Dense,
}

/// Runs the command.
pub fn run(args: Args) -> Outcome {
    if args.linear {
        return scenes::linear(args.json);
    }
    if args.wind {
        return wind::run(args.json);
    }
    if args.sound {
        return sound::run(args.json);
    }
    if args.procedural {
        return procedural::run(&args.exhibits, args.seconds.unwrap_or(EXHIBIT_SECONDS), args.json);
    }
    #[cfg(feature = "kiosk")]
    if let Some(size) = args.picture {
        return picture::run(&args.exhibits, size, args.seconds.unwrap_or(PICTURE_SECONDS), args.json);
    }
    #[cfg(feature = "kiosk")]
    if let Some(size) = args.likeness {
        let seconds = args.seconds.unwrap_or(PICTURE_SECONDS);
        return likeness::run(&args.exhibits, size, seconds, args.pictures.as_deref(), args.json);
    }
    if args.scene.is_empty() {
        let seconds = args.seconds.unwrap_or(EXHIBIT_SECONDS);
        return exhibits::run(&args.exhibits, (seconds, args.seeds), args.within, args.json);
    }
    let integrator = match args.integrator {
        IntegratorArg::Auto => Integrator::Auto,
        IntegratorArg::Fast => Integrator::Fast,
        IntegratorArg::RungeKutta => Integrator::RungeKutta,
        IntegratorArg::Precise => Integrator::Precise,
    };
    let solver = match args.solver {
        SolverArg::Sparse => Solver::Sparse,
        SolverArg::Dense => Solver::Dense,
    };
    let limits = Limits { seconds: args.seconds.unwrap_or(f64::INFINITY), budget: args.budget };
    scenes::run(&args.scene, args.dt, integrator, solver, limits, args.json)
}

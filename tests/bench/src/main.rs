//! Soffio and Rapier on the same scenes in one run: cost, energy and joints side by side.
//!
//! All engines are built together (one compiler, LTO, this processor's instructions), run in one thread of one
//! process, and take turns: a round of each, three times over, best of three. Motion is judged by the same observer,
//! from poses and velocities and the scene file's masses.

mod rapier;

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Parser;
use soffio_multibody::dynamics::{Integrator, Solver};
use soffio_offline::scene::run::{self, Best, ROUNDS};
use soffio_offline::scene::{BenchRecord, Engine, Limits, PhysicsScene, Soffio};

/// Version of the peer, as the manifest pins it.
const RAPIER: &str = "0.36.1";
/// The largest figure for the peer's dense multibody, whose step grows with the cube of the bodies.
const MULTIBODY_MOST: usize = 100;

/// Runs scenes in Soffio and Rapier and prints both side by side.
#[derive(Parser)]
struct Args {
    /// Scenes of the format `soffio-scene/1` or `isaac-bench-scene/1`.
    #[arg(required = true)]
    scenes: Vec<PathBuf>,
    /// Step, s; default is each scene's first.
    #[arg(long)]
    dt: Option<f64>,
    /// Most simulated seconds.
    #[arg(long, default_value_t = f64::INFINITY)]
    seconds: f64,
    /// Processor time of each engine's pass that measures motion, s.
    #[arg(long, default_value_t = 10.0)]
    budget: f64,
    /// Peers to run, of: impulse-f32, impulse-f32-it20-warm, multibody-f32, impulse-f64, multibody-f64.
    #[arg(long, value_delimiter = ',', default_values_t = ["impulse-f32".to_owned(), "impulse-f32-it20-warm".to_owned(), "multibody-f64".to_owned()])]
    peers: Vec<String>,
    /// One JSON object a line for each engine and scene.
    #[arg(long)]
    json: bool,
}

/// An engine and how it was set.
struct Contender {
    engine: &'static str,
    version: String,
    config: String,
    make: Box<dyn Fn(&PhysicsScene, f64) -> Option<Box<dyn Engine>>>,
}

fn peer(name: &str) -> Option<Contender> {
    let make: Box<dyn Fn(&PhysicsScene, f64) -> Option<Box<dyn Engine>>> = match name {
        "impulse-f32" => Box::new(|scene, dt| rapier::single::impulse(scene, dt, 4, false)),
        "impulse-f32-it20-warm" => Box::new(|scene, dt| rapier::single::impulse(scene, dt, 20, true)),
        "impulse-f64" => Box::new(|scene, dt| rapier::double::impulse(scene, dt, 4, false)),
        "multibody-f32" => Box::new(|scene, dt| rapier::single::multibody(scene, dt)),
        "multibody-f64" => Box::new(|scene, dt| rapier::double::multibody(scene, dt)),
        _ => return None,
    };
    Some(Contender { engine: "rapier3d", version: RAPIER.into(), config: name.into(), make })
}

fn ours() -> Contender {
    let (integrator, solver) = (Integrator::Auto, Solver::Sparse);
    Contender {
        engine: "soffio",
        version: env!("CARGO_PKG_VERSION").into(),
        config: run::config(integrator, solver),
        make: Box::new(move |scene, dt| Some(Box::new(Soffio::new(scene, dt, integrator, solver)))),
    }
}

/// Has a scene nothing but joints and couplings?
fn articulated(scene: &PhysicsScene) -> bool {
    scene.surface.is_none() && scene.joints.iter().all(|joint| joint.limits.is_none())
}

/// A row of each contender that can run the scene, in their order.
fn measure(contenders: &[Contender], scene: &PhysicsScene, dt: f64, limits: Limits) -> Vec<Option<BenchRecord>> {
    let mut best = vec![Best::default(); contenders.len()];
    for _ in 0..ROUNDS {
        for (contender, best) in contenders.iter().zip(&mut best) {
            if let Some(mut engine) = (contender.make)(scene, dt) {
                best.run_round(engine.as_mut(), run::step_count(scene, dt, limits.seconds), limits);
            }
        }
    }
    let row = |(contender, best): (&Contender, &Best)| {
        let mut engine = (contender.make)(scene, dt)?;
        let mut watched = run::observe(scene, engine.as_mut(), dt, limits);
        for _ in 1..ROUNDS {
            if let Some(mut engine) = (contender.make)(scene, dt) {
                watched.times.repeat(engine.as_mut());
            }
        }
        Some(BenchRecord::new([contender.engine, &contender.version, &contender.config], scene, dt, best, &watched))
    };
    contenders.iter().zip(&best).map(row).collect()
}

fn cell(row: &BenchRecord) -> String {
    let energy = match row.diverged_at_s {
        Some(t) => format!("div {t:.2}s"),
        None => format!("{:.1e}", row.max_energy_drift_rel),
    };
    format!("{:>11.2} {energy:>9} {:>8.1e} {:>7.2}", row.us_per_step, row.max_joint_err_m, row.sim_s)
}

fn main() -> ExitCode {
    let args = Args::parse();
    let mut contenders = vec![ours()];
    for name in &args.peers {
        let Some(peer) = peer(name) else {
            eprintln!("compare: there is no peer \"{name}\"; see --help");
            return ExitCode::from(2);
        };
        contenders.push(peer);
    }
    if !args.json {
        let head = format!("{:>11} {:>9} {:>8} {:>7}", "us/step", "E", "J", "sim s");
        println!("{:<20} {:>8} | soffio {head} | {:<22} {head} | theirs/ours", "scene", "dt", "rapier3d");
    }
    for path in &args.scenes {
        let scene = match PhysicsScene::read(path) {
            Ok(scene) => scene,
            Err(error) => {
                eprintln!("compare: {error}");
                return ExitCode::from(1);
            }
        };
        let dt = args.dt.unwrap_or(scene.dts[0]);
        let rows = measure(&contenders, &scene, dt, Limits { seconds: args.seconds, budget: args.budget });
        if args.json {
            for row in rows.iter().flatten() {
                println!("{}", serde_json::to_string(row).expect("numbers and names are JSON"));
            }
            continue;
        }
        let Some(own) = &rows[0] else { continue };
        for (contender, row) in contenders.iter().zip(&rows).skip(1) {
            let head = format!("{:<20} {dt:>8.6} |        {} | {:<22}", scene.name, cell(own), contender.config);
            match row {
                Some(row) => println!("{head} {} | {:.2}", cell(row), row.us_per_step / own.us_per_step),
                None => println!("{head} cannot run it"),
            }
        }
    }
    ExitCode::SUCCESS
}

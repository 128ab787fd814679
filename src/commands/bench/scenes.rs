//! Physics scenes, and the cost per body in growing mechanisms: rows of JSON, or a table.

use std::path::PathBuf;

use crate::commands::failure::{Failure, Outcome};
use soffio_multibody::dynamics::{Integrator, Solver};
use soffio_offline::scene::linear::{self, SIZES};
use soffio_offline::scene::{BenchRecord, FORMAT, Limits, OLD_FORMAT, PhysicsScene, run};

/// Measures each scene at `dt`, or at the steps that it names. All files are read before the first is run.
pub fn run(
    files: &[PathBuf],
    dt: Option<f64>,
    integrator: Integrator,
    solver: Solver,
    limits: Limits,
    json: bool,
) -> Outcome {
    let scenes: Vec<_> =
        files.iter().map(|file| PhysicsScene::read(file)).collect::<Result<_, _>>().map_err(Failure::input)?;
    for (file, scene) in files.iter().zip(&scenes).filter(|(_, scene)| scene.format == OLD_FORMAT) {
        let file = file.display();
        eprintln!("{file}: `{}` is now called `{FORMAT}`; `soffio check --fix {file}` rewrites the file", scene.format);
    }
    if !json {
        println!(
            "{:<22} {:>5} {:>9} {:>11} {:>9} {:>9} {:>9} {:>8} {:>9} {:>9} {:>9} {:>7}",
            "scene", "n", "dt", "us/step", "p50", "p99", "p100", "substeps", "energy", "joint", "diverged", "sim s"
        );
    }
    for scene in &scenes {
        for &dt in dt.as_ref().map_or(&scene.dts[..], std::slice::from_ref) {
            let row = run::measure(scene, dt, integrator, solver, limits);
            if json {
                println!("{}", serde_json::to_string(&row).map_err(Failure::input)?);
            } else {
                print(&row);
            }
        }
    }
    Ok(())
}

fn print(row: &BenchRecord) {
    println!(
        "{:<22} {:>5} {:>9.6} {:>11.2} {:>9.1} {:>9.1} {:>9.1} {:>8.1} {:>9.1e} {:>9.1e} {:>9} {:>7.2}",
        row.scene,
        row.n,
        row.dt,
        row.us_per_step,
        row.times.p50_us,
        row.times.p99_us,
        row.times.p100_us,
        row.substeps,
        row.max_energy_drift_rel,
        row.max_joint_err_m,
        row.diverged_at_s.map_or_else(|| "-".to_owned(), |t| format!("{t:.2} s")),
        row.sim_s
    );
    if let Some(contacts) = &row.contacts {
        println!(
            "    contacts: overlap {:.1e} m, at the end {:.1e} m; energy rises {:.1e} J; drift {} in the last second, {:.2} m in \
             all; {} asleep; worst step {}",
            contacts.max_penetration_m,
            contacts.rest_penetration_m,
            contacts.max_energy_rise_j,
            contacts.rest_drift_m.map_or_else(|| "-".to_owned(), |drift| format!("{drift:.1e} m")),
            contacts.max_way_m,
            row.asleep,
            row.times.worst_step
        );
    }
    if let (Some(speed), Some(drop), Some(phase)) =
        (row.s4_speed_rel_err, row.s4_drop_rel_err, row.s4_max_coupling_err_m)
    {
        println!("    weight: speed {speed:.1e}, drop {drop:.1e}; gears {phase:.1e} m");
    }
    if let (Some(line), Some(cubic), Some(ratio)) =
        (row.s5_period_err_ppm, row.s5_period_err_hermite_ppm, row.s5_amplitude_ratio)
    {
        println!("    period: {line:.2e} ppm by lines, {cubic:.2e} ppm by cubics; amplitude {ratio:.9}");
    }
    if !row.repeat_bitwise {
        println!("    its rounds do not agree bit for bit");
    }
}

/// Measures chains and trees of growing size.
pub fn linear(json: bool) -> Outcome {
    if !json {
        println!("{:<6} {:>6} {:>14} {:>14}", "shape", "n", "us/body/step", "factor+solve");
    }
    for (shape, scene) in linear::scenes(SIZES[SIZES.len() - 1]) {
        let cost = linear::measure(shape, &scene, 1.0);
        if json {
            println!("{}", serde_json::to_string(&cost).map_err(Failure::input)?);
        } else {
            let (step, solve) = (cost.us_per_body_step, cost.us_per_body_factor_solve);
            println!("{:<6} {:>6} {step:>14.4} {solve:>14.4}", cost.shape, cost.n);
        }
    }
    Ok(())
}

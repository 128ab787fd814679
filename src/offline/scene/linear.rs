//! Cost per body of growing mechanisms: a chain and a binary tree of 10 to 10,000 bodies.
//!
//! The cost per body of a linear-time solver is constant, apart from cache effects.

use std::hint::black_box;

use cpu_time::ThreadTime;
use serde::Serialize;

use super::format::PhysicsScene;
use super::make;
use super::run::{Engine, ROUNDS, Soffio};
use soffio_multibody::articulation::System;
use soffio_multibody::dynamics::{Integrator, Solver};

/// Numbers of bodies.
pub const SIZES: [usize; 4] = [10, 100, 1_000, 10_000];
/// Seed of the scenes.
const SEED: u64 = 1;
/// Step of the integrator, s.
const DT: f64 = 1e-3;
/// Body steps of a round: enough to outweigh reading the clock and warming the caches.
const BODIES_A_ROUND: usize = 200_000;

/// Cost of one mechanism, processor time, best of three.
#[derive(Clone, Debug, Serialize)]
pub struct Cost {
    /// `chain` or `tree`.
    pub shape: &'static str,
    /// Number of bodies.
    pub n: usize,
    /// µs per body and Runge–Kutta step.
    pub us_per_body_step: f64,
    /// µs per body of one factorisation and one solve.
    pub us_per_body_factor_solve: f64,
}

/// The mechanisms to measure: (shape, scene), with at most `largest` bodies.
pub fn scenes(largest: usize) -> impl Iterator<Item = (&'static str, PhysicsScene)> {
    SIZES
        .into_iter()
        .filter(move |&n| n <= largest)
        .flat_map(|n| [("chain", make::chain(n, SEED)), ("tree", make::mobile(n, SEED))])
}

/// Measures one mechanism; `effort` scales the length of the measurement.
pub fn measure(shape: &'static str, scene: &PhysicsScene, effort: f64) -> Cost {
    let n = scene.bodies.len();
    let rounds = ((effort * BODIES_A_ROUND as f64) as usize / n).max(2);
    let (mut step, mut solve) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..ROUNDS {
        step = step.min(step_time(scene, rounds));
        solve = solve.min(solve_time(scene, rounds));
    }
    let per_body = 1e6 / n as f64;
    Cost { shape, n, us_per_body_step: per_body * step, us_per_body_factor_solve: per_body * solve }
}

/// Time of a Runge–Kutta substep, s; the number of substeps follows from the tension.
fn step_time(scene: &PhysicsScene, steps: usize) -> f64 {
    let mut engine = Soffio::new(scene, DT, Integrator::RungeKutta, Solver::Sparse);
    let (mut substeps, mut done) = (0, 0);
    let start = ThreadTime::now();
    while done < steps {
        black_box(engine.step());
        substeps += engine.substeps();
        done += engine.substeps() as usize;
    }
    start.elapsed().as_secs_f64() / f64::from(substeps)
}

/// Time of a factorisation and a solve at the start, s.
fn solve_time(scene: &PhysicsScene, times: usize) -> f64 {
    let bodies = scene.rigid_bodies();
    let mut system = System::new(
        &bodies,
        &vec![false; bodies.len()],
        &scene.constraints(),
        soffio_multibody::articulation::LinearSolver::Sparse,
    );
    system.evaluate(&bodies);
    let start = ThreadTime::now();
    for _ in 0..times {
        system.factor();
        for b in &mut system.b {
            *b = [0.0, -1.0, 0.0, 0.0, 0.0, 0.0];
        }
        system.solve();
        black_box(&system.a);
    }
    start.elapsed().as_secs_f64() / times as f64
}

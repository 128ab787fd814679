//! The most work that a step of motion does under a breath, a fast hand and assembly stays within a bound.

use soffio_offline::load::{LoadRun, loads};

/// Operations of a step, at most. The dearest, of the breaking chain, has 8.8 million and takes 2.4 ms of an AMD EPYC. Trains and
/// loops take longer for as many: 3.4 million of the clock while it gathers take 5 ms. Time is measured by `soffio bench --within`.
const MOST: u64 = 10_000_000;
/// Assemblies, each from parts that another seed scatters. A hundred are in `soffio bench --seeds 100` (`./check --long`).
const SEEDS: u64 = 5;
/// A hard breath, s.
const BREATH: f64 = 10.0;

pub fn no_step_does_more_work_than_the_bound(id: &str) {
    let exhibit = super::load(id);
    for load in loads(&exhibit, SEEDS, BREATH) {
        let mut run = LoadRun::new(&exhibit, load);
        let mut most = 0;
        for step in 0..run.steps() {
            run.step();
            let operations = run.simulation.snapshot().diagnostics.operations;
            most = most.max(operations);
            assert!(operations <= MOST, "{load}: {operations} operations in step {step}");
        }
        super::note!("{id}: {load}: at most {most} operations in a step");
    }
}

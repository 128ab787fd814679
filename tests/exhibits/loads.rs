//! What a step of motion may do at most, whatever a visitor does.

use soffio_offline::load::{LoadRun, loads};

/// Operations that take less than a step of 4.17 ms: 8.8 million of the dearest step take 2.4 ms of an AMD EPYC, 6 million of one with
/// joints alone 2.
const MOST: u64 = 10_000_000;
/// Assemblies, each from parts that another seed scatters. A hundred are in `soffio bench --seeds 100` (`./check --long`).
const SEEDS: u64 = 5;
/// A hard breath, s.
const BREATH: f64 = 10.0;

pub fn no_step_does_more_than_fits_into_it(id: &str) {
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

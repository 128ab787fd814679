//! What must not slow an exhibit down, and the warning where it does.

use std::path::Path;
use std::sync::Arc;

use soffio_exhibit::{Exhibit, codes};
use soffio_offline::budget::{SEEDS, check_within};
use soffio_offline::load::{HARDEST_BREATH, LoadReport, LoadRun, LoadTimes, StressLoad, loads};
use soffio_offline::scene::times::StepTimes;

fn shipped(id: &str) -> Arc<Exhibit> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("exhibits").join(id);
    Arc::new(soffio_exhibit::load(&folder).expect("a shipped exhibit"))
}

#[test]
fn loads_blow_drag_and_scatter_and_repeat_to_the_bit() {
    let exhibit = shipped("wind-chimes");
    let all = loads(&exhibit, 2, 1.0);
    assert_eq!(all, [StressLoad::Breath(1.0), StressLoad::Drag, StressLoad::Assembly(0), StressLoad::Assembly(1)]);
    let home: Vec<_> = exhibit.bodies.iter().map(|body| body.pose.position).collect();
    let mut ends = Vec::new();
    for load in all {
        let mut runs = [LoadRun::new(&exhibit, load), LoadRun::new(&exhibit, load)];
        runs.iter_mut().for_each(LoadRun::step);
        let [run, again] = &mut runs;
        let snapshot = run.simulation.snapshot();
        let away =
            snapshot.poses.iter().zip(&home).map(|(pose, home)| pose.position.distance(*home)).fold(0.0, f64::max);
        match load {
            StressLoad::Breath(_) => assert_eq!(snapshot.breath.speed, HARDEST_BREATH),
            StressLoad::Drag => assert_eq!(snapshot.diagnostics.grabs, 1),
            StressLoad::Assembly(_) => assert!(away > 0.1 && run.simulation.assembly_distance().is_some(), "{away}"),
        }
        for _ in 0..120 {
            run.step();
            again.step();
        }
        assert_eq!(run.simulation.state_hash(), again.simulation.state_hash(), "{load}");
        ends.push(run.simulation.state_hash());
    }
    ends.dedup();
    assert_eq!(ends.len(), 4, "each load is a run of its own");
}

#[test]
fn a_pointer_grab_takes_every_body_of_a_small_exhibit_in_turn() {
    let exhibit = shipped("plates");
    let mut run = LoadRun::new(&exhibit, StressLoad::Drag);
    let mut takes = 0;
    let mut held = false;
    for _ in 0..run.steps() {
        run.step();
        let holds = run.simulation.snapshot().diagnostics.grabs > 0;
        takes += usize::from(holds && !held);
        held = holds;
    }
    assert_eq!(takes, exhibit.bodies.len());
}

#[test]
fn the_worst_step_of_several_loads_is_reported_with_its_load() {
    let times = |load, us: &[f64]| LoadTimes { load, times: us.iter().copied().collect::<StepTimes>() };
    let all = [
        times(StressLoad::Breath(1.0), &[1.0, 2.0]),
        times(StressLoad::Assembly(7), &[3.0, 1.0, 9.0, 1.0]),
        times(StressLoad::Drag, &[4.0]),
    ];
    let report = LoadReport::of(&all).expect("loads");
    assert_eq!((report.worst_load.as_str(), report.times.worst_step), ("assembly of seed 7", 2));
    assert_eq!((report.times.p50_us, report.times.p100_us, report.worst_at_s), (2.0, 9.0, 2.0 / 240.0));
    assert!(LoadReport::of(&[]).is_none());
}

#[test]
fn a_late_step_is_reported_with_its_load_and_cause() {
    let exhibit = shipped("wind-chimes");
    // No step is as short as that: each kind of load ends with its first one.
    let found = check_within(&exhibit, 0.0, f64::INFINITY);
    assert_eq!((found.tried, found.of, found.late.len()), (3, 3, 3), "{found:?}");
    for (late, words) in found.late.iter().zip(["hard breath", "fast drag", "assembly of seed 0"]) {
        assert_eq!(late.step, 0);
        assert!(late.seconds > 0.0 && !late.cause.is_empty(), "{late:?}");
        let warning = late.warning(&exhibit.id);
        assert_eq!(warning.code, codes::LATE.name);
        assert!(!warning.is_error());
        for word in ["wind-chimes", "4.17 ms", words, &late.cause] {
            assert!(warning.message.contains(word), "no {word} in: {}", warning.message);
        }
        assert!(warning.help.is_some_and(|help| help.contains("soffio bench wind-chimes")));
    }
}

#[test]
fn a_check_of_steps_ends_in_its_time() {
    let exhibit = shipped("pendulum");
    let none = check_within(&exhibit, f64::INFINITY, 0.0);
    assert_eq!((none.tried, none.late.len()), (0, 0));
    // No run is as short as that: the first load ends it.
    let one = check_within(&exhibit, f64::INFINITY, 1e-9);
    assert_eq!((one.tried, one.of as u64, one.late.len()), (1, SEEDS + 2, 0), "{one:?}");
}

#[test]
fn closed_loops_of_a_mechanism_are_a_cause() {
    let exhibit = shipped("breath-clock");
    let found = check_within(&exhibit, 0.0, f64::INFINITY);
    assert!(found.late.iter().all(|late| late.cause.contains("closed loops: 1 joint")), "{found:?}");
}

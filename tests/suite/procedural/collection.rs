//! The whole collection in every kind of motion: at rest, in a breath and dragged by a hand.

use std::sync::Arc;

use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_simulation::{Command, MotionMode, PointerGrab, STEPS_PER_SECOND, Settings, Simulation, StepInput};
use soffio_soundscape::parallel::parallel;

const ASPECT: f64 = 16.0 / 9.0;
/// A breath that moves everything, m/s at the lips.
const BREATH: f64 = 12.0;
/// Time of the breath or of the hand, s.
const ACTS_S: f64 = 2.0;
/// Time after it, s.
const AFTER_S: f64 = 5.0;
/// Largest joint error beyond that of dynamics, whose own is that of joints that open by design, m.
const JOINT: f64 = 1e-3;
/// Speed below which a figure is at rest, m/s: a tenth of a hand that moves slowly.
const REST: f64 = 0.05;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Act {
    Rest,
    Breath,
    Drag,
}

/// What a run shows.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    joint_error: f64,
    impacts: u64,
    faults: u64,
    /// Last time at which something moved faster than [`REST`], s.
    moved_until: f64,
}

fn run(exhibit: &Arc<Exhibit>, mode: MotionMode, act: Act) -> Seen {
    let mut simulation = Simulation::new(exhibit.clone(), Settings::default());
    let view = simulation.view(ASPECT);
    let (right, up, _) = view.axes();
    let bodies = simulation.bodies();
    let visible = |body: &usize| view.project(bodies[*body].position, ASPECT).is_some();
    let free: Vec<usize> = (0..bodies.len()).filter(visible).collect();
    let held = free[free.len() / 2];
    let start = bodies[held].position;
    let reach = 0.12 * view.height_at((start - view.eye).length());
    let mut seen = Seen::default();
    for step in 0..((ACTS_S + AFTER_S) * STEPS_PER_SECOND as f64) as u64 {
        let t = step as f64 / STEPS_PER_SECOND as f64;
        let acts = t < ACTS_S;
        let command = match (act, step) {
            (Act::Breath, 0) => Some(Command::Blow(Some(BREATH))),
            (Act::Breath, _) if !acts => Some(Command::Blow(None)),
            _ => None,
        };
        let round = reach * (t / 0.5).min(1.0);
        let place = start + round * ((3.0 * t).sin() * right + 0.5 * (1.0 - (3.0 * t).cos()) * up);
        let at = view.project(place, ASPECT).filter(|_| act == Act::Drag && acts);
        let grab = at.map(|at| PointerGrab { id: 1, at, body: Some(held) });
        simulation.step(&StepInput {
            mode: Some(mode),
            commands: command.as_slice(),
            pointer_grabs: grab.as_slice(),
            ..StepInput::default()
        });
        seen.joint_error = seen.joint_error.max(simulation.joint_error());
        let fastest = simulation.bodies().iter().map(|body| body.velocity.length()).fold(0.0, f64::max);
        if fastest > REST {
            seen.moved_until = t;
        }
    }
    let diagnostics = simulation.snapshot().diagnostics;
    (seen.impacts, seen.faults) = (diagnostics.impacts, diagnostics.faults);
    seen
}

#[test]
fn every_exhibit_moves_by_every_solver_or_says_why_not() {
    /// Hits beyond twice those of dynamics: chaos makes and unmakes a few.
    const FEW: u64 = 12;
    /// A figure that is let go rests at most so much later than by dynamics, s. After a breath pivot friction would calm it, which only
    /// dynamics has.
    const LATER: f64 = 1.0;
    let names = exhibit::ids();
    let problems: Vec<Vec<String>> = parallel(names, |name| {
        let folder = exhibit::resolve(&name).unwrap_or_else(|report| panic!("{report}"));
        let exhibit = Arc::new(exhibit::load(&folder).unwrap_or_else(|report| panic!("{}", report.to_text())));
        if exhibit.refusal().is_some() {
            return Vec::new();
        }
        let mut problems = Vec::new();
        for act in [Act::Rest, Act::Breath, Act::Drag] {
            let dynamics = run(&exhibit, MotionMode::Dynamic, act);
            for mode in [MotionMode::Procedural, MotionMode::PositionBased] {
                let seen = run(&exhibit, mode, act);
                println!("{name} {mode:?} {act:?}: {seen:?}, dynamics {dynamics:?}");
                let opens = exhibit.constraints.iter().any(|c| c.schedule != Default::default());
                let bad = [
                    (seen.faults > 0, "faults"),
                    (!opens && seen.joint_error > JOINT, "joint error"),
                    (seen.impacts > 2 * dynamics.impacts + FEW, "impacts"),
                    (act == Act::Drag && seen.moved_until > dynamics.moved_until.max(ACTS_S) + LATER, "rest"),
                ];
                let found = bad.into_iter().filter(|(is, _)| *is);
                problems.extend(
                    found.map(|(_, what)| format!("{name} {mode:?} {act:?}, {what}: {seen:?}, not {dynamics:?}")),
                );
            }
        }
        problems
    });
    let problems = problems.concat();
    assert!(problems.is_empty(), "{}", problems.join("\n"));
}

#[test]
fn gears_and_breaking_are_refused_with_the_reason() {
    let refused: Vec<(String, &str)> = exhibit::ids()
        .into_iter()
        .filter_map(|name| {
            let folder = exhibit::resolve(&name).unwrap_or_else(|report| panic!("{report}"));
            let exhibit = exhibit::load(&folder).unwrap_or_else(|report| panic!("{}", report.to_text()));
            Some((name, exhibit.refusal()?))
        })
        .collect();
    let names: Vec<&str> = refused.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["breaking-chain", "breath-clock", "cart", "gear-train", "pennant", "terry-clock"]);
    assert!(
        refused[0].1.contains("breaks under load")
            && refused[3].1.contains("gears")
            && refused[2].1.contains("tyres")
            && refused[4].1.contains("seams"),
        "{refused:?}"
    );
    // The simulation moves them by dynamics, whatever is asked.
    let exhibit = Arc::new(exhibit::load(&exhibit::resolve("gear-train").expect("a folder")).expect("an exhibit"));
    let state = |mode: MotionMode| {
        let mut simulation = Simulation::new(exhibit.clone(), Settings::default());
        (0..240).for_each(|_| simulation.step(&StepInput { mode: Some(mode), ..StepInput::default() }));
        (simulation.state_hash(), simulation.snapshot().diagnostics.mode)
    };
    assert_eq!(state(MotionMode::Procedural), state(MotionMode::Dynamic));
}

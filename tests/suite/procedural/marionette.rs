//! The marionette in hands: its hands are dragged while its feet are held, its joints stop where they should, and a
//! breath makes its limbs meet.

use std::sync::Arc;

use soffio::exhibit::{self, Exhibit};
use soffio::math::DVec3;
use soffio::procedural::Grip;
use soffio::simulation::{Command, EventKind, MotionMode, Settings, Simulation, StepInput};
use soffio::sound::SoundCommand;

fn load() -> Arc<Exhibit> {
    let folder = exhibit::resolve("marionette").unwrap_or_else(|report| panic!("{report}"));
    Arc::new(exhibit::load(&folder).unwrap_or_else(|report| panic!("{}", report.render(false))))
}

fn index(exhibit: &Exhibit, name: &str) -> usize {
    exhibit.bodies.iter().position(|body| body.name == name).unwrap_or_else(|| panic!("no {name}"))
}

/// Where a body's origin is to be, by this way from where it is.
fn grip(simulation: &Simulation, name: &str, point: DVec3) -> Grip {
    let body = index(simulation.exhibit(), name);
    Grip { body, point, place: simulation.bodies()[body].pose().point(point) }
}

#[test]
fn its_hands_are_dragged_while_its_feet_are_held() {
    /// Feet and hands are where they were asked to be, m: a straight leg gives way last.
    const MET: f64 = 1e-3;
    let mut simulation = Simulation::new(load(), Settings { wind: false, ..Settings::default() });
    let sole = DVec3::new(0.0, -0.062, 0.0);
    let feet = ["ShinLeft", "ShinRight"].map(|shin| grip(&simulation, shin, sole));
    let hands = [("ForearmLeft", -0.034), ("ForearmRight", 0.034)]
        .map(|(arm, x)| grip(&simulation, arm, DVec3::new(x, 0.018, 0.0)));
    let mut worst = 0.0_f64;
    for step in 0..1200 {
        let t = f64::from(step) / 240.0;
        let grow = (t / 2.0).min(1.0);
        let mut grips = [feet[0], feet[1], hands[0], hands[1]];
        for (side, grip) in [-1.0, 1.0].into_iter().zip(&mut grips[2..]) {
            let angle = 2.0 * t + side;
            grip.place += grow * 0.01 * DVec3::new(0.3 * side * angle.sin(), angle.sin() - 0.5, 0.6 * angle.cos());
        }
        simulation.step(&StepInput { mode: MotionMode::PositionBased, grips: &grips, ..StepInput::default() });
        let missed = grips.iter().map(|grip| grip.missed(simulation.bodies())).fold(0.0, f64::max);
        worst = worst.max(missed);
        assert!(simulation.joint_error() < 1e-6, "step {step}: {} m", simulation.joint_error());
        assert_eq!(simulation.snapshot().diagnostics.faults, 0, "step {step}");
    }
    println!("hands and feet missed by {worst} m at most");
    assert!(worst < MET, "{worst} m");
}

#[test]
fn a_breath_makes_it_swing_and_its_limbs_knock() {
    for mode in [MotionMode::Dynamic, MotionMode::PositionBased] {
        let mut simulation = Simulation::new(load(), Settings::default());
        let (mut hits, mut strikes, mut farthest) = (0, 0, 0.0_f64);
        let start: Vec<DVec3> = simulation.bodies().iter().map(|body| body.position).collect();
        for step in 0..2400 {
            let blow = match step {
                240 | 960 => Some(Command::Blow(Some(14.0))),
                600 | 1320 => Some(Command::Blow(None)),
                _ => None,
            };
            let aim = Some([0.5, 0.62]);
            simulation.step(&StepInput { mode, pointer: aim, commands: blow.as_slice(), ..StepInput::default() });
            hits += simulation.events().iter().filter(|event| event.kind == EventKind::Impact).count();
            strikes += simulation.sounds().iter().filter(|sound| matches!(sound, SoundCommand::Strike(_))).count();
            let now = simulation.bodies().iter().zip(&start);
            farthest = farthest.max(now.map(|(body, start)| body.position.distance(*start)).fold(0.0, f64::max));
        }
        println!("{mode:?}: {hits} hits, {strikes} strikes, farthest {farthest} m");
        assert!(farthest > 0.02, "{mode:?}: {farthest} m");
        assert!(hits > 0 && strikes > 0, "{mode:?}: {hits} hits, {strikes} strikes");
        assert!(simulation.joint_error() < 1e-6);
    }
}

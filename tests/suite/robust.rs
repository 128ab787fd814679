//! Scenes that are wrong, and numbers that are: nothing panics, no pose is lost, and an event says so.

use std::sync::Arc;

use soffio_exhibit::{self as exhibit, Exhibit, codes};
use soffio_geometry::bodies::{MassProperties, RigidBody};
use soffio_math::Interpolation;
use soffio_math::{DMat3, DQuat, DVec3, Pose};
use soffio_multibody::articulation::{Anchor, Breaking, Constraint, ConstraintKind, Schedule, Trigger, Window};
use soffio_multibody::dynamics::forces::Damping;
use soffio_multibody::dynamics::{self, Articulation, Dynamics, Integrator, KeyframeMotion, KinematicBody, Solver};
use soffio_offline::scene::make;
use soffio_offline::scene::run::{self, Limits, observe};
use soffio_simulation::{Command, EventKind, STEPS_PER_SECOND, Settings, Simulation, StepInput};

use super::exhibit::glb::{Folder, Scene, cuboid};

const DT: f64 = 1.0 / STEPS_PER_SECOND as f64;
const G: f64 = 9.81;
/// What the product promises of joints, m.
const JOINT_ERROR: f64 = 1e-9;

fn body(mass: f64, position: DVec3) -> RigidBody {
    let properties =
        MassProperties { mass, center: DVec3::ZERO, inertia: DMat3::from_diagonal(DVec3::splat(1e-3 * mass)) };
    RigidBody::at_rest(properties, Pose { rotation: DQuat::IDENTITY, position })
}

fn joint(name: &str, a: (Option<usize>, DVec3), b: (Option<usize>, DVec3)) -> Constraint {
    let anchor = |(body, point)| Anchor { body, point };
    Constraint::new(name, ConstraintKind::PointToPoint { a: anchor(a), b: anchor(b) })
}

fn mechanism(bodies: Vec<RigidBody>, constraints: &[Constraint], drives: &[KinematicBody]) -> Dynamics {
    let damping = vec![Damping::default(); bodies.len()];
    let mechanism = Articulation {
        bodies,
        damping,
        constraints,
        limits: &[],
        springs: &[],
        kinematic_bodies: drives,
        colliders: &[],
        pairs: Vec::new(),
    };
    let settings = dynamics::Settings {
        gravity: DVec3::new(0.0, -G, 0.0),
        friction: true,
        stabilization_time: 0.04,
        integrator: Integrator::Auto,
        solver: Solver::Sparse,
    };
    Dynamics::new(mechanism, settings)
}

/// Runs for some seconds; every state is finite. Returns the steps in which the figure was put back.
fn survive(dynamics: &mut Dynamics, seconds: f64) -> usize {
    let still = vec![[0.0; 6]; dynamics.bodies.len()];
    let mut impacts = Vec::new();
    let mut faults = 0;
    for step in 0..(seconds / DT).round() as usize {
        faults += usize::from(dynamics.step(DT, &still, &mut impacts).is_some());
        assert!(dynamics.bodies.iter().all(RigidBody::is_finite), "bad numbers after step {step}");
    }
    faults
}

/// A box that nothing holds but what `text` says.
fn small(text: &str) -> Result<Exhibit, exhibit::Report> {
    let mut scene = Scene::default();
    scene.node("Box", [0.0; 3], Some(&cuboid([0.1; 3])), &[]);
    exhibit::load(Folder::exhibit(&scene.glb(), text).path())
}

#[test]
fn masses_that_are_none_are_refused_with_their_line() {
    for mass in ["0", "-1", "-0.0", "inf", "-inf", "nan", "1e-400", "\"0 kg\"", "\"-85 g\""] {
        let text = format!("[[body]]\nnode = \"Box\"\nmass = {mass}\n");
        let report = small(&text).expect_err(mass);
        assert!(report.has(codes::RANGE) || report.has(codes::WRONG_TYPE), "{mass}: {report}");
        assert!(report.to_string().contains("mass"), "{mass}: {report}");
    }
}

#[test]
fn two_nails_that_contradict_each_other_hold_the_body_between_them() {
    // Its points are 0.2 m apart, their nails 0.3 m.
    let nail = |side: f64| joint("nail", (Some(0), DVec3::X * 0.1 * side), (None, DVec3::X * 0.15 * side));
    let nails = [nail(-1.0), nail(1.0)];
    let mut dynamics = mechanism(vec![body(0.5, DVec3::ZERO)], &nails, &[]);
    assert_eq!(survive(&mut dynamics, 10.0), 0);
    let at = dynamics.bodies[0].position;
    assert!(at.length() < 0.06, "it went to {at}");
}

#[test]
fn a_body_that_two_grabs_pull_apart_keeps_finite_numbers() {
    let hand = |body: usize, side: f64| {
        let key = |t: f64, x: f64| (t, Pose { rotation: DQuat::IDENTITY, position: DVec3::X * x * side });
        let motion = KeyframeMotion {
            keys: vec![key(0.0, 0.1), key(4.0, 2.0)],
            interpolation: Interpolation::Linear,
            repeat: false,
        };
        KinematicBody { body, motion }
    };
    let held = |point: f64| {
        [
            joint("left", (Some(0), DVec3::X * -point), (Some(1), DVec3::ZERO)),
            joint("right", (Some(0), DVec3::X * point), (Some(2), DVec3::ZERO)),
        ]
    };
    for point in [0.1, 0.0] {
        let bodies = vec![body(0.5, DVec3::ZERO), body(1.0, DVec3::X * -0.1), body(1.0, DVec3::X * 0.1)];
        let mut dynamics = mechanism(bodies, &held(point), &[hand(1, -1.0), hand(2, 1.0)]);
        let faults = survive(&mut dynamics, 8.0);
        let at = dynamics.bodies[0].position;
        println!("held at ±{point} m: it ends at {at}, {faults} faults");
        assert!(at.length() < 4.0, "it flew to {at}");
    }
}

#[test]
fn a_million_times_the_mass_hangs_on_a_chain() {
    /// Of the energy of the fall, in ten seconds of 1/240 s.
    const DRIFT: f64 = 1e-3;
    for seed in [3, 4] {
        let scene = make::mass_ratio(10, 1e6, seed);
        let mut engine = run::Soffio::new(&scene, DT, Integrator::Auto, Solver::Sparse);
        let watched = observe(&scene, &mut engine, DT, Limits { seconds: 10.0, budget: f64::INFINITY });
        let report = watched.report;
        println!(
            "seed {seed}: energy drifts by {:.1e}, joints by {:.1e} m, {:.1} substeps",
            report.max_energy_drift_rel, report.max_joint_err_m, watched.substeps
        );
        assert_eq!(report.diverged_at_s, None, "seed {seed}");
        assert!(report.max_energy_drift_rel < DRIFT, "seed {seed}: energy drifts by {}", report.max_energy_drift_rel);
        assert!(report.max_joint_err_m < JOINT_ERROR, "seed {seed}: joints by {} m", report.max_joint_err_m);
    }
}

#[test]
fn a_fast_body_is_no_fault() {
    // Half the speed of a rifle's bullet, and the spin of a dentist's drill.
    let mut bullet = body(0.01, DVec3::ZERO);
    bullet.velocity = DVec3::new(400.0, 0.0, 0.0);
    bullet.angular_velocity = DVec3::new(30_000.0, 0.0, 0.0);
    let mut dynamics = mechanism(vec![bullet], &[], &[]);
    assert_eq!(survive(&mut dynamics, 1.0), 0);
    assert!((dynamics.bodies[0].position.x - 400.0).abs() < 1e-6, "{}", dynamics.bodies[0].position);
}

#[test]
fn windows_as_long_as_a_step_and_far_shorter_are_run_through() {
    for (period, most) in [(2.0 * DT, 8), (1.5 * DT, 8), (1e-3, 64), (1e-9, 2_000)] {
        let mut nail = joint("nail", (Some(0), DVec3::X * 0.1), (None, DVec3::X * 0.1));
        nail.schedule = Schedule {
            windows: vec![Window { start: 0.0, end: 0.5 * period }],
            period: Some(period),
            ..Schedule::default()
        };
        let nails = [nail];
        let mut dynamics = mechanism(vec![body(0.5, DVec3::ZERO)], &nails, &[]);
        let mut substeps = 0;
        for _ in 0..20 {
            assert_eq!(survive(&mut dynamics, DT), 0);
            substeps = substeps.max(dynamics.substeps());
        }
        assert!(substeps <= most, "a period of {period} s takes {substeps} substeps");
        assert!(dynamics.bodies[0].position.y < 0.0);
    }
}

#[test]
fn everything_breaks_at_once_and_falls_freely() {
    let n = 30;
    let mut bodies = Vec::new();
    let mut joints = Vec::new();
    for i in 0..n {
        bodies.push(body(0.1, DVec3::new(0.0, -0.1 * i as f64 - 0.05, 0.0)));
        let above = if i == 0 { (None, DVec3::ZERO) } else { (Some(i - 1), DVec3::Y * -0.05) };
        let mut link = joint(&format!("link-{i}"), (Some(i), DVec3::Y * 0.05), above);
        // Less than the last link's own weight.
        link.breaking = Some(Breaking { force: 0.5, ..Breaking::default() });
        joints.push(link);
    }
    let mut dynamics = mechanism(bodies, &joints, &[]);
    let start: Vec<f64> = dynamics.bodies.iter().map(|body| body.position.y).collect();
    survive(&mut dynamics, DT);
    let broken: Vec<usize> = dynamics.breaks().iter().map(|b| b.index).collect();
    assert_eq!(broken, (0..n).collect::<Vec<_>>());
    let (speed, place) = (dynamics.bodies[0].velocity.y, start[0] - dynamics.bodies[0].position.y);
    assert_eq!(survive(&mut dynamics, 1.0), 0);
    assert!(dynamics.breaks().is_empty());
    for (body, start) in dynamics.bodies.iter().zip(start) {
        assert!((body.velocity.y - speed + G).abs() < 1e-9, "{} m/s", body.velocity.y);
        assert!((start - body.position.y - place - (0.5 * G - speed)).abs() < 1e-9);
    }
}

#[test]
fn a_joint_that_closes_again_is_drawn_together_before_it_can_break() {
    // It bears the weight, not the pull that gathers a metre in a few hundredths of a second.
    let mut link = joint("link", (Some(0), DVec3::Y * 0.05), (None, DVec3::ZERO));
    link.breaking = Some(Breaking { force: 1.5 * 0.1 * G, restore: 0.45, ..Breaking::default() });
    let joints = [link];
    let mut dynamics = mechanism(vec![body(0.1, DVec3::Y * -0.05)], &joints, &[]);
    assert_eq!(survive(&mut dynamics, 0.1), 0);
    // A sharp tug.
    let pull = [[0.0, -2.0, 0.0, 0.0, 0.0, 0.0]];
    dynamics.step(DT, &pull, &mut Vec::new());
    assert_eq!(dynamics.breaks().len(), 1);
    let mut breaks = 0;
    for _ in 0..(3.0 / DT) as usize {
        survive(&mut dynamics, DT);
        breaks += dynamics.breaks().len();
    }
    assert_eq!(breaks, 0, "the pull of the stabiliser broke it");
    assert!(dynamics.joint_error() < JOINT_ERROR, "{} m", dynamics.joint_error());
    dynamics.step(DT, &pull, &mut Vec::new());
    assert_eq!(dynamics.breaks().len(), 1, "closed, it can break again");
}

#[test]
fn a_breath_sets_off_what_waits_for_it_and_an_event_says_when() {
    let text = "[[body]]\nnode = \"Box\"\nmaterial = \"oak\"\n[[constraint.nail]]\nname = \"catch\"\nbody = \"Box\"\n\
                to = [0, 0, 0]\ntrigger = { on = \"breath\", least = \"2 m/s\" }\nwindow = { start = 0, end = 0.5 }\n";
    let exhibit = small(text).unwrap_or_else(|report| panic!("{}", report.to_text()));
    assert_eq!(exhibit.constraints[0].schedule.trigger, Some(Trigger::Breath { least_speed: 2.0 }));
    let exhibit = Arc::new(exhibit);
    let mut simulation = Simulation::new(exhibit.clone(), Settings { wind: false, ..Settings::default() });
    let mut fired = Vec::new();
    for step in 0..480u64 {
        // Too weak, strong enough and going on, nothing, again.
        let speed = match step {
            24..48 => 1.9,
            48..96 => 4.0,
            240.. => 3.0,
            _ => 0.0,
        };
        let commands = [Command::Blow(Some(speed))];
        simulation.step(&StepInput { commands: &commands, ..StepInput::default() });
        fired.extend(simulation.events().iter().filter(|event| event.kind == EventKind::Trigger).cloned());
        if step == 47 {
            let speed = simulation.bodies()[0].velocity.y;
            assert!((speed + G * 48.0 * DT).abs() < 1e-9, "it falls until it is caught: {speed} m/s");
        }
    }
    let samples: Vec<u64> = fired.iter().map(|event| event.sample).collect();
    assert_eq!(samples, [48 * 200, 240 * 200]);
    for event in fired {
        assert_eq!(event.bodies, [Some(0), None]);
        assert!((event.t - event.sample as f64 / 48_000.0).abs() < 1e-12, "{} s", event.t);
        assert_eq!(event.source.expect("a part").name(&exhibit), "catch");
    }
    assert!(simulation.bodies()[0].velocity.y < -1.0, "let go after half a second, it falls");
}

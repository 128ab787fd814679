//! Articulated scenes: the reader and its refusals, the measures against formulas, figures nobody tuned for.

use std::path::Path;

use soffio_math::noise::Random;
use soffio_math::{DQuat, DVec3, PI, cos, rotation, sin};
use soffio_multibody::articulation::System;
use soffio_multibody::collision::CONTACT_MARGIN;
use soffio_multibody::dynamics::{Integrator, Solver};
use soffio_offline::scene::linear;
use soffio_offline::scene::make;
use soffio_offline::scene::measure::{self, Coordinate};
use soffio_offline::scene::run::{self, Best};
use soffio_offline::scene::times::StepTimes;
use soffio_offline::scene::{
    BodyState, Engine, JointKind, Limits, OLD_FORMAT, Observer, PhysicsScene, SceneJoint, Soffio,
};

const DT: f64 = 1.0 / 240.0;
/// A few operations of f64 on numbers of about one.
const ROUNDING: f64 = 1e-14;
/// What the project promises of joints over a run, m.
const JOINT_ERROR: f64 = 1e-9;
/// Seeds of this run's random figures.
const SEEDS: std::ops::Range<u64> = 70..73;

fn shipped(name: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/cases/scenes").join(name);
    std::fs::read_to_string(path).expect("shipped")
}

fn pendulum() -> PhysicsScene {
    PhysicsScene::parse(&shipped("pendulum.json"), "pendulum.json").expect("sound")
}

fn joint(kind: JointKind, a: i64, b: usize, anchors: [[f64; 3]; 2], axis: Option<[DVec3; 2]>) -> SceneJoint {
    let [axis_a, axis_b] = axis.map_or([None; 2], |axis| axis.map(|axis| Some(axis.to_array())));
    SceneJoint { kind, a, b, anchor_a: anchors[0], anchor_b: anchors[1], axis_a, axis_b, limits: None }
}

#[test]
fn a_scene_is_written_and_read_back() {
    for scene in [pendulum(), make::chain(5, 1), make::mobile(6, 2), make::mass_ratio(3, 50.0, 3)] {
        assert_eq!(PhysicsScene::parse(&scene.to_json(), "again").expect("sound"), scene);
    }
}

#[test]
fn a_bad_scene_is_reported_with_place_and_reason() {
    let good = shipped("pendulum.json");
    for (find, replace, words) in [
        ("\"gravity\":", "\"gravity\"", &["s.json:5:", "expected `:`"][..]),
        ("\"duration\": 6.0,", "", &["s.json:", "missing field `duration`"]),
        ("\"couplings\"", "\"coupling\"", &["s.json:", "unknown field `coupling`", "`couplings`"]),
        ("\"hinge\"", "\"door\"", &["s.json:", "unknown variant `door`", "`hinge`"]),
        ("scene/1", "scene/2", &["s.json: format:", "soffio-scene/1", "isaac-bench-scene/1"]),
        (
            "\"couplings\": []",
            "\"static\": [{ \"shape\": { \"type\": \"sphere\", \"radius\": 1 } }]",
            &["s.json: static:", "soffio-scene/1"],
        ),
        (
            "\"couplings\": []",
            "\"surface\": { \"friction\": 0, \"restitution\": 0 }",
            &["s.json: surface:", "soffio-scene/1"],
        ),
        ("\"axis_b\":", "\"limits\": [0, 1], \"axis_b\":", &["s.json: joints[0].limits:", "soffio-scene/1"]),
        ("\"mass\": 0.5", "\"mass\": 0", &["s.json: bodies[0].mass:", "above zero"]),
        ("\"mass\": 0.5", "\"mass\": -0.5", &["s.json: bodies[0].mass: -0.5"]),
        ("\"mass\": 0.5", "\"mass\": 1e999", &["s.json:", "number out of range"]),
        ("\"mass\": 0.5", "\"mass\": NaN", &["s.json:12:"]),
        ("1.0e-5", "0.0", &["s.json: bodies[0].inertia:"]),
        ("0.9996573249755573", "0.99", &["s.json: bodies[0].quat:", "length 1"]),
        ("0.004166666666666667", "-0.1", &["s.json: dts[0]:", "above zero"]),
        ("\"a\": -1", "\"a\": -2", &["s.json: joints[0].a:", "no body -2"]),
        ("\"a\": -1", "\"a\": 7", &["s.json: joints[0].a:", "no body 7"]),
        ("\"a\": -1", "\"a\": 0", &["s.json: joints[0].a:", "parents come first"]),
        ("\"b\": 0", "\"b\": 1", &["s.json: joints[0].b:", "no body 1"]),
        ("\"axis_b\": [0, 0, 1]", "\"axis_b\": [0, 0, 2]", &["s.json: joints[0].axis_b:", "length 1"]),
        ("\"axis_b\": [0, 0, 1]", "\"axis_b\": [0, 1, 0]", &["s.json: joints[0].axis_b:", "begin closed"]),
        (", \"axis_b\": [0, 0, 1]", "", &["s.json: joints[0].axis_b:", "needs its axis"]),
        ("\"anchor_b\": [0, 0.2, 0]", "\"anchor_b\": [0, 0.3, 0]", &["s.json: joints[0].anchor_b:", "1.000e-1 m"]),
        ("\"couplings\": []", "\"couplings\": [{\"terms\": [[0, 1]]}]", &["s.json: couplings[0].terms:", "two joints"]),
        (
            "\"couplings\": []",
            "\"couplings\": [{\"terms\": [[0, 1], [3, 1]]}]",
            &["s.json: couplings[0].terms[1]:", "no joint 3"],
        ),
    ] {
        assert!(good.contains(find), "the scene has no {find}");
        let error = PhysicsScene::parse(&good.replacen(find, replace, 1), "s.json").expect_err(replace).to_string();
        for word in words {
            assert!(error.contains(word), "{find} → {replace}: no \"{word}\" in: {error}");
        }
    }
    let mut scene = make::chain(3, 1);
    scene.format = OLD_FORMAT.into();
    scene.joints.swap(1, 2);
    let error = PhysicsScene::parse(&scene.to_json(), "s.json").expect_err("out of order").to_string();
    assert!(error.contains("joints[1].b: 2 is out of order"), "{error}");
}

/// A ball over a floor, and a gate between two posts that is held twice: on a hinge and by a ball joint.
const GATE: &str = r#"{
  "format": "soffio-scene/1", "name": "gate", "gravity": [0, -9.81, 0], "dts": [0.004], "duration": 2.0, "energy_scale": 1.0,
  "surface": { "friction": 0.5, "restitution": 0.0 },
  "static": [{ "shape": { "type": "plane", "normal": [0, 1, 0] }, "pos": [0, -1, 0] }],
  "bodies": [
    { "name": "gate", "mass": 1.0, "inertia": [0.1, 0.1, 0.1], "shape": { "type": "box", "half": [0.4, 0.2, 0.01] },
      "pos": [0.5, 0, 0], "quat": [0, 0, 0, 1], "linvel": [0, 0, -0.25], "angvel": [0, 0.5, 0] },
    { "name": "ball", "mass": 1.0, "inertia": [0.004, 0.004, 0.004], "shape": { "type": "sphere", "radius": 0.1 },
      "pos": [3, -0.8, 0], "quat": [0, 0, 0, 1], "linvel": [0, 0, 0], "angvel": [0, 0, 0] }
  ],
  "joints": [
    { "type": "hinge", "a": -1, "b": 0, "anchor_a": [0, 0.2, 0], "anchor_b": [-0.5, 0.2, 0], "axis_a": [0, 1, 0], "axis_b": [0, 1, 0], "limits": [-0.1, 0.2] },
    { "type": "spherical", "a": -1, "b": 0, "anchor_a": [0, -0.2, 0], "anchor_b": [-0.5, -0.2, 0] }
  ]
}"#;

#[test]
fn a_bad_scene_of_contacts_and_loops_is_reported_with_place_and_reason() {
    PhysicsScene::parse(GATE, "gate.json").expect("valid");
    for (find, replace, words) in [
        ("\"limits\": [-0.1, 0.2]", "\"limits\": [0.1, 0.2]", &["joints[0].limits:", "enclose the start"][..]),
        ("\"limits\": [-0.1, 0.2]", "\"limits\": [0.2, -0.1]", &["joints[0].limits:", "enclose the start"]),
        (
            "\"type\": \"spherical\"",
            "\"limits\": [-1, 1], \"type\": \"spherical\"",
            &["joints[1].limits:", "no coordinate"],
        ),
        ("\"a\": -1", "\"a\": 0", &["joints[0].a:", "to itself"]),
        ("\"radius\": 0.1", "\"radius\": 0", &["bodies[1].shape.radius:", "above zero"]),
        ("\"half\": [0.4, 0.2, 0.01]", "\"half\": [0.4, -0.2, 0.01]", &["bodies[0].shape.half[1]:", "above zero"]),
        ("\"half\": [0.4,", "\"rounding\": 0.02, \"half\": [0.4,", &["bodies[0].shape.rounding:", "within 0 and 0.01"]),
        ("\"half\": [0.4, 0.2, 0.01]", "\"size\": 1", &["bodies[0].shape:", "unknown field `size`"]),
        ("\"type\": \"sphere\"", "\"type\": \"cone\"", &["bodies[1].shape:", "unknown variant `cone`", "`sphere`"]),
        (
            "{ \"type\": \"sphere\", \"radius\": 0.1 }",
            "{ \"type\": \"plane\", \"normal\": [0, 1, 0] }",
            &["bodies[1].shape:", "\"static\""],
        ),
        ("\"normal\": [0, 1, 0]", "\"normal\": [0, 2, 0]", &["static[0].shape.normal:", "length 1"]),
        ("\"friction\": 0.5", "\"friction\": -0.5", &["surface.friction:", "zero or more"]),
        ("\"restitution\": 0.0", "\"restitution\": 1.5", &["surface.restitution:", "within 0 and 1"]),
        (
            "\"name\": \"ball\"",
            "\"name\": \"ball\", \"surface\": { \"friction\": 1, \"restitution\": 2 }",
            &["bodies[1].surface.restitution:"],
        ),
    ] {
        assert!(GATE.contains(find), "the scene has no {find}");
        let error = PhysicsScene::parse(&GATE.replacen(find, replace, 1), "gate.json").expect_err(replace).to_string();
        for word in words {
            assert!(error.contains(word), "{find} → {replace}: no \"{word}\" in: {error}");
        }
    }
}

#[test]
fn a_ball_lands_a_gate_stops_and_a_loop_holds() {
    /// A contact rests anywhere within the touching layer, m.
    const SINKS: f64 = 2.0 * CONTACT_MARGIN;
    let scene = PhysicsScene::parse(GATE, "gate.json").expect("valid");
    let mut gate = Coordinate::new(&scene, 0).expect("a hinge");
    let mut engine = Soffio::new(&scene, DT, Integrator::Auto, Solver::Sparse);
    let mut states = Vec::new();
    let mut opened = 0.0_f64;
    for _ in 0..480 {
        assert!(engine.step());
        engine.states(&mut states);
        opened = opened.max(gate.unwrap_angle(&states));
    }
    assert!((opened - 0.2).abs() < 1e-6, "0.5 rad/s carry the gate to its stop at 0.2 rad, not to {opened}");
    assert!(measure::joint_error(&scene, &states) < JOINT_ERROR);
    assert!((states[1].position.y + 0.9).abs() < SINKS, "the ball lies at {}", states[1].position.y);

    let limits = Limits { seconds: 2.0, budget: f64::INFINITY };
    let watched = run::observe(&scene, &mut Soffio::new(&scene, DT, Integrator::Auto, Solver::Sparse), DT, limits);
    let contacts = watched.report.contacts.expect("a scene that collides");
    assert!(contacts.max_penetration_m < SINKS && contacts.max_energy_rise_rel < 1e-9, "{contacts:?}");
    assert!((contacts.max_way_m - 0.1).abs() < SINKS, "the ball falls by 0.1 m: {contacts:?}");
    assert!(contacts.rest_drift_m.is_some_and(|drift| drift < SINKS), "{contacts:?}");
    assert_eq!(watched.asleep, 2, "both rest");
}

#[test]
fn a_penetration_and_a_rise_of_energy_are_seen() {
    let scene = PhysicsScene::parse(GATE, "gate.json").expect("valid");
    let mut states: Vec<_> = scene.bodies.iter().map(|body| body.state()).collect();
    let mut observer = Observer::new(&scene);
    // Down to 3 mm below the floor, and up again by 0.5 m.
    states[1].position.y = -0.903;
    observer.observe(DT, &states);
    states[1].position.y = -0.403;
    observer.observe(2.0 * DT, &states);
    let contacts = observer.report(&states).contacts.expect("a scene that collides");
    assert!((contacts.max_penetration_m - 3e-3).abs() < ROUNDING, "{contacts:?}");
    assert_eq!(contacts.rest_penetration_m, 0.0);
    assert!((contacts.max_energy_rise_j - 0.5 * 9.81).abs() < 100.0 * ROUNDING, "{contacts:?}");
    assert_eq!(contacts.rest_drift_m, None, "the run did not get to its last second");
}

#[test]
fn percentiles_of_step_times_are_those_of_the_least_times() {
    let mut times = StepTimes::default();
    let spin = |ms: f64| {
        let start = cpu_time::ThreadTime::now();
        while start.elapsed().as_secs_f64() < 1e-3 * ms {}
    };
    // One slow step in the first round alone, one in both.
    for step in 0..10 {
        times.time(|| spin(if step == 3 || step == 7 { 2.0 } else { 0.1 }));
    }
    times.repeat_with(|step| spin(if step == 7 { 2.0 } else { 0.1 }));
    let report = times.report();
    assert_eq!(report.worst_step, 7, "{report:?}");
    assert!(report.p100_us >= 2e3 && report.p50_us >= 100.0 && report.p50_us < 2e3, "{report:?}");
    assert!(times.us()[3] < 2e3, "what is slow once is the machine's doing: {:?}", times.us());
}

#[test]
fn energy_is_that_of_the_formula() {
    // A tilted body that moves and spins about its own second axis: m v²/2 + I₂ ω²/2 + m g h.
    let mut scene = make::chain(2, 1);
    let turn = rotation(DVec3::new(0.3, -1.1, 0.7));
    let mut states: Vec<_> = scene.bodies.iter().map(|body| body.state()).collect();
    for (body, state) in scene.bodies.iter_mut().zip(&mut states) {
        (body.mass, body.inertia) = (3.0, [0.1, 0.2, 0.4]);
        *state = BodyState {
            position: DVec3::new(5.0, 2.0, -1.0),
            rotation: turn,
            velocity: DVec3::new(2.0, -1.0, 2.0),
            angular_velocity: turn * DVec3::Y * 5.0,
        };
    }
    let one = 0.5 * 3.0 * 9.0 + 0.5 * 0.2 * 25.0 + 3.0 * 9.81 * 2.0;
    let found = measure::energy(&scene, &states);
    assert!((found - 2.0 * one).abs() < 100.0 * ROUNDING, "{found} J against {} J", 2.0 * one);
}

#[test]
fn a_gap_is_the_anchors_distance_without_a_sliders_displacement() {
    let axis = DVec3::new(0.0, 0.6, 0.8);
    let (turn, at) = (rotation(DVec3::new(0.4, 0.2, -0.9)), DVec3::new(1.0, 2.0, 3.0));
    let a = BodyState { position: at, rotation: turn, ..BodyState::WORLD };
    let b = BodyState { position: at + turn * (3.0 * axis + 4e-3 * DVec3::X), ..a };
    let spherical = joint(JointKind::Spherical, 0, 1, [[0.0; 3]; 2], None);
    let slider = joint(JointKind::Slider, 0, 1, [[0.0; 3]; 2], Some([axis; 2]));
    let expected = (9.0_f64 + 16e-6).sqrt();
    assert!((measure::gap(&spherical, &a, &b) - expected).abs() < ROUNDING);
    assert!((measure::gap(&slider, &a, &b) - 4e-3).abs() < ROUNDING);
}

/// Two bodies: one on a hinge of the world with a skew axis, one on a hinge or slider of the first, both turned.
fn two(kind: JointKind) -> (PhysicsScene, DVec3) {
    let mut scene = make::chain(2, 5);
    let axis = DVec3::new(2.0, -1.0, 2.0) / 3.0;
    let states: Vec<_> = scene.bodies.iter().map(|body| body.state()).collect();
    let inside = |state: &BodyState| state.rotation.conjugate() * axis;
    let first = [scene.joints[0].anchor_a, scene.joints[0].anchor_b];
    let second = [scene.joints[1].anchor_a, scene.joints[1].anchor_b];
    scene.joints[0] = joint(JointKind::Hinge, -1, 0, first, Some([axis, inside(&states[0])]));
    scene.joints[1] = joint(kind, 0, 1, second, Some([inside(&states[0]), inside(&states[1])]));
    for body in &mut scene.bodies {
        (body.linvel, body.angvel) = ([0.0; 3], [0.0; 3]);
    }
    (PhysicsScene::parse(&scene.to_json(), "two").expect("sound"), axis)
}

#[test]
fn a_hinge_counts_right_handed_turns_of_the_child_and_all_of_them() {
    let (scene, axis) = two(JointKind::Hinge);
    let mut states: Vec<_> = scene.bodies.iter().map(|body| body.state()).collect();
    let mut hinges = [0, 1].map(|joint| Coordinate::new(&scene, joint).expect("a hinge"));
    let step = 0.7;
    for k in 1..=40 {
        // The first turns forward about the axis, the second back at twice the rate, seen from the world.
        states[0].rotation = rotation(axis * step) * states[0].rotation;
        states[1].rotation = rotation(-2.0 * step * axis) * states[1].rotation;
        let [q0, q1] = hinges.each_mut().map(|hinge| hinge.unwrap_angle(&states));
        let turned = f64::from(k) * step;
        assert!((q0 - turned).abs() < 100.0 * ROUNDING, "{q0} against {turned}");
        assert!((q1 + 3.0 * turned).abs() < 300.0 * ROUNDING, "{q1} against {}", -3.0 * turned);
    }
    let (scene, axis) = two(JointKind::Slider);
    let mut states: Vec<_> = scene.bodies.iter().map(|body| body.state()).collect();
    let mut slider = Coordinate::new(&scene, 1).expect("a slider");
    states[1].position += 0.25 * axis;
    let way = slider.unwrap_angle(&states);
    assert!((way - 0.25).abs() < ROUNDING, "{way}");
    assert!(Coordinate::new(&make::chain(1, 1), 0).is_none(), "a spherical joint has no coordinate");
}

#[test]
fn rows_of_a_hinge_are_closed_at_the_start_and_leave_one_turn() {
    let (scene, _) = two(JointKind::Hinge);
    let bodies = scene.rigid_bodies();
    let mut system = System::new(
        &bodies,
        &vec![false; bodies.len()],
        &scene.constraints(),
        soffio_multibody::articulation::LinearSolver::Sparse,
    );
    system.evaluate(&bodies);
    assert!(system.largest_error() < ROUNDING, "{}", system.largest_error());
    for joint in system.joints() {
        assert_eq!(joint.rows, 5, "{:?}", joint.link);
    }
    // The axes stay together while it swings.
    let mut engine = Soffio::new(&scene, DT, Integrator::RungeKutta, Solver::Sparse);
    let mut states = Vec::new();
    for _ in 0..120 {
        assert!(engine.step());
    }
    engine.states(&mut states);
    for joint in &scene.joints {
        let (axis_a, axis_b) = joint.axes().expect("a hinge");
        let parent = joint.parent().map_or(DQuat::IDENTITY, |body| states[body].rotation);
        let apart = (parent * axis_a - states[joint.b].rotation * axis_b).length();
        assert!(apart < JOINT_ERROR, "{apart} rad");
    }
    assert!(measure::joint_error(&scene, &states) < JOINT_ERROR);
}

#[test]
fn periods_are_found_between_samples() {
    // θ = θ₀ cos(2π t/T) sampled exactly: lines err by (ω h)² of the small angle's share, cubics far less.
    const LINES_PPM: f64 = 1e-2;
    const CUBICS_PPM: f64 = 1e-6;
    let mut scene = pendulum();
    let (period, amplitude) = (1.2345, 0.1);
    (scene.meta.period, scene.meta.theta0) = (Some(period), Some(amplitude));
    let mut observer = Observer::new(&scene);
    let omega = 2.0 * PI / period;
    let mut states = Vec::new();
    for k in 1..=2_400 {
        let t = f64::from(k) * DT;
        let turn = rotation(DVec3::Z * (amplitude * cos(omega * t)));
        let state = BodyState {
            position: turn * DVec3::new(0.0, -0.2, 0.0),
            rotation: turn,
            velocity: DVec3::ZERO,
            angular_velocity: DVec3::Z * (-amplitude * omega * sin(omega * t)),
        };
        states = vec![state];
        observer.observe(t, &states);
    }
    let found = observer.report(&states).pendulum.expect("a pendulum");
    assert!(found.period_err_ppm.abs() < LINES_PPM, "{found:?}");
    assert!(found.period_err_hermite_ppm.abs() < CUBICS_PPM, "{found:?}");
    // The largest sample lies within half a step of the top.
    let least = 1.0 - 0.5 * (0.5 * omega * DT) * (0.5 * omega * DT);
    assert!((least..=1.0 + ROUNDING).contains(&found.amplitude_ratio), "{found:?}");
}

#[test]
fn a_run_that_leaves_its_energy_or_its_numbers_has_diverged() {
    let scene = make::chain(2, 1);
    let start: Vec<_> = scene.bodies.iter().map(|body| body.state()).collect();
    let fast = BodyState { velocity: DVec3::X * 1e3, ..start[1] };
    let none = BodyState { position: DVec3::X * f64::NAN, ..start[1] };
    for bad in [fast, none] {
        let mut observer = Observer::new(&scene);
        assert!(observer.observe(DT, &start));
        let states = [start[0], bad];
        assert!(!observer.observe(2.0 * DT, &states));
        assert_eq!(observer.report(&states).diverged_at_s, Some(2.0 * DT));
    }
}

#[test]
fn a_made_mobile_hangs_level() {
    for seed in SEEDS {
        let mut scene = make::mobile(11, seed);
        for body in &mut scene.bodies {
            (body.linvel, body.angvel) = ([0.0; 3], [0.0; 3]);
        }
        let mut engine = Soffio::new(&scene, DT, Integrator::Auto, Solver::Sparse);
        (0..60).for_each(|_| assert!(engine.step()));
        let mut states = Vec::new();
        engine.states(&mut states);
        for (body, state) in scene.bodies.iter().zip(&states) {
            let moved = state.position.distance(body.state().position);
            assert!(moved < JOINT_ERROR, "seed {seed}: {} moved by {moved} m", body.name);
        }
    }
}

/// An engine whose steps take a given processor time, and whose state is how many there were.
struct Slow {
    step: f64,
    done: u32,
}

impl Engine for Slow {
    fn step(&mut self) -> bool {
        let start = cpu_time::ThreadTime::now();
        while start.elapsed().as_secs_f64() < self.step {}
        self.done += 1;
        true
    }

    fn substeps(&self) -> u32 {
        1
    }

    fn states(&self, out: &mut Vec<BodyState>) {
        *out = vec![BodyState { position: DVec3::X * f64::from(self.done), ..BodyState::WORLD }];
    }
}

#[test]
fn later_rounds_run_the_steps_of_the_first_however_long_they_take() {
    let mut best = Best::default();
    let limits = Limits { seconds: f64::INFINITY, budget: 5e-3 };
    for step in [1e-3, 3e-3, 2e-3] {
        best.run_round(&mut Slow { step, done: 0 }, 1_000, limits);
    }
    assert!((1..1_000).contains(&best.steps()), "the first round ends in its time, not after {} steps", best.steps());
    assert!(best.agree(), "all rounds have the same steps");
    assert!(best.us_per_step() >= 1e3, "{} us", best.us_per_step());
}

/// A scene as a file has it, half a second of it, at most `drift` of its energy lost or won.
#[track_caller]
fn runs_well(scene: &PhysicsScene, drift: f64) {
    let scene = PhysicsScene::parse(&scene.to_json(), &scene.name).expect("sound");
    let limits = Limits { seconds: 0.5, budget: f64::INFINITY };
    let mut engine = Soffio::new(&scene, DT, Integrator::Auto, Solver::Sparse);
    let watched = run::observe(&scene, &mut engine, DT, limits);
    let (name, report) = (&scene.name, &watched.report);
    println!("{name}: energy {:.1e}, joints {:.1e} m", report.max_energy_drift_rel, report.max_joint_err_m);
    assert_eq!(report.diverged_at_s, None, "{name}: {report:?}");
    assert!(report.max_joint_err_m < JOINT_ERROR, "{name}: {report:?}");
    assert!(report.max_energy_drift_rel < drift, "{name}: {report:?}");
    let mut best = Best::default();
    let brief = Limits { seconds: 0.1, ..limits };
    for _ in 0..2 {
        let mut engine = Soffio::new(&scene, DT, Integrator::Auto, Solver::Sparse);
        best.run_round(&mut engine, run::step_count(&scene, DT, brief.seconds), brief);
    }
    assert!(best.agree(), "{name}: two runs differ");
}

#[test]
fn mobiles_of_any_size_keep_energy_and_joints() {
    /// A fourth-order step at 240 Hz leaves 1e-7 of a slow mobile's motion.
    const DRIFT: f64 = 1e-6;
    for seed in SEEDS {
        let n = 2 + (Random::new(seed).word() % 30) as usize;
        runs_well(&make::mobile(n, seed), DRIFT);
    }
}

#[test]
fn whips_of_any_length_keep_energy_and_joints() {
    /// A whip's last link turns by a radian a step.
    const DRIFT: f64 = 1e-4;
    for seed in SEEDS {
        let n = 2 + (Random::new(seed).word() % 12) as usize;
        runs_well(&make::chain(n, seed), DRIFT);
    }
}

#[test]
fn heavy_blocks_on_light_rods_keep_energy_and_joints() {
    /// The rods' transverse modes hold hardly any of it.
    const DRIFT: f64 = 1e-6;
    for seed in SEEDS {
        let mut random = Random::new(seed);
        let n = 2 + (random.word() % 4) as usize;
        runs_well(&make::mass_ratio(n, random.range(100.0, 1_000.0).round(), seed), DRIFT);
    }
}

#[test]
fn costs_are_measured_on_chains_and_trees() {
    for (shape, scene) in linear::scenes(linear::SIZES[0]) {
        let scene = PhysicsScene::parse(&scene.to_json(), shape).expect("sound");
        let cost = linear::measure(shape, &scene, 0.0);
        assert_eq!(cost.n, 10);
        for us in [cost.us_per_body_step, cost.us_per_body_factor_solve] {
            assert!(us.is_finite() && us > 0.0, "{cost:?}");
        }
        assert!(cost.us_per_body_factor_solve < cost.us_per_body_step, "{cost:?}");
    }
}

#[test]
fn a_whips_tip_follows_a_converged_run_until_chaos_parts_them() {
    /// How far the tip may be from the converged run, m.
    const TIP: f64 = 1e-4;
    /// Two runs of 1/1920 and 1/3840 s are this far apart when chaos has made a million times more of their rounding, m:
    /// from there on nobody knows where the tip is.
    const PARTED: f64 = 1e-6;
    for seed in SEEDS {
        let scene = make::chain(10, seed);
        let tip = scene.bodies.len() - 1;
        let run = |part: u64| {
            let mut engine = Soffio::new(&scene, DT / part as f64, Integrator::Auto, Solver::Sparse);
            let mut states = Vec::new();
            let mut place = |_| {
                (0..part).for_each(|_| assert!(engine.step(), "seed {seed}"));
                engine.states(&mut states);
                states[tip].point([0.0; 3])
            };
            (0..3 * 240).map(&mut place).collect::<Vec<DVec3>>()
        };
        let (ours, fine, finest) = (run(1), run(8), run(16));
        let known = fine.iter().zip(&finest).take_while(|(a, b)| a.distance(**b) < PARTED).count();
        let worst = (0..known).fold(0.0_f64, |worst, i| worst.max(ours[i].distance(finest[i])));
        println!("seed {seed}: within {worst:.1e} m for {:.2} s", known as f64 * DT);
        assert!(known > 120 && worst < TIP, "seed {seed}: {worst:e} m within {known} steps");
    }
}

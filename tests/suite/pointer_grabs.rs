//! Pointer grabs: the body under the finger is grabbed, follows it and can be thrown, in every motion mode.

use std::sync::Arc;

use assert_no_alloc::assert_no_alloc;
use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_math::{DVec3, rotation};
use soffio_simulation::{MotionMode, PointerGrab, Script, Settings, Simulation, StepInput};

const MODES: [MotionMode; 3] = [MotionMode::Dynamic, MotionMode::Procedural, MotionMode::PositionBased];
const ASPECT: f64 = 16.0 / 9.0;

fn load(id: &str) -> Exhibit {
    let folder = exhibit::resolve(id).unwrap_or_else(|report| panic!("{report}"));
    exhibit::load(&folder).unwrap_or_else(|report| panic!("{id}: {}", report.to_text()))
}

fn begin(id: &str) -> Simulation {
    Simulation::new(Arc::new(load(id)), Settings::default())
}

fn body(simulation: &Simulation, name: &str) -> usize {
    let found = simulation.exhibit().bodies.iter().position(|body| body.name == name);
    found.unwrap_or_else(|| panic!("no body {name}"))
}

/// Position of a body's centre of mass in the picture.
fn screen_position(simulation: &Simulation, body: usize) -> [f64; 2] {
    simulation.view(ASPECT).project(simulation.bodies()[body].position, ASPECT).expect("in front of the eye")
}

fn step(simulation: &mut Simulation, mode: MotionMode, grabs: &[PointerGrab]) {
    simulation.step(&StepInput { mode: Some(mode), pointer_grabs: grabs, ..StepInput::default() });
}

#[test]
fn a_hand_that_is_invited_moves_what_it_takes() {
    /// What a visitor sees at once, m; a mallet has 24 mm to its instrument.
    const SEEN: f64 = 0.02;
    let taken = [
        ("marionette", "ForearmLeft"),
        ("chains", "HeavyDisc"),
        ("chain-light", "LightDisc"),
        ("chain-heavy", "HeavyDisc"),
        ("breaking-chain", "Disc"),
        ("scratch-board", "Quill"),
        ("strikers", "MalletDrum"),
        ("hang-it", "Arm"),
    ];
    let inviting = exhibit::ids().into_iter().filter(|id| load(id).hand_invitation("en").is_some());
    for id in inviting {
        let (_, name) =
            taken.iter().find(|(of, _)| *of == id).unwrap_or_else(|| panic!("what does a hand take of {id}?"));
        let mut simulation = begin(&id);
        let body = body(&simulation, name);
        let [x, y] = screen_position(&simulation, body);
        let start = simulation.bodies()[body].position;
        let mut way: f64 = 0.0;
        for index in 0..360 {
            let s = f64::from(index.min(120)) / 120.0;
            let grabs = [PointerGrab { id: 1, at: [x + 0.08 * s, (y - 0.25 * s).max(0.05)], body: Some(body) }];
            step(&mut simulation, MotionMode::Dynamic, &grabs);
            way = way.max(simulation.bodies()[body].position.distance(start));
        }
        println!("{id}: a hand moves {name} by {:.0} mm", 1e3 * way);
        assert!(way > SEEN, "{id}: a hand moves {name} by {way} m");
    }
}

#[test]
fn a_grabbed_body_follows_the_finger_in_every_motion_mode() {
    /// After a second at rest, m: the steady pull of gravity against a grab by speed costs at most g Δt τ = 2 mm. It is
    /// larger by 1/cos² of the angle between view ray and displacement. The procedural rule ignores small
    /// displacements, so more of gravity remains.
    const NEAR: [f64; 3] = [4e-3, 1.5e-2, 4e-3];
    for (mode, near) in MODES.into_iter().zip(NEAR) {
        let mut simulation = begin("pendulum");
        let bob = body(&simulation, "Pendulum");
        let start = screen_position(&simulation, bob);
        let held = simulation.bodies()[bob].pose().inverse_point(simulation.bodies()[bob].position);
        let began = simulation.bodies()[bob].position;
        let mut at = start;
        for index in 0..480 {
            let s = (index as f64 / 240.0).min(1.0);
            at = [start[0] + 0.06 * s, start[1]];
            let grabs = [PointerGrab { id: 7, at, body: Some(bob) }];
            if index < 60 {
                // Buffers have their final size after a while.
                step(&mut simulation, mode, &grabs);
            } else {
                assert_no_alloc(|| step(&mut simulation, mode, &grabs));
            }
            assert_eq!(simulation.snapshot().diagnostics.grabs, 1, "{mode:?}: the finger has the bob");
        }
        // The bob swings about the z axis of its knife edge: of all positions on that circle it takes the one that is
        // nearest to the view ray of the finger, however obliquely the camera sees the circle.
        let (eye, ray) = simulation.view(ASPECT).ray(at, ASPECT);
        let knife = simulation.bodies()[bob].pose().position;
        let now = simulation.bodies()[bob].pose().point(held);
        let places = (-4000..4000).map(|i| knife + rotation(1e-4 * f64::from(i) * DVec3::Z) * (now - knife));
        let off = |place: &DVec3| (*place - eye).cross(ray).length();
        let nearest = places.min_by(|a, b| off(a).total_cmp(&off(b))).expect("places");
        let beside = now.distance(nearest);
        println!("{mode:?}: from {began} to {now}, {beside} m beside the finger");
        assert!(now.distance(began) > 0.015, "{mode:?}: it hardly moved");
        assert!(beside < near, "{mode:?}: {beside} m beside the finger");
        assert!(simulation.joint_error() < 1e-6, "{mode:?}: joints open by {}", simulation.joint_error());
    }
}

#[test]
fn a_thrown_body_flies_on_and_a_body_held_still_stays() {
    for mode in MODES {
        let mut simulation = begin("pendulum");
        let bob = body(&simulation, "Pendulum");
        let start = screen_position(&simulation, bob);
        for index in 0..60 {
            let at = [start[0] + 0.12 * f64::from(index) / 60.0, start[1]];
            step(&mut simulation, mode, &[PointerGrab { id: 1, at, body: None }]);
        }
        let speed = simulation.bodies()[bob].velocity.length();
        step(&mut simulation, mode, &[]);
        let after = simulation.bodies()[bob].velocity.length();
        println!("{mode:?}: {speed} m/s in the hand, {after} m/s after it");
        // One step of gravity on the bow.
        assert!(speed > 0.1 && (after - speed).abs() < 0.1 * speed + 9.81 / 240.0, "{mode:?}: {speed} {after}");
        assert_eq!(simulation.snapshot().diagnostics.grabs, 0);
    }
}

#[test]
fn a_body_without_touch_permission_is_not_grabbed() {
    let mut exhibit = load("pendulum");
    exhibit.touch.permitted = false;
    let exhibit = Arc::new(exhibit);
    let [mut left, mut right] = [(); 2].map(|()| Simulation::new(exhibit.clone(), Settings::default()));
    let bob = body(&left, "Pendulum");
    let at = screen_position(&left, bob);
    for index in 0..240 {
        let at = [at[0] + 0.001 * f64::from(index), at[1]];
        step(&mut left, MotionMode::Dynamic, &[PointerGrab { id: 1, at, body: None }]);
        step(&mut right, MotionMode::Dynamic, &[]);
    }
    assert_eq!(left.state_hash(), right.state_hash());
}

#[test]
fn a_script_can_grab() {
    let text = "{\"t\": 0.1, \"grab\": {\"body\": \"Pendulum\"}}\n{\"t\": 0.2, \"drag\": [0.7, 0.6]}\n\
                {\"t\": 0.3, \"grab\": {\"at\": [0.5, 0.9]}, \"hand\": 1}\n{\"t\": 1.0, \"release\": true}";
    let mut script = Script::parse(text).expect("a good script");
    let simulation = begin("pendulum");
    script.fits(simulation.exhibit()).expect("it has a bob");
    let mut at = |t: f64| {
        let mut grabs = Vec::new();
        script.due(t, &mut Vec::new());
        script.pointer_grabs(&simulation, ASPECT, &mut grabs);
        grabs
    };
    assert!(at(0.0).is_empty());
    let bob = body(&simulation, "Pendulum");
    assert_eq!(at(0.1), [PointerGrab { id: 1, at: screen_position(&simulation, bob), body: Some(bob) }]);
    assert_eq!(at(0.25), [PointerGrab { id: 1, at: [0.7, 0.6], body: Some(bob) }]);
    assert_eq!(at(0.5).len(), 2);
    assert_eq!(at(1.5), [PointerGrab { id: 2, at: [0.5, 0.9], body: None }]);

    let wrong =
        Script::parse("{\"t\": 0, \"reset\": true}\n{\"t\": 1, \"grab\": {\"body\": \"Bab\"}}").expect("a script");
    let error = wrong.fits(simulation.exhibit()).expect_err("no such body");
    assert_eq!(error.line, 2);
    assert!(error.problem.contains("Pendulum"), "{error}");
}

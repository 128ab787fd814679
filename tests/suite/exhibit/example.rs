//! A sidecar that uses every part of the format loads without a word, and runs.

use std::sync::Arc;

use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_math::DVec3;
use soffio_multibody::articulation::ConstraintKind;
use soffio_simulation::{Simulation, StepInput};
use soffio_wind::ambient::{Inlet, Modulation, WindKind};
use soffio_wind::breath::SpreadLaw;

use super::glb::{Folder, Scene, cuboid};

const SIDECAR: &str = include_str!("../../cases/exhibit-full/exhibit.toml");

fn load() -> Exhibit {
    let mut scene = Scene::default();
    scene.node("Tube1", [-0.2, 0.49, 0.1], Some(&cuboid([0.032, 0.62, 0.032])), &[]);
    let hook = scene.node("StrikerHook", [0.0, 0.4, 0.0], None, &[]);
    scene.node("Striker", [-0.2, 0.4, 0.1], Some(&cuboid([0.05; 3])), &[hook]);
    scene.node("EscapeWheel", [0.0, 0.42, 0.03], Some(&cuboid([0.04, 0.04, 0.004])), &[]);
    let pivot = scene.node("PalletPivot", [0.0, 0.01, 0.0], None, &[]);
    scene.node("Pallet", [0.0, 0.47, 0.03], Some(&cuboid([0.03, 0.01, 0.004])), &[pivot]);
    scene.node("Weight", [0.1, 0.3, 0.0], Some(&cuboid([0.04; 3])), &[]);
    scene.node("Rail", [0.1, 0.5, 0.0], Some(&cuboid([0.02, 1.0, 0.02])), &[]);
    let hang = scene.node("HangPoint", [-0.2, 0.8, 0.1], None, &[]);
    let sway = |x: f32| vec![x, 0.8, 0.1];
    scene.animate("Sway", hang, "translation", "LINEAR", &[(0.0, sway(-0.2)), (2.0, sway(-0.19)), (4.0, sway(-0.2))]);
    let camera = scene.node("CamFront", [0.0, 0.5, 2.0], None, &[]);
    scene.set(camera, "camera", serde_json::json!(0));
    scene.extra = vec![(
        "cameras",
        serde_json::json!([{ "type": "perspective", "perspective": { "yfov": 0.6, "znear": 0.01 } }]),
    )];
    let folder = Folder::exhibit(&scene.glb(), "");
    folder.write("clock-and-chime.glb", &scene.glb());
    folder.write("exhibit.toml", SIDECAR.as_bytes());
    exhibit::load(folder.path()).unwrap_or_else(|report| panic!("{}", report.to_text()))
}

#[test]
fn the_full_example_loads_with_everything_it_says() {
    let exhibit = load();
    assert!(exhibit.warnings.is_empty(), "{:#?}", exhibit.warnings);
    let bodies: Vec<&str> = exhibit.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(bodies, ["Tube1", "Striker", "EscapeWheel", "Pallet", "Weight", "HangPoint"]);
    assert_eq!(exhibit.drives.iter().map(|drive| drive.body).collect::<Vec<_>>(), [5]);
    let names: Vec<&str> = exhibit.constraints.iter().map(|c| c.name.as_str()).collect();
    #[rustfmt::skip] // one kind a row
    let expected = [
        "wire", "tube-hang", "wheel-axle/tx", "wheel-axle/ty", "wheel-axle/tz", "wheel-axis-x", "wheel-axis-y",
        "retainer-plane-1", "retainer-plane-2", "pallet-arbor/nail", "pallet-arbor/across-1", "pallet-arbor/across-2",
        "wheel-to-pallet", "cord", "hold-the-weight",
    ];
    assert_eq!(names, expected);
    let freed = exhibit.constraints.iter().find(|c| c.name == "wheel-axle/tz").expect("the freed row");
    assert_eq!((freed.schedule.activation(11.0, None), freed.schedule.activation(15.0, None)), (1.0, 0.0));
    assert_eq!(freed.stabilization_time, Some(0.06));
    let ConstraintKind::Coupling { terms } = &exhibit.constraints[13].kind else { panic!("not a cord") };
    assert!(terms[0].coefficient == 2.0 && (terms[1].coefficient + 0.018).abs() < 1e-12, "{terms:?}");
    assert_eq!(exhibit.springs.len(), 2);
    let limits: Vec<&str> = exhibit.limits.iter().map(|l| l.name.as_str()).collect();
    assert_eq!(limits, ["pallet-arbor", "click", "floor"]);
}

#[test]
fn the_full_examples_winds_are_what_it_says() {
    let exhibit = load();
    let names: Vec<&str> = exhibit.winds.iter().map(|wind| wind.name.as_str()).collect();
    assert_eq!(names, ["room", "air-conditioner", "door", "passing-tram"]);
    assert_eq!(exhibit.winds[0].kind, WindKind::Turbulence { scale: 0.8, period: 5.0, seed: 3 });
    let WindKind::Fan { at, direction, diameter } = exhibit.winds[1].kind else { panic!("not a fan") };
    // The model holds single precision.
    assert!(at.distance(DVec3::new(0.1, 0.5, 0.0)) < 1e-6 && diameter == 0.15 && direction.is_normalized());
    assert_eq!(exhibit.winds[1].speed.at(2.5).value, 1.5);
    let WindKind::Draught { direction, inlet } = exhibit.winds[2].kind else { panic!("not a draught") };
    let entrance = Inlet { center: DVec3::new(0.0, 0.5, 2.0), width: 0.8 };
    assert_eq!((direction, inlet), (DVec3::NEG_Z, Some(entrance)));
    assert_eq!(exhibit.winds[2].modulation, Modulation::Gusty { strength: 0.5, period: 4.0, seed: 1 });
    assert_eq!(exhibit.winds[3].modulation, Modulation::Puffs { interval: 30.0, duration: 2.0, seed: 0 });
    assert_eq!(exhibit.winds[3].kind, WindKind::Draught { direction: DVec3::X, inlet: None });
    assert_eq!(
        (exhibit.breath.law, exhibit.breath.gain, exhibit.breath.lip_diameter),
        (SpreadLaw::Cone { vertex_distance: Some(0.03) }, 1.5, Some(0.012))
    );
    assert_eq!(exhibit.breath.turbulence, 0.4);
    let carriers: Vec<Option<usize>> = exhibit.cords[0].points.iter().map(|point| point.body).collect();
    assert_eq!(carriers, ["EscapeWheel", "Weight"].map(|name| exhibit.bodies.iter().position(|b| b.name == name)));
    // Every body with a mesh shelters; the rail, which stands still, is open.
    let mut carriers: Vec<Option<usize>> = exhibit.shelters.iter().map(|shelter| shelter.body).collect();
    carriers.sort_unstable();
    assert_eq!(carriers, [Some(0), Some(1), Some(2), Some(3), Some(4)]);
}

#[test]
fn the_full_example_runs() {
    let exhibit = Arc::new(load());
    let mut simulation = Simulation::new(exhibit, soffio_simulation::Settings::default());
    for step in 0..240 {
        simulation.step(&StepInput { hold: step < 120, ..StepInput::default() });
        let bodies = simulation.bodies();
        assert!(bodies.iter().all(|body| body.is_finite() && body.position.distance(DVec3::ZERO) < 100.0), "{step}");
    }
}

#[test]
fn an_exhibit_of_some_length_starts_again_at_its_end() {
    let mut scene = Scene::default();
    scene.node("Box", [0.0; 3], Some(&cuboid([0.1; 3])), &[]);
    let text = "[scene]\nduration = \"500 ms\"\n[[body]]\nnode = \"Box\"\nmaterial = \"oak\"\n";
    let folder = Folder::exhibit(&scene.glb(), text);
    let exhibit = exhibit::load(folder.path()).unwrap_or_else(|report| panic!("{}", report.to_text()));
    let mut simulation = Simulation::new(Arc::new(exhibit), soffio_simulation::Settings::default());
    let height = |simulation: &Simulation| simulation.bodies()[0].position.y;
    for _ in 0..120 {
        simulation.step(&StepInput::default());
    }
    // Free fall for half a second, g t²/2.
    assert!((height(&simulation) + 1.226).abs() < 0.02, "{}", height(&simulation));
    simulation.step(&StepInput::default());
    assert!(height(&simulation).abs() < 1e-3, "{}", height(&simulation));
}

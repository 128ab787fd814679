//! Windows, triggers, breaking and functions arrive from the sidecar as they are written.

use soffio_exhibit::{self as exhibit, Exhibit};
use soffio_math::Function;
use soffio_math::Interpolation;
use soffio_math::PI;
use soffio_multibody::articulation::{Breaking, Schedule, Trigger, Window};

use super::glb::{Folder, Scene, cuboid};

/// Sums of a few products.
const ROUNDING: f64 = 1e-12;

fn load(text: &str) -> Exhibit {
    let mut scene = Scene::default();
    scene.node("Box", [0.0; 3], Some(&cuboid([0.1; 3])), &[]);
    let body =
        "[[body]]\nnode = \"Box\"\nmaterial = \"oak\"\n[[collider]]\nnode = \"Box\"\nshape = { fit = \"box\" }\n";
    exhibit::load(Folder::exhibit(&scene.glb(), &format!("{body}{text}")).path())
        .unwrap_or_else(|report| panic!("{text}\n{}", report.to_text()))
}

/// A nail with these keys besides.
fn nail(keys: &str) -> Exhibit {
    load(&format!("[[constraint.nail]]\nname = \"pin\"\nbody = \"Box\"\nto = [0, 0, 0]\n{keys}\n"))
}

#[test]
fn windows_come_alone_or_in_a_list_with_ramps_and_a_period() {
    let one = nail("window = { start = \"500 ms\", end = 2, ramp_in = 0.25, ramp_out = 0.5 }\nperiod = 3");
    let schedule = &one.constraints[0].schedule;
    assert_eq!(schedule.windows, [Window { start: 0.5, end: 2.0 }]);
    for (t, share) in [(0.25, 0.0), (0.625, 0.5), (1.0, 1.0), (1.75, 0.5), (2.5, 0.0), (3.625, 0.5)] {
        assert!((schedule.activation(t, None) - share).abs() < ROUNDING, "at {t} s");
    }
    let list = nail("window = [{ end = 1 }, { start = 4, end = \"inf\" }]");
    let windows = &list.constraints[0].schedule.windows;
    assert_eq!(windows.as_slice(), [Window { start: 0.0, end: 1.0 }, Window { start: 4.0, end: f64::INFINITY }]);
    assert!(nail("").constraints[0].schedule.is_always());
}

#[test]
fn triggers_and_breaking_arrive() {
    let hit = nail("trigger = { on = \"impact\", body = \"Box\", least = \"0.1 N s\" }\nwindow = { end = 2 }");
    assert_eq!(hit.constraints[0].schedule.trigger, Some(Trigger::Impact { body: 0, least_impulse: 0.1 }));
    let blown = nail("trigger = { on = \"breath\", least = \"2 m/s\" }");
    assert_eq!(blown.constraints[0].schedule.trigger, Some(Trigger::Breath { least_speed: 2.0 }));
    let broken = nail("break = { force = \"25 N\", impulse = \"3 mN s\", restore = \"8 s\" }");
    let expected = Breaking { force: 25.0, impulse: 3e-3, restore: 8.0, ..Breaking::default() };
    assert_eq!(broken.constraints[0].breaking, Some(expected));
    for restore in ["", ", restore = \"on-reset\"", ", restore = \"never\""] {
        let broken = nail(&format!("break = {{ torque = \"2 N m\"{restore} }}"));
        assert_eq!(broken.constraints[0].breaking, Some(Breaking { torque: 2.0, ..Breaking::default() }));
    }
}

#[test]
fn all_parts_of_a_combination_share_its_times_and_break_together() {
    let text = "[[constraint.hinge]]\nname = \"axle\"\nbody = \"Box\"\naxis = [0, 0, 1]\nwindow = { start = 1, end = 3 }\n\
                break = { force = 5 }\n";
    let exhibit = load(text);
    let first = &exhibit.constraints[0];
    assert_eq!(exhibit.constraints.len(), 3);
    assert!(exhibit.constraints.iter().all(|c| c.schedule == first.schedule && c.breaking == first.breaking));
    assert_eq!((first.schedule.activation(2.0, None), first.breaking.map(|b| b.force)), (1.0, Some(5.0)));
}

#[test]
fn an_element_leaves_a_hole_that_its_own_ramps_cross() {
    let text = "[[constraint.element]]\nname = \"free\"\nof = \"pin\"\nop = \"remove\"\ndof = \"ty\"\n\
                window = { start = 12, end = 20, ramp_in = 1, ramp_out = 2 }\n";
    let exhibit = nail(text);
    let freed = exhibit.constraints.iter().find(|c| c.name == "pin/ty").expect("the row that is freed");
    let hole = Schedule {
        windows: vec![Window { start: 12.0, end: 20.0 }],
        ramp_in: 1.0,
        ramp_out: 2.0,
        ..Schedule::default()
    };
    // There from the first moment, gone inside; what it lets go, the hole has.
    for t in [0.0, 11.9, 12.25, 12.75, 13.0, 15.0, 18.5, 19.5, 20.0, 30.0] {
        let (found, expected) = (freed.schedule.activation(t, None), 1.0 - hole.activation(t, None));
        assert!((found - expected).abs() < ROUNDING, "at {t} s: {found}, expected {expected}");
    }
    assert!(exhibit.constraints.iter().filter(|c| c.name != "pin/ty").all(|c| c.schedule.is_always()));

    // A hole that repeats leaves windows that repeat, and nothing ramps where one period ends and the next begins.
    let repeated = Schedule { period: Some(30.0), ..hole };
    let rest = Schedule::default().without(&repeated);
    for t in [0.0, 11.9, 12.25, 15.0, 18.5, 19.5, 20.0, 29.99, 30.0, 42.5, 45.0, 49.5, 59.9] {
        let (found, expected) = (rest.activation(t, None), 1.0 - repeated.activation(t, None));
        assert!((found - expected).abs() < ROUNDING, "at {t} s: {found}, expected {expected}");
    }
}

#[test]
fn functions_are_numbers_keys_or_waves() {
    let spring = |stiffness: &str| {
        let text = "[[constraint.spring]]\nname = \"s\"\na = { node = \"Box\" }\nb = { node = \"Stand\" }\n";
        let mut scene = Scene::default();
        scene.node("Box", [0.0; 3], Some(&cuboid([0.1; 3])), &[]);
        scene.node("Stand", [0.0, 1.0, 0.0], None, &[]);
        let body = "[[body]]\nnode = \"Box\"\nmaterial = \"oak\"\n";
        let folder = Folder::exhibit(&scene.glb(), &format!("{body}{text}stiffness = {stiffness}\n"));
        exhibit::load(folder.path()).unwrap_or_else(|report| panic!("{}", report.to_text())).springs[0]
            .stiffness
            .clone()
    };
    assert_eq!(spring("\"1.5 N/mm\""), Function::Constant(1500.0));
    let keys = spring("{ keys = [[0, 1], [\"200 ms\", \"2 N/cm\"]], interpolation = \"step\", loop = true }");
    let expected =
        Function::Keys { keys: vec![(0.0, 1.0), (0.2, 200.0)], interpolation: Interpolation::Step, repeat: true };
    assert_eq!(keys, expected);
    let wave = spring("{ wave = \"sine\", mean = 10, amplitude = 3, period = \"2 s\", phase = \"90 deg\" }");
    assert_eq!(wave, Function::Wave { mean: 10.0, amplitude: 3.0, period: 2.0, phase: PI / 2.0 });
}

#[test]
fn a_splines_derivatives_have_no_jumps_and_are_those_of_its_values() {
    /// Central differences of width 1e-5 s: error h² f⁗/6 and rounding 1e-16/h².
    const DIFFERENCE: f64 = 1e-5;
    let keys = vec![(0.5, 1.0), (1.0, -2.0), (2.5, 0.5), (3.0, 4.0), (4.0, 1.0)];
    for repeat in [false, true] {
        let f = Function::Keys { keys: keys.clone(), interpolation: Interpolation::Spline, repeat };
        for (t, value) in &keys[..4] {
            assert!((f.at(*t).value - value).abs() < ROUNDING);
            let (before, after) = (f.at(t - 1e-9), f.at(t + 1e-9));
            assert!((before.rate - after.rate).abs() < 1e-6, "ḟ jumps at {t} s: {before:?} {after:?}");
            assert!((before.acceleration - after.acceleration).abs() < 1e-5, "f̈ jumps at {t} s");
        }
        for i in 1..70 {
            let (t, h) = (0.513 + 0.05 * f64::from(i), 1e-5);
            let (before, here, after) = (f.at(t - h), f.at(t), f.at(t + h));
            assert!(((after.value - before.value) / (2.0 * h) - here.rate).abs() < DIFFERENCE, "ḟ at {t} s");
            assert!(
                ((after.rate - before.rate) / (2.0 * h) - here.acceleration).abs() < 10.0 * DIFFERENCE,
                "f̈ at {t} s"
            );
        }
    }
}

//! What each kind of constraint holds and what it leaves free: bodies are moved by hand, and the rows that the loader
//! made are evaluated here by their definitions, apart from the solver.

use soffio_exhibit::{self as exhibit, Exhibit, Report, codes};
use soffio_math::{DVec3, PI, Pose, asin, rotation};
use soffio_multibody::articulation::{Anchor, Axis, ConstraintKind, LimitKind, Measure, SpringKind};

use super::glb::{Folder, Scene, cuboid};

/// glTF holds single precision: seven digits.
const SINGLE: f64 = 1e-6;
/// A motion that a row forbids moves it by more than this (the motions below are of some 0.1 m and rad).
const FELT: f64 = 1e-2;

/// Arm and Wheel, turned and off the origin; Rail stands still, turned about z.
fn model() -> Vec<u8> {
    let mut scene = Scene::default();
    let tip = scene.node("Tip", [0.5, 0.0, 0.0], None, &[]);
    let arm = scene.node("Arm", [0.1, 1.0, -0.2], Some(&cuboid([1.0, 0.02, 0.02])), &[tip]);
    scene.set(arm, "rotation", serde_json::json!([0.0, 0.6, 0.0, 0.8]));
    let wheel = scene.node("Wheel", [0.4, 0.3, 0.2], Some(&cuboid([0.1, 0.1, 0.02])), &[]);
    scene.set(wheel, "rotation", serde_json::json!([0.6, 0.0, 0.0, 0.8]));
    scene.node("Weight", [0.0, 0.5, 0.0], Some(&cuboid([0.05; 3])), &[]);
    let rail = scene.node("Rail", [0.4, 0.3, 0.2], None, &[]);
    scene.set(rail, "rotation", serde_json::json!([0.0, 0.0, 0.6, 0.8]));
    scene.glb()
}

const BODIES: &str = "[[body]]\nnode = \"Arm\"\nmaterial = \"steel\"\n[[body]]\nnode = \"Wheel\"\nmaterial = \"steel\"\n\
                      [[body]]\nnode = \"Weight\"\nmaterial = \"steel\"\n";
const ARM: usize = 0;
const WHEEL: usize = 1;
const WEIGHT: usize = 2;

fn try_load(text: &str) -> Result<Exhibit, Report> {
    exhibit::load(Folder::exhibit(&model(), &format!("{BODIES}{text}")).path())
}

fn load(text: &str) -> Exhibit {
    try_load(text).unwrap_or_else(|report| panic!("{text}\n{}", report.to_text()))
}

/// A turn by `turn` (rotation vector, world) about a world point, then a way.
#[derive(Clone, Copy)]
struct Twist {
    about: DVec3,
    turn: DVec3,
    way: DVec3,
}

impl Twist {
    const NONE: Self = Self { about: DVec3::ZERO, turn: DVec3::ZERO, way: DVec3::ZERO };

    fn moved(&self, pose: Pose) -> Pose {
        let q = rotation(self.turn);
        Pose { rotation: q * pose.rotation, position: self.about + q * (pose.position - self.about) + self.way }
    }
}

/// Every constraint's rows after the bodies have moved.
fn values(exhibit: &Exhibit, twists: [Twist; 3], t: f64) -> Vec<f64> {
    let start: Vec<Pose> = exhibit.bodies.iter().map(|body| body.pose).collect();
    let poses: Vec<Pose> = start.iter().zip(&twists).map(|(pose, twist)| twist.moved(*pose)).collect();
    let pose = |body: Option<usize>| body.map_or(Pose::IDENTITY, |b| poses[b]);
    let before = |body: Option<usize>| body.map_or(Pose::IDENTITY, |b| start[b]);
    let turn = |body: Option<usize>| body.map_or(DVec3::ZERO, |b| twists[b].turn);
    let point = |a: &Anchor| pose(a.body).point(a.point);
    let axis = |a: &Axis| pose(a.body).vector(a.direction);
    let measure = |m: &Measure| match m {
        // Exact for turns about the axis itself, and the motions below are no others.
        Measure::Angle { axis: a, frame } => (turn(a.body) - turn(*frame)).dot(before(a.body).vector(a.direction)),
        Measure::Displacement { point: p, direction } => {
            (point(p) - before(p.body).point(p.point)).dot(axis(direction))
        }
    };
    let mut out = Vec::new();
    for constraint in &exhibit.constraints {
        match &constraint.kind {
            ConstraintKind::PointToPoint { a, b } => out.extend((point(a) - point(b)).to_array()),
            ConstraintKind::PointOnPlane { point: p, plane, normal, offset } => {
                out.push(pose(plane.body).vector(*normal).dot(point(p) - point(plane)) - offset.at(t).value);
            }
            ConstraintKind::Orientation { a, b, angle } => {
                out.push(asin(axis(a).dot(axis(b)).clamp(-1.0, 1.0)) - angle.at(t).value);
            }
            ConstraintKind::Coupling { terms } => {
                out.push(terms.iter().map(|term| term.coefficient * measure(&term.measure)).sum());
            }
        }
    }
    out
}

/// Moves one body; the others stay.
fn one(body: usize, twist: Twist) -> [Twist; 3] {
    let mut all = [Twist::NONE; 3];
    all[body] = twist;
    all
}

fn worst(exhibit: &Exhibit, twists: [Twist; 3]) -> f64 {
    values(exhibit, twists, 0.0).iter().fold(0.0, |worst, x| worst.max(x.abs()))
}

/// Of the six motions of a body along and about the axes of a frame, which are free? ("tx ty tz rx ry rz")
fn check_freedoms(exhibit: &Exhibit, body: usize, at: DVec3, axes: [DVec3; 3], free: &str) {
    let names = ["x", "y", "z"];
    for (k, axis) in axes.into_iter().enumerate() {
        let way = Twist { way: 0.1 * axis, ..Twist::NONE };
        let turn = Twist { about: at, turn: 0.3 * axis, ..Twist::NONE };
        for (kind, twist) in [("t", way), ("r", turn)] {
            let name = format!("{kind}{}", names[k]);
            let moved = worst(exhibit, one(body, twist));
            if free.split_whitespace().any(|f| f == name) {
                assert!(moved < SINGLE, "{name} is held: {moved}");
            } else {
                assert!(moved > FELT, "{name} is free: {moved}");
            }
        }
    }
}

/// Axes of a body's node at the start.
fn axes(exhibit: &Exhibit, body: usize) -> [DVec3; 3] {
    [DVec3::X, DVec3::Y, DVec3::Z].map(|e| exhibit.bodies[body].pose.vector(e))
}

fn names(exhibit: &Exhibit) -> Vec<&str> {
    exhibit.constraints.iter().map(|c| c.name.as_str()).collect()
}

#[test]
fn combinations_leave_the_freedoms_of_their_name() {
    let cases = [
        ("[[constraint.hinge]]\naxis = [0, 0, 1]", "rz", 3),
        ("[[constraint.windmill]]\naxis = [0, 1, 0]", "ry", 3),
        ("[[constraint.slider]]\naxis = [1, 0, 0]", "tx", 5),
        ("[[constraint.weld]]", "", 4),
        ("[[constraint.nail]]\nto = { node = \"Rail\" }", "rx ry rz", 1),
    ];
    for (table, free, parts) in cases {
        let exhibit = load(&format!("{table}\nname = \"axle\"\nbody = \"Wheel\"\n"));
        assert_eq!(exhibit.constraints.len(), parts, "{table}: {:?}", names(&exhibit));
        assert!(exhibit.constraints.iter().all(|c| c.group() == "axle"), "{table}: {:?}", names(&exhibit));
        let at = exhibit.bodies[WHEEL].pose.position;
        check_freedoms(&exhibit, WHEEL, at, axes(&exhibit, WHEEL), free);
        assert!(exhibit.warnings.is_empty(), "{table}: {:?}", exhibit.warnings);
    }
    let hinge = load("[[constraint.hinge]]\naxis = [0, 0, 1]\nname = \"axle\"\nbody = \"Wheel\"\n");
    assert_eq!(names(&hinge), ["axle/nail", "axle/across-1", "axle/across-2"]);
}

#[test]
fn a_line_is_the_carriers_and_a_universal_crosses_both_axes() {
    let text =
        "[[constraint.line]]\nname = \"crutch\"\nbody = \"Wheel\"\nto = { node = \"Rail\" }\ndirection = [1, 0, 0]\n";
    let line = load(text);
    // The rail is turned about z by 2 atan(0.6/0.8).
    let x = rotation(2.0 * asin(0.6) * DVec3::Z) * DVec3::X;
    let frame = [x, DVec3::Z.cross(x), DVec3::Z];
    check_freedoms(&line, WHEEL, line.bodies[WHEEL].pose.position, frame, "tx rx ry rz");

    let text =
        "[[constraint.universal]]\nname = \"cross\"\nbody = \"Wheel\"\naxis = [1, 0, 0]\nother_axis = [0, 1, 0]\n";
    let cross = load(text);
    let at = cross.bodies[WHEEL].pose.position;
    check_freedoms(&cross, WHEEL, at, [DVec3::X, DVec3::Y, DVec3::Z], "rx ry");
    assert_eq!(names(&cross), ["cross/nail", "cross/cross"]);
}

#[test]
fn a_combination_on_a_moving_body_goes_with_it() {
    // The wheel hangs on the arm's tip, wherever that is; both turn together about any axis.
    let text = "[[constraint.hinge]]\nname = \"axle\"\nbody = \"Weight\"\naxis = [0, 0, 1]\nat = [0.3, 0.5, 0.1]\n\
                to = { node = \"Arm\", at = [0.02, 0, 0.6] }\n[solver]\nassemble = true\n";
    let exhibit = load(text);
    let twist = Twist { about: DVec3::new(0.2, 0.1, 0.4), turn: DVec3::new(0.3, -0.8, 0.5), way: DVec3::X };
    let still = values(&exhibit, [Twist::NONE; 3], 0.0);
    let mut both = [Twist::NONE; 3];
    (both[ARM], both[WEIGHT]) = (twist, twist);
    let moved = values(&exhibit, both, 0.0);
    // The gap at the point turns with the two, the angles stay.
    let length = |v: &[f64]| DVec3::from_slice(&v[..3]).length();
    assert!((length(&still) - length(&moved)).abs() < SINGLE && length(&still) > FELT);
    assert!(still[3..].iter().zip(&moved[3..]).all(|(a, b)| (a - b).abs() < SINGLE), "{still:?} {moved:?}");
}

#[test]
fn orientations_and_planes_follow_their_functions() {
    let text = "[[constraint.orientation]]\nname = \"lean\"\nbody = \"Weight\"\nbody_axis = [1, 0, 0]\n\
                world_axis = [0, 1, 0]\nangle = { keys = [[0, 0], [2, \"20 deg\"]], interpolation = \"linear\" }\n\
                [[constraint.point-on-plane]]\nname = \"lift\"\nbody = \"Weight\"\n\
                plane = { normal = [0, 2, 0], offset = { wave = \"sine\", mean = 0.5, amplitude = \"3 cm\", period = 4 } }\n";
    let exhibit = load(text);
    let lean = Twist { about: exhibit.bodies[WEIGHT].pose.position, turn: PI / 18.0 * DVec3::Z, way: 0.03 * DVec3::Y };
    // At 1 s: half way to 20°, and the crest of the wave.
    let found = values(&exhibit, one(WEIGHT, lean), 1.0);
    assert!(found.iter().all(|x| x.abs() < SINGLE), "{found:?}");
    let found = values(&exhibit, [Twist::NONE; 3], 1.0);
    assert!(found.iter().all(|x| x.abs() > FELT), "{found:?}");
    // Without an offset the point stays at its height at rest.
    let text = "[[constraint.point-on-plane]]\nname = \"level\"\nbody = \"Wheel\"\nplane = { normal = [0, 1, 0] }\n";
    assert!(worst(&load(text), [Twist::NONE; 3]) < SINGLE);
}

#[test]
fn gears_turn_oppositely_unless_one_lies_in_the_other() {
    let gear = |keys: &str| {
        load(&format!(
            "[[constraint.gear]]\nname = \"mesh\"\na = {{ body = \"Arm\", axis = [0, 1, 0], teeth = 42 }}\n{keys}\n"
        ))
    };
    let turns = |a: f64, b: f64| {
        let mut all = [Twist::NONE; 3];
        all[ARM] = Twist { turn: a * DVec3::Y, ..Twist::NONE };
        all[WEIGHT] = Twist { turn: b * DVec3::Y, ..Twist::NONE };
        all
    };
    // The arm's y axis is the world's; 42 teeth drive 6 seven times as fast.
    for (axis, keys, sense) in [("1", "", -1.0), ("-1", "", -1.0), ("1", "internal = true", 1.0)] {
        let b = format!("b = {{ body = \"Weight\", axis = [0, {axis}, 0], teeth = 6 }}\n{keys}");
        let exhibit = gear(&b);
        assert!(worst(&exhibit, turns(0.1, sense * 0.7)) < SINGLE, "{b}");
        assert!(worst(&exhibit, turns(0.1, -sense * 0.7)) > FELT, "{b}");
    }
    // On a frame that turns with both, nothing is asked.
    let text = "b = { body = \"Weight\", axis = [0, 1, 0], teeth = 6 }\nframe = \"Wheel\"";
    let all = [Twist { turn: 0.4 * DVec3::Y, ..Twist::NONE }; 3];
    assert!(worst(&gear(text), all) < SINGLE);
}

#[test]
fn a_gear_with_backlash_is_free_between_the_flanks_of_its_teeth() {
    let gear = |size: [&str; 2], keys: &str| {
        try_load(&format!(
            "[[constraint.gear]]\nname = \"mesh\"\na = {{ body = \"Arm\", axis = [0, 1, 0], {} }}\n\
             b = {{ body = \"Weight\", axis = [0, 1, 0], {} }}\n{keys}\n",
            size[0], size[1]
        ))
    };
    let (teeth, radii) = (["teeth = 42", "teeth = 6"], ["radius = \"70 mm\"", "radius = \"10 mm\""]);
    for (size, backlash, coefficients, wanted) in
        [(teeth, "\"2 deg\"", [7.0, 1.0], PI / 90.0), (radii, "\"0.5 mm\"", [0.07, 0.01], 5e-4)]
    {
        let loose = gear(size, &format!("backlash = {backlash}"));
        let exhibit = loose.unwrap_or_else(|report| panic!("{}", report.to_text()));
        assert!(exhibit.constraints.is_empty());
        let LimitKind::Play { terms, play } = exhibit.limits[0].kind else { panic!("{:?}", exhibit.limits) };
        assert!((play - wanted).abs() < SINGLE * wanted, "{play}");
        assert_eq!(terms.map(|term| term.coefficient), coefficients);
        assert_eq!(exhibit.limits[0].name, "mesh");
        // Wheels that mesh do not collide.
        assert!(exhibit.excluded_pairs.iter().any(|pair| pair.bodies == (Some(ARM), Some(WEIGHT))));
    }
    let code = |size, keys: &str| gear(size, keys).expect_err("a problem").diagnostics[0].code;
    assert_eq!(code(teeth, "backlash = \"1 mm\""), codes::WRONG_TYPE.name);
    assert_eq!(code(radii, "backlash = \"1 deg\""), codes::WRONG_TYPE.name);
    assert_eq!(code(teeth, "backlash = 0.01\nwindow = { start = 1, end = 2 }"), codes::WRONG_SHAPE.name);
    assert!(gear(teeth, "backlash = -0.01").is_err());
    assert_eq!(gear(teeth, "backlash = 0").map(|exhibit| exhibit.constraints.len()).ok(), Some(1));
}

#[test]
fn inactive_elements_do_not_act_and_can_still_be_referred_to() {
    let text = |enabled: &str| {
        format!(
            "[[constraint.hinge]]\nname = \"axle\"\nbody = \"Wheel\"\naxis = [0, 0, 1]\nlimit = {{ max = 1 }}\n{enabled}\n\
             [[constraint.torsion-spring]]\nname = \"hair\"\nof = \"axle\"\nstiffness = 1\n\
             [[constraint.limit]]\nname = \"stop\"\nof = \"axle\"\nmin = -1\n{enabled}\n"
        )
    };
    let (on, off) = (load(&text("enabled = true")), load(&text("enabled = false")));
    assert_eq!((on.constraints.len(), on.limits.len(), on.springs.len()), (3, 2, 1));
    assert_eq!((off.constraints.len(), off.limits.len(), off.springs.len()), (0, 0, 1));
    assert!(on.excluded_pairs.len() > off.excluded_pairs.len(), "what does not hold may collide");
    let output = soffio::commands::explain::explain(&off);
    assert!(output.contains("it is not active"), "{output}");
    assert!(try_load(&text("enabled = 1")).is_err());
}

#[test]
fn a_constraint_may_assemble_at_its_own_pace() {
    let own = load(
        "[[constraint.nail]]\nname = \"slow\"\nbody = \"Arm\"\nto = [0.1, 1, -0.2]\n\
         stabilize = { time_constant = \"300 ms\" }\n\
         [[constraint.nail]]\nname = \"fast\"\nbody = \"Weight\"\nto = [0, 0.5, 0]\n",
    );
    let times: Vec<Option<f64>> = own.constraints.iter().map(|c| c.stabilization_time).collect();
    assert_eq!(times, [Some(0.3), None]);
    let output = soffio::commands::explain::explain(&own);
    assert!(output.contains("0.3 s"), "{output}");
    let spring = "[[constraint.spring]]\nname = \"leaf\"\na = { node = \"Weight\" }\nb = { node = \"Rail\" }\n\
                  stiffness = 12\nstabilize = { time_constant = 1 }\n";
    assert_eq!(try_load(spring).expect_err("a problem").diagnostics[0].code, codes::WRONG_SHAPE.name);
    let still = "[[constraint.nail]]\nname = \"slow\"\nbody = \"Arm\"\nto = [0.1, 1, -0.2]\nstabilize = { time_constant = 0 }\n";
    assert!(try_load(still).is_err());
}

#[test]
fn a_weight_falls_by_the_cord_that_its_drum_pays_out() {
    for pulleys in [1, 2] {
        let exhibit = load(&format!(
            "[[constraint.gear-weight]]\nname = \"cord\"\ngear = {{ body = \"Arm\", axis = [0, 1, 0], radius = \"20 mm\" }}\n\
             weight = {{ body = \"Weight\", direction = [0, -1, 0] }}\npulleys = {pulleys}\n"
        ));
        let mut all = [Twist::NONE; 3];
        all[ARM] = Twist { turn: 2.0 * DVec3::Y, ..Twist::NONE };
        all[WEIGHT] = Twist { way: -0.04 / f64::from(pulleys) * DVec3::Y, ..Twist::NONE };
        assert!(worst(&exhibit, all) < SINGLE, "{pulleys} cords");
        all[WEIGHT].way *= -1.0;
        assert!(worst(&exhibit, all) > FELT);
    }
}

#[test]
fn an_element_frees_or_holds_one_freedom() {
    let hinge = "[[constraint.hinge]]\nname = \"axle\"\nbody = \"Weight\"\naxis = [0, 0, 1]\n";
    let element = |keys: &str| load(&format!("{hinge}[[constraint.element]]\nname = \"change\"\n{keys}"));
    let at = DVec3::new(0.0, 0.5, 0.0);
    let world = [DVec3::X, DVec3::Y, DVec3::Z];
    // What is freed for ever has a window that never comes: those rows are left out here.
    for (dof, free) in [("tz", "rz tz"), ("tx", "rz tx"), ("rx", "rz rx")] {
        let mut exhibit = element(&format!("of = \"axle\"\nop = \"remove\"\ndof = \"{dof}\"\n"));
        let freed: Vec<_> = exhibit.constraints.extract_if(.., |c| c.schedule.activation(1.0, None) == 0.0).collect();
        assert_eq!(freed.len(), 1, "{dof}: {:?}", names(&exhibit));
        assert_eq!(freed[0].group(), "axle");
        check_freedoms(&exhibit, WEIGHT, at, world, free);
    }
    // Along the axes of a turned node.
    let mut exhibit = element("of = \"axle/nail\"\nop = \"remove\"\ndof = \"tx\"\nframe = { node = \"Rail\" }\n");
    exhibit.constraints.retain(|c| c.schedule.activation(1.0, None) > 0.0);
    let x = rotation(2.0 * asin(0.6) * DVec3::Z) * DVec3::X;
    check_freedoms(&exhibit, WEIGHT, at, [x, DVec3::Z.cross(x), DVec3::Z], "rz tx");

    let exhibit = element("of = \"axle\"\nop = \"add\"\ndof = \"rz\"\nvalue = { keys = [[0, 0], [1, \"10 deg\"]] }\n");
    check_freedoms(&exhibit, WEIGHT, at, world, "");
    let turned = one(WEIGHT, Twist { about: at, turn: PI / 18.0 * DVec3::Z, ..Twist::NONE });
    assert!(values(&exhibit, turned, 2.0).iter().all(|x| x.abs() < SINGLE), "the added turn follows its value");
    for frame in ["\"world\"", "\"body\""] {
        let text = "[[constraint.element]]\nname = \"lift\"\nbody = \"Weight\"\nop = \"add\"\ndof = \"ty\"\n";
        let exhibit = load(&format!("{text}frame = {frame}\nvalue = {{ keys = [[0, 0], [1, 0.2]] }}\n"));
        let raised = one(WEIGHT, Twist { way: 0.2 * DVec3::Y, ..Twist::NONE });
        assert!(values(&exhibit, raised, 1.0)[0].abs() < SINGLE, "{frame}");
        check_freedoms(&exhibit, WEIGHT, at, world, "tx tz rx ry rz");
    }
}

#[test]
fn limits_bound_rotations_displacements_tilts_and_distances() {
    let text = "[[constraint.hinge]]\nname = \"arbor\"\nbody = \"Wheel\"\naxis = [0, 0, 1]\n\
                limit = { min = \"-6 deg\", max = \"6 deg\", restitution = 0.1 }\n\
                [[constraint.slider]]\nname = \"rod\"\nbody = \"Weight\"\naxis = [0, 1, 0]\n\
                [[constraint.limit]]\nname = \"drop\"\nof = \"rod\"\nmin = \"-40 cm\"\n\
                [[constraint.limit]]\nname = \"cord\"\na = { node = \"Arm\", at = \"Tip\" }\nb = { node = \"Rail\" }\nmax = 2\n\
                [[constraint.limit]]\nname = \"lean\"\na = { node = \"Arm\" }\naxis = [0, 1, 0]\ntilt = true\nmax = \"12 deg\"\n\
                [[constraint.ratchet]]\nname = \"click\"\nof = \"arbor\"\nteeth = 30\nreverse = true\n";
    let exhibit = load(text);
    let limit = |name: &str| exhibit.limits.iter().find(|l| l.name == name).expect("a limit");
    let LimitKind::Range { measure: Measure::Angle { axis, frame: None }, min, max } = limit("arbor").kind else {
        panic!("not a turn")
    };
    assert_eq!(axis.body, Some(WHEEL));
    assert!((min + PI / 30.0).abs() < SINGLE && (max - PI / 30.0).abs() < SINGLE && limit("arbor").restitution == 0.1);
    let LimitKind::Range { measure: Measure::Displacement { direction, .. }, min, max } = limit("drop").kind else {
        panic!("not a way")
    };
    assert!((min + 0.4).abs() < SINGLE && max == f64::INFINITY && direction.direction.distance(DVec3::Y) < SINGLE);
    assert!(matches!(limit("cord").kind, LimitKind::Distance { min: 0.0, max: 2.0, .. }));
    let LimitKind::Tilt { b, max, .. } = limit("lean").kind else { panic!("not a tilt") };
    assert!(b.direction.distance(DVec3::Y) < SINGLE && (max - PI / 15.0).abs() < SINGLE);
    let slips =
        load(&text.replace("teeth = 30\nreverse = true\n", "torque = \"3 mN m\"\n").replace("ratchet", "clutch"));
    let clutch = slips.constraints.iter().find(|c| c.name == "click").expect("a clutch");
    assert!(clutch.slips.is_some_and(|torque| (torque - 3e-3).abs() < SINGLE), "{clutch:?}");
    let LimitKind::Ratchet { measure: Measure::Angle { axis: other, .. }, pitch } = limit("click").kind else {
        panic!("not a ratchet")
    };
    assert!((pitch - PI / 15.0).abs() < SINGLE && other.direction.distance(-axis.direction) < SINGLE);
}

#[test]
fn springs_of_both_kinds_take_functions() {
    let text = "[[constraint.hinge]]\nname = \"arbor\"\nbody = \"Wheel\"\naxis = [0, 0, 1]\n\
                [[constraint.torsion-spring]]\nname = \"suspension\"\nof = \"arbor\"\nstiffness = \"2 N mm/rad\"\n\
                rest_angle = { keys = [[0, 0], [1, \"90 deg\"]] }\n\
                [[constraint.spring]]\nname = \"leaf\"\na = { node = \"Weight\" }\nb = { node = \"Rail\" }\n\
                stiffness = { keys = [[0, 12], [5, 20]], interpolation = \"linear\" }\ndamping = 0.05\n";
    let exhibit = load(text);
    let spring = |name: &str| exhibit.springs.iter().find(|s| s.name == name).expect("a spring");
    let twist = spring("suspension");
    assert!(matches!(twist.kind, SpringKind::Angular { measure: Measure::Angle { .. } }));
    assert!(
        (twist.stiffness.at(0.0).value - 2e-3).abs() < SINGLE
            && (twist.rest_length.at(1.0).value - PI / 2.0).abs() < SINGLE
    );
    let leaf = spring("leaf");
    // From (0, 0.5, 0) to (0.4, 0.3, 0.2).
    assert!((leaf.rest_length.at(3.0).value - 0.24_f64.sqrt()).abs() < SINGLE);
    assert_eq!((leaf.stiffness.at(2.5).value, leaf.damping.at(0.0).value), (16.0, 0.05));
}

#[test]
fn a_ring_of_hinges_loads_and_names_the_rows_that_repeat_others() {
    // Two welds and a hinge, five rows too many; a ring that is held just once is no cause to warn.
    let ring = "[[constraint.weld]]\nname = \"first\"\nbody = \"Arm\"\n\
                [[constraint.weld]]\nname = \"second\"\nbody = \"Weight\"\nto = { node = \"Arm\", at = [0.02, 0, 0.6] }\n\
                [[constraint.hinge]]\nname = \"third\"\nbody = \"Weight\"\naxis = [0, 0, 1]\n[solver]\nassemble = true\n";
    let warned = load(ring);
    let warning = warned.warnings.iter().find(|w| w.code == codes::REDUNDANT.name).expect("a warning");
    for part in ["\"second/nail\" (3 rows)", "\"second/about-x\"", "\"second/about-y\" are redundant"] {
        assert!(warning.message.contains(part), "{}", warning.message);
    }
    let open = "[[constraint.nail]]\nname = \"first\"\nbody = \"Arm\"\nto = [0.1, 1, -0.2]\n\
                [[constraint.point-to-point]]\nname = \"second\"\na = { node = \"Weight\" }\nb = { node = \"Arm\", at = [0, 0, 0.3] }\n\
                [[constraint.line]]\nname = \"third\"\nbody = \"Weight\"\ndirection = [1, 0, 0]\n[solver]\nassemble = true\n";
    assert!(load(open).warnings.is_empty(), "{:?}", load(open).warnings);
}

#[test]
fn rows_that_take_turns_do_not_repeat_each_other() {
    let orientation = |name: &str, axis: &str, world: &str, window: &str| {
        format!(
            "[[constraint.orientation]]\nname = \"{name}\"\nbody = \"Weight\"\nbody_axis = {axis}\n\
             world_axis = {world}\nwindow = {window}\n"
        )
    };
    let (x, y, z) = ("[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]");
    let text = |second: &str| {
        let first = "{ end = 2.5 }";
        let rows = [orientation("x-z", x, z, first), orientation("y-z", y, z, first)];
        let later = [orientation("x-y", x, y, second), orientation("z-y", z, y, second)];
        [rows.concat(), later.concat()].concat()
    };
    assert!(load(&text("{ start = 2.5 }")).warnings.is_empty());
    let both = load(&text("{ start = 1 }"));
    let warned: Vec<&str> = both.warnings.iter().map(|w| w.code).collect();
    assert_eq!(warned, [codes::REDUNDANT.name], "{:?}", both.warnings);
}

#[test]
fn explain_shows_the_expansion_with_its_line() {
    let exhibit = load("[[constraint.hinge]]\nname = \"axle\"\nbody = \"Wheel\"\naxis = [0, 0, 1]\n");
    let text = soffio::commands::explain::explain(&exhibit);
    for part in [
        "constraint axle\n",
        "5 rows: axle/nail, axle/across-1, axle/across-2",
        "exhibit.toml:12",
        "constraint axle/nail",
    ] {
        assert!(text.contains(part), "{part} is missing in\n{text}");
    }
}

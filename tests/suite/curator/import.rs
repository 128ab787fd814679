//! Import of models: a model's physics moves as in the engine, and everything that the sidecar cannot express is
//! reported.

use std::sync::Arc;

use serde_json::{Value, json};
use soffio_authoring::{ExhibitFolder, FolderFile, imported};
use soffio_exhibit::{self as exhibit, Exhibit, codes};
use soffio_math::noise::Random;
use soffio_math::{DVec3, PI};
use soffio_multibody::articulation::ConstraintKind;
use soffio_simulation::{Settings, Simulation, StepInput};

use super::super::exhibit::glb::{Folder, Scene, assemble, cuboid, sheet};

/// Single precision of a file.
const SINGLE: f64 = 1e-6;
/// Two runs of the same figure, written in two ways: rounding of 240 steps a second for some seconds, m.
const SAME: f64 = 1e-9;

fn physics(node: Value) -> Value {
    json!({ "KHR_physics_rigid_bodies": node })
}

/// Puts shapes, materials and joints at the top of a model.
fn top(scene: &mut Scene, shapes: Value, lists: Value) {
    scene.extra.push(("extensionsUsed", json!(["KHR_implicit_shapes", "KHR_physics_rigid_bodies"])));
    scene.extra.push(("extensionsRequired", json!(["KHR_physics_rigid_bodies"])));
    scene.extra.push((
        "extensions",
        json!({ "KHR_implicit_shapes": { "shapes": shapes }, "KHR_physics_rigid_bodies": lists }),
    ));
}

fn made(model: &[u8]) -> (tempfile::TempDir, ExhibitFolder) {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let path = folder.path().join("model.glb");
    std::fs::write(&path, model).expect("writable");
    let made = imported::folder(&path, "taken").unwrap_or_else(|report| panic!("{}", report.to_text()));
    for FolderFile { name, bytes } in &made.files {
        std::fs::write(folder.path().join(name), bytes).expect("writable");
    }
    (folder, made)
}

fn sidecar(made: &ExhibitFolder) -> String {
    let FolderFile { bytes, .. } = made.files.iter().find(|file| file.name == "exhibit.toml").expect("a sidecar");
    String::from_utf8(bytes.clone()).expect("UTF-8")
}

fn loaded(model: &[u8]) -> (ExhibitFolder, Exhibit) {
    let (folder, made) = made(model);
    let exhibit =
        exhibit::load(folder.path()).unwrap_or_else(|report| panic!("{}\n{}", report.to_text(), sidecar(&made)));
    (made, exhibit)
}

/// A bob at the side of its pin: a child of it is the joint's node.
fn pendulum(swapped: bool) -> Vec<u8> {
    let mut scene = Scene::default();
    let eye = scene.node("Eye", [-0.2, 0.2, 0.0], None, &[]);
    let bob = scene.node("Bob", [0.2, 0.8, 0.0], Some(&cuboid([0.05, 0.04, 0.03])), &[eye]);
    let pin = scene.node("Pin", [0.0, 1.0, 0.0], None, &[]);
    let motion = json!({
        "mass": 0.5, "centerOfMass": [0.0, 0.0, 0.0], "inertiaDiagonal": [1e-3, 2e-3, 1.5e-3],
        "angularVelocity": [0.0, 0.0, 0.4], "linearVelocity": [0.08, 0.08, 0.0],
    });
    scene.set(bob, "extensions", physics(json!({ "motion": motion })));
    let (own, other) = if swapped { (pin, eye) } else { (eye, pin) };
    scene.set(own, "extensions", physics(json!({ "joint": { "connectedNode": other, "joint": 0 } })));
    let limits = json!([
        { "linearAxes": [0, 1, 2], "max": 0.0 },
        { "angularAxes": [0, 1], "min": 0.0, "max": 0.0 },
        { "angularAxes": [2], "min": -0.3, "max": 1.2 },
    ]);
    top(&mut scene, json!([]), json!({ "physicsJoints": [{ "limits": limits }] }));
    scene.glb()
}

/// Where a body is in the world after each step of some seconds.
fn run(exhibit: Exhibit, seconds: usize) -> Vec<DVec3> {
    let settings = Settings { wind: false, friction: false, ..Settings::default() };
    let mut simulation = Simulation::new(Arc::new(exhibit), settings);
    (0..seconds * 240)
        .map(|_| {
            simulation.step(&StepInput::default());
            simulation.bodies()[0].position
        })
        .collect()
}

#[test]
fn a_pendulum_by_the_models_joint_moves_as_our_own() {
    for swapped in [false, true] {
        let (made, exhibit) = loaded(&pendulum(swapped));
        assert!(made.remarks.is_empty(), "{:?}", made.remarks);
        assert!(sidecar(&made).contains("[[constraint.hinge]]"));
        assert!((exhibit.bodies[0].properties.mass - 0.5).abs() < SINGLE);
        // Ours by hand. The model's angle is that of the connected node against the joint's: of the pin, unless swapped.
        let (min, max) = if swapped { (-0.3, 1.2) } else { (-1.2, 0.3) };
        let own = format!(
            "[[body]]\nnode = \"Bob\"\nmass = 0.5\nmaterial = \"beech\"\ninertia = {{ diagonal = [1e-3, 2e-3, 1.5e-3] }}\n\
             center_of_mass = [0, 0, 0]\ninitial = {{ velocity = [0.08, 0.08, 0], angular_velocity = [0, 0, 0.4] }}\n\
             [[constraint.hinge]]\nname = \"own\"\nbody = \"Bob\"\nat = \"Eye\"\naxis = [0, 0, 1]\nto = {{ node = \"Pin\" }}\n\
             limit = {{ min = {min}, max = {max} }}\n"
        );
        let folder = Folder::exhibit(&pendulum(swapped), &own);
        let ours = exhibit::load(folder.path()).unwrap_or_else(|report| panic!("{}", report.to_text()));
        let (theirs, ours) = (run(exhibit, 6), run(ours, 6));
        let apart = theirs.iter().zip(&ours).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        let swung = theirs.iter().map(|p| p.distance(theirs[0])).fold(0.0, f64::max);
        println!("swapped {swapped}: {apart:.1e} m apart in 6 s, swung by {swung:.3} m");
        assert!(apart < SAME, "swapped {swapped}: {apart} m apart");
        assert!(swung > 0.05, "it hangs still: {swung} m");
        let joint = theirs.iter().map(|p| (p.distance(DVec3::Y) - 0.08_f64.sqrt()).abs()).fold(0.0, f64::max);
        assert!(joint < SINGLE, "the pin lets it go by {joint} m");
    }
}

/// Degrees of freedom that a basic constraint takes.
fn rows_of(kind: &ConstraintKind) -> usize {
    if matches!(kind, ConstraintKind::PointToPoint { .. }) { 3 } else { 1 }
}

#[test]
fn locked_axes_name_the_joint() {
    let all = json!({ "linearAxes": [0, 1, 2], "max": 0.0 });
    let turns = |axes: &[usize]| json!({ "angularAxes": axes, "min": 0.0, "max": 0.0 });
    let ways = |axes: &[usize]| json!({ "linearAxes": axes, "min": 0.0, "max": 0.0 });
    // Kind, and the rows that it takes from a body.
    let cases = [
        (vec![all.clone()], "point-to-point", 3),
        (vec![all.clone(), turns(&[0, 2])], "hinge", 5),
        (vec![all.clone(), turns(&[0]), turns(&[2])], "hinge", 5),
        (vec![all.clone(), turns(&[1])], "universal", 4),
        (vec![all.clone(), turns(&[0, 1, 2])], "weld", 6),
        (vec![ways(&[0, 2]), turns(&[0, 1, 2])], "slider", 5),
        (vec![ways(&[0]), ways(&[1])], "line", 2),
        (vec![ways(&[1])], "point-on-plane", 1),
        (vec![turns(&[0])], "orientation", 1),
        (vec![turns(&[0, 1])], "orientation", 2),
        (vec![ways(&[0]), turns(&[2])], "point-on-plane", 2),
        (vec![turns(&[0, 1, 2])], "orientation", 3),
    ];
    for (limits, kind, rows) in cases {
        let mut scene = Scene::default();
        let mark = scene.node("Mark", [0.1, 0.0, 0.0], None, &[]);
        let body = scene.node("Body", [0.0, 1.0, 0.0], Some(&cuboid([0.1, 0.2, 0.05])), &[mark]);
        let fixed = scene.node("Fixed", [0.1, 1.0, 0.0], None, &[]);
        scene.set(body, "extensions", physics(json!({ "motion": { "mass": 1.0 } })));
        scene.set(mark, "extensions", physics(json!({ "joint": { "connectedNode": fixed, "joint": 0 } })));
        top(&mut scene, json!([]), json!({ "physicsJoints": [{ "limits": limits }] }));
        let (made, exhibit) = loaded(&scene.glb());
        let text = sidecar(&made);
        assert!(text.contains(&format!("[[constraint.{kind}]]")), "{kind}:\n{text}");
        let held: usize = exhibit.constraints.iter().map(|c| rows_of(&c.kind)).sum();
        assert_eq!(held, rows, "{kind}");
        assert!(exhibit.warnings.is_empty(), "{kind}: {}", exhibit.warning_report().to_text());
    }
}

#[test]
fn shapes_weigh_by_their_volume_and_collide_at_their_scale() {
    // In a node of twice the size: lengths double. Expected: volume (m³) and a principal moment over the mass (m²).
    let (r, h) = (0.2_f64, 0.6_f64);
    let capsule = PI * r * r * h + 4.0 / 3.0 * PI * r * r * r;
    let cases = [
        (json!({ "type": "sphere", "sphere": { "radius": 0.1 } }), 4.0 / 3.0 * PI * r * r * r, 0.4 * r * r),
        (json!({ "type": "box", "box": { "size": [0.1, 0.2, 0.3] } }), 0.2 * 0.4 * 0.6, (0.04 + 0.16) / 12.0),
        (
            json!({ "type": "cylinder", "cylinder": { "height": 0.3, "radiusTop": 0.1, "radiusBottom": 0.1 } }),
            PI * r * r * h,
            0.5 * r * r,
        ),
        (
            json!({ "type": "capsule", "capsule": { "height": 0.3, "radiusTop": 0.1, "radiusBottom": 0.1 } }),
            capsule,
            (PI * r * r * h * 0.5 * r * r + 4.0 / 3.0 * PI * r * r * r * 0.4 * r * r) / capsule,
        ),
    ];
    for (shape, volume, moment) in cases {
        let mut scene = Scene::default();
        let body = scene.node("Body", [0.0, 1.0, 0.0], None, &[]);
        scene.set(body, "scale", json!([2.0, 2.0, 2.0]));
        scene.set(body, "extensions", physics(json!({ "motion": {}, "collider": { "geometry": { "shape": 0 } } })));
        top(&mut scene, json!([shape]), json!({}));
        let (_, exhibit) = loaded(&scene.glb());
        let own = &exhibit.bodies[0].properties;
        assert!((own.mass / (1000.0 * volume) - 1.0).abs() < SINGLE, "{shape}: {} kg", own.mass);
        let d = [own.inertia.x_axis.x, own.inertia.y_axis.y, own.inertia.z_axis.z].map(|i| i / own.mass);
        assert!(d.iter().any(|i| (i / moment - 1.0).abs() < SINGLE), "{shape}: {d:?}, not {moment}");
        assert_eq!(exhibit.colliders.len(), 1);
    }
}

#[test]
fn materials_combine_as_the_model_says_and_filters_keep_apart() {
    let mut scene = Scene::default();
    let collider = |material: usize, filter: usize| json!({ "geometry": { "shape": 0 }, "physicsMaterial": material, "collisionFilter": filter });
    for (i, name) in ["One", "Two", "Three"].into_iter().enumerate() {
        let node = scene.node(name, [i as f32, 1.0, 0.0], None, &[]);
        let own = json!({ "motion": {}, "collider": collider(i.min(1), i.min(1)) });
        scene.set(node, "extensions", physics(own));
    }
    let lists = json!({
        "physicsMaterials": [
            { "dynamicFriction": 0.2, "restitution": 0.5, "restitutionCombine": "maximum" },
            { "dynamicFriction": 0.6, "restitution": 0.9, "frictionCombine": "multiply", "restitutionCombine": "maximum" },
        ],
        "collisionFilters": [
            { "collisionSystems": ["a"], "notCollideWithSystems": ["b"] },
            { "collisionSystems": ["b"] },
        ],
    });
    top(&mut scene, json!([{ "type": "sphere", "sphere": { "radius": 0.1 } }]), lists);
    let (_, exhibit) = loaded(&scene.glb());
    let surface = exhibit.surface_pair(soffio_multibody::collision::ColliderPair { a: 0, b: 1 });
    // The average rule is the default of the other, and goes before: (0.2 + 0.6)/2; the greater of 0.5 and 0.9.
    assert!((surface.friction - 0.4).abs() < SINGLE && (surface.restitution - 0.9).abs() < SINGLE, "{surface:?}");
    let own = exhibit.surface_pair(soffio_multibody::collision::ColliderPair { a: 1, b: 2 });
    assert!((own.friction - 0.36).abs() < SINGLE, "{own:?}");
    let apart: Vec<_> = exhibit.excluded_pairs.iter().map(|e| e.bodies).collect();
    assert_eq!(apart, [(Some(0), Some(1)), (Some(0), Some(2))]);
}

#[test]
fn unsupported_content_is_reported_node_by_node() {
    let mut scene = Scene::default();
    let fixed = scene.node("Fixed", [0.0, 2.0, 0.0], None, &[]);
    let mut body = |name: &str, at: f32, own: Value| {
        let node = scene.node(name, [at, 1.0, 0.0], Some(&cuboid([0.1; 3])), &[]);
        scene.set(node, "extensions", physics(own));
    };
    body("Still", 0.0, json!({ "motion": { "isKinematic": true } }));
    body("Heavy", 1.0, json!({ "motion": { "mass": 0 } }));
    body("Light", 2.0, json!({ "motion": { "mass": 1, "gravityFactor": 0.5, "inertiaDiagonal": [0, 1, 1] } }));
    body("Alarm", 3.0, json!({ "trigger": { "geometry": { "shape": 0 } } }));
    body("Tapered", 4.0, json!({ "motion": {}, "collider": { "geometry": { "shape": 0 } } }));
    body("Mesh", 5.0, json!({ "motion": { "mass": 1 }, "collider": { "geometry": { "node": 6 } } }));
    body(
        "Joined",
        6.0,
        json!({ "motion": { "mass": 1 }, "joint": { "connectedNode": fixed, "joint": 0, "enableCollision": true } }),
    );
    body("Lost", 7.0, json!({ "motion": { "mass": 1 }, "joint": { "connectedNode": 99, "joint": 0 } }));
    body("Floor", 8.0, json!({ "collider": { "geometry": { "shape": 1 } } }));
    let limits = json!([
        { "linearAxes": [0, 1, 2], "max": 0.0, "stiffness": 10.0 },
        { "angularAxes": [0, 2], "min": 0.0, "max": 0.5 },
    ]);
    let drives = json!([{ "type": "linear", "axis": 0, "stiffness": 1.0 }]);
    let shapes = json!([
        { "type": "cylinder", "cylinder": { "height": 0.1, "radiusTop": 0.01, "radiusBottom": 0.03 } },
        { "type": "plane", "plane": { "sizeX": 3.0, "sizeZ": 3.0 } },
    ]);
    top(&mut scene, shapes, json!({ "physicsJoints": [{ "limits": limits, "drives": drives }] }));
    let (made, exhibit) = loaded(&scene.glb());
    for (node, words) in [
        ("Still", "kinematic"),
        ("Heavy", "infinite mass"),
        ("Light", "gravityFactor"),
        ("Light", "infinite moment"),
        ("Alarm", "trigger"),
        ("Tapered", "wide at one end"),
        ("Mesh", "convex hull"),
        ("Joined", "do not collide"),
        ("Joined", "soft limit"),
        ("Joined", "a cone"),
        ("Joined", "m apart"),
        ("Joined", "other than a spring about a hinge"),
        ("Lost", "connects nothing"),
        ("Floor", "infinite"),
    ] {
        let start = format!("node \"{node}\": ");
        let output = made.remarks.iter().any(|remark| remark.starts_with(&start) && remark.contains(words));
        assert!(output, "{node}: {words}\n{:#?}", made.remarks);
        // And it stands in the file, where the curator works.
        assert!(sidecar(&made).contains(words), "{words}");
    }
    // The open joint is closed by the stabilisation.
    assert!(sidecar(&made).contains("assemble = true") && exhibit.bodies.len() == 5);
}

#[test]
fn a_plain_model_gets_bodies_that_hang_and_swing() {
    let mut scene = Scene::default();
    let cup = scene.node("Cup", [0.0, 1.0, 0.0], Some(&cuboid([0.1, 0.2, 0.1])), &[]);
    let leaf = scene.node("Leaf", [0.5, 1.0, 0.0], Some(&sheet(0.2, 0.1)), &[]);
    let stand = scene.node("Big stand", [1.5, 0.5, 0.0], Some(&cuboid([0.4, 1.0, 0.4])), &[]);
    scene.node("Scene", [0.0; 3], None, &[cup, leaf, stand]);
    let (made, exhibit) = loaded(&scene.glb());
    let names: Vec<&str> = exhibit.bodies.iter().map(|body| body.name.as_str()).collect();
    assert_eq!(names, ["Cup", "Leaf"], "{:?}", made.remarks);
    assert!((exhibit.bodies[0].properties.mass - 2e-3 * 2700.0).abs() < SINGLE * 5.4);
    assert!((exhibit.bodies[1].properties.mass - 0.02 * 1e-3 * 2700.0).abs() < SINGLE);
    assert!(made.remarks.iter().any(|r| r.contains("Big stand") && r.contains("is fixed")), "{:?}", made.remarks);
    let start = exhibit.bodies[1].pose.position;
    let end = run(exhibit, 5);
    assert!(end.iter().all(|p| p.distance(end[0]) < 1e-6), "what hangs above its centre is at rest");
    assert!(start.is_finite());
}

#[test]
fn files_beside_a_model_come_along() {
    let mut scene = Scene::default();
    scene.node("Thing", [0.0, 1.0, 0.0], Some(&cuboid([0.1; 3])), &[]);
    // The same model as JSON with its buffer beside it, under a name with a space.
    let glb = scene.glb();
    let length = u32::from_le_bytes(glb[12..16].try_into().expect("four bytes")) as usize;
    let mut json: Value = serde_json::from_slice(&glb[20..20 + length]).expect("JSON");
    json["buffers"][0]["uri"] = json!("data/my%20buffer.bin");
    let folder = tempfile::tempdir().expect("a temporary folder");
    std::fs::create_dir(folder.path().join("data")).expect("writable");
    std::fs::write(folder.path().join("data/my buffer.bin"), &glb[28 + length..]).expect("writable");
    let path = folder.path().join("thing.gltf");
    std::fs::write(&path, json.to_string()).expect("writable");
    let made = imported::folder(&path, "thing").unwrap_or_else(|report| panic!("{}", report.to_text()));
    let names: Vec<&str> = made.files.iter().map(|file| file.name.as_str()).collect();
    assert_eq!(names, ["data/my buffer.bin", "thing.gltf", "exhibit.toml"]);
    // Nothing outside the model's folder is read.
    json["buffers"][0]["uri"] = json!("../secret.bin");
    std::fs::write(&path, json.to_string()).expect("writable");
    let report = imported::folder(&path, "thing").expect_err("outside");
    assert!(report.has(codes::OUTSIDE), "{}", report.to_text());
}

#[test]
fn no_physics_however_wrong_stops_the_import() {
    let junk = [
        json!(null),
        json!(-1),
        json!(1e300),
        json!("x"),
        json!([]),
        json!({}),
        json!([1e308, "a"]),
        json!(true),
        json!([0, 0, 0]),
        json!(99),
    ];
    let good = pendulum(false);
    let length = u32::from_le_bytes(good[12..16].try_into().expect("four bytes")) as usize;
    let json: Value = serde_json::from_slice(&good[20..20 + length]).expect("JSON");
    let binary = &good[28 + length..];
    let mut random = Random::new(11);
    let mut pick = |n: usize| ((random.unit() * n as f64) as usize).min(n - 1);
    let (mut taken, mut refused) = (0, 0);
    for _ in 0..200 {
        let mut json = json.clone();
        // A value somewhere below an extension.
        let mut at = if pick(2) == 0 { &mut json["extensions"] } else { &mut json["nodes"] };
        for depth in 0..8 {
            let count = at.as_object().map(|o| o.len()).or(at.as_array().map(Vec::len)).unwrap_or(0);
            if count == 0 || (depth > 3 && pick(4) == 0) {
                break;
            }
            let k = pick(count);
            at = match at {
                Value::Object(map) => map.values_mut().nth(k).expect("counted"),
                Value::Array(list) => &mut list[k],
                other => other,
            };
        }
        *at = junk[pick(junk.len())].clone();
        let folder = tempfile::tempdir().expect("a temporary folder");
        let path = folder.path().join("model.glb");
        std::fs::write(&path, assemble(json.to_string().into_bytes(), binary.to_vec())).expect("writable");
        match imported::folder(&path, "taken") {
            Ok(made) => {
                let text = sidecar(&made);
                assert!(text.parse::<toml::Table>().is_ok(), "not TOML:\n{text}");
                taken += 1;
            }
            Err(report) => {
                assert!(report.has_errors());
                refused += 1;
            }
        }
    }
    println!("{taken} taken over, {refused} refused");
    assert!(taken > 50, "{taken} taken over");
}

#[test]
fn sixty_thousand_nodes_are_proposed_in_linear_time() {
    /// Processor time, s; comparing every node with every other took minutes.
    const LIMIT: f64 = 4.0;
    let positions: Vec<u8> =
        [0.0_f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0].iter().flat_map(|x| x.to_le_bytes()).collect();
    for (length, chains) in [(1, 60_000), (1000, 60)] {
        let node = |i: usize| match (i + 1) % length {
            0 => json!({ "name": format!("n{i}"), "mesh": 0 }),
            _ => json!({ "name": format!("n{i}"), "children": [i + 1] }),
        };
        let model = json!({
            "asset": { "version": "2.0" },
            "nodes": (0..length * chains).map(node).collect::<Vec<_>>(),
            "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 } }] }],
            "accessors": [{
                "bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0],
            }],
            "bufferViews": [{ "buffer": 0, "byteLength": 36 }],
            "buffers": [{ "byteLength": 36 }],
        });
        let start = cpu_time::ThreadTime::now();
        let (_folder, made) = made(&assemble(model.to_string().into_bytes(), positions.clone()));
        let took = start.elapsed().as_secs_f64();
        assert!(took < LIMIT, "{length} × {chains}: {took} s");
        let bodies = sidecar(&made).matches("[[body]]").count();
        assert!((1..=256).contains(&bodies), "{length} × {chains}: {bodies} bodies");
    }
}

//! Sidecars over one small model: a frame, a boom with a lead weight, a hanging plate.
//!
//! Bad ones stand in `tests/cases/exhibit-bad/*.toml`; the first line of each names the codes and lines to be found,
//! all of them and no others: `# expect E0207:7 E0102:9`. Warnings are counted where one is expected: `# expect W0407:12`.

use std::path::PathBuf;

use soffio_detector::BlowDetector;
use soffio_exhibit::{self as exhibit, AttractAction, Diagnostic, Exhibit, ImpactFrame, Report, codes};
use soffio_geometry::support::Core;
use soffio_math::{DVec3, PI};
use soffio_multibody::articulation::{ConstraintKind, LimitKind};
use soffio_multibody::collision::{Collider, ColliderPair, Excluded};
use soffio_multibody::dynamics::RollingResistance;
use soffio_wind::SurfaceShape;

use super::glb::{Folder, Scene, boom_and_plate as model, cuboid};

/// glTF holds single precision: seven digits.
const SINGLE: f64 = 1e-6;

fn load(sidecar: &str) -> Result<Exhibit, Report> {
    let folder = Folder::exhibit(&model(), sidecar);
    exhibit::load(folder.path())
}

const GOOD: &str = r##"
[material.steel]
loss_factor = 1e-3
[[body]]
node = "Boom"
material = "steel"
x_studio = { note = "keys of others are theirs" }
[[body.part]]
node = "Weight"
material = "lead"
[[body]]
node = "Plate"
material = "aluminium"
initial = { angular_velocity = [0, "30 deg/s", 0] }
[[wire]]
name = "rod"
body = "Boom"
points = ["End", [0, 0, 0], "Tip"]
diameter = "2 mm"
material = "steel"
color = "#ff0000"
collide = true
[[constraint.nail]]
name = "pivot"
body = "Boom"
to = [0, 1, 0]
limit = { axis = [0, 1, 0], max = "12 deg" }
friction = { coefficient = 0.2, radius = "0.3 mm" }
[[constraint.point-to-point]]
name = "hook"
a = { node = "Plate", at = "Hook" }
b = { node = "Boom", at = "Tip" }
[[collider]]
node = "Plate"
shape = { fit = "plate" }
[collision]
groups = { still = ["Post"] }
exclude = [["Plate", "group:still"]]
[[wind_surface]]
node = "Plate"
[[sound]]
name = "ring"
body = "Plate"
on = "impact"
timbre = "plate"
gain = "-6 dB"
caption = "rings"
[[attract.step]]
at = 1
show = "invite"
[[attract.step]]
at = "1.5 s"
reset = true
[label.en]
title = "A test"
alt = "A rod and a plate."
text = { invite = "Blow" }
caption = { rings = "[rings]" }
"##;

fn good() -> Exhibit {
    load(GOOD).unwrap_or_else(|report| panic!("{}", report.to_text()))
}

#[test]
fn masses_are_volumes_and_wires_times_densities() {
    let exhibit = good();
    let rod = PI * 1e-6 * 1.0 * 7850.0;
    let weight = 8e-6 * 11300.0;
    let boom = &exhibit.bodies[0].properties;
    assert!((boom.mass - rod - weight).abs() < SINGLE * weight, "{}", boom.mass);
    assert!((boom.center.x + 0.4 * weight / (rod + weight)).abs() < SINGLE);
    // About the boom's own origin: a slender rod and a cube on its arm.
    let about = boom.inertia_about(DVec3::ZERO).z_axis.z;
    let expected = rod / 12.0 + rod * 1e-6 / 4.0 + weight * (0.16 + 2.0 * 0.02 * 0.02 / 12.0);
    assert!((about - expected).abs() < SINGLE * expected, "{about} {expected}");
    let plate = &exhibit.bodies[1];
    assert!((plate.properties.mass - 2e-5 * 2700.0).abs() < SINGLE);
    assert!((plate.angular_velocity.y - PI / 6.0).abs() < SINGLE);
}

#[test]
fn joints_get_anchors_axes_and_limits_in_body_frames() {
    let exhibit = good();
    let by_name = |name: &str| exhibit.constraints.iter().find(|c| c.name == name).expect("a constraint");
    let ConstraintKind::PointToPoint { a, b } = &by_name("hook").kind else { panic!("not a point") };
    assert_eq!((a.body, b.body), (Some(1), Some(0)));
    assert!(
        a.point.distance(DVec3::new(0.0, 0.1, 0.0)) < SINGLE && b.point.distance(DVec3::new(0.5, 0.0, 0.0)) < SINGLE
    );
    let limit = exhibit.limits.iter().find(|limit| limit.name == "pivot").expect("a limit");
    let LimitKind::Tilt { a, b, max } = limit.kind else { panic!("not a tilt") };
    assert_eq!((a.body, b.body), (Some(0), None));
    assert!((max - PI / 15.0).abs() < SINGLE && b.direction.distance(DVec3::Y) < SINGLE);
    let excluded: Vec<_> = exhibit.excluded_pairs.iter().map(|e| (e.bodies, e.why)).collect();
    let joined = |a, b| ((a, b), Excluded::Joined);
    assert_eq!(excluded[0], joined(None, Some(0)));
    assert!(excluded.contains(&joined(Some(0), Some(1))), "{excluded:?}");
    let mut bodies: Vec<_> = excluded.iter().map(|(bodies, _)| *bodies).collect();
    bodies.dedup();
    assert_eq!(bodies, [(None, Some(0)), (None, Some(1)), (Some(0), Some(1))]);
}

#[test]
fn a_plate_collides_as_its_outline_and_feels_the_wind_on_one_face_for_both() {
    let exhibit = good();
    let plate = exhibit.colliders.iter().find(|c| c.node == "Plate").expect("a collider");
    let Core::Hull(outline) = &plate.shape.core else { panic!("not a plate") };
    assert_eq!(outline.corners().len(), 4);
    assert!((plate.shape.radius - 5e-4).abs() < SINGLE && outline.corners().iter().all(|p| p.z.abs() < SINGLE));
    // A straight wire is one capsule, whatever the number of its points.
    assert_eq!(exhibit.colliders.iter().filter(|c| c.node == "rod").count(), 1);
    let SurfaceShape::Mesh { mesh, sheet, .. } = &exhibit.wind_surfaces[0].shape else { panic!("not a mesh") };
    assert!(*sheet && (mesh.area() - 0.02).abs() < SINGLE, "{}", mesh.area());
    assert!(matches!(&exhibit.wind_surfaces[1].shape, SurfaceShape::Wire { points, .. } if points.len() == 3));
}

#[test]
fn a_sounding_plate_is_measured() {
    let exhibit = good();
    let spec = &exhibit.instruments[0];
    assert!((spec.body.half_extents[0] - 0.1).abs() < SINGLE && (spec.body.half_extents[1] - 0.05).abs() < SINGLE);
    assert!((spec.body.thickness - 1e-3).abs() < SINGLE && (spec.body.area - 0.02).abs() < SINGLE);
    assert!((spec.gain - 0.501_187).abs() < SINGLE, "{}", spec.gain);
    let ImpactFrame { longest: long, middle: wide, center } = exhibit.sounds[0].frame;
    assert!(long.y.abs() > 1.0 - SINGLE && wide.x.abs() > 1.0 - SINGLE && center.length() < SINGLE);
}

#[test]
fn the_rest_of_the_file_arrives() {
    let exhibit = good();
    assert_eq!(exhibit.wires[0].color, [1.0, 0.0, 0.0]);
    assert_eq!(exhibit.materials.iter().find(|m| m.name == "steel").map(|m| m.loss_factor), Some(1e-3));
    assert!(matches!(exhibit.attract.steps[1].action, AttractAction::Reset) && exhibit.attract.duration == 11.5);
    assert_eq!(exhibit.labels.get("fr").map(|l| l.title.as_str()), Some("A test"));
    // The model has two nodes of one name, and nothing else is odd.
    let codes: Vec<&str> = exhibit.warnings.iter().map(|w| w.code).collect();
    assert_eq!(codes, [codes::DUPLICATE_NODE.name]);
    let mass = exhibit.origins.iter().find(|o| o.of == "body Plate" && o.key == "mass").expect("an origin");
    assert!(mass.source.starts_with("derived"), "{mass:?}");
}

#[test]
fn resistances_of_surfaces_add_unless_their_pair_says_otherwise() {
    let text = "[material.felt]\ndensity = 300\nyoungs_modulus = 1e7\nrolling_resistance = \"0.2 mm\"\nspin_resistance = 1e-4\n\
                [material.rubber]\ndensity = 900\nyoungs_modulus = 1e7\nrolling_resistance = \"0.3 mm\"\n\
                [[material_pair]]\npair = [\"felt\", \"steel\"]\nspin_resistance = \"0.5 mm\"\n\
                [[collider]]\nnode = \"Post\"\nmaterial = \"felt\"\nshape = { plane = {} }\n\
                [[collider]]\nnode = \"Plate\"\nmaterial = \"rubber\"\nshape = { sphere = { radius = 0.01 } }\n\
                [[collider]]\nnode = \"Boom\"\nmaterial = \"steel\"\nshape = { sphere = { radius = 0.01 } }\n\
                [[body]]\nnode = \"Plate\"\nmaterial = \"steel\"\n[[body]]\nnode = \"Boom\"\nmass = 1\n\
                inertia = { diagonal = [1, 1, 1] }\n";
    let exhibit = load(text).unwrap_or_else(|report| panic!("{}", report.to_text()));
    let of = |a: usize, b: usize| exhibit.surface_pair(ColliderPair { a, b }).resistance;
    let same = |found: RollingResistance, rolling: f64, spinning: f64| {
        assert!((found.rolling - rolling).abs() < 1e-12 && (found.spinning - spinning).abs() < 1e-12, "{found:?}");
    };
    same(of(0, 1), 5e-4, 1e-4);
    same(of(2, 0), 2e-4, 5e-4);
    same(of(1, 2), 3e-4, 0.0);
    // The plane faces its node's Y.
    let plane = &exhibit.colliders[0].shape;
    assert!(plane.is_plane() && plane.place.position.distance(DVec3::Y * 0.5) < SINGLE);
    assert!((plane.place.rotation * DVec3::Y).distance(DVec3::Y) < SINGLE);
}

#[test]
fn an_open_sheet_weighs_by_its_thickness() {
    let text = "[[body]]\nnode = \"Flag\"\nmaterial = \"steel\"\nthickness = \"0.5 mm\"\n";
    let exhibit = load(text).unwrap_or_else(|report| panic!("{}", report.to_text()));
    let expected = 0.02 * 5e-4 * 7850.0;
    assert!((exhibit.bodies[0].properties.mass - expected).abs() < SINGLE * expected);
}

#[test]
fn a_pattern_takes_a_wire_through_its_points_in_natural_order() {
    let mut scene = Scene::default();
    let marks = [("Rod.10", 0.3), ("Rod.9", 0.2), ("Rod.1", 0.1), ("Rodent", 9.0)];
    let mut below: Vec<_> = marks.iter().map(|(name, x)| scene.node(name, [*x, 0.0, 0.0], None, &[])).collect();
    below.push(scene.node("Weight", [0.0; 3], Some(&cuboid([0.02; 3])), &[]));
    scene.node("Boom", [0.0, 1.0, 0.0], None, &below);
    scene.node("Stay.2", [0.0, 0.0, 2.0], None, &[]);
    scene.node("Stay.1", [0.0, 0.0, 1.0], None, &[]);
    let wire = |name: &str, points: &str| {
        format!("[[wire]]\nname = \"{name}\"\npoints = \"{points}\"\ndiameter = \"1 mm\"\nmaterial = \"steel\"\n")
    };
    let body = "[[body]]\nnode = \"Boom\"\nmaterial = \"steel\"\n";
    let text = format!("{body}{}body = \"Boom\"\n{}", wire("rod", "Rod.*"), wire("stay", "Stay.*"));
    let exhibit =
        exhibit::load(Folder::exhibit(&scene.glb(), &text).path()).unwrap_or_else(|report| panic!("{report}"));
    let along = |wire: usize, axis: DVec3| exhibit.wires[wire].points.iter().map(|p| p.dot(axis)).collect::<Vec<_>>();
    for (found, expected) in [(along(0, DVec3::X), &[0.1, 0.2, 0.3][..]), (along(1, DVec3::Z), &[1.0, 2.0])] {
        assert_eq!(found.len(), expected.len(), "{found:?}");
        assert!(found.iter().zip(expected).all(|(a, b)| (a - b).abs() < SINGLE), "{found:?} {expected:?}");
    }
    assert_eq!((exhibit.wires[0].body, exhibit.wires[1].body), (Some(0), None));
}

#[test]
fn a_wire_collides_as_few_capsules_that_stay_inside_it() {
    let exhibit = exhibit::load(&exhibit::resolve("steel-fish").expect("shipped")).unwrap_or_else(|r| panic!("{r}"));
    for name in ["b2-wire", "b4-wire"] {
        let wire = exhibit.wires.iter().find(|wire| wire.name == name).expect("a wire");
        let ends = |c: &Collider| {
            let Core::Segment { half } = c.shape.core else { panic!("not a capsule") };
            (c.shape.place.point(-half * DVec3::Y), c.shape.place.point(half * DVec3::Y))
        };
        let chain: Vec<_> = exhibit.colliders.iter().filter(|c| c.node == name).map(ends).collect();
        let segments = wire.points.len() - 1;
        assert!((1..=segments / 2).contains(&chain.len()), "{} capsules for {segments} segments", chain.len());
        // A capsule keeps its middle, direction and length: its ends come back to rounding.
        let same = |p: DVec3, q: DVec3| p.distance(q) < 1e-15;
        assert!(chain.windows(2).all(|pair| same(pair[0].1, pair[1].0)), "the chain is whole");
        assert!(same(chain[0].0, wire.points[0]) && same(chain[chain.len() - 1].1, wire.points[segments]));
        for &point in &wire.points {
            let off = |&(a, b): &(DVec3, DVec3)| {
                let t = ((point - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
                point.distance(a + (b - a) * t)
            };
            let distance = chain.iter().map(off).fold(f64::INFINITY, f64::min);
            assert!(distance <= wire.radius, "{name}: {distance} m off");
        }
    }
}

#[test]
fn a_breath_made_from_its_strength_is_heard_as_one_and_is_always_the_same() {
    let text = "[[attract.step]]\nat = 0\nblow = { strength = 0.5, hold = \"0.8 s\", aim = [0.3, 0.4] }\n\
                [[attract.step]]\nat = 5\nblow = { strength = 0.5, hold = \"0.8 s\" }\n";
    let breaths = || {
        let exhibit = load(text).unwrap_or_else(|report| panic!("{report}"));
        let breath = |i: usize| match &exhibit.attract.steps[i].action {
            AttractAction::Blow { samples, sample_rate, aim } => (samples.to_vec(), *sample_rate, *aim),
            other => panic!("{other:?}"),
        };
        [breath(0), breath(1)]
    };
    let [first, second] = breaths();
    assert_eq!(breaths(), [first.clone(), second.clone()]);
    assert_ne!(first.0, second.0, "two breaths of a script differ");
    assert_eq!((first.1, first.2, second.2), (16_000, Some([0.3, 0.4]), None));
    // 0.4 s of quiet on either side, 0.12 s up, 0.8 s, 0.3 s down.
    assert_eq!(first.0.len(), (2.02 * 16_000.0) as usize);
    let mut detector = BlowDetector::new(first.1);
    let mut blowing = 0;
    for step in first.0.chunks(16_000 / 240) {
        detector.push(step, &[]);
        blowing += usize::from(detector.estimate().speed > 0.0);
    }
    assert!(blowing as f64 / 240.0 > 0.5, "heard for {blowing} steps");
}

#[test]
fn bad_sidecars_give_all_their_problems_each_at_its_line() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/cases/exhibit-bad");
    let (mut cases, mut wrong) = (0, String::new());
    for entry in std::fs::read_dir(&folder).expect("the folder of cases").flatten() {
        let path = entry.path();
        let text = std::fs::read_to_string(&path).expect("a case");
        let first = text.lines().next().unwrap_or_default();
        let mut expected: Vec<&str> = first.trim_start_matches("# expect").split_whitespace().collect();
        expected.sort_unstable();
        let case = Folder::exhibit(&model(), "");
        case.write("exhibit.toml", text.as_bytes());
        let warns = expected.iter().any(|code| code.starts_with('W'));
        let report = match exhibit::load(case.path()) {
            Ok(exhibit) => exhibit.warning_report(),
            Err(report) => report,
        };
        // The model itself has two nodes of one name.
        let counted = |d: &&Diagnostic| d.is_error() || (warns && d.code != codes::DUPLICATE_NODE.name);
        let problems = report.diagnostics.iter().filter(counted);
        let mut found: Vec<String> =
            problems.map(|d| format!("{}:{}", d.code, d.location.as_ref().map_or(0, |l| l.line))).collect();
        found.sort_unstable();
        if expected.is_empty() || found != expected {
            wrong += &format!("{}: {found:?}, expected {expected:?}\n{}", path.display(), report.to_text());
        }
        cases += 1;
    }
    assert!(wrong.is_empty(), "{wrong}");
    assert!(cases >= 20, "{cases} cases");
}

#[test]
fn a_report_shows_the_line_and_near_names_and_speaks_json() {
    let report = load("[[body]]\nnode = \"Boon\"\nmaterial = \"stel\"\nmass = 1\n").expect_err("two misspelt names");
    let shown = report.to_text();
    for part in ["E0207", "\"Boon\"", "node = \"Boon\"", "\"Boom\"", "exhibit.toml:4:8"] {
        assert!(shown.contains(part), "{part} is missing in\n{shown}");
    }
    let json = report.to_json();
    let json = json.as_array().and_then(|all| all.iter().find(|d| d["severity"] == "error")).expect("an error");
    assert_eq!(json["code"], "E0207");
    assert_eq!((json["line"].as_u64(), json["column"].as_u64()), (Some(4), Some(8)));
}

//! Key frames of morph weights and of scales: read, played at the time of the run, drawn, and refused where they are broken.

use serde_json::json;
use soffio_exhibit::animated_scale::AnimatedScale;
use soffio_exhibit::shape_tracks::ShapeTrack;
use soffio_exhibit::{self as exhibit, Exhibit, model};
use soffio_math::DVec3;

use crate::exhibit::glb::{Folder, Scene, cuboid, sheet};

/// Single precision of numbers about one.
const ROUNDING: f64 = 1e-6;

/// A red sheet, 0.4 m wide and 0.6 m high, with two targets: its upper edge goes 0.3 m to the right, and all of it 0.2 m up.
fn leaf() -> (Scene, usize) {
    let mut scene = Scene::default();
    let shape = sheet(0.4, 0.6);
    let mesh = scene.textured(&shape, &[[0.0; 2]; 4]);
    let lean = shape.0.iter().map(|p| [if p[1] > 0.0 { 0.3 } else { 0.0 }, 0.0, 0.0]).collect();
    scene.morph(mesh, &[lean, vec![[0.0, 0.2, 0.0]; 4]]);
    let leaf = scene.node("Leaf", [0.0, 0.5, 0.0], None, &[]);
    scene.set(leaf, "mesh", json!(mesh));
    let red = json!({ "baseColorFactor": [0.6, 0.01, 0.01, 1.0], "metallicFactor": 0.0 });
    scene.extra.push(("materials", json!([{ "doubleSided": true, "pbrMetallicRoughness": red }])));
    (scene, leaf)
}

fn plain(scene: &Scene) -> Exhibit {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("model.glb");
    std::fs::write(&path, scene.glb()).expect("writable");
    Exhibit::from_model(model::load(&path).unwrap_or_else(|report| panic!("{}", report.to_text())))
}

fn weights(track: &ShapeTrack, t: f64) -> [f64; 2] {
    let mut weights = [f64::NAN; 2];
    track.channel.sample_weights(track.time(t), &mut weights);
    weights
}

#[test]
fn weights_go_from_key_to_key_as_their_curve_says_and_start_again() {
    let near = |found: [f64; 2], wanted: [f64; 2], what: &str| {
        let off = (found[0] - wanted[0]).abs().max((found[1] - wanted[1]).abs());
        assert!(off < ROUNDING, "{what}: {found:?} instead of {wanted:?}");
    };
    let keys = [(0.5, vec![0.0, 1.0]), (1.5, vec![1.0, 0.5]), (2.5, vec![0.0, 1.0])];
    for (curve, wanted) in [("STEP", [0.0, 1.0]), ("LINEAR", [0.25, 0.875])] {
        let (mut scene, leaf) = leaf();
        scene.animate("Wave", leaf, "weights", curve, &keys);
        let exhibit = plain(&scene);
        let [track] = exhibit.shapes.as_slice() else { panic!("one track: {:?}", exhibit.shapes) };
        near(weights(track, 0.75), wanted, curve);
        near(weights(track, 1.5), [1.0, 0.5], curve);
        // The animation lasts two seconds.
        near(weights(track, 6.75), wanted, curve);
        assert!(track.is_changing(100.0));
    }
    // In-tangents, values and out-tangents of each key; the values of a cubic by glTF 2.0, appendix C.5.
    let (mut scene, leaf) = leaf();
    let cubic = [(0.0, vec![9.0, 9.0, 0.0, 1.0, 0.5, -1.0]), (2.0, vec![0.25, 0.0, 1.0, 0.0, 9.0, 9.0])];
    scene.animate("Wave", leaf, "weights", "CUBICSPLINE", &cubic);
    let exhibit = plain(&scene);
    let (s, d): (f64, f64) = (0.3, 2.0);
    let (s2, s3) = (s * s, s * s * s);
    let [v, b, w, a] = [2.0 * s3 - 3.0 * s2 + 1.0, d * (s3 - 2.0 * s2 + s), 3.0 * s2 - 2.0 * s3, d * (s3 - s2)];
    near(weights(&exhibit.shapes[0], d * s), [0.5 * b + w + 0.25 * a, v - b], "cubic");
}

#[test]
fn a_node_grows_with_what_is_above_it_and_a_body_follows_its_place_alone() {
    let mut scene = Scene::default();
    let bud = scene.node("Bud", [0.0, 0.2, 0.0], Some(&cuboid([0.1; 3])), &[]);
    let stem = scene.node("Stem", [1.0, 0.0, 0.0], None, &[bud]);
    // At rest nothing of the stem is to be seen; what it is turned by is known all the same.
    scene.set(stem, "scale", json!([0.0, 0.0, 0.0]));
    let half = 0.5_f32.sqrt();
    scene.set(stem, "rotation", json!([0.0, 0.0, half, half]));
    scene.animate("Grow", stem, "scale", "LINEAR", &[(0.0, vec![0.0; 3]), (2.0, vec![2.0, 4.0, 2.0])]);
    let exhibit = plain(&scene);
    // A quarter turn takes the bud's height to −x.
    let at = AnimatedScale::of(&exhibit, bud).world(1.0).transform_point3(DVec3::ZERO);
    assert!(at.distance(DVec3::new(1.0 - 0.4, 0.0, 0.0)) < ROUNDING, "{at}");
    assert!(AnimatedScale::of(&exhibit, bud).frame(0.0).is_none(), "what is nowhere has no frame");

    let (mut scene, leaf) = leaf();
    let turn = |angle: f32| vec![0.0, 0.0, (0.5 * angle).sin(), (0.5 * angle).cos()];
    scene.animate("Wave", leaf, "weights", "LINEAR", &[(0.0, vec![0.0; 2]), (3.0, vec![1.0; 2])]);
    scene.animate("Turn", leaf, "rotation", "LINEAR", &[(0.0, turn(0.0)), (1.0, turn(1.0))]);
    scene.animate("Stretch", leaf, "scale", "LINEAR", &[(0.0, vec![1.0; 3]), (1.0, vec![1.0, 3.0, 1.0])]);
    let body = "[[body]]\nnode = \"Leaf\"\nmotion = \"kinematic\"\nanimation = { name = \"NAME\", loop = false }\n";
    let load = |name: &str| exhibit::load(Folder::exhibit(&scene.glb(), &body.replace("NAME", name)).path());
    // It stretches unevenly, which no body can, and turns all the same.
    let turned = load("Turn").unwrap_or_else(|report| panic!("{}", report.to_text()));
    assert_eq!((turned.drives.len(), turned.shapes.len()), (1, 2));
    assert!(turned.shapes.iter().all(|track| track.repeat), "these are not of the animation that the body follows");
    // Shapes do not move a body.
    for name in ["Wave", "Stretch"] {
        let output = load(name).expect_err("nothing to follow").to_text();
        assert!(output.contains(&format!("no animation \"{name}\" of the model moves \"Leaf\"")), "{output}");
    }
}

#[test]
fn nodes_below_a_body_play_the_animation_that_the_body_follows() {
    let (mut scene, leaf) = leaf();
    let turn = |angle: f32| vec![0.0, 0.0, (0.5 * angle).sin(), (0.5 * angle).cos()];
    scene.animate("Idle", leaf, "weights", "STEP", &[(0.0, vec![0.5; 2]), (7.0, vec![0.5; 2])]);
    scene.animate("Bow", leaf, "rotation", "LINEAR", &[(0.0, turn(0.0)), (1.0, turn(1.0))]);
    scene.animate("Bow", leaf, "weights", "LINEAR", &[(0.0, vec![0.0; 2]), (1.0, vec![1.0; 2])]);
    scene.merge("Bow");
    let text = "[[body]]\nnode = \"Leaf\"\nmotion = \"kinematic\"\nanimation = { name = \"Bow\", loop = false }\n";
    let exhibit = exhibit::load(Folder::exhibit(&scene.glb(), text).path())
        .unwrap_or_else(|report| panic!("{}", report.to_text()));
    let [track] = exhibit.shapes.as_slice() else { panic!("one track: {:?}", exhibit.shapes) };
    assert_eq!((track.repeat, track.first_key, track.last_key), (false, 0.0, 1.0));
    assert_eq!((weights(track, 0.25), weights(track, 5.0)), ([0.25; 2], [1.0; 2]));
    assert!(track.is_changing(0.5) && !track.is_changing(1.5));
}

#[test]
fn broken_key_frames_of_shapes_are_reported_with_their_place() {
    let output = |scene: &Scene| {
        let report = exhibit::load(Folder::exhibit(&scene.glb(), "").path()).expect_err("broken");
        // As shown, and without the breaks of lines.
        report.to_text() + &report.diagnostics[0].message
    };
    let refused = |keys: &[(f32, Vec<f32>)], curve: &str, words: &[&str]| {
        let (mut scene, leaf) = leaf();
        scene.animate("Wave", leaf, "weights", curve, keys);
        let output = output(&scene);
        for word in words.iter().chain(&["exhibit.toml:2", "model.glb", "animation \"Wave\""]) {
            assert!(output.contains(word), "no {word} in\n{output}");
        }
    };
    refused(&[(0.0, vec![0.0]), (1.0, vec![1.0, 1.0])], "LINEAR", &["3 weights of node \"Leaf\"", "2 a key"]);
    refused(&[(0.0, vec![0.0; 4]), (1.0, vec![1.0; 4])], "LINEAR", &["2 keys have 4 lists of weights"]);
    refused(&[(0.0, vec![0.0; 2]), (1.0, vec![1.0; 2])], "CUBICSPLINE", &["2 keys have 2 lists of weights"]);
    refused(&[(1.0, vec![0.0; 2]), (0.0, vec![1.0; 2])], "STEP", &["not in the order of time"]);
    let mut scene = Scene::default();
    let stiff = scene.node("Stiff", [0.0; 3], Some(&cuboid([0.1; 3])), &[]);
    scene.animate("Wave", stiff, "weights", "LINEAR", &[(0.0, vec![0.0]), (1.0, vec![1.0])]);
    let output = output(&scene);
    assert!(output.contains("morphs node \"Stiff\", which has no morph targets"), "{output}");
}

#[test]
fn an_export_names_the_shapes_that_it_leaves_at_rest() {
    let (mut scene, leaf) = leaf();
    scene.animate("Wave", leaf, "weights", "LINEAR", &[(0.0, vec![0.0; 2]), (1.0, vec![1.0; 2])]);
    let folder = Folder::exhibit(&scene.glb(), "");
    let run = std::process::Command::new(env!("CARGO_BIN_EXE_soffio"))
        .args(["export", ".", "--gltf", "out.glb", "--seconds", "0.1"])
        .current_dir(folder.path())
        .output()
        .expect("the program starts");
    let output = String::from_utf8_lossy(&run.stderr);
    assert!(
        run.status.success() && output.contains("left out: key frames of scales and morph weights (1)"),
        "{output}"
    );
    let written = model::load(&folder.file("out.glb")).unwrap_or_else(|report| panic!("{}", report.to_text()));
    assert!(written.animations.is_empty() && written.meshes.len() == 1);
}

#[cfg(feature = "kiosk")]
mod drawn {
    use soffio_exhibit::View;
    use soffio_kiosk::step::idle_detection::IdleDetector;
    use soffio_render::FrameInput;
    use soffio_simulation::{Settings, Simulation, StepInput};

    use super::*;
    use crate::pictures::renderer;
    use crate::skins::red;

    const SIZE: (u32, u32) = (480, 480);

    /// The middle of a polygon in the plane of the picture and its area, pixels.
    fn seen(corners: &[DVec3], view: &View) -> ([f64; 2], f64) {
        let at = |p: DVec3| {
            let [x, y] = view.project(p, 1.0).expect("before the eye");
            [x * f64::from(SIZE.0), y * f64::from(SIZE.1)]
        };
        let (mut sum, mut all) = ([0.0; 2], 0.0);
        for triangle in [[0, 1, 2], [0, 2, 3]] {
            let [a, b, c] = triangle.map(|i| at(corners[i]));
            let area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
            sum = std::array::from_fn(|i| sum[i] + area * (a[i] + b[i] + c[i]) / 3.0);
            all += area;
        }
        (sum.map(|x| x / all), all)
    }

    #[test]
    fn morphs_and_scales_are_drawn_where_the_formula_has_them_at_the_time_of_the_run() {
        /// Pixels: those of the edge are red or not by their share.
        const TOLERANCE: f64 = 0.6;
        /// Share of the area: an edge of a pixel's width around a sheet of some hundred.
        const AREA: f64 = 0.04;
        /// Steps of eight bits: two seconds are 480 steps of which each is rounded.
        const SAME: u8 = 1;
        let (mut scene, leaf) = leaf();
        scene.animate(
            "Wave",
            leaf,
            "weights",
            "LINEAR",
            &[(0.0, vec![0.0; 2]), (1.0, vec![1.0, 0.5]), (2.0, vec![0.0; 2])],
        );
        scene.animate(
            "Grow",
            leaf,
            "scale",
            "STEP",
            &[(0.0, vec![1.0; 3]), (0.5, vec![0.5, 0.75, 1.0]), (2.0, vec![1.0; 3])],
        );
        let exhibit = std::sync::Arc::new(plain(&scene));
        let Some(mut renderer) = renderer(&exhibit, |_| {}) else { return };
        let view = View { eye: DVec3::new(0.1, 0.5, 2.6), target: DVec3::new(0.1, 0.45, 0.0), up: DVec3::Y, fovy: 0.6 };
        let mut simulation = Simulation::new(exhibit.clone(), Settings::default());
        let mut pictures = Vec::new();
        for step in 0..=680_u32 {
            let now = simulation.snapshot();
            let t = f64::from(step) / 240.0;
            assert!((now.time - t).abs() < ROUNDING, "{} at {t}", now.time);
            if step % 160 == 40 {
                let frame = FrameInput {
                    poses: &now.poses,
                    dust: &[],
                    curves: &[],
                    view,
                    size: SIZE,
                    exposure: 1.0,
                    time: now.time,
                };
                let picture = renderer.draw(&frame).expect("a picture");
                if let Ok(folder) = std::env::var("SOFFIO_PICTURES") {
                    picture.save(std::path::Path::new(&folder).join(format!("shape-{step}.png"))).expect("writable");
                }
                let past = t % 2.0;
                let share = 1.0 - (past - 1.0).abs();
                let scale = if past < 0.5 { DVec3::ONE } else { DVec3::new(0.5, 0.75, 1.0) };
                let corner = |[x, y]: [f64; 2]| {
                    let lean = if y > 0.0 { 0.3 * share } else { 0.0 };
                    DVec3::new(0.0, 0.5, 0.0) + scale * DVec3::new(x + lean, y + 0.2 * 0.5 * share, 0.0)
                };
                let corners = [[-0.2, -0.3], [0.2, -0.3], [0.2, 0.3], [-0.2, 0.3]].map(corner);
                let ((found, pixels), (wanted, area)) = (red(&picture), seen(&corners, &view));
                println!("{t:.2} s: {found:.2?} beside {wanted:.2?}, {pixels} pixels beside {area:.0}");
                let off = (found[0] - wanted[0]).hypot(found[1] - wanted[1]);
                assert!(off < TOLERANCE, "{t} s: {found:?} instead of {wanted:?}");
                assert!((pixels / area - 1.0).abs() < AREA, "{t} s: {pixels} pixels of {area}");
                pictures.push(picture);
            }
            simulation.step(&StepInput::default());
        }
        let apart = |a: usize, b: usize| {
            let pairs = pictures[a].as_raw().iter().zip(pictures[b].as_raw());
            pairs.map(|(a, b)| a.abs_diff(*b)).max().unwrap_or_default()
        };
        assert!(apart(0, 3) <= SAME && apart(1, 4) <= SAME, "after two seconds it starts again");
        assert!(apart(0, 1) > SAME && apart(1, 2) > SAME);
    }

    #[test]
    fn pictures_do_not_wait_while_a_shape_changes() {
        let still = |repeats: bool| {
            let (mut scene, leaf) = leaf();
            let turn = |angle: f32| vec![0.0, 0.0, (0.5 * angle).sin(), (0.5 * angle).cos()];
            scene.animate("Bow", leaf, "rotation", "LINEAR", &[(0.0, turn(0.0)), (1.0, turn(0.0))]);
            scene.animate("Bow", leaf, "weights", "LINEAR", &[(0.0, vec![0.0; 2]), (1.0, vec![1.0; 2])]);
            scene.merge("Bow");
            let text =
                format!("[[body]]\nnode = \"Leaf\"\nmotion = \"kinematic\"\nanimation = {{ loop = {repeats} }}\n");
            let exhibit = exhibit::load(Folder::exhibit(&scene.glb(), &text).path())
                .unwrap_or_else(|report| panic!("{}", report.to_text()));
            let exhibit = std::sync::Arc::new(exhibit);
            let view = exhibit.view(1.0);
            let (mut simulation, mut idle) =
                (Simulation::new(exhibit.clone(), Settings::default()), IdleDetector::default());
            let mut seen = Vec::new();
            for step in 1..=480 {
                simulation.step(&StepInput::default());
                idle.update(&exhibit, &simulation.snapshot(), &view);
                if step % 240 == 0 {
                    seen.push(idle.is_still());
                }
            }
            seen
        };
        assert_eq!(still(true), [false, false]);
        assert_eq!(still(false), [false, true], "after its last key it rests");
    }
}

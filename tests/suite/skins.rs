//! Meshes that follow joints, drawn, beside the formula of glTF 2.0, 3.7.3, worked out here in double precision.

use glam::{DMat4, DQuat, DVec3};
use serde_json::json;
use soffio_exhibit::{Body, Exhibit, View, model};
use soffio_geometry::bodies::MassProperties;
use soffio_math::{DMat3, Pose};
use soffio_render::FrameInput;

use crate::pictures::renderer;

/// Rows of the strip, half its width and its height, m.
const ROWS: usize = 13;
const HALF: f64 = 0.08;
const HEIGHT: f64 = 0.8;
/// Turn of the second joint at rest about z, rad: it is bound without.
const REST: f64 = 0.4;
const SIZE: (u32, u32) = (480, 480);

fn floats(values: impl IntoIterator<Item = f64>) -> Vec<u8> {
    values.into_iter().flat_map(|value| (value as f32).to_le_bytes()).collect()
}

/// Corners of the strip as it is bound, upright in the plane z = 0, and the share of the upper joint in each.
fn strip() -> Vec<(DVec3, f64)> {
    let row = |i: usize| {
        let up = i as f64 / (ROWS - 1) as f64;
        [-HALF, HALF].map(|x| (DVec3::new(x, HEIGHT * up, 0.0), up * up))
    };
    (0..ROWS).flat_map(row).collect()
}

fn triangles() -> Vec<[usize; 3]> {
    (0..ROWS - 1).flat_map(|row| [[2 * row, 2 * row + 1, 2 * row + 3], [2 * row, 2 * row + 3, 2 * row + 2]]).collect()
}

/// What takes the bound strip to the frame of each joint: the lower one lies in the origin, the upper one at its end.
fn inverse_bind() -> [DMat4; 2] {
    [DMat4::IDENTITY, DMat4::from_translation(-HEIGHT * DVec3::Y)]
}

/// A red strip on two joints, each of them the node of a body, shown by a node that lies elsewhere, as a file.
fn exhibit(folder: &std::path::Path) -> Exhibit {
    let corners = strip();
    let mut bin = floats(corners.iter().flat_map(|(p, _)| p.to_array()));
    let mut views = vec![bin.len()];
    let mut add = |bytes: Vec<u8>, bin: &mut Vec<u8>| {
        bin.extend(bytes);
        views.push(bin.len());
    };
    add(floats(corners.iter().flat_map(|_| [0.0, 0.0, 1.0])), &mut bin);
    // As many files have them: the order is not that of the weights.
    add(corners.iter().flat_map(|_| [1u8, 0, 0, 0]).collect(), &mut bin);
    add(floats(corners.iter().flat_map(|(_, upper)| [*upper, 1.0 - upper, 0.0, 0.0])), &mut bin);
    add(floats(inverse_bind().iter().flat_map(DMat4::to_cols_array)), &mut bin);
    add(triangles().into_iter().flatten().flat_map(|i| (i as u16).to_le_bytes()).collect(), &mut bin);
    let starts = [0, views[0], views[1], views[2], views[3], views[4]];
    let list: Vec<_> = starts
        .iter()
        .zip(&views)
        .map(|(start, end)| json!({"buffer": 0, "byteOffset": start, "byteLength": end - start}))
        .collect();
    let n = corners.len();
    let [s, c] = [(0.5 * REST).sin(), (0.5 * REST).cos()];
    let json = json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1, 2]}],
        "buffers": [{"byteLength": bin.len(), "uri": "strip.bin"}], "bufferViews": list,
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": n, "type": "VEC3", "min": [-HALF, 0.0, 0.0], "max": [HALF, HEIGHT, 0.0]},
            {"bufferView": 1, "componentType": 5126, "count": n, "type": "VEC3"},
            {"bufferView": 2, "componentType": 5121, "count": n, "type": "VEC4"},
            {"bufferView": 3, "componentType": 5126, "count": n, "type": "VEC4"},
            {"bufferView": 4, "componentType": 5126, "count": 2, "type": "MAT4"},
            {"bufferView": 5, "componentType": 5123, "count": 3 * triangles().len(), "type": "SCALAR"}
        ],
        "materials": [{"doubleSided": true, "pbrMetallicRoughness": {"baseColorFactor": [0.6, 0.01, 0.01, 1.0], "metallicFactor": 0.0}}],
        "meshes": [{"primitives": [{
            "attributes": {"POSITION": 0, "NORMAL": 1, "JOINTS_0": 2, "WEIGHTS_0": 3}, "indices": 5, "material": 0
        }]}],
        "nodes": [
            {"mesh": 0, "skin": 0, "translation": [3.0, 1.0, 0.0], "name": "strip"},
            {"name": "lower"},
            {"name": "upper", "translation": [0.0, HEIGHT, 0.0], "rotation": [0.0, 0.0, s, c]}
        ],
        "skins": [{"joints": [1, 2], "inverseBindMatrices": 4}]
    });
    let path = folder.join("strip.gltf");
    std::fs::write(folder.join("strip.bin"), bin).expect("writable");
    std::fs::write(&path, json.to_string()).expect("writable");
    let mut exhibit = Exhibit::from_model(model::load(&path).unwrap_or_else(|report| panic!("{report}")));
    let body = |node: usize| {
        let (_, rotation, position) = exhibit.model.nodes[node].world.to_scale_rotation_translation();
        Body {
            name: exhibit.model.nodes[node].name.clone(),
            node,
            properties: MassProperties { mass: 0.1, center: DVec3::ZERO, inertia: DMat3::IDENTITY },
            pose: Pose { rotation, position },
            velocity: DVec3::ZERO,
            angular_velocity: DVec3::ZERO,
            linear_damping: 0.0,
            angular_damping: 0.0,
            material: 0,
            moved_by: None,
        }
    };
    exhibit.bodies = [1, 2].map(body).to_vec();
    exhibit
}

/// Where the formula has each corner: p = Σ w J I p₀.
fn formula(poses: &[Pose; 2]) -> Vec<DVec3> {
    let [lower, upper]: [DMat4; 2] = std::array::from_fn(|i| poses[i].matrix() * inverse_bind()[i]);
    strip()
        .into_iter()
        .map(|(corner, share)| (upper * share + lower * (1.0 - share)).transform_point3(corner))
        .collect()
}

/// Middle of what is red, pixels, and how many pixels are.
pub fn red(picture: &image::RgbaImage) -> ([f64; 2], f64) {
    let (mut sum, mut count) = ([0.0; 2], 0.0);
    for (x, y, pixel) in picture.enumerate_pixels() {
        let [r, g, b, _] = pixel.0.map(f64::from);
        if r > 3.0 * g.max(b) && r > 40.0 {
            sum = [sum[0] + f64::from(x) + 0.5, sum[1] + f64::from(y) + 0.5];
            count += 1.0;
        }
    }
    (sum.map(|x| x / count), count)
}

/// The same by the formula: the triangles' middles by their areas, where none covers another.
fn seen(corners: &[DVec3], view: &View) -> ([f64; 2], f64) {
    let at = |i: usize| {
        let [x, y] = view.project(corners[i], 1.0).expect("before the eye");
        [x * f64::from(SIZE.0), y * f64::from(SIZE.1)]
    };
    let (mut sum, mut all) = ([0.0; 2], 0.0);
    for triangle in triangles() {
        let [a, b, c] = triangle.map(at);
        let area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])).abs();
        sum = std::array::from_fn(|i| sum[i] + area * (a[i] + b[i] + c[i]) / 3.0);
        all += area;
    }
    (sum.map(|x| x / all), all)
}

#[test]
fn a_skin_follows_the_bodies_that_carry_its_joints_as_the_formula_says() {
    /// Pixels: those of the edge are red or not by their share.
    const TOLERANCE: f64 = 0.6;
    /// Share of the area: an edge of a pixel's width around a strip of some sixty.
    const AREA: f64 = 0.04;
    let folder = tempfile::tempdir().expect("a folder");
    let exhibit = exhibit(folder.path());
    let Some(mut renderer) = renderer(&exhibit, |_| {}) else { return };
    let view = View { eye: DVec3::new(0.1, 0.5, 2.6), target: DVec3::new(0.1, 0.45, 0.0), up: DVec3::Y, fovy: 0.6 };
    let rest: [Pose; 2] = std::array::from_fn(|i| exhibit.bodies[i].pose);
    let moved = |x: f64, y: f64, turn: f64, tilt: f64| Pose {
        position: DVec3::new(x, y, 0.05),
        rotation: DQuat::from_rotation_z(turn) * DQuat::from_rotation_x(tilt),
    };
    let scenes = [
        rest,
        [moved(0.0, 0.1, 0.0, 0.0), rest[1]],
        [rest[0], moved(0.45, 0.65, -0.9, 0.0)],
        [moved(-0.15, 0.05, 0.3, 0.2), moved(0.35, 0.8, -0.6, 0.5)],
        rest,
    ];
    let mut pictures = Vec::new();
    for (i, poses) in scenes.iter().enumerate() {
        let frame = FrameInput { poses, dust: &[], curves: &[], view, size: SIZE, exposure: 1.0, time: 0.0 };
        let picture = renderer.draw(&frame).expect("a picture");
        if let Ok(folder) = std::env::var("SOFFIO_PICTURES") {
            picture.save(std::path::Path::new(&folder).join(format!("skin-{i}.png"))).expect("a writable folder");
        }
        let ((found, pixels), (wanted, area)) = (red(&picture), seen(&formula(poses), &view));
        println!("{i}: {found:.2?} beside {wanted:.2?}, {pixels} pixels beside {area:.0}");
        let off = (found[0] - wanted[0]).hypot(found[1] - wanted[1]);
        assert!(off < TOLERANCE, "{i}: {found:?} instead of {wanted:?}");
        assert!((pixels / area - 1.0).abs() < AREA, "{i}: {pixels} pixels of {area}");
        pictures.push(picture);
    }
    assert!(pictures[0] == pictures[4], "what has come back is the same picture");
}

#[test]
fn at_rest_it_has_the_shape_that_physics_and_grabs_use() {
    /// Single precision of a metre.
    const ROUNDING: f64 = 1e-6;
    let folder = tempfile::tempdir().expect("a folder");
    let exhibit = exhibit(folder.path());
    let node = &exhibit.model.nodes[0];
    let frozen = &exhibit.model.meshes[node.mesh.expect("a mesh")].primitives[0].positions;
    let poses: [Pose; 2] = std::array::from_fn(|i| exhibit.bodies[i].pose);
    for (stored, wanted) in frozen.iter().zip(formula(&poses)) {
        let world = node.world.transform_point3(glam::Vec3::from_array(*stored).as_dvec3());
        assert!((world - wanted).length() < ROUNDING, "{world} instead of {wanted}");
    }
    // A joint that turns moves all of it: nobody may take it for still.
    assert!(exhibit.body_radii().iter().all(|reach| *reach >= HEIGHT - ROUNDING), "{:?}", exhibit.body_radii());
}

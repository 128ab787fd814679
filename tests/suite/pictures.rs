//! Pictures on whatever Vulkan driver there is, software included; without one these tests say so and pass.

use glam::{DMat4, DVec3, Vec3};
use soffio_exhibit::model::{Appearance, Camera, Mesh, Model, Node, Primitive};
use soffio_exhibit::{Body, Exhibit, Wire};
use soffio_math::Pose;
use soffio_render::{FrameInput, ImageRenderer, Lighting, Options, RenderError, Tonemap};
use soffio_simulation::DustParticle;

use crate::require::require;

/// A plate: an outline in the plane z = 0, extruded by its thickness, fan from the centroid.
pub(crate) fn plate(outline: &[[f32; 2]], thickness: f32, material: usize) -> Primitive {
    let mut p = Primitive { material: Some(material), ..Default::default() };
    let n = outline.len();
    let center = outline.iter().fold([0.0; 2], |c, q| [c[0] + q[0] / n as f32, c[1] + q[1] / n as f32]);
    for side in [1.0f32, -1.0] {
        let base = p.positions.len() as u32;
        let z = 0.5 * thickness * side;
        p.positions.push([center[0], center[1], z]);
        p.positions.extend(outline.iter().map(|q| [q[0], q[1], z]));
        p.normals.resize(p.positions.len(), [0.0, 0.0, side]);
        for i in 0..n as u32 {
            let (a, b) = (base + 1 + i, base + 1 + (i + 1) % n as u32);
            p.indices.extend(if side > 0.0 { [base, a, b] } else { [base, b, a] });
        }
    }
    for i in 0..n {
        let (a, b) = (outline[i], outline[(i + 1) % n]);
        let base = p.positions.len() as u32;
        let normal = Vec3::new(b[1] - a[1], a[0] - b[0], 0.0).normalize().to_array();
        for (q, z) in [(a, -0.5), (b, -0.5), (b, 0.5), (a, 0.5)] {
            p.positions.push([q[0], q[1], z * thickness]);
            p.normals.push(normal);
        }
        p.indices.extend([0, 1, 2, 0, 2, 3].map(|k| base + k));
    }
    p
}

fn disc(radius: f32) -> Vec<[f32; 2]> {
    (0..64)
        .map(|i| (i as f32 / 64.0 * std::f32::consts::TAU).sin_cos())
        .map(|(s, c)| [radius * c, radius * s])
        .collect()
}

/// A fish in outline: body and forked tail, drawn by a radius over the angle.
fn fish() -> Vec<[f32; 2]> {
    (0..96)
        .map(|i| {
            let (s, c) = (i as f32 / 96.0 * std::f32::consts::TAU).sin_cos();
            let x = 0.20 * c;
            let body = 0.062 * s * (1.0 - 0.35 * c);
            let tail = if c < -0.62 { -0.17 * (c + 0.62) * s.signum() } else { 0.0 };
            [x - if c < -0.9 { 0.25 * (0.02 - 0.06 * (s.abs() - 0.2)) } else { 0.0 }, body + tail]
        })
        .collect()
}

pub(crate) fn paint(name: &str, base_color: [f32; 4], metallic: f32, roughness: f32) -> Appearance {
    Appearance { name: name.into(), base_color, metallic, roughness, ..Default::default() }
}

/// A standing mobile in the manner of the collection: post, boom with a black fish, and hanging plates.
pub fn mobile() -> Exhibit {
    let materials = vec![
        paint("black", [0.012, 0.012, 0.014, 1.0], 0.0, 0.42),
        paint("red", [0.62, 0.018, 0.012, 1.0], 0.0, 0.38),
        paint("orange", [0.80, 0.17, 0.012, 1.0], 0.0, 0.4),
        paint("white", [0.80, 0.79, 0.76, 1.0], 0.0, 0.45),
        paint("steel", [0.45, 0.45, 0.46, 1.0], 1.0, 0.35),
    ];
    let mut model = Model { materials, ..Default::default() };
    let mut add = |name: &str, primitive: Option<Primitive>, at: DVec3, camera: Option<usize>| {
        let world = DMat4::from_translation(at);
        let mesh = primitive.map(|p| {
            model.meshes.push(Mesh { name: name.into(), primitives: vec![p] });
            model.meshes.len() - 1
        });
        let index = model.nodes.len();
        let node =
            Node { name: name.into(), parent: None, children: vec![], local: world, world, mesh, camera, light: None };
        model.nodes.push(node);
        model.roots.push(index);
        index
    };
    let foot: Vec<_> = disc(0.075);
    let mut base = plate(&foot, 0.012, 4);
    for v in base.positions.iter_mut().chain(base.normals.iter_mut()) {
        *v = [v[0], v[2], -v[1]];
    }
    add("foot", Some(base), DVec3::new(0.05, 0.006, 0.0), None);
    let places = [
        ("fish", plate(&fish(), 0.0008, 0), DVec3::new(-0.16, 0.46, 0.0)),
        (
            "red",
            plate(&[[-0.05, -0.075], [0.06, -0.045], [0.035, 0.07], [-0.02, 0.05]], 0.0008, 1),
            DVec3::new(0.24, 0.25, 0.03),
        ),
        ("orange", plate(&disc(0.037), 0.0008, 2), DVec3::new(0.40, 0.21, -0.02)),
        ("white", plate(&disc(0.027), 0.0008, 3), DVec3::new(0.33, 0.13, 0.04)),
    ];
    let bodies: Vec<(usize, DVec3)> = places.into_iter().map(|(n, p, at)| (add(n, Some(p), at, None), at)).collect();
    let camera = add("camera", None, DVec3::new(0.08, 0.34, 1.75), Some(0));
    model.cameras.push(Camera { fovy: 0.42, aspect: Some(1.5) });
    let mut exhibit = Exhibit::from_model(model);
    exhibit.camera_node = Some(camera);
    let properties = soffio_geometry::bodies::MassProperties {
        mass: 0.1,
        center: DVec3::ZERO,
        inertia: soffio_math::DMat3::IDENTITY,
    };
    exhibit.bodies = bodies
        .iter()
        .map(|&(node, at)| Body {
            name: exhibit.model.nodes[node].name.clone(),
            node,
            properties,
            pose: Pose { position: at, ..Pose::IDENTITY },
            velocity: DVec3::ZERO,
            angular_velocity: DVec3::ZERO,
            linear_damping: 0.0,
            angular_damping: 0.0,
            material: 0,
            moved_by: None,
        })
        .collect();
    let mut wire = |name: &str, points: Vec<DVec3>, radius: f64| {
        exhibit.wires.push(Wire {
            name: name.into(),
            body: None,
            points,
            radius,
            material: 0,
            color: [0.50, 0.50, 0.52],
            metallic: 1.0,
            roughness: 0.35,
        });
    };
    let v = DVec3::new;
    wire("post", vec![v(0.05, 0.0, 0.0), v(0.05, 0.475, 0.0)], 0.003);
    let arc = |a: DVec3, b: DVec3, rise: f64| -> Vec<DVec3> {
        (0..=24).map(|i| i as f64 / 24.0).map(|t| a.lerp(b, t) + DVec3::Y * (4.0 * rise * t * (1.0 - t))).collect()
    };
    wire("boom", arc(v(-0.16, 0.46, 0.001), v(0.33, 0.40, 0.0), 0.045), 0.001);
    wire("drop", vec![v(0.33, 0.40, 0.0), v(0.33, 0.36, 0.0)], 0.0006);
    wire("second", arc(v(0.24, 0.32, 0.03), v(0.375, 0.30, 0.0), 0.035), 0.0006);
    wire("red hanger", vec![v(0.24, 0.32, 0.03), v(0.24, 0.30, 0.03)], 0.0004);
    wire("third", arc(v(0.40, 0.25, -0.02), v(0.33, 0.165, 0.04), 0.03), 0.0005);
    wire("third hanger", vec![v(0.375, 0.30, 0.0), v(0.375, 0.235, 0.005)], 0.0004);
    exhibit
}

/// The renderer; `None` where there is no driver at all.
pub(crate) fn renderer(exhibit: &Exhibit, adjust: impl FnOnce(&mut Options)) -> Option<ImageRenderer> {
    match ImageRenderer::new(exhibit, adjust) {
        Err(error) if !matches!(error, RenderError::NoAdapter(_)) => panic!("{error}"),
        found => require("Vulkan driver", found),
    }
}

pub(crate) fn frame<'a>(exhibit: &Exhibit, poses: &'a [Pose], size: (u32, u32)) -> FrameInput<'a> {
    FrameInput {
        poses,
        dust: &[],
        curves: &[],
        view: exhibit.view(f64::from(size.0) / f64::from(size.1)),
        size,
        exposure: 1.0,
        time: 0.0,
    }
}

#[test]
fn the_gallery_shows_a_grey_wall_a_dark_fish_and_a_soft_shadow() {
    let exhibit = mobile();
    let Some(mut renderer) = renderer(&exhibit, |_| {}) else { return };
    let poses: Vec<Pose> = exhibit.bodies.iter().map(|b| b.pose).collect();
    // Not a multiple of 64 wide: rows are padded on the way back.
    let size = (301, 201);
    let picture = renderer.draw(&frame(&exhibit, &poses, size)).expect("a picture");
    if let Ok(folder) = std::env::var("SOFFIO_PICTURES") {
        picture.save(std::path::Path::new(&folder).join("gallery.png")).expect("a writable folder");
    }
    let at = |point: DVec3| {
        let [x, y] = exhibit.view(301.0 / 201.0).project(point, 301.0 / 201.0).expect("in front");
        picture.get_pixel((x * 301.0) as u32, (y * 201.0) as u32).0
    };
    let wall = picture.get_pixel(15, 15).0;
    // A fifth to two thirds of white.
    assert!(wall[..3].iter().all(|&c| (124..=212).contains(&c)), "a grey wall: {wall:?}");
    let fish = at(exhibit.bodies[0].pose.position);
    assert!(fish[..3].iter().all(|&c| c < 110), "a dark fish: {fish:?}");
    let red = at(exhibit.bodies[1].pose.position);
    assert!(red[0] > 2 * red[1] && red[0] > 100, "a red plate: {red:?}");
    let again = renderer.draw(&frame(&exhibit, &poses, size)).expect("a picture");
    assert_eq!(picture, again, "the same moment is the same picture");
}

#[test]
fn each_lamp_throws_the_fish_on_the_wall_where_geometry_says() {
    let exhibit = mobile();
    let Some(mut renderer) = renderer(&exhibit, |_| {}) else { return };
    let poses: Vec<Pose> = exhibit.bodies.iter().map(|b| b.pose).collect();
    // The same room with the fish far behind its wall: what the shadow falls on.
    let mut without = poses.clone();
    without[0].position.z = -100.0;
    let size = (600, 400);
    let [with, without] = [&poses, &without].map(|p| renderer.draw(&frame(&exhibit, p, size)).expect("a picture"));
    let gallery = soffio_render::gallery::Gallery::around(&exhibit);
    let wall = gallery.center - gallery.z * gallery.half.z;
    for (lamp, share) in gallery.lamps.iter().zip([0.6, 0.15]) {
        let center = exhibit.bodies[0].pose.position.as_vec3();
        let ray = center - lamp.position;
        let foot = lamp.position + ray * ((wall - lamp.position).dot(gallery.z) / ray.dot(gallery.z));
        let [x, y] = exhibit.view(1.5).project(foot.as_dvec3(), 1.5).expect("in front");
        let at = |picture: &image::RgbaImage| linear(picture.get_pixel((x * 600.0) as u32, (y * 400.0) as u32).0[1]);
        let lost = 1.0 - at(&with) / at(&without);
        // Three quarters of the light behind the work, four fifths of them the key lamp's; the lamps fall off by some tenths towards the edge.
        const TOLERANCE: f32 = 0.3;
        assert!((lost / share - 1.0).abs() < TOLERANCE, "lost {lost}, share {share} at {x} {y}");
    }
}

#[test]
fn a_furnace_shows_no_white_thing() {
    // Under uniform light a perfect reflector is indistinguishable from the background.
    const TOLERANCE: f32 = 0.02;
    let radiance = Vec3::splat(0.5);
    for metallic in [0.0, 1.0] {
        for roughness in [0.05, 0.3, 0.6, 1.0] {
            let mut sphere = ball(0.4);
            sphere.material = Some(0);
            let exhibit = Exhibit::from_model(Model {
                nodes: vec![still(DMat4::IDENTITY)],
                roots: vec![0],
                meshes: vec![Mesh { name: "ball".into(), primitives: vec![sphere] }],
                materials: vec![paint("white", [1.0; 4], metallic, roughness)],
                ..Default::default()
            });
            let white = std::sync::Arc::new(soffio_render::environment::Environment::new(|_| radiance));
            let look = Lighting {
                tonemap: Tonemap::Clamp,
                environment: Some(white),
                background: Some(radiance),
                ..Default::default()
            };
            let Some(mut renderer) = renderer(&exhibit, |options| options.lighting = look) else { return };
            let picture = renderer.draw(&frame(&exhibit, &[], (64, 64))).expect("a picture");
            for (x, y, pixel) in picture.enumerate_pixels() {
                let value = linear(pixel.0[1]) / radiance.y;
                assert!((value - 1.0).abs() < TOLERANCE, "metal {metallic} rough {roughness} at {x},{y}: {value}");
            }
        }
    }
}

#[test]
fn a_wire_thinner_than_a_pixel_is_an_unbroken_line_of_the_right_darkness() {
    // Goals of the renderer: mean within a tenth, scatter from column to column below a twentieth.
    const BIAS: f32 = 0.1;
    const SCATTER: f32 = 0.05;
    let size = (160, 80);
    let pixel = 2.0 * (0.2f64 / 2.0).tan() * 2.0 / f64::from(size.1);
    for width in [0.25, 0.47, 0.88, 1.66] {
        let mut exhibit = Exhibit::from_model(Model::default());
        let slope = DVec3::new(1.0, 0.13, 0.0);
        exhibit.wires.push(Wire {
            name: "wire".into(),
            body: None,
            points: vec![-slope, slope],
            radius: 0.5 * width * pixel,
            material: 0,
            color: [0.0; 3],
            metallic: 1.0,
            roughness: 0.5,
        });
        let look =
            Lighting { tonemap: Tonemap::Clamp, background: Some(Vec3::ONE), env_intensity: 0.0, ..Default::default() };
        let Some(mut renderer) = renderer(&exhibit, |options| options.lighting = look) else { return };
        let view = soffio_exhibit::View { eye: DVec3::Z * 2.0, target: DVec3::ZERO, up: DVec3::Y, fovy: 0.2 };
        let frame = FrameInput { poses: &[], dust: &[], curves: &[], view, size, exposure: 1.0, time: 0.0 };
        let picture = renderer.draw(&frame).expect("a picture");
        let ink: Vec<f32> =
            (8..152).map(|x| (0..80).map(|y| 1.0 - linear(picture.get_pixel(x, y).0[1])).sum::<f32>()).collect();
        let mean = ink.iter().sum::<f32>() / ink.len() as f32;
        let scatter = (ink.iter().map(|i| (i - mean) * (i - mean)).sum::<f32>() / ink.len() as f32).sqrt() / mean;
        let expected = (width * slope.length()) as f32;
        assert!((mean / expected - 1.0).abs() < BIAS, "{width} px: mean {mean}, expected {expected}");
        assert!(scatter < SCATTER, "{width} px: scatter {scatter}");
    }
}

#[test]
fn both_ways_to_average_samples_agree() {
    let exhibit = mobile();
    let mut pictures = Vec::new();
    for shader_resolve in [true, false] {
        let Some(mut renderer) = renderer(&exhibit, |options| options.shader_resolve = shader_resolve) else { return };
        pictures.push(renderer.draw(&frame(&exhibit, &[], (240, 160))).expect("a picture"));
    }
    // Either may round to its own side.
    let worst = pictures[0].iter().zip(pictures[1].iter()).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(worst <= Some(1), "{worst:?} LSB apart");
}

#[test]
fn dust_adds_light_where_it_is_and_nowhere_else() {
    let exhibit = mobile();
    let Some(mut renderer) = renderer(&exhibit, |_| {}) else { return };
    let position = exhibit.bodies[0].pose.position + DVec3::Z * 0.1;
    let mote = DustParticle { position: position.as_vec3().to_array(), velocity: [0.0; 3], brightness: 0.8 };
    let dark = frame(&exhibit, &[], (300, 200));
    let lit = FrameInput { dust: &[mote], ..dark };
    let [before, after] = [dark, lit].map(|f| renderer.draw(&f).expect("a picture"));
    let [x, y] = dark.view.project(position, 1.5).expect("in front");
    let (x, y) = ((x * 300.0) as i32, (y * 200.0) as i32);
    let mut gained = 0;
    for (px, py, pixel) in after.enumerate_pixels() {
        let old = before.get_pixel(px, py).0[0];
        let far = (px as i32 - x).abs().max((py as i32 - y).abs()) > 4;
        assert!(!far || pixel.0[0] == old, "changed at {px},{py}, the mote is at {x},{y}");
        gained += i32::from(pixel.0[0]) - i32::from(old);
    }
    assert!(gained > 30, "{gained}");
}

/// The eight corners of a box.
fn corners(bounds: &soffio_exhibit::view::Bounds) -> [DVec3; 8] {
    std::array::from_fn(|i| {
        let pick = |bit: usize, low: f64, high: f64| if i & bit == 0 { low } else { high };
        DVec3::new(
            pick(1, bounds.min.x, bounds.max.x),
            pick(2, bounds.min.y, bounds.max.y),
            pick(4, bounds.min.z, bounds.max.z),
        )
    })
}

#[test]
fn a_narrower_picture_shows_the_whole_exhibit_and_as_large_as_it_can() {
    // Rounding of a few double-precision operations.
    const ROUNDING: f64 = 1e-9;
    let exhibit = mobile();
    let own = exhibit.view(1.5);
    let wide = |view: &soffio_exhibit::View, aspect: f64| aspect * (0.5 * view.fovy).tan();
    let bounds = exhibit.bounds();
    for aspect in [1.4, 1.0, 0.5] {
        let view = exhibit.view(aspect);
        assert!(wide(&view, aspect) <= wide(&own, 1.5) + ROUNDING, "no wider than the camera");
        let mut reach: f64 = 0.0;
        for corner in corners(&bounds) {
            let at = view.project(corner, aspect).expect("in front");
            assert!(at.iter().all(|c| (0.0..=1.0).contains(c)), "aspect {aspect}, corner {corner}: {at:?}");
            reach = at.iter().fold(reach, |reach, c| reach.max(2.0 * (c - 0.5).abs()));
        }
        assert!(reach > 0.5, "aspect {aspect}: the exhibit reaches only {reach} of the way to an edge");
    }
    assert_eq!(exhibit.view(2.0).fovy, own.fovy, "a wider picture shows more at the sides");
    let moving = exhibit.moving_bounds();
    let (_, _, forward) = own.axes();
    assert!((own.target - moving.center()).dot(forward).abs() < ROUNDING, "aimed at the depth of what moves");
}

#[test]
fn a_model_without_a_camera_is_framed_whole_in_any_aspect() {
    let mut exhibit = mobile();
    exhibit.camera_node = None;
    let bounds = exhibit.bounds();
    for aspect in [0.4, 1.0, 2.5] {
        let view = exhibit.view(aspect);
        for corner in corners(&bounds) {
            let at = view.project(corner, aspect).expect("in front");
            assert!(at.iter().all(|c| (0.0..=1.0).contains(c)), "aspect {aspect}, corner {corner}: {at:?}");
        }
    }
}

/// sRGB code to linear light.
pub(crate) fn linear(code: u8) -> f32 {
    let c = f32::from(code) / 255.0;
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

/// A node that shows the first mesh and stands still.
pub(crate) fn still(world: DMat4) -> Node {
    Node {
        name: "still".into(),
        parent: None,
        children: vec![],
        local: world,
        world,
        mesh: Some(0),
        camera: None,
        light: None,
    }
}

/// A ball with smooth normals.
pub(crate) fn ball(radius: f32) -> Primitive {
    let (rings, sectors) = (32u32, 48u32);
    let mut p = Primitive::default();
    for i in 0..=rings {
        let (s, c) = (i as f32 / rings as f32 * std::f32::consts::PI).sin_cos();
        for j in 0..=sectors {
            let (y, x) = (j as f32 / sectors as f32 * std::f32::consts::TAU).sin_cos();
            let n = Vec3::new(s * x, c, -s * y);
            p.normals.push(n.to_array());
            p.positions.push((n * radius).to_array());
        }
    }
    for i in 0..rings {
        for j in 0..sectors {
            let a = i * (sectors + 1) + j;
            let b = a + sectors + 1;
            p.indices.extend([a, b, a + 1, a + 1, b, b + 1]);
        }
    }
    p
}

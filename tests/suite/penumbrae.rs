//! Shadows of plates on the wall, against the area of the lamp's disc that a plate hides: a sum over the plate's edges, itself
//! held against a count over the disc.

use glam::{DVec2, DVec3};
use soffio_authoring::outline::{Polygon, ellipse, reversed};
use soffio_authoring::solid::extrude;
use soffio_exhibit::model::{Mesh, Model, Node, Primitive};
use soffio_exhibit::{Body, Exhibit, View, Wire};
use soffio_math::{DQuat, Pose};
use soffio_render::gallery::{Gallery, Lamp, WALL_ALBEDO};
use soffio_render::{FrameInput, ImageRenderer, Lighting, Tonemap};

use super::pictures::{linear, paint, renderer, still};

/// m.
const THICKNESS: f64 = 0.0008;
const BEVEL: f64 = 0.0001;
/// Pixels of the pictures.
const SIZE: (u32, u32) = (240, 160);

/// An outline and its holes, all anticlockwise, and how it is turned: not edge on to a lamp, where a plate shades by its
/// thickness, which the sums here leave out.
struct Case {
    name: &'static str,
    outline: Polygon,
    holes: Vec<Polygon>,
    turn: DQuat,
}

fn circle(radius: f64, steps: usize) -> Polygon {
    ellipse(DVec2::ZERO, DVec2::splat(radius), 0.0, steps)
}

fn cases() -> [Case; 4] {
    let leaf = [[-0.05, -0.03], [0.06, -0.02], [0.03, 0.035], [-0.01, 0.01]].map(DVec2::from).to_vec();
    let case = |name, outline, holes, turn| Case { name, outline, holes, turn };
    [
        case("disc", circle(0.03, 72), vec![], DQuat::IDENTITY),
        case("leaf, slanted", leaf, vec![], DQuat::from_rotation_y(-1.0) * DQuat::from_rotation_x(0.4)),
        case("ring", circle(0.045, 48), vec![circle(0.028, 40)], DQuat::from_rotation_x(-0.5)),
        case("disc, turned away", circle(0.04, 72), vec![], DQuat::from_rotation_y(1.45)),
    ]
}

/// A plate that hangs before the wall. `closed` or with a hole in its rim, too small to be seen: then it is no plate to the
/// renderer, and its triangles throw the shadow.
fn hung(case: &Case, closed: bool) -> Exhibit {
    let solid = extrude(&case.outline, &case.holes, THICKNESS, BEVEL);
    let mut primitive = Primitive {
        material: Some(0),
        positions: solid.positions.iter().map(|p| p.as_vec3().to_array()).collect(),
        normals: solid.normals.iter().map(|n| n.as_vec3().to_array()).collect(),
        indices: solid.triangles.iter().flatten().copied().collect(),
        ..Default::default()
    };
    if !closed {
        primitive.indices.truncate(primitive.indices.len() - 3);
    }
    let mut node: Node = still(glam::DMat4::IDENTITY);
    node.mesh = Some(0);
    let model = Model {
        nodes: vec![node],
        roots: vec![0],
        meshes: vec![Mesh { name: "plate".into(), primitives: vec![primitive] }],
        materials: vec![paint("black", [0.01, 0.01, 0.01, 1.0], 0.0, 0.5)],
        ..Default::default()
    };
    let mut exhibit = Exhibit::from_model(model);
    exhibit.bodies.push(Body {
        name: "plate".into(),
        node: 0,
        properties: soffio_geometry::bodies::MassProperties {
            mass: 0.1,
            center: DVec3::ZERO,
            inertia: soffio_math::DMat3::IDENTITY,
        },
        pose: Pose::IDENTITY,
        velocity: DVec3::ZERO,
        angular_velocity: DVec3::ZERO,
        linear_damping: 0.0,
        angular_damping: 0.0,
        material: 0,
        moved_by: None,
    });
    // A pole far to the side makes the room large: the penumbra is as wide as the plate, and the shadow on the wall.
    exhibit.wires.push(Wire {
        name: "pole".into(),
        body: None,
        points: vec![DVec3::new(-0.8, -0.7, 0.0), DVec3::new(-0.8, 0.7, 0.0)],
        radius: 0.002,
        material: 0,
        color: [0.0; 3],
        metallic: 1.0,
        roughness: 0.5,
    });
    exhibit
}

/// Loops of a case where a pose has them: around the plate anticlockwise, around holes clockwise.
fn placed(case: &Case, pose: &Pose) -> Vec<Vec<DVec3>> {
    let holes = case.holes.iter().map(|hole| reversed(hole.clone()));
    let loops = std::iter::once(case.outline.clone()).chain(holes);
    loops.map(|points| points.iter().map(|p| pose.point(p.extend(0.0))).collect()).collect()
}

/// A point seen from `eye` on a lamp's disc, of radius 1.
fn on_disc(point: DVec3, eye: DVec3, lamp: &Lamp) -> DVec2 {
    let (center, axis) = (lamp.position.as_dvec3(), lamp.axis.as_dvec3().normalize());
    let (u, v) = axis.any_orthonormal_pair();
    let way = point - eye;
    let hit = eye + way * ((center - eye).dot(axis) / way.dot(axis)) - center;
    DVec2::new(hit.dot(u), hit.dot(v)) / f64::from(lamp.radius)
}

/// Area of the unit disc within closed lines over its own: the part of each edge inside with triangles, the rest with sectors.
fn hidden_share(loops: &[Vec<DVec2>]) -> f64 {
    let sector = |a: DVec2, b: DVec2| 0.5 * a.perp_dot(b).atan2(a.dot(b));
    let mut area = 0.0;
    for line in loops {
        for (k, &a) in line.iter().enumerate() {
            let b = line[(k + 1) % line.len()];
            let d = b - a;
            let (p, q) = (a.dot(d) / d.length_squared(), (a.length_squared() - 1.0) / d.length_squared());
            let root = (p * p - q).max(0.0).sqrt();
            let [enters, leaves] = [-p - root, -p + root].map(|t| t.clamp(0.0, 1.0));
            if root == 0.0 || enters == leaves {
                area += sector(a, b);
            } else {
                let (e, l) = (a + enters * d, a + leaves * d);
                area += sector(a, e) + 0.5 * e.perp_dot(l) + sector(l, b);
            }
        }
    }
    area.abs() / std::f64::consts::PI
}

/// The same by counting points of a grid over the disc within the lines.
fn counted_share(loops: &[Vec<DVec2>], across: usize) -> f64 {
    let (mut inside, mut all) = (0, 0);
    for i in 0..across * across {
        let p = (DVec2::new((i % across) as f64, (i / across) as f64) + 0.5) * (2.0 / across as f64) - 1.0;
        if p.length_squared() > 1.0 {
            continue;
        }
        all += 1;
        let sides = loops.iter().flat_map(|line| (0..line.len()).map(|k| (line[k], line[(k + 1) % line.len()])));
        let crossed =
            sides.filter(|(a, b)| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (b.x - a.x) * (p.y - a.y) / (b.y - a.y));
        inside += crossed.count() % 2;
    }
    inside as f64 / f64::from(all)
}

#[test]
fn the_part_of_a_lamp_behind_a_plate_is_a_sum_over_its_edges() {
    /// Points across the disc, and what their count may be off: an outline passes a tenth of a row's points wrongly.
    const ACROSS: usize = 400;
    const COUNTED: f64 = 1.5e-3;
    let lamp = Gallery::around(&hung(&cases()[0], true)).lamps[0];
    let mut worst: f64 = 0.0;
    for case in cases() {
        let pose = Pose { position: DVec3::ZERO, rotation: case.turn };
        let loops = placed(&case, &pose);
        for k in 0..12 {
            // From its shadow's middle outwards.
            let lamp_at = lamp.position.as_dvec3();
            let eye = -lamp_at * 0.25 + DVec3::new(0.007 * f64::from(k), 0.004 * f64::from(k), 0.0);
            let seen: Vec<Vec<DVec2>> =
                loops.iter().map(|line| line.iter().map(|&p| on_disc(p, eye, &lamp)).collect()).collect();
            let (sum, count) = (hidden_share(&seen), counted_share(&seen, ACROSS));
            worst = worst.max((sum - count).abs());
            assert!((sum - count).abs() < COUNTED, "{}, place {k}: {sum} by edges, {count} by points", case.name);
        }
    }
    println!("edges against points: {worst:.5} at worst");
}

/// A test case in a gallery, its picture perpendicular to the key lamp's shadow, and the width of a pixel on the wall,
/// m.
struct Wall {
    gallery: Gallery,
    renderer: ImageRenderer,
    view: View,
    foot: DVec3,
    pixel: f64,
}

impl Wall {
    fn of(case: &Case, closed: bool) -> Option<Self> {
        let exhibit = hung(case, closed);
        let gallery = Gallery::around(&exhibit);
        let look = Lighting { tonemap: Tonemap::Clamp, ..Default::default() };
        let renderer = renderer(&exhibit, |options| options.lighting = look)?;
        let (key, wall) = (gallery.lamps[0].position, gallery.center - gallery.z * gallery.half.z);
        let (height, distance) = (-wall.dot(gallery.z), (key - wall).dot(gallery.z));
        let foot = (key - key * (distance / (distance - height))).as_dvec3();
        let z = gallery.z.as_dvec3();
        let view = View { eye: foot + z * 2.0, target: foot, up: DVec3::Y, fovy: 0.11 };
        let pixel = 2.0 * (0.5 * view.fovy).tan() * 2.0 / f64::from(SIZE.1);
        Some(Self { gallery, renderer, view, foot, pixel })
    }

    /// Radiance in each pixel, linear, of the green channel: the mean of so many exposures, each with codes of its own.
    fn picture(&mut self, pose: Pose, exposures: u32) -> Vec<f64> {
        let mut sum = vec![0.0; (SIZE.0 * SIZE.1) as usize];
        for k in 0..exposures {
            let exposure = 1.0 - 0.013 * k as f32;
            let frame =
                FrameInput { poses: &[pose], dust: &[], curves: &[], view: self.view, size: SIZE, exposure, time: 0.0 };
            let picture = self.renderer.draw(&frame).expect("a picture");
            for (sum, pixel) in sum.iter_mut().zip(picture.pixels()) {
                *sum += f64::from(linear(pixel.0[1]) / exposure) / f64::from(exposures);
            }
        }
        sum
    }

    /// The wall where a pixel's middle is.
    fn at(&self, x: u32, y: u32) -> DVec3 {
        let right = self.gallery.x.as_dvec3();
        let [across, up] = [f64::from(x) + 0.5 - 0.5 * f64::from(SIZE.0), 0.5 * f64::from(SIZE.1) - f64::from(y) - 0.5];
        self.foot + (right * across + DVec3::Y * up) * self.pixel
    }

    /// Radiance that a lamp adds to the wall there, unshaded.
    fn lit(&self, lamp: &Lamp, at: DVec3) -> f64 {
        let away = at - lamp.position.as_dvec3();
        let cosine = away.normalize().dot(lamp.axis.as_dvec3());
        let (inner, outer) = (f64::from(lamp.cos_inner), f64::from(lamp.cos_outer));
        let t = ((cosine - outer) / (inner - outer)).clamp(0.0, 1.0);
        let falls = -away.normalize().dot(self.gallery.z.as_dvec3());
        f64::from(WALL_ALBEDO.y) / std::f64::consts::PI * f64::from(lamp.intensity.y) * t * t * (3.0 - 2.0 * t) * falls
            / away.length_squared()
    }
}

/// Where nothing is before the wall.
const GONE: Pose = Pose { position: DVec3::new(0.0, 0.0, -100.0), rotation: DQuat::IDENTITY };

#[test]
fn a_plate_before_the_wall_throws_the_penumbra_that_the_closed_form_says() {
    /// Root of the mean square along a row, of the key's light. Codes of eight bits make 0.008 of it in one pair of pictures and
    /// 0.003 in the mean of eight; the rest is the shadow's texels, which round the ends of a penumbra off.
    const RMS: f64 = 0.012;
    const EXPOSURES: u32 = 8;
    let mut sums = [0.0; 2];
    for case in cases() {
        let mut measurements = Vec::new();
        for closed in [true, false] {
            let Some(mut wall) = Wall::of(&case, closed) else { return };
            let pose = Pose { position: DVec3::ZERO, rotation: case.turn };
            let (with, without) = (wall.picture(pose, EXPOSURES), wall.picture(GONE, EXPOSURES));
            let loops = placed(&case, &pose);
            let key = wall.lit(&wall.gallery.lamps[0], wall.foot);
            let y = SIZE.1 / 2;
            let mut squares = 0.0;
            let (mut deepest, mut worst): (f64, f64) = (0.0, 0.0);
            for x in 0..SIZE.0 {
                let at = wall.at(x, y);
                let i = (y * SIZE.0 + x) as usize;
                let lost = (without[i] - with[i]) / key;
                let expected: f64 = wall
                    .gallery
                    .lamps
                    .iter()
                    .map(|lamp| {
                        let seen: Vec<Vec<DVec2>> =
                            loops.iter().map(|line| line.iter().map(|&p| on_disc(p, at, lamp)).collect()).collect();
                        wall.lit(lamp, at) / key * hidden_share(&seen)
                    })
                    .sum();
                squares += (lost - expected) * (lost - expected);
                deepest = deepest.max(expected);
                worst = worst.max((lost - expected).abs());
            }
            let rms = (squares / f64::from(SIZE.0)).sqrt();
            measurements.push(rms);
            let how = if closed { "closed form" } else { "triangles" };
            println!("{}, {how}: rms {rms:.4}, worst {worst:.4} of the key, deepest {deepest:.3}", case.name);
            if let Ok(folder) = std::env::var("SOFFIO_PICTURES") {
                let grey = image::GrayImage::from_fn(SIZE.0, SIZE.1, |x, y| {
                    let i = (y * SIZE.0 + x) as usize;
                    image::Luma([(255.0 * (1.0 - (without[i] - with[i]) / key)).clamp(0.0, 255.0) as u8])
                });
                let name = format!("penumbra-{}-{how}.png", case.name).replace([' ', ','], "-");
                grey.save(std::path::Path::new(&folder).join(name)).expect("a writable folder");
            }
        }
        assert!(measurements[0] < RMS, "{}: {} of the key's light", case.name, measurements[0]);
        (0..2).for_each(|i| sums[i] += measurements[i]);
    }
    // One shadow or another may lie better on its texels; in the mean the closed form is nearer.
    assert!(sums[0] < sums[1], "triangles are nearer, {sums:?}");
}

#[test]
fn a_shadow_that_moves_by_tenths_of_a_pixel_goes_evenly() {
    /// Of the greatest change from one place to the next, over the mean one: a penumbra is steepest in its middle, by 4/π,
    /// and codes of eight bits leave some noise in a column's mean.
    const EVEN: f64 = 1.8;
    /// Pictures of slightly different exposure whose mean is taken, so that the noise of the dither is half as much.
    const EXPOSURES: u32 = 4;
    const STEPS: u32 = 60;
    let half = [[-0.1, -0.06], [0.0, -0.06], [0.0, 0.06], [-0.1, 0.06]].map(DVec2::from).to_vec();
    let case = Case { name: "edge", outline: half, holes: vec![], turn: DQuat::IDENTITY };
    for closed in [true, false] {
        let Some(mut wall) = Wall::of(&case, closed) else { return };
        let x = SIZE.0 / 2;
        let right = wall.gallery.x.as_dvec3();
        let column: Vec<f64> = (0..STEPS)
            .map(|k| {
                // The shadow goes a little farther than the plate.
                let step = 0.1 * wall.pixel * 0.8 * (f64::from(k) - 0.5 * f64::from(STEPS));
                let picture = wall.picture(Pose { position: right * step, rotation: DQuat::IDENTITY }, EXPOSURES);
                let rows = 50..110;
                let count = f64::from(rows.end - rows.start);
                rows.map(|y| picture[(y * SIZE.0 + x) as usize]).sum::<f64>() / count
            })
            .collect();
        let changes: Vec<f64> = column.windows(2).map(|pair| pair[0] - pair[1]).collect();
        let mean = changes.iter().sum::<f64>() / changes.len() as f64;
        let greatest = changes.iter().fold(0.0_f64, |most, change| most.max(change.abs()));
        let stand = changes.iter().filter(|change| change.abs() < 0.1 * mean.abs()).count();
        let how = if closed { "closed form" } else { "triangles" };
        println!(
            "{how}: mean change {mean:.5}, greatest {:.2} of it, {stand} of {} places stand",
            greatest / mean.abs(),
            changes.len()
        );
        assert!(!closed || greatest < EVEN * mean.abs(), "{greatest} of {mean}");
    }
}

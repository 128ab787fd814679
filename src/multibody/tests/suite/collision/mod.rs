//! Shapes that touch: every pair of shapes against independent geometry, contact points, time of impact, pairs.
//!
//! References know the shapes by other means than the code: signed distance formulas of each shape, and fine polytopes
//! whose corners are the shape's.

use soffio_geometry::support::Core;
use soffio_math::noise::Random;
use soffio_math::{DQuat, DVec3, PI, Pose, rotation};
use soffio_multibody::collision::{Collider, Proximity, Shape, proximity};

mod manifolds;
mod pairs;
mod swept;

/// Sides of the prism that stands for a cylinder in references.
const PRISM: usize = 360;
/// A prism of 360 sides lies inside its cylinder by r (1 − cos(π/360)) < 4e-5 r; radii here are below 0.06 m but for a few
/// of half a metre.
const FINE: f64 = 5e-6;
const FINE_LARGE: f64 = 4e-5;
/// Distances of closed forms and of GJK on angular cores at a metre from the origin: rounding times a few dozen operations.
const EXACT: f64 = 1e-9;

/// The kinds of bounded shapes.
const KINDS: usize = 7;

fn signed(random: &mut Random) -> DVec3 {
    DVec3::new(random.signed(), random.signed(), random.signed())
}

fn pose(random: &mut Random, spread: f64) -> Pose {
    Pose { rotation: rotation(signed(random) * PI), position: signed(random) * spread }
}

/// A shape of a kind, a few centimetres large, somewhere in its body's frame.
fn shape(kind: usize, random: &mut Random) -> Shape {
    let mut size = || random.range(0.01, 0.06);
    let (x, y, z) = (size(), size(), size());
    let (from, to) = (signed(random) * 0.03, signed(random) * 0.08);
    match kind {
        0 => Shape::sphere(from, x),
        1 => Shape::capsule(from, to, 0.3 * x),
        2 => Shape::cuboid(pose(random, 0.03), DVec3::new(x, y, z), 0.0),
        3 => Shape::cuboid(pose(random, 0.03), DVec3::new(x, y, z), 0.002),
        4 => Shape::cylinder(from, to, y, 0.0),
        5 => Shape::cylinder(from, to, y, 0.002),
        _ if random.unit() < 0.5 => plate(random, 5, 0.0005),
        _ => Shape::hull(&(0..12).map(|_| signed(random) * 0.05).collect::<Vec<_>>(), 0.001),
    }
}

/// A plate with its corners on an ellipse.
fn plate(random: &mut Random, corners: usize, half_thickness: f64) -> Shape {
    let (u, v) = (random.range(0.02, 0.08), random.range(0.02, 0.08));
    let corner = |i: usize| {
        let angle = 2.0 * PI * i as f64 / corners as f64;
        DVec3::new(u * angle.cos(), v * angle.sin(), 0.0)
    };
    Shape::plate(&(0..corners).map(corner).collect::<Vec<_>>(), half_thickness)
}

/// World corners of a fine polytope for the core.
fn outline(shape: &Shape, pose: &Pose) -> Vec<DVec3> {
    let box_of = |half: DVec3| {
        (0..8).map(move |i| {
            let sign = |bit: usize| if i >> bit & 1 == 0 { -1.0 } else { 1.0 };
            DVec3::new(sign(0), sign(1), sign(2)) * half
        })
    };
    let local: Vec<DVec3> = match &shape.core {
        Core::Point => vec![DVec3::ZERO],
        Core::Segment { half } => vec![-half * DVec3::Y, half * DVec3::Y],
        Core::Box { half } => box_of(*half).collect(),
        Core::Cylinder { half, radius } => (0..PRISM)
            .flat_map(|i| {
                let angle = 2.0 * PI * i as f64 / PRISM as f64;
                [-half, *half].map(|y| DVec3::new(radius * angle.cos(), y, radius * angle.sin()))
            })
            .collect(),
        // A block of a metre below the plane, far wider than the body on it.
        Core::HalfSpace => box_of(DVec3::new(20.0, 0.5, 20.0)).map(|p| p - 0.5 * DVec3::Y).collect(),
        Core::Hull(hull) => hull.corners().to_vec(),
    };
    local.into_iter().map(|p| pose.point(shape.place.point(p))).collect()
}

/// Signed distance of a world point from the surface, by the formula of each shape; hulls by their outline alone.
fn from_surface(shape: &Shape, pose: &Pose, p: DVec3) -> f64 {
    let l = shape.place.inverse_point(pose.inverse_point(p));
    let boxed = |q: DVec3| q.max(DVec3::ZERO).length() + q.max_element().min(0.0);
    let core = match &shape.core {
        Core::Point => l.length(),
        Core::Segment { half } => l.distance(DVec3::Y * l.y.clamp(-half, *half)),
        Core::Box { half } => boxed(l.abs() - *half),
        Core::Cylinder { half, radius } => boxed(DVec3::new(l.x.hypot(l.z) - radius, l.y.abs() - half, -1.0)),
        Core::HalfSpace => l.y,
        Core::Hull(_) => soffio_geometry::convex::closest(&outline(shape, pose)[..], &[p][..]).distance,
    };
    core - shape.radius
}

/// Extent of A − B along a direction, from the outlines, balls included: how far A must go along −d to clear B.
fn overlap_along(a: (&Shape, &[DVec3]), b: (&Shape, &[DVec3]), d: DVec3) -> f64 {
    let far = |points: &[DVec3], d: DVec3| points.iter().map(|p| p.dot(d)).fold(f64::NEG_INFINITY, f64::max);
    far(a.1, d) + far(b.1, -d) + a.0.radius + b.0.radius
}

/// Directions spread evenly over the sphere.
fn directions(count: usize) -> impl Iterator<Item = DVec3> {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    (0..count).map(move |i| {
        let y = 1.0 - (2.0 * i as f64 + 1.0) / count as f64;
        let (r, angle) = ((1.0 - y * y).sqrt(), golden * i as f64);
        DVec3::new(r * angle.cos(), y, r * angle.sin())
    })
}

/// Is the answer right? By references alone.
fn check(label: &str, (a, at_a): (&Shape, &Pose), (b, at_b): (&Shape, &Pose), found: &Proximity) {
    let Proximity { gap, normal, point } = *found;
    assert!(gap.is_finite() && point.is_finite(), "{label}: {found:?}");
    assert!((normal.length() - 1.0).abs() < EXACT, "{label}: normal {normal}");
    let (corners_a, corners_b) = (outline(a, at_a), outline(b, at_b));
    let (of_a, of_b) = ((a, &corners_a[..]), (b, &corners_b[..]));
    // No way along the normal is shorter or longer than said: the shapes' extents are the independent witness.
    let along = -overlap_along(of_a, of_b, -normal);
    let large = |s: &Shape| matches!(s.core, Core::Cylinder { radius, .. } if radius > 0.1);
    let fine = if large(a) || large(b) { FINE_LARGE } else { FINE };
    assert!((along - gap).abs() < fine, "{label}: gap {gap} but {along} along the normal");
    if gap > -2.0 * a.radius.min(b.radius) + FINE {
        // The cores are apart. A separating direction bounds the distance from below; two points from above.
        for (shape, pose) in [(a, at_a), (b, at_b)] {
            let off = from_surface(shape, pose, point);
            assert!((off - 0.5 * gap).abs() < fine, "{label}: {off} from the surface, gap {gap}");
        }
    } else {
        for d in directions(1000) {
            let out = overlap_along(of_a, of_b, d);
            assert!(
                out > -gap - DEPTH_SHARE * gap.abs() - fine,
                "{label}: {out} along {d} is a shorter way than {gap}"
            );
        }
    }
}

/// Overlaps of round cores end with the faces there is room for: good to this share of the depth.
const DEPTH_SHARE: f64 = 2e-3;

#[test]
fn every_pair_of_shapes_agrees_with_independent_geometry() {
    let mut overlaps = 0;
    for first in 0..KINDS {
        for second in 0..KINDS {
            for seed in 0..24 {
                let label = format!("kinds {first}, {second}, seed {seed}");
                let random = &mut Random::new((first * KINDS + second) as u64 * 1000 + seed);
                let (a, b) = (shape(first, random), shape(second, random));
                let (at_a, at_b) = (pose(random, 0.02 + 0.01 * seed as f64), pose(random, 0.02));
                let found = proximity(&a, &at_a, &b, &at_b);
                check(&label, (&a, &at_a), (&b, &at_b), &found);
                overlaps += usize::from(found.gap < 0.0);

                // The order of arguments only turns the normal.
                let turned = proximity(&b, &at_b, &a, &at_a);
                assert!(
                    (turned.gap - found.gap).abs() < FINE,
                    "{label}: {turned:?} the other way round, not {found:?}"
                );
                // A rigid motion of both carries the answer along.
                let by = pose(random, 1.0);
                let transformed =
                    |p: &Pose| Pose { rotation: by.rotation * p.rotation, position: by.point(p.position) };
                let there = proximity(&a, &transformed(&at_a), &b, &transformed(&at_b));
                assert!((there.gap - found.gap).abs() < FINE, "{label}: {} elsewhere", there.gap);
                assert_eq!(found, proximity(&a, &at_a, &b, &at_b), "{label}: twice the same bits");
            }
        }
    }
    // The scenes must try both halves of the code.
    assert!((200..1000).contains(&overlaps), "{overlaps} overlaps");
}

#[test]
fn every_shape_stands_on_a_plane_by_its_lowest_point() {
    for kind in 0..KINDS {
        for seed in 0..40 {
            let label = format!("kind {kind}, seed {seed}");
            let random = &mut Random::new(seed + 7);
            let body = shape(kind, random);
            let at = pose(random, 0.1);
            let plane = Shape::plane(signed(random) * 0.05, signed(random).normalize());
            let found = proximity(&body, &at, &plane, &Pose::IDENTITY);
            check(&label, (&body, &at), (&plane, &Pose::IDENTITY), &found);
            let normal = plane.place.vector(DVec3::Y);
            assert!(found.normal.distance(normal) < EXACT, "{label}");
            assert_eq!(proximity(&plane, &Pose::IDENTITY, &body, &at).normal, -found.normal, "{label}");
        }
    }
}

#[test]
fn textbook_distances_come_out_to_rounding() {
    let at = |x: f64, y: f64, z: f64| Pose { rotation: DQuat::IDENTITY, position: DVec3::new(x, y, z) };
    let turned = |axis: DVec3, angle: f64, x: f64, y: f64, z: f64| Pose {
        rotation: rotation(axis * angle),
        position: DVec3::new(x, y, z),
    };
    let ball = |r: f64| Shape::sphere(DVec3::ZERO, r);
    let rod = |half: f64, r: f64| Shape::capsule(-half * DVec3::Y, half * DVec3::Y, r);
    let can = |half: f64, r: f64| Shape::cylinder(-half * DVec3::Y, half * DVec3::Y, r, 0.0);
    let cube = |half: f64| Shape::cuboid(Pose::IDENTITY, DVec3::splat(half), 0.0);
    let diagonal = 2.0_f64.sqrt();
    let cases: Vec<(&str, Shape, Pose, Shape, Pose, f64)> = vec![
        ("balls", ball(0.1), at(0.3, 0.4, 0.0), ball(0.15), at(0.0, 0.0, 0.0), 0.25),
        (
            "crossed rods",
            rod(1.0, 0.1),
            at(0.0, 0.0, 0.5),
            rod(1.0, 0.1),
            turned(DVec3::Z, 0.5 * PI, 0.0, 0.0, 0.0),
            0.3,
        ),
        ("parallel rods", rod(1.0, 0.1), at(0.5, 1.5, 0.0), rod(1.0, 0.1), at(0.0, 0.0, 0.0), 0.3),
        ("rods in a line", rod(1.0, 0.1), at(0.0, 2.5, 0.0), rod(1.0, 0.1), at(0.0, 0.0, 0.0), 0.3),
        ("ball over can", ball(0.1), at(0.1, 0.5, 0.1), can(0.2, 0.3), at(0.0, 0.0, 0.0), 0.2),
        ("ball beside can", ball(0.1), at(0.3, 0.1, 0.4), can(0.2, 0.3), at(0.0, 0.0, 0.0), 0.1),
        ("ball at the rim", ball(0.1), at(0.6, 0.6, 0.0), can(0.2, 0.3), at(0.0, 0.0, 0.0), 0.4),
        ("ball in a can", ball(0.1), at(0.0, 0.15, 0.0), can(0.2, 0.3), at(0.0, 0.0, 0.0), -0.15),
        ("ball in a cube", ball(0.1), at(0.05, 0.0, 0.0), cube(0.2), at(0.0, 0.0, 0.0), -0.25),
        ("stacked cans", can(0.2, 0.3), at(0.1, 0.5, 0.0), can(0.2, 0.3), at(0.0, 0.0, 0.0), 0.1),
        ("cans side by side", can(0.2, 0.3), at(0.6, 0.1, 0.8), can(0.2, 0.3), at(0.0, 0.0, 0.0), 0.4),
        ("rims of parallel cans", can(0.2, 0.3), at(0.9, 0.8, 0.0), can(0.2, 0.3), at(0.0, 0.0, 0.0), 0.5),
        ("can in a can", can(0.1, 0.1), at(0.0, 0.0, 0.0), can(0.2, 0.3), at(0.0, 0.0, 0.0), -0.3),
        (
            "crossed cans",
            can(1.0, 0.1),
            at(0.0, 0.0, 0.5),
            can(1.0, 0.2),
            turned(DVec3::Z, 0.5 * PI, 0.0, 0.0, 0.0),
            0.2,
        ),
        (
            "crossed cans, overlapping",
            can(1.0, 0.2),
            at(0.0, 0.0, 0.3),
            can(1.0, 0.2),
            turned(DVec3::Z, 0.5 * PI, 0.0, 0.0, 0.0),
            -0.1,
        ),
        ("cubes face to face", cube(0.1), at(0.0, 0.25, 0.05), cube(0.1), at(0.0, 0.0, 0.0), 0.05),
        ("cubes overlapping", cube(0.1), at(0.01, 0.15, 0.05), cube(0.1), at(0.0, 0.0, 0.0), -0.05),
        (
            "edge over face",
            cube(0.1),
            turned(DVec3::Z, 0.25 * PI, 0.0, 0.3, 0.0),
            cube(0.1),
            at(0.0, 0.0, 0.0),
            0.2 - 0.1 * diagonal,
        ),
        (
            "edge in face",
            cube(0.1),
            turned(DVec3::Z, 0.25 * PI, 0.0, 0.22, 0.0),
            cube(0.1),
            at(0.0, 0.0, 0.0),
            0.12 - 0.1 * diagonal,
        ),
        (
            "crossed edges",
            cube(0.1),
            turned(DVec3::X, 0.25 * PI, 0.0, 0.25, 0.0),
            cube(0.1),
            turned(DVec3::Z, 0.25 * PI, 0.0, 0.0, 0.0),
            0.25 - 0.2 * diagonal,
        ),
    ];
    for (name, a, at_a, b, at_b, gap) in cases {
        let found = proximity(&a, &at_a, &b, &at_b);
        // The polytope of a round overlap is good to its share.
        let allowed = if name.contains("cans, over") { 1e-4 } else { EXACT };
        assert!((found.gap - gap).abs() < allowed, "{name}: {} instead of {gap}", found.gap);
        check(name, (&a, &at_a), (&b, &at_b), &found);
    }
}

#[test]
fn shapes_inside_each_other_have_some_way_out() {
    let shapes = |seed: u64| -> Vec<Shape> {
        let random = &mut Random::new(seed);
        let mut all: Vec<Shape> = (0..KINDS).map(|kind| shape(kind, random)).collect();
        // All about the origin, axes parallel, some without width.
        all.push(Shape::sphere(DVec3::ZERO, 0.0));
        all.push(Shape::capsule(-DVec3::Y, DVec3::Y, 0.0));
        all.push(Shape::capsule(DVec3::ZERO, DVec3::ZERO, 0.01));
        all.push(Shape::cylinder(-DVec3::Y, DVec3::Y, 0.5, 0.0));
        all.push(Shape::cuboid(Pose::IDENTITY, DVec3::new(0.1, 0.1, 0.0), 0.0));
        all.push(Shape::cuboid(Pose::IDENTITY, DVec3::splat(0.1), 0.0));
        all.push(Shape::plate(&[DVec3::X, DVec3::Y, -DVec3::X, -DVec3::Y], 0.0));
        all.push(Shape::plate(&[DVec3::X, DVec3::Z, -DVec3::X, -DVec3::Z], 0.001));
        all.push(Shape::hull(&[DVec3::X], 0.001));
        all.push(Shape::hull(&[DVec3::X, -DVec3::X, 0.5 * DVec3::X], 0.001));
        all
    };
    for seed in 0..4 {
        let all = shapes(seed);
        let random = &mut Random::new(seed + 1000);
        for (i, a) in all.iter().enumerate() {
            for (j, b) in all.iter().enumerate() {
                let motion = [Pose::IDENTITY, pose(random, 0.0), pose(random, 1e-9), pose(random, 1e-4)];
                for (k, at_a) in motion.iter().enumerate() {
                    let found = proximity(a, at_a, b, &Pose::IDENTITY);
                    let label = format!("seed {seed}, shapes {i} in {j}, pose {k}");
                    check(&label, (a, at_a), (b, &Pose::IDENTITY), &found);
                    // Moved out by the depth they touch.
                    if found.gap < 0.0 {
                        let out = Pose { position: at_a.position - found.gap * found.normal, ..*at_a };
                        let touching = proximity(a, &out, b, &Pose::IDENTITY).gap;
                        assert!(touching.abs() < FINE - DEPTH_SHARE * found.gap, "{label}: {touching} after {found:?}");
                    }
                }
            }
        }
    }
}

fn collider(body: Option<usize>, shape: Shape) -> Collider {
    Collider { body, shape, material: 0, node: String::new() }
}

//! Points of contact: where they are, how many, how far apart.

use soffio_math::noise::Random;
use soffio_math::{DQuat, DVec3, PI, Pose, rotation};
use soffio_multibody::collision::{Manifold, ManifoldBuilder, Shape, proximity};

use super::{EXACT, KINDS, collider, from_surface, plate, pose, shape, signed};

/// A face that leans by 0.03 lies by that definition: its ball touches 0.03² / 2 of its radius (2 mm) off.
const ON_SURFACE: f64 = 2e-6;
/// Edges that cross at 0.01 part sideways by a millimetre within 10 cm: from a round one of 3 mm by δ²/2r.
const ON_EDGES: f64 = 2e-4;

fn manifold(a: &Shape, at_a: &Pose, b: &Shape, at_b: &Pose) -> Manifold {
    let (a, b) = (collider(Some(0), a.clone()), collider(None, b.clone()));
    ManifoldBuilder::new(&[a.clone(), b.clone()]).manifold(&a, at_a, &b, at_b)
}

fn at(x: f64, y: f64, z: f64) -> Pose {
    Pose { rotation: DQuat::IDENTITY, position: DVec3::new(x, y, z) }
}

fn tilted(axis: DVec3, angle: f64, y: f64) -> Pose {
    Pose { rotation: rotation(axis * angle), position: DVec3::Y * y }
}

fn ground() -> Shape {
    Shape::plane(DVec3::ZERO, DVec3::Y)
}

fn block(x: f64, y: f64, z: f64) -> Shape {
    Shape::cuboid(Pose::IDENTITY, DVec3::new(x, y, z), 0.0)
}

/// Points as a sorted list, for sets.
fn sorted(m: &Manifold) -> Vec<[f64; 3]> {
    // Coordinates to the nanometre, so that order does not hang on rounding.
    let mut all: Vec<[f64; 3]> =
        m.points().iter().map(|p| p.point.to_array().map(|x| (x * 1e9).round() * 1e-9 + 0.0)).collect();
    all.sort_by(|p, q| p.partial_cmp(q).expect("numbers"));
    all
}

fn assert_points(m: &Manifold, gap: f64, expected: &[[f64; 3]]) {
    let found = sorted(m);
    assert_eq!(found.len(), expected.len(), "{m:?}");
    for (p, q) in found.iter().zip(expected) {
        assert!(DVec3::from(*p).distance(DVec3::from(*q)) < 2.0 * EXACT, "{p:?} is not {q:?} in {m:?}");
    }
    assert!(m.points().iter().all(|p| (p.gap - gap).abs() < EXACT), "gaps in {m:?} are not {gap}");
}

#[test]
fn equal_faces_touch_at_their_corners_however_little_they_are_turned() {
    /// A point of contact jumps from a corner to where edges cross by no more than this, m.
    const NEAR: f64 = 1e-3;
    let half = 0.05;
    let cube = block(half, half, half);
    for angle in [0.0, 1e-14, 1e-9, 1e-7, 1e-5, 1e-4, 1e-3] {
        let m = manifold(&cube, &tilted(DVec3::Y, angle, 2.0 * half), &cube, &at(0.0, 0.0, 0.0));
        let corners: Vec<_> = m.points().iter().map(|p| [p.point.x > 0.0, p.point.z > 0.0]).collect();
        assert!((0..4).all(|k| (0..k).all(|j| corners[j] != corners[k])), "turned by {angle}: {m:?}");
        for p in m.points() {
            let off = (p.point.x.abs() - half).abs().max((p.point.z.abs() - half).abs());
            assert!(off < NEAR, "turned by {angle}: {} is {off} m from its corner", p.point);
        }
    }
}

#[test]
fn a_face_on_a_face_touches_at_the_corners_of_what_they_share() {
    let small = block(0.1, 0.05, 0.1);
    // Half over the edge of a larger block, apart, touching and sunk in.
    for gap in [1e-3, 0.0, -1e-6, -1e-3] {
        let m = manifold(&small, &at(0.25, 0.1 + gap, 0.0), &block(0.2, 0.05, 0.2), &at(0.0, 0.0, 0.0));
        let y = 0.05 + 0.5 * gap;
        assert_points(&m, gap, &[[0.15, y, -0.1], [0.15, y, 0.1], [0.2, y, -0.1], [0.2, y, 0.1]]);
        assert!(m.normal.distance(DVec3::Y) < EXACT);
    }
    // Turned by an eighth on itself, the shared octagon has more corners than are kept, all on its rim.
    let m = manifold(&small, &tilted(DVec3::Y, 0.25 * PI, 0.1), &small, &at(0.0, 0.0, 0.0));
    assert_eq!(m.count, 4);
    let rim = 0.1 / (PI / 8.0).cos();
    assert!(m.points().iter().all(|p| (p.point.x.hypot(p.point.z) - rim).abs() < EXACT && p.gap.abs() < EXACT));
    let sum: DVec3 = m.points().iter().map(|p| p.point).sum();
    assert!((0.25 * sum).distance(0.05 * DVec3::Y) < 0.03, "{m:?} does not surround the middle");
}

#[test]
fn sheet_metal_on_sheet_metal_touches_all_around() {
    let square = |half: f64| {
        Shape::plate(
            &[(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)].map(|(x, z)| DVec3::new(x * half, 0.0, z * half)),
            5e-4,
        )
    };
    let m = manifold(&square(0.05), &at(0.03, 1.001e-3, 0.0), &square(0.04), &at(0.0, 0.0, 0.0));
    let y = 5.005e-4;
    assert_points(&m, 1e-6, &[[-0.02, y, -0.04], [-0.02, y, 0.04], [0.04, y, -0.04], [0.04, y, 0.04]]);
}

#[test]
fn round_things_touch_as_their_shape_says() {
    let can = Shape::cylinder(-0.1 * DVec3::Y, 0.1 * DVec3::Y, 0.03, 0.0);
    // On its end: four points a quarter apart on the rim.
    let m = manifold(&can, &at(0.0, 0.1, 0.0), &ground(), &Pose::IDENTITY);
    assert_eq!(m.count, 4);
    let sum: DVec3 = m.points().iter().map(|p| p.point).sum();
    assert!(sum.length() < EXACT && m.points().iter().all(|p| (p.point.length() - 0.03).abs() < EXACT), "{m:?}");
    // On its side, and a capsule on a plane and along a block: both ends.
    let lying = tilted(DVec3::Z, 0.5 * PI, 0.03);
    assert_points(&manifold(&can, &lying, &ground(), &Pose::IDENTITY), 0.0, &[[-0.1, 0.0, 0.0], [0.1, 0.0, 0.0]]);
    let rod = Shape::capsule(-0.1 * DVec3::Y, 0.1 * DVec3::Y, 0.03);
    assert_points(&manifold(&rod, &lying, &ground(), &Pose::IDENTITY), 0.0, &[[-0.1, 0.0, 0.0], [0.1, 0.0, 0.0]]);
    let under = block(0.06, 0.1, 0.1);
    assert_points(&manifold(&rod, &lying, &under, &at(0.0, -0.1, 0.0)), 0.0, &[[-0.06, 0.0, 0.0], [0.06, 0.0, 0.0]]);
    // Beside each other, crossed, upright, and balls.
    let beside = Pose { position: DVec3::new(0.05, 0.09, 0.0), ..lying };
    assert_points(&manifold(&rod, &beside, &rod, &lying), 0.0, &[[-0.05, 0.06, 0.0], [0.1, 0.06, 0.0]]);
    let crossed = Pose { rotation: rotation(DVec3::X * 0.5 * PI), position: 0.09 * DVec3::Y };
    assert_points(&manifold(&rod, &crossed, &rod, &lying), 0.0, &[[0.0, 0.06, 0.0]]);
    assert_points(&manifold(&rod, &at(0.0, 0.13, 0.0), &ground(), &Pose::IDENTITY), 0.0, &[[0.0; 3]]);
    let ball = Shape::sphere(DVec3::ZERO, 0.02);
    assert_points(&manifold(&ball, &at(0.0, 0.02, 0.0), &under, &at(0.0, -0.1, 0.0)), 0.0, &[[0.0; 3]]);
    // A can's end on a larger can's end: all of its rim lies on it.
    let wide = Shape::cylinder(-0.1 * DVec3::Y, 0.1 * DVec3::Y, 0.06, 0.0);
    let m = manifold(&can, &at(0.01, 0.2, 0.0), &wide, &at(0.0, 0.0, 0.0));
    assert!(m.count == 4 && m.points().iter().all(|p| (p.point.x - 0.01).hypot(p.point.z) > 0.03 - EXACT), "{m:?}");
}

#[test]
fn what_leans_touches_where_it_is_lowest() {
    let cube = block(0.1, 0.1, 0.1);
    // On an edge: its two ends. On a corner: one point. Leaning by a hundredth: four points, two of them up.
    let on_edge = tilted(DVec3::Z, 0.25 * PI, 0.1 * 2.0_f64.sqrt());
    assert_points(&manifold(&cube, &on_edge, &ground(), &Pose::IDENTITY), 0.0, &[[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]);
    assert_points(&manifold(&cube, &on_edge, &cube, &at(0.0, -0.1, 0.05)), 0.0, &[[0.0, 0.0, -0.05], [0.0, 0.0, 0.1]]);
    let on_corner = tilted(DVec3::new(1.0, 0.3, -0.7).normalize(), 0.7, 0.2);
    assert_eq!(manifold(&cube, &on_corner, &ground(), &Pose::IDENTITY).count, 1);
    let tilt = 0.01_f64;
    let m = manifold(&cube, &tilted(DVec3::Z, tilt, 0.1 * (tilt.cos() + tilt.sin())), &ground(), &Pose::IDENTITY);
    let mut gaps: Vec<f64> = m.points().iter().map(|p| p.gap).collect();
    gaps.sort_by(f64::total_cmp);
    assert_eq!(gaps.len(), 4);
    for (gap, expected) in gaps.iter().zip([0.0, 0.0, 0.2 * tilt.sin(), 0.2 * tilt.sin()]) {
        assert!((gap - expected).abs() < EXACT, "{gaps:?}");
    }
}

#[test]
fn every_point_lies_on_both_surfaces() {
    let mut counts = [0; 5];
    for seed in 0..3000_u64 {
        let random = &mut Random::new(seed);
        let (first, second) = ((random.word() % KINDS as u64) as usize, (random.word() % KINDS as u64) as usize);
        let (a, b) = (shape(first, random), shape(second, random));
        // Faces that lie on each other are rare by chance: half of the scenes turn the one by right angles nearly.
        let mut at_a = pose(random, 0.05);
        let mut at_b = pose(random, 0.05);
        if seed.is_multiple_of(2) {
            let (x, z) = ((random.word() % 4) as f64, (random.word() % 4) as f64);
            let right = rotation(DVec3::X * 0.5 * PI * x) * rotation(DVec3::Z * 0.5 * PI * z);
            let upright = |s: &Shape| s.place.rotation.inverse();
            at_a.rotation = rotation(signed(random) * 5e-3) * right * upright(&a);
            at_b.rotation = upright(&b);
        }
        // Put just apart, so that distances of surfaces are defined everywhere.
        let near = proximity(&a, &at_a, &b, &at_b);
        at_a.position += (1e-4 - near.gap) * near.normal;
        let near = proximity(&a, &at_a, &b, &at_b);
        let m = manifold(&a, &at_a, &b, &at_b);
        let label = format!("seed {seed}, kinds {first} on {second}: {m:?}, nearest {near:?}");
        assert!((1..=4).contains(&m.count), "{label}");
        counts[m.count] += 1;
        assert_eq!(m, manifold(&a, &at_a, &b, &at_b), "{label}");
        let least = m.points().iter().map(|p| p.gap).fold(f64::INFINITY, f64::min);
        assert!((least - near.gap).abs() < ON_SURFACE, "{label}");
        for p in m.points() {
            let half = 0.5 * p.gap * m.normal;
            let (on_a, on_b) = (from_surface(&a, &at_a, p.point + half), from_surface(&b, &at_b, p.point - half));
            let allowed = if m.count <= 3 { ON_EDGES } else { ON_SURFACE };
            assert!(on_a.abs() < allowed && on_b.abs() < allowed, "{on_a}, {on_b}: {label}");
        }
    }
    // All kinds of contact were tried.
    assert!(counts[1..].iter().all(|&n| n >= 10), "{counts:?}");
}

#[test]
fn plates_of_many_corners_keep_the_four_that_hold_most() {
    for seed in 0..50 {
        let random = &mut Random::new(seed);
        let disc = plate(random, 24, 5e-4);
        let flat = Pose { rotation: rotation(DVec3::X * 0.5 * PI), position: 5e-4 * DVec3::Y };
        let m = manifold(&disc, &flat, &ground(), &Pose::IDENTITY);
        assert_eq!(m.count, 4, "seed {seed}");
        // The best four of an ellipse hold 2/π of it; these begin where the feature does.
        let [p, q, r, s] = [0, 1, 2, 3].map(|k| m.points[k].point);
        let covered = 0.5 * (r - p).cross(s - q).length();
        let corners: Vec<DVec3> = super::outline(&disc, &flat);
        let area: f64 = (1..corners.len() - 1)
            .map(|k| 0.5 * (corners[k] - corners[0]).cross(corners[k + 1] - corners[0]).length())
            .sum();
        assert!(covered > 0.45 * area, "seed {seed}: {covered} of {area}");
    }
}

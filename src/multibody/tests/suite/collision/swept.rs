//! Time of impact: nothing passes through anything.

use soffio_geometry::bodies::{MassProperties, RigidBody};
use soffio_math::noise::Random;
use soffio_math::{DMat3, DVec3, PI, Pose, rotation};
use soffio_multibody::collision::{
    CONTACT_MARGIN, Collider, ManifoldBuilder, MovingCollider, Shape, Sweep, proximity, time_of_impact,
};

use super::{EXACT, KINDS, collider, pose, shape, signed};

/// A body at a pose that moves and turns for `dt` seconds, as sweep.
fn sweep(at: Pose, velocity: DVec3, spin: DVec3, dt: f64) -> Sweep {
    let properties = MassProperties { mass: 1.0, center: DVec3::ZERO, inertia: DMat3::IDENTITY };
    let before = RigidBody::at_rest(properties, at);
    let mut after = before;
    after.displace(velocity * dt, spin * dt);
    Sweep::new(&before, &after)
}

fn sheet(half_x: f64, half_y: f64) -> Shape {
    let corners = [(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)];
    Shape::plate(&corners.map(|(x, y)| DVec3::new(x * half_x, y * half_y, 0.0)), 5e-4)
}

fn bounding_radius(c: &Collider) -> f64 {
    c.shape.bounding_radius(DVec3::ZERO)
}

#[test]
fn a_millimetre_of_sheet_at_twenty_metres_a_second_passes_nothing() {
    // Four steps at once: a third of a metre.
    const DT: f64 = 1.0 / 60.0;
    const SPEED: f64 = 20.0;
    let mut hits = 0;
    for seed in 0..400 {
        let random = &mut Random::new(seed);
        let flying = collider(Some(0), sheet(0.05, 0.08));
        // The other is sheet as well, or anything, or a plane; it turns and may fly too.
        let other = match seed % 3 {
            0 => sheet(0.07, 0.06),
            1 => shape((seed / 3) as usize % KINDS, random),
            _ => Shape::plane(DVec3::ZERO, signed(random).normalize()),
        };
        let is_static = other.is_plane();
        let other = collider(if is_static { None } else { Some(1) }, other);
        let toward = if is_static { -other.shape.place.vector(DVec3::Y) } else { signed(random).normalize() };
        // It starts clear of the other and would end behind it.
        let from = Pose { position: other.shape.middle() - toward * 0.6 * SPEED * DT, ..pose(random, 0.0) };
        let spins = [signed(random) * 60.0, if is_static { DVec3::ZERO } else { signed(random) * 60.0 }];
        let moving = sweep(from, toward * SPEED, spins[0], DT);
        let second_sweep = if is_static { Sweep::STATIC } else { sweep(Pose::IDENTITY, DVec3::ZERO, spins[1], DT) };
        let found = time_of_impact(
            &ManifoldBuilder::default(),
            MovingCollider { collider: &flying, sweep: &moving, bounding_radius: bounding_radius(&flying) },
            MovingCollider { collider: &other, sweep: &second_sweep, bounding_radius: bounding_radius(&other) },
        );
        let gap = |s: f64| proximity(&flying.shape, &moving.pose(s), &other.shape, &second_sweep.pose(s)).gap;
        let Some(impact) = found else {
            // A body that rotates out of the way is missed; the samples are 0.4 mm apart.
            assert!((0..=1000).all(|k| gap(f64::from(k) / 1000.0) > 0.0), "seed {seed}: passed through");
            continue;
        };
        hits += 1;
        // It stands at the surface: not beyond, and not far before.
        let there = gap(impact.s);
        assert!(there > -EXACT && there < 50.0 * CONTACT_MARGIN, "seed {seed}: gap {there} at {}", impact.s);
        // Nothing touched before.
        for k in 0..200 {
            let s = impact.s * f64::from(k) / 200.0;
            assert!(gap(s) > 0.0, "seed {seed}: in each other at {s}, reported at {}", impact.s);
        }
    }
    assert!(hits > 350, "only {hits} of 400 met");
}

#[test]
fn any_shapes_meet_when_sampling_says_so() {
    let mut collisions = 0;
    for seed in 0..600 {
        let random = &mut Random::new(seed + 5000);
        let (a, b) = (shape(seed as usize % KINDS, random), shape((seed / 7) as usize % KINDS, random));
        let (a, b) = (collider(Some(0), a), collider(Some(1), b));
        let (at_a, at_b) = (pose(random, 0.15), pose(random, 0.15));
        let sweep_a = sweep(at_a, signed(random) * 20.0, signed(random) * 100.0, 0.005);
        let sweep_b = sweep(at_b, signed(random) * 20.0, signed(random) * 100.0, 0.005);
        let gap = |s: f64| proximity(&a.shape, &sweep_a.pose(s), &b.shape, &sweep_b.pose(s)).gap;
        let found = time_of_impact(
            &ManifoldBuilder::default(),
            MovingCollider { collider: &a, sweep: &sweep_a, bounding_radius: bounding_radius(&a) },
            MovingCollider { collider: &b, sweep: &sweep_b, bounding_radius: bounding_radius(&b) },
        );
        let sampled = (0..=2000).map(|k| f64::from(k) / 2000.0).find(|&s| gap(s) < 0.0);
        if let Some(s) = sampled {
            collisions += 1;
            let Some(impact) = found else { panic!("seed {seed}: meeting at {s} not seen") };
            assert!(impact.s <= s, "seed {seed}: {} is after {s}", impact.s);
            assert!(
                impact.s == 0.0 || gap(impact.s).abs() < 50.0 * CONTACT_MARGIN,
                "seed {seed}: gap {} at {}",
                gap(impact.s),
                impact.s
            );
        }
    }
    assert!((50..500).contains(&collisions), "{collisions} met");
}

#[test]
fn a_ball_falls_on_a_plane_in_its_own_time() {
    // A ball that spins about its centre turns into itself: it is the fall alone that counts.
    let ball = collider(Some(0), Shape::sphere(DVec3::ZERO, 0.02));
    let floor = collider(None, Shape::plane(DVec3::ZERO, DVec3::Y));
    let from = Pose { rotation: rotation(DVec3::X), position: DVec3::new(1.0, 0.1, 2.0) };
    let falling = sweep(from, DVec3::new(3.0, -16.0, 0.0), DVec3::splat(PI), 0.01);
    let impact = time_of_impact(
        &ManifoldBuilder::default(),
        MovingCollider { collider: &ball, sweep: &falling, bounding_radius: bounding_radius(&ball) },
        MovingCollider { collider: &floor, sweep: &Sweep::STATIC, bounding_radius: bounding_radius(&floor) },
    )
    .expect("it falls on it");
    assert!((impact.s - 0.5).abs() < CONTACT_MARGIN / 0.16, "{}", impact.s);
    assert!(impact.proximity.normal.distance(DVec3::Y) < EXACT);
    // One that turns with a driven plane is met, one that the plane turns away from is not.
    let up = sweep(Pose::IDENTITY, DVec3::ZERO, DVec3::Z * 20.0, 0.01);
    let kinematic = collider(Some(1), Shape::plane(DVec3::ZERO, DVec3::Y));
    for (x, meets) in [(1.0, true), (-1.0, false)] {
        let at = sweep(Pose { position: DVec3::new(x, 0.1, 0.0), ..from }, DVec3::ZERO, DVec3::ZERO, 0.01);
        let impact = time_of_impact(
            &ManifoldBuilder::default(),
            MovingCollider { collider: &ball, sweep: &at, bounding_radius: bounding_radius(&ball) },
            MovingCollider { collider: &kinematic, sweep: &up, bounding_radius: bounding_radius(&kinematic) },
        );
        assert_eq!(impact.is_some(), meets, "ball at {x}");
    }
}

//! Many contacts: full floors, towers, heaps.

use super::*;
use soffio_math::noise::Random;

/// Resting bodies sink and drift by no more than this, m.
const DRIFT: f64 = 1e-4;

fn boxes(half: f64, places: impl Iterator<Item = DVec3>) -> Scene {
    let mass = 500.0 * 8.0 * half * half * half;
    let bodies: Vec<_> = places.map(|place| cube(mass, DVec3::splat(half), place)).collect();
    let colliders = (0..bodies.len()).map(|body| block(body, DVec3::splat(half))).chain([floor()]).collect();
    Scene { restitution: 0.0, ..Scene::new(bodies, colliders) }
}

/// How far the farthest body is from where it was, m.
fn drift(dynamics: &Dynamics, before: &[RigidBody]) -> f64 {
    dynamics.bodies.iter().zip(before).map(|(now, then)| now.position.distance(then.position)).fold(0.0, f64::max)
}

/// The deepest overlap of any two colliders, m.
fn overlap(scene: &Scene, dynamics: &Dynamics) -> f64 {
    let pose = |collider: &Collider| collider.body.map_or(Pose::IDENTITY, |body| dynamics.bodies[body].pose());
    let of_pair = |pair: soffio_multibody::collision::ColliderPair| {
        let [a, b] = [pair.a, pair.b].map(|index| &scene.colliders[index]);
        -soffio_multibody::collision::proximity(&a.shape, &pose(a), &b.shape, &pose(b)).gap
    };
    pairs(&scene.colliders, &[], &ReachableVolumes::default()).meet.into_iter().map(of_pair).fold(0.0, f64::max)
}

#[test]
fn a_floor_bears_a_hundred_boxes() {
    let scene = boxes(0.05, (0..100).map(|i| DVec3::new(0.15 * f64::from(i % 10), 0.05, 0.15 * f64::from(i / 10))));
    let mut dynamics = scene.dynamics();
    let before = dynamics.bodies.clone();
    run(&mut dynamics, 5.0);
    assert!(drift(&dynamics, &before) < DRIFT, "{} m", drift(&dynamics, &before));
    assert!((0..100).all(|body| dynamics.is_asleep(body)), "boxes on a floor sleep");
}

#[test]
fn a_tower_of_ten_boxes_stands_and_sleeps() {
    let scene = boxes(0.05, (0..10).map(|i| DVec3::Y * (0.05 + 0.1 * f64::from(i))));
    let mut dynamics = scene.dynamics();
    let before = dynamics.bodies.clone();
    run(&mut dynamics, 10.0);
    assert!(drift(&dynamics, &before) < DRIFT, "{} m", drift(&dynamics, &before));
    assert!((0..10).all(|body| dynamics.is_asleep(body)));
}

#[test]
fn a_tower_of_twenty_put_exactly_on_each_other_stays_where_it_is() {
    /// m: it has nowhere to fall, and the solver's error is less than the contact layer.
    const STAYS: f64 = 1e-5;
    let scene = boxes(0.05, (0..20).map(|i| DVec3::Y * (0.05 + 0.1 * f64::from(i))));
    let mut dynamics = scene.dynamics();
    let before = dynamics.bodies.clone();
    let (no_wrenches, mut impacts) = (vec![[0.0; 6]; 20], Vec::new());
    for step in 0..1200 {
        dynamics.step(DT, &no_wrenches, &mut impacts);
        let displacement = drift(&dynamics, &before);
        assert!(displacement < STAYS, "step {step}: {displacement} m");
    }
    assert!((0..20).all(|body| dynamics.is_asleep(body)), "it sleeps after five seconds");
    assert!(impacts.is_empty(), "contacts from the beginning are no impacts");
}

/// Boxes that fall on each other from a column.
fn heap(count: usize) -> Scene {
    let mut random = Random::new(3);
    let mut scene = boxes(0.03, (0..count).map(|i| DVec3::new(0.0, 0.1 + 0.08 * i as f64, 0.0)));
    for body in &mut scene.bodies {
        body.position += 0.05 * DVec3::new(random.signed(), 0.0, random.signed());
        body.rotation = rotation(DVec3::new(random.signed(), random.signed(), random.signed()));
    }
    scene.restitution = 0.2;
    scene
}

#[test]
fn a_heap_comes_to_rest_and_gains_no_energy() {
    /// Fraction of the energy of the fall: moving overlapping bodies apart lifts them.
    const GAIN: f64 = 1e-2;
    let scene = heap(20);
    let mut dynamics = scene.dynamics();
    let no_wrenches = vec![[0.0; 6]; dynamics.bodies.len()];
    let (start, mut least, mut gain, mut impacts) = (dynamics.energy(), f64::INFINITY, 0.0, Vec::new());
    for _ in 0..1200 {
        assert_eq!(dynamics.step(DT, &no_wrenches, &mut impacts), None);
        gain = f64::max(gain, dynamics.energy() - least);
        least = least.min(dynamics.energy());
    }
    assert!(gain < GAIN * (start - least), "gained {gain} J of {} J", start - least);
    let fastest = dynamics.bodies.iter().map(|body| body.velocity.length()).fold(0.0, f64::max);
    assert!(fastest < 1e-2, "{fastest} m/s after five seconds");
    assert!(overlap(&scene, &dynamics) < DRIFT, "{} m", overlap(&scene, &dynamics));
}

#[test]
fn a_heap_that_is_too_much_for_a_step_comes_to_rest_and_sleeps() {
    /// Operations of a step that changes to time stepping.
    const BUDGET: u64 = 3_000_000;
    let mut dynamics = heap(50).dynamics();
    let (no_wrenches, mut impacts) = (vec![[0.0; 6]; 50], Vec::new());
    let mut most = 0;
    for _ in 0..2400 {
        assert_eq!(dynamics.step(DT, &no_wrenches, &mut impacts), None);
        most = most.max(dynamics.operations());
    }
    assert!(most > BUDGET, "{most} operations are none too many");
    let awake = (0..50).filter(|&body| !dynamics.is_asleep(body)).count();
    assert_eq!(awake, 0, "all sleep after ten seconds");
}

#[test]
fn the_same_heap_ends_in_the_same_bits() {
    let ends = || {
        let mut dynamics = heap(12).dynamics();
        run(&mut dynamics, 1.5);
        dynamics.bodies
    };
    assert_eq!(ends(), ends());
}

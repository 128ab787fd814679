//! Which pairs can meet: exclusion with its reasons, reachable volumes, broad phase.

use soffio_geometry::bodies::{MassProperties, RigidBody};
use soffio_math::noise::Random;
use soffio_math::{DMat3, DQuat, DVec3, PI, Pose, rotation};
use soffio_multibody::collision::reachable_volume::{FixedAxis, JointEnd, JointPoint};
use soffio_multibody::collision::{
    BroadPhase, Collider, ColliderPair, Excluded, Exclusion, ManifoldBuilder, MovingCollider, PairExclusion,
    ReachableVolumes, Shape, Sweep, pairs, proximity, time_of_impact,
};

use super::{KINDS, collider, pose, shape, signed};

fn ball(body: Option<usize>, at: DVec3, radius: f64) -> Collider {
    collider(body, Shape::sphere(at, radius))
}

fn end(body: impl Into<Option<usize>>, point: DVec3) -> JointEnd {
    JointEnd { body: body.into(), point }
}

#[test]
fn every_pair_left_out_has_its_reason() {
    // Body 0 hangs from a nail, body 1 from body 0, body 2 from a nail far off, body 3 is free.
    let x = DVec3::X;
    let colliders = [
        ball(Some(0), DVec3::ZERO, 0.1),
        ball(Some(0), x, 0.1),
        ball(Some(1), DVec3::ZERO, 0.1),
        ball(Some(2), DVec3::ZERO, 0.1),
        ball(Some(3), DVec3::ZERO, 0.1),
        ball(None, 10.0 * x, 0.1),
        ball(None, 11.0 * x, 0.1),
    ];
    let poses = [0.0, 1.0, 5.0, 2.0].map(|at| Pose { rotation: DQuat::IDENTITY, position: at * x });
    let joints = [
        [end(0, DVec3::ZERO), end(None, DVec3::ZERO)],
        [end(0, x), end(1, DVec3::ZERO)],
        [end(2, DVec3::ZERO), end(None, 5.0 * x)],
    ];
    let bounding_radius = ReachableVolumes::new(&colliders, &poses, &joints, &[]);
    let excluded = [
        Exclusion { bodies: (Some(1), Some(0)), why: Excluded::Joined },
        Exclusion { bodies: (None, Some(3)), why: Excluded::ByCurator },
    ];
    let found = pairs(&colliders, &excluded, &bounding_radius);
    let reason = |a: usize, b: usize| found.left_out.iter().find(|(p, _)| (p.a, p.b) == (a, b)).map(|(_, r)| *r);
    assert_eq!(reason(0, 1), Some(PairExclusion::SameBody));
    assert_eq!(reason(0, 2), Some(PairExclusion::Excluded(Excluded::Joined)));
    assert_eq!(reason(4, 5), Some(PairExclusion::Excluded(Excluded::ByCurator)));
    assert_eq!(reason(5, 6), Some(PairExclusion::BothStill));
    // Body 1 stays within 1.1 m of the nail at 0, body 2 within 0.1 m of the one at 5.
    let Some(PairExclusion::Unreachable(apart)) = reason(2, 3) else { panic!("{found:?}") };
    assert!((apart - 3.8).abs() < 1e-4, "{apart}");
    let Some(PairExclusion::Unreachable(apart)) = reason(2, 5) else { panic!("{found:?}") };
    assert!((apart - 8.8).abs() < 1e-4, "{apart}");
    // The free body may meet all but the world; every pair is reported once.
    let free = [(0, 4), (1, 4), (2, 4), (3, 4)].map(|(a, b)| ColliderPair { a, b });
    assert_eq!(found.meet, free);
    assert_eq!(found.meet.len() + found.left_out.len(), 7 * 6 / 2);
    let said = found.left_out.iter().map(|(_, reason)| reason.to_string()).collect::<Vec<_>>().join("; ");
    for words in ["parts of one body", "both stand still", "joined by a constraint", "by the curator", "by 3800.0 mm"] {
        assert!(said.contains(words), "no \"{words}\" in {said}");
    }
    // An open joint holds nothing.
    let scattered = [Pose::IDENTITY, Pose::IDENTITY, poses[2], poses[3]];
    assert!(ReachableVolumes::new(&colliders, &scattered, &joints, &[]).clearance(2, 3) < 0.0);
}

/// A random tree of bodies hanging from world anchors: each body's parent (or the world) and the joint.
fn tree(random: &mut Random, count: usize) -> (Vec<Collider>, Vec<Pose>, Vec<JointPoint>) {
    let (mut colliders, mut poses, mut joints): (Vec<Collider>, Vec<Pose>, Vec<JointPoint>) = Default::default();
    for body in 0..count {
        let kind = (random.word() % KINDS as u64) as usize;
        colliders.push(collider(Some(body), shape(kind, random)));
        let rotation = rotation(signed(random) * PI);
        let own = signed(random) * 0.1;
        let parent = (random.unit() < 0.75 && body > 0).then(|| (random.word() % body as u64) as usize);
        let point = signed(random) * if parent.is_some() { 0.1 } else { 0.6 };
        let at = parent.map_or(point, |p| poses[p].point(point));
        poses.push(Pose { rotation, position: at - rotation * own });
        joints.push([end(body, own), end(parent, point)]);
    }
    (colliders, poses, joints)
}

#[test]
fn no_motion_of_a_tree_leaves_its_bounds() {
    let mut bounded = 0;
    for seed in 0..60 {
        let random = &mut Random::new(seed);
        let (mut colliders, mut poses, joints) = tree(random, 8);
        // The first body turns about a line through its nail only.
        let axis = FixedAxis { body: 0, point: joints[0][1].point, direction: signed(random).normalize() };
        for _ in 0..3 {
            colliders.push(collider(None, shape((random.word() % KINDS as u64) as usize, random)));
        }
        colliders.push(collider(None, Shape::plane(DVec3::Y * -0.6, DVec3::Y)));
        let bounding_radius = ReachableVolumes::new(&colliders, &poses, &joints, &[axis]);
        let resting: Vec<(usize, usize, f64)> = (0..colliders.len())
            .flat_map(|i| (i + 1..colliders.len()).map(move |j| (i, j)))
            .map(|(i, j)| (i, j, bounding_radius.clearance(i, j)))
            .filter(|(i, j, apart)| *apart > 0.0 && colliders[*i].body != colliders[*j].body)
            .collect();
        bounded += resting.len();
        for motion in 0..40 {
            for body in 0..8 {
                let rotation = if body == 0 {
                    rotation(axis.direction * random.signed() * PI)
                } else {
                    rotation(signed(random) * PI)
                };
                let rotation = (rotation * poses[body].rotation).normalize();
                let [own, other] = joints[body];
                let at = other.body.map_or(other.point, |p| poses[p].point(other.point));
                poses[body] = Pose { rotation, position: at - rotation * own.point };
            }
            let at = |c: &Collider| c.body.map_or(Pose::IDENTITY, |b| poses[b]);
            for &(i, j, apart) in &resting {
                let (a, b) = (&colliders[i], &colliders[j]);
                let gap = proximity(&a.shape, &at(a), &b.shape, &at(b)).gap;
                assert!(gap >= apart, "seed {seed}, motion {motion}: {i} and {j} are {gap} apart, not {apart}");
            }
        }
    }
    // The bounds must say something.
    assert!(bounded > 300, "{bounded} pairs told apart");
}

#[test]
fn what_turns_about_one_line_stays_in_its_ring() {
    // Two wheels on one axle, one beside the other, and a post that neither reaches but in both their balls.
    let wheel = |body: usize| collider(Some(body), Shape::cylinder(-0.01 * DVec3::Z, 0.01 * DVec3::Z, 0.2, 0.0));
    let colliders = [
        wheel(0),
        wheel(1),
        collider(None, Shape::capsule(DVec3::new(0.0, 0.1, 0.15), DVec3::new(0.0, 0.2, 0.15), 0.01)),
    ];
    let poses = [0.0, 0.05].map(|z| Pose { rotation: DQuat::IDENTITY, position: DVec3::Z * z });
    let joints = [0, 1].map(|b| [end(b, DVec3::ZERO), end(None, poses[b].position)]);
    let axes = [0, 1].map(|body| FixedAxis { body, point: DVec3::ZERO, direction: DVec3::Z });
    let free = ReachableVolumes::new(&colliders, &poses, &joints, &[]);
    assert!(free.clearance(0, 1) < 0.0);
    let reachable = ReachableVolumes::new(&colliders, &poses, &joints, &axes);
    assert!((reachable.clearance(0, 1) - 0.03).abs() < 1e-4, "{}", reachable.clearance(0, 1));
}

/// Scenes of bodies that fly about: colliders, poses before and after as sweeps.
fn scene(seed: u64, bodies: usize) -> (Vec<Collider>, Vec<Sweep>) {
    let random = &mut Random::new(seed);
    let mut colliders = Vec::new();
    let mut sweeps = Vec::new();
    for body in 0..bodies {
        for _ in 0..1 + random.word() % 3 {
            colliders.push(collider(Some(body), shape((random.word() % KINDS as u64) as usize, random)));
        }
        let center = signed(random) * 0.05;
        let properties = MassProperties { mass: 1.0, center, inertia: DMat3::IDENTITY };
        let before = RigidBody::at_rest(properties, pose(random, 0.5));
        let mut after = before;
        after.displace(signed(random) * 0.1, signed(random) * if seed.is_multiple_of(2) { 0.1 } else { 1.0 });
        sweeps.push(Sweep::new(&before, &after));
    }
    for _ in 0..4 {
        let random_place = Shape::sphere(signed(random) * 0.5, 0.05);
        colliders.push(collider(None, random_place));
    }
    colliders.push(collider(None, Shape::plane(-0.3 * DVec3::Y, DVec3::Y)));
    (colliders, sweeps)
}

/// A wheel of balls and a body of three, that wander about each other: a sweep a step, now and then a jump between two.
#[test]
fn of_many_pairs_the_same_are_found_as_at_first_sight() {
    let mut random = Random::new(23);
    let ball = |body: usize, at: DVec3| collider(Some(body), Shape::sphere(at, 0.004));
    let ring = (0..42).map(|k| {
        let (s, c) = soffio_math::sincos(f64::from(k) * 0.149_6);
        ball(0, 0.1 * DVec3::new(c, s, 0.0))
    });
    let colliders: Vec<Collider> = ring.chain((0..3).map(|k| ball(1, 0.01 * f64::from(k) * DVec3::X))).collect();
    let pairs = pairs(&colliders, &[], &ReachableVolumes::default()).meet;
    let properties = MassProperties { mass: 1.0, center: DVec3::ZERO, inertia: DMat3::IDENTITY };
    let at = |x: f64| Pose { rotation: DQuat::IDENTITY, position: DVec3::X * x };
    let mut bodies = [RigidBody::at_rest(properties, at(0.0)), RigidBody::at_rest(properties, at(0.1))];
    let mut broad = BroadPhase::new(&colliders, &pairs);
    let (mut found, mut fresh, mut collided) = (Vec::new(), Vec::new(), 0);
    for step in 0..4000 {
        let size = if step % 500 == 0 { 0.05 } else { 2e-4 };
        let before = bodies;
        let rotations = [0.1 * size * signed(&mut random) + 2e-3 * DVec3::Z, 10.0 * size * signed(&mut random)];
        for ((body, home), rotation) in bodies.iter_mut().zip([DVec3::ZERO, 0.1 * DVec3::X]).zip(rotations) {
            body.displace(size * signed(&mut random) + 0.1 * (home - body.position), rotation);
        }
        let sweeps = [0, 1].map(|k| Sweep::new(&before[k], &bodies[k]));
        broad.candidates(&sweeps, &mut found);
        BroadPhase::new(&colliders, &pairs).candidates(&sweeps, &mut fresh);
        assert_eq!(found, fresh, "step {step}");
        collided += found.len();
        // Thrown elsewhere, as a hand or a reset does.
        if step % 700 == 699 {
            bodies[1].displace(0.03 * signed(&mut random), signed(&mut random));
        }
    }
    assert!(collided > 1000, "{collided} pairs in all");
}

#[test]
fn the_broad_phase_finds_whatever_meets() {
    let (mut kept, mut all, mut hits) = (0, 0, 0);
    for seed in 0..60 {
        let (colliders, sweeps) = scene(seed, 12);
        let pairs = pairs(&colliders, &[], &ReachableVolumes::default()).meet;
        let mut broad = BroadPhase::new(&colliders, &pairs);
        let mut found = vec![99];
        broad.candidates(&sweeps, &mut found);
        assert!(found.is_sorted() && found.windows(2).all(|w| w[0] != w[1]), "seed {seed}: {found:?}");
        let mut again = Vec::new();
        broad.candidates(&sweeps, &mut again);
        assert_eq!(found, again, "seed {seed}: the order of the last call shows");
        let sweep = |c: &Collider| c.body.map_or(Sweep::STATIC, |b| sweeps[b]);
        // Centres of mass lie within 0.1 m of the frames' origins.
        let bounding_radius = |c: &Collider| c.shape.bounding_radius(DVec3::ZERO) + 0.1;
        for (index, pair) in pairs.iter().enumerate() {
            let (a, b) = (&colliders[pair.a], &colliders[pair.b]);
            let (sa, sb) = (sweep(a), sweep(b));
            let impact = time_of_impact(
                &ManifoldBuilder::default(),
                MovingCollider { collider: a, sweep: &sa, bounding_radius: bounding_radius(a) },
                MovingCollider { collider: b, sweep: &sb, bounding_radius: bounding_radius(b) },
            );
            // The hit is where the broad phase must not be wrong.
            let collided = impact.is_some_and(|impact| impact.proximity.gap < 1e-5);
            hits += usize::from(collided);
            assert!(!collided || found.contains(&index), "seed {seed}: pair {index} meets unseen, {impact:?}");
        }
        kept += found.len();
        all += pairs.len();
    }
    // It must also leave out: boxes overlap a few times as often as colliders.
    assert!(hits > 100 && kept < 5 * hits && kept < all / 4, "{hits} hits, {kept} candidates of {all} pairs");
}

#[test]
fn boxes_follow_the_shape_along_its_way() {
    // Many samples of the way of a point never leave the box in which the broad phase looks.
    for seed in 0..200 {
        let random = &mut Random::new(seed);
        let far = signed(random) * 0.3;
        let resting = signed(random) * 0.1;
        let properties = MassProperties { mass: 1.0, center: signed(random) * 0.2, inertia: DMat3::IDENTITY };
        let before = RigidBody::at_rest(properties, pose(random, 0.1));
        let mut after = before;
        after.displace(signed(random) * 0.3, signed(random) * 1.7);
        let sweep = Sweep::new(&before, &after);
        let colliders = [ball(Some(0), far, 1e-6), ball(None, resting, 1e-6)];
        // A ball put on the way of the other is always a candidate.
        for k in 0..=20 {
            let on_way = sweep.pose(f64::from(k) / 20.0).point(far);
            let mut both = colliders.clone();
            both[1] = ball(None, on_way, 1e-6);
            let mut broad = BroadPhase::new(&both, &[ColliderPair { a: 0, b: 1 }]);
            let mut found = Vec::new();
            broad.candidates(&[sweep], &mut found);
            assert_eq!(found, [0], "seed {seed}, sample {k}");
        }
    }
}

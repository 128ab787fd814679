//! Whole mechanisms: grouping where it is exact, the tree's solve against a dense one, and both beside constrained dynamics.

use soffio_geometry::bodies::RigidBody;
use soffio_math::noise::Random;
use soffio_math::{DMat3, DVec3, rotation};
use soffio_multibody::procedural::{PositionSolver, Settings};

use super::{Extras, Hand, METHODS, chain, dynamics_of};
use crate::motion::{World, body};

/// Joints are closed to 10⁻⁷ m, the dense solve's to rounding: bodies a decimetre across may differ by some of that.
const DENSE: f64 = 1e-6;

/// A tree of bodies that hang on each other by points anywhere, in random motion.
fn tree(seed: u64, count: usize) -> World {
    let mut random = Random::new(seed);
    let mut any = || DVec3::new(random.signed(), random.signed(), random.signed());
    let mut bodies: Vec<RigidBody> = Vec::new();
    for _ in 0..count {
        let size = any().abs() + 0.2;
        let mut body = body(0.05 + size.x, size * 1e-3, 0.3 * any());
        body.rotation = rotation(any());
        body.velocity = any();
        bodies.push(body);
    }
    let mut world = World::new(bodies);
    world.gravity = DVec3::ZERO;
    for k in 0..count {
        let parent = k.checked_sub(1).map(|k| k / 2);
        let place = world.bodies[k].position + 0.1 * any();
        world.pin(&format!("joint-{k}"), k, parent, place);
    }
    world
}

/// Newton's method on min ½ δ·M δ, J δ = −C for point joints, each pass by Gaussian elimination on all of M, J.
fn dense(world: &World, mut bodies: Vec<RigidBody>) -> Vec<RigidBody> {
    use soffio_multibody::articulation::{Anchor, ConstraintKind};
    for _ in 0..8 {
        let (n, rows) = (6 * bodies.len(), 3 * world.constraints.len());
        let size = n + rows;
        let mut a = vec![vec![0.0; size + 1]; size];
        for (i, body) in bodies.iter().enumerate() {
            let inertia = body.inertia_world();
            for k in 0..3 {
                a[6 * i + k][6 * i + k] = body.properties.mass;
                for l in 0..3 {
                    a[6 * i + 3 + k][6 * i + 3 + l] = inertia.col(l)[k];
                }
            }
        }
        for (c, constraint) in world.constraints.iter().enumerate() {
            let ConstraintKind::PointToPoint { a: one, b: two } = &constraint.kind else { panic!("a point") };
            let place = |anchor: &Anchor| anchor.body.map_or(anchor.point, |i| bodies[i].pose().point(anchor.point));
            let gap = place(one) - place(two);
            for k in 0..3 {
                let row = n + 3 * c + k;
                a[row][size] = -gap[k];
                for (anchor, sign) in [(one, 1.0), (two, -1.0)] {
                    let Some(i) = anchor.body else { continue };
                    let axis = DVec3::AXES[k] * sign;
                    let torque_arm = (place(anchor) - bodies[i].position).cross(axis);
                    for l in 0..3 {
                        for (column, value) in [(6 * i + l, axis[l]), (6 * i + 3 + l, torque_arm[l])] {
                            a[row][column] += value;
                            a[column][row] -= value;
                        }
                    }
                }
            }
        }
        let delta = eliminate(a);
        for (i, body) in bodies.iter_mut().enumerate() {
            let part = |at: usize| DVec3::new(delta[6 * i + at], delta[6 * i + at + 1], delta[6 * i + at + 2]);
            body.displace(part(0), part(3));
        }
    }
    bodies
}

fn eliminate(mut a: Vec<Vec<f64>>) -> Vec<f64> {
    let n = a.len();
    for k in 0..n {
        let pivot = (k..n).max_by(|&i, &j| a[i][k].abs().total_cmp(&a[j][k].abs())).expect("a row");
        a.swap(k, pivot);
        for i in 0..n {
            if i != k {
                let factor = a[i][k] / a[k][k];
                for j in k..=n {
                    a[i][j] -= factor * a[k][j];
                }
            }
        }
    }
    (0..n).map(|k| a[k][n] / a[k][k]).collect()
}

#[test]
fn all_joints_at_once_are_where_a_dense_solve_puts_them() {
    for seed in 1..20 {
        let world = tree(seed, 2 + (seed as usize % 4));
        let dt = 0.02;
        let mut displaced = world.bodies.clone();
        displaced.iter_mut().for_each(|body| body.position += dt * body.velocity);
        let exact = dense(&world, displaced);
        let mut hand = Hand::new(&world, PositionSolver::TreeSolve);
        hand.step(dt, &[]);
        assert!(hand.procedural.report().converged() && hand.procedural.report().passes <= 5);
        for (found, exact) in hand.bodies().iter().zip(&exact) {
            let off = found.position.distance(exact.position);
            let turned = (found.rotation * DVec3::X).distance(exact.rotation * DVec3::X);
            assert!(off < DENSE && turned < DENSE, "seed {seed}: {off} m, {turned}");
        }
    }
}

/// Where the joints go through the centres nothing turns: groups and masses are all there is, and the dense solve's
/// answer is the momentum's.
#[test]
fn grouping_is_exact_where_nothing_turns() {
    const ROUNDING: f64 = 1e-12;
    for (seed, heavy) in [(1, 0), (2, 0), (3, 1)] {
        let mut random = Random::new(seed);
        let mut bodies: Vec<RigidBody> =
            (0..4).map(|_| body(random.range(0.1, 0.2), DVec3::ONE * 1e-3, DVec3::ZERO)).collect();
        bodies[heavy].properties.mass = 1.0;
        // What is behind the joint moves as one; the root has a motion of its own.
        let (one, others) = (DVec3::new(0.3, -0.2, 0.5), DVec3::new(-0.1, 0.4, 0.0));
        for (k, body) in bodies.iter_mut().enumerate() {
            body.velocity = if k == heavy { one } else { others };
        }
        let mut world = World::new(bodies);
        world.gravity = DVec3::ZERO;
        let order: Vec<usize> = [heavy].into_iter().chain((0..4).filter(|&k| k != heavy)).collect();
        for pair in order.windows(2) {
            world.pin(&format!("joint-{}", pair[1]), pair[1], Some(pair[0]), DVec3::ZERO);
        }
        let mass: f64 = world.bodies.iter().map(|b| b.properties.mass).sum();
        let momentum = world.bodies.iter().fold(DVec3::ZERO, |p, b| p + b.properties.mass * b.velocity);
        let exact = {
            let mut displaced = world.bodies.clone();
            displaced.iter_mut().for_each(|body| body.position += 0.01 * body.velocity);
            dense(&world, displaced)
        };
        for method in METHODS {
            let mut hand = Hand::new(&world, method);
            hand.step(0.01, &[]);
            for (found, exact) in hand.bodies().iter().zip(&exact) {
                assert!(found.position.distance(exact.position) < ROUNDING, "{method:?} seed {seed}");
                assert!((found.velocity - momentum / mass).length() < ROUNDING / 0.01, "{method:?} seed {seed}");
            }
        }
    }
}

/// One pass closes a tree that is held in one place, whatever its joints.
#[test]
fn one_pass_closes_what_is_held_in_one_place() {
    for seed in 1..10 {
        let mut world = tree(seed, 6);
        // Some of its joints are hinges.
        for k in [2, 4] {
            let place = world.bodies[k].position + DVec3::X * 0.05;
            world.constraints.retain(|c| c.name != format!("joint-{k}"));
            world.hinge(&format!("hinge-{k}"), k, Some((k - 1) / 2), place, DVec3::Y);
        }
        for control in [0.0, 0.1, 1.0] {
            let settings = Settings { method: PositionSolver::Relaxation, control, ..Settings::default() };
            let mut hand = Hand::with(&world, &Extras::default(), settings);
            for _ in 0..20 {
                hand.step(1.0 / 60.0, &[]);
                let report = hand.procedural.report();
                assert!(report.converged() && report.passes == 1, "seed {seed}, control {control}: {report:?}");
            }
        }
    }
}

/// A double pendulum beside constrained dynamics: near for a second, and no energy comes from nowhere.
#[test]
fn all_joints_at_once_stay_near_the_laws() {
    /// First order: what a step of 1/240 s may leave after a second of swings of 0.2 m, m.
    const NEAR: f64 = 0.02;
    let mut world = chain(&[0.1, 0.1], 0.2, true);
    for body in &mut world.bodies {
        let initial_rotation = rotation(DVec3::Z * 0.4);
        (body.position, body.rotation) = (initial_rotation * body.position, initial_rotation * body.rotation);
    }
    let mut dynamics_of = dynamics_of(&world, &Extras::default());
    let mut hand = Hand::new(&world, PositionSolver::TreeSolve);
    let start = dynamics_of.energy();
    let no_wrench = [[0.0; 6]; 2];
    let mut worst: f64 = 0.0;
    for step in 0..240 {
        dynamics_of.step(1.0 / 240.0, &no_wrench, &mut Vec::new());
        hand.step(1.0 / 240.0, &[]);
        for (one, other) in dynamics_of.bodies.iter().zip(hand.bodies()) {
            worst = worst.max(one.position.distance(other.position));
        }
        assert!(hand.dynamics.energy() <= start + 1e-3, "step {step}: {} of {start}", hand.dynamics.energy());
    }
    println!("farthest apart {worst} m; energy {} of {start} J", hand.dynamics.energy());
    assert!(worst < NEAR, "{worst} m");
}

#[test]
fn the_same_run_has_the_same_bits() {
    for method in METHODS {
        let run = || {
            let world = tree(5, 7);
            let mut hand = Hand::new(&world, method);
            for _ in 0..200 {
                hand.step(1.0 / 60.0, &[]);
            }
            hand.bodies().to_vec()
        };
        assert!(run() == run(), "{method:?}");
    }
}

/// Nothing that the matrix of inertia is asked for depends on how it is turned.
#[test]
fn a_free_body_keeps_its_energy_or_loses_it() {
    let mut world = World::new(vec![body(1.0, DVec3::new(1.0, 2.0, 3.0) * 1e-3, DVec3::ZERO)]);
    world.gravity = DVec3::ZERO;
    world.bodies[0].angular_velocity = DVec3::new(1.0, 6.0, 0.5);
    world.bodies[0].properties.inertia += DMat3::ZERO;
    let mut hand = Hand::new(&world, PositionSolver::TreeSolve);
    let mut before = world.bodies[0].kinetic_energy();
    let start = before;
    for _ in 0..2400 {
        hand.step(1.0 / 240.0, &[]);
        let now = hand.bodies()[0].kinetic_energy();
        assert!(now <= before * 1.01, "{now} after {before}");
        before = now;
    }
    assert!(before <= start * 1.001 && before > 0.5 * start, "{before} of {start}");
}

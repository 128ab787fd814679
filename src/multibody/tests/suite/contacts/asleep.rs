//! Sleep: bodies at rest are left out until something disturbs them, exactly still, and wake as if they had never slept.

use soffio_multibody::articulation::{Anchor, Schedule, Window};

use super::*;

/// Long enough to come to rest and fall asleep, s.
const SETTLING_TIME: f64 = 3.0;
/// Difference of positions between a run awake and one asleep, half a second after an impact, m. Resting forces are found to
/// 1e-11 m/s, and an impact multiplies that error.
const SAME: f64 = 1e-8;
/// The same of energy and the work of contacts, J.
const BALANCE: f64 = 1e-10;

const HALF: DVec3 = DVec3::new(0.05, 0.02, 0.05);
const BALL: f64 = 0.1;

/// A ball on a block, a second block apart, and a ball above the first one's edge.
fn yard() -> Dynamics {
    let place = |x: f64| cube(0.4, HALF, DVec3::new(x, 0.02, 0.0));
    let drop = |x: f64, y: f64| ball(BALL, 0.02, DVec3::new(x, y, 0.0));
    let bodies = vec![place(0.0), drop(0.0, 0.06), place(0.5), drop(0.045, 0.3)];
    let colliders = vec![block(0, HALF), sphere(1, 0.02), block(2, HALF), sphere(3, 0.02), floor()];
    Scene::new(bodies, colliders).dynamics()
}

/// Runs under a push on one body, N; `awake` disturbs the bodies before each step.
fn run_under(dynamics: &mut Dynamics, seconds: f64, (body, push): (usize, DVec3), awake: bool) {
    let mut wrenches = vec![[0.0; 6]; dynamics.bodies.len()];
    wrenches[body][..3].copy_from_slice(&push.to_array());
    for _ in 0..(seconds / DT).round() as usize {
        if awake {
            dynamics.disturb();
        }
        assert_eq!(dynamics.step(DT, &wrenches, &mut Vec::new()), None, "invalid numbers");
    }
}

fn sleeping(dynamics: &Dynamics) -> Vec<bool> {
    (0..dynamics.bodies.len()).map(|body| dynamics.is_asleep(body)).collect()
}

/// Supports the upper ball.
const LIFT: (usize, DVec3) = (3, DVec3::new(0.0, BALL * G, 0.0));
/// No push.
const NO_PUSH: (usize, DVec3) = (3, DVec3::ZERO);

#[test]
fn resting_bodies_fall_asleep_and_do_not_change_by_a_bit() {
    let mut yard = yard();
    run_under(&mut yard, SETTLING_TIME, LIFT, false);
    assert_eq!(sleeping(&yard), [true; 4]);
    let before = yard.bodies.clone();
    run_under(&mut yard, 10.0, LIFT, false);
    assert_eq!(yard.bodies, before);
    assert!(before.iter().all(|body| body.velocity == DVec3::ZERO && body.angular_velocity == DVec3::ZERO));
    // Sleeping bodies still press: the block and its ball, the ball alone, the second block.
    let weights: f64 = yard.contact_reports().map(|report| report.normal_force).sum();
    assert!((weights / (0.4 + BALL + BALL + 0.4) / G - 1.0).abs() < 1e-6, "{weights} N");
}

#[test]
fn an_impact_wakes_its_island_as_if_it_had_been_awake() {
    let runs = [false, true].map(|awake| {
        let mut yard = yard();
        run_under(&mut yard, SETTLING_TIME, LIFT, awake);
        let balance_before = yard.energy() - yard.contact_work();
        let slept = sleeping(&yard);
        // Released, the upper ball falls on the block and bounces.
        run_under(&mut yard, 0.5, NO_PUSH, awake);
        (slept, sleeping(&yard), yard.energy() - yard.contact_work() - balance_before, yard.bodies)
    });
    let [(slept, now, balance, bodies), (never, _, other_balance, others)] = runs;
    assert_eq!((slept, never), (vec![true; 4], vec![false; 4]));
    assert_eq!(now, [false, false, true, false], "the second block does not wake");
    for (body, other) in bodies.iter().zip(&others) {
        let apart = body.position.distance(other.position);
        assert!(apart < SAME, "{apart} m apart");
    }
    assert!((balance - other_balance).abs() < BALANCE, "{balance} and {other_balance} J");
}

#[test]
fn a_push_wakes_a_body_and_those_resting_on_it() {
    let mut yard = yard();
    run_under(&mut yard, SETTLING_TIME, LIFT, false);
    // Too weak to move it; but a pushed body wakes, and stays awake for a while.
    run_under(&mut yard, DT, (0, DVec3::X * 1e-3), false);
    assert_eq!(sleeping(&yard), [false, false, true, false]);
    run_under(&mut yard, 0.01, NO_PUSH, false);
    assert_eq!(sleeping(&yard)[..3], [false, false, true]);
}

#[test]
fn a_body_set_from_outside_wakes_with_a_notice_or_without() {
    for notified in [true, false] {
        let mut yard = yard();
        run_under(&mut yard, SETTLING_TIME, LIFT, false);
        yard.bodies[2].velocity = DVec3::X;
        if notified {
            yard.disturb();
        }
        run_under(&mut yard, DT, LIFT, false);
        let displacement = yard.bodies[2].position.x - 0.5;
        // Friction takes μ g from its speed.
        let slides = DT * (1.0 - 0.25 * G * DT);
        assert!((displacement - slides).abs() < 1e-3 * slides, "{displacement} m instead of {slides}");
    }
}

#[test]
fn a_body_falls_when_the_window_of_its_nail_closes_in_its_sleep() {
    const CLOSES: f64 = 4.0;
    let place = DVec3::Y * 0.5;
    let mut scene = Scene::new(vec![cube(0.4, HALF, place)], vec![block(0, HALF), floor()]);
    let kind = ConstraintKind::PointToPoint {
        a: Anchor { body: Some(0), point: DVec3::ZERO },
        b: Anchor { body: None, point: place },
    };
    let windows = vec![Window { start: f64::NEG_INFINITY, end: CLOSES }];
    let schedule = Schedule { windows, ..Schedule::default() };
    scene.constraints.push(Constraint { schedule, ..Constraint::new("nail", kind) });
    let mut hanging = scene.dynamics();
    run_under(&mut hanging, CLOSES - DT, (0, DVec3::ZERO), false);
    assert!(hanging.is_asleep(0));
    assert_eq!(hanging.bodies[0].position, place);
    run_under(&mut hanging, 0.2 + DT, (0, DVec3::ZERO), false);
    let fallen = 0.5 - hanging.bodies[0].position.y;
    assert!((fallen - 0.5 * G * 0.04).abs() < 1e-9, "fallen by {fallen} m");
}

#[test]
fn a_creeping_body_is_awake() {
    /// m/s: a millimetre in a day.
    const CREEP: f64 = 1e-3 / 86_400.0;
    let mut scene = Scene::new(vec![ball(BALL, 0.02, DVec3::Y)], vec![sphere(0, 0.02), floor()]);
    scene.gravity = DVec3::ZERO;
    scene.bodies[0].velocity = DVec3::X * CREEP;
    let mut creeping = scene.dynamics();
    run_under(&mut creeping, 60.0, (0, DVec3::ZERO), false);
    let displacement = creeping.bodies[0].position.x;
    assert!((displacement / (60.0 * CREEP) - 1.0).abs() < 1e-9, "crept {displacement} m");
}

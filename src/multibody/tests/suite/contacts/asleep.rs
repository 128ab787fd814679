//! What rests is left out until something comes: exactly still, and awake as if it had never slept.

use soffio_multibody::articulation::{Anchor, Schedule, Window};

use super::*;

/// Long enough to come to rest and fall asleep, s.
const NIGHT: f64 = 3.0;
/// What is awake and what has slept come apart by no more than this in the half second after a hit, m: forces at rest are found
/// to 1e-11 m/s, and a hit multiplies what there is.
const SAME: f64 = 1e-8;
/// The same of energy and the work of contacts, J.
const LEDGER: f64 = 1e-10;

const HALF: DVec3 = DVec3::new(0.05, 0.02, 0.05);
const BALL: f64 = 0.1;

/// A ball on a block, a block apart, and a ball beside them above the first one's edge.
fn yard() -> Dynamics {
    let place = |x: f64| cube(0.4, HALF, DVec3::new(x, 0.02, 0.0));
    let drop = |x: f64, y: f64| ball(BALL, 0.02, DVec3::new(x, y, 0.0));
    let bodies = vec![place(0.0), drop(0.0, 0.06), place(0.5), drop(0.045, 0.3)];
    let colliders = vec![block(0, HALF), sphere(1, 0.02), block(2, HALF), sphere(3, 0.02), floor()];
    Scene::new(bodies, colliders).dynamics()
}

/// Goes on for a time under a push on one body, N; `awake` disturbs the figure before each step.
fn go_on(dynamics: &mut Dynamics, seconds: f64, (body, push): (usize, DVec3), awake: bool) {
    let mut wrenches = vec![[0.0; 6]; dynamics.bodies.len()];
    wrenches[body][..3].copy_from_slice(&push.to_array());
    for _ in 0..(seconds / DT).round() as usize {
        if awake {
            dynamics.disturb();
        }
        assert_eq!(dynamics.step(DT, &wrenches, &mut Vec::new()), None, "bad numbers");
    }
}

fn who_sleeps(dynamics: &Dynamics) -> Vec<bool> {
    (0..dynamics.bodies.len()).map(|body| dynamics.is_asleep(body)).collect()
}

/// Holds the ball up.
const HELD: (usize, DVec3) = (3, DVec3::new(0.0, BALL * G, 0.0));
/// Holds nothing.
const NOTHING: (usize, DVec3) = (3, DVec3::ZERO);

#[test]
fn what_rests_falls_asleep_and_does_not_change_by_a_bit() {
    let mut yard = yard();
    go_on(&mut yard, NIGHT, HELD, false);
    assert_eq!(who_sleeps(&yard), [true; 4]);
    let before = yard.bodies.clone();
    go_on(&mut yard, 10.0, HELD, false);
    assert_eq!(yard.bodies, before);
    assert!(before.iter().all(|body| body.velocity == DVec3::ZERO && body.angular_velocity == DVec3::ZERO));
    // What lies still presses all the same: the block and its ball, the ball alone, the block apart.
    let weights: f64 = yard.contact_reports().map(|touch| touch.normal_force).sum();
    assert!((weights / (0.4 + BALL + BALL + 0.4) / G - 1.0).abs() < 1e-6, "{weights} N");
}

#[test]
fn a_hit_wakes_what_it_is_felt_by_as_if_it_had_been_awake() {
    let runs = [false, true].map(|awake| {
        let mut yard = yard();
        go_on(&mut yard, NIGHT, HELD, awake);
        let ledger = yard.energy() - yard.contact_work();
        let slept = who_sleeps(&yard);
        // Let go, the ball falls on the block and bounces.
        go_on(&mut yard, 0.5, NOTHING, awake);
        (slept, who_sleeps(&yard), yard.energy() - yard.contact_work() - ledger, yard.bodies)
    });
    let [(slept, now, balance, bodies), (never, _, other_balance, others)] = runs;
    assert_eq!((slept, never), (vec![true; 4], vec![false; 4]));
    assert_eq!(now, [false, false, true, false], "the block apart hears nothing of it");
    for (body, other) in bodies.iter().zip(&others) {
        let apart = body.position.distance(other.position);
        assert!(apart < SAME, "{apart} m apart");
    }
    assert!((balance - other_balance).abs() < LEDGER, "{balance} and {other_balance} J");
}

#[test]
fn a_push_wakes_a_body_and_what_leans_on_it() {
    let mut yard = yard();
    go_on(&mut yard, NIGHT, HELD, false);
    // Too weak to move it; but who is pushed is awake, and stays so for a while.
    go_on(&mut yard, DT, (0, DVec3::X * 1e-3), false);
    assert_eq!(who_sleeps(&yard), [false, false, true, false]);
    go_on(&mut yard, 0.01, NOTHING, false);
    assert_eq!(who_sleeps(&yard)[..3], [false, false, true]);
}

#[test]
fn whoever_is_moved_wakes_with_a_word_or_without() {
    for told in [true, false] {
        let mut yard = yard();
        go_on(&mut yard, NIGHT, HELD, false);
        yard.bodies[2].velocity = DVec3::X;
        if told {
            yard.disturb();
        }
        go_on(&mut yard, DT, HELD, false);
        let way = yard.bodies[2].position.x - 0.5;
        // Friction takes μ g from its speed.
        let slides = DT * (1.0 - 0.25 * G * DT);
        assert!((way - slides).abs() < 1e-3 * slides, "{way} m instead of {slides}");
    }
}

#[test]
fn a_window_that_closes_lets_fall_what_slept_under_it() {
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
    let mut hung = scene.dynamics();
    go_on(&mut hung, CLOSES - DT, (0, DVec3::ZERO), false);
    assert!(hung.is_asleep(0));
    assert_eq!(hung.bodies[0].position, place);
    go_on(&mut hung, 0.2 + DT, (0, DVec3::ZERO), false);
    let fallen = 0.5 - hung.bodies[0].position.y;
    assert!((fallen - 0.5 * G * 0.04).abs() < 1e-9, "fallen by {fallen} m");
}

#[test]
fn what_creeps_is_awake() {
    /// m/s: a millimetre in a day.
    const CREEP: f64 = 1e-3 / 86_400.0;
    let mut scene = Scene::new(vec![ball(BALL, 0.02, DVec3::Y)], vec![sphere(0, 0.02), floor()]);
    scene.gravity = DVec3::ZERO;
    scene.bodies[0].velocity = DVec3::X * CREEP;
    let mut creeping = scene.dynamics();
    go_on(&mut creeping, 60.0, (0, DVec3::ZERO), false);
    let way = creeping.bodies[0].position.x;
    assert!((way / (60.0 * CREEP) - 1.0).abs() < 1e-9, "crept {way} m");
}

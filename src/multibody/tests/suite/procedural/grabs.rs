//! Hands that pull: within report, out of report, wildly.

use soffio_math::DVec3;
use soffio_math::noise::Random;
use soffio_multibody::articulation::{Limit, LimitKind, Measure};
use soffio_multibody::procedural::{
    GrabTarget, MAX_FREE_PASSES, MAX_GRAB_PASSES, MAX_SPEED, MAX_SPIN, MAX_SWEEPS, POSITION_TOLERANCE, PositionSolver,
    Settings,
};

use super::{Extras, Hand, METHODS, chain, end_of};
use crate::motion::{World, body, wheel};

const LENGTH: f64 = 0.1;
const SLOW: f64 = 1.0 / 30.0;
/// What relaxation may leave in a step of a chain of 0.8 m, m. Measured: 0.02 mm.
const MISSED: f64 = 1e-3;

/// Is a hand where it should be, and do the joints hold?
fn closed_and_held(hand: &Hand, method: PositionSolver) -> bool {
    let report = hand.procedural.report();
    match method {
        PositionSolver::Relaxation => report.residual <= POSITION_TOLERANCE && report.grab_error <= MISSED,
        PositionSolver::TreeSolve => report.converged(),
    }
}

#[test]
fn a_hand_within_reach_is_met_and_the_joints_hold() {
    for method in METHODS {
        let world = chain(&[0.1; 8], LENGTH, true);
        let mut hand = Hand::new(&world, method);
        for step in 0..300 {
            let angle = 0.02 * step as f64;
            let place = DVec3::new(0.5 * angle.sin(), -0.35, 0.3 * (1.3 * angle).sin());
            hand.step(1.0 / 60.0, &[end_of(&world, 7, LENGTH, place)]);
            assert!(closed_and_held(&hand, method), "{method:?} step {step}: {:?}", hand.procedural.report());
            assert!(hand.dynamics.joint_error() <= POSITION_TOLERANCE);
        }
    }
}

/// Two hands and a nail hold three ends of a cross.
#[test]
fn several_hands_are_met_at_once() {
    for method in METHODS {
        let world = chain(&[0.1; 9], LENGTH, true);
        let mut hand = Hand::new(&world, method);
        for step in 0..120 {
            let s = step as f64 / 120.0;
            let middle = end_of(&world, 4, LENGTH, DVec3::new(0.2 * s, -0.42, 0.0));
            let end = end_of(&world, 8, LENGTH, DVec3::new(0.25 * s, -0.6, 0.2 * s));
            hand.step(1.0 / 60.0, &[middle, end]);
            assert!(closed_and_held(&hand, method), "{method:?} step {step}: {:?}", hand.procedural.report());
        }
    }
}

#[test]
fn what_is_out_of_reach_ends_and_is_told() {
    /// A chain of eight that is drawn taut towards a hand is as near as it gets; tautness comes last, m.
    const TAUT: f64 = 5e-3;
    for method in METHODS {
        let world = chain(&[0.1; 8], LENGTH, true);
        let mut hand = Hand::new(&world, method);
        for step in 0..60 {
            let place = DVec3::new(4.0, -3.0, 0.0);
            hand.step(1.0 / 60.0, &[end_of(&world, 7, LENGTH, place)]);
            let report = hand.procedural.report();
            let most = match method {
                PositionSolver::Relaxation => MAX_SWEEPS as u32,
                PositionSolver::TreeSolve => MAX_GRAB_PASSES + MAX_FREE_PASSES as u32 + MAX_SWEEPS as u32,
            };
            assert!(!report.converged() && report.passes <= most, "{method:?}: {report:?}");
            assert!(report.residual <= POSITION_TOLERANCE, "{method:?} step {step}: {report:?}");
        }
        let missed = hand.procedural.report().grab_error;
        assert!((missed - (5.0 - 8.0 * LENGTH)).abs() < TAUT, "{method:?} misses by {missed} m");
    }
}

/// A minute of grabs whose targets jump anywhere within 10 m, at 30 steps a second, on chains of very unlike masses.
#[test]
fn wild_drags_neither_break_nor_grow() {
    for method in METHODS {
        for (seed, ratio) in [(1, 1.0), (2, 1e3), (3, 1e-3)] {
            for anchored in [true, false] {
                let mut random = Random::new(seed);
                let masses: Vec<f64> = (0..10).map(|k| if k % 2 == 0 { 0.01 } else { 0.01 * ratio }).collect();
                let world = chain(&masses, LENGTH, anchored);
                let mut hand = Hand::new(&world, method);
                let size = 10.0 * LENGTH;
                let mut place = DVec3::ZERO;
                for step in 0..1800 {
                    // Leaps, rests and lets go.
                    let mode = (step / 30) % 4;
                    if mode < 2 || step % 30 == 0 {
                        place = 10.0 * DVec3::new(random.signed(), random.signed(), random.signed()) / 3.0_f64.sqrt();
                    }
                    let grab = [end_of(&world, 6, LENGTH, place)];
                    hand.step(SLOW, if mode == 3 && anchored { &[] } else { &grab });
                    let what = format!("{method:?} seed {seed} ratio {ratio} nailed {anchored} step {step}");
                    let report = hand.procedural.report();
                    assert!(report.residual <= POSITION_TOLERANCE, "{what}: {report:?}");
                    assert!(anchored || report.grab_error <= POSITION_TOLERANCE, "{what}: {report:?}");
                    let center = if anchored { DVec3::ZERO } else { place };
                    for body in hand.bodies() {
                        assert!(body.is_finite(), "{what}");
                        assert!(
                            body.position.distance(center) <= size + POSITION_TOLERANCE,
                            "{what}: {}",
                            body.position
                        );
                        assert!(body.velocity.length() <= MAX_SPEED * 1.001, "{what}");
                        assert!(body.angular_velocity.length() <= MAX_SPIN * 1.001, "{what}");
                    }
                }
            }
        }
    }
}

/// Let go, a mechanism under gravity with damping comes to rest: nothing feeds it.
#[test]
fn what_was_dragged_comes_to_rest() {
    for method in METHODS {
        let mut world = chain(&[0.1, 0.001, 0.1, 0.001], LENGTH, true);
        world.damping = soffio_multibody::dynamics::forces::Damping { linear: 1.0, angular: 1.0 };
        let mut hand = Hand::new(&world, method);
        for step in 0..60 {
            hand.step(SLOW, &[end_of(&world, 3, LENGTH, DVec3::new(0.3, -0.1 + 1e-3 * f64::from(step), 0.0))]);
        }
        for _ in 0..900 {
            hand.step(SLOW, &[]);
        }
        let fastest = hand.bodies().iter().map(|b| b.velocity.length()).fold(0.0, f64::max);
        assert!(fastest < 1e-3, "{method:?}: {fastest} m/s after half a minute");
    }
}

/// Hinges with stops, pulled about.
#[test]
fn limits_of_angles_are_kept() {
    /// What a bound may be passed by: Newton's last step, rad.
    const KEPT: f64 = 1e-6;
    const MOST: f64 = 0.5;
    for method in METHODS {
        let mut world = chain(&[0.1; 5], LENGTH, false);
        world.constraints.clear();
        let mut extras = Extras::default();
        for k in 0..5_usize {
            let place = DVec3::NEG_Y * (LENGTH * k as f64);
            world.hinge(&format!("hinge-{k}"), k, k.checked_sub(1), place, DVec3::Z);
            let measure = Measure::Angle { axis: world.axis(Some(k), DVec3::Z), frame: k.checked_sub(1) };
            let kind = LimitKind::Range { measure, min: -MOST, max: MOST };
            extras.limits.push(Limit { name: format!("stop-{k}"), kind, restitution: 0.0 });
        }
        let settings = Settings { method, ..Settings::default() };
        let mut hand = Hand::with(&world, &extras, settings);
        let mut random = Random::new(4);
        let mut place = DVec3::NEG_Y * 0.5;
        let mut worst: f64 = 0.0;
        let mut at_stop = 0;
        for step in 0..600 {
            place += DVec3::new(0.04 * random.signed(), 0.04 * random.signed(), 0.0);
            place = place.clamp_length_max(0.45);
            let grab = GrabTarget { target: place, ..end_of(&world, 4, LENGTH, place) };
            hand.step(SLOW, if step % 100 < 80 { std::slice::from_ref(&grab) } else { &[] });
            for bound in 0..hand.dynamics.contacts().bound_count() {
                let (gap, _) = hand.dynamics.contacts().bound(bound, hand.bodies());
                worst = worst.max(-gap);
                at_stop += usize::from(gap < 1e-3);
            }
            assert!(hand.dynamics.joint_error() <= 1e-6, "{method:?} step {step}: {:?}", hand.procedural.report());
        }
        assert!(worst <= KEPT, "{method:?}: passed by {worst} rad");
        assert!(at_stop > 100, "{method:?}: stops were asked {at_stop} times only");
    }
}

/// Wheels in mesh, one of them turned by hand: the phases keep.
#[test]
fn gears_keep_their_phase_under_a_hand() {
    use soffio_multibody::articulation::{ConstraintKind, Term};
    for method in METHODS {
        let mut world = World::new(vec![
            wheel(0.2, 1e-4, DVec3::ZERO),
            wheel(0.4, 4e-4, DVec3::X * 0.3),
            body(0.1, DVec3::ONE * 1e-4, DVec3::Y),
        ]);
        world.hinge("first", 0, None, DVec3::ZERO, DVec3::Z);
        world.hinge("second", 1, None, DVec3::X * 0.3, DVec3::Z);
        let term = |body: usize, coefficient: f64| Term {
            measure: Measure::Angle { axis: world.axis(Some(body), DVec3::Z), frame: None },
            coefficient,
        };
        let terms = vec![term(0, 0.1), term(1, 0.2)];
        world.add("mesh", ConstraintKind::Coupling { terms });
        let mut hand = Hand::new(&world, method);
        for step in 0..200 {
            let angle = 0.05 * f64::from(step);
            let place = 0.08 * DVec3::new(angle.cos(), angle.sin(), 0.0);
            hand.step(SLOW, &[GrabTarget { body: 0, point: DVec3::X * 0.08, target: place }]);
            let report = hand.procedural.report();
            assert!(report.converged(), "{method:?} step {step}: {report:?}");
        }
        // 9.95 rad of the first are −4.975 of the second.
        let second = hand.bodies()[1].rotation * DVec3::X;
        let wanted = DVec3::new((-4.975_f64).cos(), (-4.975_f64).sin(), 0.0);
        assert!((second - wanted).length() < 1e-5, "{method:?}: {second}");
    }
}

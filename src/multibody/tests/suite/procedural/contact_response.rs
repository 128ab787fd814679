//! Collisions in position-based motion: bodies bounce, are moved out, and report the impact.

use soffio_math::{DVec3, Pose};
use soffio_multibody::collision::{Collider, Shape};
use soffio_multibody::dynamics::ImpactKind;
use soffio_multibody::procedural::Settings;

use super::{Extras, Hand, METHODS};
use crate::motion::{DT, G, World, body};

const RADIUS: f64 = 0.05;

fn collider(body: Option<usize>, shape: Shape) -> Collider {
    Collider { body, shape, material: 0, node: String::new() }
}

fn ball(mass: f64, position: DVec3) -> World {
    World::new(vec![body(mass, DVec3::ONE * (0.4 * mass * RADIUS * RADIUS), position)])
}

#[test]
fn a_ball_bounces_as_high_as_it_should_and_comes_to_rest_in_silence() {
    const E: f64 = 0.6;
    const HEIGHT: f64 = 0.5;
    /// A step's way at the hit is what it may be off by.
    const STEP_WAY: f64 = 3.2 * DT;
    for method in METHODS {
        let world = ball(0.2, DVec3::Y * (HEIGHT + RADIUS));
        let floor = collider(None, Shape::plane(DVec3::ZERO, DVec3::Y));
        let colliders = vec![collider(Some(0), Shape::sphere(DVec3::ZERO, RADIUS)), floor];
        let extras = Extras { colliders, restitution: E, friction: 0.3, ..Extras::default() };
        let mut hand = Hand::with(&world, &extras, Settings { method, ..Settings::default() });
        let (mut top, mut lowest, mut loud) = (0.0_f64, f64::INFINITY, 0);
        for step in 0..1920 {
            let reported = hand.impacts.len();
            hand.step(DT, &[]);
            let y = hand.bodies()[0].position.y;
            lowest = lowest.min(y);
            let hits = hand.impacts.iter().filter(|i| i.kind == ImpactKind::Impact).count();
            if hits == 1 {
                top = top.max(y);
            }
            loud += usize::from(step > 960 && hand.impacts.len() > reported);
        }
        let first = hand.impacts[0];
        assert!((first.speed - (2.0 * G * HEIGHT).sqrt()).abs() < 2.0 * G * DT, "{method:?}: {} m/s", first.speed);
        assert!((first.impulse - 0.2 * (1.0 + E) * first.speed).abs() < 1e-9, "{method:?}: {} N s", first.impulse);
        assert!((top - RADIUS - E * E * HEIGHT).abs() < 2.0 * STEP_WAY, "{method:?}: up to {top} m");
        assert!(lowest > RADIUS - 1e-5, "{method:?}: sank to {lowest} m");
        assert!((hand.bodies()[0].position.y - RADIUS).abs() < 1e-4, "{method:?}");
        assert_eq!(loud, 0, "{method:?}: what rests tells nothing");
    }
}

#[test]
fn nothing_goes_through_thin_sheet() {
    for method in METHODS {
        for speed in [1.0, 10.0, 40.0] {
            let mut world = ball(0.01, DVec3::X * -0.5);
            world.gravity = DVec3::ZERO;
            world.bodies[0].velocity = DVec3::X * speed;
            let sheet = Shape::cuboid(Pose::IDENTITY, DVec3::new(2e-4, 0.3, 0.3), 2e-4);
            let colliders = vec![collider(Some(0), Shape::sphere(DVec3::ZERO, 2e-3)), collider(None, sheet)];
            let extras = Extras { colliders, restitution: 0.5, ..Extras::default() };
            let mut hand = Hand::with(&world, &extras, Settings { method, ..Settings::default() });
            for _ in 0..240 {
                hand.step(DT, &[]);
                assert!(hand.bodies()[0].position.x < 0.0, "{method:?} at {speed} m/s");
            }
            let after = hand.bodies()[0].velocity.x;
            assert!((after + 0.5 * speed).abs() < 1e-6 * speed, "{method:?}: {after} m/s");
        }
    }
}

/// A hit on the end of a chain goes through its joints.
#[test]
fn a_hit_moves_the_whole_chain() {
    for method in METHODS {
        let mut world = super::chain(&[0.1, 0.1], 0.2, true);
        world.gravity = DVec3::ZERO;
        let mut ball = body(0.1, DVec3::ONE * 1e-4, DVec3::new(-0.2, -0.35, 0.0));
        ball.velocity = DVec3::X * 2.0;
        world.bodies.push(ball);
        let rod = Shape::cuboid(Pose::IDENTITY, DVec3::new(0.005, 0.09, 0.005), 1e-3);
        let colliders = vec![collider(Some(1), rod), collider(Some(2), Shape::sphere(DVec3::ZERO, 0.02))];
        let extras = Extras { colliders, restitution: 0.8, ..Extras::default() };
        let mut hand = Hand::with(&world, &extras, Settings { method, ..Settings::default() });
        for _ in 0..48 {
            hand.step(DT, &[]);
        }
        assert_eq!(hand.impacts.iter().filter(|i| i.kind == ImpactKind::Impact).count(), 1, "{method:?}");
        let upper = hand.bodies()[0].angular_velocity.length();
        assert!(upper > 0.1, "{method:?}: the upper rod turns at {upper} rad/s");
        assert!(hand.bodies()[2].velocity.x < 2.0);
    }
}

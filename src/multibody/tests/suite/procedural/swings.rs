//! Free swings: position-based motion keeps time and energy at any length of step.

use soffio_math::{DVec3, PI};
use soffio_multibody::procedural::PositionSolver;

use super::{Hand, METHODS, chain};
use crate::motion::World;

/// Steps a second.
const RATES: [f64; 4] = [60.0, 120.0, 240.0, 480.0];
const LENGTH: f64 = 0.5;
/// Angle at which it is let go, rad: 4 degrees.
const START: f64 = 0.0698;
const GRAVITY: f64 = 9.81;

/// A rod that hangs from the origin, let go at an angle, its angles over `seconds` s.
fn swing(method: PositionSolver, rate: f64, seconds: f64) -> Vec<f64> {
    let mut world = chain(&[0.2], LENGTH, true);
    world.gravity = DVec3::NEG_Y * GRAVITY;
    let rotation = soffio_math::rotation(DVec3::Z * START);
    world.bodies[0].position = rotation * world.bodies[0].position;
    world.bodies[0].rotation = rotation * world.bodies[0].rotation;
    let mut hand = Hand::new(&world, method);
    (0..(seconds * rate) as usize)
        .map(|_| {
            hand.step(1.0 / rate, &[]);
            let center = hand.bodies()[0].position;
            center.x.atan2(-center.y)
        })
        .collect()
}

/// A pendulum of a rod has the period 2π √(2L/3g) (1 + θ²/16), and loses nothing.
#[test]
fn a_pendulum_keeps_its_period_and_its_swing_at_any_rate() {
    /// Relative error of the period. The bar of the product is 5 %.
    const PERIOD: f64 = 0.002;
    /// Share of the amplitude that may be lost or won in twenty seconds.
    const AMPLITUDE: f64 = 0.02;
    const SECONDS: f64 = 20.0;
    let period = 2.0 * PI * (2.0 * LENGTH / (3.0 * GRAVITY)).sqrt() * (1.0 + START * START / 16.0);
    for method in METHODS {
        for rate in RATES {
            let angles = swing(method, rate, SECONDS);
            let falls: Vec<f64> = angles
                .windows(2)
                .enumerate()
                .filter(|(_, pair)| pair[0] > 0.0 && pair[1] <= 0.0)
                .map(|(step, pair)| (step as f64 + pair[0] / (pair[0] - pair[1])) / rate)
                .collect();
            let measured = (falls[falls.len() - 1] - falls[0]) / (falls.len() - 1) as f64;
            let last = &angles[angles.len() - (2.0 * period * rate) as usize..];
            let amplitude = last.iter().fold(0.0_f64, |most, angle| most.max(angle.abs())) / START;
            println!("{method:?} at {rate}/s: period {measured} s of {period}, amplitude {amplitude}");
            assert!((measured / period - 1.0).abs() < PERIOD, "{method:?} at {rate}/s: {measured} s, not {period}");
            assert!((amplitude - 1.0).abs() < AMPLITUDE, "{method:?} at {rate}/s: {amplitude} of the swing");
        }
    }
}

/// A chain that falls from the horizontal never has more energy than at its start, and is not slowed much.
#[test]
fn a_chain_that_falls_gains_no_energy() {
    /// Gain in parts of its first height over the lowest place: the error of first order at 60 steps a second.
    const GAIN: f64 = 0.01;
    for method in METHODS {
        for rate in RATES {
            let mut world: World = chain(&[0.1; 6], 0.1, true);
            world.gravity = DVec3::NEG_Y * GRAVITY;
            let rotation = soffio_math::rotation(DVec3::Z * (0.5 * PI));
            for body in &mut world.bodies {
                (body.position, body.rotation) = (rotation * body.position, rotation * body.rotation);
            }
            let mut hand = Hand::new(&world, method);
            let start = hand.dynamics.energy();
            let height = 0.6 * GRAVITY * 0.3;
            for step in 0..(5.0 * rate) as usize {
                hand.step(1.0 / rate, &[]);
                let gain = (hand.dynamics.energy() - start) / height;
                assert!(gain < GAIN, "{method:?} at {rate}/s, step {step}: {gain} of {height} J won");
            }
        }
    }
}

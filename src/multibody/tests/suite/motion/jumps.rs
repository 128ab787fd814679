//! Drivers whose velocity jumps: joints hold through every jump.

use soffio_math::{DVec3, Interpolation, Pose, rotation};
use soffio_multibody::dynamics::{KeyframeMotion, KinematicBody};

use super::{INTEGRATORS, World, body, step};

#[test]
fn joints_hold_through_every_jump_of_a_driver() {
    /// Largest gap of a joint, m.
    const CLOSED: f64 = 1e-9;
    for integrator in INTEGRATORS {
        for interpolation in [Interpolation::Step, Interpolation::Linear, Interpolation::Smooth, Interpolation::Spline]
        {
            // A hand that goes to and fro and turns, with keys between the steps, and three rods that hang from it.
            let place = |k: u32| {
                let side = if k.is_multiple_of(2) { 0.2 } else { -0.1 };
                Pose {
                    position: DVec3::new(side, 0.05 * f64::from(k % 3), 0.0),
                    rotation: rotation(DVec3::Z * (2.0 * side)),
                }
            };
            let keys: Vec<(f64, Pose)> = (0..9).map(|k| (0.1237 * f64::from(k), place(k % 8))).collect();
            let motion = KeyframeMotion { keys, interpolation, repeat: true };
            let start = motion.at(0.0).pose;
            let mut world = World::new(vec![body(1.0, DVec3::ONE, DVec3::ZERO)]);
            (world.bodies[0].position, world.bodies[0].rotation) = (start.position, start.rotation);
            for k in 0..3 {
                let top = start.position + DVec3::NEG_Y * (0.1 * f64::from(k));
                world.bodies.push(super::rod(0.05, top, top + DVec3::NEG_Y * 0.1));
                world.pin(&format!("joint-{k}"), k as usize + 1, Some(k as usize), top);
            }
            world.kinematic_bodies.push(KinematicBody { body: 0, motion });
            let mut dynamics = world.start(integrator);
            let none = [[0.0; 6]; 4];
            let mut worst = 0.0_f64;
            for _ in 0..720 {
                step(&mut dynamics, 1.0 / 240.0, &none);
                worst = worst.max(dynamics.joint_error());
            }
            println!("{integrator:?} {interpolation:?}: {worst} m");
            assert!(worst < CLOSED, "{integrator:?} {interpolation:?}: {worst} m");
        }
    }
}

/// A block welded to a driver takes its new speed at once, by the impulse m Δv; a rod on a hinge keeps its angular momentum about it.
#[test]
fn a_jump_is_an_impulse_through_the_joint() {
    /// Rounding of an integration over a step, relative.
    const EXACT: f64 = 1e-9;
    let at = |t: f64, x: f64| (t, Pose { position: DVec3::X * x, ..Pose::IDENTITY });
    let motion = KeyframeMotion {
        keys: vec![at(0.0, 0.0), at(0.1, 0.0), at(0.2, 0.3)],
        interpolation: Interpolation::Linear,
        repeat: false,
    };
    // A rod that hangs from the driver, 0.4 m long: ω = v/(2/3 L) about its top after the jump to v.
    let mut world =
        World::new(vec![body(1.0, DVec3::ONE, DVec3::ZERO), super::rod(0.1, DVec3::ZERO, DVec3::NEG_Y * 0.4)]);
    world.gravity = DVec3::ZERO;
    world.pin("hook", 1, Some(0), DVec3::ZERO);
    world.kinematic_bodies.push(KinematicBody { body: 0, motion });
    let mut dynamics = world.start(INTEGRATORS[0]);
    let none = [[0.0; 6]; 2];
    // 24 steps lead to the key at 0.1 s, where the driver begins to move.
    (0..23).for_each(|_| step(&mut dynamics, 1.0 / 240.0, &none));
    assert!(dynamics.bodies[1].velocity.length() < EXACT, "it hangs still until then");
    step(&mut dynamics, 1.0 / 240.0, &none);
    let rod = &dynamics.bodies[1];
    let (v, length) = (3.0, 0.4);
    let spin = -v / (2.0 / 3.0 * length);
    assert!((rod.angular_velocity.z / spin - 1.0).abs() < 1e-4, "{} rad/s, not {spin}", rod.angular_velocity.z);
    assert!((rod.velocity.x / (v + 0.5 * length * spin) - 1.0).abs() < 1e-4, "{} m/s", rod.velocity.x);
    assert!(dynamics.joint_error() < EXACT, "{} m", dynamics.joint_error());
}

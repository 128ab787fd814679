//! Pendulums on nails and hinges that are fixed, accelerated, shaken, or move along a path.

use soffio_geometry::bodies::RigidBody;
use soffio_math::Function;
use soffio_math::Interpolation;
use soffio_math::{DQuat, DVec3, PI, Pose, rotation};
use soffio_multibody::articulation::{Axis, ConstraintKind};
use soffio_multibody::dynamics::{Dynamics, Integrator, KeyframeMotion, KinematicBody};

use super::reference::flow;
use super::{CLOSED, DT, G, INTEGRATORS, ROUNDING, World, accelerated, body, elliptic_period, period, rod, run, step};

/// Relative error of a period over ten swings, and of an angle after some seconds, by the method's order at 1/240 s.
fn followed(integrator: Integrator) -> f64 {
    match integrator {
        Integrator::Precise => 1e-11,
        _ => 2e-7,
    }
}

/// Angle of a hanging body's centre from straight down about z, with its rate.
fn swing(body: &RigidBody, pivot: DVec3) -> (f64, f64) {
    let r = body.position - pivot;
    (r.x.atan2(-r.y), body.angular_velocity.z)
}

#[test]
fn a_rod_on_a_nail_keeps_the_elliptic_period() {
    let (l, angle) = (0.4, 0.9_f64);
    let mut world = World::new(vec![rod(0.1, DVec3::ZERO, DVec3::new(l * angle.sin(), -l * angle.cos(), 0.0))]);
    world.pin("nail", 0, None, DVec3::ZERO);
    // ω² = m g (l/2) / (m l²/3).
    let expected = elliptic_period(1.5 * G / l, angle);
    for integrator in INTEGRATORS {
        let mut dynamics = world.start(integrator);
        let found = period(&mut dynamics, 10.0, DT, |d| swing(&d.bodies[0], DVec3::ZERO));
        let error = (found / expected - 1.0).abs();
        println!("nail, {integrator:?}: period off by {error:.1e}");
        assert!(error < followed(integrator), "{integrator:?}: {found} s against {expected} s");
        assert!(dynamics.joint_error() < CLOSED);
    }
}

#[test]
fn a_body_of_any_shape_on_a_hinge_is_a_physical_pendulum() {
    // The axis is no principal axis: the hinge bears the torques out of the plane.
    let mut bob = body(0.7, DVec3::new(0.02, 0.03, 0.045), DVec3::new(0.25, -0.3, 0.1));
    bob.rotation = rotation(DVec3::new(0.4, -0.7, 0.3));
    let axis = DVec3::new(0.2, 0.1, 1.0).normalize();
    let mut world = World::new(vec![bob]);
    world.hinge("axle", 0, None, DVec3::ZERO, axis);
    let r = bob.position - axis * bob.position.dot(axis);
    let moment = axis.dot(bob.inertia_world() * axis) + bob.properties.mass * r.length_squared();
    // Gravity across the axle, and the angle from its direction.
    let down = DVec3::NEG_Y - axis * DVec3::NEG_Y.dot(axis);
    let angle = (r.normalize().dot(down.normalize())).acos();
    let square = bob.properties.mass * G * down.length() * r.length() / moment;
    let expected = elliptic_period(square, angle);
    let (d, side) = (down.normalize(), axis.cross(down.normalize()));
    for integrator in INTEGRATORS {
        let mut dynamics = world.start(integrator);
        let read = |dynamics: &Dynamics| {
            let r = dynamics.bodies[0].position;
            (r.dot(side).atan2(r.dot(d)), dynamics.bodies[0].angular_velocity.dot(axis))
        };
        let found = period(&mut dynamics, 10.0, DT, read);
        let error = (found / expected - 1.0).abs();
        println!("hinge, {integrator:?}: period off by {error:.1e}");
        assert!(error < followed(integrator), "{integrator:?}: {found} s against {expected} s");
        assert!(dynamics.joint_error() < CLOSED);
    }
}

/// A rod that hangs by its end from the origin, at an angle about z.
fn hanging(l: f64, angle: f64) -> RigidBody {
    rod(0.1, DVec3::ZERO, DVec3::new(l * angle.sin(), -l * angle.cos(), 0.0))
}

#[test]
fn a_nail_that_is_accelerated_tilts_and_hastens_its_pendulum() {
    // In its frame gravity is (−a, −g): the equilibrium is at atan(a/g), and the pendulum swings about it under √(g² + a²).
    let (l, a) = (0.5, 3.0_f64);
    let tilt = -(a / G).atan();
    for integrator in INTEGRATORS {
        for swing_by in [0.0, 0.4] {
            let mut world = World::new(vec![hanging(l, tilt + swing_by), body(1.0, DVec3::ONE, DVec3::ZERO)]);
            world.kinematic_bodies.push(accelerated(1, DVec3::X * a));
            world.pin("nail", 0, Some(1), DVec3::ZERO);
            let mut dynamics = world.start(integrator);
            let read = |dynamics: &Dynamics| {
                let (angle, rate) = swing(&dynamics.bodies[0], dynamics.bodies[1].position);
                (angle - tilt, rate)
            };
            if swing_by == 0.0 {
                run(&mut dynamics, 5.0, DT);
                let (angle, rate) = read(&dynamics);
                assert!(angle.abs() < ROUNDING && rate.abs() < ROUNDING, "{integrator:?}: {angle} rad, {rate} rad/s");
            } else {
                let expected = elliptic_period(1.5 * (G * G + a * a).sqrt() / l, swing_by);
                let found = period(&mut dynamics, 10.0, DT, read);
                let error = (found / expected - 1.0).abs();
                println!("accelerated nail, {integrator:?}: period off by {error:.1e}");
                assert!(error < followed(integrator), "{integrator:?}: {found} s against {expected} s");
            }
            // The nail has gone a hundred metres.
            assert!(dynamics.joint_error() < 1e2 * CLOSED);
        }
    }
}

#[test]
fn a_nail_shaken_up_and_down_drives_its_pendulum() {
    // θ̈ = −(g + ÿ) (3/2 l) sin θ with y = A sin(2πt/T): the nail is three planes, the middle one's height a wave.
    let (l, angle, amplitude, beat) = (0.3, 0.6, 0.05, 0.35);
    let wave = Function::Wave { mean: 0.0, amplitude, period: beat, phase: 0.0 };
    let mut world = World::new(vec![hanging(l, angle)]);
    // It starts with the nail's velocity, without rotation.
    world.bodies[0].velocity = DVec3::Y * wave.at(0.0).rate;
    let (point, plane) = (world.anchor(Some(0), DVec3::ZERO), world.anchor(None, DVec3::ZERO));
    for (normal, offset) in [(DVec3::X, Function::default()), (DVec3::Y, wave.clone()), (DVec3::Z, Function::default())]
    {
        world.add("nail", ConstraintKind::PointOnPlane { point, plane, normal, offset });
    }
    let rate = |t: f64, y: &[f64]| {
        let omega = 2.0 * PI / beat;
        let lift = -amplitude * omega * omega * (omega * t).sin();
        vec![y[1], -1.5 * (G + lift) / l * y[0].sin()]
    };
    let expected = flow(&rate, &[angle, 0.0], 4.0, 0.01);
    for integrator in INTEGRATORS {
        let mut dynamics = world.start(integrator);
        run(&mut dynamics, 4.0, DT);
        let nail = DVec3::Y * wave.at(4.0).value;
        let (found, _) = swing(&dynamics.bodies[0], nail);
        let error = (found - expected[0]).abs();
        println!("shaken nail, {integrator:?}: off by {error:.1e} rad");
        // The wave has eleven times the frequency of the pendulum.
        assert!(error < 1e3 * followed(integrator), "{integrator:?}: {found} against {} rad", expected[0]);
        assert!(dynamics.joint_error() < CLOSED);
    }
}

#[test]
fn a_point_goes_along_its_path_and_feels_what_that_takes() {
    let keys = (0..9)
        .map(|i| {
            let t = f64::from(i);
            let position = DVec3::new((0.8 * t).sin(), 0.3 * (1.7 * t).cos(), 0.2 * t);
            (t, Pose { rotation: DQuat::IDENTITY, position })
        })
        .collect();
    let path = KeyframeMotion { keys, interpolation: Interpolation::Spline, repeat: false };
    let mass = 0.3;
    for integrator in INTEGRATORS {
        let mut world = World::new(vec![body(mass, DVec3::ONE, DVec3::ZERO), body(1.0, DVec3::ONE, DVec3::ZERO)]);
        world.bodies[0].position = path.at(0.0).pose.position;
        world.bodies[1].position = path.at(0.0).pose.position;
        world.pin("path", 0, Some(1), world.bodies[0].position);
        world.kinematic_bodies.push(KinematicBody { body: 1, motion: path.clone() });
        let mut dynamics = world.start(integrator);
        let no_wrenches = [[0.0; 6]; 2];
        for index in 0..1900 {
            step(&mut dynamics, DT, &no_wrenches);
            let now = path.at(f64::from(index + 1) * DT);
            assert!(dynamics.bodies[0].position.distance(now.pose.position) < CLOSED);
            assert!(dynamics.bodies[0].velocity.distance(now.velocity) < ROUNDING);
            let expected = mass * (now.acceleration + DVec3::Y * G).length();
            let found = dynamics.system().constraint_load(0).force;
            assert!((found - expected).abs() < ROUNDING, "{found} N against {expected} N");
        }
    }
}

#[test]
fn a_pendulum_in_a_turning_hinge_is_thrown_outwards() {
    // The axle turns about the vertical at Ω: θ̈ = Ω² k sin θ cos θ − (3g/2l) sin θ, k = 1 − I₃/I₁ by the moments about
    // the nail. Its equilibrium is cos θ = 3g/(2 l k Ω²).
    let (l, omega) = (0.4, 9.0);
    let k = 1.0 - 1e-3 * 0.25;
    let equilibrium = (1.5 * G / (l * k * omega * omega)).acos();
    for integrator in INTEGRATORS {
        for (start, at_equilibrium) in [(equilibrium, true), (0.3, false)] {
            let mut bob = hanging(l, start);
            let spin = DVec3::Y * omega;
            (bob.angular_velocity, bob.velocity) = (spin, spin.cross(bob.position));
            let mut world = World::new(vec![bob, body(1.0, DVec3::ONE, DVec3::ZERO)]);
            world.hinge("axle", 0, Some(1), DVec3::ZERO, DVec3::Z);
            world.kinematic_bodies.push(super::turning(1, spin));
            let mut dynamics = world.start(integrator);
            run(&mut dynamics, 2.0, DT);
            let r = dynamics.bodies[0].position;
            let found = r.x.hypot(r.z).atan2(-r.y);
            let rate =
                |_: f64, y: &[f64]| vec![y[1], k * omega * omega * y[0].sin() * y[0].cos() - 1.5 * G / l * y[0].sin()];
            let expected = if at_equilibrium { equilibrium } else { flow(&rate, &[start, 0.0], 2.0, 0.01)[0] };
            let error = (found - expected.abs()).abs();
            println!("turning hinge, {integrator:?}: off by {error:.1e} rad");
            assert!(error < 1e2 * followed(integrator), "{integrator:?}: {found} against {expected} rad");
            assert!(dynamics.joint_error() < CLOSED);
        }
    }
}

#[test]
fn an_axis_of_the_world_is_no_body() {
    // A joint to the world and one to a kinematic body at rest are the same.
    let mut world = World::new(vec![hanging(0.4, 0.5), body(1.0, DVec3::ONE, DVec3::ZERO)]);
    let mut kinematic = world.clone();
    world.hinge("axle", 0, None, DVec3::ZERO, DVec3::Z);
    kinematic.hinge("axle", 0, Some(1), DVec3::ZERO, DVec3::Z);
    let standing = vec![(0.0, Pose::IDENTITY)];
    kinematic.kinematic_bodies.push(KinematicBody {
        body: 1,
        motion: KeyframeMotion { keys: standing, interpolation: Interpolation::Step, repeat: false },
    });
    let mut ends = Vec::new();
    for world in [world, kinematic] {
        assert!(matches!(world.constraints[1].kind, ConstraintKind::Orientation { a: Axis { body: Some(0), .. }, .. }));
        let mut dynamics = world.start(Integrator::RungeKutta);
        run(&mut dynamics, 1.0, DT);
        ends.push(dynamics.bodies[0]);
    }
    assert!(ends[0].position.distance(ends[1].position) < ROUNDING);
}

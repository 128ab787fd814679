//! Alternating orientations: a wheel's axle moves from one axis to another, critically damped.

use soffio_math::Function;
use soffio_math::{DVec3, PI, rotation};
use soffio_multibody::articulation::{Constraint, ConstraintKind, Schedule, Window};

use super::{DT, INTEGRATORS, OMEGA, World, step, wheel};

/// When the rows change; inside a step.
const CHANGE: f64 = 0.1037;
/// Angle error, rad: the stabiliser moves the axle until projection closes the last 1e-4 rad.
const REACH: f64 = 1.5e-4;
/// Error of the rate, rad/s: ω₀ times that.
const RATE: f64 = 2.0 * OMEGA * REACH;

/// A wheel on a nail whose axle is constrained along `from`, then along `to`; all rotated by `frame_rotation`.
fn swapping(from: DVec3, to: DVec3, frame_rotation: DVec3, spin: f64) -> World {
    let frame = rotation(frame_rotation);
    let (from, to) = (frame * from, frame * to);
    let third = from.cross(to);
    let mut wheel = wheel(0.5, 2e-3, DVec3::ZERO);
    wheel.rotation = soffio_math::DQuat::from_rotation_arc(DVec3::Z, from);
    wheel.angular_velocity = spin * from;
    let mut world = World::new(vec![wheel]);
    world.pin("nail", 0, None, DVec3::ZERO);
    let before = Window { start: f64::NEG_INFINITY, end: CHANGE };
    let after = Window { start: CHANGE, end: f64::INFINITY };
    let axle = world.axis(Some(0), from);
    for (name, across, window) in
        [("from-1", to, before), ("from-2", third, before), ("to-1", from, after), ("to-2", third, after)]
    {
        let b = world.axis(None, across);
        let kind = ConstraintKind::Orientation { a: axle, b, angle: Function::default() };
        let schedule = Schedule { windows: vec![window], ..Schedule::default() };
        world.constraints.push(Constraint { schedule, ..Constraint::new(name, kind) });
    }
    world
}

#[test]
fn a_wheel_goes_from_axis_to_axis_smoothly() {
    let axes = DVec3::AXES;
    for integrator in INTEGRATORS {
        for (from, to) in [(2, 1), (1, 2), (0, 1), (1, 0), (0, 2), (2, 0)] {
            for (frame_rotation, spin) in [(DVec3::ZERO, 0.0), (DVec3::ZERO, 8.0), (DVec3::new(0.3, -0.8, 0.5), 3.0)] {
                let case = format!("{integrator:?}, axis {from} to {to} turned by {frame_rotation}, {spin} rad/s");
                let world = swapping(axes[from], axes[to], frame_rotation, spin);
                let axle = rotation(frame_rotation) * axes[from];
                let goal = rotation(frame_rotation) * axes[to];
                let mut dynamics = world.start(integrator);
                let mut before = dynamics.bodies[0].angular_velocity;
                let (mut jump, mut last) = (0.0_f64, 0.0);
                for index in 0..240 {
                    step(&mut dynamics, DT, &[[0.0; 6]]);
                    let t = f64::from(index + 1) * DT;
                    let now = dynamics.bodies[0].rotation * world.axis(Some(0), axle).direction;
                    let angle = now.dot(axle).clamp(-1.0, 1.0).acos();
                    // Any direction is allowed, with C = π/2 (1 + ω₀t) exp(−ω₀t).
                    let since = (t - CHANGE).max(0.0);
                    let expected = 0.5 * PI * (1.0 - (1.0 + OMEGA * since) * (-OMEGA * since).exp());
                    assert!((angle - expected).abs() < REACH, "{case}: {angle} rad against {expected} rad at {t} s");
                    let rate = dynamics.bodies[0].angular_velocity;
                    jump = jump.max((rate - before).length());
                    (before, last) = (rate, angle);
                }
                let side = (dynamics.bodies[0].rotation * world.axis(Some(0), axle).direction).dot(goal).abs();
                assert!((side - 1.0).abs() < 1e-12, "{case}: it ends {last} rad away");
                // No acceleration above that of the stabiliser at the start, ω₀² π/2, and that of the spin.
                let allowed = (OMEGA * OMEGA * 0.5 * PI + OMEGA * spin) * DT + RATE;
                assert!(jump < allowed, "{case}: ω jumps by {jump}, at most {allowed} rad/s");
                assert!(dynamics.joint_error() < super::CLOSED);
            }
        }
    }
}

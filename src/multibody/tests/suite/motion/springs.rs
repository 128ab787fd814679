//! Springs and dampers, along lines and about axles.

use soffio_math::Function;
use soffio_math::Interpolation;
use soffio_math::{DVec3, PI};
use soffio_multibody::articulation::{Measure, Schedule, Spring, SpringKind};
use soffio_multibody::dynamics::Integrator;
use soffio_multibody::dynamics::forces::Damping;

use super::reference::flow;
use super::{CLOSED, DT, G, INTEGRATORS, ROUNDING, World, body, period, run, wheel};

pub fn spring(kind: SpringKind, stiffness: f64, damping: f64) -> Spring {
    Spring {
        name: "spring".into(),
        kind,
        rest_length: Function::default(),
        stiffness: stiffness.into(),
        damping: damping.into(),
        schedule: Schedule::default(),
        breaking: None,
    }
}

fn period_error(integrator: Integrator) -> f64 {
    if integrator == Integrator::Precise { 1e-11 } else { 2e-7 }
}

#[test]
fn a_slider_on_a_spring_keeps_two_pi_root_m_over_k() {
    let (m, k, rest_length) = (0.3, 12.0, 0.5);
    let along = DVec3::new(0.6, 0.0, 0.8);
    for integrator in INTEGRATORS {
        let mut world = World::new(vec![body(m, DVec3::splat(1e-3), along * 0.6)]);
        world.slider("slider", 0, None, along);
        let (a, b) = (world.anchor(Some(0), world.bodies[0].position), world.anchor(None, DVec3::ZERO));
        world.springs.push(Spring { rest_length: rest_length.into(), ..spring(SpringKind::Linear { a, b }, k, 0.0) });
        let mut dynamics = world.start(integrator);
        let energy = dynamics.energy();
        let found = period(&mut dynamics, 10.0, DT, |d| {
            (d.bodies[0].position.dot(along) - rest_length, d.bodies[0].velocity.dot(along))
        });
        let error = (found / (2.0 * PI * (m / k).sqrt()) - 1.0).abs();
        println!("slider, {integrator:?}: period off by {error:.1e}");
        assert!(error < period_error(integrator), "{integrator:?}: {found} s");
        let swing = 0.5 * k * 0.1 * 0.1;
        let kept = (dynamics.energy() - energy).abs() / swing;
        assert!(kept < 100.0 * period_error(integrator), "{integrator:?}: energy off by {kept:e}");
        assert!(dynamics.joint_error() < CLOSED);
    }
}

#[test]
fn a_wheel_on_a_torsion_spring_keeps_its_period_through_whole_turns() {
    let (j, k) = (2e-3, 0.02);
    for integrator in INTEGRATORS {
        let mut world = World::new(vec![wheel(0.2, j, DVec3::ZERO)]);
        world.hinge("axle", 0, None, DVec3::ZERO, DVec3::Z);
        let measure = Measure::Angle { axis: world.axis(Some(0), DVec3::Z), frame: None };
        // It was wound up by three turns.
        let wound = 6.0 * PI;
        world.springs.push(Spring { rest_length: wound.into(), ..spring(SpringKind::Angular { measure }, k, 0.0) });
        let mut dynamics = world.start(integrator);
        let half = PI * (j / k).sqrt();
        let steps = 480.0;
        run(&mut dynamics, half, half / steps);
        // Half a period later it is as far on the other side, at its turning point.
        let wheel = &dynamics.bodies[0];
        let angle = 2.0 * wheel.rotation.z.atan2(wheel.rotation.w);
        let off = (angle - 2.0 * wound).rem_euclid(2.0 * PI);
        let off = off.min(2.0 * PI - off) / wound;
        println!("torsion spring, {integrator:?}: off by {off:.1e}");
        assert!(off < 10.0 * period_error(integrator), "{integrator:?}: off by {off:e}");
        let rate = wheel.angular_velocity.z / (wound * (k / j).sqrt());
        assert!(rate.abs() < 10.0 * period_error(integrator), "{integrator:?}: still turning, {rate:e}");
        // Between two bodies the reduced inertia counts.
        let mut world = World::new(vec![wheel_at(j, 0.0), wheel_at(3.0 * j, 0.1)]);
        world.hinge("axle-1", 0, None, DVec3::ZERO, DVec3::Z);
        world.hinge("axle-2", 1, None, DVec3::Z * 0.1, DVec3::Z);
        let measure = Measure::Angle { axis: world.axis(Some(0), DVec3::Z), frame: Some(1) };
        world.springs.push(spring(SpringKind::Angular { measure }, k, 0.0));
        world.bodies[0].angular_velocity = DVec3::Z;
        let mut dynamics = world.start(integrator);
        let read = |d: &soffio_multibody::dynamics::Dynamics| {
            let relative = d.bodies[1].rotation.conjugate() * d.bodies[0].rotation;
            (2.0 * relative.z.atan2(relative.w), d.bodies[0].angular_velocity.z - d.bodies[1].angular_velocity.z)
        };
        let found = period(&mut dynamics, 8.0, DT, read);
        let error = (found / (2.0 * PI * (0.75 * j / k).sqrt()) - 1.0).abs();
        assert!(error < period_error(integrator), "{integrator:?}: {found} s");
    }
}

fn wheel_at(j: f64, z: f64) -> soffio_geometry::bodies::RigidBody {
    wheel(0.2, j, DVec3::Z * z)
}

#[test]
fn dampers_and_damping_slow_by_the_exponential() {
    let (m, c, v, rate) = (0.3, 0.9, 2.0, 3.0);
    for integrator in INTEGRATORS {
        // A dashpot on a slider, one on an axle, and a body's own damping.
        let mut bodies = vec![body(m, DVec3::splat(1e-3), DVec3::X), wheel(0.2, 1e-3, DVec3::Y)];
        bodies[0].velocity = DVec3::X * v;
        bodies[1].angular_velocity = DVec3::Z * rate;
        let mut world = World::new(bodies.clone());
        world.gravity = DVec3::ZERO;
        world.slider("slider", 0, None, DVec3::X);
        world.hinge("axle", 1, None, DVec3::Y, DVec3::Z);
        let (a, b) = (world.anchor(Some(0), DVec3::X), world.anchor(None, DVec3::ZERO));
        world.springs.push(spring(SpringKind::Linear { a, b }, 0.0, c));
        let measure = Measure::Angle { axis: world.axis(Some(1), DVec3::Z), frame: None };
        world.springs.push(spring(SpringKind::Angular { measure }, 0.0, 3e-3));
        let mut dashpots = world.start(integrator);
        run(&mut dashpots, 1.0, DT);
        let mut world = World::new(bodies);
        world.gravity = DVec3::ZERO;
        world.damping = Damping { linear: c / m, angular: 3.0 };
        let mut own = world.start(integrator);
        run(&mut own, 1.0, DT);
        for dynamics in [dashpots, own] {
            let found = [dynamics.bodies[0].velocity.x / v, dynamics.bodies[1].angular_velocity.z / rate];
            for found in found {
                let error = (found / (-3.0_f64).exp() - 1.0).abs();
                let allowed = if integrator == Integrator::Precise { ROUNDING } else { 1e-8 };
                assert!(error < allowed, "{integrator:?}: off by {error:e}");
            }
            // The displacement is v m/c (1 − exp(−c t/m)).
            let displacement = v * m / c * (1.0 - (-3.0_f64).exp());
            assert!((dynamics.bodies[0].position.x - 1.0 - displacement).abs() < 1e-8);
        }
    }
}

#[test]
fn a_spring_whose_rest_and_stiffness_change_does_as_its_equation_says() {
    let (m, h) = (0.4, 1.1);
    let rest_length = Function::Wave { mean: 1.0, amplitude: 0.1, period: 0.7, phase: 0.2 };
    let keys = vec![(0.0, 20.0), (1.0, 60.0), (2.0, 10.0)];
    let stiffness = Function::Keys { keys, interpolation: Interpolation::Smooth, repeat: false };
    let damping = 0.5;
    let rate = |t: f64, y: &[f64]| {
        let (l, k) = (rest_length.at(t), stiffness.at(t).value);
        // Downwards from the hook.
        vec![y[1], G - (k * (y[0] - l.value) + damping * (y[1] - l.rate)) / m]
    };
    // In pieces that end at the keys.
    let first = flow(&rate, &[h, 0.0], 1.0, 0.02);
    let expected = flow(&|t, y: &[f64]| rate(t + 1.0, y), &first, 1.0, 0.02);
    for integrator in INTEGRATORS {
        let mut world = World::new(vec![body(m, DVec3::splat(1e-3), DVec3::NEG_Y * h)]);
        let (a, b) = (world.anchor(Some(0), world.bodies[0].position), world.anchor(None, DVec3::ZERO));
        let base = spring(SpringKind::Linear { a, b }, 0.0, damping);
        world.springs.push(Spring { rest_length: rest_length.clone(), stiffness: stiffness.clone(), ..base });
        let mut dynamics = world.start(integrator);
        run(&mut dynamics, 2.0, DT);
        let off = (dynamics.bodies[0].position.y + expected[0]).abs();
        println!("changing spring, {integrator:?}: off by {off:.1e} m");
        // The third derivative of smooth keys jumps, so the sixth order is not reached.
        let allowed = if integrator == Integrator::Precise { 1e-10 } else { 1e-7 };
        assert!(off < allowed, "{integrator:?}: off by {off:e} m");
    }
}

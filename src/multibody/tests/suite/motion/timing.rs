//! Activation windows, ramps, breaking, healing and triggers, each at its time inside the step.

use soffio_math::Function;
use soffio_math::Interpolation;
use soffio_math::{DVec3, rotation};
use soffio_multibody::articulation::{
    Breaking, Constraint, ConstraintKind, Load, Measure, Schedule, Spring, SpringKind, Term, Trigger, Window,
};
use soffio_multibody::collision::{Collider, ReachableVolumes, Shape, pairs};
use soffio_multibody::dynamics::forces::Damping;
use soffio_multibody::dynamics::{Articulation, Dynamics, Integrator, RollingResistance, SurfacePair};

use super::reference::flow;
use super::springs::spring;
use super::{CLOSED, DT, G, INTEGRATORS, OMEGA, ROUNDING, World, body, rod, run, step, wheel};

fn window(start: f64, end: f64) -> Schedule {
    Schedule { windows: vec![Window { start, end }], ..Schedule::default() }
}

#[test]
fn a_nail_lets_go_inside_the_step() {
    let end = 0.3337;
    for integrator in INTEGRATORS {
        let mut world = World::new(vec![body(0.2, DVec3::splat(1e-3), DVec3::ZERO)]);
        world.pin("nail", 0, None, DVec3::ZERO);
        world.constraints[0].schedule = window(f64::NEG_INFINITY, end);
        let mut dynamics = world.start(integrator);
        run(&mut dynamics, 1.0, DT);
        let off = dynamics.bodies[0].position.y + 0.5 * G * (1.0 - end) * (1.0 - end);
        assert!(off.abs() < ROUNDING, "{integrator:?}: off by {off:e} m");
    }
}

#[test]
fn a_floor_is_there_from_its_moment_on() {
    // The stone passes the height of the floor when the floor appears.
    let start = 0.4321;
    let height = -0.5 * G * start * start;
    for integrator in INTEGRATORS {
        let mut stone = body(0.2, DVec3::splat(1e-3), DVec3::ZERO);
        stone.velocity = DVec3::X * 0.3;
        let mut world = World::new(vec![stone]);
        let (point, plane) = (world.anchor(Some(0), DVec3::ZERO), world.anchor(None, DVec3::Y * height));
        world
            .add("floor", ConstraintKind::PointOnPlane { point, plane, normal: DVec3::Y, offset: Function::default() });
        world.constraints[0].schedule = window(start, f64::INFINITY);
        let mut dynamics = world.start(integrator);
        run(&mut dynamics, 1.0, DT);
        let off = dynamics.bodies[0].position - DVec3::new(0.3, height, 0.0);
        assert!(off.length() < ROUNDING, "{integrator:?}: off by {off} m");
    }
}

#[test]
fn a_periodic_window_brakes_for_its_share_of_the_time() {
    // Open for 0.2 s of every 0.31 s, from 0.05 s on: in 1 s that is 3 · 0.2 s and the 20 ms from 0.98 s on.
    let (m, c) = (0.3, 1.2);
    for integrator in INTEGRATORS {
        let mut sled = body(m, DVec3::splat(1e-3), DVec3::X);
        sled.velocity = DVec3::X * 2.0;
        let mut world = World::new(vec![sled]);
        world.gravity = DVec3::ZERO;
        let (a, b) = (world.anchor(Some(0), DVec3::X), world.anchor(None, DVec3::ZERO));
        let schedule = Schedule { period: Some(0.31), ..window(0.05, 0.25) };
        world.springs.push(Spring { schedule, ..spring(SpringKind::Linear { a, b }, 0.0, c) });
        let mut dynamics = world.start(integrator);
        run(&mut dynamics, 1.0, DT);
        let open = 3.0 * 0.2 + 0.02;
        let expected = 2.0 * (-c / m * open).exp();
        let error = (dynamics.bodies[0].velocity.x / expected - 1.0).abs();
        let allowed = if integrator == Integrator::Precise { ROUNDING } else { 1e-8 };
        assert!(error < allowed, "{integrator:?}: off by {error:e}");
    }
}

#[test]
fn a_nail_that_fades_carries_its_share_and_the_stabiliser_s() {
    // ÿ = −(1 − s) g − s (ω₀² y + 2 ω₀ ẏ), s from 1 to 0 in half a second.
    let (from, to) = (0.25, 0.75);
    let activation = |t: f64| ((to - t) / (to - from)).clamp(0.0, 1.0);
    let rate = |t: f64, y: &[f64]| {
        let s = activation(t + from);
        vec![y[1], -(1.0 - s) * G - s * (OMEGA * OMEGA * y[0] + 2.0 * OMEGA * y[1])]
    };
    let expected = flow(&rate, &[0.0, 0.0], to - from, 1e-3);
    let falls = expected[0] + expected[1] * 0.25 - 0.5 * G * 0.0625;
    for integrator in INTEGRATORS {
        let mut errors = Vec::new();
        for dt in [DT, 0.5 * DT] {
            // At the end of a rod, where the effective inverse mass differs in every direction.
            let mut world = World::new(vec![body(0.2, DVec3::splat(1e-3), DVec3::ZERO)]);
            world.pin("nail", 0, None, DVec3::ZERO);
            world.constraints[0].schedule = Schedule { ramp_out: to - from, ..window(f64::NEG_INFINITY, to) };
            let mut dynamics = world.start(integrator);
            run(&mut dynamics, 1.0, dt);
            errors.push((dynamics.bodies[0].position.y - falls).abs());
        }
        println!("fading nail, {integrator:?}: off by {:.1e} m, {:.1e} m in half steps", errors[0], errors[1]);
        // The activation is that of the middle of a substep: second order.
        assert!(errors[0] < 1e-4 && errors[1] < 0.3 * errors[0], "{integrator:?}: {errors:?}");
    }
}

/// A rod on a nail, pulled down by a spring whose force grows from 0 by `growth` N a second.
fn loaded(growth: f64) -> World {
    let k = 50.0;
    let mut world = World::new(vec![rod(0.2, DVec3::ZERO, DVec3::NEG_Y * 0.3)]);
    world.pin("nail", 0, None, DVec3::ZERO);
    let (a, b) = (world.anchor(Some(0), DVec3::NEG_Y * 0.3), world.anchor(None, DVec3::NEG_Y * 1.3));
    let keys = vec![(0.0, 1.0), (10.0, 1.0 - 10.0 * growth / k)];
    let rest_length = Function::Keys { keys, interpolation: Interpolation::Linear, repeat: false };
    world.springs.push(Spring { rest_length, ..spring(SpringKind::Linear { a, b }, k, 0.0) });
    world
}

#[test]
fn an_overloaded_nail_breaks_within_the_substep() {
    let (limit, growth) = (3.0, 1.7);
    for integrator in INTEGRATORS {
        let mut world = loaded(growth);
        world.constraints[0].breaking = Some(Breaking { force: limit, ..Breaking::default() });
        let mut dynamics = world.start(integrator);
        let expected = (limit - 0.2 * G) / growth;
        let mut found = None;
        for _ in 0..240 {
            step(&mut dynamics, DT, &[[0.0; 6]]);
            if let [broken] = dynamics.breaks() {
                found = Some(broken.time);
                break;
            }
        }
        let found = found.expect("it breaks");
        let substep = DT / f64::from(dynamics.substeps());
        assert!(found >= expected - 1e-9 && found <= expected + substep, "{integrator:?}: {found} s, not {expected} s");
        run(&mut dynamics, 0.2, DT);
        assert_eq!(dynamics.system().constraint_load(0), Load::default());
        assert!(dynamics.bodies[0].position.y < -0.25, "it still hangs");
        assert!(dynamics.breaks().is_empty(), "it breaks once");
    }
}

#[test]
fn of_equal_links_the_one_that_carries_most_breaks_first() {
    for integrator in INTEGRATORS {
        let links = (0..4).map(|i| {
            let top = DVec3::NEG_Y * 0.2 * f64::from(i);
            rod(0.1, top, top - DVec3::Y * 0.2)
        });
        let mut world = World::new(links.collect());
        for i in 0..4 {
            world.pin(&format!("link-{i}"), i, i.checked_sub(1), DVec3::NEG_Y * 0.2 * i as f64);
            world.constraints[i].breaking = Some(Breaking { force: 5.0, ..Breaking::default() });
        }
        let (a, b) = (world.anchor(Some(3), DVec3::NEG_Y * 0.8), world.anchor(None, DVec3::NEG_Y * 1.8));
        let keys = vec![(0.0, 1.0), (2.0, 0.0)];
        let rest_length = Function::Keys { keys, interpolation: Interpolation::Linear, repeat: false };
        world.springs.push(Spring { rest_length, ..spring(SpringKind::Linear { a, b }, 10.0, 0.0) });
        let mut dynamics = world.start(integrator);
        let mut broken = Vec::new();
        while broken.is_empty() {
            step(&mut dynamics, DT, &[[0.0; 6]; 4]);
            broken.extend(dynamics.breaks().iter().map(|b| (b.index, b.time)));
        }
        // Top: 0.4 kg and 5 N/s.
        let expected = (5.0 - 0.4 * G) / 5.0;
        assert_eq!(broken[0].0, 0);
        assert!((broken[0].1 - expected).abs() < DT, "{integrator:?}: {} s against {expected} s", broken[0].1);
    }
}

#[test]
fn a_hinge_breaks_as_a_whole_and_heals_gently() {
    let restore = 0.15;
    for integrator in INTEGRATORS {
        let mut world = World::new(vec![rod(0.2, DVec3::ZERO, DVec3::NEG_Y * 0.3)]);
        world.hinge("axle", 0, None, DVec3::ZERO, DVec3::Z);
        world.constraints[0].breaking = Some(Breaking { force: 5.0, restore, ..Breaking::default() });
        let mut dynamics = world.start(integrator);
        // Under 9 N and a torque the nail breaks, and the axle's orientations with it.
        let torn = [2.0, -9.0, 1.0, 0.05, 0.05, 0.0];
        step(&mut dynamics, DT, &[torn]);
        assert_eq!(dynamics.breaks().len(), 1, "{:?}", dynamics.breaks());
        let broken = dynamics.breaks()[0].time;
        for index in 0..3 {
            assert_eq!(dynamics.system().activity.activation(index), 0.0, "part {index} still holds");
        }
        run(&mut dynamics, restore - 2.0 * DT, DT);
        let gap = |d: &Dynamics| d.bodies[0].pose().point(world.anchor(Some(0), DVec3::ZERO).point).length();
        let fallen = gap(&dynamics);
        assert!(fallen > 0.05, "it fell by {fallen} m");
        // Critical damping: it moves on by at most v/(e ω₀) and returns without overshoot.
        let speed = dynamics.bodies[0].velocity.length() + dynamics.bodies[0].angular_velocity.length() * 0.3;
        let mut last = 0.0;
        for _ in 0..480 {
            step(&mut dynamics, DT, &[[0.0; 6]]);
            last = gap(&dynamics);
            assert!(last < fallen + speed * (3.0 * DT + 0.5 / OMEGA), "{integrator:?}: it swings out to {last} m");
        }
        assert!(broken < DT * 1.0001);
        let axle = dynamics.bodies[0].rotation * world.axis(Some(0), DVec3::Z).direction;
        assert!(last < CLOSED && (axle.dot(DVec3::Z).abs() - 1.0).abs() < CLOSED, "{integrator:?}: {last} m, {axle}");
        assert!(dynamics.joint_error() < CLOSED);
    }
}

#[test]
fn a_broken_nail_carries_nothing_and_the_other_carries_more() {
    // A bar on two nails: m g/2 each. When one breaks the other carries m g/4 at once (a rod that begins to rotate).
    for integrator in INTEGRATORS {
        let (l, m) = (0.6, 0.4);
        let mut world = World::new(vec![rod(m, DVec3::ZERO, DVec3::X * l)]);
        world.pin("left", 0, None, DVec3::ZERO);
        world.plane("right", 0, None, DVec3::X * l, DVec3::Y);
        world.constraints[1].schedule = window(f64::NEG_INFINITY, 0.5);
        let mut dynamics = world.start(integrator);
        run(&mut dynamics, 0.25, DT);
        let loads = |d: &Dynamics| [d.system().constraint_load(0).force, d.system().constraint_load(1).force];
        let [left, right] = loads(&dynamics);
        assert!((left - 0.5 * m * G).abs() < ROUNDING && (right - 0.5 * m * G).abs() < ROUNDING, "{left} {right}");
        run(&mut dynamics, 0.25, DT);
        step(&mut dynamics, 1e-6, &[[0.0; 6]]);
        let [left, right] = loads(&dynamics);
        // A microsecond later it has rotated by 1e-11 rad, at 2e-5 rad/s.
        assert!((left - 0.25 * m * G).abs() < 1e-6 && right == 0.0, "{integrator:?}: {left} N and {right} N");
        // A coupling whose window has ended carries nothing either.
        let mut world = World::new(vec![wheel(0.2, 1e-3, DVec3::ZERO), wheel(0.2, 1e-3, DVec3::X)]);
        world.hinge("axle-0", 0, None, DVec3::ZERO, DVec3::Z);
        world.hinge("axle-1", 1, None, DVec3::X, DVec3::Z);
        let terms = [0, 1].map(|i| Term {
            measure: Measure::Angle { axis: world.axis(Some(i), DVec3::Z), frame: None },
            coefficient: 1.0,
        });
        world.add("gears", ConstraintKind::Coupling { terms: terms.to_vec() });
        let last = world.constraints.len() - 1;
        world.constraints[last].schedule = window(f64::NEG_INFINITY, 0.1);
        let mut dynamics = world.start(integrator);
        let torque = [[0.0, 0.0, 0.0, 0.0, 0.0, 0.01], [0.0; 6]];
        for index in 0..48 {
            step(&mut dynamics, DT, &torque);
            let expected = if f64::from(index + 1) * DT <= 0.1 { 0.005 } else { 0.0 };
            let found = dynamics.system().constraint_load(last).force;
            assert!((found - expected).abs() < ROUNDING, "{integrator:?}, step {index}: {found}");
        }
    }
}

#[test]
fn a_breath_starts_the_clock_once_and_the_next_one_again() {
    // A brake that acts for 0.1 s, from 0.02 s after every breath of 3 m/s or more.
    let (m, c) = (0.3, 2.0);
    for integrator in INTEGRATORS {
        let mut sled = body(m, DVec3::splat(1e-3), DVec3::X);
        sled.velocity = DVec3::X * 2.0;
        let mut world = World::new(vec![sled]);
        world.gravity = DVec3::ZERO;
        let (a, b) = (world.anchor(Some(0), DVec3::X), world.anchor(None, DVec3::ZERO));
        let schedule = Schedule { trigger: Some(Trigger::Breath { least_speed: 3.0 }), ..window(0.02, 0.12) };
        world.springs.push(Spring { schedule, ..spring(SpringKind::Linear { a, b }, 0.0, c) });
        let mut dynamics = world.start(integrator);
        let mut braking = 0.0;
        for index in 0..240 {
            // Too weak; strong, and continuing; a pause; strong again.
            let breath = match index {
                10..=30 => 2.9,
                40..=80 => 3.5,
                120..=130 => 6.0,
                _ => 0.0,
            };
            dynamics.set_breath_speed(breath);
            step(&mut dynamics, DT, &[[0.0; 6]]);
            if index == 39 || index == 75 || index == 239 {
                let expected = 2.0 * (-c / m * braking).exp();
                let error = (dynamics.bodies[0].velocity.x / expected - 1.0).abs();
                assert!(error < 1e-8, "{integrator:?}, step {index}: off by {error:e}");
            }
            if index == 39 || index == 119 {
                braking += 0.1;
            }
        }
    }
}

#[test]
fn an_impact_releases_the_constraint_that_it_triggers() {
    // A ball swings against another that hangs on a nail whose window ends 0.05 s after the impact: then it flies off.
    let r = 0.02;
    let ball = |at: DVec3| body(0.1, DVec3::splat(0.4 * 0.1 * r * r), at);
    let (top, gap) = (DVec3::Y * 0.5, DVec3::X * (2.0 * r + 1e-6));
    let mut world = World::new(vec![ball(rotation(DVec3::Z * -0.3) * -top + top), ball(gap)]);
    world.bodies[0].rotation = rotation(DVec3::Z * -0.3);
    world.pin("nail-0", 0, None, top);
    world.pin("nail-1", 1, None, top + gap);
    let impact = |least_impulse| Some(Trigger::Impact { body: 1, least_impulse });
    // Before the impact the schedule is not running: its complement acts until then.
    let (a, b) = (world.anchor(Some(1), gap), world.anchor(None, DVec3::X * 2.0));
    let schedule = Schedule { trigger: impact(1e-3), ..window(0.05, f64::INFINITY) };
    world.springs.push(Spring { schedule, ..spring(SpringKind::Linear { a, b }, 0.0, 5.0) });
    let schedule = Schedule { trigger: impact(10.0), ..window(0.0, f64::INFINITY) };
    let never = Constraint { schedule, ..world.constraints[0].clone() };
    world.constraints.push(Constraint { name: "never".into(), ..never });
    let colliders = [0, 1].map(|body| Collider {
        body: Some(body),
        shape: Shape::sphere(DVec3::ZERO, r),
        material: 0,
        node: String::new(),
    });
    let meet = pairs(&colliders, &[], &ReachableVolumes::default()).meet;
    let articulation = Articulation {
        bodies: world.bodies.clone(),
        damping: vec![Damping::default(); 2],
        constraints: &world.constraints,
        limits: &[],
        springs: &world.springs,
        kinematic_bodies: &[],
        colliders: &colliders,
        pairs: meet
            .into_iter()
            .map(|pair| SurfacePair {
                pair,
                restitution: 1.0,
                friction: 0.0,
                full_slip: 0.0,
                resistance: RollingResistance::default(),
            })
            .collect(),
    };
    let mut dynamics = Dynamics::new(articulation, world.settings(Integrator::RungeKutta));
    let (mut hit_at, mut fastest, mut impacts) = (f64::INFINITY, 0.0_f64, Vec::new());
    for index in 0..240 {
        let t = f64::from(index) * DT;
        dynamics.step(DT, &[[0.0; 6]; 2], &mut impacts);
        if let ([impact, ..], true) = (&impacts[..], hit_at.is_infinite()) {
            hit_at = t + impact.time;
        }
        let speed = dynamics.bodies[1].velocity.length();
        if t + DT < hit_at + 0.05 && hit_at.is_finite() {
            fastest = speed;
        }
        if t > hit_at + 0.15 {
            // A dashpot of 5 N s/m stops 0.1 kg in some 20 ms.
            assert!(speed < 0.1 * fastest, "it still runs at {speed} of {fastest} m/s");
            break;
        }
    }
    assert!(fastest > 0.1 && hit_at.is_finite());
    assert_eq!(dynamics.system().activity.activation(2), 0.0, "a light hit fires no heavy trigger");
}

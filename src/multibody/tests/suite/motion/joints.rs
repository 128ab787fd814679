//! Planes, wires, sliders, welds, universal and windmill joints, and joints that follow a function of time.

use soffio_geometry::bodies::MassProperties;
use soffio_math::Function;
use soffio_math::Interpolation;
use soffio_math::{DMat3, DQuat, DVec3, Pose, rotation};
use soffio_multibody::articulation::ConstraintKind;
use soffio_multibody::dynamics::{Integrator, KeyframeMotion, KinematicBody};

use super::{CLOSED, DT, G, INTEGRATORS, ROUNDING, World, accelerated, body, run, step, turning, wheel};

const SECOND: f64 = 1.0;

#[test]
fn a_bead_slides_down_a_plane_with_g_sine() {
    let normal = rotation(DVec3::new(0.3, 0.0, 0.5)) * DVec3::Y;
    for integrator in INTEGRATORS {
        let mut world = World::new(vec![body(0.2, DVec3::splat(1e-4), DVec3::new(0.1, 0.2, 0.3))]);
        world.plane("plane", 0, None, world.bodies[0].position, normal);
        let mut dynamics = world.start(integrator);
        run(&mut dynamics, SECOND, DT);
        let along = DVec3::NEG_Y * G - normal * (DVec3::NEG_Y * G).dot(normal);
        let off = dynamics.bodies[0].position - world.bodies[0].position - 0.5 * along;
        assert!(off.length() < ROUNDING, "{integrator:?}: off by {off}");
        // Its normal force is m g cos.
        let force = dynamics.system().constraint_load(0).force;
        assert!((force - 0.2 * G * normal.y).abs() < ROUNDING);
    }
}

#[test]
fn in_a_lift_that_is_accelerated_a_slope_is_steeper() {
    let (lift, angle) = (2.5, 0.6_f64);
    let normal = DVec3::new(angle.sin(), angle.cos(), 0.0);
    let downhill = DVec3::new(angle.cos(), -angle.sin(), 0.0);
    for integrator in INTEGRATORS {
        let mut world =
            World::new(vec![body(0.2, DVec3::splat(1e-4), DVec3::ZERO), body(1.0, DVec3::ONE, DVec3::ZERO)]);
        world.kinematic_bodies.push(accelerated(1, DVec3::Y * lift));
        world.plane("floor", 0, Some(1), DVec3::ZERO, normal);
        let mut dynamics = world.start(integrator);
        run(&mut dynamics, SECOND, DT);
        let expected = 0.5 * (lift * DVec3::Y + (G + lift) * angle.sin() * downhill);
        let off = dynamics.bodies[0].position - expected;
        assert!(off.length() < ROUNDING, "{integrator:?}: off by {off}");
    }
}

#[test]
fn a_wedge_gives_way_under_its_block() {
    // On a smooth floor the wedge M goes back with m g sin α cos α / (M + m sin² α).
    let (m, heavy, angle) = (0.4, 1.3, 0.5_f64);
    let normal = DVec3::new(angle.sin(), angle.cos(), 0.0);
    for integrator in INTEGRATORS {
        let block = body(m, DVec3::splat(1e-3), DVec3::new(0.1, 0.4, 0.0));
        let mut world = World::new(vec![body(heavy, DVec3::splat(1e-2), DVec3::ZERO), block]);
        world.fix_turn("wedge", 0, None);
        world.plane("wedge/floor", 0, None, DVec3::ZERO, DVec3::Y);
        world.plane("slope", 1, Some(0), world.bodies[1].position, normal);
        let mut dynamics = world.start(integrator);
        run(&mut dynamics, SECOND, DT);
        let expected = -0.5 * m * G * angle.sin() * angle.cos() / (heavy + m * angle.sin() * angle.sin());
        let off = (dynamics.bodies[0].position - DVec3::X * expected).length();
        assert!(off < ROUNDING, "{integrator:?}: {} m against {expected} m", dynamics.bodies[0].position.x);
        assert!(dynamics.joint_error() < CLOSED);
    }
}

#[test]
fn two_planes_are_a_wire_that_a_bead_slides_down() {
    let along = DVec3::new(0.7, -0.4, 0.5).normalize();
    for integrator in INTEGRATORS {
        let mut world = World::new(vec![body(0.2, DVec3::splat(1e-4), DVec3::new(0.1, 0.2, 0.3))]);
        world.wire("wire", 0, None, world.bodies[0].position, along);
        let mut dynamics = world.start(integrator);
        run(&mut dynamics, SECOND, DT);
        let expected = 0.5 * (DVec3::NEG_Y * G).dot(along) * along;
        let off = dynamics.bodies[0].position - world.bodies[0].position - expected;
        assert!(off.length() < ROUNDING, "{integrator:?}: off by {off}");
    }
}

#[test]
fn a_bead_on_a_turning_wire_is_thrown_out_by_the_hyperbolic_cosine() {
    // r̈ = Ω² r; the wire pushes with 2 m Ω ṙ.
    let (omega, start, mass) = (2.0, 0.1, 0.2);
    for integrator in INTEGRATORS {
        let mut bead = body(mass, DVec3::splat(1e-4), DVec3::X * start);
        bead.velocity = DVec3::Z * -omega * start;
        let mut world = World::new(vec![bead, body(1.0, DVec3::ONE, DVec3::ZERO)]);
        world.gravity = DVec3::ZERO;
        world.kinematic_bodies.push(turning(1, DVec3::Y * omega));
        world.wire("wire", 0, Some(1), DVec3::X * start, DVec3::X);
        let mut dynamics = world.start(integrator);
        run(&mut dynamics, SECOND, DT);
        let along = rotation(DVec3::Y * omega * SECOND) * DVec3::X;
        let off = dynamics.bodies[0].position - start * (omega * SECOND).cosh() * along;
        // The motion is no polynomial: the error of fourth order is (Ωh)⁵ a step.
        let allowed = if integrator == Integrator::Precise { ROUNDING } else { 1e-9 };
        assert!(off.length() < allowed, "{integrator:?}: off by {off}");
        let push = dynamics.system().constraint_load(0).force.hypot(dynamics.system().constraint_load(1).force);
        let expected = 2.0 * mass * omega * omega * start * (omega * SECOND).sinh();
        assert!((push - expected).abs() < 10.0 * allowed, "{push} N against {expected} N");
    }
}

#[test]
fn a_weld_makes_one_body_of_two() {
    let orientation = DMat3::from_quat(rotation(DVec3::new(0.2, 0.5, -0.4)));
    let part = |mass, center, moments: DVec3| MassProperties {
        mass,
        center,
        inertia: orientation * DMat3::from_diagonal(moments) * orientation.transpose(),
    };
    let a = part(0.5, DVec3::new(0.1, 0.0, 0.05), DVec3::new(2e-3, 3e-3, 4e-3));
    let b = part(0.8, DVec3::new(-0.15, 0.1, 0.0), DVec3::new(5e-3, 1e-3, 5e-3));
    let spin = DVec3::new(1.0, 4.0, -2.0);
    let make = |properties: MassProperties| {
        let mut body = soffio_geometry::bodies::RigidBody::at_rest(properties, Pose::IDENTITY);
        (body.angular_velocity, body.velocity) = (spin, DVec3::Y * 3.0 + spin.cross(body.position));
        body
    };
    for integrator in INTEGRATORS {
        let mut two = World::new(vec![make(a), make(b)]);
        two.pin("weld", 1, Some(0), DVec3::new(0.05, 0.02, 0.03));
        two.fix_turn("weld", 1, Some(0));
        let one = World::new(vec![make(a.combine(&b))]);
        let (mut two, mut one) = (two.start(integrator), one.start(integrator));
        run(&mut two, 2.0, DT);
        run(&mut one, 2.0, DT);
        let (p, q, r) = (two.bodies[0].pose(), two.bodies[1].pose(), one.bodies[0].pose());
        let corner = DVec3::ONE;
        let (apart, off) = (p.point(corner).distance(q.point(corner)), p.point(corner).distance(r.point(corner)));
        println!("weld, {integrator:?}: off by {off:.1e} m");
        // The one body and the two are both integrated, with a fourth-order error of some 1e-7.
        let allowed = if integrator == Integrator::Precise { 1e-10 } else { 1e-6 };
        assert!(apart < 10.0 * CLOSED && off < allowed, "{integrator:?}: {apart} m apart, {off} m off");
    }
}

#[test]
fn a_universal_joint_turns_its_output_unevenly() {
    // ω₂/ω₁ = cos β / (1 − sin² β cos² φ), φ the angle of the input's pin from the plane of the two axles. The bearings
    // hold the other directions: of the joint itself only the orientation row is new.
    let beta = 0.6_f64;
    let (first, second) = (DVec3::X, DVec3::new(beta.cos(), beta.sin(), 0.0));
    for integrator in INTEGRATORS {
        let shaft = |axle: DVec3, inertia: f64, rate: f64| {
            let mut shaft = body(1.0, DVec3::new(1.0, 0.7, 0.7) * inertia, -0.2 * axle);
            shaft.rotation = DQuat::from_rotation_arc(DVec3::X, axle);
            shaft.angular_velocity = rate * axle;
            shaft
        };
        // The pin begins in the plane of the axles, where the output is fastest.
        let mut world = World::new(vec![shaft(first, 2e-3, 5.0), shaft(second, 5e-4, 5.0 / beta.cos())]);
        world.gravity = DVec3::ZERO;
        world.hinge("input", 0, None, DVec3::ZERO, first);
        world.hinge("output", 1, None, DVec3::ZERO, second);
        world.across("cross", 0, DVec3::Y, Some(1), DVec3::Z);
        let mut dynamics = world.start(integrator);
        let energy = dynamics.energy();
        let no_wrenches = [[0.0; 6]; 2];
        let (mut slowest, mut fastest) = (f64::INFINITY, 0.0_f64);
        for _ in 0..480 {
            step(&mut dynamics, DT, &no_wrenches);
            let [input, output] = [dynamics.bodies[0], dynamics.bodies[1]];
            let pin = input.rotation * DVec3::Y;
            let phi = pin.z.atan2(pin.y);
            let expected = beta.cos() / (1.0 - (beta.sin() * phi.cos()) * (beta.sin() * phi.cos()));
            let found = output.angular_velocity.dot(second) / input.angular_velocity.dot(first);
            assert!((found - expected).abs() < ROUNDING, "{integrator:?}: ratio {found} against {expected}");
            (slowest, fastest) = (slowest.min(found), fastest.max(found));
        }
        assert!(slowest < 1.001 * beta.cos() && fastest > 0.999 / beta.cos());
        let lost = (dynamics.energy() / energy - 1.0).abs();
        println!("universal joint, {integrator:?}: energy off by {lost:.1e}");
        let allowed = if integrator == Integrator::Precise { 1e-10 } else { 1e-6 };
        assert!(lost < allowed, "{integrator:?}: energy off by {lost:e}");
    }
}

#[test]
fn a_windmill_keeps_its_spin_while_its_mast_turns_it() {
    // Only torque about the axle changes the spin of the sails. Turning the mast takes the gyroscopic torque I Ω ω.
    let (spin, yaw, inertia) = (12.0, 1.5, 2e-3);
    for integrator in INTEGRATORS {
        let hub = DVec3::new(0.0, 1.0, 0.2);
        let mut sails = wheel(0.3, inertia, hub);
        let mast = DVec3::Y * yaw;
        sails.angular_velocity = DVec3::Z * spin + mast;
        sails.velocity = mast.cross(hub);
        let mut world = World::new(vec![sails, body(1.0, DVec3::ONE, DVec3::ZERO)]);
        world.kinematic_bodies.push(turning(1, mast));
        world.pin("windmill/nail", 0, Some(1), hub);
        world.across("windmill/across-1", 0, DVec3::Z, Some(1), DVec3::X);
        world.across("windmill/across-2", 0, DVec3::Z, Some(1), DVec3::Y);
        let mut dynamics = world.start(integrator);
        let no_wrenches = [[0.0; 6]; 2];
        let mut turned = 0.0;
        // The directions of the torque rotate with the mast: the error of fourth order is (Ωh)⁵ a step.
        let allowed = if integrator == Integrator::Precise { ROUNDING } else { 1e-8 };
        for _ in 0..480 {
            step(&mut dynamics, DT, &no_wrenches);
            turned += yaw * DT;
            let axle = rotation(DVec3::Y * turned) * DVec3::Z;
            let sails = &dynamics.bodies[0];
            assert!((sails.rotation * DVec3::Z).distance(axle) < ROUNDING);
            assert!((sails.angular_velocity.dot(axle) - spin).abs() < allowed);
            let torque = dynamics.system().constraint_load(1).torque.hypot(dynamics.system().constraint_load(2).torque);
            assert!((torque - inertia * spin * yaw).abs() < allowed, "{torque} N m");
        }
        // Now the mast is stopped, and a wind pushes and tilts it as well.
        world.kinematic_bodies[0].motion =
            KeyframeMotion { keys: vec![(0.0, Pose::IDENTITY)], interpolation: Interpolation::Step, repeat: false };
        world.bodies[0].angular_velocity = DVec3::ZERO;
        world.bodies[0].velocity = DVec3::ZERO;
        let mut dynamics = world.start(integrator);
        for _ in 0..240 {
            step(&mut dynamics, DT, &[[0.3, -0.2, 1.0, 0.4, -0.5, 0.01], [0.0; 6]]);
        }
        let rate = dynamics.bodies[0].angular_velocity;
        assert!((rate - DVec3::Z * 0.01 / inertia).length() < ROUNDING, "{rate} rad/s");
    }
}

#[test]
fn bodies_follow_a_function_and_bear_its_acceleration() {
    let wave = Function::Wave { mean: 0.1, amplitude: 0.4, period: 0.9, phase: 0.3 };
    let keys = vec![(0.0, 0.0), (0.5, 0.3), (1.1, -0.2), (1.6, 0.1), (3.0, 0.0)];
    let spline = Function::Keys { keys, interpolation: Interpolation::Spline, repeat: false };
    let inertia = 2e-3;
    for (integrator, function) in INTEGRATORS.into_iter().flat_map(|i| [(i, &wave), (i, &spline)]) {
        let start = function.at(0.0);
        // A wheel whose mark is held at f(t) above the horizon, and a stone held at the height f(t).
        let mut wheel = wheel(0.3, inertia, DVec3::ZERO);
        wheel.rotation = rotation(DVec3::Z * start.value);
        wheel.angular_velocity = DVec3::Z * start.rate;
        let mut stone = body(0.5, DVec3::ONE, DVec3::new(1.0, start.value, 0.0));
        stone.velocity = DVec3::new(0.2, start.rate, 0.0);
        let mut world = World::new(vec![wheel, stone]);
        world.hinge("axle", 0, None, DVec3::ZERO, DVec3::Z);
        let mark = soffio_multibody::articulation::Axis { body: Some(0), direction: DVec3::X };
        let kind = ConstraintKind::Orientation { a: mark, b: world.axis(None, DVec3::Y), angle: function.clone() };
        world.add("hand", kind);
        let kind = ConstraintKind::PointOnPlane {
            point: world.anchor(Some(1), stone.position),
            plane: world.anchor(None, DVec3::ZERO),
            normal: DVec3::Y,
            offset: function.clone(),
        };
        world.add("height", kind);
        let mut dynamics = world.start(integrator);
        let no_wrenches = [[0.0; 6]; 2];
        for index in 0..480 {
            step(&mut dynamics, DT, &no_wrenches);
            let now = function.at(f64::from(index + 1) * DT);
            let (wheel, stone) = (&dynamics.bodies[0], &dynamics.bodies[1]);
            let mark = wheel.rotation * DVec3::X;
            let off = [
                mark.y.atan2(mark.x) - now.value,
                wheel.angular_velocity.z - now.rate,
                stone.position.y - now.value,
                stone.velocity.y - now.rate,
                stone.velocity.x - 0.2,
                dynamics.system().constraint_load(3).torque - (inertia * now.acceleration).abs(),
                dynamics.system().constraint_load(4).force - (0.5 * (now.acceleration + G)).abs(),
            ];
            assert!(off.iter().all(|x| x.abs() < ROUNDING), "{integrator:?}, step {index}: {off:?}");
        }
    }
}

#[test]
fn bodies_are_where_their_keys_say_and_hanging_bodies_feel_it() {
    // A table that is lifted, turned and shaken, with a block welded to its corner.
    let keys: Vec<(f64, Pose)> = (0..7)
        .map(|i| {
            let t = 0.5 * f64::from(i);
            let orientation = rotation(DVec3::new(0.3 * t, (2.0 * t).sin(), 0.5));
            (t, Pose { rotation: orientation, position: DVec3::new(t.sin(), 0.2 * t * t, (3.0 * t).cos()) })
        })
        .collect();
    for (integrator, interpolation) in
        INTEGRATORS.into_iter().flat_map(|i| [(i, Interpolation::Smooth), (i, Interpolation::Spline)])
    {
        let motion = KeyframeMotion { keys: keys.clone(), interpolation, repeat: false };
        let start = motion.at(0.0).pose;
        let mut block = body(0.2, DVec3::new(1e-4, 2e-4, 3e-4), start.point(DVec3::new(0.3, 0.1, -0.2)));
        block.rotation = start.rotation;
        let mut world = World::new(vec![block, body(2.0, DVec3::ONE, DVec3::ZERO)]);
        (world.bodies[1].position, world.bodies[1].rotation) = (start.position, start.rotation);
        world.pin("weld", 0, Some(1), block.position);
        world.fix_turn("weld", 0, Some(1));
        world.kinematic_bodies.push(KinematicBody { body: 1, motion: motion.clone() });
        let mut dynamics = world.start(integrator);
        let no_wrenches = [[0.0; 6]; 2];
        for index in 0..690 {
            step(&mut dynamics, DT, &no_wrenches);
            let now = motion.at(f64::from(index + 1) * DT);
            let arm = now.pose.vector(DVec3::new(0.3, 0.1, -0.2));
            let block = &dynamics.bodies[0];
            assert!(dynamics.bodies[1].pose().point(DVec3::ONE).distance(now.pose.point(DVec3::ONE)) < CLOSED);
            assert!(block.position.distance(now.pose.position + arm) < 10.0 * CLOSED);
            assert!(block.velocity.distance(now.velocity + now.angular_velocity.cross(arm)) < ROUNDING);
            let spin = now.angular_velocity;
            let lift = now.acceleration + now.angular_acceleration.cross(arm) + spin.cross(spin.cross(arm));
            let expected = 0.2 * (lift + DVec3::Y * G).length();
            let found = dynamics.system().constraint_load(0).force;
            assert!((found - expected).abs() < 10.0 * ROUNDING, "{found} N against {expected} N");
        }
    }
}

//! Wheels with tyres against the brush model and the geometry of steering.
//!
//! Symbols: r radius of a wheel, α slip angle, s₁ slip from which a tyre slides entirely, L wheelbase, δ steering angle, R radius
//! of the circle of the rear axle's middle.

use super::*;

/// Radius of a wheel and half the width of its tyre, m.
const R: f64 = 0.03;
const HALF_WIDTH: f64 = 4e-3;
/// Friction, and the slip from which a tyre slides entirely.
const MU: f64 = 0.5;
const FULL_SLIP: f64 = 0.2;
/// Distance from the front to the rear axle, and half of that between the rear wheels, m.
const WHEELBASE: f64 = 0.2;
const HALF_TRACK: f64 = 0.1;

fn tyre(body: usize) -> Collider {
    let side = HALF_WIDTH * DVec3::Z;
    collider(Some(body), Shape::cylinder(-side, side, R, HALF_WIDTH))
}

/// A thin disc that rolls towards +x at `speed`.
fn wheel(mass: f64, position: DVec3, speed: f64) -> RigidBody {
    let mut wheel = body(mass, DVec3::new(0.25, 0.25, 0.5) * mass * R * R, position);
    (wheel.velocity.x, wheel.angular_velocity.z) = (speed, -speed / R);
    wheel
}

/// Keeps the axle of a wheel along Z rotated by `angle` about Y, in the frame of `carrier`.
fn axle(wheel: usize, carrier: Option<usize>, angle: f64) -> Vec<Constraint> {
    let axis = |body, direction| Axis { body, direction };
    let across = |n: DVec3| ConstraintKind::Orientation {
        a: axis(Some(wheel), DVec3::Z),
        b: axis(carrier, rotation(DVec3::Y * angle) * n),
        angle: 0.0.into(),
    };
    [DVec3::X, DVec3::Y].map(|n| Constraint::new("axle", across(n))).to_vec()
}

/// Force of a free wheel across its own plane, and along it, over its weight, and its mean slip meanwhile.
fn forces_at(slip_angle: f64) -> (f64, f64, f64) {
    let speed = 5.0;
    let mut rolling = wheel(1.0, DVec3::Y * R, speed);
    let turned = rotation(DVec3::Y * slip_angle);
    rolling.rotation = turned;
    rolling.angular_velocity = turned * (DVec3::NEG_Z * speed * slip_angle.cos() / R);
    let mut scene = Scene::new(vec![rolling], vec![tyre(0), floor()]);
    (scene.friction, scene.full_slip) = (MU, FULL_SLIP);
    scene.constraints = axle(0, None, slip_angle);
    let mut dynamics = scene.dynamics();
    run(&mut dynamics, 2.0 * DT);
    let before = dynamics.bodies[0].velocity;
    run(&mut dynamics, DT);
    let after = dynamics.bodies[0].velocity;
    let [across, along] = [DVec3::Z, DVec3::X].map(|axis| turned * axis);
    let acceleration = (after - before) / DT;
    let mean = 0.5 * (before + after);
    (acceleration.dot(across) / G, acceleration.dot(along) / G, mean.dot(across).abs() / mean.dot(along))
}

#[test]
fn the_side_force_grows_with_the_slip_angle_and_saturates() {
    // The force over a step is that at its end, when the slip is less by up to 5 % of full slip's than in the mean.
    const RATE: f64 = 0.03;
    let mut last = 0.0;
    for slip in [0.02f64, 0.05, 0.1, 0.15, 0.19, 0.25, 0.5, 1.0] {
        let (across, along, slip) = forces_at(slip.atan());
        let left = (1.0 - slip / FULL_SLIP).max(0.0);
        let expected = MU * (1.0 - left * left * left);
        println!("slip {slip:.4}: {across:.4} of the weight, {expected:.4} by the brush model, {along:.1e} along");
        assert!(
            (across.abs() / expected - 1.0).abs() < RATE,
            "{across} against {expected} of the weight at slip {slip}"
        );
        assert!(across.abs() > last * (1.0 - RATE), "less than at a smaller slip: {across}");
        assert!(along.abs() < RATE * across.abs(), "a free wheel is not braked: {along} at slip {slip}");
        last = across.abs();
    }
}

#[test]
fn a_wheel_rolls_straight_without_slip_or_loss() {
    const SLIP: f64 = 1e-4;
    let mut scene = Scene::new(vec![wheel(0.1, DVec3::Y * R, 1.0)], vec![tyre(0), floor()]);
    (scene.friction, scene.full_slip) = (MU, FULL_SLIP);
    scene.constraints = axle(0, None, 0.0);
    let mut dynamics = scene.dynamics();
    run(&mut dynamics, 0.5);
    let before = dynamics.energy();
    run(&mut dynamics, 2.0);
    let now = dynamics.bodies[0];
    assert!((now.velocity.x + R * now.angular_velocity.z).abs() < SLIP * now.velocity.x, "slips: {now:?}");
    assert!((dynamics.energy() / before - 1.0).abs() < 1e-6, "{} of {before} J", dynamics.energy());
    // Brought to the floor without spin, friction spins it up until it rolls.
    let mut scene = Scene::new(vec![wheel(0.1, DVec3::Y * R, 1.0)], vec![tyre(0), floor()]);
    scene.bodies[0].angular_velocity = DVec3::ZERO;
    (scene.friction, scene.full_slip) = (MU, FULL_SLIP);
    scene.constraints = axle(0, None, 0.0);
    let mut dynamics = scene.dynamics();
    run(&mut dynamics, 1.0);
    let now = dynamics.bodies[0];
    // Friction does not change m v r + I ω: v = v₀/(1 + 1/2).
    assert!((now.velocity.x - 2.0 / 3.0).abs() < 1e-3, "{} m/s", now.velocity.x);
    assert!((now.velocity.x + R * now.angular_velocity.z).abs() < SLIP, "slips: {now:?}");
}

#[test]
fn a_standing_tyre_holds_on_a_slope() {
    let mut scene = Scene::new(vec![wheel(0.1, DVec3::Y * R, 0.0)], vec![tyre(0), floor()]);
    // The slope falls along the axle.
    scene.gravity = rotation(DVec3::X * -0.3) * DVec3::new(0.0, -G, 0.0);
    (scene.friction, scene.full_slip, scene.restitution) = (MU, FULL_SLIP, 0.0);
    scene.constraints = axle(0, None, 0.0);
    let mut dynamics = scene.dynamics();
    run(&mut dynamics, 0.5);
    assert_stays(&mut dynamics, 10.0);
}

/// A tricycle with its front wheel turned by `steering`, that rolls towards +x at `speed`: chassis, two rear wheels, front wheel.
fn tricycle(steering: f64, speed: f64) -> Dynamics {
    let wheel_mass = 0.01;
    let mut chassis = body(0.5, DVec3::new(8e-4, 3e-3, 2.4e-3), DVec3::new(0.4 * WHEELBASE, R, 0.0));
    chassis.velocity.x = speed;
    let places = [-HALF_TRACK, HALF_TRACK].map(|z| DVec3::new(0.0, R, z));
    let front = DVec3::new(WHEELBASE, R, 0.0);
    let bodies = vec![
        chassis,
        wheel(wheel_mass, places[0], speed),
        wheel(wheel_mass, places[1], speed),
        wheel(wheel_mass, front, speed),
    ];
    let mut scene = Scene::new(bodies, vec![tyre(1), tyre(2), tyre(3), floor()]);
    (scene.friction, scene.full_slip, scene.restitution) = (MU, FULL_SLIP, 0.0);
    let turned = rotation(DVec3::Y * steering);
    scene.bodies[3].rotation = turned;
    scene.bodies[3].angular_velocity = turned * (DVec3::NEG_Z * speed * steering.cos() / R);
    for (index, angle) in [(1, 0.0), (2, 0.0), (3, steering)] {
        let at = scene.bodies[index].position - chassis.position;
        let point = ConstraintKind::PointToPoint { a: anchor(Some(index), DVec3::ZERO), b: anchor(Some(0), at) };
        scene.constraints.push(Constraint::new("hub", point));
        scene.constraints.extend(axle(index, Some(0), angle));
    }
    scene.dynamics()
}

/// Velocity of the middle of the tricycle's rear axle, m/s.
fn rear_velocity(dynamics: &Dynamics) -> DVec3 {
    let chassis = &dynamics.bodies[0];
    chassis.velocity_at(chassis.position + chassis.rotation * (-0.4 * WHEELBASE * DVec3::X))
}

/// Radius of the circle on which the rear axle's middle moves, m.
fn circle(dynamics: &Dynamics) -> f64 {
    rear_velocity(dynamics).length() / dynamics.bodies[0].angular_velocity.y.abs()
}

#[test]
fn slow_wheels_roll_on_the_circle_of_their_steering() {
    // Side forces of a hundredth of the most turn the tyres' ways by s₁/300, against δ.
    const CIRCLE: f64 = 0.01;
    for steering in [0.1f64, 0.25, 0.5] {
        let expected = WHEELBASE / steering.tan();
        let mut dynamics = tricycle(steering, (0.01 * MU * G * expected).sqrt());
        run(&mut dynamics, 1.0);
        let found = circle(&dynamics);
        assert!((found / expected - 1.0).abs() < CIRCLE, "{found} m against {expected} m at {steering} rad");
        assert!(dynamics.joint_error() < 1e-9);
    }
}

/// Largest slip of the tricycle's wheels: across over along, of the rear axle and of the front wheel.
fn largest_slip(dynamics: &Dynamics, steering: f64) -> f64 {
    let heading = dynamics.bodies[0].rotation;
    let slip = |velocity: DVec3, along: DVec3| {
        let across = DVec3::Y.cross(along);
        (velocity.dot(across) / velocity.dot(along)).abs()
    };
    let front = heading * (rotation(DVec3::Y * steering) * DVec3::X);
    slip(rear_velocity(dynamics), heading * DVec3::X).max(slip(dynamics.bodies[3].velocity, front))
}

/// Velocity of the whole tricycle's centre of mass, m/s.
fn center_velocity(dynamics: &Dynamics) -> DVec3 {
    let mass: f64 = dynamics.bodies.iter().map(|body| body.properties.mass).sum();
    dynamics.bodies.iter().map(|body| body.properties.mass * body.velocity).sum::<DVec3>() / mass
}

#[test]
fn a_fast_tricycle_drifts_and_friction_brings_it_back_to_the_circle() {
    /// Of the friction that its weight allows: its wheels' load changes as it leans.
    const LOAD: f64 = 0.1;
    let steering = 0.4f64;
    let ideal = WHEELBASE / steering.tan();
    // At a third of the most side force the brush slips by 1 − (1 − 1/3)^(1/3) = 13 % of s₁, front and rear alike.
    let mut slow = tricycle(steering, (0.33 * MU * G * ideal).sqrt());
    run(&mut slow, 0.5);
    let (ratio, slip) = (circle(&slow) / ideal, largest_slip(&slow, steering));
    assert!((ratio - 1.0).abs() < 0.15, "{ratio} of the circle");
    assert!(slip < 0.5 * FULL_SLIP, "it slips by {slip}");
    // At three times the most, no tyre can follow.
    let mut fast = tricycle(steering, (3.0 * MU * G * ideal).sqrt());
    let (mut widest, mut hardest): (f64, f64) = (0.0, 0.0);
    for step in 0..48 {
        let before = center_velocity(&fast);
        run(&mut fast, DT);
        hardest = hardest.max(((center_velocity(&fast) - before) / DT).with_y(0.0).length());
        // At the start the front wheel rolls aslant in any case.
        if step >= 24 {
            widest = widest.max(largest_slip(&fast, steering));
        }
    }
    println!("slip {slip:.3} at a third of the most, {widest:.2} at three times; {hardest:.2} m/s²");
    assert!(widest > FULL_SLIP, "its tyres hold at a slip of {widest}");
    assert!(hardest < (1.0 + LOAD) * MU * G, "{hardest} m/s² of {}", MU * G);
    // Friction slows it down until its tyres hold it on the circle.
    run(&mut fast, 4.0);
    let caught = circle(&fast) / ideal;
    assert!((caught - 1.0).abs() < 0.15, "{caught} of the circle at {} m/s", rear_velocity(&fast).length());
}

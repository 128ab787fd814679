//! Slip clutches: what they carry, what they carry while they slip, and where they hold again.

use soffio_math::{DVec3, atan2, exp};
use soffio_multibody::articulation::{Axis, Constraint, ConstraintKind, Limit, LimitKind, Measure, Term};
use soffio_multibody::dynamics::forces::Damping;
use soffio_multibody::dynamics::{Articulation, Dynamics, Integrator};

use super::{DT, ROUNDING, World, step, wheel};

/// Moments of inertia of the two discs, kg m², and the clutch's torque, N m.
const I: [f64; 2] = [3e-2, 8e-2];
const TORQUE: f64 = 0.01;
/// Slipping so fast it carries twice that, rad/s, and what its friction at the end of a substep leaves of a rate, as a share.
const GREASE: f64 = 0.5;
const FIRST_ORDER: f64 = 5e-3;

/// What the clutch takes from the rate of slipping for a unit of it, 1/s: c (1/I₁ + 1/I₂).
fn damping() -> f64 {
    TORQUE / GREASE * (I[0].recip() + I[1].recip())
}

/// Two discs on one axle, the first held on the second by a clutch.
fn discs(integrator: Integrator) -> Dynamics {
    on_one_axle(I).start(integrator)
}

/// The same with these moments of inertia.
fn on_one_axle(inertia: [f64; 2]) -> World {
    let bodies = [0, 1].map(|disc| wheel(0.2, inertia[disc], DVec3::Z * (0.1 * disc as f64)));
    let mut world = World::new(bodies.to_vec());
    world.gravity = DVec3::ZERO;
    for i in 0..2 {
        world.hinge(&format!("axle-{i}"), i, None, world.bodies[i].position, DVec3::Z);
    }
    let measure = Measure::Angle { axis: Axis { body: Some(0), direction: DVec3::Z }, frame: Some(1) };
    let kind = ConstraintKind::Coupling { terms: vec![Term { measure, coefficient: 1.0 }] };
    world.constraints.push(Constraint { slips: Some(TORQUE), ..Constraint::new("clutch", kind) });
    world
}

/// Rates after so many steps under a torque on the first disc, rad/s.
fn turn(dynamics: &mut Dynamics, torque: f64, steps: usize) -> [f64; 2] {
    for _ in 0..steps {
        step(dynamics, DT, &[[0.0, 0.0, 0.0, 0.0, 0.0, torque], [0.0; 6]]);
    }
    [0, 1].map(|disc| dynamics.bodies[disc].angular_velocity.z)
}

/// How far the first disc is turned against the second, rad.
fn apart(dynamics: &Dynamics) -> f64 {
    let [a, b] = [0, 1].map(|disc| dynamics.bodies[disc].rotation);
    let d = b.conjugate() * a;
    2.0 * atan2(d.z, d.w)
}

#[test]
fn below_its_torque_two_discs_are_one_and_above_it_each_goes_its_own_way() {
    for integrator in [Integrator::RungeKutta, Integrator::Fast] {
        // Held, the second disc asks for T I₂/(I₁ + I₂) through the clutch.
        let most = TORQUE * (I[0] + I[1]) / I[1];
        let mut held = discs(integrator);
        for rate in turn(&mut held, 0.99 * most, 240) {
            assert!((rate - 0.99 * most / (I[0] + I[1])).abs() < ROUNDING, "{rate} rad/s");
        }
        assert!(apart(&held).abs() < ROUNDING);
        // Relative rate: q̈ = T/I₁ − (τ + c q̇)(1/I₁ + 1/I₂).
        let mut slips = discs(integrator);
        let torque = 1.5 * most;
        turn(&mut slips, torque, 1);
        let [first, second] = turn(&mut slips, torque, 480);
        let fastest = GREASE * (torque / most - 1.0);
        let expected = fastest * (1.0 - exp(-damping() * 480.0 * DT));
        assert!((first - second - expected).abs() < FIRST_ORDER * fastest, "{} rad/s, not {expected}", first - second);
        let momentum = I[0] * first + I[1] * second;
        assert!((momentum - torque * 481.0 * DT).abs() < ROUNDING, "what is pushed in is there");
    }
}

#[test]
fn what_slips_comes_to_rest_when_friction_has_used_up_its_rate_and_is_held_there() {
    /// Held from one step to the next, s.
    const LATE: f64 = 2.0 * DT;
    let (torque, push) = (4.0 * TORQUE, 480);
    let mut dynamics = discs(Integrator::RungeKutta);
    let [first, second] = turn(&mut dynamics, torque, push);
    let stops = libm::log(1.0 + (first - second) / GREASE) / damping();
    let mut waited = 0.0;
    while dynamics.bodies[0].angular_velocity.z - dynamics.bodies[1].angular_velocity.z > ROUNDING {
        turn(&mut dynamics, 0.0, 1);
        waited += DT;
        assert!(waited < 2.0 * stops, "it still slips after {waited} s");
    }
    assert!((waited - stops).abs() < LATE, "at rest after {waited} s, by its friction after {stops} s");
    // What was pushed in is there, shared by both.
    let [first, second] = turn(&mut dynamics, 0.0, 1);
    let momentum = torque * push as f64 * DT;
    assert!((first - second).abs() < ROUNDING);
    assert!((I[0] * first + I[1] * second - momentum).abs() < ROUNDING, "{first} rad/s");
    let there = apart(&dynamics);
    turn(&mut dynamics, 0.5 * TORQUE, 240);
    assert!((apart(&dynamics) - there).abs() < ROUNDING, "it is held where it came to rest");
    assert!(dynamics.joint_error() < ROUNDING);
}

#[test]
fn a_light_disc_at_its_stop_feels_no_more_than_the_clutch_carries() {
    /// Ten thousand times lighter than the other, kg m².
    const LIGHT: f64 = 8e-6;
    /// What rests lies in the touching layer, rad.
    const LAYER: f64 = 2e-6;
    let world = on_one_axle([LIGHT, I[1]]);
    let measure = Measure::Angle { axis: Axis { body: Some(0), direction: DVec3::Z }, frame: None };
    let kind = LimitKind::Range { measure, min: f64::NEG_INFINITY, max: 0.0 };
    let limit = Limit { name: "stop".to_owned(), kind, restitution: 0.0 };
    for integrator in [Integrator::RungeKutta, Integrator::Fast] {
        let figure = Articulation {
            bodies: world.bodies.clone(),
            damping: vec![Damping::default(); 2],
            constraints: &world.constraints,
            limits: std::slice::from_ref(&limit),
            springs: &[],
            kinematic_bodies: &[],
            colliders: &[],
            pairs: Vec::new(),
        };
        let mut dynamics = Dynamics::new(figure, world.settings(integrator));
        let (torque, damping) = (3.0 * TORQUE, TORQUE / GREASE / I[1]);
        for count in 1..=480 {
            step(&mut dynamics, DT, &[[0.0; 6], [0.0, 0.0, 0.0, 0.0, 0.0, torque]]);
            let turned = dynamics.bodies[0].rotation;
            assert!(2.0 * atan2(turned.z, turned.w).abs() < LAYER, "the stop gives way by {turned} in step {count}");
        }
        let fastest = GREASE * (torque / TORQUE - 1.0);
        let expected = fastest * (1.0 - exp(-damping * 480.0 * DT));
        let rate = dynamics.bodies[1].angular_velocity.z;
        assert!((rate - expected).abs() < FIRST_ORDER * fastest, "{rate} rad/s, not {expected}");
    }
}

//! Slip clutches: their torque while they stick and while they slip, and where they stick again.

use soffio_math::{DVec3, atan2, exp};
use soffio_multibody::articulation::{Axis, Constraint, ConstraintKind, Limit, LimitKind, Measure, Term};
use soffio_multibody::dynamics::forces::Damping;
use soffio_multibody::dynamics::{Articulation, Dynamics, Integrator};

use super::{DT, ROUNDING, World, step, wheel};

/// Moments of inertia of the two discs, kg m², and the clutch's torque, N m.
const I: [f64; 2] = [3e-2, 8e-2];
const TORQUE: f64 = 0.01;
/// At this rate of slip it carries twice that, rad/s.
const VISCOUS_SLIP: f64 = 0.5;
/// Relative error of a rate by friction at the end of each substep.
const FIRST_ORDER: f64 = 5e-3;

/// Damping rate of the slip, 1/s: c (1/I₁ + 1/I₂).
fn damping() -> f64 {
    TORQUE / VISCOUS_SLIP * (I[0].recip() + I[1].recip())
}

/// Two discs on one axle with a clutch between them.
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
fn rates_after(dynamics: &mut Dynamics, torque: f64, steps: usize) -> [f64; 2] {
    for _ in 0..steps {
        step(dynamics, DT, &[[0.0, 0.0, 0.0, 0.0, 0.0, torque], [0.0; 6]]);
    }
    [0, 1].map(|disc| dynamics.bodies[disc].angular_velocity.z)
}

/// Angle of the first disc relative to the second, rad.
fn relative_angle(dynamics: &Dynamics) -> f64 {
    let [a, b] = [0, 1].map(|disc| dynamics.bodies[disc].rotation);
    let d = b.conjugate() * a;
    2.0 * atan2(d.z, d.w)
}

#[test]
fn below_its_torque_two_discs_are_one_and_above_it_each_goes_its_own_way() {
    for integrator in [Integrator::RungeKutta, Integrator::Fast] {
        // Sticking, the clutch carries T I₂/(I₁ + I₂).
        let most = TORQUE * (I[0] + I[1]) / I[1];
        let mut sticking = discs(integrator);
        for rate in rates_after(&mut sticking, 0.99 * most, 240) {
            assert!((rate - 0.99 * most / (I[0] + I[1])).abs() < ROUNDING, "{rate} rad/s");
        }
        assert!(relative_angle(&sticking).abs() < ROUNDING);
        // Relative rate: q̈ = T/I₁ − (τ + c q̇)(1/I₁ + 1/I₂).
        let mut slips = discs(integrator);
        let torque = 1.5 * most;
        rates_after(&mut slips, torque, 1);
        let [first, second] = rates_after(&mut slips, torque, 480);
        let fastest = VISCOUS_SLIP * (torque / most - 1.0);
        let expected = fastest * (1.0 - exp(-damping() * 480.0 * DT));
        assert!((first - second - expected).abs() < FIRST_ORDER * fastest, "{} rad/s, not {expected}", first - second);
        let momentum = I[0] * first + I[1] * second;
        assert!((momentum - torque * 481.0 * DT).abs() < ROUNDING, "angular momentum is the torque's impulse");
    }
}

#[test]
fn a_slipping_clutch_comes_to_rest_by_its_friction_and_sticks_there() {
    /// It sticks from one step to the next, s.
    const LATE: f64 = 2.0 * DT;
    let (torque, push) = (4.0 * TORQUE, 480);
    let mut dynamics = discs(Integrator::RungeKutta);
    let [first, second] = rates_after(&mut dynamics, torque, push);
    let stops = libm::log(1.0 + (first - second) / VISCOUS_SLIP) / damping();
    let mut waited = 0.0;
    while dynamics.bodies[0].angular_velocity.z - dynamics.bodies[1].angular_velocity.z > ROUNDING {
        rates_after(&mut dynamics, 0.0, 1);
        waited += DT;
        assert!(waited < 2.0 * stops, "it still slips after {waited} s");
    }
    assert!((waited - stops).abs() < LATE, "at rest after {waited} s, by its friction after {stops} s");
    // The torque's impulse is shared by both.
    let [first, second] = rates_after(&mut dynamics, 0.0, 1);
    let momentum = torque * push as f64 * DT;
    assert!((first - second).abs() < ROUNDING);
    assert!((I[0] * first + I[1] * second - momentum).abs() < ROUNDING, "{first} rad/s");
    let there = relative_angle(&dynamics);
    rates_after(&mut dynamics, 0.5 * TORQUE, 240);
    assert!((relative_angle(&dynamics) - there).abs() < ROUNDING, "it sticks where it came to rest");
    assert!(dynamics.joint_error() < ROUNDING);
}

#[test]
fn a_light_disc_at_its_stop_feels_no_more_than_the_clutch_carries() {
    /// Ten thousand times lighter than the other, kg m².
    const LIGHT: f64 = 8e-6;
    /// Resting contacts lie in the contact layer, rad.
    const LAYER: f64 = 2e-6;
    let world = on_one_axle([LIGHT, I[1]]);
    let measure = Measure::Angle { axis: Axis { body: Some(0), direction: DVec3::Z }, frame: None };
    let kind = LimitKind::Range { measure, min: f64::NEG_INFINITY, max: 0.0 };
    let limit = Limit { name: "stop".to_owned(), kind, restitution: 0.0 };
    for integrator in [Integrator::RungeKutta, Integrator::Fast] {
        let articulation = Articulation {
            bodies: world.bodies.clone(),
            damping: vec![Damping::default(); 2],
            constraints: &world.constraints,
            limits: std::slice::from_ref(&limit),
            springs: &[],
            kinematic_bodies: &[],
            colliders: &[],
            pairs: Vec::new(),
        };
        let mut dynamics = Dynamics::new(articulation, world.settings(integrator));
        let (torque, damping) = (3.0 * TORQUE, TORQUE / VISCOUS_SLIP / I[1]);
        for count in 1..=480 {
            step(&mut dynamics, DT, &[[0.0; 6], [0.0, 0.0, 0.0, 0.0, 0.0, torque]]);
            let turned = dynamics.bodies[0].rotation;
            assert!(2.0 * atan2(turned.z, turned.w).abs() < LAYER, "the stop yields by {turned} in step {count}");
        }
        let fastest = VISCOUS_SLIP * (torque / TORQUE - 1.0);
        let expected = fastest * (1.0 - exp(-damping * 480.0 * DT));
        let rate = dynamics.bodies[1].angular_velocity.z;
        assert!((rate - expected).abs() < FIRST_ORDER * fastest, "{rate} rad/s, not {expected}");
    }
}

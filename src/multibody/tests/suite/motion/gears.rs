//! Gears, drums, racks and pulleys against their formulas; phases over many turns.

use soffio_geometry::bodies::RigidBody;
use soffio_math::spatial::matrix;
use soffio_math::{DVec3, PI, rotation};
use soffio_multibody::articulation::rows::BodyStates;
use soffio_multibody::articulation::rows::coupling::{self, Gauge};
use soffio_multibody::articulation::{ConstraintKind, Measure, Term};
use soffio_multibody::dynamics::{Dynamics, Integrator};

use super::{CLOSED, DT, G, INTEGRATORS, ROUNDING, World, body, elliptic_period, period, run, step, wheel};

/// Phase error of gears by tooth numbers: tooth number times the rounding of an angle below half a turn.
const PHASE: f64 = 1e-13;

impl World {
    /// Σ coefficient · angle about z of (body, frame) is constant.
    fn couple(&mut self, name: &str, terms: &[(Option<usize>, Option<usize>, f64)]) {
        let term = |&(body, frame, coefficient): &(Option<usize>, Option<usize>, f64)| Term {
            measure: Measure::Angle { axis: self.axis(body, DVec3::Z), frame },
            coefficient,
        };
        let terms = terms.iter().map(term).collect();
        self.add(name, ConstraintKind::Coupling { terms });
    }

    fn displacement(&self, body: usize, direction: DVec3) -> Measure {
        let point = self.anchor(Some(body), self.bodies[body].position);
        Measure::Displacement { point, direction: self.axis(None, direction) }
    }
}

/// Wheels on axles along z in the world, at these places.
fn wheels(inertias: &[f64]) -> World {
    let bodies = inertias.iter().enumerate().map(|(i, j)| wheel(0.2, *j, DVec3::X * 0.3 * i as f64)).collect();
    let mut world = World::new(bodies);
    for i in 0..inertias.len() {
        world.hinge(&format!("axle-{i}"), i, None, world.bodies[i].position, DVec3::Z);
    }
    world
}

fn torque_about_z(torque: f64) -> [f64; 6] {
    [0.0, 0.0, 0.0, 0.0, 0.0, torque]
}

#[test]
fn a_pair_of_gears_shares_a_torque_by_its_ratio() {
    // α₁ = τ/(J₁ + J₂ (r₁/r₂)²)
    let (r1, r2, j1, j2, torque) = (0.05, 0.12, 2e-3, 7e-3, 0.02);
    for integrator in INTEGRATORS {
        let mut world = wheels(&[j1, j2]);
        world.couple("gears", &[(Some(0), None, r1), (Some(1), None, r2)]);
        let mut dynamics = world.start(integrator);
        for _ in 0..240 {
            step(&mut dynamics, DT, &[torque_about_z(torque), [0.0; 6]]);
        }
        let alpha = torque / (j1 + j2 * (r1 / r2) * (r1 / r2));
        let off = dynamics.bodies[0].angular_velocity.z - alpha;
        assert!(off.abs() < ROUNDING, "{integrator:?}: off by {off:e} rad/s");
        let off = r1 * dynamics.bodies[0].angular_velocity.z + r2 * dynamics.bodies[1].angular_velocity.z;
        assert!(off.abs() < ROUNDING);
        assert!(dynamics.joint_error() < CLOSED);
    }
}

#[test]
fn gears_on_a_swinging_frame_change_its_swing() {
    // With both wheels' angles q relative to the frame, r₁ q₁ + r₂ q₂ = 0 and q = r₁/r₂: from rest
    //   q̇₁ = −θ̇ (J₁ − q J₂)/(J₁ + q² J₂)      I = I_frame + J₁ + J₂ − (J₁ − q J₂)²/(J₁ + q² J₂)
    let (ratio, j1, j2, start) = (3.0, 2e-3, 8e-3, 0.7);
    let turned = |v: DVec3| rotation(DVec3::Z * start) * v;
    let places = [DVec3::new(0.0, -0.2, 0.0), DVec3::new(0.1, -0.5, 0.0), DVec3::new(-0.1, -0.4, 0.0)];
    let masses = [0.5, 0.3, 0.2];
    for integrator in INTEGRATORS {
        let frame = body(masses[0], DVec3::new(1.0, 0.5, 1.0) * 0.01, turned(places[0]));
        let mut world =
            World::new(vec![frame, wheel(masses[1], j1, turned(places[1])), wheel(masses[2], j2, turned(places[2]))]);
        world.hinge("pivot", 0, None, DVec3::ZERO, DVec3::Z);
        for i in 1..3 {
            world.hinge(&format!("axle-{i}"), i, Some(0), turned(places[i]), DVec3::Z);
        }
        world.couple("gears", &[(Some(1), Some(0), ratio), (Some(2), Some(0), 1.0)]);
        let carried: f64 = (0..3).map(|i| masses[i] * places[i].length_squared()).sum();
        let (direct, geared) = (j1 - ratio * j2, j1 + ratio * ratio * j2);
        let inertia = 0.01 + carried + j1 + j2 - direct * direct / geared;
        let moment: DVec3 = (0..3).map(|i| masses[i] * places[i]).sum();
        let hanging = moment.x.atan2(-moment.y);
        let expected = elliptic_period(G * moment.length() / inertia, start + hanging);
        let mut dynamics = world.start(integrator);
        let read = |dynamics: &Dynamics| {
            let r: DVec3 = dynamics.bodies.iter().map(|b| b.properties.mass * b.position).sum();
            (r.x.atan2(-r.y), dynamics.bodies[0].angular_velocity.z)
        };
        let found = period(&mut dynamics, 8.0, DT, read);
        let error = (found / expected - 1.0).abs();
        println!("gears on a swinging frame, {integrator:?}: period off by {error:.1e}");
        let allowed = if integrator == Integrator::Precise { 1e-11 } else { 2e-7 };
        assert!(error < allowed, "{integrator:?}: {found} s against {expected} s");
        let theta = dynamics.bodies[0].angular_velocity.z;
        let q = dynamics.bodies[1].angular_velocity.z - theta;
        assert!((q + theta * direct / geared).abs() < ROUNDING, "{integrator:?}: the wheel turns with {q} rad/s");
        assert!(dynamics.joint_error() < CLOSED);
    }
}

#[test]
fn a_planetary_gear_reduces_by_its_teeth() {
    // Ring R = S + 2P is fixed, a torque acts on the sun: carrier ω S/(S + R), planet (ω_s − ω_c) (−S/P) against the carrier.
    let (s, p, torque) = (24.0, 18.0, 0.01);
    let r = s + 2.0 * p;
    let (js, jc, jp, mp) = (1e-3, 4e-3, 5e-4, 0.15);
    for integrator in INTEGRATORS {
        let arm = DVec3::X * 0.1;
        let mut world = World::new(vec![wheel(0.2, js, DVec3::ZERO), wheel(0.3, jc, DVec3::ZERO), wheel(mp, jp, arm)]);
        world.gravity = DVec3::ZERO;
        world.hinge("sun", 0, None, DVec3::ZERO, DVec3::Z);
        world.hinge("carrier", 1, None, DVec3::ZERO, DVec3::Z);
        world.hinge("planet", 2, Some(1), arm, DVec3::Z);
        world.couple("inside", &[(Some(0), Some(1), s), (Some(2), Some(1), p)]);
        world.couple("outside", &[(Some(2), Some(1), p), (None, Some(1), -r)]);
        let mut dynamics = world.start(integrator);
        for _ in 0..240 {
            step(&mut dynamics, DT, &[torque_about_z(torque), [0.0; 6], [0.0; 6]]);
        }
        let carrier = s / (s + r);
        let planet = carrier - s / p * (1.0 - carrier);
        let inertia = js + (jc + mp * 0.01) * carrier * carrier + jp * planet * planet;
        let expected = torque / inertia;
        let rates = [0, 1, 2].map(|i| dynamics.bodies[i].angular_velocity.z);
        for (found, ratio) in rates.into_iter().zip([1.0, carrier, planet]) {
            // The planet's axle moves on a circle: centripetal force is no polynomial of time, so the error exceeds rounding.
            let allowed = if integrator == Integrator::Precise { ROUNDING } else { 1e-8 };
            let error = (found - ratio * expected).abs();
            assert!(error < allowed * expected.abs(), "{integrator:?}: {rates:?}, off by {error:e}");
        }
        assert!(dynamics.joint_error() < CLOSED);
    }
}

#[test]
fn a_ring_of_gears_turns_though_one_mesh_repeats_the_others() {
    let (j, torque) = (3e-3, 0.03);
    let teeth = [20.0, 30.0, 20.0, 45.0];
    for integrator in INTEGRATORS {
        let mut world = wheels(&[j; 4]);
        for i in 0..4 {
            let next = (i + 1) % 4;
            world.couple(&format!("mesh-{i}"), &[(Some(i), None, teeth[i]), (Some(next), None, teeth[next])]);
        }
        let mut dynamics = world.start(integrator);
        let wrenches = [torque_about_z(torque), [0.0; 6], [0.0; 6], [0.0; 6]];
        for _ in 0..240 {
            step(&mut dynamics, DT, &wrenches);
        }
        assert_eq!(dynamics.system().redundant_rows().len(), 1);
        let inertia: f64 = teeth.iter().map(|z| j * (teeth[0] / z) * (teeth[0] / z)).sum();
        let off = dynamics.bodies[0].angular_velocity.z * inertia / torque - 1.0;
        assert!(off.abs() < ROUNDING, "{integrator:?}: off by {off:e}");
        assert!(dynamics.joint_error() < 1e2 * CLOSED, "tooth numbers times rounding: {}", dynamics.joint_error());
    }
}

#[test]
fn a_weight_on_a_drum_falls_with_its_share_of_g() {
    // a = m g r² / (J + m r²)
    let (m, r, j) = (0.4, 0.06, 3e-3);
    for integrator in INTEGRATORS {
        let mut world = wheels(&[j]);
        world.bodies.push(body(m, DVec3::splat(1e-4), DVec3::new(r, -0.5, 0.0)));
        let drum = Measure::Angle { axis: world.axis(Some(0), DVec3::Z), frame: None };
        let terms = vec![
            Term { measure: world.displacement(1, DVec3::NEG_Y), coefficient: 1.0 },
            Term { measure: drum, coefficient: -r },
        ];
        world.add("cord", ConstraintKind::Coupling { terms });
        let mut dynamics = world.start(integrator);
        run(&mut dynamics, 1.0, DT);
        let a = m * G * r * r / (j + m * r * r);
        let off = dynamics.bodies[1].position.y + 0.5 + 0.5 * a;
        assert!(off.abs() < ROUNDING, "{integrator:?}: off by {off:e} m");
        let off = dynamics.bodies[0].angular_velocity.z - a / r;
        assert!(off.abs() < 1e2 * ROUNDING, "{integrator:?}: off by {off:e} rad/s");
        // The cord pulls with m (g − a).
        let tension = dynamics.system().constraint_load(world.constraints.len() - 1).force;
        assert!((tension - m * (G - a)).abs() < ROUNDING, "{tension} N");
    }
}

#[test]
fn a_compound_pulley_halves_the_way() {
    // y₁ + 2 y₂ = const: a₂ = g (m₂ − 2 m₁)/(m₂ + 4 m₁), a₁ = −2 a₂, both down.
    let (m1, m2) = (0.3, 1.1);
    for integrator in INTEGRATORS {
        let stone = |m, x| body(m, DVec3::splat(1e-4), DVec3::X * x);
        let mut world = World::new(vec![stone(m1, 0.0), stone(m2, 0.2)]);
        let terms = [(0, 1.0), (1, 2.0)]
            .map(|(body, coefficient)| Term { measure: world.displacement(body, DVec3::NEG_Y), coefficient })
            .to_vec();
        world.add("cord", ConstraintKind::Coupling { terms });
        let mut dynamics = world.start(integrator);
        run(&mut dynamics, 1.0, DT);
        let a2 = G * (m2 - 2.0 * m1) / (m2 + 4.0 * m1);
        for (body, a) in [(0, -2.0 * a2), (1, a2)] {
            let off = dynamics.bodies[body].position.y + 0.5 * a;
            assert!(off.abs() < ROUNDING, "{integrator:?}, weight {body}: off by {off:e} m");
        }
    }
}

/// Σ teeth · angle, by a coupling's gauges that have counted up to these bodies.
fn slip(gauges: &[(Gauge, f64)], bodies: &[RigidBody]) -> f64 {
    let frames: Vec<_> = bodies.iter().map(|b| matrix(b.rotation)).collect();
    let mut parts: Vec<_> = (0..bodies.len()).map(|i| (i, [0.0; 6])).collect();
    coupling::row(&BodyStates { bodies, frames: &frames, time: 0.0 }, gauges, &mut parts).value
}

#[test]
fn phases_are_counted_exactly_over_a_hundred_thousand_turns() {
    // The rotations at every radian of the slow wheel are given, not integrated.
    let (z1, z2) = (12.0, 60.0);
    let mut bodies = [wheel(0.2, 1e-3, DVec3::ZERO), wheel(0.2, 1e-3, DVec3::X)];
    let measure = |body| Measure::Angle {
        axis: soffio_multibody::articulation::Axis { body: Some(body), direction: DVec3::Z },
        frame: None,
    };
    let mut gauges = [(Gauge::new(measure(0), &bodies), z1), (Gauge::new(measure(1), &bodies), z2)];
    let mut worst = 0.0_f64;
    let (turns, per_turn) = (100_000_u64, 5_u64);
    for index in 0..=turns * per_turn {
        // Whole turns are subtracted as integers: the angle is exact to rounding.
        let angle = |ratio: u64, sign: f64| {
            let part = index % (per_turn * ratio);
            sign * 2.0 * PI * part as f64 / (per_turn * ratio) as f64
        };
        bodies[0].rotation = rotation(DVec3::Z * angle(1, 1.0));
        bodies[1].rotation = rotation(DVec3::Z * angle(5, -1.0));
        if index % 997 == 0 || index == turns * per_turn {
            worst = worst.max(slip(&gauges, &bodies).abs());
        }
        for (gauge, _) in &mut gauges {
            gauge.count(&bodies);
        }
    }
    println!("phase after {turns} turns: off by {worst:.1e} at most");
    // In units of teeth · rad; a tooth of a module of a millimetre is half of that in millimetres.
    assert!(worst * 5e-4 < PHASE, "off by {worst:e}");
}

/// Largest phase error, m, of gears of a module of one millimetre over this many turns of free motion.
fn running(integrator: Integrator, turns: f64, rate: f64, dt: f64) -> f64 {
    let (z1, z2, module) = (12.0, 60.0, 1e-3);
    let mut world = wheels(&[1e-4, 2e-3]);
    world.gravity = DVec3::ZERO;
    world.bodies[0].angular_velocity = DVec3::Z * rate;
    world.bodies[1].angular_velocity = DVec3::Z * -rate * z1 / z2;
    // By tooth numbers: radii of 6 and 30 mm are not one to five in binary, and differ by a picometre over such an angle.
    world.couple("gears", &[(Some(0), None, z1), (Some(1), None, z2)]);
    let mut dynamics = world.start(integrator);
    let no_wrenches = [[0.0; 6]; 2];
    let mut worst = 0.0_f64;
    for _ in 0..(turns * 2.0 * PI / rate / dt).round() as usize {
        step(&mut dynamics, dt, &no_wrenches);
        // Wrapped, so that no count of turns can hide an error of the rotations.
        let angle = |i: usize| 2.0 * dynamics.bodies[i].rotation.z.atan2(dynamics.bodies[i].rotation.w);
        let teeth = (z1 * angle(0) + z2 * angle(1)) / (2.0 * PI);
        worst = worst.max((teeth - teeth.round()).abs() * PI * module);
    }
    let off = (dynamics.bodies[0].angular_velocity.z / rate - 1.0).abs();
    assert!(off < 1e-10, "the speed is off by {off:e}");
    worst
}

#[test]
fn running_gears_keep_their_phase() {
    for integrator in INTEGRATORS {
        let worst = [40.0, 400.0].map(|turns| running(integrator, turns, 60.0, DT));
        println!("gears running, {integrator:?}: phase off by {:.1e} m, then {:.1e} m", worst[0], worst[1]);
        assert!(worst[1] < PHASE, "{integrator:?}: {worst:?} m");
    }
}

#[test]
#[ignore = "a hundred thousand turns: a minute or two of the machine"]
fn gears_keep_their_phase_over_a_hundred_thousand_turns() {
    for integrator in INTEGRATORS {
        let worst = running(integrator, 1e5, 60.0, DT);
        println!("gears running, {integrator:?}: phase off by {worst:.1e} m");
        assert!(worst < PHASE, "{integrator:?}: {worst:e} m");
    }
}

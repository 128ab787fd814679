//! The two-object rule by hand.

use soffio_math::Interpolation;
use soffio_math::{DMat3, DQuat, DVec3, Pose};
use soffio_multibody::dynamics::{KeyframeMotion, KinematicBody};
use soffio_multibody::procedural::two_body_rule::{
    Group, MAX_ROTATION, common_point, compulsive_rotation, compulsive_translation,
};
use soffio_multibody::procedural::{PositionSolver, Settings};

use super::{Extras, Hand};
use crate::motion::{World, body};

/// Rounding of some ten operations on numbers of order 1.
const ROUNDING: f64 = 1e-14;
/// And of a step's bookkeeping: differences of places, over rotations.
const STEP: f64 = 1e-12;

#[test]
fn the_turn_and_the_way_are_those_of_a_hand_calculation() {
    // r along x, s along y, about z with I = 0.05 kg m², 2 kg, c = 1.5: h = 0.0375 m², ψ = atan(0.1/0.3),
    // θ = ψ 0.09/(0.09 + 0.0375).
    let (r, s) = (DVec3::X * 0.3, DVec3::Y * 0.1);
    let inertia = DMat3::from_diagonal(DVec3::new(0.01, 0.02, 0.05));
    let w = compulsive_rotation(r, s, 1.5, &inertia, 2.0);
    let theta = (1.0_f64 / 3.0).atan() * 0.09 / 0.1275;
    assert!((w - DVec3::Z * theta).length() < ROUNDING, "{w}");
    let rotation = DMat3::from_axis_angle(DVec3::Z, theta);
    let t = compulsive_translation(r, s, &rotation);
    // By hand: R r = 0.3 (cos θ, sin θ), so T = (0.3 (1 − cos θ), 0.1 − 0.3 sin θ).
    let by_hand = DVec3::new(0.3 * (1.0 - theta.cos()), 0.1 - 0.3 * theta.sin(), 0.0);
    assert!((t - by_hand).length() < ROUNDING, "{t} {by_hand}");
    assert!((r + s - (rotation * r + t)).length() < ROUNDING);
}

#[test]
fn more_inertia_turns_less_and_a_heavier_load_more() {
    let (r, s) = (DVec3::new(0.1, 0.02, 0.0), DVec3::new(-0.03, 0.02, 0.01));
    let angle = |inertia: f64, mass: f64, control: f64| {
        compulsive_rotation(r, s, control, &(DMat3::IDENTITY * inertia), mass).length()
    };
    let psi = r.angle_between(r + s);
    assert!(psi < MAX_ROTATION && psi < r.angle_between(s), "between 0 and the source's φ");
    assert!(angle(2e-3, 1.0, 1.0) < angle(1e-3, 1.0, 1.0));
    assert!(angle(1e-3, 2.0, 1.0) > angle(1e-3, 1.0, 1.0));
    assert!((angle(1e-3, 1.0, 0.0) - psi).abs() < ROUNDING, "without control it turns by all of ψ");
    assert!(angle(1e-3, 1.0, 1e12) < 1e-9, "and by nothing under a strong one");
}

/// What the source's own exponential does not do: a thousand steps of a thousandth of the way turn as much as one.
#[test]
fn the_turn_does_not_depend_on_the_step() {
    /// Difference of arc and chord over a way of a hundredth of the arm.
    const BENT: f64 = 1e-4;
    let (r, displacement) = (DVec3::X * 0.3, DVec3::Y * 3e-3);
    let turned = |steps: u32| {
        let of =
            |_| compulsive_rotation(r, displacement / f64::from(steps), 1.0, &(DMat3::IDENTITY * 0.05), 2.0).length();
        (0..steps).map(of).sum::<f64>()
    };
    let one = turned(1);
    for steps in [2, 30, 1000] {
        assert!((turned(steps) / one - 1.0).abs() < BENT, "{steps} steps: {} and {one} rad", turned(steps));
    }
    // As the source derives it before its exponential, for a short arm: θ = (m/I)|r × s|.
    let (r, s) = (DVec3::X * 1e-4, DVec3::Y * 1e-7);
    let theta = compulsive_rotation(r, s, 1.0, &(DMat3::IDENTITY * 0.05), 2.0).length();
    assert!((theta / (2.0 / 0.05 * r.cross(s).length()) - 1.0).abs() < 1e-3, "{theta} rad");
}

#[test]
fn the_turn_has_the_least_kinetic_energy() {
    // ½ m |u|² + ½ I θ² with u + θ z × r = s; the least among turns near it.
    let (r, s, inertia, mass) = (DVec3::X * 0.2, DVec3::Y * 1e-6, 0.03, 2.0);
    let theta = compulsive_rotation(r, s, 1.0, &(DMat3::IDENTITY * inertia), mass).z;
    let energy = |theta: f64| {
        let u = s - theta * DVec3::Z.cross(r);
        0.5 * mass * u.length_squared() + 0.5 * inertia * theta * theta
    };
    for other in [0.9, 0.99, 1.01, 1.1] {
        assert!(energy(theta) < energy(other * theta), "{other}");
    }
}

#[test]
fn a_group_balances_where_its_loads_do() {
    // A beam of 1 kg with 3 kg at its right end: 4 kg at 0.3 m, and 1·3/4·0.4² more inertia.
    let beam = Group { mass: 1.0, center: DVec3::ZERO, inertia: DMat3::from_diagonal(DVec3::new(0.0, 0.02, 0.02)) };
    let group = beam.with_load(3.0, DVec3::X * 0.4);
    assert!((group.mass - 4.0).abs() < ROUNDING && (group.center - DVec3::X * 0.3).length() < ROUNDING, "{group:?}");
    assert!((group.inertia - DMat3::from_diagonal(DVec3::new(0.0, 0.14, 0.14))).abs_diff_eq(DMat3::ZERO, ROUNDING));
    // Held above that point it does not turn under gravity.
    let w = compulsive_rotation(DVec3::Y * 0.1, DVec3::Y * 1e-4, 1.0, &group.inertia, group.mass);
    assert_eq!(w, DVec3::ZERO);
}

#[test]
fn what_lies_along_the_arm_turns_nothing() {
    for s in [DVec3::X, DVec3::NEG_X, DVec3::ZERO] {
        let w = compulsive_rotation(DVec3::X * 0.3, s * 0.1, 1.0, &DMat3::IDENTITY, 1.0);
        assert_eq!(w, DVec3::ZERO, "{s}");
    }
}

#[test]
fn reaching_turns_a_point_mass_onto_its_line_and_a_wheel_not_at_all() {
    let (r, s) = (DVec3::new(0.2, 0.1, 0.0), DVec3::new(-0.01, 0.05, 0.06));
    let aim = |inertia: f64, r: DVec3| compulsive_rotation(r, s, 1.0, &(DMat3::IDENTITY * inertia), 2.0);
    let w = aim(0.0, r);
    let turned = DQuat::from_scaled_axis(w) * r;
    assert!(turned.cross(r + s).length() < ROUNDING && turned.dot(r + s) > 0.0);
    // I/m = |r|² halves it.
    assert!((aim(2.0 * r.length_squared(), r) - 0.5 * w).length() < ROUNDING);
    assert!(aim(0.1, DVec3::X * 1e-12).length() < 1e-20);
}

#[test]
fn two_free_objects_meet_where_their_masses_say() {
    let c = common_point((1.0, DVec3::X), (3.0, DVec3::NEG_X));
    assert!((c - DVec3::NEG_X * 0.5).length() < ROUNDING);
    let (m1, c1, m2, c2) = (0.3, DVec3::new(0.1, 0.7, -0.2), 0.8, DVec3::new(-0.4, 0.2, 0.9));
    let c = common_point((m1, c1), (m2, c2));
    assert!((m1 * (c1 - c) - m2 * (c - c2)).length() < ROUNDING);
}

/// O₁ follows key frames and jumps; O₂ hangs on it by a point.
#[test]
fn a_step_moves_the_second_object_by_the_rule() {
    const JUMP: DVec3 = DVec3::new(0.05, 0.2, 0.0);
    const CONTROL: f64 = 0.7;
    let inertia = DVec3::new(2e-3, 3e-3, 4e-3);
    let mut world = World::new(vec![body(1.0, DVec3::ONE, DVec3::ZERO), body(0.5, inertia, DVec3::X * 0.25)]);
    world.gravity = DVec3::ZERO;
    world.pin("joint", 1, Some(0), DVec3::X * 0.1);
    let key = |t: f64, position: DVec3| (t, Pose { rotation: DQuat::IDENTITY, position });
    let keys = vec![key(0.0, DVec3::ZERO), key(1e-3, JUMP)];
    world.kinematic_bodies.push(KinematicBody {
        body: 0,
        motion: KeyframeMotion { keys, interpolation: Interpolation::Linear, repeat: false },
    });
    let settings = Settings { method: PositionSolver::Relaxation, control: CONTROL, retention: 1.0 };
    let mut hand = Hand::with(&world, &Extras::default(), settings);
    hand.step(1e-2, &[]);
    let r = DVec3::X * -0.15;
    let w = compulsive_rotation(r, JUMP, CONTROL, &DMat3::from_diagonal(inertia), 0.5);
    let rotation = DMat3::from_quat(DQuat::from_scaled_axis(w));
    let place = DVec3::X * 0.25 + compulsive_translation(r, JUMP, &rotation);
    let displaced = hand.bodies()[1];
    assert!((displaced.position - place).length() < STEP, "{} {place}", displaced.position);
    assert!((displaced.rotation * DVec3::X - rotation * DVec3::X).length() < STEP);
    assert_eq!(displaced.velocity, DVec3::ZERO, "O₁ rests at the end of its jump, and the joint gives O₂ its speed");
    assert!(hand.procedural.report().converged());
}

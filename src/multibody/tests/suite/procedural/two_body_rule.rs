//! The two-object rule by hand.

use soffio_math::Interpolation;
use soffio_math::{DMat3, DQuat, DVec3, PI, Pose};
use soffio_multibody::dynamics::{KeyframeMotion, KinematicBody};
use soffio_multibody::procedural::two_body_rule::{
    RotationRule, common_point, compulsive_rotation, compulsive_translation, rotation_vector,
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
    // r along x, s along y: a right angle, |r||s| = 0.12 m², about z with I = 0.05 kg m², 2 kg, c = 1.5:
    // h = 0.0375 m², θ = π/2 exp(−0.3125) = 1.149218... rad.
    let (r, s) = (DVec3::X * 0.3, DVec3::Y * 0.4);
    let inertia = DMat3::from_diagonal(DVec3::new(0.01, 0.02, 0.05));
    let w = compulsive_rotation(r, s, 1.5, &inertia, 2.0);
    let theta = 0.5 * PI * (-0.3125_f64).exp();
    assert!((w - DVec3::Z * theta).length() < ROUNDING, "{w}");
    let rotation = DMat3::from_axis_angle(DVec3::Z, theta);
    let t = compulsive_translation(r, s, &rotation);
    // By hand: R r = 0.3 (cos θ, sin θ), so T = (0.3 (1 − cos θ), 0.4 − 0.3 sin θ).
    let by_hand = DVec3::new(0.3 * (1.0 - theta.cos()), 0.4 - 0.3 * theta.sin(), 0.0);
    assert!((t - by_hand).length() < ROUNDING, "{t} {by_hand}");
    assert!((r + s - (rotation * r + t)).length() < ROUNDING);
}

#[test]
fn more_inertia_turns_less_and_a_heavier_load_more() {
    let (r, s) = (DVec3::new(0.1, 0.02, 0.0), DVec3::new(-0.03, 0.08, 0.05));
    let angle = |inertia: f64, mass: f64, control: f64| {
        compulsive_rotation(r, s, control, &(DMat3::IDENTITY * inertia), mass).length()
    };
    let phi = r.angle_between(s);
    assert!(angle(2e-3, 1.0, 1.0) < angle(1e-3, 1.0, 1.0));
    assert!(angle(1e-3, 2.0, 1.0) > angle(1e-3, 1.0, 1.0));
    assert!((angle(1e-3, 1.0, 0.0) - phi).abs() < ROUNDING, "without control it turns by all of φ");
    assert!(angle(1e-3, 1.0, 1e4) < 1e-12, "and by nothing under a strong one");
    for k in 0..50 {
        let angle = angle(1e-3, 1.0, 0.1 * f64::from(k));
        assert!((0.0..=phi + ROUNDING).contains(&angle));
    }
}

#[test]
fn what_lies_along_the_arm_turns_nothing() {
    for s in [DVec3::X, DVec3::NEG_X, DVec3::ZERO] {
        for rotation_rule in [RotationRule::Compulsive(0.0), RotationRule::Aim] {
            let w = rotation_vector(rotation_rule, DVec3::X * 0.3, s * 0.1, &DMat3::IDENTITY, 1.0);
            assert_eq!(w, DVec3::ZERO, "{s} {rotation_rule:?}");
        }
    }
}

#[test]
fn reaching_turns_a_point_mass_onto_its_line_and_a_wheel_not_at_all() {
    let (r, s) = (DVec3::new(0.2, 0.1, 0.0), DVec3::new(-0.01, 0.05, 0.06));
    let aim = |inertia: f64, r: DVec3| rotation_vector(RotationRule::Aim, r, s, &(DMat3::IDENTITY * inertia), 2.0);
    let w = aim(0.0, r);
    let turned = DQuat::from_scaled_axis(w) * r;
    assert!(turned.cross(r + s).length() < ROUNDING && turned.dot(r + s) > 0.0);
    assert!(w.length() <= r.angle_between(s));
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
    const DEFAULT_CONTROL: f64 = 0.7;
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
    let settings = Settings { method: PositionSolver::Relaxation, control: DEFAULT_CONTROL, retention: 1.0 };
    let mut hand = Hand::with(&world, &Extras::default(), settings);
    hand.step(1e-2, &[]);
    let r = DVec3::X * -0.15;
    let w = compulsive_rotation(r, JUMP, DEFAULT_CONTROL, &DMat3::from_diagonal(inertia), 0.5);
    let rotation = DMat3::from_quat(DQuat::from_scaled_axis(w));
    let place = DVec3::X * 0.25 + compulsive_translation(r, JUMP, &rotation);
    let displaced = hand.bodies()[1];
    assert!((displaced.position - place).length() < STEP, "{} {place}", displaced.position);
    assert!((displaced.rotation * DVec3::X - rotation * DVec3::X).length() < STEP);
    assert!((displaced.velocity - (place - DVec3::X * 0.25) / 1e-2).length() < STEP / 1e-2);
    assert!(hand.procedural.report().converged());
}

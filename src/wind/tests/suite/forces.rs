//! Wind forces against formulas: drag, damping, momentum, turbulence, travelling jet_front.

use soffio_geometry::bodies::RigidBody;
use soffio_math::noise::Random;
use soffio_math::spatial::{Vec6, linear};
use soffio_math::{DVec3, PI};
use soffio_wind::ambient::{Modulation, Wind, WindKind};
use soffio_wind::breath::{AIR_DENSITY, SpreadLaw};
use soffio_wind::force::{BreathJet, TURBULENCE, WindField};
use soffio_wind::jet_front::JetFront;
use soffio_wind::{Surface, SurfaceShape};

use super::bodies::*;

/// A sum of a few hundred terms in double precision against the formula.
const ROUNDING: f64 = 1e-12;
const DT: f64 = 1.0 / 240.0;

fn draught(v: DVec3) -> Wind {
    let kind = WindKind::Draught { direction: v.normalize(), inlet: None };
    Wind { name: "draught".into(), kind, speed: v.length().into(), modulation: Modulation::Steady }
}

/// Force on one body in a wind that is the same everywhere, N.
fn force_in(wind: DVec3, surface: Surface, body: RigidBody) -> DVec3 {
    let mut out = [[0.0; 6]];
    WindField::new(&[surface], &[], &[draught(wind)], 1, 1).apply_forces(&[body], 0.0, None, &mut out);
    linear(&out[0])
}

/// ½ ρ A (C_D |v_n| v_n n + C_F |v_t| v_t).
fn on_face(area: f64, n: DVec3, v: DVec3, drag_normal: f64) -> DVec3 {
    let along = v.dot(n);
    let slip = v - along * n;
    0.5 * AIR_DENSITY * area * (drag_normal * along.abs() * along * n + C_F * slip.length() * slip)
}

/// A wind of up to 20 m/s, and a body of any attitude that moves at up to 5 m/s.
fn any_case(random: &mut Random) -> (DVec3, RigidBody) {
    let mut moving = turned(any_vector(random, 1.0), any_turn(random));
    moving.velocity = any_vector(random, 5.0);
    (any_vector(random, 20.0), moving)
}

#[test]
fn drag_of_a_sheet_matches_the_formula_at_any_angle_and_speed() {
    const SEED: u64 = 21;
    let mut random = Random::new(SEED);
    let a = 0.1;
    for case in 0..500 {
        let (wind, moving) = any_case(&mut random);
        let n = moving.rotation * DVec3::Z;
        let expected = on_face(a * a, n, wind - moving.velocity, C_D);
        let found = force_in(wind, sheet(0, face(a), 16 + case % 200), moving);
        let off = (found - expected).length() / expected.length();
        assert!(off < ROUNDING, "seed {SEED}, case {case}: {found} N against {expected} N, {off:e}");
    }
}

#[test]
fn wind_acts_on_windward_faces_of_a_solid_and_its_own_motion_on_all() {
    const SEED: u64 = 22;
    let mut random = Random::new(SEED);
    let size = DVec3::new(0.1, 0.08, 0.06);
    for case in 0..500 {
        let (wind, moving) = any_case(&mut random);
        let mut expected = DVec3::ZERO;
        for (n, area) in [(DVec3::X, size.y * size.z), (DVec3::Y, size.x * size.z), (DVec3::Z, size.x * size.y)] {
            for n in [moving.rotation * n, moving.rotation * -n] {
                let v = if n.dot(wind) < 0.0 { wind - moving.velocity } else { -moving.velocity };
                expected += on_face(area, n, v, if v.dot(n) < 0.0 { C_D } else { 0.0 });
            }
        }
        let found = force_in(wind, solid(0, cuboid(size), 300), moving);
        let off = (found - expected).length() / expected.length();
        assert!(off < ROUNDING, "seed {SEED}, case {case}: {found} N against {expected} N, {off:e}");
    }
}

#[test]
fn a_wire_is_a_cylinder_across_and_along() {
    const SEED: u64 = 23;
    let (radius, length, drag) = (5e-4, 0.3, 1.2);
    let mut random = Random::new(SEED);
    for case in 0..200 {
        let (wind, moving) = any_case(&mut random);
        let ends = DVec3::new(0.1, -0.2, 0.2) * (length / 0.3);
        let shape = SurfaceShape::Wire { points: vec![DVec3::ZERO, ends], radius };
        let wire = Surface { shape, drag_normal: drag, ..solid(0, face(1.0), 1) };
        let t = moving.rotation * ends.normalize();
        let v = wind - moving.velocity;
        let (along, across) = (v.dot(t) * t, v - v.dot(t) * t);
        // ½ ρ C_D (2 r L) v_⊥² across; along, skin friction on the whole skin 2 π r L.
        let expected = 0.5 * AIR_DENSITY * drag * 2.0 * radius * length * across.length() * across
            + 0.5 * AIR_DENSITY * C_F * 2.0 * PI * radius * length * along.length() * along;
        let found = force_in(wind, wire, moving);
        let off = (found - expected).length() / expected.length();
        assert!(off < ROUNDING, "seed {SEED}, case {case}: {found} N against {expected} N, {off:e}");
    }
}

#[test]
fn still_air_slows_a_moving_plate_by_quadratic_drag() {
    let a = 0.1;
    for speed in [0.2, 1.0, 3.0] {
        let mut moving = body(DVec3::ZERO);
        moving.velocity = DVec3::Z * speed;
        let mut out = [[0.0; 6]];
        field(&[sheet(0, face(a), 64)], 1).apply_forces(&[moving], 0.0, None, &mut out);
        let expected = -0.5 * AIR_DENSITY * C_D * a * a * speed * speed;
        assert!((linear(&out[0]).z / expected - 1.0).abs() < ROUNDING, "{:?} at {speed} m/s", out[0]);
    }
}

#[test]
fn patches_damp_rotation() {
    // A plate about an axis in its plane: τ = −½ ρ C_D ω² ∫ |x|³ dA = −½ ρ C_D ω² a · 2 (a/2)⁴/4; a wire of length L
    // about its middle: −½ ρ C_D 2 r ω² · 2 (L/2)⁴/4; a plate in its own plane: skin friction alone, which still brakes.
    const SAMPLED: f64 = 0.05;
    let (a, spin) = (0.1, 5.0);
    let torque = |surface: Surface, axis: DVec3| {
        let mut turning = body(DVec3::ZERO);
        turning.angular_velocity = axis * spin;
        let mut out = [[0.0; 6]];
        field(&[surface], 1).apply_forces(&[turning], 0.0, None, &mut out);
        DVec3::new(out[0][3], out[0][4], out[0][5]).dot(axis)
    };
    let h: f64 = 0.5 * a;
    let over_a_half = 2.0 * h * h * h * h / 4.0;
    let found = torque(sheet(0, face(a), 200), DVec3::Y);
    let expected = -0.5 * AIR_DENSITY * C_D * spin * spin * a * over_a_half;
    assert!((found / expected - 1.0).abs() < SAMPLED, "plate: {found} against {expected} N m");
    let shape = SurfaceShape::Wire { points: vec![DVec3::X * -0.2, DVec3::X * 0.2], radius: 1e-3 };
    let found = torque(Surface { shape, ..solid(0, face(1.0), 1) }, DVec3::Y);
    let expected = -0.5 * AIR_DENSITY * C_D * spin * spin * 2e-3 * 2.0 * 0.2 * 0.2 * 0.2 * 0.2 / 4.0;
    assert!((found / expected - 1.0).abs() < SAMPLED, "wire: {found} against {expected} N m");
    assert!(torque(sheet(0, face(a), 200), DVec3::Z) < 0.0, "a plate in its own plane");
}

#[test]
fn a_breath_never_pushes_harder_than_its_momentum_times_the_gain() {
    // Walls that would take more than the breath carries, plates that fly against it, many at once.
    const SEED: u64 = 24;
    let mut random = Random::new(SEED);
    let surfaces: Vec<Surface> = (0..4).map(|i| sheet(i, face(if i == 0 { 0.6 } else { 0.08 }), 200)).collect();
    let mut field = field(&surfaces, 4);
    let mut most: f64 = 0.0;
    for case in 0..300 {
        let bodies: Vec<RigidBody> = (0..4)
            .map(|i| {
                let place = DVec3::new(0.05, 0.05, 0.2) * any_vector(&mut random, 1.0) * f64::from(u8::from(i > 0));
                let mut moving = turned(place, any_turn(&mut random));
                moving.velocity = any_vector(&mut random, 3.0);
                moving
            })
            .collect();
        let mut jet = jet(random.range(0.5, 30.0));
        jet.breath.law = if case % 2 == 0 { SpreadLaw::Jet } else { SpreadLaw::Cone { vertex_distance: None } };
        jet.gain = random.range(0.5, 8.0);
        let report = field.apply_forces(&bodies, random.range(0.0, 100.0), Some(&jet), &mut [[0.0; 6]; 4]);
        let bound = jet.breath.momentum_flow(jet.breath.speed) * jet.gain;
        assert!((report.bound - bound).abs() < ROUNDING * bound || report.bound == 0.0);
        let share = report.breath.length() / bound;
        assert!(share <= 1.0 + ROUNDING, "seed {SEED}, case {case}: {share} of the bound");
        most = most.max(share);
    }
    assert!(most > 0.5, "some case comes near the bound: {most}");
}

#[test]
fn the_lee_side_and_the_air_behind_the_lips_are_still() {
    let mut field = field(&[solid(0, plate(0.1, 1e-3), 200)], 1);
    let mut out = [[0.0; 6]];
    field.apply_forces(&[body(DVec3::new(0.0, 0.0, 0.7))], 0.0, Some(&jet(17.0)), &mut out);
    assert_eq!(linear(&out[0]), DVec3::ZERO);
}

#[test]
fn a_sheet_of_one_face_is_pushed_from_either_side() {
    let mut field = field(&[sheet(0, face(0.1), 200)], 1);
    let mut force = |mouth: f64| {
        let mut jet = jet(8.9);
        jet.breath.mouth.z = mouth;
        jet.breath.direction.z = -mouth.signum();
        let mut out = [[0.0; 6]];
        field.apply_forces(&[body(DVec3::ZERO)], 0.0, Some(&jet), &mut out);
        linear(&out[0]).z
    };
    let (before, behind) = (force(0.5), force(-0.5));
    assert!(before < 0.0 && behind > 0.0, "{before} N and {behind} N");
}

/// Force of a breath on a plate of one patch, and the same without turbulence, N.
fn on_one_patch(field: &mut WindField, at: DVec3, time: f64) -> (DVec3, DVec3) {
    let jet = jet(8.9);
    let report = field.apply_forces(&[body(at)], time, Some(&jet), &mut [[0.0; 6]]);
    // The sample is somewhere on the plate, which is so small that the wind is the same all over it.
    (report.breath, on_face(1e-8, DVec3::Z, jet.breath.velocity(at), C_D))
}

#[test]
fn turbulence_is_smaller_than_its_share_of_the_force_and_coherent() {
    const SMALL: f64 = 1e-4;
    let mut field = field(&[sheet(0, face(SMALL), 1)], 1);
    let random_part = |field: &mut WindField, x: f64, time: f64| {
        let (found, mean) = on_one_patch(field, DVec3::X * x, time);
        (found - mean) / mean.length()
    };
    let (mut most, mut sum, mut square, n) = (0.0_f64, DVec3::ZERO, 0.0, 4000);
    for i in 0..n {
        let part = random_part(&mut field, 0.0, 0.173 * f64::from(i));
        most = most.max(part.length());
        sum += part / f64::from(n);
        square += part.length_squared() / f64::from(n);
    }
    // A hundredth of a percent for the wind's change over the plate.
    assert!(most < TURBULENCE * (1.0 + 1e-3), "{most} of the force");
    assert!(square.sqrt() > 0.3 * TURBULENCE, "it is felt: {} rms", square.sqrt());
    // 4,000 samples, of which eddies make some hundreds independent.
    assert!(sum.length() < 0.1 * TURBULENCE, "it has a direction of its own: {sum}");
    // A step later and a millimetre on it is nearly the same; an eddy's size on, another.
    for i in 0..50 {
        let time = 0.5 * f64::from(i);
        let here = random_part(&mut field, 0.0, time);
        assert!(here.distance(random_part(&mut field, 0.0, time + DT)) < 0.25 * TURBULENCE, "at {time} s");
        assert!(here.distance(random_part(&mut field, 1e-3, time)) < 0.15 * TURBULENCE, "at {time} s");
    }
    let far: f64 = (0..50)
        .map(|i| random_part(&mut field, 0.0, f64::from(i)).distance(random_part(&mut field, 0.05, f64::from(i))))
        .sum();
    assert!(far / 50.0 > 0.2 * TURBULENCE, "an eddy on it is another: {}", far / 50.0);
}

#[test]
fn the_same_seed_is_the_same_wind_to_the_bit() {
    let surfaces = [sheet(0, face(0.1), 64), solid(1, ball(0.03, 8), 64)];
    let wind = Wind {
        name: "room".into(),
        kind: WindKind::Turbulence { scale: 0.3, period: 4.0, seed: 5 },
        speed: 0.2.into(),
        modulation: Modulation::Steady,
    };
    let run = |seed: u64| -> Vec<Vec6> {
        let shelters = soffio_wind::Shelter::of(&surfaces);
        let mut field = WindField::new(&surfaces, &shelters, std::slice::from_ref(&wind), 2, seed);
        let bodies = [body(DVec3::ZERO), body(DVec3::new(0.02, 0.0, 0.1))];
        let mut all = Vec::new();
        for step in 0..100 {
            let mut out = [[0.0; 6]; 2];
            field.apply_forces(&bodies, f64::from(step) * DT, Some(&jet(8.9)), &mut out);
            all.extend(out);
        }
        all
    };
    assert!(run(5) == run(5));
    assert!(run(5) != run(6), "another seed has other gusts");
}

#[test]
fn air_on_its_way_pushes_after_the_lips_have_closed() {
    let mut field = field(&[sheet(0, face(0.1), 64)], 1);
    let mut jet_front = JetFront::default();
    let mut force = |jet_front: &JetFront, speed: f64| {
        let jet = BreathJet { breath: breath(speed), jet_front: Some(jet_front), gain: 1.0, turbulence: TURBULENCE };
        field.apply_forces(&[body(DVec3::ZERO)], 0.0, Some(&jet), &mut [[0.0; 6]]).breath.length()
    };
    // Half a metre at 8.9 m/s takes 0.468 s: a puff of 0.2 s has left before any of it arrives.
    for _ in 0..48 {
        jet_front.advance(8.9, DT);
        assert_eq!(force(&jet_front, 8.9), 0.0, "nothing arrives before the front");
    }
    let mut impulse = 0.0;
    for _ in 0..480 {
        jet_front.advance(0.0, DT);
        let force = force(&jet_front, 0.0);
        assert!(force <= breath(0.0).momentum_flow(8.9) * (1.0 + ROUNDING));
        impulse += force * DT;
    }
    // A fifth of a second of momentum flow is 1.5 mN s; the plate takes a part of it, slowed on its way.
    assert!(impulse > 2e-5, "the puff arrives: {impulse} N s");
    assert_eq!(force(&jet_front, 0.0), 0.0, "and has passed");
}

#[test]
fn undirected_wind_hardly_changes_a_breath_of_large_gain_on_a_solid() {
    const SEED: u64 = 27;
    /// At a gain of 100 the undirected wind counts a tenth as much beside the breath, but for squares.
    const GAIN: f64 = 100.0;
    const LEFT: f64 = 0.2;
    let breath = breath(3.0);
    let speed = breath.velocity(DVec3::ZERO).length();
    let kind = WindKind::Turbulence { scale: 0.5, period: 2.0, seed: SEED };
    let turbulence = [Wind { name: "room".into(), kind, speed: speed.into(), modulation: Modulation::Steady }];
    let force = |gain: f64, winds: &[Wind], time: f64| {
        let mut field = WindField::new(&[solid(0, plate(0.02, 0.002), 64)], &[], winds, 1, 1);
        let jet = BreathJet { breath, jet_front: None, gain, turbulence: TURBULENCE };
        field.apply_forces(&[body(DVec3::ZERO)], time, Some(&jet), &mut [[0.0; 6]]).breath.length() / gain
    };
    let changed = |gain: f64| {
        let share =
            |second: i32| force(gain, &turbulence, f64::from(second)) / force(gain, &[], f64::from(second)) - 1.0;
        (0..60).map(share).fold(0.0, |most: f64, change| most.max(change.abs()))
    };
    let [alike, stronger] = [1.0, GAIN].map(changed);
    println!("the undirected wind changes a breath by {alike:.2}, with a gain of {GAIN} by {stronger:.2}");
    assert!(alike > 0.3 && stronger < LEFT * alike, "{alike} and {stronger}");
}

#[test]
fn the_air_over_a_surface_is_as_loud_as_its_area_and_the_sixth_power_of_its_speed() {
    // Patches are drawn at random: their mean lies within a tenth of the side of the middle.
    const OF_THE_MIDDLE: f64 = 0.1;
    const SEED: u64 = 24;
    let mut random = Random::new(SEED);
    let a = 0.1;
    for case in 0..100 {
        let (wind, moving) = any_case(&mut random);
        let mut field = WindField::new(&[sheet(0, face(a), 200)], &[], &[draught(wind)], 1, 1);
        field.apply_forces(&[moving], 0.0, None, &mut [[0.0; 6]]);
        let [noise] = field.noise() else { panic!("one surface") };
        let speed = (wind - moving.velocity).length();
        let expected = a * a * soffio_math::pow(speed, 6.0);
        assert!(
            (noise.power / expected - 1.0).abs() < ROUNDING,
            "seed {SEED}, case {case}: {noise:?} against {expected}"
        );
        assert!((noise.speed(field.area(0)) / speed - 1.0).abs() < ROUNDING);
        assert!((noise.flow.normalize() - (wind - moving.velocity) / speed).length() < ROUNDING);
        let place = noise.place().expect("wind blows");
        assert!(place.distance(moving.position) < OF_THE_MIDDLE * a, "{place}");
        // Calm air around a body at rest makes no sound; around a body that moves it does.
        let mut calm = WindField::new(&[sheet(0, face(a), 200)], &[], &[], 1, 1);
        let rest = RigidBody { velocity: DVec3::ZERO, ..moving };
        calm.apply_forces(&[rest], 0.0, None, &mut [[0.0; 6]]);
        assert_eq!(calm.noise()[0].power, 0.0);
        calm.apply_forces(&[moving], 0.0, None, &mut [[0.0; 6]]);
        let expected = a * a * soffio_math::pow(moving.velocity.length(), 6.0);
        assert!((calm.noise()[0].power / expected - 1.0).abs() < ROUNDING);
    }
}

#[test]
fn drag_stops_a_light_sheet_at_most_and_never_turns_it_round() {
    // A sheet of 1 m² and 69 g, as of silk, and one of 10 kg, in 40 m/s: the force of a step of 1/240 s.
    const STEP: f64 = 1.0 / 240.0;
    for (mass, expected) in [(0.069, 0.069 * 40.0 / STEP), (10.0, 0.5 * AIR_DENSITY * C_D * 1600.0)] {
        let mut body = turned(DVec3::ZERO, soffio_math::DQuat::IDENTITY);
        body.properties.mass = mass;
        let force = force_in(40.0 * DVec3::Z, sheet(0, face(1.0), 64), body).z;
        assert!((force / expected - 1.0).abs() < 1e-9, "{mass} kg: {force} N, not {expected}");
        assert!(force * STEP / mass <= 40.0 * (1.0 + 1e-9), "it would fly faster than the air");
    }
}

//! The wind's force against formulas: drag, terminal speed, momentum, shelter, gusts.

use soffio::articulation::block::linear;
use soffio::bodies::{MassProperties, RigidBody};
use soffio::geometry::TriangleMesh;
use soffio::math::{DMat3, DVec3, Pose};
use soffio::wind::force::{Breath, WindField};
use soffio::wind::jet::{AIR_DENSITY, Jet};
use soffio::wind::{Surface, SurfaceShape};

const C_D: f64 = 1.17;

/// A closed square plate of side `a` and thickness `t`, its faces along z.
fn plate(a: f64, t: f64) -> TriangleMesh {
    let (h, z) = (0.5 * a, 0.5 * t);
    let corner = |i: usize| {
        let sign = |bit: usize| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
        DVec3::new(sign(0) * h, sign(1) * h, sign(2) * z)
    };
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    TriangleMesh {
        positions: (0..8).map(corner).collect(),
        triangles: faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).collect(),
    }
}

fn surface(body: usize, mesh: TriangleMesh) -> Surface {
    let shape = SurfaceShape::Mesh { mesh, per_area: 40_000.0, count: (200, 2000), sheet: false, seed: 3 };
    Surface { body, node: String::new(), shape, drag_normal: C_D, drag_tangential: 0.0, gain: 1.0 }
}

fn body(position: DVec3) -> RigidBody {
    let properties =
        MassProperties { mass: 0.01, center: DVec3::ZERO, inertia: DMat3::from_diagonal(DVec3::splat(1e-5)) };
    RigidBody::at_rest(properties, Pose { position, ..Pose::IDENTITY })
}

fn jet(speed: f64) -> Jet {
    Jet { mouth: DVec3::new(0.0, 0.0, 0.5), direction: DVec3::NEG_Z, lip_diameter: 0.01, speed }
}

fn breath(speed: f64) -> Breath<'static> {
    Breath { jet: jet(speed), front: None, gain: 1.0, time: 0.0 }
}

#[test]
fn still_air_brakes_a_moving_plate_as_quadratic_drag() {
    // F = ½ ρ C_D A v², against the motion; rim patches feel nothing as they move along themselves.
    const SAMPLED: f64 = 0.02;
    let a = 0.1;
    let mut field = WindField::new(&[surface(0, plate(a, 5e-4))], 1, 1);
    for speed in [0.2, 1.0, 3.0] {
        let mut moving = body(DVec3::ZERO);
        moving.velocity = DVec3::Z * speed;
        let mut out = [[0.0; 6]];
        field.push(&[moving], None, &mut out);
        let expected = -0.5 * AIR_DENSITY * C_D * a * a * speed * speed;
        let found = linear(&out[0]);
        assert!((found.z / expected - 1.0).abs() < SAMPLED, "{} against {expected} at {speed} m/s", found.z);
        assert!(found.x.abs() + found.y.abs() < 1e-3 * expected.abs());
    }
}

#[test]
fn a_spinning_plate_is_braked_by_its_own_patches() {
    // About an axis in its plane: τ = −½ ρ C_D ω² ∫ |x|³ dA = −½ ρ C_D ω² a · 2 (a/2)⁴/4.
    const SAMPLED: f64 = 0.05;
    let (a, spin) = (0.1, 5.0);
    let mut field = WindField::new(&[surface(0, plate(a, 5e-4))], 1, 1);
    let mut turning = body(DVec3::ZERO);
    turning.angular_velocity = DVec3::Y * spin;
    let mut out = [[0.0; 6]];
    field.push(&[turning], None, &mut out);
    let h = 0.5 * a;
    let expected = -0.5 * AIR_DENSITY * C_D * spin * spin * a * 2.0 * h * h * h * h / 4.0;
    assert!((out[0][4] / expected - 1.0).abs() < SAMPLED, "{} against {expected}", out[0][4]);
}

#[test]
fn a_breath_never_pushes_harder_than_its_momentum_flow() {
    // A wall before the lips: without the bound a plate this large would take more than the breath carries.
    for speed in [3.8, 8.9, 17.0] {
        let mut field = WindField::new(&[surface(0, plate(0.6, 1e-3))], 1, 1);
        let mut out = [[0.0; 6]];
        let report = field.push(&[body(DVec3::ZERO)], Some(&breath(speed)), &mut out);
        let bound = jet(speed).momentum_flow();
        assert!(report.force.length() <= bound * (1.0 + 1e-12), "{} N of {bound} N", report.force.length());
        assert!(report.force.z < -0.3 * bound, "a breath into a wall gives most of what it has");
    }
}

#[test]
fn a_plate_behind_another_feels_no_breath() {
    let surfaces = [surface(0, plate(0.3, 1e-3)), surface(1, plate(0.05, 1e-3))];
    let mut field = WindField::new(&surfaces, 2, 1);
    let mut pushed = |screen: DVec3| {
        let mut out = [[0.0; 6]; 2];
        field.push(&[body(screen), body(DVec3::new(0.0, 0.0, -0.1))], Some(&breath(8.9)), &mut out);
        linear(&out[1]).length()
    };
    let open = pushed(DVec3::new(1.0, 0.0, 0.0));
    assert!(open > 1e-4, "an open plate is pushed: {open} N");
    assert_eq!(pushed(DVec3::ZERO), 0.0, "a sheltered one is not");
}

#[test]
fn the_lee_side_and_the_air_behind_the_lips_are_still() {
    let mut field = WindField::new(&[surface(0, plate(0.1, 1e-3))], 1, 1);
    let mut out = [[0.0; 6]];
    field.push(&[body(DVec3::new(0.0, 0.0, 0.7))], Some(&breath(17.0)), &mut out);
    assert_eq!(linear(&out[0]), DVec3::ZERO);
}

#[test]
fn a_sheet_of_one_face_is_pushed_from_either_side() {
    let face =
        TriangleMesh { positions: plate(0.1, 0.0).positions[4..].to_vec(), triangles: vec![[0, 1, 3], [0, 3, 2]] };
    let shape = SurfaceShape::Mesh { mesh: face, per_area: 40_000.0, count: (200, 2000), sheet: true, seed: 3 };
    let sheet = Surface { shape, ..surface(0, TriangleMesh::default()) };
    let mut field = WindField::new(&[sheet], 1, 1);
    let mut force = |mouth: f64| {
        let mut breath = breath(8.9);
        breath.jet.mouth.z = mouth;
        breath.jet.direction.z = -mouth.signum();
        let mut out = [[0.0; 6]];
        field.push(&[body(DVec3::ZERO)], Some(&breath), &mut out);
        linear(&out[0]).z
    };
    let (front, back) = (force(0.5), force(-0.5));
    assert!(front < 0.0 && back > 0.0, "{front} N and {back} N");
}

#[test]
fn gusts_are_the_same_from_run_to_run_and_change_smoothly() {
    let at = |seed: u64, time: f64, x: f64| {
        let field = WindField::new(&[], 0, seed);
        field.air(&Breath { time, ..breath(8.9) }, DVec3::new(x, 0.0, 0.0)).length()
    };
    assert_eq!(at(5, 0.3, 0.0), at(5, 0.3, 0.0));
    assert_ne!(at(5, 0.3, 0.0), at(6, 0.3, 0.0));
    // Neighbours a millimetre or a step apart feel nearly the same gust.
    assert!((at(5, 0.3, 0.0) - at(5, 0.3, 0.001)).abs() < 0.05);
    assert!((at(5, 0.3, 0.0) - at(5, 0.3 + 1.0 / 240.0, 0.0)).abs() < 0.08);
    // Its mean is the jet's own speed: the noise has no bias over many eddies.
    let mean: f64 = (0..4000).map(|i| at(5, 0.1 * f64::from(i), 0.0)).sum::<f64>() / 4000.0;
    const BIAS: f64 = 0.05;
    assert!((mean / jet(8.9).center_speed(0.5, 8.9) - 1.0).abs() < BIAS, "{mean} m/s");
}

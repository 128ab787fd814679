//! The force of a breath on a square plate over its distance from the lips.
//!
//! `cargo run -p soffio-wind --example breath_on_a_plate`
//!
//! Near the lips the plate catches the whole jet, so the force is close to the momentum flow ρ Q U₀. Farther away the jet
//! is wider than the plate and passes it.

use soffio_geometry::TriangleMesh;
use soffio_geometry::bodies::{MassProperties, RigidBody};
use soffio_math::spatial::linear;
use soffio_math::{DMat3, DVec3, Pose};
use soffio_wind::breath::{Breath, SpreadLaw};
use soffio_wind::force::{BreathJet, TURBULENCE, WindField};
use soffio_wind::{Surface, SurfaceShape};

/// Side of the plate, m.
const SIDE: f64 = 0.1;
/// Speed of the air at the lips, m/s: a strong breath of an adult.
const SPEED: f64 = 10.0;

fn main() {
    let corner = |x: f64, y: f64| 0.5 * SIDE * DVec3::new(x, y, 0.0);
    let positions = vec![corner(-1.0, -1.0), corner(1.0, -1.0), corner(1.0, 1.0), corner(-1.0, 1.0)];
    let mesh = TriangleMesh { positions, triangles: vec![[0, 1, 2], [0, 2, 3]] };
    let shape = SurfaceShape::Mesh { mesh, per_area: 1e5, count: 100..=1000, sheet: true, seed: 1 };
    let plate = Surface { body: 0, node: "Plate".into(), shape, drag_normal: 1.17, drag_tangential: 0.02, gain: 1.0 };
    let mut air = WindField::new(&[plate], &[], &[], 1, 1);
    let still = MassProperties { mass: 0.1, center: DVec3::ZERO, inertia: DMat3::from_diagonal(DVec3::splat(1e-4)) };
    let bodies = [RigidBody::at_rest(still, Pose::IDENTITY)];

    let from = |distance: f64| Breath {
        mouth: distance * DVec3::Z,
        direction: DVec3::NEG_Z,
        lip_diameter: 0.01,
        speed: SPEED,
        law: SpreadLaw::Jet,
    };
    println!("momentum flow of the breath: {:.2} mN", 1e3 * from(1.0).momentum_flow(SPEED));
    println!("distance, cm   air speed on the axis, m/s   force, mN");
    for centimetres in [5, 10, 20, 30, 50, 70, 100] {
        let breath = from(f64::from(centimetres) / 100.0);
        let mut forces = [[0.0; 6]];
        air.apply_forces(
            &bodies,
            0.0,
            Some(&BreathJet { breath, jet_front: None, gain: 1.0, turbulence: TURBULENCE }),
            &mut forces,
        );
        let speed = breath.velocity(DVec3::ZERO).length();
        println!("{centimetres:>12}   {speed:>26.2}   {:>9.3}", 1e3 * linear(&forces[0]).length());
    }
}

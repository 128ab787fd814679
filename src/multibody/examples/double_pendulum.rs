//! A double pendulum: chaotic motion whose energy must stay the same.
//!
//! `cargo run -p soffio-multibody --example double_pendulum`

use soffio_geometry::bodies::{MassProperties, RigidBody};
use soffio_math::{DMat3, DQuat, DVec3, PI, Pose};
use soffio_multibody::articulation::{Anchor, Constraint, ConstraintKind};
use soffio_multibody::dynamics::forces::Damping;
use soffio_multibody::dynamics::{Articulation, Dynamics, Integrator, Settings, Solver};

/// Length of each rod, m, and its mass, kg.
const LENGTH: f64 = 0.5;
const MASS: f64 = 1.0;
const G: f64 = 9.81;
const DT: f64 = 1.0 / 240.0;

/// A rod that lies along x, its left end at `left`.
fn rod(left: f64) -> RigidBody {
    let across = MASS * LENGTH * LENGTH / 12.0;
    let inertia = DMat3::from_diagonal(DVec3::new(1e-3 * across, across, across));
    let properties = MassProperties { mass: MASS, center: DVec3::ZERO, inertia };
    let position = DVec3::new(left + 0.5 * LENGTH, 0.0, 0.0);
    RigidBody::at_rest(properties, Pose { rotation: DQuat::from_rotation_x(0.1 * PI), position })
}

/// The left end of a rod stays on a point of another rod, or of the world.
fn hinge(name: &str, rod: usize, other: Option<usize>) -> Constraint {
    let half = 0.5 * LENGTH * DVec3::X;
    let a = Anchor { body: Some(rod), point: -half };
    let b = Anchor { body: other, point: if other.is_some() { half } else { DVec3::ZERO } };
    Constraint::new(name, ConstraintKind::PointToPoint { a, b })
}

fn main() {
    let constraints = [hinge("nail", 0, None), hinge("joint", 1, Some(0))];
    let articulation = Articulation {
        bodies: vec![rod(0.0), rod(LENGTH)],
        damping: vec![Damping::default(); 2],
        constraints: &constraints,
        limits: &[],
        springs: &[],
        kinematic_bodies: &[],
        colliders: &[],
        pairs: Vec::new(),
    };
    let settings = Settings {
        gravity: G * DVec3::NEG_Y,
        friction: false,
        stabilization_time: 0.04,
        integrator: Integrator::Auto,
        solver: Solver::Sparse,
    };
    let mut dynamics = Dynamics::new(articulation, settings);
    let start = dynamics.energy();
    // Of the fall of both rods to their lowest place, J.
    let fall = MASS * G * (0.5 + 1.5) * LENGTH;
    let external = [[0.0; 6]; 2];
    let mut impacts = Vec::new();
    println!("time, s   end of the lower rod, m   energy drift   joint error, m");
    for second in 1..=20 {
        for _ in 0..240 {
            let restored = dynamics.step(DT, &external, &mut impacts);
            assert_eq!(restored, None, "every number is finite");
        }
        let end = dynamics.bodies[1].pose().point(0.5 * LENGTH * DVec3::X);
        let drift = (dynamics.energy() - start) / fall;
        println!("{second:>7}   {:>10.4} {:>10.4}   {drift:>14.1e}   {:>14.1e}", end.x, end.y, dynamics.joint_error());
    }
}

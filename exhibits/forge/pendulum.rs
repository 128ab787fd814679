//! The pendulum of a shelf clock: a steel rod with a brass bob on a bracket.
//!
//! A body that swings about a pivot has the period of a simple pendulum of length l = I/(m d), with I about the pivot
//! and d the depth of its centre of mass: T = 2π √(l/g). The position of the bob solves for l.

use soffio_math::{DQuat, DVec2, DVec3, PI};

use soffio_authoring::glb::Scene;
use soffio_authoring::piece::Piece;
use soffio_authoring::solid::revolve;
use soffio_authoring::stock_parts::{
    BRASS, Finishes, MM, ROUND, STEEL, bent_rod_stand, finishes, part, rod, write, y_to_z,
};

/// Period, s: 6720 beats an hour.
const PERIOD: f64 = 2.0 * 3600.0 / 6720.0;
/// Length of the simple pendulum of that period under 9.81 m/s²: 285.3 mm.
const LENGTH: f64 = 9.81 * PERIOD * PERIOD / (4.0 * PI * PI);
/// Height of the pivot above the floor, m.
const PIVOT: f64 = 400.0 * MM;
/// Radius of the bob, mm.
const BOB_RADIUS: f64 = 24.0;

/// The pendulum in its own frame, the pivot at the origin.
fn pendulum(finishes: &Finishes) -> Piece {
    let lens = [(0.0, -6.0), (10.0, -5.6), (18.0, -3.9), (BOB_RADIUS, 0.0), (18.0, 3.9), (10.0, 5.6), (0.0, 6.0)];
    let lens = revolve(&lens.map(|(r, y)| DVec2::new(r, y) * MM), 2 * ROUND);
    let with_bob = |depth: f64| {
        let (top, bottom) = (depth - BOB_RADIUS * MM, depth + BOB_RADIUS * MM);
        let (none, along) = (DVec3::ZERO, DQuat::IDENTITY);
        Piece {
            name: "Pendulum",
            parts: vec![
                part("Rod", rod(1.2 * MM, -top, 5.0 * MM), none, along, STEEL, finishes.steel),
                part("Bob", lens.clone(), -depth * DVec3::Y, y_to_z(), BRASS, finishes.brass),
                part("Nut", rod(3.0 * MM, -bottom - 5.0 * MM, -bottom), none, along, BRASS, finishes.brass),
            ],
            wires: Vec::new(),
            markers: Vec::new(),
        }
    };
    let length = |piece: &Piece| {
        let mass = piece.mass();
        mass.inertia_about(DVec3::ZERO).z_axis.z / (mass.mass * -mass.center.y)
    };
    // A rod longer by δ makes the pendulum longer by nearly δ.
    let depth = (0..40).fold(LENGTH, |depth, _| depth + LENGTH - length(&with_bob(depth)));
    with_bob(depth)
}

/// The model.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let pivot = PIVOT * DVec3::Y;
    let mut stand = bent_rod_stand(pivot + 8.0 * MM * DVec3::Y, DVec2::new(0.0, -70.0 * MM), finishes.black);
    let knife = part("Knife", rod(2.0 * MM, -9.0 * MM, 9.0 * MM), pivot, y_to_z(), STEEL, finishes.steel);
    stand.parts.push(knife);
    // A side view, so that the breath goes along the swing.
    let target = DVec3::new(0.0, 0.22, 0.0);
    let away = DVec3::new(PI / 3.0, 0.12, 0.62).normalize();
    write(scene, "Pendulum", &[(stand, DVec3::ZERO), (pendulum(&finishes), pivot)], target + 1.15 * away, target)
}

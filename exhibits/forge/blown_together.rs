//! Five beads on a tray under a hook: a breath assembles them into a chain.

use soffio_math::{DQuat, DVec2, DVec3, PI, rotation};

use soffio_authoring::glb::Scene;
use soffio_authoring::piece::Piece;
use soffio_authoring::solid::{revolve, revolve_ring};
use soffio_authoring::stock_parts::{MM, ROUND, STEEL, WOOD, bent_rod_stand, finishes, part, rod, write};

/// Height of the hook above the ground, m.
const HOOK: f64 = 400.0 * MM;
/// Height of the tray's floor above the ground, m.
const FLOOR: f64 = 10.0 * MM;
/// Radius of a bead, m.
const RADIUS: f64 = 19.0 * MM;
/// How far a bead's eyes protrude, m.
const EYE: f64 = 3.0 * MM;
/// Start positions of the beads, mm, and their rotations, rad.
const PLACES: [(f64, f64, f64); 5] =
    [(-72.0, 22.0, 0.4), (64.0, -38.0, 1.9), (4.0, 62.0, -0.8), (-18.0, -64.0, 2.6), (82.0, 34.0, -2.1)];
/// Names of each bead and of its parts: bead, ball, eyes, upper and lower eye.
const NAMES: [[&str; 5]; 5] = [
    ["Bead1", "Bead1Ball", "Bead1Eyes", "Bead1Top", "Bead1End"],
    ["Bead2", "Bead2Ball", "Bead2Eyes", "Bead2Top", "Bead2End"],
    ["Bead3", "Bead3Ball", "Bead3Eyes", "Bead3Top", "Bead3End"],
    ["Bead4", "Bead4Ball", "Bead4Eyes", "Bead4Top", "Bead4End"],
    ["Bead5", "Bead5Ball", "Bead5Eyes", "Bead5Top", "Bead5End"],
];

/// The model.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let (none, along) = (DVec3::ZERO, DQuat::IDENTITY);
    let mut stand = bent_rod_stand(HOOK * DVec3::Y, DVec2::new(0.0, -170.0 * MM), finishes.black);
    let floor = [(0.0, 0.0), (126.0, 0.0), (130.0, 3.0), (130.0, 10.0), (0.0, 10.0)];
    let floor = revolve(&floor.map(|(r, y)| DVec2::new(r, y) * MM), 2 * ROUND);
    let wall = [(122.0, 10.0), (130.0, 10.0), (130.0, 34.0), (128.0, 36.0), (124.0, 36.0), (122.0, 34.0)];
    let wall = revolve_ring(&wall.map(|(r, y)| DVec2::new(r, y) * MM), 2 * ROUND);
    stand.parts.push(part("TrayFloor", floor, none, along, STEEL, finishes.black));
    stand.parts.push(part("TrayWall", wall, none, along, STEEL, finishes.black));
    stand.markers.push(("TrayTop", DVec3::ZERO));
    let mut pieces = vec![(stand, none)];
    let bead = (0..=16).map(|k| {
        let (s, c) = soffio_math::sincos(PI * f64::from(k) / 16.0);
        DVec2::new(if k % 16 == 0 { 0.0 } else { RADIUS * s }, -RADIUS * c)
    });
    let bead = revolve(&bead.collect::<Vec<_>>(), ROUND);
    let thread = rod(1.2 * MM, -RADIUS - EYE, RADIUS + EYE).y_to_x();
    let colors = [finishes.red, finishes.white, finishes.blue, finishes.wood, finishes.red];
    for (([name, ball, eyes, top, end], (x, z, turn)), color) in NAMES.into_iter().zip(PLACES).zip(colors) {
        let lies = rotation(turn * DVec3::Y);
        let hold = (RADIUS + EYE) * (lies * DVec3::X);
        let piece = Piece {
            name,
            parts: vec![
                part(ball, bead.clone(), none, lies, WOOD, color),
                part(eyes, thread.clone(), none, lies, STEEL, finishes.steel),
            ],
            wires: Vec::new(),
            markers: vec![(top, -hold), (end, hold)],
        };
        pieces.push((piece, DVec3::new(x * MM, FLOOR + RADIUS, z * MM)));
    }
    let target = DVec3::new(0.0, 0.19, 0.0);
    write(scene, "Blown together", &pieces, target + 1.15 * DVec3::new(0.25, 0.42, 1.0).normalize(), target)
}

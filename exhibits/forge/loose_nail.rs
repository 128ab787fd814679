//! A pendulum on a bead that slides on a rail: a nail that is loose along the rail, and fixed again.

use soffio_math::{DQuat, DVec2, DVec3, PI, rotation};

use soffio_authoring::glb::Scene;
use soffio_authoring::piece::Piece;
use soffio_authoring::solid::revolve;
use soffio_authoring::stock_parts::{BRASS, MM, ROUND, STEEL, WOOD, finishes, part, rod, slab, write};

/// Height of the rail above the floor, m.
const RAIL: f64 = 400.0 * MM;
/// Half length of the rail, m.
const HALF: f64 = 190.0 * MM;
/// Depth of the plate's centre under the rail, m.
const DEPTH: f64 = 210.0 * MM;

/// The model.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let (none, along) = (DVec3::ZERO, DQuat::IDENTITY);
    let lay = rotation(0.5 * PI * DVec3::Z);
    let flat = rotation(0.5 * PI * DVec3::X);
    let mut parts = vec![
        part("Rail", rod(2.5 * MM, -HALF - 12.0 * MM, HALF + 12.0 * MM), RAIL * DVec3::Y, lay, STEEL, finishes.steel),
        part("Base", slab(0.44, 0.14, 12.0 * MM), 6.0 * MM * DVec3::Y, flat, WOOD, finishes.black),
    ];
    for (name, x) in [("PostLeft", -HALF), ("PostRight", HALF)] {
        parts.push(part(name, rod(6.0 * MM, 8.0 * MM, RAIL + 8.0 * MM), x * DVec3::X, along, WOOD, finishes.black));
    }
    // Marker of the fixed nail.
    parts.push(part("Mark", rod(4.5 * MM, -2.0 * MM, 2.0 * MM), RAIL * DVec3::Y, lay, BRASS, finishes.brass));
    let stand = Piece { name: "Stand", parts, wires: Vec::new(), markers: vec![("Middle", RAIL * DVec3::Y)] };
    let bead = (0..=12).map(|k| {
        let (s, c) = soffio_math::sincos(PI * f64::from(k) / 12.0);
        DVec2::new(if k % 12 == 0 { 0.0 } else { 9.0 * s }, -9.0 * c) * MM
    });
    let plate = [(0.0, -2.0), (36.0, -2.0), (38.0, 0.0), (36.0, 2.0), (0.0, 2.0)];
    let plate = revolve(&plate.map(|(r, y)| DVec2::new(r, y) * MM), 2 * ROUND);
    let pendulum = Piece {
        name: "Pendulum",
        parts: vec![
            part("Bead", revolve(&bead.collect::<Vec<_>>(), ROUND), none, along, WOOD, finishes.red),
            part("Rod", rod(1.2 * MM, -DEPTH + 30.0 * MM, 0.0), none, along, STEEL, finishes.steel),
            part("Plate", plate, -DEPTH * DVec3::Y, rotation(0.5 * PI * DVec3::Z), WOOD, finishes.blue),
        ],
        wires: Vec::new(),
        markers: Vec::new(),
    };
    let pieces = [(stand, none), (pendulum, RAIL * DVec3::Y)];
    // A side view, so that a breath goes along the rail.
    let target = DVec3::new(0.0, 0.22, 0.0);
    write(scene, "A loose nail", &pieces, target + 1.2 * DVec3::new(0.95, 0.18, 0.80).normalize(), target)
}

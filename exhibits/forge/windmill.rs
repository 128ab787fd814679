//! A windmill: a rotor with four vanes on the shaft of a head, which turns on its mast and carries a tail.

use soffio_math::{DQuat, DVec2, DVec3, PI, rotation};

use soffio_authoring::glb::Scene;
use soffio_authoring::piece::Piece;
use soffio_authoring::solid::revolve;
use soffio_authoring::stock_parts::{
    BRASS, MM, ROUND, STEEL, VanePlacement, WOOD, finishes, part, rod, slab, vane, write, y_to_z,
};

/// Height of the shaft above the floor, m.
const SHAFT: f64 = 330.0 * MM;
/// Distance from the mast's axis to the rotor, m.
const OVERHANG: f64 = 42.0 * MM;
/// Names of the vanes.
const VANES: [&str; 4] = ["Vane1", "Vane2", "Vane3", "Vane4"];

/// The model: the shaft is the z axis of head and rotor, the mast the y axis.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let (none, upright) = (DVec3::ZERO, DQuat::IDENTITY);
    let mast =
        [(0.0, 0.0), (66.0, 0.0), (68.0, 3.0), (22.0, 16.0), (9.0, 60.0), (5.5, 300.0), (5.5, 319.0), (0.0, 319.0)];
    let mast = revolve(&mast.map(|(r, y)| DVec2::new(r, y) * MM), 2 * ROUND);
    let stand = Piece {
        name: "Mast",
        parts: vec![part("Tower", mast, none, upright, WOOD, finishes.white)],
        wires: Vec::new(),
        markers: Vec::new(),
    };
    // Bored along z, its frame at the crossing of mast and shaft; the tail keeps the rotor's weight in balance.
    let sideways = rotation(0.5 * PI * DVec3::Y);
    let head = Piece {
        name: "Head",
        parts: vec![
            part("Nacelle", rod(9.0 * MM, -34.0 * MM, 34.0 * MM), none, y_to_z(), WOOD, finishes.wood),
            part("Boom", rod(1.6 * MM, -150.0 * MM, -34.0 * MM), none, y_to_z(), STEEL, finishes.steel),
            part(
                "TailVane",
                slab(56.0 * MM, 66.0 * MM, 1.0 * MM),
                -150.0 * MM * DVec3::Z,
                sideways,
                WOOD,
                finishes.red,
            ),
        ],
        wires: Vec::new(),
        markers: vec![("HeadShaft", OVERHANG * DVec3::Z)],
    };
    let mut parts = vec![part("Hub", rod(8.0 * MM, -6.0 * MM, 8.0 * MM), none, y_to_z(), BRASS, finishes.brass)];
    parts.extend(VANES.into_iter().enumerate().map(|(k, name)| {
        let size = [82.0 * MM, 30.0 * MM, 1.0 * MM];
        vane(
            name,
            size,
            VanePlacement { radius: 49.0 * MM, angle: 0.5 * PI * k as f64, pitch: 0.6 },
            WOOD,
            finishes.blue,
        )
    }));
    let rotor = Piece { name: "Rotor", parts, wires: Vec::new(), markers: Vec::new() };
    let top = SHAFT * DVec3::Y;
    let pieces = [(stand, none), (head, top), (rotor, top + OVERHANG * DVec3::Z)];
    write(scene, "Windmill", &pieces, DVec3::new(0.42, 0.36, 0.95), DVec3::new(0.0, 0.23, 0.0))
}

//! A wheel held at its centre alone: constraints determine its axis of rotation, which changes.

use soffio_math::{DQuat, DVec2, DVec3, PI};

use soffio_authoring::glb::Scene;
use soffio_authoring::piece::Piece;
use soffio_authoring::solid::revolve;
use soffio_authoring::stock_parts::{
    BRASS, MM, ROUND, VanePlacement, WOOD, finishes, part, ring, rod, vane, write, y_to_z,
};

/// Height of the wheel's centre above the floor, m.
const MIDDLE: f64 = 300.0 * MM;
/// Names of the vanes, as in the sidecar.
const VANES: [&str; 6] = ["Vane1", "Vane2", "Vane3", "Vane4", "Vane5", "Vane6"];

/// The model: the wheel's axle is the z axis of its node.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let none = DVec3::ZERO;
    let mut parts = vec![
        part("Rim", ring(74.0 * MM, 84.0 * MM, 8.0 * MM), none, y_to_z(), WOOD, finishes.red),
        part("Hub", rod(9.0 * MM, -9.0 * MM, 9.0 * MM), none, y_to_z(), BRASS, finishes.brass),
    ];
    let size = [67.0 * MM, 26.0 * MM, 1.5 * MM];
    parts.extend(VANES.into_iter().enumerate().map(|(k, name)| {
        let finish = if k % 2 == 0 { finishes.white } else { finishes.blue };
        vane(name, size, VanePlacement { radius: 41.5 * MM, angle: PI / 3.0 * k as f64, pitch: 0.6 }, WOOD, finish)
    }));
    let wheel = Piece { name: "Wheel", parts, wires: Vec::new(), markers: Vec::new() };
    // A bowl below it, outside the sphere that the rim can sweep.
    let bowl =
        [(0.0, 0.0), (70.0, 0.0), (74.0, 4.0), (30.0, 18.0), (14.0, 60.0), (16.0, 150.0), (22.0, 196.0), (0.0, 190.0)];
    let bowl = revolve(&bowl.map(|(r, y)| DVec2::new(r, y) * MM), 2 * ROUND);
    let stand = Piece {
        name: "Stand",
        parts: vec![part("Pedestal", bowl, none, DQuat::IDENTITY, WOOD, finishes.black)],
        wires: Vec::new(),
        markers: vec![("Middle", MIDDLE * DVec3::Y)],
    };
    let (eye, target) = (DVec3::new(0.33, 0.41, 0.90), DVec3::new(0.0, 0.195, 0.0));
    write(scene, "Wheel between two axes", &[(stand, none), (wheel, MIDDLE * DVec3::Y)], eye, target)
}

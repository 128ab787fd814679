//! A nail on a path: a swallow with a tail of three links moves along a figure of eight.

use soffio_math::{DQuat, DVec2, DVec3, PI, sin};

use soffio_authoring::glb::Scene;
use soffio_authoring::outline::{Knot, closed_spline, reversed};
use soffio_authoring::piece::{BentWire, Piece};
use soffio_authoring::solid::extrude;
use soffio_authoring::stock_parts::{MM, STEEL, WOOD, bent_rod_stand, finishes, part, rod, write};

/// Half width and half depth of the eight, m. The sidecar gives the nail's times.
const EIGHT: DVec2 = DVec2::new(150.0 * MM, 60.0 * MM);
/// Height of the eight above the floor, m.
const HEIGHT: f64 = 330.0 * MM;

/// The point of the path after a fraction of a round.
pub fn place(share: f64) -> DVec3 {
    let turn = 2.0 * PI * share;
    DVec3::new(EIGHT.x * sin(turn), HEIGHT, EIGHT.y * sin(2.0 * turn))
}

/// The model: the swallow hangs at its origin.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let (none, along) = (DVec3::ZERO, DQuat::IDENTITY);
    let top = DVec3::new(0.0, HEIGHT + 60.0 * MM, 0.0);
    let mut stand = bent_rod_stand(top, DVec2::new(0.0, -120.0 * MM), finishes.black);
    let rail = (0..=64).map(|k| place(f64::from(k) / 64.0) + 3.0 * MM * DVec3::Y).collect();
    stand.wires.push(BentWire { name: "EightRail", points: rail, radius: 1.0 * MM, density: STEEL });
    for (name, side) in [("StayLeft", -1.0), ("StayRight", 1.0)] {
        let end = place(0.25 * side) + 3.0 * MM * DVec3::Y;
        let points = (0..=6).map(|k| top + (end - top) * (f64::from(k) / 6.0)).collect();
        stand.wires.push(BentWire { name, points, radius: 0.8 * MM, density: STEEL });
    }
    let wings = [
        Knot::Corner(0.0, 34.0),
        Knot::Smooth(10.0, 18.0),
        Knot::Smooth(52.0, 6.0),
        Knot::Corner(86.0, -22.0),
        Knot::Smooth(44.0, -12.0),
        Knot::Smooth(12.0, -14.0),
        Knot::Corner(0.0, -34.0),
        Knot::Smooth(-12.0, -14.0),
        Knot::Smooth(-44.0, -12.0),
        Knot::Corner(-86.0, -22.0),
        Knot::Smooth(-52.0, 6.0),
        Knot::Smooth(-10.0, 18.0),
    ];
    let outline = reversed(closed_spline(&wings, 6).into_iter().map(|p| p * MM).collect());
    let assemble_tree = 46.0 * MM;
    let swallow = Piece {
        name: "Swallow",
        parts: vec![
            part("Thread", rod(0.6 * MM, -assemble_tree + 12.0 * MM, 0.0), none, along, STEEL, finishes.steel),
            part(
                "Wings",
                extrude(&outline, &[], 1.2 * MM, 0.2 * MM),
                -assemble_tree * DVec3::Y,
                along,
                WOOD,
                finishes.blue,
            ),
        ],
        wires: Vec::new(),
        markers: vec![("SwallowTail", -(assemble_tree + 34.0 * MM) * DVec3::Y)],
    };
    let mut pieces = vec![(stand, none), (swallow, place(0.0))];
    let mut hook = place(0.0) - (assemble_tree + 34.0 * MM) * DVec3::Y;
    for (name, stick, end, color) in [
        ("Tail1", "Tail1Stick", "Tail1End", finishes.white),
        ("Tail2", "Tail2Stick", "Tail2End", finishes.white),
        ("Tail3", "Tail3Stick", "Tail3End", finishes.red),
    ] {
        let way = -30.0 * MM * DVec3::Y;
        let piece = Piece {
            name,
            parts: vec![part(stick, rod(2.2 * MM, -28.0 * MM, -2.0 * MM), none, along, WOOD, color)],
            wires: Vec::new(),
            markers: vec![(end, way)],
        };
        pieces.push((piece, hook));
        hook += way;
    }
    let target = DVec3::new(0.0, 0.24, 0.0);
    write(scene, "A way of its own", &pieces, target + 1.1 * DVec3::new(0.15, 0.25, 1.0).normalize(), target)
}

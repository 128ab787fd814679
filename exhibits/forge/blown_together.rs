//! Five discs on a tray under a hook: what a breath gathers into a chain.

use soffio::math::{DQuat, DVec2, DVec3, rotation};

use super::glb::Scene;
use super::piece::Piece;
use super::solid::turned;
use super::stock::{MM, ROUND, STEEL, WOOD, finishes, gallows, part, write};

/// Height of the hook, and of the tray's floor.
const HOOK: f64 = 400.0 * MM;
const FLOOR: f64 = 10.0 * MM;
/// Of a disc.
const RADIUS: f64 = 26.0 * MM;
const THICKNESS: f64 = 7.0 * MM;
/// Where the discs lie at first, mm, and how each is turned, rad.
const PLACES: [(f64, f64, f64); 5] =
    [(-72.0, 22.0, 0.4), (64.0, -38.0, 1.9), (4.0, 62.0, -0.8), (-18.0, -64.0, 2.6), (82.0, 34.0, -2.1)];
const NAMES: [[&str; 4]; 5] = [
    ["Disc1", "Disc1Plate", "Disc1Top", "Disc1End"],
    ["Disc2", "Disc2Plate", "Disc2Top", "Disc2End"],
    ["Disc3", "Disc3Plate", "Disc3Top", "Disc3End"],
    ["Disc4", "Disc4Plate", "Disc4Top", "Disc4End"],
    ["Disc5", "Disc5Plate", "Disc5Top", "Disc5End"],
];

/// The model.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let (none, along) = (DVec3::ZERO, DQuat::IDENTITY);
    let mut stand = gallows(HOOK * DVec3::Y, DVec2::new(0.0, -170.0 * MM), finishes.black);
    let floor = [(0.0, 0.0), (126.0, 0.0), (130.0, 3.0), (130.0, 10.0), (0.0, 10.0)];
    let floor = turned(&floor.map(|(r, y)| DVec2::new(r, y) * MM), false, 2 * ROUND);
    let wall = [(122.0, 10.0), (130.0, 10.0), (130.0, 34.0), (128.0, 36.0), (124.0, 36.0), (122.0, 34.0)];
    let wall = turned(&wall.map(|(r, y)| DVec2::new(r, y) * MM), true, 2 * ROUND);
    stand.parts.push(part("TrayFloor", floor, none, along, STEEL, finishes.black));
    stand.parts.push(part("TrayWall", wall, none, along, STEEL, finishes.black));
    let mut pieces = vec![(stand, none)];
    let edge = 0.5 * MM;
    let half = 0.5 * THICKNESS;
    let disc = [
        (0.0, -half),
        (RADIUS - edge, -half),
        (RADIUS, edge - half),
        (RADIUS, half - edge),
        (RADIUS - edge, half),
        (0.0, half),
    ];
    let disc = turned(&disc.map(|(r, y)| DVec2::new(r, y)), false, ROUND);
    let colors = [finishes.red, finishes.white, finishes.blue, finishes.wood, finishes.red];
    for (([name, plate, top, end], (x, z, turn)), color) in NAMES.into_iter().zip(PLACES).zip(colors) {
        let way = rotation(turn * DVec3::Y) * DVec3::X;
        let hold = (RADIUS + 3.0 * MM) * way;
        let piece = Piece {
            name,
            parts: vec![part(plate, disc.clone(), none, along, WOOD, color)],
            bends: Vec::new(),
            marks: vec![(top, -hold), (end, hold)],
        };
        pieces.push((piece, DVec3::new(x * MM, FLOOR + half, z * MM)));
    }
    let target = DVec3::new(0.0, 0.19, 0.0);
    write(scene, "Blown together", &pieces, target + 1.15 * DVec3::new(0.25, 0.42, 1.0).normalize(), target)
}

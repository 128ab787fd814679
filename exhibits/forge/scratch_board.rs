//! A board of beech in a frame, and a quill with its nib on it.

use soffio_math::{DQuat, DVec2, DVec3, PI, cos, rotation, sin};

use soffio_authoring::glb::Scene;
use soffio_authoring::outline::{Knot, closed_spline};
use soffio_authoring::piece::Piece;
use soffio_authoring::solid::{extrude, revolve};
use soffio_authoring::stock_parts::{MM, ROUND, STEEL, WOOD, finishes, part, rod, slab, write};

/// Length, width and thickness of the board, m.
const SIZE: [f64; 3] = [360.0 * MM, 240.0 * MM, 12.0 * MM];
/// Height of the board's upper face, m.
const TOP: f64 = 40.0 * MM;
/// Radius of the nib, a ball whose centre is the origin of the quill, m.
const NIB: f64 = 1.5 * MM;
/// Tilt of the quill to the back, rad.
const LEAN: f64 = 0.42;
/// Length of the quill's shaft, m.
const SHAFT: f64 = 150.0 * MM;

/// The model.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let flat = rotation(0.5 * PI * DVec3::X);
    let (along, none) = (DQuat::IDENTITY, DVec3::ZERO);
    let [length, width, thickness] = SIZE;
    let mut parts = vec![part(
        "BoardPlank",
        slab(length, width, thickness),
        -0.5 * thickness * DVec3::Y,
        flat,
        WOOD,
        finishes.wood,
    )];
    let (rim, high) = (10.0 * MM, 10.0 * MM);
    for (name, size, x, z) in [
        ("RimFront", [length + 2.0 * rim, rim], 0.0, 0.5 * (width + rim)),
        ("RimBack", [length + 2.0 * rim, rim], 0.0, -0.5 * (width + rim)),
        ("RimLeft", [rim, width], -0.5 * (length + rim), 0.0),
        ("RimRight", [rim, width], 0.5 * (length + rim), 0.0),
    ] {
        let at = DVec3::new(x, 0.5 * (high - thickness), z);
        parts.push(part(name, slab(size[0], size[1], high + thickness), at, flat, WOOD, finishes.black));
    }
    let board = Piece { name: "Board", parts, wires: Vec::new(), markers: Vec::new() };
    let foot = part("Foot", slab(length, 0.18, 0.02), DVec3::new(0.0, 0.01, 0.0), flat, WOOD, finishes.black);
    let stand = Piece { name: "Stand", parts: vec![foot], wires: Vec::new(), markers: Vec::new() };

    // The quill is tilted to the back and to the right; its frame is upright.
    let lean = rotation(DVec3::new(-LEAN, 0.0, -0.6 * LEAN));
    let up = lean * DVec3::Y;
    let point = (0..=8).map(|k| {
        let (s, c) = (sin(PI * f64::from(k) / 8.0), cos(PI * f64::from(k) / 8.0));
        DVec2::new(if k % 8 == 0 { 0.0 } else { NIB * s }, -NIB * c)
    });
    let point = revolve(&point.collect::<Vec<_>>(), ROUND / 2);
    let vane = [
        Knot::Corner(0.0, 38.0),
        Knot::Smooth(13.0, 62.0),
        Knot::Smooth(17.0, 110.0),
        Knot::Smooth(9.0, 158.0),
        Knot::Corner(0.0, 182.0),
        Knot::Smooth(-9.0, 150.0),
        Knot::Smooth(-14.0, 100.0),
        Knot::Smooth(-9.0, 58.0),
    ];
    let outline = closed_spline(&vane, 8).into_iter().map(|p| p * MM).collect();
    let quill = Piece {
        name: "Quill",
        parts: vec![
            part("Nib", point, none, along, STEEL, finishes.steel),
            part("Shaft", rod(1.3 * MM, 0.5 * NIB, SHAFT), none, lean, WOOD, finishes.white),
            part("Feather", extrude(&outline, &[], 0.5 * MM, 0.06 * MM), 0.9 * MM * up, lean, 300.0, finishes.blue),
        ],
        wires: Vec::new(),
        markers: Vec::new(),
    };
    let stands = DVec3::new(-60.0 * MM, TOP + NIB, 30.0 * MM);
    let pieces = [(stand, none), (board, TOP * DVec3::Y), (quill, stands)];
    let target = DVec3::new(0.0, 0.075, 0.0);
    write(scene, "A board to scratch", &pieces, target + 0.95 * DVec3::new(0.1, 0.62, 1.0).normalize(), target)
}

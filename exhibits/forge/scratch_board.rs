//! A board of pine in a frame, with the rings of its years drawn on it, and a quill with its nib on it.

use image::{Rgb, RgbImage};
use soffio_math::noise::perlin3;
use soffio_math::{DQuat, DVec2, DVec3, PI, cos, rotation, sin};

use soffio_authoring::glb::{Finish, Picture, Scene};
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
/// Pixels of the board's picture for each metre: 0.4 mm a pixel, a third of the nib.
const PIXELS: f64 = 2500.0;
/// Distance of two years' rings, m: a fast-grown softwood, so that each ring is heard by itself under a slow nib.
const YEAR: f64 = 6.0 * MM;
/// Distance of the tree's axis below the board's lower edge, m.
const PITH: f64 = 260.0 * MM;
/// Seed of the grain.
const GRAIN: u64 = 7;

/// The face of the board: rings about an axis below its lower edge, a little bent along the trunk. Each year begins light and ends
/// dark, and fine fibres run along it.
fn rings() -> Picture {
    let [length, width, _] = SIZE;
    let [columns, rows] = [length, width].map(|side| (side * PIXELS) as u32);
    let pixels = RgbImage::from_fn(columns, rows, |i, j| {
        let x = (f64::from(i) + 0.5) / PIXELS - 0.5 * length;
        let y = 0.5 * width - (f64::from(j) + 0.5) / PIXELS;
        let bend = 9.0 * MM * perlin3(DVec3::new(x / 0.19, y / 0.11, 0.5), GRAIN);
        let (above, along) = (y + 0.5 * width + PITH + bend, 0.35 * x);
        let from_axis = (above * above + along * along).sqrt();
        let year = from_axis / YEAR;
        let part = year - year.floor();
        let late = part * part * part;
        let fibre = perlin3(DVec3::new(x / (14.0 * MM), y / (0.9 * MM), 2.5), GRAIN + 1);
        let light = (1.0 - 0.52 * late + 0.05 * fibre).clamp(0.0, 1.0);
        Rgb([1.0, 0.80 + 0.2 * light * light, 0.62 + 0.38 * light * light]
            .map(|tone| (255.0 * light * tone).round() as u8))
    });
    Picture { pixels, size: [length, width] }
}

/// The model.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let face = scene.finish(&Finish {
        name: "Planed pine",
        color: [0.78, 0.56, 0.33],
        metallic: 0.0,
        roughness: 0.6,
        finish: Some("pine"),
    });
    scene.picture(face, &rings()).expect("a picture in memory");
    let flat = rotation(0.5 * PI * DVec3::X);
    let (along, none) = (DQuat::IDENTITY, DVec3::ZERO);
    let [length, width, thickness] = SIZE;
    let mut parts =
        vec![part("BoardPlank", slab(length, width, thickness), -0.5 * thickness * DVec3::Y, flat, WOOD, face)];
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

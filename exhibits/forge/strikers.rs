//! A bell, a drum, a casting and a piece of wood in a row, and a mallet in front of each: a breath makes the mallets
//! hit.
//!
//! Front view (mm): the rail is 400 high, the mallets' heads 150 below it, the instruments' faces 24 behind the heads.

use soffio_math::{DQuat, DVec2, DVec3, PI, rotation};

use soffio_authoring::glb::Scene;
use soffio_authoring::piece::{Part, Piece};
use soffio_authoring::solid::revolve;
use soffio_authoring::stock_parts::{
    BRASS, Finishes, MM, ROUND, STEEL, WOOD, finishes, part, rod, slab, write, y_to_z,
};

/// Height of the rail above the floor, m.
const RAIL: f64 = 400.0 * MM;
/// Distance from the rail down to the centre of a mallet's head, m.
const HEAD: f64 = 150.0 * MM;
/// Radius of a mallet's head, m.
const RADIUS: f64 = 11.0 * MM;
/// Gap between head and instrument at rest, m.
const GAP: f64 = 24.0 * MM;
/// Distance between the centres of neighbours, m.
const PITCH: f64 = 135.0 * MM;
/// Depth of the instruments' faces behind the mallets' plane, m.
const FACE: f64 = -(RADIUS + GAP);

/// A ball of beech about the origin.
fn ball(radius: f64) -> soffio_authoring::solid::Solid {
    let arc = (0..=12).map(|k| {
        let (s, c) = soffio_math::sincos(PI * f64::from(k) / 12.0);
        DVec2::new(if k % 12 == 0 { 0.0 } else { radius * s }, -radius * c)
    });
    revolve(&arc.collect::<Vec<_>>(), ROUND)
}

/// A mallet in its own frame, hanging at the origin: stick, head, and a sail below it.
fn mallet(names: [&'static str; 4], finishes: &Finishes, color: usize) -> Piece {
    let [name, stick, head, sail] = names;
    let (none, along) = (DVec3::ZERO, DQuat::IDENTITY);
    let sail_at = -(HEAD + 52.0 * MM) * DVec3::Y;
    Piece {
        name,
        parts: vec![
            part(stick, rod(1.6 * MM, -HEAD - 24.0 * MM, 4.0 * MM), none, along, WOOD, finishes.wood),
            part(head, ball(RADIUS), -HEAD * DVec3::Y, along, WOOD, finishes.wood),
            part(sail, slab(66.0 * MM, 56.0 * MM, 0.8 * MM), sail_at, along, WOOD, color),
        ],
        wires: Vec::new(),
        markers: Vec::new(),
    }
}

fn instrument(name: &'static str, parts: Vec<Part>) -> Piece {
    Piece { name, parts, wires: Vec::new(), markers: Vec::new() }
}

/// The four instruments, their frames at the heads' height in the plane of their faces.
fn instruments(finishes: &Finishes) -> [Piece; 4] {
    let (none, along) = (DVec3::ZERO, DQuat::IDENTITY);
    let bell = [(44.0, -38.0), (42.0, -34.0), (30.0, -18.0), (23.0, 6.0), (20.0, 26.0), (14.0, 34.0), (0.0, 36.0)];
    let inside = [(0.0, 32.0), (11.0, 30.0), (16.5, 24.0), (19.5, 6.0), (26.0, -17.0), (38.0, -33.0), (40.0, -38.0)];
    // Profile from the axis inside, around the mouth, to the axis outside: the material is on the left.
    let bell: Vec<DVec2> = inside.iter().chain(&bell).map(|&(r, y)| DVec2::new(r, y) * MM).collect();
    let bell = revolve(&bell, 2 * ROUND);
    let drum = rod(52.0 * MM, -64.0 * MM, 0.0);
    let skin = rod(50.0 * MM, 0.0, 0.6 * MM);
    let metal = [(0.0, -9.0), (44.0, -9.0), (46.0, -7.0), (46.0, 0.0), (36.0, 0.0), (34.0, -2.0), (0.0, -2.0)];
    let metal = revolve(&metal.map(|(r, y)| DVec2::new(r, y) * MM), 2 * ROUND);
    [
        instrument("Bell", vec![part("Bell", bell, none, along, BRASS, finishes.brass)]),
        instrument(
            "Drum",
            vec![
                part("DrumShell", drum, none, y_to_z(), WOOD, finishes.red),
                part("DrumSkin", skin, none, y_to_z(), WOOD, finishes.white),
            ],
        ),
        instrument("Metal", vec![part("MetalPan", metal, none, y_to_z(), STEEL, finishes.steel)]),
        instrument(
            "Wood",
            vec![part(
                "WoodBlock",
                slab(96.0 * MM, 62.0 * MM, 26.0 * MM),
                -13.0 * MM * DVec3::Z,
                along,
                WOOD,
                finishes.wood,
            )],
        ),
    ]
}

/// Position of the k-th instrument and mallet along the rail, m.
fn at(k: usize) -> f64 {
    (k as f64 - 1.5) * PITCH
}

/// The rail on its posts, the base, and a leg behind each instrument.
fn stand(finishes: &Finishes) -> Piece {
    let along = DQuat::IDENTITY;
    let lay = rotation(0.5 * PI * DVec3::Z);
    let flat = rotation(0.5 * PI * DVec3::X);
    let half = 2.0 * PITCH;
    let back = FACE - 34.0 * MM;
    let mut parts = vec![
        part("Rail", rod(2.0 * MM, -half, half), RAIL * DVec3::Y, lay, STEEL, finishes.steel),
        part(
            "Base",
            slab(2.0 * half, 0.16, 14.0 * MM),
            DVec3::new(0.0, 7.0 * MM, -30.0 * MM),
            flat,
            WOOD,
            finishes.black,
        ),
        part(
            "PostLeft",
            rod(6.0 * MM, 10.0 * MM, RAIL + 8.0 * MM),
            DVec3::new(-half, 0.0, 0.0),
            along,
            WOOD,
            finishes.black,
        ),
        part(
            "PostRight",
            rod(6.0 * MM, 10.0 * MM, RAIL + 8.0 * MM),
            DVec3::new(half, 0.0, 0.0),
            along,
            WOOD,
            finishes.black,
        ),
    ];
    let height = RAIL - HEAD;
    for (k, (name, tall)) in [
        ("LegBell", RAIL - HEAD + 46.0 * MM),
        ("LegDrum", 206.0 * MM),
        ("LegMetal", 212.0 * MM),
        ("LegWood", 226.0 * MM),
    ]
    .into_iter()
    .enumerate()
    {
        // The bell's support is behind it.
        let behind = if k == 0 { back - 34.0 * MM } else { back };
        parts.push(part(
            name,
            rod(4.0 * MM, 10.0 * MM, tall),
            DVec3::new(at(k), 0.0, behind),
            along,
            STEEL,
            finishes.black,
        ));
    }
    let arm = rotation(0.5 * PI * DVec3::X);
    let bell_back = 44.0 * MM;
    parts.push(part(
        "BellArm",
        rod(3.0 * MM, back - 36.0 * MM, FACE - bell_back + 4.0 * MM),
        DVec3::new(at(0), height + 42.0 * MM, 0.0),
        arm,
        STEEL,
        finishes.black,
    ));
    Piece { name: "Stand", parts, wires: Vec::new(), markers: Vec::new() }
}

/// The model.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let height = RAIL - HEAD;
    let mut pieces = vec![(stand(&finishes), DVec3::ZERO)];
    let mallets = [
        ["MalletBell", "StickBell", "HeadBell", "SailBell"],
        ["MalletDrum", "StickDrum", "HeadDrum", "SailDrum"],
        ["MalletMetal", "StickMetal", "HeadMetal", "SailMetal"],
        ["MalletWood", "StickWood", "HeadWood", "SailWood"],
    ];
    let colors = [finishes.blue, finishes.white, finishes.red, finishes.blue];
    for (k, (thing, names)) in instruments(&finishes).into_iter().zip(mallets).enumerate() {
        // The bell is round: where the head touches it, it is 27 mm from its axis.
        let depth = if k == 0 { FACE - 24.5 * MM } else { FACE };
        pieces.push((thing, DVec3::new(at(k), height, depth)));
        pieces.push((mallet(names, &finishes, colors[k]), DVec3::new(at(k), RAIL, 0.0)));
    }
    let target = DVec3::new(0.0, 0.215, -0.02);
    let away = DVec3::new(0.62, 0.22, 1.0).normalize();
    write(scene, "Bell, drum, metal, wood", &pieces, target + 1.22 * away, target)
}

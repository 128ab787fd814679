//! Three equal puppets on one beam, each moved by another kind of motion, and two boards for the curves of their errors.
//!
//! Front view of a puppet (mm below its hook), left and right are symmetric:
//!
//! ```text
//!    0  hook of the beam, 140 to the next one
//!   55  end of the rod: crown
//!  100  neck; shoulder 24 aside
//!  162  hip, 13 aside
//!  212  knee
//!  262  sole
//! ```
//!
//! The shoes reach as far back as forward, so the shins hang upright.

use soffio_math::{DQuat, DVec2, DVec3, PI};

use soffio_authoring::glb::{Finish, Scene};
use soffio_authoring::piece::{BentWire, Part, Piece};
use soffio_authoring::solid::revolve;
use soffio_authoring::stock_parts::{Finishes, MM, ROUND, STEEL, WOOD, finishes, part, rod, slab, write, y_to_z};

/// Height of the hooks above the floor, m.
const HOOK: f64 = 425.0 * MM;
/// Distance of the hooks, m.
const APART: f64 = 140.0 * MM;
/// Length of the rod that a puppet hangs by, m.
const ROD: f64 = 55.0 * MM;
/// Points of a puppet from its crown, m, those aside on its right.
const SHOULDER: DVec3 = DVec3::new(24.0 * MM, -45.0 * MM, 0.0);
const HIP: DVec3 = DVec3::new(13.0 * MM, -107.0 * MM, 0.0);
/// Lengths of an arm, a thigh and a shin, m.
const ARM: f64 = 74.0 * MM;
const THIGH: f64 = 50.0 * MM;
const SHIN: f64 = 50.0 * MM;
/// Size of a board, m.
const BOARD: DVec3 = DVec3::new(190.0 * MM, 104.0 * MM, 4.0 * MM);
/// Centres of the boards, m aside and above the floor.
const BOARD_AT: [DVec3; 2] = [DVec3::new(-102.0 * MM, 76.0 * MM, 0.0), DVec3::new(102.0 * MM, 76.0 * MM, 0.0)];
/// Size of a chart, m.
pub const CHART: [f64; 2] = [174.0 * MM, 90.0 * MM];
/// Lines of a board between the lower and the upper edge of its chart: one for each factor of a thousand of its scale.
pub const LINES: usize = 5;

/// Names of a puppet's pieces and points.
struct Names {
    rod: [&'static str; 3],
    torso: [&'static str; 5],
    sides: [SideNames; 2],
}

/// Names on a side: each piece, its mesh, its next point; where arm and leg hang.
struct SideNames {
    sign: f64,
    arm: [&'static str; 3],
    thigh: [&'static str; 3],
    shin: [&'static str; 3],
    shoulder: &'static str,
    hip: &'static str,
}

macro_rules! names {
    ($of:literal) => {
        Names {
            rod: [concat!("Rod", $of), concat!("RodWire", $of), concat!("RodEnd", $of)],
            torso: [
                concat!("Torso", $of),
                concat!("Head", $of),
                concat!("Neck", $of),
                concat!("Chest", $of),
                concat!("Nose", $of),
            ],
            sides: [names!(-1.0, "Left", $of), names!(1.0, "Right", $of)],
        }
    };
    ($sign:literal, $side:literal, $of:literal) => {
        SideNames {
            sign: $sign,
            arm: [concat!("Arm", $side, $of), concat!("ArmStick", $side, $of), concat!("Hand", $side, $of)],
            thigh: [concat!("Thigh", $side, $of), concat!("ThighStick", $side, $of), concat!("Knee", $side, $of)],
            shin: [concat!("Shin", $side, $of), concat!("ShinStick", $side, $of), concat!("Foot", $side, $of)],
            shoulder: concat!("Shoulder", $side, $of),
            hip: concat!("Hip", $side, $of),
        }
    };
}

/// The puppets from left to right: moved by forces, by the rule of two bodies, by all places at once.
const PUPPETS: [Names; 3] = [names!("Forces"), names!("Rule"), names!("Places")];

fn ball(name: &'static str, radius: f64, center: DVec3, finish: usize) -> Part {
    let arc = (0..=12).map(|k| {
        let (s, c) = soffio_math::sincos(PI * f64::from(k) / 12.0);
        DVec2::new(if k % 12 == 0 { 0.0 } else { radius * s }, -radius * c)
    });
    part(name, revolve(&arc.collect::<Vec<_>>(), ROUND), center, DQuat::IDENTITY, WOOD, finish)
}

/// A limb that hangs from its origin.
fn limb(name: &'static str, length: f64, radius: f64, finish: usize) -> Part {
    part(name, rod(radius, 3.0 * MM - length, -3.0 * MM), DVec3::ZERO, DQuat::IDENTITY, WOOD, finish)
}

/// The pieces of a puppet that hangs from `hook`, m, in clothes of one finish.
fn puppet(names: &Names, hook: DVec3, clothes: usize, finishes: &Finishes) -> Vec<(Piece, DVec3)> {
    let crown = hook - ROD * DVec3::Y;
    let piece = |name, parts, markers| Piece { name, parts, wires: Vec::new(), markers };
    let [rod_name, wire, rod_end] = names.rod;
    let points = (0..=2).map(|k| -0.5 * f64::from(k) * ROD * DVec3::Y).collect();
    let hanger = Piece {
        name: rod_name,
        parts: Vec::new(),
        wires: vec![BentWire { name: wire, points, radius: 0.8 * MM, density: STEEL }],
        markers: vec![(rod_end, -ROD * DVec3::Y)],
    };
    let [torso_name, head, neck, chest, nose] = names.torso;
    let on = |side: &SideNames, point: DVec3| DVec3::new(side.sign * point.x, point.y, point.z);
    let along = DQuat::IDENTITY;
    let torso = piece(
        torso_name,
        vec![
            ball(head, 16.0 * MM, -16.0 * MM * DVec3::Y, finishes.wood),
            part(neck, rod(4.0 * MM, -42.0 * MM, -30.0 * MM), DVec3::ZERO, along, WOOD, finishes.wood),
            part(chest, slab(36.0 * MM, 66.0 * MM, 20.0 * MM), -73.0 * MM * DVec3::Y, along, WOOD, clothes),
            part(nose, rod(2.5 * MM, 14.0 * MM, 21.0 * MM), -16.0 * MM * DVec3::Y, y_to_z(), WOOD, clothes),
        ],
        names.sides.iter().flat_map(|side| [(side.shoulder, on(side, SHOULDER)), (side.hip, on(side, HIP))]).collect(),
    );
    let mut pieces = vec![(hanger, hook), (torso, crown)];
    for side in &names.sides {
        let ([arm, arm_stick, hand], [thigh, thigh_stick, knee], [shin, shin_stick, foot]) =
            (side.arm, side.thigh, side.shin);
        let hip = crown + on(side, HIP);
        let (palm, sole) = (6.5 * MM, slab(13.0 * MM, 28.0 * MM, 7.0 * MM));
        pieces.extend([
            (
                piece(
                    arm,
                    vec![limb(arm_stick, ARM, 4.5 * MM, clothes), ball(hand, palm, -ARM * DVec3::Y, finishes.wood)],
                    Vec::new(),
                ),
                crown + on(side, SHOULDER),
            ),
            (piece(thigh, vec![limb(thigh_stick, THIGH, 6.0 * MM, clothes)], vec![(knee, -THIGH * DVec3::Y)]), hip),
            (
                piece(
                    shin,
                    vec![
                        limb(shin_stick, SHIN, 5.0 * MM, finishes.wood),
                        part(foot, sole, -SHIN * DVec3::Y, y_to_z(), WOOD, finishes.black),
                    ],
                    Vec::new(),
                ),
                hip - THIGH * DVec3::Y,
            ),
        ]);
    }
    pieces
}

/// The frame: beam, posts, boards with their lines.
fn frame(finishes: &Finishes, grey: usize) -> Piece {
    const LINE_NAMES: [[&str; LINES + 2]; 2] = [
        ["LineA0", "LineA1", "LineA2", "LineA3", "LineA4", "LineA5", "LineA6"],
        ["LineB0", "LineB1", "LineB2", "LineB3", "LineB4", "LineB5", "LineB6"],
    ];
    let along = DQuat::IDENTITY;
    let half = 232.0 * MM;
    let post = |name, x: f64| {
        part(name, rod(5.0 * MM, 0.0, HOOK + 20.0 * MM), DVec3::new(x, 0.0, 0.0), along, STEEL, finishes.black)
    };
    let foot =
        |name, x: f64| part(name, rod(42.0 * MM, 0.0, 9.0 * MM), DVec3::new(x, 0.0, 0.0), along, STEEL, finishes.black);
    let peg = |name, k: f64| {
        part(name, rod(2.0 * MM, HOOK, HOOK + 8.0 * MM), k * APART * DVec3::X, along, STEEL, finishes.steel)
    };
    let beam = slab(2.0 * half + 20.0 * MM, 14.0 * MM, 14.0 * MM);
    let bar = rod(3.5 * MM, -half, half).y_to_x();
    let mut parts = vec![
        part("Beam", beam, (HOOK + 15.0 * MM) * DVec3::Y, along, WOOD, finishes.wood),
        part("Bar", bar, DVec3::new(0.0, BOARD_AT[0].y, -6.0 * MM), along, STEEL, finishes.black),
        post("LeftPost", -half),
        post("RightPost", half),
        foot("LeftFoot", -half),
        foot("RightFoot", half),
        peg("LeftPeg", -1.0),
        peg("MiddlePeg", 0.0),
        peg("RightPeg", 1.0),
    ];
    let front = 0.5 * BOARD.z;
    for ((board, at), lines) in ["BoardJoints", "BoardDeparture"].into_iter().zip(BOARD_AT).zip(LINE_NAMES) {
        parts.push(part(board, slab(BOARD.x, BOARD.y, BOARD.z), at, along, WOOD, finishes.white));
        for (k, name) in lines.into_iter().enumerate() {
            let up = CHART[1] * (k as f64 / (LINES + 1) as f64 - 0.5);
            let line = slab(CHART[0], 0.5 * MM, 0.3 * MM);
            parts.push(part(name, line, at + DVec3::new(0.0, up, front), along, STEEL, grey));
        }
    }
    let corner = |at: DVec3| at + DVec3::new(-0.5 * CHART[0], -0.5 * CHART[1], front);
    let mut markers = vec![("CornerJoints", corner(BOARD_AT[0])), ("CornerDeparture", corner(BOARD_AT[1]))];
    let hooks = ["HookForces", "HookRule", "HookPlaces"].into_iter().zip(hooks());
    markers.extend(hooks);
    Piece { name: "Frame", parts, wires: Vec::new(), markers }
}

/// The hooks from left to right, m.
fn hooks() -> [DVec3; 3] {
    [-1.0, 0.0, 1.0].map(|k| DVec3::new(k * APART, HOOK, 0.0))
}

/// The model: each piece hangs at its origin, and the hooks of the next ones have markers.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let ochre = scene.finish(&Finish {
        name: "Ochre paint",
        color: [0.55, 0.26, 0.02],
        metallic: 0.0,
        roughness: 0.4,
        finish: Some("paint"),
    });
    let grey = scene.finish(&Finish {
        name: "Grey paint",
        color: [0.35, 0.35, 0.35],
        metallic: 0.0,
        roughness: 0.6,
        finish: Some("paint-matt"),
    });
    let mut pieces = vec![(frame(&finishes, grey), DVec3::ZERO)];
    for ((names, hook), clothes) in PUPPETS.iter().zip(hooks()).zip([finishes.blue, finishes.red, ochre]) {
        pieces.extend(puppet(names, hook, clothes, &finishes));
    }
    let target = DVec3::new(0.0, 0.235, 0.0);
    let away = DVec3::new(0.0, 0.06, 1.0).normalize();
    write(scene, "Three motions", &pieces, target + 1.02 * away, target)
}

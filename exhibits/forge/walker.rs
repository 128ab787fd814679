//! A puppet on a stage, under a carriage that runs on a rail: it walks, looks and braces itself by springs in its joints.
//!
//! Front view (mm above the floor), left and right are symmetric:
//!
//! ```text
//!   ═══════ 302 ═══════  rail, 330 to each side
//!          290           swivel under the carriage: upper end of the torso's rod
//!          192           neck; the head turns about it
//!          187           shoulder, 21 aside
//!          126           hip, 12 aside
//!         ─── 24 ───     stage
//! ```
//!
//! A leg of two parts of length l, bent by δ at the knee and by δ/2 at the hip, reaches 2 l cos(δ/2) down. In the model δ is 0.5, and
//! the soles lie flat on the stage: the hips are 5 + 100 cos(0.25) mm above it.

use soffio_math::{DQuat, DVec2, DVec3, PI, rotation};

use soffio_authoring::glb::{Finish, Scene};
use soffio_authoring::piece::{BentWire, Part, Piece};
use soffio_authoring::solid::revolve;
use soffio_authoring::stock_parts::{Finishes, MM, ROUND, STEEL, WOOD, finishes, part, rod, slab, write, y_to_z};

/// Upper face of the stage, m.
const STAGE: f64 = 24.0 * MM;
/// Half of the bend of a knee in the model, rad.
const BEND: f64 = 0.25;
/// The neck above the hips, m.
const NECK: f64 = 66.0 * MM;
/// Shoulder and hip of the right side, m from the neck.
const SHOULDER: DVec3 = DVec3::new(21.0 * MM, -5.0 * MM, 0.0);
const HIP: DVec3 = DVec3::new(12.0 * MM, -NECK, 0.0);
/// Lengths, m.
const ROD: f64 = 98.0 * MM;
const ARM: f64 = 62.0 * MM;
const THIGH: f64 = 50.0 * MM;
const SHIN: f64 = 50.0 * MM;
/// Thickness of a shoe, which is round and lies along the foot, m.
const SHOE: f64 = 10.0 * MM;
/// Distance of the rail's ends from the middle, m.
const REACH: f64 = 330.0 * MM;
/// The rail above the swivel, m.
const SWIVEL: f64 = 12.0 * MM;

/// Height of the hips, m: the soles are on the stage.
fn hip_height() -> f64 {
    STAGE + 0.5 * SHOE + (THIGH + SHIN) * soffio_math::cos(BEND)
}

fn ball(name: &'static str, radius: f64, center: DVec3, finish: usize) -> Part {
    let arc = (0..=12).map(|k| {
        let (s, c) = soffio_math::sincos(PI * f64::from(k) / 12.0);
        DVec2::new(if k % 12 == 0 { 0.0 } else { radius * s }, -radius * c)
    });
    part(name, revolve(&arc.collect::<Vec<_>>(), ROUND), center, DQuat::IDENTITY, WOOD, finish)
}

/// A limb that hangs from its origin, `forward` by this angle, rad.
fn limb(name: &'static str, length: f64, radius: f64, forward: f64, finish: usize) -> Part {
    part(name, rod(radius, 2.5 * MM - length, -2.5 * MM), DVec3::ZERO, rotation(-forward * DVec3::X), WOOD, finish)
}

fn piece(name: &'static str, parts: Vec<Part>, markers: Vec<(&'static str, DVec3)>) -> Piece {
    Piece { name, parts, wires: Vec::new(), markers }
}

/// Names of the pieces of a side: arm, thigh, shin, each with its mesh and its end.
struct Side {
    sign: f64,
    arm: [&'static str; 3],
    thigh: [&'static str; 3],
    shin: [&'static str; 3],
    shoulder: &'static str,
    hip: &'static str,
}

const SIDES: [Side; 2] = [
    Side {
        sign: -1.0,
        arm: ["ArmRight", "ArmRightStick", "HandRight"],
        thigh: ["ThighRight", "ThighRightStick", "KneeRight"],
        shin: ["ShinRight", "ShinRightStick", "ShoeRight"],
        shoulder: "ShoulderRight",
        hip: "HipRight",
    },
    Side {
        sign: 1.0,
        arm: ["ArmLeft", "ArmLeftStick", "HandLeft"],
        thigh: ["ThighLeft", "ThighLeftStick", "KneeLeft"],
        shin: ["ShinLeft", "ShinLeftStick", "ShoeLeft"],
        shoulder: "ShoulderLeft",
        hip: "HipLeft",
    },
];

/// Head, torso, arms and legs; it faces the visitor.
fn puppet(finishes: &Finishes, green: usize) -> Vec<(Piece, DVec3)> {
    let neck = (hip_height() + NECK) * DVec3::Y;
    let along = DQuat::IDENTITY;
    let face = 17.0 * MM;
    let eye = |name, side: f64| ball(name, 2.4 * MM, DVec3::new(side * 6.0 * MM, 24.0 * MM, 15.5 * MM), finishes.black);
    let head = piece(
        "Head",
        vec![
            ball("HeadBall", face, 20.0 * MM * DVec3::Y, finishes.wood),
            part("Nose", rod(3.0 * MM, 15.0 * MM, 25.0 * MM), 18.0 * MM * DVec3::Y, y_to_z(), WOOD, finishes.red),
            eye("EyeLeft", 1.0),
            eye("EyeRight", -1.0),
            part("HatBrim", rod(21.0 * MM, 30.0 * MM, 32.5 * MM), DVec3::ZERO, along, WOOD, finishes.black),
            part("HatCrown", rod(13.0 * MM, 32.0 * MM, 46.0 * MM), DVec3::ZERO, along, WOOD, finishes.black),
        ],
        Vec::new(),
    );
    let on = |side: &Side, point: DVec3| DVec3::new(side.sign * point.x, point.y, point.z);
    let markers = SIDES.iter().flat_map(|side| [(side.shoulder, on(side, SHOULDER)), (side.hip, on(side, HIP))]);
    let points = (0..=2).map(|k| 0.5 * f64::from(k) * ROD * DVec3::Y).collect();
    let torso = Piece {
        name: "Torso",
        parts: vec![
            part("Chest", slab(34.0 * MM, 56.0 * MM, 22.0 * MM), -33.0 * MM * DVec3::Y, along, WOOD, green),
            part("Collar", rod(5.0 * MM, -8.0 * MM, 2.0 * MM), DVec3::ZERO, along, WOOD, finishes.wood),
        ],
        wires: vec![BentWire { name: "RodWire", points, radius: 0.8 * MM, density: STEEL }],
        markers: markers.chain([("TorsoTop", ROD * DVec3::Y)]).collect(),
    };
    let mut pieces = vec![(torso, neck), (head, neck)];
    for side in &SIDES {
        let ([arm, arm_stick, hand], [thigh, thigh_stick, knee], [shin, shin_stick, shoe]) =
            (side.arm, side.thigh, side.shin);
        let hip = neck + on(side, HIP);
        let arm_parts =
            vec![limb(arm_stick, ARM, 4.5 * MM, 0.0, green), ball(hand, 6.0 * MM, -ARM * DVec3::Y, finishes.wood)];
        pieces.push((piece(arm, arm_parts, Vec::new()), neck + on(side, SHOULDER)));
        let thigh_parts = vec![limb(thigh_stick, THIGH, 6.0 * MM, BEND, finishes.blue)];
        let to_knee = rotation(-BEND * DVec3::X) * (-THIGH * DVec3::Y);
        pieces.push((piece(thigh, thigh_parts, vec![(knee, to_knee)]), hip));
        let sole = rod(0.5 * SHOE, -14.0 * MM, 14.0 * MM);
        let shoe_at = rotation(BEND * DVec3::X) * (-SHIN * DVec3::Y) + 5.0 * MM * DVec3::Z;
        let shin_parts = vec![
            limb(shin_stick, SHIN, 5.0 * MM, -BEND, finishes.blue),
            part(shoe, sole, shoe_at, y_to_z(), WOOD, finishes.black),
        ];
        pieces.push((piece(shin, shin_parts, Vec::new()), hip + to_knee));
    }
    pieces
}

/// The stage and the rail.
fn stage(finishes: &Finishes, boards: usize) -> Piece {
    let along = DQuat::IDENTITY;
    let rail = hip_height() + NECK + ROD + SWIVEL;
    let post = |name, x: f64| {
        part(name, rod(4.0 * MM, STAGE, rail + 4.0 * MM), DVec3::new(x, 0.0, -28.0 * MM), along, STEEL, finishes.black)
    };
    let arm = |name, x: f64| {
        let solid = slab(8.0 * MM, 8.0 * MM, 36.0 * MM);
        part(name, solid, DVec3::new(x, rail, -14.0 * MM), along, STEEL, finishes.black)
    };
    let floor = slab(2.0 * REACH + 40.0 * MM, STAGE, 130.0 * MM);
    piece(
        "Stage",
        vec![
            part("Floor", floor, 0.5 * STAGE * DVec3::Y, along, WOOD, boards),
            part("Rail", rod(3.0 * MM, -REACH, REACH).y_to_x(), rail * DVec3::Y, along, STEEL, finishes.steel),
            post("LeftPost", -REACH),
            post("RightPost", REACH),
            arm("LeftArm", -REACH),
            arm("RightArm", REACH),
        ],
        vec![("RailEnd", DVec3::new(-REACH, rail, 0.0))],
    )
}

/// The model: each piece hangs at its origin, and the hooks of the next ones have markers.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let green = scene.finish(&Finish {
        name: "Green paint",
        color: [0.03, 0.22, 0.08],
        metallic: 0.0,
        roughness: 0.4,
        finish: Some("paint"),
    });
    let boards = scene.finish(&Finish {
        name: "Dark boards",
        color: [0.16, 0.09, 0.045],
        metallic: 0.0,
        roughness: 0.6,
        finish: Some("oak"),
    });
    let swivel_height = (hip_height() + NECK + ROD) * DVec3::Y;
    let along = DQuat::IDENTITY;
    let car = piece(
        "Car",
        vec![part("CarBlock", slab(38.0 * MM, 12.0 * MM, 16.0 * MM), DVec3::ZERO, along, STEEL, finishes.red)],
        vec![("CarUnder", -SWIVEL * DVec3::Y)],
    );
    let swivel = piece(
        "Swivel",
        vec![part("SwivelDisc", rod(9.0 * MM, 0.5 * MM, 4.5 * MM), DVec3::ZERO, along, STEEL, finishes.steel)],
        Vec::new(),
    );
    let mut pieces = vec![
        (stage(&finishes, boards), DVec3::ZERO),
        (car, swivel_height + SWIVEL * DVec3::Y),
        (swivel, swivel_height),
    ];
    pieces.extend(puppet(&finishes, green));
    let target = DVec3::new(0.0, 0.165, 0.0);
    let away = DVec3::new(0.12, 0.14, 1.0).normalize();
    write(scene, "Walker", &pieces, target + 0.98 * away, target)
}

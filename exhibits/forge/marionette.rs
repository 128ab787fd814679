//! A marionette after the Sicilian pupi, which are moved by rods instead of strings: a cross bar, a rod to the head,
//! one to each hand; limbs of beech joined by balls or hinges.
//!
//! Front view (mm), l and r are symmetric:
//!
//! ```text
//!          452 hook
//!   ───────┬───────  440 bar, 105 to each side
//!   │     340     │  top of the head
//!   │  36,290     │  shoulder         neck 298
//!   92,262 ─ 58,244   hand, elbow     waist 224
//!            11,196   hip             knee 134, sole 66
//! ```

use soffio_math::{DQuat, DVec2, DVec3, PI, rotation};

use soffio_authoring::glb::Scene;
use soffio_authoring::piece::{BentWire, Part, Piece};
use soffio_authoring::solid::revolve;
use soffio_authoring::stock_parts::{
    Finishes, MM, ROUND, STEEL, WOOD, bent_rod_stand, finishes, part, rod, slab, write, y_to_z,
};

/// Position of the hook that the bar hangs from, m.
const HOOK: DVec3 = DVec3::new(0.0, 452.0 * MM, 0.0);
/// Height of the bar below its hook, m.
const BAR: f64 = -12.0 * MM;
/// Positions of the hand rods on the bar, m to each side.
const BAR_END: f64 = 105.0 * MM;
/// Top of the head, m.
const CROWN: DVec3 = DVec3::new(0.0, 340.0 * MM, 0.0);
/// Joint of the neck, m.
const NECK: DVec3 = DVec3::new(0.0, 298.0 * MM, 0.0);
/// Joint of the waist, m.
const WAIST: DVec3 = DVec3::new(0.0, 224.0 * MM, 0.0);
/// Joint of the right shoulder, at +x, m.
const SHOULDER: DVec3 = DVec3::new(36.0 * MM, 290.0 * MM, 0.0);
/// Joint of the right elbow, m: 51 mm from the shoulder.
const ELBOW: DVec3 = DVec3::new(46.94 * MM, 240.2 * MM, 0.0);
/// Right hand, m.
const HAND: DVec3 = DVec3::new(78.94 * MM, 261.55 * MM, 0.0);
/// End of the rod to the right hand, m: the thread between is lengthened by its load.
const ROD_END: DVec3 = DVec3::new(79.2 * MM, 263.0 * MM, 0.0);
/// Joint of the right hip, m. The knees are slightly bent, so that forces on the feet do not hold the hips.
const HIP: DVec3 = DVec3::new(11.0 * MM, 196.0 * MM, 0.0);
/// Joint of the right knee, m.
const KNEE: DVec3 = DVec3::new(11.0 * MM, 132.85 * MM, 0.0);
/// Height of the ankle above the floor, m.
const ANKLE: f64 = 70.0 * MM;
/// Distance of the ankle behind the knee, m: the shin with its foot is balanced.
const BEHIND: f64 = 5.7 * MM;

/// The same point on one of the sides: −1 left, 1 right.
fn on(side: f64, point: DVec3) -> DVec3 {
    DVec3::new(side * point.x, point.y, point.z)
}

/// A limb from the origin along `to`, with a gap at each end.
fn limb(name: &'static str, to: DVec3, radius: f64, gap: f64, finish: usize) -> Part {
    let length = to.length();
    let solid = rod(radius, gap - length, -gap);
    part(name, solid, DVec3::ZERO, DQuat::from_rotation_arc(DVec3::NEG_Y, to / length), WOOD, finish)
}

/// A rod of wire from the origin along `to`.
fn led(name: &'static str, wire: &'static str, marker: &'static str, to: DVec3) -> Piece {
    let points = (0..=4).map(|k| to * (f64::from(k) / 4.0)).collect();
    let wires = vec![BentWire { name: wire, points, radius: 0.7 * MM, density: STEEL }];
    Piece { name, parts: Vec::new(), wires, markers: vec![(marker, to)] }
}

/// A ball of beech about `center`.
fn ball(name: &'static str, radius: f64, center: DVec3, finish: usize) -> Part {
    let arc = (0..=12).map(|k| {
        let (s, c) = soffio_math::sincos(PI * f64::from(k) / 12.0);
        DVec2::new(if k % 12 == 0 { 0.0 } else { radius * s }, -radius * c)
    });
    part(name, revolve(&arc.collect::<Vec<_>>(), ROUND), center, DQuat::IDENTITY, WOOD, finish)
}

fn bar(finishes: &Finishes) -> Piece {
    let along = DQuat::IDENTITY;
    let beam = rod(5.0 * MM, -BAR_END - 8.0 * MM, BAR_END + 8.0 * MM).y_to_x();
    let hand = rod(4.0 * MM, -40.0 * MM, 40.0 * MM);
    Piece {
        name: "Bar",
        parts: vec![
            part("BarBeam", beam, BAR * DVec3::Y, along, WOOD, finishes.wood),
            part("BarCross", hand, BAR * DVec3::Y, y_to_z(), WOOD, finishes.wood),
            part("BarPin", rod(1.5 * MM, BAR, 0.0), DVec3::ZERO, along, STEEL, finishes.steel),
        ],
        wires: Vec::new(),
        markers: vec![
            ("BarHook", DVec3::ZERO),
            ("BarMiddle", BAR * DVec3::Y),
            ("BarLeft", DVec3::new(-BAR_END, BAR, 0.0)),
            ("BarRight", DVec3::new(BAR_END, BAR, 0.0)),
        ],
    }
}

/// Names of the parts of a side.
struct Side {
    sign: f64,
    rod: [&'static str; 3],
    upper: [&'static str; 3],
    fore: [&'static str; 4],
    thigh: [&'static str; 3],
    shin: [&'static str; 3],
    hip: &'static str,
    shoulder: &'static str,
}

/// Signs and names of the left and of the right side.
const SIDES: [Side; 2] = [
    Side {
        sign: -1.0,
        rod: ["RodLeft", "RodLeftWire", "RodLeftEnd"],
        upper: ["UpperArmLeft", "UpperArmLeftStick", "ElbowLeft"],
        fore: ["ForearmLeft", "ForearmLeftStick", "HandLeftBall", "HandLeft"],
        thigh: ["ThighLeft", "ThighLeftStick", "KneeLeft"],
        shin: ["ShinLeft", "ShinLeftStick", "FootLeft"],
        hip: "HipLeft",
        shoulder: "ShoulderLeft",
    },
    Side {
        sign: 1.0,
        rod: ["RodRight", "RodRightWire", "RodRightEnd"],
        upper: ["UpperArmRight", "UpperArmRightStick", "ElbowRight"],
        fore: ["ForearmRight", "ForearmRightStick", "HandRightBall", "HandRight"],
        thigh: ["ThighRight", "ThighRightStick", "KneeRight"],
        shin: ["ShinRight", "ShinRightStick", "FootRight"],
        hip: "HipRight",
        shoulder: "ShoulderRight",
    },
];

/// The five pieces of a side at their positions.
fn side(names: &Side, finishes: &Finishes) -> Vec<(Piece, DVec3)> {
    let at = |point| on(names.sign, point);
    let way = |from, to| at(to) - at(from);
    let end = HOOK + DVec3::new(BAR_END, BAR, 0.0);
    let [rod_name, wire, rod_end] = names.rod;
    let [upper, upper_stick, elbow] = names.upper;
    let [fore, fore_stick, hand_ball, hand] = names.fore;
    let [thigh, thigh_stick, knee] = names.thigh;
    let [shin, shin_stick, foot] = names.shin;
    let piece = |name, parts, markers| Piece { name, parts, wires: Vec::new(), markers };
    let sleeve = finishes.red;
    let sole = slab(18.0 * MM, 40.0 * MM, 8.0 * MM);
    let sole_at = DVec3::new(0.0, ANKLE - KNEE.y, 9.0 * MM - BEHIND - KNEE.z);
    let down = DVec3::new(0.0, ANKLE - KNEE.y, -BEHIND - KNEE.z);
    vec![
        (led(rod_name, wire, rod_end, way(end, ROD_END)), at(end)),
        (
            piece(
                upper,
                vec![limb(upper_stick, way(SHOULDER, ELBOW), 6.5 * MM, 4.0 * MM, sleeve)],
                vec![(elbow, way(SHOULDER, ELBOW))],
            ),
            at(SHOULDER),
        ),
        (
            piece(
                fore,
                vec![
                    limb(fore_stick, way(ELBOW, HAND), 5.0 * MM, 3.0 * MM, sleeve),
                    ball(hand_ball, 8.0 * MM, way(ELBOW, HAND), finishes.wood),
                ],
                vec![(hand, way(ELBOW, HAND))],
            ),
            at(ELBOW),
        ),
        (
            piece(
                thigh,
                vec![limb(thigh_stick, way(HIP, KNEE), 8.0 * MM, 4.0 * MM, finishes.blue)],
                vec![(knee, way(HIP, KNEE))],
            ),
            at(HIP),
        ),
        (
            piece(
                shin,
                vec![
                    limb(shin_stick, down, 6.5 * MM, 4.0 * MM, finishes.blue),
                    part(foot, sole, sole_at, rotation(0.5 * PI * DVec3::X), WOOD, finishes.black),
                ],
                Vec::new(),
            ),
            at(KNEE),
        ),
    ]
}

/// The model: each piece hangs at its origin, and the hooks of the next ones have markers.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let along = DQuat::IDENTITY;
    let piece = |name, parts, markers| Piece { name, parts, wires: Vec::new(), markers };
    let head = piece(
        "Head",
        vec![
            ball("HeadBall", 19.0 * MM, -19.0 * MM * DVec3::Y, finishes.wood),
            part("Neck", rod(5.0 * MM, NECK.y - CROWN.y, -34.0 * MM), DVec3::ZERO, along, WOOD, finishes.wood),
            part("Nose", rod(3.0 * MM, 17.0 * MM, 25.0 * MM), -19.0 * MM * DVec3::Y, y_to_z(), WOOD, finishes.red),
        ],
        vec![("HeadNeck", NECK - CROWN)],
    );
    let chest = slab(56.0 * MM, 68.0 * MM, 24.0 * MM);
    let mut torso_marks = vec![("TorsoWaist", WAIST - NECK)];
    torso_marks.extend(SIDES.iter().map(|side| (side.shoulder, on(side.sign, SHOULDER) - NECK)));
    let torso =
        piece("Torso", vec![part("Chest", chest, -37.0 * MM * DVec3::Y, along, WOOD, finishes.red)], torso_marks);
    let hips = slab(46.0 * MM, 22.0 * MM, 22.0 * MM);
    let markers = SIDES.iter().map(|side| (side.hip, on(side.sign, HIP) - WAIST)).collect();
    let pelvis = piece("Pelvis", vec![part("Hips", hips, -14.0 * MM * DVec3::Y, along, WOOD, finishes.blue)], markers);
    let mut pieces = vec![
        (bent_rod_stand(HOOK, DVec2::new(0.0, -110.0 * MM), finishes.black), DVec3::ZERO),
        (bar(&finishes), HOOK),
        (led("RodHead", "RodHeadWire", "RodHeadEnd", CROWN - HOOK - BAR * DVec3::Y), HOOK + BAR * DVec3::Y),
        (head, CROWN),
        (torso, NECK),
        (pelvis, WAIST),
    ];
    pieces.extend(SIDES.iter().flat_map(|names| side(names, &finishes)));
    let target = DVec3::new(0.0, 0.25, 0.0);
    let away = DVec3::new(0.30, 0.10, 1.0).normalize();
    write(scene, "Marionette", &pieces, target + 1.25 * away, target)
}

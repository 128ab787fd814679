//! A wooden clock that breath winds: a windmill, four pairs of wheels and a differential raise the weight that drives it.
//!
//! The going train, the escapement and the hands are those of the clock after Eli Terry (`terry_clock`). On the great
//! wheel's arbor three wheels rotate independently: the great wheel A, the drum D with the cord, and the winding wheel
//! B. Planets on the drum mesh with both wheels:
//!
//! ```text
//! ω_A + ω_B = 2 ω_D          half of the drum's torque τ = m g r goes to each wheel, wound or not
//! v = r ω_D                  speed of the weight, downwards
//! rotor 16 → 64 third 6 → 60 second 8 → 64 first 8 → 64 winding wheel B        2560 : 1
//! ```
//!
//! A ratchet keeps the winding train from running back; while it stands, the drum rotates at half the speed of the
//! great wheel. With m = 2.494 kg, r = 20 mm and eight hours for a turn of the great wheel, the weight descends by 7.9
//! mm an hour: 53 µW.

use soffio_math::{DQuat, DVec2, DVec3, PI, Pose, rotation};

use super::terry_clock as clock;
use super::terry_clock::{CANNON, GREAT, HOUR, MINUTE, THIRD, TIP, TOOTH};
use super::terry_layout::{
    BACK, CENTER, DRUM, ESCAPING, FRONT, MIDDLE, MODULE, MOTION, SWING, ToothCounts, WHEEL, along_z, flat, piece,
    toward, wheel,
};
use soffio_authoring::glb::Scene;
use soffio_authoring::outline::{Polygon, ellipse};
use soffio_authoring::piece::Piece;
use soffio_authoring::stock_parts::{
    BRASS, Finishes, LEAD, MM, STEEL, VanePlacement, WOOD, finishes, meshing_phase, part, rod, slab, spur_gear, vane,
    y_to_z,
};

/// Teeth of the winding train, each pair from the slower wheel to the faster pinion.
pub const WINDING: [ToothCounts; 4] = [
    ToothCounts { wheel: 64, pinion: 8 },
    ToothCounts { wheel: 64, pinion: 8 },
    ToothCounts { wheel: 60, pinion: 6 },
    ToothCounts { wheel: 64, pinion: 16 },
];
/// Direction of each arbor from the previous one, unit, in the plane of the plates: laid out so that no wheel meets
/// another arbor.
const STEPS: [(f64, f64); 4] = [(-0.995, 0.0998), (-0.6, 0.8), (-0.8, 0.6), (-0.94, 0.341_174_442)];
/// Layer of the winding wheel: its centre along z, m.
const WIND: f64 = -6.0 * MM;
/// Layer of the wheels that drive the winding wheel, m.
const BEHIND: f64 = -14.0 * MM;
/// Layer of the rotor, m: in front of the pendulum.
const SAILS: f64 = 60.0 * MM;
/// Names of the rotor's vanes.
const SAIL_NAMES: [&str; 6] = ["Sail1", "Sail2", "Sail3", "Sail4", "Sail5", "Sail6"];
/// Height of the weight's centre at the start, m: it can descend by 30 mm.
const WEIGHT: f64 = 104.0 * MM;
/// Length of the simple pendulum that makes 6720 beats an hour at this clock's amplitude, m; without a leaf it swings
/// wider than Terry's.
const LENGTH: f64 = 290.3010 * MM;

/// Arbors of the winding train: winding wheel, first, second, third, rotor.
fn winding_places() -> [DVec3; 5] {
    let mut places = [clock::places()[0]; 5];
    for (k, (teeth, (x, y))) in WINDING.into_iter().zip(STEPS).enumerate() {
        places[k + 1] = places[k] + teeth.center_distance(MODULE) * DVec3::new(x, y, 0.0).normalize();
    }
    places
}

/// All parts between the great wheel's arbor and the breath.
fn winding(finishes: &Finishes) -> Vec<(Piece, DVec3)> {
    let places = winding_places();
    let wood = finishes.wood;
    let pinion = |k: usize, phase: f64| {
        let teeth = WINDING[k];
        let phase = meshing_phase(teeth.pinion, teeth.wheel, phase, toward(places[k], places[k + 1]));
        spur_gear(teeth.pinion, MODULE, 6.0 * MM, phase, &[])
    };
    let planet = |name, angle: f64| {
        let out = 13.0 * MM * DVec3::new(soffio_math::cos(angle), soffio_math::sin(angle), 0.0);
        let at = out + (BEHIND + 0.5 * MM) * DVec3::Z;
        part(name, spur_gear(12, 0.9 * MM, 5.0 * MM, 0.0, &[]), at, DQuat::IDENTITY, BRASS, finishes.brass)
    };
    let drum = piece(
        "Drum",
        vec![
            along_z("DrumBody", DRUM - 0.5 * MM, (BACK + 4.0 * MM, BEHIND - 4.0 * MM), WOOD, wood),
            planet("PlanetLeft", PI),
            planet("PlanetRight", 0.0),
        ],
    );
    let winding_wheel =
        piece("WindingWheel", vec![flat("WindingWheel", wheel(WINDING[0].wheel, 0.0), WIND, WOOD, wood)]);
    let first = piece(
        "WindingFirst",
        vec![
            flat("WindingFirst", wheel(WINDING[1].wheel, 0.0), BEHIND, WOOD, wood),
            flat("WindingFirstPinion", pinion(0, 0.0), WIND, WOOD, wood),
            along_z("WindingFirstArbor", 2.0 * MM, (-48.0 * MM, 0.0), WOOD, wood),
        ],
    );
    let second = piece(
        "WindingSecond",
        vec![
            flat("WindingSecond", wheel(WINDING[2].wheel, 0.0), WIND, WOOD, wood),
            flat("WindingSecondPinion", pinion(1, 0.0), BEHIND, WOOD, wood),
            along_z("WindingSecondArbor", 2.0 * MM, (-48.0 * MM, 0.0), WOOD, wood),
        ],
    );
    let third = piece(
        "WindingThird",
        vec![
            flat("WindingThird", wheel(WINDING[3].wheel, 0.0), BEHIND, WOOD, wood),
            flat("WindingThirdPinion", pinion(2, 0.0), WIND, WOOD, wood),
            along_z("WindingThirdArbor", 2.0 * MM, (-48.0 * MM, 0.0), WOOD, wood),
        ],
    );
    let mut parts = vec![
        flat("RotorPinion", pinion(3, 0.0), BEHIND, WOOD, wood),
        along_z("RotorShaft", 2.0 * MM, (-48.0 * MM, SAILS), STEEL, finishes.steel),
        along_z("RotorHub", 8.0 * MM, (SAILS - 6.0 * MM, SAILS + 8.0 * MM), BRASS, finishes.brass),
    ];
    for (k, name) in SAIL_NAMES.into_iter().enumerate() {
        let color = if k % 2 == 0 { finishes.red } else { finishes.blue };
        let mut sail = vane(
            name,
            [66.0 * MM, 34.0 * MM, 0.8 * MM],
            VanePlacement { radius: 42.0 * MM, angle: PI * k as f64 / 3.0, pitch: -0.6 },
            WOOD,
            color,
        );
        sail.place.position.z += SAILS;
        parts.push(sail);
    }
    let rotor = piece("Rotor", parts);
    [drum, winding_wheel, first, second, third, rotor]
        .into_iter()
        .zip([places[0], places[0], places[1], places[2], places[3], places[4]])
        .collect()
}

/// The going train, the escapement and the hands.
fn going(finishes: &Finishes) -> Vec<(Piece, Pose)> {
    let [great, minute, third, escape, arbor] = clock::places();
    let wood = finishes.wood;
    let at = |position: DVec3| Pose { rotation: DQuat::IDENTITY, position };
    let mut pieces: Vec<(Piece, Pose)> = Vec::new();
    let great_wheel = vec![
        flat("GreatWheel", wheel(GREAT.wheel, 0.0), BACK, WOOD, wood),
        along_z("GreatArbor", 3.0 * MM, (-48.0 * MM, 0.0), WOOD, wood),
    ];
    pieces.push((piece("GreatWheel", great_wheel), at(great)));
    let mut phase = meshing_phase(GREAT.pinion, GREAT.wheel, 0.0, toward(great, minute));
    let hand = |name, size, out, z, angle| clock::hand(name, size, out, z, angle, finishes.black);
    let minute_parts = vec![
        flat("MinuteArbor", wheel(MINUTE.wheel, 0.0), MIDDLE, WOOD, wood),
        flat("MinutePinion", spur_gear(GREAT.pinion, MODULE, 6.0 * MM, phase, &[]), BACK, WOOD, wood),
        along_z("CenterArbor", 2.2 * MM, (-48.0 * MM, 18.0 * MM), WOOD, wood),
        flat("Cannon", spur_gear(CANNON.wheel, MODULE, WHEEL, 0.0, &[]), MOTION, WOOD, wood),
        hand("MinuteHand", [88.0 * MM, 3.0 * MM], 34.0 * MM, 16.0 * MM, clock::minute_hand()),
    ];
    pieces.push((piece("MinuteArbor", minute_parts), at(minute)));
    phase = meshing_phase(MINUTE.pinion, MINUTE.wheel, 0.0, toward(minute, third));
    let third_parts = vec![
        flat("ThirdWheel", wheel(THIRD.wheel, 0.0), FRONT, WOOD, wood),
        flat("ThirdPinion", spur_gear(MINUTE.pinion, MODULE, 6.0 * MM, phase, &[]), MIDDLE, WOOD, wood),
        along_z("ThirdArbor", 2.0 * MM, (-48.0 * MM, 0.0), WOOD, wood),
    ];
    pieces.push((piece("ThirdWheel", third_parts), at(third)));
    let turned_by = clock::escape_phase();
    phase = meshing_phase(THIRD.pinion, THIRD.wheel, 0.0, toward(third, escape)) - turned_by;
    let tooth = DVec3::new(0.0, TIP - 1.5 * MM, ESCAPING);
    let escape_parts = vec![
        flat("EscapeWheel", clock::escape_wheel(), ESCAPING, BRASS, finishes.brass),
        flat("EscapePinion", spur_gear(THIRD.pinion, MODULE, 6.0 * MM, phase, &[]), FRONT, WOOD, wood),
        along_z("EscapeArbor", 1.8 * MM, (-48.0 * MM, 14.0 * MM), WOOD, wood),
        part("EscapeTooth", rod(TOOTH, -MM, MM), tooth, DQuat::IDENTITY, BRASS, finishes.brass),
    ];
    let turned = Pose { rotation: rotation(DVec3::Z * turned_by), position: escape };
    pieces.push((piece("EscapeWheel", escape_parts), turned));
    let pivot = arbor + DVec3::Z * SWING;
    pieces.push((clock::anchor(finishes), at(pivot)));
    pieces.push((clock::pendulum(finishes, LENGTH, false), at(pivot)));
    let minute_wheel_at = CENTER + 24.0 * MM * DVec3::new(-soffio_math::sin(0.9), -soffio_math::cos(0.9), 0.0);
    phase = meshing_phase(CANNON.pinion, CANNON.wheel, 0.0, toward(CENTER, minute_wheel_at));
    let motion_parts = vec![
        flat("MinuteWheel", spur_gear(CANNON.pinion, MODULE, WHEEL, phase, &[]), MOTION, WOOD, wood),
        flat("HourPinion", spur_gear(HOUR.wheel, 0.96 * MM, 6.0 * MM, 0.0, &[]), MOTION + 5.0 * MM, WOOD, wood),
    ];
    pieces.push((piece("MinuteWheel", motion_parts), at(minute_wheel_at)));
    phase = meshing_phase(HOUR.pinion, HOUR.wheel, 0.0, toward(minute_wheel_at, CENTER));
    let bore: Polygon = ellipse(DVec2::ZERO, DVec2::splat(3.0 * MM), 0.0, 32);
    let hour_parts = vec![
        flat("HourWheel", spur_gear(HOUR.pinion, 0.96 * MM, WHEEL, phase, &[bore]), MOTION + 5.0 * MM, WOOD, wood),
        hand("HourHand", [54.0 * MM, 4.0 * MM], 31.0 * MM, MOTION + 8.0 * MM, clock::hour_hand()),
    ];
    pieces.push((piece("HourWheel", hour_parts), at(CENTER)));
    pieces
}

/// The model; all arbors are parallel to z.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let places = winding_places();
    let pivot = clock::places()[4] + DVec3::Z * SWING;
    let upright = rotation(DVec3::Z * (0.5 * PI));
    let flat_down = rotation(0.5 * PI * DVec3::X);
    let plate = |name, size: [f64; 2], at: DVec3| {
        part(name, slab(size[0], size[1], 5.0 * MM), at - 48.0 * MM * DVec3::Z, upright, WOOD, finishes.white)
    };
    let weight_at = DVec3::new(places[0].x - DRUM, WEIGHT, -24.0 * MM);
    let post = |name, x: f64| {
        part(
            name,
            rod(5.0 * MM, 10.0 * MM, 0.30),
            DVec3::new(x, 0.0, -56.0 * MM),
            DQuat::IDENTITY,
            WOOD,
            finishes.black,
        )
    };
    let mut parts = vec![
        plate("BackPlate", [190.0 * MM, 159.0 * MM], CENTER),
        plate("WindingPlate", [150.0 * MM, 120.0 * MM], DVec3::new(-0.13, 0.375, -1.5 * MM)),
        part(
            "Floor",
            slab(0.40, 0.14, 12.0 * MM),
            DVec3::new(-0.04, 0.006, -10.0 * MM),
            flat_down,
            WOOD,
            finishes.black,
        ),
        part("AnchorCock", rod(4.0 * MM, -4.0 * MM, 4.0 * MM), pivot, y_to_z(), BRASS, finishes.brass),
        post("PostLeft", -0.17),
        post("PostRight", 0.06),
    ];
    let bracket = DVec3::new(places[4].x, places[4].y, 24.0 * MM);
    parts.push(part("RotorBearing", rod(5.0 * MM, -5.0 * MM, 5.0 * MM), bracket, y_to_z(), BRASS, finishes.brass));
    let mut pieces = vec![(piece("Frame", parts), Pose::IDENTITY)];
    pieces.extend(going(&finishes));
    let at = |position| Pose { rotation: DQuat::IDENTITY, position };
    pieces.extend(winding(&finishes).into_iter().map(|(piece, place)| (piece, at(place))));
    let weight = rod(20.0 * MM, -60.0 * MM, 60.0 * MM);
    let weight = vec![part("TimeWeight", weight, DVec3::ZERO, DQuat::IDENTITY, LEAD, finishes.lead)];
    pieces.push((piece("TimeWeight", weight), at(weight_at)));
    for (piece, pose) in &pieces {
        piece.write(&mut scene, *pose);
    }
    let target = DVec3::new(-0.045, 0.262, 0.0);
    scene.camera("CamFront", target + DVec3::new(0.10, 0.07, 1.24), target, 27.0 * PI / 180.0, 16.0 / 9.0);
    scene.into_glb("A clock that breath winds", "Original work of the Soffio project; MIT OR Apache-2.0")
}

//! The striking train of Eli Terry's clock, which counts the hours.
//!
//! # Train
//!
//! ```text
//! great wheel 52 → 8 pin wheel 64 (eight pins, one a strike) → 8 lock wheel 72 (a turn a strike) → 6 fly
//! great wheel's pinion 20 → 30 count wheel: a turn for 78 strikes, 1 + 2 + … + 12
//! ```
//!
//! # Counting
//!
//! The follower of the count lever lies on the count wheel, whose rim is raised except for a notch after each hour's
//! strikes. In a notch the lever's arm blocks the pin on the lock wheel; on the rim it is clear. A pin on the minute
//! arbor lifts the flirt and drops it on the hour, and the flirt kicks the lever. The lock pin has passed when the arm
//! returns. A turn later, after the first strike, the arm blocks it again, unless the rim has lifted the follower by
//! then.

use soffio_math::{DQuat, DVec2, DVec3, PI, Pose, atan2, cos, rotation, sin};

use super::terry_layout::{BACK, CENTER, DRUM, ToothCounts, WHEEL, along_z, flat, piece, toward, wheel};
use soffio_authoring::outline::{Polygon, ellipse};
use soffio_authoring::piece::{Part, Piece};
use soffio_authoring::solid::{Solid, extrude, revolve};
use soffio_authoring::stock_parts::{
    BRASS, Finishes, LEAD, MM, ROUND, STEEL, WOOD, meshing_phase, part, rod, slab, spur_gear, y_to_z,
};

/// Teeth of the great wheel, and of the pin wheel's pinion.
pub const GREAT: ToothCounts = ToothCounts { wheel: 52, pinion: 8 };
/// Teeth of the pin wheel, and of the lock wheel's pinion.
pub(crate) const PIN: ToothCounts = ToothCounts { wheel: 64, pinion: 8 };
/// Teeth of the lock wheel, and of the fly's pinion.
pub(crate) const LOCK: ToothCounts = ToothCounts { wheel: 72, pinion: 6 };
/// Teeth of the great wheel's pinion and of the count wheel.
pub(crate) const COUNT: ToothCounts = ToothCounts { wheel: 20, pinion: 30 };
/// Number of pins that lift the hammer.
pub const PINS: usize = 8;
/// Strikes of a turn of the count wheel.
pub const BLOWS: usize = 78;
/// Module of lock wheel and fly, m.
const FINE: f64 = 0.7 * MM;

/// Radius of the raised rim of the count wheel, m.
const RIM: f64 = 45.0 * MM;
/// Height of the rim above the notches, m.
const RISE: f64 = 3.0 * MM;
/// Position after a lock at which the rim begins to rise, strikes.
const FOOT: f64 = 0.22;
/// Position after a lock at which the rim has risen, strikes.
const TOP: f64 = 0.62;
/// Position before the next lock at which the rim begins to fall, strikes.
const EDGE: f64 = 0.75;
/// Position before the next lock at which the rim has fallen, strikes. The follower must be down before the pin comes.
const DOWN: f64 = 0.35;
/// Radius of the pins and of the arms, m.
const PEG: f64 = 0.8 * MM;
/// Radius of the follower, m.
const FEELER: f64 = 1.0 * MM;

/// Layer of the pin wheel: centre along z, m.
const PIN_LAYER: f64 = -31.0 * MM;
/// Layer of the lock wheel, m.
const LOCK_LAYER: f64 = -21.0 * MM;
/// Layer of the count lever, m.
const LEVER_LAYER: f64 = -16.0 * MM;
/// Layer of the flirt, m.
const FLIRT_LAYER: f64 = -9.0 * MM;
/// Layer of the count wheel, m.
const COUNT_LAYER: f64 = 4.0 * MM;
/// Layer of bell and hammer, m.
const BELL_LAYER: f64 = -60.0 * MM;

/// Radius of the circle of the pins that lift the hammer, m.
const HAMMER_PINS: f64 = 12.0 * MM;
/// Radius of the lock pin's circle, m.
const LOCK_PIN: f64 = 18.0 * MM;
/// Radius of the circle of the minute arbor's pin, m.
pub(crate) const LIFTING_PIN: f64 = 10.0 * MM;
/// Position of the lock pin on the lever's arm, rad.
const LOCKED: f64 = 12.0 * PI / 180.0;
/// Draw of the lock, rad: the pin pulls the arm in rather than out.
const DRAW: f64 = 0.05;
/// Length of the hammer's tail, m.
const TAIL: f64 = 27.4 * MM;
/// Length of the flirt's left arm, m.
const REACH: f64 = 50.4 * MM;
/// Pins meet the arms beside their ends, by this angle further on, rad, so that they do not jam.
const INSIDE: f64 = 0.16;
/// Angle of the next pin before the hammer's tail when the train is locked, rad.
const RUN_UP: f64 = 5.0 * PI / 180.0;

fn mm(x: f64, y: f64) -> DVec3 {
    CENTER + DVec3::new(x, y, 0.0) * MM
}

/// Arbors: great wheel, pin wheel, lock wheel, fly, count wheel; hammer, lever, flirt.
struct ArborPositions {
    great: DVec3,
    pin: DVec3,
    lock: DVec3,
    fly: DVec3,
    count: DVec3,
    hammer: DVec3,
    lever: DVec3,
    flirt: DVec3,
}

fn places() -> ArborPositions {
    let away = |x: f64, y: f64| DVec3::new(x, y, 0.0).normalize();
    let great = mm(40.0, -32.0);
    let pin = great + GREAT.center_distance(MM) * away(0.55, 0.835);
    let lock = pin + PIN.center_distance(MM) * away(0.3, 0.954);
    let fly = lock + LOCK.center_distance(FINE) * away(0.1, 0.995);
    let count = great + COUNT.center_distance(MM) * away(0.6, -0.8);
    ArborPositions {
        great,
        pin,
        lock,
        fly,
        count,
        hammer: pin + DVec3::new(38.5, -13.0, 0.0) * MM,
        lever: count + DVec3::new(31.0 * MM, RIM + FEELER + 2.0 * MM, 0.0),
        flirt: mm(60.0, 8.0),
    }
}

/// Direction of the pivot of an arm of this length from the centre of a pin circle, and half the angle in which a pin
/// moves the arm, between the contacts of their round ends: rad.
fn meeting(center: DVec3, circle: f64, pivot: DVec3, arm: f64) -> (f64, f64) {
    let apart = center.distance(pivot);
    let arm = arm + 2.0 * PEG;
    let cosine = (circle * circle + apart * apart - arm * arm) / (2.0 * circle * apart);
    (toward(center, pivot), soffio_math::acos(cosine))
}

/// Direction of the lifting pin when the flirt drops, rad.
pub fn lifting_pin_at_the_hour() -> f64 {
    let (toward, half) = meeting(CENTER, LIFTING_PIN, places().flirt, REACH);
    toward - half
}

/// A pin along z.
pub fn peg(name: &'static str, at: DVec3, (low, high): (f64, f64), finish: usize) -> Part {
    let middle = 0.5 * (low + high);
    part(name, rod(PEG, low - middle, high - middle), at.with_z(middle), y_to_z(), STEEL, finish)
}

/// A round arm from one point to another of the piece's plane.
fn arm(name: &'static str, from: DVec3, to: DVec3, z: f64, finish: usize) -> Part {
    let offset = to - from;
    let turn = rotation(DVec3::Z * (atan2(offset.y, offset.x) - 0.5 * PI));
    let half = 0.5 * offset.length();
    part(name, rod(PEG, -half, half), (0.5 * (from + to)).with_z(z), turn, STEEL, finish)
}

fn polar(radius: f64, angle: f64) -> DVec3 {
    radius * DVec3::new(cos(angle), sin(angle), 0.0)
}

/// The raised rim of one hour after the strikes of the earlier hours; the count wheel is at `now` strikes.
fn rise(hour: usize, now: f64) -> Solid {
    let before = (hour * (hour - 1) / 2) as f64;
    let bottom = RIM - RISE - 1.0 * MM;
    // Later strikes come from the right.
    let at = |blow: f64, radius: f64| {
        let angle = 0.5 * PI - 2.0 * PI * (blow - now) / BLOWS as f64;
        DVec2::new(radius * cos(angle), radius * sin(angle))
    };
    let (first, last) = (before, before + hour as f64);
    let mut outline: Polygon = vec![at(last - DOWN, RIM - RISE), at(last - DOWN, bottom), at(first + FOOT, bottom)];
    outline.push(at(first + FOOT, RIM - RISE));
    outline.extend((0..=hour).map(|k| {
        let share = k as f64 / hour as f64;
        at(first + TOP + share * (hour as f64 - TOP - EDGE), RIM)
    }));
    outline.reverse();
    extrude(&outline, &[], WHEEL - 0.4 * MM, 0.1 * MM)
}

/// Names of the raised parts of the rim, each before the notch of its hour.
const RISES: [&str; 11] =
    ["Hour02", "Hour03", "Hour04", "Hour05", "Hour06", "Hour07", "Hour08", "Hour09", "Hour10", "Hour11", "Hour12"];

/// The moving pieces; the train has struck `hour` last.
pub fn pieces(finishes: &Finishes, hour: usize) -> Vec<(Piece, Pose)> {
    let p = &places();
    let weight =
        part("StrikeWeight", rod(22.0 * MM, -60.0 * MM, 60.0 * MM), DVec3::ZERO, DQuat::IDENTITY, LEAD, finishes.lead);
    let pieces = [
        (great_wheel(finishes), p.great),
        (pin_wheel(p, finishes), p.pin),
        (lock_wheel(p, finishes), p.lock),
        (fly(p, finishes), p.fly),
        (count_wheel(p, finishes, hour), p.count),
        (hammer(p, finishes), p.hammer),
        (count_lever(p, finishes), p.lever),
        (flirt(p, finishes), p.flirt),
        (piece("StrikeWeight", vec![weight]), weight_at()),
    ];
    let at = |position: DVec3| Pose { rotation: DQuat::IDENTITY, position };
    pieces.map(|(piece, place)| (piece, at(place))).into()
}

/// The great wheel with the drum, and the pinion of the count wheel.
fn great_wheel(finishes: &Finishes) -> Piece {
    let wood = finishes.wood;
    piece(
        "StrikeWheel",
        vec![
            flat("StrikeWheel", wheel(GREAT.wheel, 0.0), BACK, WOOD, wood),
            along_z("StrikeDrum", DRUM - 0.5 * MM, (BACK + 4.0 * MM, BACK + 30.0 * MM), WOOD, wood),
            along_z("StrikeArbor", 3.0 * MM, (-48.0 * MM, 7.0 * MM), WOOD, wood),
            flat("CountPinion", spur_gear(COUNT.wheel, MM, WHEEL, 0.0, &[]), COUNT_LAYER, WOOD, wood),
        ],
    )
}

/// Where on the pin circle a pin meets the hammer's tail, rad.
fn hammer_met(p: &ArborPositions) -> f64 {
    let (toward_hammer, half) = meeting(p.pin, HAMMER_PINS, p.hammer, TAIL);
    toward_hammer - half + INSIDE
}

/// The pin wheel, whose pins lift the hammer.
fn pin_wheel(p: &ArborPositions, finishes: &Finishes) -> Piece {
    let (wood, steel) = (finishes.wood, finishes.steel);
    let phase = meshing_phase(GREAT.pinion, GREAT.wheel, 0.0, toward(p.great, p.pin));
    let mut parts = vec![
        flat("PinWheel", wheel(PIN.wheel, 0.0), PIN_LAYER, WOOD, wood),
        flat("PinPinion", spur_gear(GREAT.pinion, MM, 6.0 * MM, phase, &[]), BACK, WOOD, wood),
        along_z("PinArbor", 2.2 * MM, (-48.0 * MM, 0.0), WOOD, wood),
    ];
    let met = hammer_met(p);
    /// Names of the pins that lift the hammer.
    const LIFTS: [&str; PINS] = ["Lift1", "Lift2", "Lift3", "Lift4", "Lift5", "Lift6", "Lift7", "Lift8"];
    for (k, name) in LIFTS.into_iter().enumerate() {
        let angle = met - RUN_UP + 2.0 * PI * k as f64 / PINS as f64;
        parts.push(peg(name, polar(HAMMER_PINS, angle), (-29.0 * MM, -23.5 * MM), steel));
    }
    piece("PinWheel", parts)
}

/// The lock wheel with its pin.
fn lock_wheel(p: &ArborPositions, finishes: &Finishes) -> Piece {
    let (wood, steel) = (finishes.wood, finishes.steel);
    let phase = meshing_phase(PIN.pinion, PIN.wheel, 0.0, toward(p.pin, p.lock));
    let holes: Vec<Polygon> = (0..5)
        .map(|k| {
            let angle = 0.4 * PI * f64::from(k) + 0.8;
            ellipse(12.0 * MM * DVec2::new(cos(angle), sin(angle)), DVec2::splat(4.2 * MM), 0.0, 24)
        })
        .collect();
    piece(
        "LockWheel",
        vec![
            flat("LockWheel", spur_gear(LOCK.wheel, FINE, WHEEL, 0.0, &holes), LOCK_LAYER, WOOD, wood),
            flat("LockPinion", spur_gear(PIN.pinion, MM, 6.0 * MM, phase, &[]), PIN_LAYER, WOOD, wood),
            along_z("LockArbor", 2.0 * MM, (-48.0 * MM, -12.0 * MM), WOOD, wood),
            peg("LockPin", polar(LOCK_PIN, LOCKED), (-20.0 * MM, -13.0 * MM), steel),
        ],
    )
}

/// The fly: two vanes that the air brakes.
fn fly(p: &ArborPositions, finishes: &Finishes) -> Piece {
    let (wood, steel) = (finishes.wood, finishes.steel);
    let phase = meshing_phase(LOCK.pinion, LOCK.wheel, 0.0, toward(p.lock, p.fly));
    let vane = |name, side: f64| {
        let turn = rotation(0.5 * PI * DVec3::X);
        part(name, slab(36.0 * MM, 18.0 * MM, 0.8 * MM), DVec3::new(26.0 * side, 0.0, -3.0) * MM, turn, WOOD, wood)
    };
    piece(
        "Fly",
        vec![
            flat("FlyPinion", spur_gear(LOCK.pinion, FINE, 6.0 * MM, phase, &[]), LOCK_LAYER, WOOD, wood),
            along_z("FlyArbor", 1.5 * MM, (-48.0 * MM, 8.0 * MM), STEEL, steel),
            part(
                "FlyHub",
                rod(1.2 * MM, -10.0 * MM, 10.0 * MM),
                DVec3::Z * -3.0 * MM,
                rotation(0.5 * PI * DVec3::Z),
                STEEL,
                steel,
            ),
            vane("Vane1", 1.0),
            vane("Vane2", -1.0),
        ],
    )
}

/// The count wheel with the hours' raised rims, after `hour` has been struck.
fn count_wheel(p: &ArborPositions, finishes: &Finishes, hour: usize) -> Piece {
    let wood = finishes.wood;
    let phase = meshing_phase(COUNT.pinion, COUNT.wheel, 0.0, toward(p.great, p.count));
    let disc =
        revolve(&[(0.0, -2.0), (42.0, -2.0), (42.0, 2.0), (0.0, 2.0)].map(|(r, y)| DVec2::new(r, y) * MM), 2 * ROUND);
    let mut parts = vec![
        part("CountDisc", disc, DVec3::Z * COUNT_LAYER, y_to_z(), WOOD, wood),
        flat("CountGear", spur_gear(COUNT.pinion, MM, WHEEL, phase, &[]), COUNT_LAYER - 4.2 * MM, WOOD, wood),
    ];
    let now = (hour * (hour + 1) / 2) as f64;
    for (k, name) in RISES.into_iter().enumerate() {
        parts.push(flat(name, rise(k + 2, now), COUNT_LAYER, WOOD, wood));
    }
    piece("CountWheel", parts)
}

/// The hammer; the next pin is just before its tail.
fn hammer(p: &ArborPositions, finishes: &Finishes) -> Piece {
    let steel = finishes.steel;
    let tail = met_arm(p.pin, hammer_met(p), HAMMER_PINS, p.hammer, -1.0);
    piece(
        "Hammer",
        vec![
            along_z("HammerArbor", 1.5 * MM, (-64.0 * MM, -20.0 * MM), STEEL, steel),
            arm("HammerTail", polar(4.0 * MM, tail), polar(TAIL, tail), -26.5 * MM, steel),
            arm("HammerRod", DVec3::ZERO, DVec3::Y * -75.0 * MM, BELL_LAYER, steel),
            part(
                "HammerHead",
                rod(5.0 * MM, -7.0 * MM, 7.0 * MM),
                DVec3::new(0.0, -80.0 * MM, BELL_LAYER),
                rotation(0.5 * PI * DVec3::Z),
                BRASS,
                finishes.brass,
            ),
        ],
    )
}

/// The count lever, its follower in a notch and its arm under the lock pin.
fn count_lever(p: &ArborPositions, finishes: &Finishes) -> Piece {
    let steel = finishes.steel;
    // In the notch; the arm under the lock pin.
    let follower = p.count + DVec3::Y * (RIM + FEELER - RISE) - p.lever;
    let lock_pin = p.lock + polar(LOCK_PIN, LOCKED) - p.lever;
    let stop = lock_pin + 2.0 * PEG * DVec3::new(-DRAW, -1.0, 0.0).normalize();
    piece(
        "CountLever",
        vec![
            along_z("LeverArbor", 1.5 * MM, (-24.0 * MM, 8.0 * MM), STEEL, steel),
            arm("FeelerArm", DVec3::ZERO, follower, COUNT_LAYER, steel),
            part("Feeler", rod(FEELER, -1.5 * MM, 1.5 * MM), follower.with_z(COUNT_LAYER), y_to_z(), STEEL, steel),
            arm("StopArm", DVec3::ZERO, stop, LEVER_LAYER - 4.0 * MM, steel),
            peg("Stop", stop, (-22.0 * MM, -13.0 * MM), steel),
            arm("KickArm", DVec3::ZERO, DVec3::X * 14.0 * MM, FLIRT_LAYER + 4.0 * MM, steel),
            peg("Kick", DVec3::X * 14.0 * MM, (-11.0 * MM, -5.0 * MM), steel),
        ],
    )
}

/// The flirt, just above the lever's arm.
fn flirt(p: &ArborPositions, finishes: &Finishes) -> Piece {
    let steel = finishes.steel;
    let (toward_flirt, half) = meeting(CENTER, LIFTING_PIN, p.flirt, REACH);
    let left = met_arm(CENTER, toward_flirt + half - INSIDE, LIFTING_PIN, p.flirt, 1.0);
    // Just above the lever's arm.
    let tip = p.lever + DVec3::new(14.0 * MM, 2.0 * PEG + 0.3 * MM, 0.0) - p.flirt;
    piece(
        "Flirt",
        vec![
            along_z("FlirtArbor", 1.5 * MM, (-13.0 * MM, -4.0 * MM), STEEL, steel),
            arm("FlirtArm", polar(20.0 * MM, left), polar(REACH, left), FLIRT_LAYER, steel),
            arm("FlirtBack", DVec3::ZERO, polar(20.0 * MM, left), FLIRT_LAYER, steel),
            arm("FlirtFront", DVec3::ZERO, tip, FLIRT_LAYER - 2.5 * MM, steel),
            peg("FlirtTip", tip, (-13.0 * MM, -5.0 * MM), steel),
        ],
    )
}

/// Position of the weight of the striking train, wound up.
pub fn weight_at() -> DVec3 {
    DVec3::new(0.125, 0.36, -10.0 * MM)
}

/// Direction of an arm that just touches a pin at `angle` of its circle, on the side of the sign.
fn met_arm(center: DVec3, angle: f64, circle: f64, pivot: DVec3, side: f64) -> f64 {
    let pin = center + polar(circle, angle);
    toward(pivot, pin) + side * soffio_math::asin(2.0 * PEG / pivot.distance(pin))
}

/// The bell, which is fixed.
pub fn bell(finishes: &Finishes) -> Part {
    let outside = [(40.0, 0.0), (39.5, 8.0), (36.0, 16.0), (28.0, 23.0), (16.0, 27.5), (0.0, 29.0)];
    let inside = [(0.0, 27.0), (15.0, 25.5), (26.5, 21.3), (34.0, 15.0), (37.5, 7.5), (38.0, 0.0)];
    let profile: Vec<DVec2> = inside.iter().chain(&outside).map(|&(r, y)| DVec2::new(r, y) * MM).collect();
    let place = places().hammer + DVec3::new(0.0, -80.0 * MM, 0.0);
    let middle = place + DVec3::new(5.0 * MM + 1.0 * MM + 40.0 * MM, 0.0, BELL_LAYER + 4.0 * MM);
    part("Bell", revolve(&profile, 2 * ROUND), middle, rotation(-0.5 * PI * DVec3::X), BRASS, finishes.brass)
}

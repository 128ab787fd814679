//! A mobile that is not balanced yet: its arm lies in a loop, held by friction alone, until a visitor slides it to the
//! balance point. Then a hammer at its end is level with two cymbals.
//!
//! In the arm's frame its axis is y = 0; wire, hammer and loads have their centre of mass at (b, −h). The arm lies on
//! the loop's bar at the height −r and the position u of that axis. With friction along it, it is in equilibrium where
//! its centre of mass is below that point:
//!
//! ```text
//! tan θ = (u − b)/(h − r)        θ = 0 at u = b; friction holds while |tan θ| < μ
//! ```

use soffio_math::{DQuat, DVec2, DVec3, PI, Pose, atan2, cos, rotation, sin};

use soffio_authoring::glb::Scene;
use soffio_authoring::hanging::{PlateSolid, hanging_plate};
use soffio_authoring::outline::{Polygon, ellipse, open_spline, ring as circle};
use soffio_authoring::piece::{BentWire, Piece, load, yaw};
use soffio_authoring::solid::{extrude, revolve};
use soffio_authoring::stock_parts::{BRASS, MM, ROUND, STEEL, WOOD, ceiling, finishes, part, ring, rod};

/// Position of the loop's bar, m.
const BAR: DVec3 = DVec3::new(0.0, 0.52, 0.0);
/// Distance of the swivel above the bar, m.
const SWIVEL: f64 = 16.0 * MM;
/// Radius of the bar, m.
const BAR_RADIUS: f64 = 1.5 * MM;
/// Radius of the arm's wire, m.
const WIRE: f64 = 1.2 * MM;
/// Depth of the arm's ends below its axis, m, which makes the balance stable.
const DROOP: f64 = 90.0 * MM;
/// Left end of the arm, from the origin of its axis, m.
const LEFT: f64 = -150.0 * MM;
/// Right end of the arm, from the origin of its axis, m.
const RIGHT: f64 = 230.0 * MM;
/// Half length of the arm's straight part, on which it slides, m.
const STRAIGHT: f64 = 62.0 * MM;
/// Distance of the hammer beyond the right end, m.
const REACH: f64 = 38.0 * MM;
/// Radius of the hammer's head, m.
const HAMMER: f64 = 6.0 * MM;
/// Distance of the start position from the balance point, m.
const OFF: f64 = -15.0 * MM;
/// Two cymbals next to the path of the hammer, their rims slightly inside it: names, radius, and direction of each from
/// above, relative to the arm's start direction, rad.
const CYMBALS: [([&str; 4], f64, f64); 2] = [
    (["CymbalBack", "DiscBack", "StemBack", "HookBack"], 38.0 * MM, 0.7),
    (["CymbalFront", "DiscFront", "StemFront", "HookFront"], 30.0 * MM, -0.8),
];
/// Thickness of a cymbal, m.
const SHEET: f64 = 1.0 * MM;
/// Distance from a cymbal's hook down to it, m.
const HANG: f64 = 26.0 * MM;
/// Overlap of the hammer and a cymbal's rim, m.
const OVER: f64 = 5.0 * MM;

/// A plate of wood on a stem: an oval with a hole.
fn plate(names: [&'static str; 3], size: DVec2, thickness: f64, color: usize) -> Piece {
    let top = DVec2::new(0.0, 3.0 * MM - size.y);
    let hole = ellipse(DVec2::ZERO, DVec2::splat(1.0 * MM), 0.0, 16);
    let outline: Polygon = ellipse(top, size, 0.0, 64);
    let solid = extrude(&outline, &[hole], thickness, 0.15 * MM);
    hanging_plate(names, PlateSolid { solid, density: WOOD, finish: color }, 34.0 * MM)
}

/// The arm with its loads, and its balance point (b, −h).
fn arm(brass: usize, black: usize, loads: [f64; 2]) -> (Piece, DVec2) {
    let at = |x: f64, y: f64| DVec3::new(x, y, 0.0);
    let bow = |end: f64, start: f64| {
        let between = |s: f64, y: f64| at(start + (end - start) * s, -DROOP * y);
        open_spline(
            &[at(start, 0.0), between(0.25, 0.10), between(0.6, 0.48), between(0.88, 0.82), between(1.0, 1.0)],
            6,
        )
    };
    let mut points: Vec<DVec3> = bow(LEFT, -STRAIGHT).into_iter().rev().collect();
    points.extend(bow(RIGHT, STRAIGHT));
    points.push(at(RIGHT + REACH, -DROOP));
    let eye = |x: f64| circle(at(x, -DROOP - 3.0 * MM), 3.0 * MM, DVec3::Y, DVec3::X, 12);
    let sphere = (0..=12).map(|k| {
        let (s, c) = soffio_math::sincos(PI * f64::from(k) / 12.0);
        DVec2::new(if k % 12 == 0 { 0.0 } else { HAMMER * s }, -HAMMER * c)
    });
    let sphere = revolve(&sphere.collect::<Vec<_>>(), ROUND / 2);
    let along = DQuat::IDENTITY;
    let piece = Piece {
        name: "Arm",
        parts: vec![
            part("ArmRail", rod(WIRE, -STRAIGHT, STRAIGHT).y_to_x(), DVec3::ZERO, along, STEEL, black),
            part("Hammer", sphere, at(RIGHT + REACH, -DROOP), along, BRASS, brass),
        ],
        wires: vec![
            BentWire { name: "ArmWire", points, radius: WIRE, density: STEEL },
            BentWire { name: "ArmEyeLeft", points: eye(LEFT), radius: 0.8 * MM, density: STEEL },
            BentWire { name: "ArmEyeRight", points: eye(RIGHT), radius: 0.8 * MM, density: STEEL },
        ],
        markers: vec![
            ("ArmMiddle", DVec3::ZERO),
            ("ArmLeft", at(LEFT, -DROOP - 6.0 * MM)),
            ("ArmRight", at(RIGHT, -DROOP - 6.0 * MM)),
        ],
    };
    let [left, right] = loads;
    let whole =
        piece.mass().combine(&load(left, piece.marker("ArmLeft"))).combine(&load(right, piece.marker("ArmRight")));
    (piece, DVec2::new(whole.center.x, whole.center.y))
}

/// A disc on a stem that hangs at the origin.
fn cymbal([name, disc, stem, hook]: [&'static str; 4], radius: f64, brass: usize, steel: usize) -> Piece {
    let (edge, half) = (0.3 * SHEET, 0.5 * SHEET);
    let profile = [(0.0, -half), (radius - edge, -half), (radius, edge - half), (radius, half - edge)];
    let profile = profile.into_iter().chain([(radius - edge, half), (0.0, half)]).map(|(r, y)| DVec2::new(r, y));
    let solid = revolve(&profile.collect::<Vec<_>>(), 2 * ROUND);
    let along = DQuat::IDENTITY;
    Piece {
        name,
        parts: vec![
            part(disc, solid, -HANG * DVec3::Y, along, BRASS, brass),
            part(stem, rod(0.8 * MM, -HANG, 0.0), DVec3::ZERO, along, STEEL, steel),
        ],
        wires: Vec::new(),
        markers: vec![(hook, DVec3::ZERO)],
    }
}

/// The model.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let left =
        plate(["PlateLeft", "PlateLeftHook", "PlateLeftStem"], DVec2::new(46.0, 62.0) * MM, 3.0 * MM, finishes.red);
    let right =
        plate(["PlateRight", "PlateRightHook", "PlateRightStem"], DVec2::new(26.0, 44.0) * MM, 3.0 * MM, finishes.blue);
    let (arm, center) = arm(finishes.brass, finishes.black, [left.mass().mass, right.mass().mass]);
    // It starts at OFF from the balance point, with the tilt of that position; the bar is at u on its axis.
    let (level, high) = (center.x, -center.y - WIRE);
    let tilt = atan2(OFF, high);
    let turn = rotation(tilt * DVec3::Z);
    let normal = DVec3::new(-sin(tilt), cos(tilt), 0.0);
    let foot = BAR + (BAR_RADIUS + WIRE) * normal;
    let arm_pose = Pose { rotation: turn, position: foot - turn * ((level + OFF) * DVec3::X) };
    let left_pose = Pose { rotation: yaw(0.5), position: arm_pose.point(arm.marker("ArmLeft")) };
    let right_pose = Pose { rotation: yaw(-0.4), position: arm_pose.point(arm.marker("ArmRight")) };

    let swivel = BAR + SWIVEL * DVec3::Y;
    let ring_at = -(SWIVEL - 2.5 * MM) * DVec3::Y;
    let lay = rotation(0.5 * PI * DVec3::Z);
    let across = rotation(0.5 * PI * DVec3::X);
    let bar = |half: f64| rod(BAR_RADIUS, -half, half);
    let upper = (2.0 * (BAR_RADIUS + WIRE) + 1.6 * MM - SWIVEL) * DVec3::Y;
    let eye = Piece {
        name: "Loop",
        parts: vec![
            part("LoopRing", ring(7.5 * MM, 9.5 * MM, 3.0 * MM), ring_at, lay, STEEL, finishes.brass),
            part("LoopBar", bar(7.5 * MM), -SWIVEL * DVec3::Y, across, STEEL, finishes.brass),
            part("LoopGuard", bar(7.5 * MM), upper, across, STEEL, finishes.brass),
            part("LoopStem", rod(1.5 * MM, -6.0 * MM, 8.0 * MM), DVec3::ZERO, DQuat::IDENTITY, STEEL, finishes.brass),
        ],
        wires: Vec::new(),
        markers: vec![("LoopSeat", -SWIVEL * DVec3::Y)],
    };

    let path = RIGHT + REACH - level;
    let height = BAR.y + BAR_RADIUS + WIRE - DROOP;
    let cymbals = CYMBALS.map(|(names, radius, aside)| {
        let away = path + HAMMER + radius - OVER;
        let hook = DVec3::new(away * cos(aside), height + HANG, -away * sin(aside));
        (cymbal(names, radius, finishes.brass, finishes.steel), hook)
    });
    let mut stand = ceiling(finishes.black);
    for own in &mut stand.parts {
        own.place.position += swivel - 5.0 * MM * DVec3::Y;
    }
    stand.wires.clear();
    stand.markers = vec![("SwivelPoint", swivel)];
    for ((_, hook), (name, marker)) in cymbals.iter().zip([("RodBack", "PointBack"), ("RodFront", "PointFront")]) {
        stand.parts.push(part(name, rod(1.2 * MM, 0.0, 0.9), *hook, DQuat::IDENTITY, STEEL, finishes.black));
        stand.markers.push((marker, *hook));
    }

    let at = |position| Pose { rotation: DQuat::IDENTITY, position };
    for (piece, pose) in
        [(stand, at(DVec3::ZERO)), (eye, at(swivel)), (arm, arm_pose), (left, left_pose), (right, right_pose)]
    {
        piece.write(&mut scene, pose);
    }
    for (piece, hook) in cymbals {
        piece.write(&mut scene, at(hook));
    }
    let target = DVec3::new(0.06, 0.42, 0.0);
    let camera = target + 1.25 * DVec3::new(0.05, 0.10, 1.0).normalize();
    scene.camera("CamFront", camera, target, 27.0 * PI / 180.0, 16.0 / 9.0);
    scene.into_glb("Hang it", "Original work of the Soffio project; MIT OR Apache-2.0")
}

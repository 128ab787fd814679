//! A small mobile of three steel discs that hang so near to each other that a breath makes them meet and ring.

use soffio::math::{DQuat, DVec2, DVec3, PI, Pose};

use super::glb::Scene;
use super::hung::disc;
use super::mobile::{Branch, Mobile, branch};
use super::piece::{Piece, yaw};
use super::stock::{MM, STEEL, finishes, gallows};

/// Where the mobile hangs.
const HOOK: f64 = 330.0 * MM;
const SHEET: f64 = 0.6 * MM;
/// The lower branch against the upper one, rad.
const LOWER_YAW: f64 = 0.6;

/// Draws, balances and writes the model.
pub fn glb() -> (Mobile, Vec<u8>) {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let plate = |names, diameter, length, finish| disc(names, (diameter, SHEET), length, (STEEL, finish));
    let large = plate(["LargeDisc", "LargeHook", "LargeStem"], 62.0 * MM, 66.0 * MM, finishes.steel);
    let middle = plate(["MiddleDisc", "MiddleHook", "MiddleStem"], 46.0 * MM, 62.0 * MM, finishes.blue);
    let small = plate(["SmallDisc", "SmallHook", "SmallStem"], 36.0 * MM, 70.0 * MM, finishes.red);
    let lower = branch(&Branch {
        names: ["Lower", "LowerLoop", "LowerWire", "LowerRight", "LowerLeft"],
        radius: 0.6 * MM,
        eye: 1.8 * MM,
        chord: 98.0 * MM,
        droop: 5.0 * MM,
        loads: [small.mass().mass, middle.mass().mass],
    });
    let below = lower.mass().mass + small.mass().mass + middle.mass().mass;
    let upper = branch(&Branch {
        names: ["Upper", "UpperLoop", "UpperWire", "UpperRight", "UpperLeft"],
        radius: 0.8 * MM,
        eye: 2.2 * MM,
        chord: 80.0 * MM,
        droop: 8.0 * MM,
        loads: [below, large.mass().mass],
    });
    let top = Pose { rotation: DQuat::IDENTITY, position: HOOK * DVec3::Y };
    let hung = |pose: Pose, piece: &Piece, mark| Pose { rotation: yaw(0.0), position: pose.point(piece.mark(mark)) };
    let large_pose = hung(top, &upper, "UpperLeft");
    // Turned, so that the middle disc hangs before the large one's rim: a breath that drives it back makes them meet.
    let lower_pose = Pose { rotation: yaw(LOWER_YAW), ..hung(top, &upper, "UpperRight") };
    let small_pose = hung(lower_pose, &lower, "LowerRight");
    let middle_pose = hung(lower_pose, &lower, "LowerLeft");
    let work = Mobile {
        pieces: vec![
            (upper, top),
            (lower, lower_pose),
            (large, large_pose),
            (middle, middle_pose),
            (small, small_pose),
        ],
        stand: gallows(HOOK * DVec3::Y, DVec2::new(0.0, -110.0 * MM), finishes.black),
    };
    work.stand.write(&mut scene, Pose::IDENTITY);
    for (piece, pose) in &work.pieces {
        piece.write(&mut scene, *pose);
    }
    let target = DVec3::new(0.01, 0.20, 0.0);
    scene.camera("CamFront", DVec3::new(0.16, 0.28, 0.85), target, 27.0 * PI / 180.0, 16.0 / 9.0);
    let copyright = "Original work of the Soffio project; MIT OR Apache-2.0";
    (work, scene.into_glb("Three plates", copyright))
}

//! A small mobile of three steel discs that hang so close together that a breath makes them touch and ring.

use soffio_math::{DVec2, DVec3, PI, Pose};

use soffio_authoring::glb::Scene;
use soffio_authoring::hanging::{SheetStock, disc};
use soffio_authoring::mobile::{CascadeBranches, Mobile, cascade};
use soffio_authoring::stock_parts::{MM, STEEL, bent_rod_stand, finishes};

/// Height of the mobile's hook above the floor, m.
const HOOK: f64 = 330.0 * MM;
/// Thickness of all discs, m.
const SHEET: f64 = 0.6 * MM;
/// Rotation of the lower branch relative to the upper one, rad: the middle disc hangs in front of the large one's rim,
/// so a breath drives it against that rim.
const LOWER_YAW: f64 = 0.6;

/// Designs, balances and writes the model.
pub fn glb() -> (Mobile, Vec<u8>) {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let stock = |finish| SheetStock { thickness: SHEET, density: STEEL, finish };
    let plate = |names, diameter, length, finish| disc(names, diameter, length, stock(finish));
    let large = plate(["LargeDisc", "LargeHook", "LargeStem"], 62.0 * MM, 66.0 * MM, finishes.steel);
    let middle = plate(["MiddleDisc", "MiddleHook", "MiddleStem"], 46.0 * MM, 62.0 * MM, finishes.blue);
    let small = plate(["SmallDisc", "SmallHook", "SmallStem"], 36.0 * MM, 70.0 * MM, finishes.red);
    let wires = CascadeBranches {
        radius: [0.8 * MM, 0.6 * MM],
        eye: [2.2 * MM, 1.8 * MM],
        chord: [80.0 * MM, 98.0 * MM],
        droop: [8.0 * MM, 5.0 * MM],
        lower_yaw: LOWER_YAW,
    };
    let stand = bent_rod_stand(HOOK * DVec3::Y, DVec2::new(0.0, -110.0 * MM), finishes.black);
    let mobile = cascade(HOOK * DVec3::Y, &wires, [large, middle, small], stand);
    mobile.stand.write(&mut scene, Pose::IDENTITY);
    for (piece, pose) in &mobile.pieces {
        piece.write(&mut scene, *pose);
    }
    let target = DVec3::new(0.01, 0.20, 0.0);
    scene.camera("CamFront", DVec3::new(0.16, 0.28, 0.85), target, 27.0 * PI / 180.0, 16.0 / 9.0);
    let copyright = "Original work of the Soffio project; MIT OR Apache-2.0";
    (mobile, scene.into_glb("Three plates", copyright))
}

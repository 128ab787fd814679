//! Twelve moons on eleven branches: a chain in which each branch carries one moon and the next branch.
//!
//! The moons go from full, the large one on the left, to new, the smallest on the right; the part in shadow is cut out.
//! Masses and wires are those of the design; each branch's loads hang 12 mm below its loop. The branches of the design
//! are straight. These are up to 3 % shorter from end to end, so that with curves and eyes their inertias agree.

use soffio_math::{DQuat, DVec2, DVec3, PI, Pose, cos, sin};

use soffio_authoring::glb::{Finish, Scene};
use soffio_authoring::hanging::{SheetStock, cut_plate};
use soffio_authoring::mobile::Mobile;
use soffio_authoring::outline::{Polygon, ellipse};
use soffio_authoring::piece::{Piece, named};
use soffio_authoring::stock_parts::{ALUMINIUM, MM, ceiling};
use soffio_authoring::tree::{BranchNode, TreeNode, assemble_tree};

/// Thickness of all moons, m.
const SHEET: f64 = 1.0 * MM;
/// Position of the mobile's hook, m.
const HOOK: DVec3 = DVec3::new(-0.21, 0.66, 0.0);
/// Depth of the centre of a branch's loads below its loop, m.
const DEPTH: f64 = 12.0 * MM;
/// Segments of a moon's outline.
const ROUND: usize = 72;

/// A branch, the uppermost first. Its moon's diameter (mm, of the full disc) and mass (g). Diameter, length from end to
/// end, and rise of the moon's end of the wire (mm). Directions of the branch and the moon (rad). Length of the moon's
/// stem (mm).
#[rustfmt::skip] // rows of a drawing
const BOUGHS: [[f64; 8]; 11] = [
    [220.0, 102.6,   2.4, 692.1,  46.0,  0.10,  0.16,  34.0],
    [180.0,  68.7,   2.4, 542.2,  40.0, -0.16, -0.20,  30.0],
    [115.0,  28.0,   2.0, 440.4,  52.0,  0.10,  0.25,  26.0],
    [110.0,  25.7,   2.0, 390.2,  50.0, -0.14, -0.15,  30.0],
    [105.0,  23.4,   1.6, 351.3,  46.0,  0.12,  0.20,  24.0],
    [100.0,  21.2,   1.6, 321.1,  44.0, -0.12, -0.25,  28.0],
    [ 95.0,  19.1,   1.6, 291.1,  40.0,  0.14,  0.15,  22.0],
    [ 90.0,  17.2,   1.6, 261.4,  36.0, -0.10, -0.20,  26.0],
    [ 85.0,  15.3,   1.2, 233.8,  24.0,  0.16,  0.25,  22.0],
    [ 80.0,  13.6,   1.2, 215.9,  10.0, -0.08, -0.15,  24.0],
    [ 75.0,  11.9,   1.2, 197.5,  -9.0,  0.30,  0.20,  24.0],
];
/// The last moon, at the lowest branch's right end: diameter (mm), mass (g), direction (rad), length of its stem (mm).
const LAST: [f64; 4] = [70.0, 10.4, -0.10, 30.0];
/// Index of the red moon, as in an eclipse.
const ECLIPSED: usize = 5;
/// The shadow's radius over the moon's; the remaining rim holds the moon together.
const SHADOW: f64 = 0.66;
/// Tilt of the line between the horns, rad.
const LEAN: f64 = 0.42;

/// The part in shadow of a moon of radius `radius`, `share` 0 … 1: between the limb and half an ellipse.
fn shadow(radius: f64, share: f64) -> Option<Polygon> {
    if share <= 0.0 {
        return None;
    }
    let (outer, inner) = (SHADOW * radius, SHADOW * radius * (1.0 - 2.0 * share));
    let half = ROUND / 2;
    let angle = |k: usize| PI * k as f64 / half as f64 + 0.5 * PI;
    // Down the limb on the left, up the terminator.
    let limb = (0..=half).map(|k| DVec2::new(outer * cos(angle(k)), outer * sin(angle(k))));
    let terminator = (1..half).rev().map(|k| DVec2::new(inner * cos(angle(k)), outer * sin(angle(k))));
    let (s, c) = (sin(LEAN), cos(LEAN));
    Some(limb.chain(terminator).map(|p| DVec2::new(c * p.x - s * p.y, s * p.x + c * p.y)).collect())
}

/// Moon `k` of twelve, 0 the full one.
fn moon(k: usize, [diameter, mass, stem]: [f64; 3], finish: usize) -> Piece {
    let names =
        [named(format!("Moon{}", k + 1)), named(format!("Moon{}Hook", k + 1)), named(format!("Moon{}Stem", k + 1))];
    let radius = 0.5 * diameter;
    let outline = ellipse(DVec2::ZERO, DVec2::splat(radius), 0.5 * PI, ROUND);
    let holes = shadow(radius, k as f64 / 11.5).into_iter().collect();
    let stock = SheetStock { thickness: SHEET, density: ALUMINIUM, finish };
    cut_plate(names, (outline, holes), 3.0, stem * MM, stock, 1e-3 * mass)
}

/// Designs, balances and writes the model.
pub fn glb() -> (Mobile, Vec<u8>) {
    let mut scene = Scene::default();
    let mut add =
        |name, color, metallic, roughness, finish| scene.finish(&Finish { name, color, metallic, roughness, finish });
    let night = add("Night blue", [0.012, 0.030, 0.085], 0.0, 0.40, Some("paint"));
    let ivory = add("Ivory", [0.78, 0.72, 0.58], 0.0, 0.45, Some("paint"));
    let gold = add("Leaf gold", [0.85, 0.52, 0.16], 0.9, 0.34, Some("brass-polished"));
    let copper = add("Eclipse red", [0.48, 0.06, 0.022], 0.2, 0.38, Some("paint"));
    let iron = add("Dark iron", [0.05, 0.05, 0.055], 0.9, 0.45, Some("iron-cast"));
    let finish = |k: usize| match k {
        0 => ivory,
        1 => night,
        ECLIPSED => copper,
        _ => gold,
    };
    let [diameter, mass, turn, stem] = LAST;
    let mut below = TreeNode::Plate(moon(11, [diameter, mass, stem], night), turn);
    for (k, row) in BOUGHS.iter().enumerate().rev() {
        let [diameter, mass, wire, length, rise, bough_turn, turn, stem] = *row;
        let moon = TreeNode::Plate(moon(k, [diameter, mass, stem], finish(k)), turn);
        below = TreeNode::branch(BranchNode {
            name: format!("Bough{}", k + 1),
            radius: 0.5 * wire * MM,
            chord: length * MM,
            rise: rise * MM,
            depth: DEPTH,
            turn: bough_turn,
            ends: [below, moon],
        });
    }
    let mobile = Mobile { pieces: assemble_tree(HOOK, below), stand: ceiling(iron) };
    mobile.stand.write(&mut scene, Pose { rotation: DQuat::IDENTITY, position: HOOK });
    for (piece, pose) in &mobile.pieces {
        piece.write(&mut scene, *pose);
    }
    let target = DVec3::new(-0.02, 0.50, 0.0);
    let away = DVec3::new(-0.30, 0.07, 1.0).normalize();
    scene.camera("CamFront", target + 2.25 * away, target, 27.0 * PI / 180.0, 16.0 / 9.0);
    (mobile, scene.into_glb("Twelve moons", "Original composition of the Soffio project; MIT OR Apache-2.0"))
}

//! A sounding mobile after the idea of Alexander Calder's noise-mobiles: an original drawing. A vane rotates a wire
//! with a hammer at its other end; six brass gongs hang around both on a fixed hoop.
//!
//! The hammer passes inside the gongs' stems and hits the inner part of each gong; the gongs' centres are level. A
//! disc's frequency is proportional to 1/d²: the diameters follow a five-note scale and the octave.

use soffio_math::{DQuat, DVec2, DVec3, PI, Pose, cos, sin};

use soffio_authoring::glb::{Finish, Scene};
use soffio_authoring::hanging::{SheetStock, cut_plate, disc};
use soffio_authoring::mobile::Mobile;
use soffio_authoring::outline::{Knot::Corner, Knot::Smooth, closed_spline, ring};
use soffio_authoring::piece::{BentWire, Piece, named, yaw};
use soffio_authoring::solid::revolve;
use soffio_authoring::stock_parts::{ALUMINIUM, BRASS, MM, STEEL, ceiling, part};
use soffio_authoring::tree::{BranchNode, TreeNode, assemble_tree};

/// Position of the mobile's hook, m.
const HOOK: DVec3 = DVec3::new(0.0, 0.66, 0.0);
/// Radius of the hoop, m.
const HOOP: f64 = 195.0 * MM;
/// Height of the hoop above the hook, m.
const RAISED: f64 = 34.0 * MM;
/// Depth of the centres of gongs and hammer below the hook, m.
const LEVEL: f64 = 112.0 * MM;
/// Diameter of the largest gong, m.
const LARGEST: f64 = 110.0 * MM;
/// Thickness of all gongs, m.
const SHEET: f64 = 1.5 * MM;
/// Frequencies of the gongs over the lowest: the major pentatonic scale in just intonation, and the octave.
const PITCHES: [f64; 6] = [1.0, 9.0 / 8.0, 5.0 / 4.0, 3.0 / 2.0, 5.0 / 3.0, 2.0];
/// Radius of the hammer's head, m.
const HEAD: f64 = 8.0 * MM;
/// Direction of the arm at rest, rad.
const TURN: f64 = -1.15;
/// Distance of the hole from the gong's rim, m.
const HOLE: f64 = 2.4 * MM;

/// A ball on a stem.
fn hammer(stem: f64, finish: usize) -> Piece {
    let ball = (0..=16).map(|i| {
        let angle = PI * (f64::from(i) / 16.0 - 0.5);
        DVec2::new(if i % 16 == 0 { 0.0 } else { HEAD * cos(angle) }, HEAD * sin(angle))
    });
    let ball = revolve(&ball.collect::<Vec<_>>(), 32);
    let mut points = ring(DVec3::new(0.0, -1.3 * MM, 0.0), 1.8 * MM, DVec3::NEG_Y, DVec3::X, 12);
    points.push((HEAD - stem) * DVec3::Y);
    Piece {
        name: "Hammer",
        parts: vec![part("HammerHead", ball, -stem * DVec3::Y, DQuat::IDENTITY, STEEL, finish)],
        wires: vec![BentWire { name: "HammerStem", points, radius: 0.6 * MM, density: STEEL }],
        markers: vec![("HammerHook", DVec3::ZERO)],
    }
}

/// The vane: a red flame, heavier than the hammer and nearer to the centre.
fn vane(finish: usize) -> Piece {
    #[rustfmt::skip] // rows of a drawing
    let knots = [
        Corner(4.0, 88.0), Smooth(-22.0, 52.0), Smooth(-46.0, 4.0), Smooth(-40.0, -42.0), Smooth(-6.0, -64.0),
        Smooth(32.0, -48.0), Smooth(47.0, -8.0), Smooth(36.0, 22.0), Smooth(22.0, 46.0),
    ];
    let eye = soffio_authoring::outline::ellipse(DVec2::new(2.0, -14.0), DVec2::new(15.0, 19.0), 0.3, 32);
    let stock = SheetStock { thickness: 1.0 * MM, density: ALUMINIUM, finish };
    cut_plate(["Vane", "VaneHook", "VaneStem"], (closed_spline(&knots, 8), vec![eye]), 4.0, 26.0 * MM, stock, 27e-3)
}

/// The hoop on three spokes, around the hook.
fn hoop() -> Vec<BentWire> {
    let wire = |name, points, radius| BentWire { name, points, radius, density: STEEL };
    let mut wires = vec![wire("Hoop", ring(RAISED * DVec3::Y, HOOP, DVec3::X, DVec3::Z, 72), 1.6 * MM)];
    for (k, name) in ["SpokeA", "SpokeB", "SpokeC"].into_iter().enumerate() {
        let angle = 2.0 * PI * (k as f64 / 3.0 + 0.04);
        let out = |r: f64, y: f64| DVec3::new(r * cos(angle), y * MM, r * sin(angle));
        let knots = [out(0.0, 96.0), out(0.3 * HOOP, 78.0), out(0.7 * HOOP, 50.0), out(HOOP, RAISED / MM)];
        wires.push(wire(name, soffio_authoring::outline::open_spline(&knots, 6), 1.2 * MM));
    }
    wires
}

/// Designs, balances and writes the model.
pub fn glb() -> (Mobile, Vec<u8>) {
    let mut scene = Scene::default();
    let mut add =
        |name, color, metallic, roughness, finish| scene.finish(&Finish { name, color, metallic, roughness, finish });
    let brass = add("Brass", [0.80, 0.57, 0.25], 1.0, 0.26, Some("brass-brushed"));
    let red = add("Vermilion", [0.62, 0.045, 0.012], 0.0, 0.40, Some("paint"));
    let iron = add("Dark iron", [0.05, 0.05, 0.055], 0.9, 0.45, Some("iron-cast"));
    let mut stand = ceiling(iron);
    stand.wires.extend(hoop());
    let arm = TreeNode::branch(BranchNode {
        name: "Arm".to_owned(),
        radius: 1.0 * MM,
        chord: 250.0 * MM,
        rise: 6.0 * MM,
        depth: 12.0 * MM,
        turn: TURN,
        ends: [TreeNode::Plate(vane(red), -0.15), TreeNode::Plate(hammer(104.0 * MM, iron), 0.0)],
    });
    let mut pieces = assemble_tree(HOOK, arm);
    for (k, pitch) in PITCHES.into_iter().enumerate() {
        // Evenly on the circle; the hammer rests between the first and the last.
        let angle = PI + TURN + 2.0 * PI * (k as f64 + 0.5) / PITCHES.len() as f64;
        let at = DVec3::new(HOOP * cos(angle), RAISED, -HOOP * sin(angle));
        let diameter = LARGEST / pitch.sqrt();
        let [name, hook, stem] = ["", "Hook", "Stem"].map(|end| named(format!("Gong{}{end}", k + 1)));
        let length = LEVEL + RAISED - 0.5 * diameter + HOLE;
        let stock = SheetStock { thickness: SHEET, density: BRASS, finish: brass };
        let gong = disc([name, hook, stem], diameter, length, stock);
        stand.markers.push((named(format!("Hoop{}", k + 1)), at));
        pieces.push((gong, Pose { rotation: yaw(angle), position: HOOK + at }));
    }
    let mobile = Mobile { pieces, stand };
    mobile.stand.write(&mut scene, Pose { rotation: DQuat::IDENTITY, position: HOOK });
    for (piece, pose) in &mobile.pieces {
        piece.write(&mut scene, *pose);
    }
    let target = DVec3::new(0.0, 0.585, 0.0);
    let away = DVec3::new(-0.10, 0.30, 1.0).normalize();
    scene.camera("CamFront", target + 1.02 * away, target, 27.0 * PI / 180.0, 16.0 / 9.0);
    (mobile, scene.into_glb("Mobile with gongs", "Original composition of the Soffio project; MIT OR Apache-2.0"))
}

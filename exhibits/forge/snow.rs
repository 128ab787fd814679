//! Thirty-nine ice-pale discs on dark wires: three chains that whirl downwards, with ever smaller discs. After the idea
//! of Alexander Calder's snow flurries (from 1948 on): an original drawing.
//!
//! The discs are fixed to their wires, so that they rotate with their branch. Successive branches of a chain differ by
//! nearly the golden angle, as seeds in a flower, so that no disc hangs right below another.

use soffio_math::{DQuat, DVec2, DVec3, PI, Pose, exp, ln, rotation};

use soffio_authoring::glb::{Finish, Scene};
use soffio_authoring::mobile::Mobile;
use soffio_authoring::outline::ellipse;
use soffio_authoring::piece::{Part, named};
use soffio_authoring::solid::extrude;
use soffio_authoring::stock_parts::{ALUMINIUM, MM, ceiling};
use soffio_authoring::tree::{BranchNode, TreeNode, assemble_tree};

/// Branches of a chain; it has one disc more.
const CHAIN: usize = 12;
/// Thickness of the discs, m.
const SHEET: f64 = 0.8 * MM;
/// Diameters of a chain's first and last disc, mm; those between follow a geometric series.
const DISCS: [f64; 2] = [66.0, 20.0];
/// Lengths of a chain's first and last branch, mm.
const LENGTHS: [f64; 2] = [208.0, 70.0];
/// Depth of the centre of a branch's loads below its loop, m.
const DEPTH: f64 = 11.0 * MM;
/// Position of the mobile's hook, m.
const HOOK: DVec3 = DVec3::new(-0.04, 0.82, 0.0);

/// Term `i` of a geometric sequence from the first to the last.
fn graded([first, last]: [f64; 2], share: f64) -> f64 {
    first * exp(share * ln(last / first))
}

/// Disc `i` of a chain, fixed at its centre, its face tilted about the wire.
fn flake(chain: char, i: usize, lean: f64, finish: usize) -> Part {
    let radius = 0.5 * graded(DISCS, i as f64 / CHAIN as f64) * MM;
    let outline = ellipse(DVec2::ZERO, DVec2::splat(radius), 0.0, 40);
    Part {
        name: named(format!("Disc{chain}{}", i + 1)),
        solid: extrude(&outline, &[], SHEET, 0.15 * MM),
        place: Pose { rotation: rotation(lean * DVec3::X), position: DVec3::ZERO },
        density: ALUMINIUM,
        finish,
    }
}

/// A chain whose first branch points along `turn`; it whirls to the right or, for `sense` −1, to the left.
fn chain(name: char, turn: f64, sense: f64, finish: usize) -> TreeNode {
    // Tilted alternately to both sides: some are seen as discs, some as lines.
    let lean = |i: usize| [-0.35, 0.55, -0.75, 0.25][i % 4];
    let mut below = TreeNode::Fixed(flake(name, CHAIN, lean(CHAIN), finish));
    for k in (0..CHAIN).rev() {
        let share = k as f64 / (CHAIN - 1) as f64;
        below = TreeNode::branch(BranchNode {
            name: format!("Flake{name}{}", k + 1),
            radius: (0.6 - 0.25 * share) * MM,
            chord: graded(LENGTHS, share) * MM,
            rise: (24.0 - 26.0 * share) * MM,
            depth: DEPTH,
            turn: turn + sense * 2.2 * k as f64,
            ends: [below, TreeNode::Fixed(flake(name, k, lean(k), finish))],
        });
    }
    below
}

/// Designs, balances and writes the model.
pub fn glb() -> (Mobile, Vec<u8>) {
    let mut scene = Scene::default();
    let mut add =
        |name, color, metallic, roughness, finish| scene.finish(&Finish { name, color, metallic, roughness, finish });
    let ice = add("Ice", [0.47, 0.64, 0.76], 0.0, 0.42, Some("paint"));
    let iron = add("Dark iron", [0.05, 0.05, 0.055], 0.9, 0.45, Some("iron-cast"));
    let branch = |name: &str, [wire, chord, rise, depth, turn]: [f64; 5], ends| {
        let [radius, chord, rise, depth] = [0.5 * wire, chord, rise, depth].map(|x| x * MM);
        TreeNode::branch(BranchNode { name: name.to_owned(), radius, chord, rise, depth, turn, ends })
    };
    let [a, b, c] = [chain('A', 0.3, 1.0, ice), chain('B', 2.3, -1.0, ice), chain('C', 0.9, 1.0, ice)];
    let right = branch("Right", [1.6, 440.0, -60.0, 40.0, 0.16], [c, b]);
    let top = branch("Top", [2.0, 560.0, 50.0, 24.0, -0.12], [right, a]);
    let mobile = Mobile { pieces: assemble_tree(HOOK, top), stand: ceiling(iron) };
    mobile.stand.write(&mut scene, Pose { rotation: DQuat::IDENTITY, position: HOOK });
    for (piece, pose) in &mobile.pieces {
        piece.write(&mut scene, *pose);
    }
    let target = DVec3::new(-0.05, 0.62, 0.0);
    let away = DVec3::new(-0.12, 0.10, 1.0).normalize();
    scene.camera("CamFront", target + 1.62 * away, target, 27.0 * PI / 180.0, 16.0 / 9.0);
    (mobile, scene.into_glb("Snow", "Original composition of the Soffio project; MIT OR Apache-2.0"))
}

//! A bushy mobile after the idea of Alexander Calder's *Lobster Trap and Fish Tail* (1939): an original drawing.
//!
//! ```text
//!                 ┌────────────┴──┐ A
//!               trap      ┌───────┴────┐ B
//!                        tail      ┌───┴──────┐ C
//!                               twig        ┌─┴──┐ D        a twig is three leaves on two wires
//!                                         twig  twig
//! ```

use soffio_math::{DQuat, DVec2, DVec3, PI, Pose, cos, sin};

use soffio_authoring::glb::{Finish, Scene};
use soffio_authoring::hanging::{SheetStock, cut_plate};
use soffio_authoring::mobile::Mobile;
use soffio_authoring::outline::{Knot, Knot::Corner, Knot::Smooth, area_and_centroid, closed_spline, ring};
use soffio_authoring::piece::{BentWire, Piece, named};
use soffio_authoring::stock_parts::{ALUMINIUM, MM, STEEL, ceiling};
use soffio_authoring::tree::{BranchNode, TreeNode, assemble_tree};

/// Thickness of all plates, m.
const SHEET: f64 = 0.6 * MM;
/// Position of the mobile's hook, m.
const HOOK: DVec3 = DVec3::new(0.03, 0.76, 0.0);

/// A leaf of `length` mm: a point, a belly, a blunt end; mirrored if `flipped`.
fn leaf_outline(length: f64, flipped: bool) -> Vec<DVec2> {
    #[rustfmt::skip] // rows of a drawing
    let knots = [
        (-50.0, -9.0, true), (-30.0, -20.0, false), (2.0, -24.0, false), (32.0, -17.0, false), (48.0, -3.0, false),
        (46.0, 9.0, false), (30.0, 16.0, false), (4.0, 15.0, false), (-24.0, 6.0, false),
    ];
    let side = if flipped { -1.0 } else { 1.0 };
    let knot = |&(x, y, corner): &(f64, f64, bool)| {
        let (x, y) = (side * x * 0.01 * length, y * 0.01 * length);
        if corner { Corner(x, y) } else { Smooth(x, y) }
    };
    let mut knots: Vec<Knot> = knots.iter().map(knot).collect();
    if flipped {
        knots.reverse();
    }
    closed_spline(&knots, 8)
}

/// Mass of an outline in mm as a sheet with its stem, kg.
fn weight(outline: &[DVec2], holes: &[Vec<DVec2>]) -> f64 {
    let area = area_and_centroid(outline).0 - holes.iter().map(|hole| area_and_centroid(hole).0).sum::<f64>();
    area * MM * MM * SHEET * ALUMINIUM
}

fn plate(
    name: String,
    (outline, holes): (Vec<DVec2>, Vec<Vec<DVec2>>),
    stem: f64,
    turn: f64,
    finish: usize,
) -> TreeNode {
    let names = [named(name.clone()), named(format!("{name}Hook")), named(format!("{name}Stem"))];
    let mass = weight(&outline, &holes);
    let stock = SheetStock { thickness: SHEET, density: ALUMINIUM, finish };
    TreeNode::Plate(cut_plate(names, (outline, holes), 3.0, stem * MM, stock, mass), turn)
}

/// The red plate: a tail of two lobes with a slit between.
fn tail(finish: usize) -> TreeNode {
    #[rustfmt::skip] // rows of a drawing
    let knots = [
        Corner(-8.0, 62.0), Smooth(-13.0, 30.0), Smooth(-24.0, 0.0), Smooth(-47.0, -34.0), Corner(-66.0, -52.0),
        Smooth(-30.0, -50.0), Corner(-2.0, -34.0), Smooth(26.0, -58.0), Corner(58.0, -70.0), Smooth(40.0, -40.0),
        Smooth(22.0, -4.0), Smooth(11.0, 30.0), Corner(6.0, 62.0),
    ];
    let slit = |x: f64, y: f64, long: f64, turn: f64| {
        soffio_authoring::outline::ellipse(DVec2::new(x, y), DVec2::new(long, 2.6), turn, 24)
    };
    let holes = vec![slit(-19.0, -22.0, 19.0, 0.92), slit(17.0, -26.0, 19.0, 2.16)];
    plate("Tail".to_owned(), (closed_spline(&knots, 8), holes), 30.0, 0.10, finish)
}

/// Three leaves on two wires: lengths of the leaves (mm), lengths of the wires (mm), directions of wires and leaves
/// (rad).
struct Twig {
    leaves: [f64; 3],
    wires: [f64; 2],
    turns: [f64; 2],
    leaf_turns: [f64; 3],
    stems: [f64; 3],
}

/// Twig `k` with leaves 3k+1 … 3k+3.
fn twig(k: usize, drawn: &Twig, finish: usize) -> TreeNode {
    let leaf = |i: usize| {
        let outline = leaf_outline(drawn.leaves[i], (i + k) % 2 == 1);
        plate(format!("Leaf{}", 3 * k + i + 1), (outline, Vec::new()), drawn.stems[i], drawn.leaf_turns[i], finish)
    };
    let branch = |name: String, i: usize, rise: f64, ends| {
        let chord = drawn.wires[i] * MM;
        TreeNode::branch(BranchNode {
            name,
            radius: 0.5 * MM,
            chord,
            rise: rise * MM,
            depth: 22.0 * MM,
            turn: drawn.turns[i],
            ends,
        })
    };
    let lower = branch(format!("Twig{}b", k + 1), 1, -16.0, [leaf(2), leaf(1)]);
    branch(format!("Twig{}a", k + 1), 0, -22.0, [lower, leaf(0)])
}

/// The trap: a basket of ribs and hoops about a level axis, on a stem.
fn trap() -> Piece {
    /// Names of the ribs.
    const RIBS: [&str; 8] = ["Rib1", "Rib2", "Rib3", "Rib4", "Rib5", "Rib6", "Rib7", "Rib8"];
    /// Names of the hoops, and their positions along the trap's axis, mm.
    const HOOPS: [(&str, f64); 4] = [("Hoop1", -46.0), ("Hoop2", -16.0), ("Hoop3", 16.0), ("Hoop4", 46.0)];
    let (half, belly, stem) = (78.0, 38.0, 44.0);
    let middle = -(stem + belly) * MM * DVec3::Y;
    let radius = |x: f64| belly * (1.0 - (x / half) * (x / half)).max(0.0).sqrt();
    let at = |x: f64, angle: f64| middle + DVec3::new(x, radius(x) * cos(angle), radius(x) * sin(angle)) * MM;
    let wire = |name, points| BentWire { name, points, radius: 0.6 * MM, density: STEEL };
    let mut wires: Vec<BentWire> = Vec::new();
    for (k, name) in RIBS.into_iter().enumerate() {
        let angle = 2.0 * PI * k as f64 / RIBS.len() as f64;
        wires.push(wire(name, (0..=16).map(|i| at(-half * cos(PI * f64::from(i) / 16.0), angle)).collect()));
    }
    for (name, x) in HOOPS {
        let center = middle + x * MM * DVec3::X;
        wires.push(wire(name, ring(center, radius(x) * MM, DVec3::Y, DVec3::Z, 24)));
    }
    let mut line = ring(DVec3::new(0.0, -1.4 * MM, 0.0), 1.7 * MM, DVec3::NEG_Y, DVec3::X, 12);
    line.push(-(stem - 1.0) * MM * DVec3::Y);
    wires.push(BentWire { name: "TrapStem", points: line, radius: 0.4 * MM, density: STEEL });
    Piece { name: "Trap", parts: Vec::new(), wires, markers: vec![("TrapHook", DVec3::ZERO), ("TrapMiddle", middle)] }
}

/// Designs, balances and writes the model.
pub fn glb() -> (Mobile, Vec<u8>) {
    let mut scene = Scene::default();
    let mut add =
        |name, color, metallic, roughness, finish| scene.finish(&Finish { name, color, metallic, roughness, finish });
    let black = add("Black paint", [0.012, 0.012, 0.013], 0.0, 0.45, Some("paint"));
    let red = add("Vermilion", [0.62, 0.045, 0.012], 0.0, 0.40, Some("paint"));
    let iron = add("Dark iron", [0.05, 0.05, 0.055], 0.9, 0.45, Some("iron-cast"));
    let twigs = [
        Twig {
            leaves: [132.0, 112.0, 96.0],
            wires: [185.0, 150.0],
            turns: [2.60, 0.5],
            leaf_turns: [0.25, -0.35, 0.1],
            stems: [30.0, 26.0, 58.0],
        },
        Twig {
            leaves: [120.0, 104.0, 84.0],
            wires: [165.0, 135.0],
            turns: [0.35, -0.5],
            leaf_turns: [-0.2, 0.3, -0.1],
            stems: [62.0, 84.0, 40.0],
        },
        Twig {
            leaves: [108.0, 92.0, 76.0],
            wires: [150.0, 120.0],
            turns: [-2.75, 2.5],
            leaf_turns: [0.15, -0.3, 0.35],
            stems: [26.0, 48.0, 92.0],
        },
    ];
    let mut twigs = twigs.iter().enumerate().map(|(k, drawn)| twig(k, drawn, black)).collect::<Vec<_>>().into_iter();
    let mut next = || twigs.next().expect("three twigs");
    let [first, second, third] = [next(), next(), next()];
    let branch = |name: &str, [wire, chord, rise, depth, turn]: [f64; 5], ends| {
        let [radius, chord, rise, depth] = [0.5 * wire, chord, rise, depth].map(|x| x * MM);
        TreeNode::branch(BranchNode { name: name.to_owned(), radius, chord, rise, depth, turn, ends })
    };
    let d = branch("BoughD", [1.2, 230.0, -34.0, 40.0, 0.20], [second, third]);
    let c = branch("BoughC", [1.4, 300.0, -44.0, 46.0, -0.30], [d, first]);
    let b = branch("BoughB", [1.6, 380.0, -24.0, 44.0, 0.22], [c, tail(red)]);
    let a = branch("BoughA", [2.0, 470.0, 34.0, 30.0, -0.06], [b, TreeNode::Plate(trap(), 0.35)]);
    let mobile = Mobile { pieces: assemble_tree(HOOK, a), stand: ceiling(iron) };
    mobile.stand.write(&mut scene, Pose { rotation: DQuat::IDENTITY, position: HOOK });
    for (piece, pose) in &mobile.pieces {
        piece.write(&mut scene, *pose);
    }
    let target = DVec3::new(0.04, 0.52, 0.0);
    let away = DVec3::new(-0.22, 0.05, 1.0).normalize();
    scene.camera("CamFront", target + 1.38 * away, target, 27.0 * PI / 180.0, 16.0 / 9.0);
    (mobile, scene.into_glb("Tree with a trap", "Original composition of the Soffio project; MIT OR Apache-2.0"))
}

//! Mobiles as binary trees: branches that carry plates and branches, balanced from the lowest upwards.
//!
//! As in building a real mobile, the lowest branch comes first: [`assemble_tree`] finds where it balances and hangs it
//! on the next. Each branch's right end droops so far that the centre of its loads is `depth` below its loop. Its tilt
//! then has the period 2π √(I/(M g depth)), I about the loop.

use soffio_math::{DVec3, Pose};

use super::mobile::{Branch, branch_of_depth};
use super::piece::{Part, Piece, named, yaw};

/// A node of the tree.
pub enum TreeNode {
    /// A plate on its stem, hanging by its first marker; rotated about the vertical, rad, relative to the world.
    Plate(Piece, f64),
    /// A branch with its loads.
    BranchNode(Box<BranchNode>),
    /// A part fixed to the wire's end, relative to it.
    Fixed(Part),
}

impl TreeNode {
    /// A branch node.
    pub fn branch(branch: BranchNode) -> Self {
        Self::BranchNode(Box::new(branch))
    }
}

/// A wire with a loop at its balance point and a load at each end.
pub struct BranchNode {
    /// Name of its node; the loop is `<name>Loop`, the wire `<name>Wire`, the ends `<name>Right` and `<name>Left`.
    pub name: String,
    /// Radius of the wire, m.
    pub radius: f64,
    /// Distance between the two loads, m.
    pub chord: f64,
    /// Rise of the left end over the loop's foot, m; it droops where this is negative.
    pub rise: f64,
    /// Depth of the centre of all loads below the loop, m.
    pub depth: f64,
    /// Direction of its right end, rad about the vertical relative to the world.
    pub turn: f64,
    /// Loads at the right and at the left end.
    pub ends: [TreeNode; 2],
}

/// Segments of each arm.
const STEPS: usize = 12;
/// Radius of loops and eyes over that of the wire.
const EYE_RATIO: f64 = 2.7;
/// Least radius of loops and eyes, m.
const MIN_EYE: f64 = 1.7e-3;

struct Bent {
    piece: Piece,
    turn: f64,
    mass: f64,
    hanging: Vec<(&'static str, Bent)>,
}

/// A node with its bent wires and masses, or the part that is fixed.
fn bend(hanging: TreeNode) -> Result<Bent, Part> {
    match hanging {
        TreeNode::Plate(piece, turn) => Ok(Bent { mass: piece.mass().mass, piece, turn, hanging: Vec::new() }),
        TreeNode::BranchNode(branch) => Ok(bend_bough(*branch)),
        TreeNode::Fixed(part) => Err(part),
    }
}

fn bend_bough(BranchNode { name, radius, chord, rise, depth, turn, ends }: BranchNode) -> Bent {
    let ends = ends.map(bend);
    let load = |end: &Result<Bent, Part>| end.as_ref().map_or(0.0, |bent| bent.mass);
    let loads = [load(&ends[0]), load(&ends[1])];
    let tips = [&ends[0], &ends[1]].map(|end| end.as_ref().err().cloned());
    let name = named(name);
    let [loops, wire, right, left] = ["Loop", "Wire", "Right", "Left"].map(|end| named(format!("{name}{end}")));
    let drawn = Branch {
        names: [name, loops, wire, right, left],
        radius,
        eye: (EYE_RATIO * radius).max(MIN_EYE),
        chord,
        droop: [depth, -rise],
        steps: STEPS,
        loads,
        tips,
    };
    let piece = branch_of_depth(drawn, depth);
    let mass = piece.mass().mass + loads[0] + loads[1];
    let hanging = [right, left].into_iter().zip(ends).filter_map(|(marker, end)| Some((marker, end.ok()?)));
    Bent { piece, turn, mass, hanging: hanging.collect() }
}

fn place(bent: Bent, position: DVec3, pieces: &mut Vec<(Piece, Pose)>) {
    let pose = Pose { rotation: yaw(bent.turn), position };
    let hooks: Vec<DVec3> = bent.hanging.iter().map(|(marker, _)| pose.point(bent.piece.marker(marker))).collect();
    pieces.push((bent.piece, pose));
    for ((_, below), hook) in bent.hanging.into_iter().zip(hooks) {
        place(below, hook, pieces);
    }
}

/// All pieces of a mobile that hangs at `hook`, in their equilibrium poses; a piece comes before its loads.
pub fn assemble_tree(hook: DVec3, top: TreeNode) -> Vec<(Piece, Pose)> {
    let mut pieces = Vec::new();
    if let Ok(bent) = bend(top) {
        place(bent, hook, &mut pieces);
    }
    pieces
}

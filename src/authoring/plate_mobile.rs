//! Mobiles of given plates: paired, attached and balanced.
//!
//! Plates are sorted by weight. Neighbours hang in pairs from a short branch that points towards the visitor, the
//! lighter one in front and a little lower: a breath drives it against the other, and both ring. (Of an odd number the
//! heaviest hangs alone.) The pairs hang in a chain, the lightest lowest, each branch rotated relative to the one
//! above.
//!
//! R is the farthest distance of a hanging subtree from the plumb line through its hook, for any rotation: of a plate
//! the farthest corner, of a branch the longest arm + R of its load. A chain's branch is longer than the sum of the two
//! R at its ends, so only the plates of a pair can touch.

use super::glb::{Finish, Scene};
use super::hanging::{HOLE_RADIUS, SheetStock, drawn_plate, hang_by_hole};
use super::mobile::Mobile;
use super::outline::{Polygon, area_and_centroid, ellipse};
use super::piece::{Piece, named};
use super::stock_parts::{self, MM, ceiling};
use super::tree::{BranchNode, TreeNode, assemble_tree};
use soffio_exhibit::codes;
use soffio_exhibit::diagnostic::Diagnostic;
use soffio_math::{DQuat, DVec2, DVec3, PI, Pose, asin, cos, sin};

/// Fewest and most plates.
pub const COUNT: [usize; 2] = [2, 24];
/// Least and greatest extent of a plate, mm.
pub const EXTENT: [f64; 2] = [15.0, 600.0];
/// Thinnest and thickest sheet, mm.
pub const THICKNESS: [f64; 2] = [0.3, 4.0];
/// Largest weight ratio of a pair: the heavy plate's arm of the short branch would vanish.
pub const PAIR_RATIO: f64 = 5.0;
/// Distance from a plate's upper edge to the centre of its hole, mm.
const HOLE_INSET: f64 = 3.0;
/// Least width of sheet around the hole, mm.
const HOLE_RIM: f64 = 0.5;
/// Direction of a pair's branch, rad about the vertical: nearly towards the visitor, so that both plates are visible.
const PAIR_HEADING: f64 = 1.25;
/// Clearance between parts that must not touch, m.
const CLEARANCE: f64 = 12.0 * MM;
/// Least length of a branch's shorter arm, m: enough for two eyes and a loop.
const MIN_ARM: f64 = 5.0 * MM;
/// Height of the lowest point above the floor, m.
const FLOOR_CLEARANCE: f64 = 0.2;
/// Vertical field of view of the camera, rad.
const FOVY: f64 = 27.0 * PI / 180.0;
/// Width of the camera's picture over its height.
const ASPECT: f64 = 16.0 / 9.0;

/// Outline of a plate.
#[derive(Clone, Debug)]
pub struct Outline {
    /// Name in messages: its size, or the element of a drawing.
    pub name: String,
    /// Closed, counter-clockwise, mm, y upwards.
    pub polygon: Polygon,
}

/// Metal of the plates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Metal {
    /// Painted.
    Aluminium,
    /// Painted.
    Steel,
    /// Bare.
    Brass,
    /// Bare.
    Copper,
}

impl Metal {
    /// Name in a sidecar.
    pub fn name(self) -> &'static str {
        match self {
            Self::Aluminium => "aluminium",
            Self::Steel => "steel",
            Self::Brass => "brass",
            Self::Copper => "copper",
        }
    }

    /// Gain of the breath that moves a sheet of `thickness` m as much as thin aluminium.
    pub fn gain(self, thickness: f64) -> f64 {
        /// Mass per area of aluminium of 0.8 mm, kg/m², which a child's breath swings against its neighbour.
        const REFERENCE_AREAL_DENSITY: f64 = 2.16;
        ((self.density() * thickness / REFERENCE_AREAL_DENSITY).max(1.0) * 10.0).round() / 10.0
    }

    /// Density, kg/m³.
    fn density(self) -> f64 {
        match self {
            Self::Aluminium => stock_parts::ALUMINIUM,
            Self::Steel => stock_parts::STEEL,
            Self::Brass => stock_parts::BRASS,
            Self::Copper => stock_parts::COPPER,
        }
    }

    fn finishes(self) -> Vec<Finish> {
        let finish = |name, color, metallic, roughness, finish| Finish { name, color, metallic, roughness, finish };
        match self {
            Self::Brass => vec![finish("Brass", [0.80, 0.57, 0.25], 1.0, 0.28, Some("brass-brushed"))],
            Self::Copper => vec![finish("Copper", [0.86, 0.45, 0.32], 1.0, 0.28, Some("copper"))],
            Self::Aluminium | Self::Steel => vec![
                finish("Red paint", [0.55, 0.018, 0.012], 0.0, 0.40, Some("paint")),
                finish("Black paint", [0.012, 0.012, 0.013], 0.0, 0.45, Some("paint")),
                finish("Yellow paint", [0.72, 0.42, 0.02], 0.0, 0.42, Some("paint")),
                finish("Blue paint", [0.02, 0.08, 0.35], 0.0, 0.40, Some("paint")),
                finish("White paint", [0.80, 0.78, 0.72], 0.0, 0.45, Some("paint")),
            ],
        }
    }
}

/// A plate of a finished mobile.
#[derive(Clone, Debug)]
pub struct PlacedPlate {
    /// Name of its node.
    pub node: &'static str,
    /// Name of the outline it is cut from.
    pub source: String,
    /// Picture coordinates of its centre: (0,0) top left, (1,1) bottom right.
    pub picture_position: [f64; 2],
}

/// A balanced mobile with its model.
#[derive(Debug)]
pub struct PlateMobile {
    /// The placed pieces.
    pub mobile: Mobile,
    /// The model, as a GLB file.
    pub glb: Vec<u8>,
    /// The plates, the heaviest first.
    pub plates: Vec<PlacedPlate>,
    /// Pairs of plates, as indices into `plates`: the back one, the front one.
    pub pairs: Vec<[usize; 2]>,
}

fn rejection(message: String, help: &str) -> Diagnostic {
    Diagnostic::new(codes::NEW, message).help(help)
}

/// Reports why a plate cannot be cut, or cannot hang by a hole; `None` where it can.
fn plate_problem(outline: &Outline) -> Option<Diagnostic> {
    let (polygon, name) = (&outline.polygon, &outline.name);
    let low = polygon.iter().copied().reduce(DVec2::min)?;
    let high = polygon.iter().copied().reduce(DVec2::max)?;
    let size = high - low;
    let [least, most] = EXTENT;
    if size.min_element() < least || size.max_element() > most {
        let message = format!("{name} is {:.1} × {:.1} mm", size.x, size.y);
        return Some(rejection(message, &format!("plates are {least} to {most} mm high and wide")));
    }
    let (hanging, _) = hang_by_hole(&(polygon.clone(), Vec::new()), HOLE_INSET);
    let sides = || hanging.iter().zip(hanging.iter().cycle().skip(1));
    let left = sides().map(|(p, q)| {
        let along = ((-*p).dot(*q - *p) / (*q - *p).length_squared()).clamp(0.0, 1.0);
        (*p + along * (*q - *p)).length()
    });
    let crossings = sides().filter(|(p, q)| (p.y > 0.0) != (q.y > 0.0) && p.x - p.y * (q.x - p.x) / (q.y - p.y) > 0.0);
    let inside = crossings.count() % 2 == 1;
    if !inside || left.fold(f64::INFINITY, f64::min) < HOLE_RADIUS + HOLE_RIM {
        let message = format!("{name} is too narrow above its middle for the hole by which it hangs");
        let need = 2.0 * (HOLE_RADIUS + HOLE_RIM);
        let help = format!(
            "leave {need:.0} mm of sheet around a point {HOLE_INSET} mm below its upper edge, above its centre"
        );
        return Some(rejection(message, &help));
    }
    None
}

/// A subtree of the chain, its farthest distance from its plumb line, and its mass.
struct Subtree {
    hanging: TreeNode,
    reach: f64,
    mass: f64,
}

/// Radius of a wire that bears this mass (kg) without visible sag, m.
fn wire_for(mass: f64) -> f64 {
    let table = [(0.05, 0.6), (0.15, 0.8), (0.35, 1.0), (0.8, 1.3), (2.0, 1.8)];
    MM * table.iter().find(|(most, _)| mass < *most).map_or(2.5, |(_, radius)| *radius)
}

/// Farthest distance of a branch's loads from its loop; the balance determines the arms.
fn reach(chord: f64, [right, left]: [&Subtree; 2]) -> f64 {
    let arm = chord * left.mass / (left.mass + right.mass);
    (arm + right.reach).max(chord - arm + left.reach)
}

/// The subtree of a branch with two loads.
fn branch_subtree(name: String, chord: f64, rise: f64, depth: f64, turn: f64, [right, left]: [Subtree; 2]) -> Subtree {
    let reach = reach(chord, [&right, &left]);
    let loads = right.mass + left.mass;
    let radius = wire_for(loads);
    // Wire and eyes: as much again as the chord for the curve and the loop.
    let mass = loads + 2.0 * stock_parts::STEEL * PI * radius * radius * chord;
    let ends = [right.hanging, left.hanging];
    Subtree { hanging: TreeNode::branch(BranchNode { name, radius, chord, rise, depth, turn, ends }), reach, mass }
}

/// A plate with its stem.
struct CutPlate {
    piece: Piece,
    reach: f64,
    height: f64,
}

impl CutPlate {
    fn subtree(&self, turn: f64) -> Subtree {
        Subtree { hanging: TreeNode::Plate(self.piece.clone(), turn), reach: self.reach, mass: self.piece.mass().mass }
    }
}

/// Cuts plate `k` with a stem of `stem` m.
fn cut(k: usize, outline: &Outline, stem: f64, thickness: f64, metal: Metal, finish: usize) -> CutPlate {
    let names = ["", "Hook", "Stem"].map(|end| named(format!("Plate{}{end}", k + 1)));
    let drawn = (outline.polygon.clone(), Vec::new());
    let (hanging, _) = hang_by_hole(&drawn, HOLE_INSET);
    let reach = MM * hanging.iter().map(|p| p.x.abs()).fold(0.0, f64::max) + thickness;
    let height = MM * (HOLE_INSET - hanging.iter().map(|p| p.y).fold(0.0, f64::min));
    let stock = SheetStock { thickness, density: metal.density(), finish };
    let piece = drawn_plate(names, &drawn, HOLE_INSET, stem, stock);
    CutPlate { piece, reach, height }
}

/// Length of the stem of a plate that hangs alone or behind, m.
const STEM_LENGTH: f64 = 24.0 * MM;

/// Two plates on a short branch, `behind` the heavier; the front one hangs lower by a third of the other's height.
/// Pairs alternate between both sides by their `number`.
fn pair(number: usize, behind: &CutPlate, front: &CutPlate, thickness: f64) -> Result<Subtree, Diagnostic> {
    let (heavy, light) = (behind.piece.mass().mass, front.piece.mass().mass);
    if heavy > PAIR_RATIO * light {
        let (a, b) = (1e3 * heavy, 1e3 * light);
        let message = format!("two neighbours in weight, {a:.1} g and {b:.1} g, differ by more than 1 to {PAIR_RATIO}");
        return Err(rejection(message, "give plates that are more alike, or one of a size between them"));
    }
    let swing = STEM_LENGTH + 0.33 * behind.height + front.height;
    let gap = (0.08 * swing).clamp(9.0 * MM, 15.0 * MM) + thickness;
    let chord = (gap / sin(PAIR_HEADING)).max(MIN_ARM * (heavy + light) / light);
    let depth = 0.2 * chord;
    // Where the balance requires a longer branch, it points more to the side, which keeps the gap of the plates.
    let towards = asin(gap / chord);
    let turn = if number % 2 == 1 { towards } else { PI - towards };
    let subtrees = [behind.subtree(0.0), front.subtree(0.0)];
    Ok(branch_subtree(format!("Pair{number}"), chord, -depth, depth, turn, subtrees))
}

/// Designs, balances and writes a mobile of `outlines`, cut from sheet of `thickness` m; the scene is called `title`.
///
/// # Errors
/// All plates that cannot be cut or paired.
pub fn mobile(title: &str, outlines: &[Outline], thickness: f64, metal: Metal) -> Result<PlateMobile, Vec<Diagnostic>> {
    let problems: Vec<Diagnostic> = outlines.iter().filter_map(plate_problem).collect();
    if !problems.is_empty() {
        return Err(problems);
    }
    let [fewest, most] = COUNT;
    if !(fewest..=most).contains(&outlines.len()) {
        let message = format!("{} plates: too few or too many for a mobile", outlines.len());
        return Err(vec![rejection(message, &format!("give {fewest} to {most} of them"))]);
    }
    let [thinnest, thickest] = THICKNESS.map(|t| t * MM);
    if !(thinnest..=thickest).contains(&thickness) {
        let message = format!("a sheet of {} mm is too thin or too thick", thickness / MM);
        return Err(vec![rejection(message, &format!("give {} to {} mm", THICKNESS[0], THICKNESS[1]))]);
    }
    let mut sorted: Vec<&Outline> = outlines.iter().collect();
    sorted.sort_by(|a, b| area_and_centroid(&b.polygon).0.total_cmp(&area_and_centroid(&a.polygon).0));

    let mut scene = Scene::default();
    let finishes: Vec<usize> = metal.finishes().iter().map(|finish| scene.finish(finish)).collect();
    let iron = scene.finish(&Finish {
        name: "Dark iron",
        color: [0.05, 0.05, 0.055],
        metallic: 0.9,
        roughness: 0.45,
        finish: Some("iron-cast"),
    });
    let alone = sorted.len() % 2;
    let pairs: Vec<[usize; 2]> = (alone..sorted.len()).step_by(2).map(|k| [k, k + 1]).collect();
    let cut = |k: usize, stem: f64| cut(k, sorted[k], stem, thickness, metal, finishes[k % finishes.len()]);
    let tree = || -> Result<TreeNode, Diagnostic> {
        let mut subtrees = Vec::new();
        if alone == 1 {
            subtrees.push(cut(0, STEM_LENGTH).subtree(0.2));
        }
        for (number, [behind, front]) in (1..).zip(&pairs) {
            let behind = cut(*behind, STEM_LENGTH);
            let front = cut(*front, STEM_LENGTH + 0.33 * behind.height);
            subtrees.push(pair(number, &behind, &front, thickness)?);
        }
        // The lightest is the lowest; the branches point alternately left and right.
        let mut level = subtrees.len();
        let mut subtrees = subtrees.into_iter().rev();
        let lowest = subtrees.next();
        let chain = subtrees.fold(lowest, |below, subtree| {
            let below = below?;
            level -= 1;
            let arm = MIN_ARM * (below.mass + subtree.mass) / below.mass.min(subtree.mass);
            let chord = (below.reach + subtree.reach + CLEARANCE).max(arm);
            let depth = (0.04 * chord).clamp(8.0 * MM, 30.0 * MM);
            let turn = if level % 2 == 1 { 0.12 } else { PI - 0.16 };
            Some(branch_subtree(format!("Bough{level}"), chord, 0.04 * chord, depth, turn, [below, subtree]))
        });
        // There are at least two plates, hence a pair.
        chain.map(|subtree| subtree.hanging).ok_or_else(|| rejection("there is no plate".into(), "give at least two"))
    };
    // Assembled at the origin first, to find its lowest point.
    let one = |problem| vec![problem];
    let (low, _) = bounds(&assemble_tree(DVec3::ZERO, tree().map_err(one)?));
    let hook = DVec3::new(0.0, ((FLOOR_CLEARANCE - low.y) * 1e3).ceil() * MM, 0.0);
    let mobile = Mobile { pieces: assemble_tree(hook, tree().map_err(one)?), stand: ceiling(iron) };
    mobile.stand.write(&mut scene, Pose { rotation: DQuat::IDENTITY, position: hook });
    for (piece, pose) in &mobile.pieces {
        piece.write(&mut scene, *pose);
    }
    let camera = FramingCamera::framing(&mobile, hook);
    scene.camera("CamFront", camera.position, camera.target, FOVY, ASPECT);
    let plates = (0..sorted.len()).map(|k| {
        let node = named(format!("Plate{}", k + 1));
        let piece = mobile.pieces.iter().find(|(piece, _)| piece.name == node);
        let center = piece.map_or(camera.target, |(piece, pose)| pose.point(piece.mass().center));
        PlacedPlate { node, source: sorted[k].name.clone(), picture_position: camera.project(center) }
    });
    let plates = plates.collect();
    Ok(PlateMobile { mobile, glb: scene.into_glb(title, "Made with Soffio from given plates"), plates, pairs })
}

/// Bounding box of placed pieces.
fn bounds(pieces: &[(Piece, Pose)]) -> (DVec3, DVec3) {
    let corners = pieces.iter().flat_map(|(piece, pose)| {
        let wires = piece.wires.iter().flat_map(|bend| bend.points.clone());
        let parts = piece.parts.iter().flat_map(|part| part.solid.positions.iter().map(|p| part.place.point(*p)));
        wires.chain(parts).map(|p| pose.point(p)).collect::<Vec<_>>()
    });
    let none = (DVec3::splat(f64::INFINITY), DVec3::splat(f64::NEG_INFINITY));
    corners.fold(none, |(low, high), p| (low.min(p), high.max(p)))
}

/// The camera of the model.
struct FramingCamera {
    position: DVec3,
    target: DVec3,
}

impl FramingCamera {
    /// In front of the mobile, far enough to show all of it and a little of the rod.
    fn framing(mobile: &Mobile, hook: DVec3) -> Self {
        let (low, high) = bounds(&mobile.pieces);
        let high = high.max(hook + 0.04 * DVec3::Y);
        let half = 0.5 * (high - low);
        let target = 0.5 * (low + high);
        let tall = half.y.max(half.x / ASPECT) * 1.12;
        let far = tall * cos(0.5 * FOVY) / sin(0.5 * FOVY) + half.z;
        Self { position: target + far * DVec3::new(-0.08, 0.05, 1.0).normalize(), target }
    }

    /// Picture coordinates of a point, (0,0) top left, to hundredths.
    fn project(&self, point: DVec3) -> [f64; 2] {
        let back = (self.position - self.target).normalize();
        let right = DVec3::Y.cross(back).normalize();
        let up = back.cross(right);
        let offset = point - self.position;
        let half = -offset.dot(back) * sin(0.5 * FOVY) / cos(0.5 * FOVY);
        let (x, y) = (0.5 + 0.5 * offset.dot(right) / (half * ASPECT), 0.5 - 0.5 * offset.dot(up) / half);
        [x, y].map(|v| (v * 100.0).round() / 100.0)
    }
}

/// A plate by its size: `120x80` is 120 mm wide and 80 high with round corners, `100` a disc of 100 mm.
///
/// # Errors
/// The text is no size, or the size is out of range; the diagnostic says how it is written.
pub fn sized(text: &str) -> Result<Outline, Diagnostic> {
    let wrong = || {
        rejection(
            format!("\"{text}\" is not a size of a plate"),
            "write 120x80 (width x height, mm), or 100 for a disc of 100 mm",
        )
    };
    let number = |s: &str| s.trim().parse::<f64>().ok().filter(|x| x.is_finite() && *x > 0.0).ok_or_else(wrong);
    let sides = text.trim().trim_end_matches("mm").split(['x', '×']).map(number).collect::<Result<Vec<_>, _>>()?;
    let polygon = match sides[..] {
        [diameter] => ellipse(DVec2::ZERO, DVec2::splat(0.5 * diameter), 0.5 * PI, 64),
        [width, height] => {
            let round = 0.18 * width.min(height);
            let middle = 0.5 * DVec2::new(width, height) - round;
            // A quarter of a circle about each inner corner, counter-clockwise.
            (0..4)
                .flat_map(|quarter| {
                    (0..=8).map(move |k| (quarter, 0.5 * PI * (f64::from(quarter) + f64::from(k) / 8.0)))
                })
                .map(|(quarter, angle)| {
                    let side =
                        [DVec2::new(1.0, 1.0), DVec2::new(-1.0, 1.0), DVec2::new(-1.0, -1.0), DVec2::new(1.0, -1.0)];
                    middle * side[quarter as usize] + round * DVec2::new(cos(angle), sin(angle))
                })
                .collect()
        }
        _ => return Err(wrong()),
    };
    Ok(Outline { name: text.trim().to_owned(), polygon })
}

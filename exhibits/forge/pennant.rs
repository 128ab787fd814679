//! A silk pennant below a yard that turns on the arm of a stand.
//!
//! The silk is a grid of cells, which the sidecar joins to a sheet, and one skin over them. A place on it has the coordinates
//! u from −1 to 1 across and v from 0 at the hem to 1 at the tails.

use soffio_math::{DQuat, DVec2, DVec3, PI, Pose, rotation};

use soffio_authoring::glb::{Finish, Scene};
use soffio_authoring::piece::Piece;
use soffio_authoring::solid::{Solid, revolve};
use soffio_authoring::stock_parts::{BRASS, Finishes, MM, ROUND, WOOD, bent_rod_stand, finishes, part, rod};

/// Rows and columns of cells: as the sidecar says.
pub const CELLS: [usize; 2] = [8, 4];
/// Length of the silk from its hem to its tails, m.
pub const LENGTH: f64 = 340.0 * MM;
/// Width at the hem and at the tails, m.
pub const WIDTHS: [f64; 2] = [150.0 * MM, 76.0 * MM];
/// Depth of the notch between the tails, m.
const NOTCH: f64 = 46.0 * MM;
/// Rows and columns of the drawn skin: a fold is round.
const SKIN: [usize; 2] = [60, 24];
/// Rows of the skin that are ivory: two chevrons.
const CHEVRONS: [std::ops::Range<usize>; 2] = [30..35, 39..44];
/// Point of the bearing that bears the yard, m, above the floor.
const BEARING: DVec3 = DVec3::new(0.0, 0.50, 0.0);
/// Height of the bearing above the yard's axis, m.
const STEM: f64 = 14.0 * MM;
/// Radius of the yard, m; the hem lies along its lowest line.
const YARD: f64 = 2.5 * MM;

/// A place on the silk in the yard's frame, m.
fn place(u: f64, v: f64) -> DVec3 {
    let half = 0.5 * (WIDTHS[0] + (WIDTHS[1] - WIDTHS[0]) * v);
    DVec3::new(half * u, -STEM - YARD - LENGTH * v + NOTCH * v * (1.0 - u.abs()), 0.0)
}

/// The model.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let mut silk = |name, color| {
        let finish = scene.finish(&Finish { name, color, metallic: 0.0, roughness: 0.38, finish: None });
        scene.two_sided(finish);
        finish
    };
    let colors = [silk("Vermilion silk", [0.60, 0.035, 0.012]), silk("Ivory silk", [0.78, 0.70, 0.52])];
    let upright = |position| Pose { rotation: DQuat::IDENTITY, position };
    let stand = bent_rod_stand(BEARING, DVec2::new(-0.19, 0.03), finishes.black);
    stand.write(&mut scene, Pose::IDENTITY);
    yard(&finishes).write(&mut scene, upright(BEARING));
    let [rows, columns] = CELLS;
    let mut joints = Vec::new();
    for i in 0..rows {
        for j in 0..columns {
            let (u, v) = ((2.0 * j as f64 + 1.0) / columns as f64 - 1.0, (i as f64 + 0.5) / rows as f64);
            let at = BEARING + place(u, v);
            joints.push((scene.node(&format!("Silk.{i}.{j}"), None, at, DQuat::IDENTITY), upright(at)));
        }
    }
    for (ivory, name) in [(false, "Cloth"), (true, "Chevrons")] {
        let (solid, weights) = skin(ivory);
        let node = scene.node(name, None, DVec3::ZERO, DQuat::IDENTITY);
        scene.skin(node, &solid, colors[usize::from(ivory)], &weights, &joints);
    }
    let target = DVec3::new(-0.01, 0.31, -0.03);
    let eye = target + 1.22 * DVec3::new(0.42, 0.10, 1.0).normalize();
    scene.camera("CamFront", eye, target, 27.0 * PI / 180.0, 16.0 / 9.0);
    scene.into_glb("Pennant", "Original work of the Soffio project; MIT OR Apache-2.0")
}

/// The yard with its knobs and the stem to the bearing, which is its origin.
fn yard(finishes: &Finishes) -> Piece {
    let half = 0.5 * WIDTHS[0] + 9.0 * MM;
    let lay = rotation(0.5 * PI * DVec3::Z);
    let knob = [(0.0, -6.5), (4.0, -5.2), (6.5, -1.5), (6.5, 1.5), (4.0, 5.2), (0.0, 6.5)];
    let knob = revolve(&knob.map(|(r, y)| DVec2::new(r, y) * MM), ROUND);
    let below = -STEM * DVec3::Y;
    Piece {
        name: "Yard",
        parts: vec![
            part("Bar", rod(YARD, -half, half), below, lay, BRASS, finishes.brass),
            part("KnobLeft", knob.clone(), below - half * DVec3::X, lay, WOOD, finishes.wood),
            part("KnobRight", knob, below + half * DVec3::X, lay, WOOD, finishes.wood),
            part("Stem", rod(1.5 * MM, -STEM, 0.0), DVec3::ZERO, DQuat::IDENTITY, BRASS, finishes.brass),
        ],
        wires: Vec::new(),
        markers: Vec::new(),
    }
}

/// The cells of the skin of one colour, and what its vertices follow.
fn skin(ivory: bool) -> (Solid, Vec<[(u16, f64); 4]>) {
    let [rows, columns] = SKIN;
    let (mut solid, mut weights) = (Solid::default(), Vec::new());
    for i in 0..=rows {
        for j in 0..=columns {
            let (u, v) = (2.0 * j as f64 / columns as f64 - 1.0, i as f64 / rows as f64);
            solid.positions.push(BEARING + place(u, v));
            solid.normals.push(DVec3::Z);
            weights.push(followed(u, v));
        }
    }
    for i in (0..rows).filter(|i| CHEVRONS.iter().any(|band| band.contains(i)) == ivory) {
        for j in 0..columns {
            let at = (i * (columns + 1) + j) as u32;
            let below = at + columns as u32 + 1;
            solid.triangles.extend([[at, below, below + 1], [at, below + 1, at + 1]]);
        }
    }
    (solid, weights)
}

/// The cells around a place, each with its share: bilinear between their middles.
fn followed(u: f64, v: f64) -> [(u16, f64); 4] {
    let [rows, columns] = CELLS;
    let between = |x: f64, count: usize| {
        let x = (x * count as f64 - 0.5).clamp(0.0, count as f64 - 1.0);
        let first = (x as usize).min(count - 2);
        (first, x - first as f64)
    };
    let ((i, down), (j, right)) = (between(v, rows), between(0.5 * (u + 1.0), columns));
    let cell = |i: usize, j: usize| (i * columns + j) as u16;
    [
        (cell(i, j), (1.0 - down) * (1.0 - right)),
        (cell(i, j + 1), (1.0 - down) * right),
        (cell(i + 1, j), down * (1.0 - right)),
        (cell(i + 1, j + 1), down * right),
    ]
}

//! The case of Terry's clock: a shelf case after his pillar and scroll, with glass at its sides and the door open, so
//! that the movement is visible and a breath comes in. Nothing of it moves and nothing touches it.

use soffio_math::{DQuat, DVec2, DVec3, PI, cos, rotation, sin};

use super::terry_layout::{CENTER, piece};
use soffio_authoring::glb::{Finish, Glass, Scene};
use soffio_authoring::outline::{Polygon, ellipse, reversed};
use soffio_authoring::piece::{Part, Piece};
use soffio_authoring::solid::{Solid, extrude, revolve};
use soffio_authoring::stock_parts::{BRASS, Finishes, MM, ROUND, WOOD, part, ring, rod, slab, y_to_z};

/// The space inside the case: lowest and highest coordinate along each axis, m.
#[derive(Clone, Copy)]
struct Interior {
    /// Left and right.
    x: [f64; 2],
    /// Bottom and top.
    y: [f64; 2],
    /// Back and front.
    z: [f64; 2],
}

/// Inside of the case, m: it holds the wheels, the weights' fall and the pendulum's swing.
const INSIDE: Interior = Interior { x: [-0.200, 0.220], y: [0.034, 0.492], z: [-0.098, 0.050] };
/// Thickness of boards, m.
const BOARD: f64 = 9.0 * MM;
/// Width of the mouldings, m.
const LEDGE: f64 = 14.0 * MM;
/// Inner radius of the chapter ring, m.
const CHAPTERS_INNER: f64 = 82.0 * MM;
/// Outer radius of the chapter ring, m.
const CHAPTERS_OUTER: f64 = 101.0 * MM;
/// Position of the chapter ring along z, m: in front of the wheels and behind the hands.
const DIAL: f64 = 10.0 * MM;
/// Width of the numerals' strokes, m.
const STROKE: f64 = 1.7 * MM;

/// Finishes of the case.
struct Woods {
    mahogany: usize,
    paint: usize,
    glass: usize,
}

/// The case, the dial and the rods on which the weights slide.
pub fn pieces(scene: &mut Scene, finishes: &Finishes, weights: [DVec3; 2]) -> [Piece; 2] {
    let mut add =
        |name, color, metallic, roughness, finish| scene.finish(&Finish { name, color, metallic, roughness, finish });
    let woods = Woods {
        mahogany: add("Mahogany", [0.150, 0.045, 0.018], 0.0, 0.32, Some("walnut")),
        paint: add("Dial paint", [0.82, 0.78, 0.66], 0.0, 0.55, Some("paint-matt")),
        glass: add("Old glass", [0.95, 0.97, 0.95], 0.0, 0.03, None),
    };
    scene.clear(
        woods.glass,
        &Glass {
            wall_thickness: 2.0 * MM,
            ior: 1.52,
            transmission: 0.97,
            attenuation_color: [0.75, 0.90, 0.82],
            attenuation_distance: 0.05,
        },
    );
    let mut parts = boards(&woods);
    parts.extend(pediment(&woods, finishes));
    for (x, name) in [(INSIDE.x[0], "Left"), (INSIDE.x[1], "Right")] {
        parts.extend(pillar(x, name, &woods, finishes));
    }
    for (at, name) in weights.into_iter().zip(["GuideLeft", "GuideRight"]) {
        let long = rod(2.0 * MM, INSIDE.y[0], INSIDE.y[1]);
        parts.push(part(name, long, at.with_y(0.0), DQuat::IDENTITY, BRASS, finishes.steel));
    }
    [piece("Case", parts), piece("Dial", dial(&woods, finishes))]
}

fn size([low, high]: [f64; 2]) -> f64 {
    high - low
}

fn middle([low, high]: [f64; 2]) -> f64 {
    0.5 * (low + high)
}

/// Back, bottom, top with their mouldings, feet, and sides with a pane each.
fn boards(woods: &Woods) -> Vec<Part> {
    let Interior { x, y, z } = INSIDE;
    let wood = woods.mahogany;
    let level = rotation(0.5 * PI * DVec3::X);
    let outer = size(x) + 2.0 * BOARD;
    let at = |height: f64| DVec3::new(middle(x), height, middle(z));
    let board = |name, out: f64, thick: f64, height: f64| {
        let deep = size(z) + BOARD + 2.0 * out;
        part(name, slab(outer + 2.0 * out, deep, thick), at(height), level, WOOD, wood)
    };
    let mut parts = vec![
        part(
            "BackBoard",
            slab(outer, size(y), BOARD),
            DVec3::new(middle(x), middle(y), z[0] - 0.5 * BOARD),
            DQuat::IDENTITY,
            WOOD,
            wood,
        ),
        board("Bottom", 0.3 * LEDGE, BOARD, y[0] - 0.5 * BOARD),
        board("Base", LEDGE, 0.8 * BOARD, y[0] - 1.4 * BOARD),
        board("Top", 0.3 * LEDGE, BOARD, y[1] + 0.5 * BOARD),
        board("Cornice", LEDGE, 0.8 * BOARD, y[1] + 1.4 * BOARD),
    ];
    let bun = [(0.0, 0.0), (9.0, 0.0), (14.0, 4.0), (14.5, 9.0), (11.0, 15.0), (0.0, 15.0)];
    let bun = revolve(&bun.map(|(r, h)| DVec2::new(r, h) * MM), ROUND);
    for (name, right, front) in
        [("FootBackLeft", 0, 0), ("FootFrontLeft", 0, 1), ("FootBackRight", 1, 0), ("FootFrontRight", 1, 1)]
    {
        let foot = DVec3::new(x[right], y[0] - 1.8 * BOARD - 15.0 * MM, z[front]);
        parts.push(part(name, bun.clone(), foot, DQuat::IDENTITY, WOOD, wood));
    }
    let window: Polygon = rectangle(size(z) - 60.0 * MM, size(y) - 70.0 * MM);
    let wall = extrude(&rectangle(size(z) + BOARD, size(y)), &[window], BOARD, 0.6 * MM);
    let pane = extrude(&rectangle(size(z) - 56.0 * MM, size(y) - 66.0 * MM), &[], 2.0 * MM, 0.2 * MM);
    for (side, glass, place) in
        [("SideLeft", "PaneLeft", x[0] - 0.5 * BOARD), ("SideRight", "PaneRight", x[1] + 0.5 * BOARD)]
    {
        let (to, turn) = (DVec3::new(place, middle(y), middle(z)), rotation(0.5 * PI * DVec3::Y));
        parts.push(part(side, wall.clone(), to, turn, WOOD, wood));
        parts.push(part(glass, pane.clone(), to, turn, WOOD, woods.glass));
    }
    parts
}

fn rectangle(width: f64, height: f64) -> Polygon {
    let (x, y) = (0.5 * width, 0.5 * height);
    [(-x, -y), (x, -y), (x, y), (-x, y)].map(|(x, y)| DVec2::new(x, y)).into()
}

/// A slender turned pillar with brass at both ends, in front of one side.
fn pillar(x: f64, name: &'static str, woods: &Woods, finishes: &Finishes) -> Vec<Part> {
    let [low, high] = INSIDE.y;
    let foot = DVec3::new(x, low, INSIDE.z[1] + 4.0 * MM);
    let long = size([low, high]);
    // A column swells slightly below its middle (entasis).
    let shaft: Vec<DVec2> = (0..=24)
        .map(|k| {
            let s = f64::from(k) / 24.0;
            DVec2::new((6.2 + 1.6 * sin(PI * s) - 1.2 * s) * MM, 10.0 * MM + s * (long - 20.0 * MM))
        })
        .collect();
    let ends = [DVec2::new(0.0, shaft[0].y), DVec2::new(0.0, shaft[24].y)];
    let shaft: Vec<DVec2> = ends[..1].iter().chain(&shaft).chain(&ends[1..]).copied().collect();
    let knop = [(0.0, 0.0), (10.0, 0.0), (10.0, 3.0), (8.0, 5.0), (9.0, 7.5), (7.0, 10.5), (0.0, 10.5)];
    let knop = revolve(&knop.map(|(r, h)| DVec2::new(r, h) * MM), ROUND);
    let [shaft_name, base, head] = match name {
        "Left" => ["PillarLeft", "PillarFootLeft", "PillarHeadLeft"],
        _ => ["PillarRight", "PillarFootRight", "PillarHeadRight"],
    };
    vec![
        part(shaft_name, revolve(&shaft, ROUND), foot, DQuat::IDENTITY, WOOD, woods.mahogany),
        part(base, knop.clone(), foot, DQuat::IDENTITY, BRASS, finishes.brass),
        part(head, knop, foot + long * DVec3::Y, rotation(PI * DVec3::X), BRASS, finishes.brass),
    ]
}

/// Two swan necks that end in rosettes, a plinth between them, and three urns.
fn pediment(woods: &Woods, finishes: &Finishes) -> Vec<Part> {
    let Interior { x, y, z } = INSIDE;
    let ground = DVec3::new(middle(x), y[1] + 1.8 * BOARD, z[1] - 2.0 * MM);
    let (far, near, rise, low) = (0.5 * size(x) + BOARD, 46.0 * MM, 56.0 * MM, 9.0 * MM);
    let neck = |side: f64| -> Polygon {
        let edge = |height: f64, thick: f64| {
            move |k: i32| {
                let s = f64::from(k) / 40.0;
                let up = 0.5 - 0.5 * cos(PI * s);
                DVec2::new(side * (far + (near - far) * s), height + up * rise * (1.0 - thick))
            }
        };
        // Below it the neck is cut out, so that it stands free near the rosette.
        let over = (0..=40).map(edge(low, 0.0));
        let under = (0..=40).rev().map(edge(0.0, 0.28));
        let outline: Polygon = over.chain(under).collect();
        if side > 0.0 { outline } else { reversed(outline) }
    };
    let urn = [
        (0.0, 0.0),
        (7.0, 0.0),
        (7.0, 3.0),
        (3.5, 6.0),
        (8.0, 13.0),
        (9.0, 18.0),
        (6.0, 22.0),
        (2.5, 25.0),
        (3.2, 28.0),
        (1.5, 34.0),
        (0.0, 37.0),
    ];
    let urn = revolve(&urn.map(|(r, h)| DVec2::new(r, h) * MM), ROUND);
    let rosette = rod(14.0 * MM, -6.0 * MM, 6.0 * MM);
    let mut parts = Vec::new();
    for (side, scroll, flower) in [(-1.0, "ScrollLeft", "RosetteLeft"), (1.0, "ScrollRight", "RosetteRight")] {
        let neck = extrude(&neck(side), &[], 9.0 * MM, 0.8 * MM);
        parts.push(part(scroll, neck, ground, DQuat::IDENTITY, WOOD, woods.mahogany));
        let end = ground + DVec3::new(side * near, 0.5 * (low + 1.72 * rise), 0.0);
        parts.push(part(flower, rosette.clone(), end, y_to_z(), BRASS, finishes.brass));
    }
    let plinth = slab(22.0 * MM, 40.0 * MM, 12.0 * MM);
    parts.push(part("Plinth", plinth, ground + 20.0 * MM * DVec3::Y, DQuat::IDENTITY, WOOD, woods.mahogany));
    for (name, along, up) in
        [("UrnLeft", -far + 6.0 * MM, low), ("UrnMiddle", 0.0, 40.0 * MM), ("UrnRight", far - 6.0 * MM, low)]
    {
        parts.push(part(
            name,
            urn.clone(),
            ground + DVec3::new(along, up, 0.0),
            DQuat::IDENTITY,
            BRASS,
            finishes.brass,
        ));
    }
    parts
}

/// A painted ring with the hours in Roman numerals and a dot for each minute, open in the middle.
fn dial(woods: &Woods, finishes: &Finishes) -> Vec<Part> {
    let at = CENTER + DIAL * DVec3::Z;
    let ground = part("ChapterRing", ring(CHAPTERS_INNER, CHAPTERS_OUTER, 1.6 * MM), at, y_to_z(), WOOD, woods.paint);
    let mut ink = Solid::default();
    for minute in 0..60 {
        let angle = 0.5 * PI - 2.0 * PI * f64::from(minute) / 60.0;
        let size = if minute % 5 == 0 { 1.1 } else { 0.6 } * MM;
        let dot =
            ellipse((CHAPTERS_OUTER - 2.4 * MM) * DVec2::new(cos(angle), sin(angle)), DVec2::splat(size), 0.0, 16);
        join(&mut ink, &extrude(&dot, &[], 0.3 * MM, 0.05 * MM));
    }
    for (hour, numeral) in
        ["XII", "I", "II", "III", "IIII", "V", "VI", "VII", "VIII", "IX", "X", "XI"].iter().enumerate()
    {
        let angle = -2.0 * PI * hour as f64 / 12.0;
        for stroke in strokes(numeral) {
            // Numerals are upright at twelve and rotate along the ring.
            let turn = |p: DVec2| DVec2::from_angle(angle).rotate(p + DVec2::Y * (CHAPTERS_INNER + 7.6 * MM));
            join(&mut ink, &extrude(&stroke.into_iter().map(turn).collect(), &[], 0.3 * MM, 0.05 * MM));
        }
    }
    let ink = part("Numerals", ink, at + 0.9 * MM * DVec3::Z, DQuat::IDENTITY, WOOD, finishes.black);
    vec![ground, ink]
}

/// The strokes of a numeral about its middle, m: I upright, V and X of two slanted ones.
fn strokes(numeral: &str) -> Vec<Polygon> {
    let (high, half) = (5.0 * MM, 0.5 * STROKE);
    let slanted = |from: f64, to: f64| -> Polygon {
        [(from - half, -high), (from + half, -high), (to + half, high), (to - half, high)]
            .map(|(x, y)| DVec2::new(x, y))
            .into()
    };
    let wide = |letter: char| if letter == 'I' { 2.9 * MM } else { 6.4 * MM };
    let all: f64 = numeral.chars().map(wide).sum();
    let mut left = -0.5 * all;
    let mut out = Vec::new();
    for letter in numeral.chars() {
        let (middle, arm) = (left + 0.5 * wide(letter), 2.3 * MM);
        match letter {
            'I' => out.push(slanted(middle, middle)),
            'V' => out.extend([slanted(middle, middle - arm), slanted(middle, middle + arm)]),
            _ => out.extend([slanted(middle - arm, middle + arm), slanted(middle + arm, middle - arm)]),
        }
        left += wide(letter);
    }
    out
}

/// Appends a solid that does not touch the first.
fn join(all: &mut Solid, one: &Solid) {
    let first = all.positions.len() as u32;
    all.positions.extend(&one.positions);
    all.normals.extend(&one.normals);
    all.triangles.extend(one.triangles.iter().map(|corners| corners.map(|corner| corner + first)));
}

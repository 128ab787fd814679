//! Wind chimes of metals, bamboo or glass: tubes in a circle around a wooden disc that a sail moves.
//!
//! A tube hangs by a pin at 22.42 % of its length, a node of its first bending mode, so that the cord does not damp it.
//! All tubes are struck at the same height, 40 % of their length from the lower end, which excites the first five
//! modes. So their tops and feet are staggered. The cords hang from a round crown.

use soffio_math::{DQuat, DVec2, DVec3, PI, cos, rotation, sin};

use super::glb::{Finish, Glass, Scene};
use super::hanging::{BEVEL, SheetMass, to_mass};
use super::outline::{Polygon, area_and_centroid, ring};
use super::piece::{BentWire, Piece, load, named};
use super::solid::{Solid, extrude, revolve, revolve_ring};
use super::stock_parts::{BRASS, COPPER, MM, ROUND, STEEL, WOOD, ceiling, part, write};

/// Height of the crown's hook, m.
const HOOK_HEIGHT: f64 = 1.26;
/// Height of the crown's ring above its underside, m.
const BRIDLE_HEIGHT: f64 = 105.0 * MM;
/// Point where a tube hangs, as a fraction of its length from the upper end: a node of its first bending mode.
const HANGING_FRACTION: f64 = 0.2242;
/// Point where a tube is struck, as a fraction of its length from the upper end.
const STRIKE_FRACTION: f64 = 0.6;
/// Least gap between the crown and a tube, m.
const CROWN_CLEARANCE: f64 = 34.0 * MM;
/// Radius of the striker, m.
const STRIKER_RADIUS: f64 = 40.0 * MM;
/// Mass of the striker, kg.
const STRIKER_MASS: f64 = 60e-3;
/// Gap between the striker's rim and the tubes, m.
const STRIKER_GAP: f64 = 13.5 * MM;
/// Distance from the striker to the middle of the sail, m.
const SAIL_DISTANCE: f64 = 0.5;
/// Mass of the sail, kg.
const SAIL_MASS: f64 = 10e-3;
/// Density of the sail's wood, kg/m³.
const LIME_WOOD_DENSITY: f64 = 530.0;

/// What tubes are cut from.
pub struct TubeStock {
    /// Outer diameter and wall, mm.
    pub size: [f64; 2],
    /// Density, kg/m³.
    pub density: f64,
    /// Finish.
    pub finish: Finish,
    /// Optical properties if it is of glass.
    pub glass: Option<Glass>,
}

impl TubeStock {
    /// Distance of a tube's axis from the middle, m: the gap to the striker is the same for all.
    fn circle(&self) -> f64 {
        STRIKER_RADIUS + STRIKER_GAP + 0.5 * self.size[0] * MM
    }
}

/// Design of a wind chime.
pub struct ChimeDesign<'a> {
    /// Title of the scene.
    pub title: &'a str,
    /// Lengths of the tubes, mm, the longest first.
    pub lengths: &'a [f64],
    /// What the tubes are cut from, in turns: the first tube from the first, and so on around.
    pub stocks: &'a [TubeStock],
    /// Finish of the sail.
    pub sail: Finish,
}

/// Aluminium 6061-T6, C5 to C6.
pub const ALUMINIUM: ChimeDesign<'static> = ChimeDesign {
    title: "Wind chimes of aluminium",
    lengths: &[533.8, 503.4, 474.7, 434.6, 409.7, 374.9],
    stocks: &[TubeStock {
        size: [25.4, 1.65],
        density: 2710.0,
        finish: Finish {
            name: "Brushed aluminium",
            color: [0.78, 0.79, 0.80],
            metallic: 1.0,
            roughness: 0.26,
            finish: Some("aluminium-brushed"),
        },
        glass: None,
    }],
    sail: Finish {
        name: "Signal red",
        color: [0.55, 0.03, 0.018],
        metallic: 0.0,
        roughness: 0.45,
        finish: Some("paint"),
    },
};

/// Bamboo, C5 to A5.
pub const BAMBOO: ChimeDesign<'static> = ChimeDesign {
    title: "Wind chimes of bamboo",
    lengths: &[497.0, 468.0, 440.0, 401.0, 377.0],
    stocks: &[TubeStock {
        size: [30.0, 4.0],
        density: 660.0,
        finish: Finish {
            name: "Bamboo",
            color: [0.58, 0.42, 0.17],
            metallic: 0.0,
            roughness: 0.50,
            finish: Some("bamboo"),
        },
        glass: None,
    }],
    sail: Finish {
        name: "Leaf green",
        color: [0.05, 0.17, 0.06],
        metallic: 0.0,
        roughness: 0.50,
        finish: Some("paint"),
    },
};

/// Soda-lime glass, C5 to A5.
pub const GLASS: ChimeDesign<'static> = ChimeDesign {
    title: "Wind chimes of glass",
    lengths: &[480.3, 453.0, 427.3, 391.4, 369.1],
    stocks: &[TubeStock {
        size: [20.0, 1.8],
        density: 2500.0,
        finish: Finish { name: "Sea glass", color: [0.78, 0.93, 0.90], metallic: 0.0, roughness: 0.08, finish: None },
        glass: Some(Glass {
            wall_thickness: 1.8 * MM,
            ior: 1.52,
            transmission: 0.96,
            attenuation_color: [0.36, 0.74, 0.70],
            attenuation_distance: 0.012,
        }),
    }],
    sail: Finish {
        name: "Deep sea",
        color: [0.015, 0.07, 0.16],
        metallic: 0.0,
        roughness: 0.40,
        finish: Some("paint"),
    },
};

/// Steel conduit, copper water pipe and brass tube: C5 of each, then G5 of each.
pub const METALS: ChimeDesign<'static> = ChimeDesign {
    title: "Wind chimes of three metals",
    lengths: &[450.4, 425.4, 385.9, 367.1, 346.2, 314.1],
    stocks: &[
        TubeStock {
            size: [17.9, 1.07],
            density: STEEL,
            finish: Finish {
                name: "Bright steel",
                color: [0.50, 0.51, 0.53],
                metallic: 1.0,
                roughness: 0.22,
                finish: Some("steel-polished"),
            },
            glass: None,
        },
        TubeStock {
            size: [22.2, 1.14],
            density: COPPER,
            finish: Finish {
                name: "Copper",
                color: [0.80, 0.33, 0.19],
                metallic: 1.0,
                roughness: 0.28,
                finish: Some("copper"),
            },
            glass: None,
        },
        TubeStock {
            size: [19.05, 1.65],
            density: BRASS,
            finish: Finish {
                name: "Polished brass",
                color: [0.80, 0.57, 0.25],
                metallic: 1.0,
                roughness: 0.24,
                finish: Some("brass-polished"),
            },
            glass: None,
        },
    ],
    sail: Finish { name: "Plum", color: [0.14, 0.02, 0.10], metallic: 0.0, roughness: 0.45, finish: Some("paint") },
};

struct FinishIndices {
    /// Of each stock.
    tubes: Vec<usize>,
    sail: usize,
    wood: usize,
    iron: usize,
}

/// Distance from the crown's underside down to the strike height, m.
fn drop(design: &ChimeDesign) -> f64 {
    STRIKE_FRACTION * design.lengths[0] * MM + CROWN_CLEARANCE
}

/// A tube of `length` along y about the origin.
fn tube([outer, wall]: [f64; 2], length: f64) -> Solid {
    let (radius, inner, half) = (0.5 * outer * MM, (0.5 * outer - wall) * MM, 0.5 * length);
    revolve_ring(
        &[(inner, -half), (radius, -half), (radius, half), (inner, half)].map(|(r, y)| DVec2::new(r, y)),
        2 * ROUND,
    )
}

/// A cord of `length` from the origin down, threaded through a bead at its foot.
fn cord(k: usize, length: f64, finishes: &FinishIndices) -> Piece {
    let name = named(format!("Cord{k}"));
    let radius = 6.0 * MM;
    let ball = (0..=12).map(|i| {
        let angle = PI * (f64::from(i) / 12.0 - 0.5);
        DVec2::new(if i % 12 == 0 { 0.0 } else { radius * cos(angle) }, radius * sin(angle))
    });
    let bead = revolve(&ball.collect::<Vec<_>>(), ROUND / 2);
    let at = -0.35 * length * DVec3::Y;
    Piece {
        name,
        parts: vec![part(named(format!("Bead{k}")), bead, at, DQuat::IDENTITY, WOOD, finishes.wood)],
        wires: vec![line(named(format!("CordLine{k}")), length)],
        markers: vec![(named(format!("CordEnd{k}")), -length * DVec3::Y)],
    }
}

/// Braided cord straight down from the origin: 0.7 mm in radius, with the density of nylon.
fn line(name: &'static str, length: f64) -> BentWire {
    BentWire { name, points: vec![DVec3::ZERO, -length * DVec3::Y], radius: 0.7 * MM, density: 1150.0 }
}

/// The crown: a turned board on a bridle of three cords; its origin is the ring in which they meet. Long tubes are
/// heavier, so the board is offset by `aside` from the ring to hang level.
fn crown(design: &ChimeDesign, aside: DVec3, finishes: &FinishIndices) -> Piece {
    let reach = |stock: &TubeStock| stock.circle() + 0.5 * stock.size[0] * MM;
    let rim = (design.stocks.iter().map(reach).fold(0.0, f64::max) + 10.0 * MM) / MM;
    let top = 16.0;
    #[rustfmt::skip] // rows of a drawing
    let board = [
        (0.0, 0.0), (rim - 3.0, 0.0), (rim, 3.0), (rim, 7.5), (rim - 2.0, 9.5), (rim - 7.0, 10.5),
        (rim - 12.0, 13.5), (rim - 18.0, top), (0.0, top),
    ];
    let board = revolve(&board.map(|(r, y)| DVec2::new(r, y) * MM), 3 * ROUND);
    let loops = ring(DVec3::new(0.0, -4.0 * MM, 0.0), 5.0 * MM, DVec3::Y, DVec3::Z, 16);
    let mut wires = vec![BentWire { name: "CrownRing", points: loops, radius: 1.0 * MM, density: STEEL }];
    for (k, name) in ["BridleA", "BridleB", "BridleC"].into_iter().enumerate() {
        let angle = 2.0 * PI * (k as f64 / 3.0 + 0.06);
        let out = (rim - 20.0) * MM;
        let foot = aside + DVec3::new(out * cos(angle), top * MM - BRIDLE_HEIGHT, out * sin(angle));
        wires.push(BentWire { name, points: vec![-8.0 * MM * DVec3::Y, foot], radius: 0.7 * MM, density: 1150.0 });
    }
    let under = aside - BRIDLE_HEIGHT * DVec3::Y;
    let mut markers = vec![("CrownHook", DVec3::ZERO), ("CrownMiddle", under)];
    for (k, at) in places(design).into_iter().enumerate() {
        markers.push((named(format!("CrownHole{}", k + 1)), under + at));
    }
    Piece {
        name: "Crown",
        parts: vec![part("Board", board, under, DQuat::IDENTITY, WOOD, finishes.wood)],
        wires,
        markers,
    }
}

/// Positions of the tubes about the centre: evenly around it, none exactly in front of another.
fn places(design: &ChimeDesign) -> Vec<DVec3> {
    let count = design.lengths.len();
    let place = |k: usize| {
        let circle = design.stocks[k % design.stocks.len()].circle();
        let angle = 2.0 * PI * (k as f64 / count as f64) + 1.05 * PI;
        DVec3::new(circle * cos(angle), 0.0, -circle * sin(angle))
    };
    (0..count).map(place).collect()
}

/// The striker on its line, which continues to the sail.
fn striker(drop: f64, finishes: &FinishIndices) -> Piece {
    let height = STRIKER_MASS / (WOOD * PI * STRIKER_RADIUS * STRIKER_RADIUS);
    let (h, edge) = (0.5 * height, 1.5 * MM);
    let profile = [
        (0.0, -h),
        (STRIKER_RADIUS - edge, -h),
        (STRIKER_RADIUS, edge - h),
        (STRIKER_RADIUS, h - edge),
        (STRIKER_RADIUS - edge, h),
        (0.0, h),
    ];
    let disc = revolve(&profile.map(|(r, y)| DVec2::new(r, y)), 2 * ROUND);
    Piece {
        name: "Striker",
        parts: vec![part("StrikerDisc", disc, -drop * DVec3::Y, DQuat::IDENTITY, WOOD, finishes.wood)],
        wires: vec![line("StrikerLine", drop)],
        markers: vec![("StrikerHook", DVec3::ZERO), ("StrikerFoot", -drop * DVec3::Y)],
    }
}

/// The sail on its line: two crossed leaves of 60 mm by 100 mm with rounded corners. However the line twists, one of
/// them faces the wind.
fn sail(finishes: &FinishIndices) -> Piece {
    let (x, y) = (30.0, 50.0);
    // |x/a|⁴ + |y/b|⁴ = 1: a superellipse.
    let soft = |share: f64| share.abs().sqrt().copysign(share);
    let corner = |k: usize| {
        let angle = 2.0 * PI * (k as f64 / ROUND as f64 - 0.25);
        DVec2::new(x * soft(cos(angle)), y * soft(sin(angle)))
    };
    let outline: Polygon = (0..ROUND).map(corner).collect();
    let area = area_and_centroid(&outline).0 * MM * MM;
    let mass = 0.5 * SAIL_MASS;
    let thickness = mass / (LIME_WOOD_DENSITY * area);
    let solid = to_mass(outline, Vec::new(), SheetMass { thickness, density: LIME_WOOD_DENSITY, mass });
    // The other leaf consists of two halves, one on either side.
    let half: Polygon = (0..=ROUND / 2).map(|k| corner(k) * MM).map(|p| p.with_x(p.x.max(0.5 * thickness))).collect();
    let half = extrude(&half, &[], thickness, BEVEL);
    let middle = -SAIL_DISTANCE * DVec3::Y;
    let about = |quarters: f64| rotation(0.5 * PI * quarters * DVec3::Y);
    let leaf = |name, solid, place, turn| part(name, solid, place, turn, LIME_WOOD_DENSITY, finishes.sail);
    let leaves = vec![
        leaf("Sail", solid.translated(middle), DVec3::ZERO, DQuat::IDENTITY),
        leaf("SailFront", half.clone(), middle, about(-1.0)),
        leaf("SailBack", half, middle, about(1.0)),
    ];
    Piece {
        name: "Sail",
        parts: leaves,
        wires: vec![line("SailLine", SAIL_DISTANCE - y * MM)],
        markers: vec![("SailHook", DVec3::ZERO)],
    }
}

/// The GLB file of a chime.
pub fn glb(design: &ChimeDesign) -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = FinishIndices {
        tubes: design.stocks.iter().map(|stock| scene.finish(&stock.finish)).collect(),
        sail: scene.finish(&design.sail),
        wood: scene.finish(&Finish {
            name: "Oiled cherry",
            color: [0.30, 0.115, 0.045],
            metallic: 0.0,
            roughness: 0.42,
            finish: Some("beech"),
        }),
        iron: scene.finish(&Finish {
            name: "Dark iron",
            color: [0.05, 0.05, 0.055],
            metallic: 0.9,
            roughness: 0.45,
            finish: Some("iron-cast"),
        }),
    };
    for (stock, &finish) in design.stocks.iter().zip(&finishes.tubes) {
        if let Some(glass) = &stock.glass {
            scene.clear(finish, glass);
        }
    }
    let (top, drop) = (HOOK_HEIGHT * DVec3::Y, drop(design));
    let lengths = design.lengths.iter().map(|length| length * MM);
    let hanging: Vec<(Piece, Piece, f64)> = (1..)
        .zip(lengths)
        .map(|(k, length)| {
            let down = drop - (STRIKE_FRACTION - HANGING_FRACTION) * length;
            let middle = (HANGING_FRACTION - 0.5) * length * DVec3::Y;
            let turn = (k - 1) % design.stocks.len();
            let stock = &design.stocks[turn];
            let (pipe, finish) = (tube(stock.size, length), finishes.tubes[turn]);
            let own = part(named(format!("Pipe{k}")), pipe, middle, DQuat::IDENTITY, stock.density, finish);
            let markers = vec![(named(format!("Pin{k}")), DVec3::ZERO)];
            let tube = Piece { name: named(format!("Tube{k}")), parts: vec![own], wires: Vec::new(), markers };
            (cord(k, down, &finishes), tube, down)
        })
        .collect();
    let (striker, sail) = (striker(drop, &finishes), sail(&finishes));
    // The bridle's cords stay where they meet, so the offset of the board is found in three iterations.
    let places = places(design);
    let aside = (0..3).fold(DVec3::ZERO, |aside, _| {
        let mut whole = crown(design, aside, &finishes).mass();
        for ((cord, tube, _), at) in hanging.iter().zip(&places) {
            whole = whole.combine(&load(cord.mass().mass + tube.mass().mass, aside + *at));
        }
        whole = whole.combine(&load(striker.mass().mass + sail.mass().mass, aside));
        aside - DVec3::new(whole.center.x, 0.0, whole.center.z)
    });
    let under = top + aside - BRIDLE_HEIGHT * DVec3::Y;
    let mut pieces = vec![(ceiling(finishes.iron), top), (crown(design, aside, &finishes), top)];
    for ((cord, tube, down), at) in hanging.into_iter().zip(places) {
        pieces.push((cord, under + at));
        pieces.push((tube, under + at - down * DVec3::Y));
    }
    pieces.push((striker, under));
    pieces.push((sail, under - drop * DVec3::Y));
    let target = DVec3::new(0.0, 0.75, 0.0);
    let away = DVec3::new(0.28, 0.04, 1.0).normalize();
    write(scene, design.title, &pieces, target + 2.35 * away, target)
}

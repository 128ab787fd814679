//! An aeolian harp: seven strings between a sound box and a curved neck, each with a feather on a stem that plucks it.
//!
//! Every string is pulled by T = 93 N and tuned by its length: f = (1/2L) √(T/μ), so L₁/L is the interval above the lowest.
//! The lowest is steel wire of 0.43 mm, the others are gut of 1.055 mm: both weigh μ = 1.137 g/m, so 650 mm sound A3.
//! A stem hangs on a peg before its string; its bead is 8 mm from it, and the feather below takes the wind.

use soffio_math::{DQuat, DVec2, DVec3, PI, cos, rotation, sin};

use soffio_authoring::glb::{Finish, Scene};
use soffio_authoring::outline::{Polygon, open_spline};
use soffio_authoring::piece::{BentWire, Piece, named};
use soffio_authoring::solid::{extrude, revolve};
use soffio_authoring::stock_parts::{
    BRASS, Finishes, MM, ROUND, STEEL, WOOD, finishes, part, rod, slab, write, y_to_z,
};

/// Intervals above the lowest string: A C D E G A C, just.
const INTERVALS: [f64; 7] = [1.0, 6.0 / 5.0, 4.0 / 3.0, 3.0 / 2.0, 9.0 / 5.0, 2.0, 12.0 / 5.0];
/// Length of the lowest string, m.
const LONGEST: f64 = 650.0 * MM;
/// Radius and density of the steel string and of the gut ones, m and kg/m³.
const WIRES: [(f64, f64); 2] = [(0.215 * MM, STEEL), (0.5276 * MM, 1300.0)];
/// Distance of neighbouring strings, m.
const PITCH: f64 = 52.0 * MM;
/// Spans in which a string is drawn and feels the wind.
const SPANS: usize = 8;
/// Height of the sound box's top above the floor, m.
const BOX_TOP: f64 = 130.0 * MM;
/// Size of the sound box, m.
const BOX: DVec3 = DVec3::new(460.0 * MM, 90.0 * MM, 130.0 * MM);
/// Distance of the posts from the middle, m.
const POST: f64 = 205.0 * MM;
/// Height of a peg above the upper end of its string, m.
const PEG: f64 = 10.0 * MM;
/// Distance of a stem before its string, m.
const BEFORE: f64 = 14.6 * MM;
/// Distance of the bead from the peg, and its radius, m.
const BEAD: [f64; 2] = [110.0 * MM, 6.0 * MM];
/// Length, width and thickness of a feather, m.
const FEATHER: DVec3 = DVec3::new(24.0 * MM, 60.0 * MM, 0.6 * MM);
/// Density of a feather's wood, kg/m³.
const LIME_WOOD: f64 = 530.0;
/// Colours of the feathers, from the lowest string to the highest.
const COLORS: [[f64; 3]; 7] = [
    [0.30, 0.02, 0.02],
    [0.55, 0.10, 0.02],
    [0.65, 0.35, 0.03],
    [0.10, 0.28, 0.06],
    [0.02, 0.24, 0.28],
    [0.03, 0.09, 0.36],
    [0.18, 0.04, 0.28],
];

/// Length of the k-th string, m.
fn length(k: usize) -> f64 {
    LONGEST / INTERVALS[k]
}

/// Upper end of the k-th string, m.
fn top(k: usize) -> DVec3 {
    DVec3::new((k as f64 - 3.0) * PITCH, BOX_TOP + length(k), 0.0)
}

/// The k-th string about its middle.
fn string(k: usize, finish: usize) -> Piece {
    let (radius, density) = WIRES[k.min(1)];
    let name = named(format!("String{}", k + 1));
    let half = 0.5 * length(k);
    let parts = vec![part(name, rod(radius, -half, half), DVec3::ZERO, DQuat::IDENTITY, density, finish)];
    Piece { name, parts, wires: Vec::new(), markers: Vec::new() }
}

/// A straight line in spans, each of which meets its own wind.
fn line(name: &'static str, from: DVec3, to: DVec3, (radius, density): (f64, f64)) -> BentWire {
    BentWire { name, points: (0..=SPANS).map(|i| from.lerp(to, i as f64 / SPANS as f64)).collect(), radius, density }
}

/// The k-th stem with its bead and feather, its origin at its peg.
fn plectrum(k: usize, finishes: &Finishes, color: usize) -> Piece {
    let [down, radius] = BEAD;
    let ball = (0..=12).map(|i| {
        let angle = PI * (f64::from(i) / 12.0 - 0.5);
        DVec2::new(if i % 12 == 0 { 0.0 } else { radius * cos(angle) }, radius * sin(angle))
    });
    let bead = revolve(&ball.collect::<Vec<_>>(), ROUND / 2);
    // A superellipse |x/a|³ + |y/b|³ = 1: a rounded leaf.
    let soft = |share: f64| soffio_math::pow(share.abs(), 2.0 / 3.0).copysign(share);
    let leaf: Polygon = (0..ROUND)
        .map(|i| 2.0 * PI * (i as f64 + 0.5) / ROUND as f64)
        .map(|angle| 0.5 * DVec2::new(FEATHER.x * soft(cos(angle)), FEATHER.y * soft(sin(angle))))
        .collect();
    let leaf = extrude(&leaf, &[], FEATHER.z, 0.1 * MM);
    let foot = down + radius;
    let upright = DQuat::IDENTITY;
    let (bead_name, feather) = (named(format!("Bead{}", k + 1)), named(format!("Feather{}", k + 1)));
    let stem = BentWire {
        name: named(format!("Stem{}", k + 1)),
        points: vec![DVec3::ZERO, -foot * DVec3::Y],
        radius: 0.5 * MM,
        density: BRASS,
    };
    Piece {
        name: named(format!("Plectrum{}", k + 1)),
        parts: vec![
            part(bead_name, bead, -down * DVec3::Y, upright, WOOD, finishes.black),
            part(feather, leaf, -(foot + 0.5 * FEATHER.y) * DVec3::Y, upright, LIME_WOOD, color),
        ],
        wires: vec![stem],
        markers: Vec::new(),
    }
}

/// The neck: a curved board whose lower edge is where the strings end.
fn neck() -> Polygon {
    let mut knots = vec![DVec3::new(-POST - 14.0 * MM, BOX_TOP + LONGEST + 40.0 * MM, 0.0)];
    knots.extend((0..INTERVALS.len()).map(top));
    knots.push(DVec3::new(POST + 14.0 * MM, BOX_TOP + length(6) - 14.0 * MM, 0.0));
    let edge = open_spline(&knots, 8);
    let upper = edge.iter().rev().map(|p| p.truncate() + 24.0 * MM * DVec2::Y);
    edge.iter().map(|p| p.truncate()).chain(upper).collect()
}

/// Everything that stands: box, posts, neck, pegs, bridge, and two stays of 0.8 mm wire crosswise behind the strings.
fn frame(finishes: &Finishes, cherry: usize) -> Piece {
    let upright = DQuat::IDENTITY;
    let middle = (BOX_TOP - 0.5 * BOX.y) * DVec3::Y;
    let post = |name, x: f64, high: f64| {
        part(name, rod(8.0 * MM, BOX_TOP, high), DVec3::new(x, 0.0, 0.0), upright, WOOD, cherry)
    };
    let foot = |name, x: f64| {
        let size = slab(50.0 * MM, 44.0 * MM, BOX.z + 50.0 * MM);
        part(name, size, DVec3::new(x, 22.0 * MM, 0.0), upright, WOOD, finishes.black)
    };
    let mut parts = vec![
        part("Box", slab(BOX.x, BOX.y, BOX.z), middle, upright, WOOD, finishes.wood),
        part("Neck", extrude(&neck(), &[], 18.0 * MM, 2.0 * MM), DVec3::ZERO, upright, WOOD, cherry),
        post("PostLow", -POST, BOX_TOP + LONGEST + 50.0 * MM),
        post("PostHigh", POST, BOX_TOP + length(6) + 5.0 * MM),
        foot("FootLeft", -170.0 * MM),
        foot("FootRight", 170.0 * MM),
        part("Bridge", rod(3.0 * MM, -0.19, 0.19).y_to_x(), BOX_TOP * DVec3::Y, upright, BRASS, finishes.brass),
    ];
    for (k, x) in [-120.0, 0.0, 120.0].into_iter().enumerate() {
        let hole = rod(24.0 * MM, 0.0, 1.0 * MM);
        let at = middle + DVec3::new(x * MM, 0.0, 0.5 * BOX.z);
        parts.push(part(named(format!("Hole{}", k + 1)), hole, at, y_to_z(), WOOD, finishes.black));
    }
    for k in 0..INTERVALS.len() {
        let peg = rod(2.2 * MM, -16.0 * MM, BEFORE + 3.0 * MM);
        parts.push(part(named(format!("Peg{}", k + 1)), peg, top(k) + PEG * DVec3::Y, y_to_z(), BRASS, finishes.brass));
    }
    let stay = |name, side: f64, high: f64| {
        let from = DVec3::new(-side * 0.19, BOX_TOP, -45.0 * MM);
        line(name, from, DVec3::new(side * 0.19, BOX_TOP + high, -9.0 * MM), (0.4 * MM, STEEL))
    };
    let mut wires = vec![stay("StayRising", -1.0, LONGEST + 20.0 * MM), stay("StayFalling", 1.0, length(6))];
    // The strings once more, as the wind meets them.
    for k in 0..INTERVALS.len() {
        let name = named(format!("StringLine{}", k + 1));
        wires.push(line(name, top(k) - length(k) * DVec3::Y, top(k), WIRES[k.min(1)]));
    }
    Piece { name: "Frame", parts, wires, markers: Vec::new() }
}

/// The model.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let cherry = Finish {
        name: "Oiled cherry",
        color: [0.30, 0.115, 0.045],
        metallic: 0.0,
        roughness: 0.42,
        finish: Some("beech"),
    };
    let cherry = scene.finish(&cherry);
    let steel = Finish {
        name: "String wire",
        color: [0.55, 0.55, 0.56],
        metallic: 0.9,
        roughness: 0.3,
        finish: Some("steel-polished"),
    };
    let gut = Finish { name: "Gut", color: [0.80, 0.66, 0.42], metallic: 0.0, roughness: 0.5, finish: None };
    let strings = [scene.finish(&steel), scene.finish(&gut)];
    let mut pieces = vec![(frame(&finishes, cherry), DVec3::ZERO)];
    for (k, color) in COLORS.into_iter().enumerate() {
        let name = named(format!("Feather {}", k + 1));
        let color = scene.finish(&Finish { name, color, metallic: 0.0, roughness: 0.5, finish: None });
        pieces.push((string(k, strings[k.min(1)]), top(k) - 0.5 * length(k) * DVec3::Y));
        pieces.push((plectrum(k, &finishes, color), top(k) + DVec3::new(0.0, PEG, BEFORE)));
    }
    let target = DVec3::new(0.0, 0.415, 0.0);
    let away = rotation(0.45 * DVec3::Y) * DVec3::new(0.0, 0.10, 1.0).normalize();
    write(scene, "Aeolian harp", &pieces, target + 2.0 * away, target)
}

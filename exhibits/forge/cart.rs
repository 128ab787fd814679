//! A sailing cart on a tray: two wheels behind, and a castor in front that a vane turns down the wind.
//!
//! Cart frame: x forward, y up, z to the right; the origin lies on the ground below the middle of the rear axle.

use soffio_math::{DMat3, DQuat, DVec2, DVec3, PI, Pose, cos, rotation, sin};

use soffio_authoring::glb::{Finish, Scene};
use soffio_authoring::outline::{Polygon, ellipse};
use soffio_authoring::piece::{Part, Piece};
use soffio_authoring::solid::{Solid, extrude, revolve_ring};
use soffio_authoring::stock_parts::{BRASS, Finishes, MM, ROUND, STEEL, WOOD, finishes, part, rod, slab, y_to_z};

use crate::sloped_bed::SlopedBed;

/// Distance from the rear axle to the castor's pivot, m.
pub const WHEELBASE: f64 = 92.0 * MM;
/// Half the distance between the rear wheels' middles, m.
pub const HALF_TRACK: f64 = 50.0 * MM;
/// Radius of the rear wheels and of the front wheel over the tyre, m, as in the sidecar.
pub const REAR: f64 = 17.0 * MM;
/// The same of the front wheel.
pub const FRONT: f64 = 12.0 * MM;
/// Distance by which the front wheel trails its pivot, m.
pub const TRAIL: f64 = 12.0 * MM;
/// Width of a tyre, m, as in the sidecar.
const TYRE: f64 = 5.0 * MM;
/// Height of the deck's middle and its thickness, m.
const DECK: [f64; 2] = [31.0 * MM, 3.0 * MM];
/// Place of the mast ahead of the rear axle, m: the wind pulls ahead of the wheels that hold, so the cart turns down the wind.
const MAST: f64 = 56.0 * MM;
/// The sail is a piece of a cylinder: radius, height, and half its angle at the foot and at the head, rad.
const SAIL: [f64; 4] = [58.0 * MM, 92.0 * MM, 1.1, 0.75];
/// Thickness of the sail, m: stiff card.
const CARD: f64 = 0.4 * MM;
/// The tray's floor; its edge is high enough for the cart to roll back.
pub const FLOOR: SlopedBed = SlopedBed { half: DVec2::new(330.0 * MM, 230.0 * MM), height: 24.0 * MM, rise: 9.0 * MM };
/// Start of the rear axle's middle (x, z), m, and the cart's heading from x, rad about y: askew to a visitor's breath.
const START: ([f64; 2], f64) = ([-0.03, 0.05], 0.7);
/// Planes of the sidecar: the four slopes of the floor and the four rims.
const PLANES: [[&str; 2]; 4] =
    [["FloorLeft", "RimLeft"], ["FloorRight", "RimRight"], ["FloorBack", "RimBack"], ["FloorFront", "RimFront"]];

/// The model.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let mut add =
        |name, color, roughness, finish| scene.finish(&Finish { name, color, metallic: 0.0, roughness, finish });
    let rubber = add("Rubber", [0.02, 0.02, 0.021], 0.8, Some("paint-matt"));
    let floor = add("Pale lacquer", [0.42, 0.50, 0.50], 0.35, Some("paint"));
    tray(&finishes, floor).write(&mut scene, Pose::IDENTITY);
    FLOOR.write_planes(&mut scene, PLANES);
    let cart = start();
    let place = |at: DVec3, turn: DQuat| Pose { rotation: cart.rotation * turn, position: cart.point(at) };
    chassis(&finishes).write(&mut scene, cart);
    fork(&finishes).write(&mut scene, place(DVec3::new(WHEELBASE, 0.0, 0.0), DQuat::IDENTITY));
    for (names, side) in
        [(["WheelLeft", "TyreLeft", "DiscLeft"], -1.0), (["WheelRight", "TyreRight", "DiscRight"], 1.0)]
    {
        let at = DVec3::new(0.0, REAR, side * HALF_TRACK);
        wheel(names, REAR, [rubber, finishes.red]).write(&mut scene, place(at, y_to_z()));
    }
    let at = DVec3::new(WHEELBASE - TRAIL, FRONT, 0.0);
    wheel(["WheelFront", "TyreFront", "DiscFront"], FRONT, [rubber, finishes.red])
        .write(&mut scene, place(at, y_to_z()));
    let (eye, target) = (DVec3::new(0.10, 0.56, 1.06), DVec3::new(0.0, 0.035, 0.0));
    scene.camera("CamFront", eye, target, 27.0 * PI / 180.0, 16.0 / 9.0);
    scene.into_glb("Cart", "Original work of the Soffio project; MIT OR Apache-2.0")
}

/// Pose of the cart's frame: its three wheels on the slopes of the tray.
fn start() -> Pose {
    let ([x, z], heading) = START;
    let turn = rotation(heading * DVec3::Y);
    let foot = |local: DVec3| {
        let at = DVec3::new(x, 0.0, z) + turn * local;
        at.with_y(FLOOR.above(DVec2::new(at.x, at.z), 0.0))
    };
    let [left, right] = [-HALF_TRACK, HALF_TRACK].map(|side| foot(side * DVec3::Z));
    let (front, rear) = (foot((WHEELBASE - TRAIL) * DVec3::X), 0.5 * (left + right));
    let (forward, across) = ((front - rear).normalize(), (right - left).normalize());
    let up = across.cross(forward).normalize();
    let rotation = DQuat::from_mat3(&DMat3::from_cols(forward, up, forward.cross(up)));
    // A wheel's edge touches a little beside its middle where floors meet: a fifth of a millimetre above.
    Pose { rotation: rotation.normalize(), position: rear + 0.2 * MM * DVec3::Y }
}

/// Everything on the rear wheels: deck, ballast, axle, mast with yards, and the sail.
fn chassis(finishes: &Finishes) -> Piece {
    let upright = DQuat::IDENTITY;
    let [deck, thickness] = DECK;
    let outline: Polygon = [(-14.0, -26.0), (70.0, -22.0), (104.0, -9.0), (104.0, 9.0), (70.0, 22.0), (-14.0, 26.0)]
        .map(|(x, y)| DVec2::new(x, y) * MM)
        .into();
    let flat = rotation(-0.5 * PI * DVec3::X);
    let [radius, height, _, _] = SAIL;
    let foot = deck + 14.0 * MM;
    let yard = |name, at: f64, half: f64| {
        part(name, rod(1.2 * MM, -half, half), DVec3::new(MAST + 2.5 * MM, at, 0.0), y_to_z(), WOOD, finishes.wood)
    };
    Piece {
        name: "Cart",
        parts: vec![
            part("Deck", extrude(&outline, &[], thickness, 0.4 * MM), deck * DVec3::Y, flat, WOOD, finishes.wood),
            // Low and between the wheels, against a gust from the side.
            part(
                "Ballast",
                slab(40.0 * MM, 26.0 * MM, 4.0 * MM),
                DVec3::new(30.0 * MM, deck - 0.5 * thickness - 2.0 * MM, 0.0),
                flat,
                BRASS,
                finishes.brass,
            ),
            part(
                "AxleBlock",
                slab(12.0 * MM, 60.0 * MM, 10.0 * MM),
                DVec3::new(0.0, deck - 7.0 * MM, 0.0),
                flat,
                WOOD,
                finishes.wood,
            ),
            part(
                "Axle",
                rod(1.2 * MM, -HALF_TRACK - 4.0 * MM, HALF_TRACK + 4.0 * MM),
                REAR * DVec3::Y,
                y_to_z(),
                STEEL,
                finishes.steel,
            ),
            part("Mast", rod(2.0 * MM, deck, foot + height + 14.0 * MM), MAST * DVec3::X, upright, WOOD, finishes.wood),
            yard("LowerYard", foot, radius * sin(SAIL[2])),
            yard("UpperYard", foot + height, radius * sin(SAIL[3])),
            part(
                "Sail",
                sail(),
                DVec3::new(MAST + 4.0 * MM - radius * cos(SAIL[2]), foot, 0.0),
                upright,
                750.0,
                finishes.red,
            ),
        ],
        wires: Vec::new(),
        markers: vec![("Pivot", WHEELBASE * DVec3::X)],
    }
}

/// The sail: a sheet on a cylinder about y that opens backwards, narrower at its head.
fn sail() -> Solid {
    /// Strips across and up: flat to a tenth of a millimetre.
    const STRIPS: [usize; 2] = [24, 8];
    let [radius, height, foot, head] = SAIL;
    let mut solid = Solid::default();
    let (columns, rows) = (STRIPS[0] as u32 + 1, STRIPS[1] as u32 + 1);
    for side in [1.0, -1.0] {
        for row in 0..rows {
            let up = f64::from(row) / f64::from(rows - 1);
            for column in 0..columns {
                let share = 2.0 * f64::from(column) / f64::from(columns - 1) - 1.0;
                let angle = share * (foot + (head - foot) * up);
                let out = DVec3::new(cos(angle), 0.0, sin(angle));
                solid.positions.push((radius + 0.5 * side * CARD) * out + height * up * DVec3::Y);
                solid.normals.push(side * out);
            }
        }
    }
    let back = rows * columns;
    let mut quad = |a: u32, b: u32, c: u32, d: u32| solid.triangles.extend([[a, b, c], [a, c, d]]);
    for row in 0..rows - 1 {
        for column in 0..columns - 1 {
            let at = row * columns + column;
            quad(at, at + columns, at + columns + 1, at + 1);
            quad(back + at, back + at + 1, back + at + columns + 1, back + at + columns);
        }
    }
    // The edges: foot, head, and both sides.
    for column in 0..columns - 1 {
        let (low, high) = (column, back - columns + column);
        quad(low, low + 1, back + low + 1, back + low);
        quad(high, back + high, back + high + 1, high + 1);
    }
    for row in 0..rows - 1 {
        let (left, right) = (row * columns, row * columns + columns - 1);
        quad(left, back + left, back + left + columns, left + columns);
        quad(right, right + columns, back + right + columns, back + right);
    }
    solid
}

/// The castor: a stem in the deck's nose, a yoke, and the vane ahead. Its frame's y axis is the pivot.
fn fork(finishes: &Finishes) -> Piece {
    let upright = DQuat::IDENTITY;
    let leg = |name, side: f64| {
        let at = DVec3::new(-0.5 * TRAIL, 0.5 * (FRONT + DECK[0]) - 3.0 * MM, side * 5.5 * MM);
        part(name, slab(TRAIL + 6.0 * MM, 16.0 * MM, 1.6 * MM), at, upright, WOOD, finishes.wood)
    };
    Piece {
        name: "Fork",
        parts: vec![
            part(
                "Stem",
                rod(1.5 * MM, DECK[0] - 5.0 * MM, DECK[0] + 48.0 * MM),
                DVec3::ZERO,
                upright,
                STEEL,
                finishes.steel,
            ),
            leg("LegLeft", -1.0),
            leg("LegRight", 1.0),
            part(
                "Yoke",
                slab(14.0 * MM, 12.6 * MM, 2.0 * MM),
                DVec3::new(-3.0 * MM, DECK[0] - 4.5 * MM, 0.0),
                rotation(-0.5 * PI * DVec3::X),
                WOOD,
                finishes.wood,
            ),
            part(
                "FrontAxle",
                rod(1.0 * MM, -6.5 * MM, 6.5 * MM),
                DVec3::new(-TRAIL, FRONT, 0.0),
                y_to_z(),
                STEEL,
                finishes.steel,
            ),
            part(
                "Vane",
                slab(40.0 * MM, 30.0 * MM, CARD),
                DVec3::new(23.0 * MM, DECK[0] + 32.0 * MM, 0.0),
                upright,
                750.0,
                finishes.white,
            ),
        ],
        wires: Vec::new(),
        markers: vec![("Hub", DVec3::new(-TRAIL, FRONT, 0.0))],
    }
}

/// A wheel about y: a disc with holes, which show that it rotates, and its tyre.
fn wheel(names: [&'static str; 3], radius: f64, [rubber, paint]: [usize; 2]) -> Piece {
    let (half, felloe) = (0.5 * TYRE, 0.74 * radius);
    let circle = |middle: DVec2, r: f64| ellipse(middle, DVec2::splat(r), 0.0, ROUND);
    let holes: Vec<Polygon> = (0..5)
        .map(|k| 2.0 * PI * f64::from(k) / 5.0)
        .map(|angle| circle(0.45 * radius * DVec2::new(cos(angle), sin(angle)), 0.15 * radius))
        .collect();
    let disc = extrude(&circle(DVec2::ZERO, felloe + 0.2 * MM), &holes, 0.6 * TYRE, 0.3 * MM);
    let shoulder = 0.8 * MM;
    let profile = [
        (felloe, -half),
        (radius - shoulder, -half),
        (radius, shoulder - half),
        (radius, half - shoulder),
        (radius - shoulder, half),
        (felloe, half),
    ];
    let tyre = revolve_ring(&profile.map(|(r, y)| DVec2::new(r, y)), 2 * ROUND);
    let parts: Vec<Part> = vec![
        part(names[1], tyre, DVec3::ZERO, DQuat::IDENTITY, 1100.0, rubber),
        part(names[2], disc, DVec3::ZERO, rotation(-0.5 * PI * DVec3::X), WOOD, paint),
    ];
    Piece { name: names[0], parts, wires: Vec::new(), markers: Vec::new() }
}

/// The tray: its floor and four rims.
fn tray(finishes: &Finishes, floor: usize) -> Piece {
    let flat = rotation(-0.5 * PI * DVec3::X);
    let frame = extrude(&FLOOR.rectangle(26.0 * MM), &[FLOOR.rectangle(0.0)], 62.0 * MM, 1.5 * MM);
    Piece {
        name: "Tray",
        parts: vec![
            part("Floor", FLOOR.solid(31.0 * MM), DVec3::ZERO, DQuat::IDENTITY, WOOD, floor),
            part("Rims", frame, 31.0 * MM * DVec3::Y, flat, WOOD, finishes.wood),
        ],
        wires: Vec::new(),
        markers: Vec::new(),
    }
}

//! A corner where the air is never still: a pinwheel before a vent, and a mobile of card strips before an open window.

use soffio_math::{DQuat, DVec2, DVec3, PI, Pose, atan2, rotation};

use soffio_authoring::glb::Scene;
use soffio_authoring::hanging::{HOLE_RADIUS, PlateSolid, hanging_plate};
use soffio_authoring::mobile::{CascadeBranches, Mobile, cascade};
use soffio_authoring::outline::{Polygon, ellipse};
use soffio_authoring::piece::Piece;
use soffio_authoring::solid::{extrude, revolve};
use soffio_authoring::stock_parts::{
    BRASS, Finishes, MM, ROUND, STEEL, VanePlacement, WOOD, bent_rod_stand, finishes, part, ring, rod, vane, y_to_z,
};

/// Density of Bristol board of 300 g/m², kg/m³, as the sidecar's material.
const CARD: f64 = 750.0;
/// Thickness of Bristol board of 300 g/m², m.
const THICKNESS: f64 = 0.4 * MM;
/// Position of the pinwheel's axle, m.
const PINWHEEL: DVec3 = DVec3::new(-0.125, 0.25, 0.0);
/// Distance of the vent behind the pinwheel, m.
const VENT: f64 = 200.0 * MM;
/// Position of the mobile's hook, m.
const HOOK: DVec3 = DVec3::new(0.12, 0.35, 0.0);
/// Middle of the window that the mobile's draught comes through, m.
const WINDOW: DVec3 = DVec3::new(0.23, 0.24, -0.24);
/// Direction of the lower branch relative to the upper one, rad.
const LOWER_YAW: f64 = 0.9;
/// Names of the pinwheel's vanes.
const VANES: [&str; 5] = ["Vane1", "Vane2", "Vane3", "Vane4", "Vane5"];

/// A rectangle about `middle`.
fn rectangle(middle: DVec2, size: DVec2) -> Polygon {
    let (x, y) = (0.5 * size.x, 0.5 * size.y);
    [(-x, -y), (x, -y), (x, y), (-x, y)].map(|(x, y)| middle + DVec2::new(x, y)).into()
}

/// A strip of card that hangs by a hole near its upper end from a stem.
fn strip(names: [&'static str; 3], size: [f64; 2], stem: f64, finish: usize) -> Piece {
    let (inset, radius) = (4.0 * MM, HOLE_RADIUS * MM);
    let outline = rectangle((inset - 0.5 * size[1]) * DVec2::Y, size.into());
    let hole = ellipse(DVec2::ZERO, DVec2::splat(radius), 0.0, ROUND / 4);
    let solid = extrude(&outline, &[hole], THICKNESS, 0.2 * THICKNESS);
    hanging_plate(names, PlateSolid { solid, density: CARD, finish }, stem)
}

/// The post on which the pinwheel turns.
fn post(finishes: &Finishes) -> Piece {
    let profile = [(0.0, 0.0), (46.0, 0.0), (48.0, 3.0), (16.0, 11.0), (6.0, 40.0), (4.0, 230.0), (4.0, 256.0)];
    let profile = profile.map(|(r, y)| DVec2::new(r, y) * MM).into_iter().chain([DVec2::new(0.0, 256.0 * MM)]);
    let pillar = revolve(&profile.collect::<Vec<_>>(), 2 * ROUND);
    let behind = -34.0 * MM;
    let spindle = rod(1.5 * MM, behind - 6.0 * MM, -6.0 * MM);
    let at = DVec3::new(0.0, PINWHEEL.y, behind);
    Piece {
        name: "Post",
        parts: vec![
            part("Pillar", pillar, behind * DVec3::Z, DQuat::IDENTITY, WOOD, finishes.wood),
            part("Spindle", spindle, PINWHEEL.y * DVec3::Y, y_to_z(), STEEL, finishes.steel),
        ],
        wires: Vec::new(),
        markers: vec![("SpindleEnd", at - behind * DVec3::Z)],
    }
}

/// The pinwheel, its sails red and white in turn.
fn pinwheel(finishes: &Finishes) -> Piece {
    let mut parts = vec![part("Hub", rod(6.0 * MM, -5.0 * MM, 6.0 * MM), DVec3::ZERO, y_to_z(), BRASS, finishes.brass)];
    parts.extend(VANES.into_iter().enumerate().map(|(k, name)| {
        let size = [44.0 * MM, 26.0 * MM, 1.0 * MM];
        let finish = if k % 2 == 0 { finishes.red } else { finishes.white };
        vane(
            name,
            size,
            VanePlacement { radius: 28.0 * MM, angle: 2.0 * PI * k as f64 / VANES.len() as f64, pitch: 0.7 },
            WOOD,
            finish,
        )
    }));
    Piece { name: "Pinwheel", parts, wires: Vec::new(), markers: Vec::new() }
}

/// The vent behind it, a ring on a leg.
fn vent(finishes: &Finishes) -> Piece {
    let (none, upright) = (DVec3::ZERO, DQuat::IDENTITY);
    let height = PINWHEEL.y * DVec3::Y;
    let leg = rod(4.0 * MM, 6.0 * MM, PINWHEEL.y - 50.0 * MM);
    Piece {
        name: "Vent",
        parts: vec![
            part("VentRing", ring(46.0 * MM, 52.0 * MM, 36.0 * MM), height, y_to_z(), STEEL, finishes.steel),
            part("VentLeg", leg, none, upright, STEEL, finishes.black),
            part("VentFoot", rod(40.0 * MM, 0.0, 6.0 * MM), none, upright, STEEL, finishes.black),
        ],
        wires: Vec::new(),
        markers: vec![("VentMouth", height + 18.0 * MM * DVec3::Z)],
    }
}

/// The window, which faces the mobile.
fn window(finishes: &Finishes) -> Piece {
    let draught = DVec3::new(HOOK.x - WINDOW.x, 0.0, HOOK.z - WINDOW.z);
    let middle = WINDOW.y * DVec2::Y;
    let frame = rectangle(0.19 * DVec2::Y, DVec2::new(0.20, 0.38));
    let opening = rectangle(middle, DVec2::new(0.16, 0.24));
    let frame = extrude(&frame, &[opening], 10.0 * MM, 1.0 * MM);
    Piece {
        name: "Window",
        parts: vec![part(
            "Frame",
            frame,
            DVec3::ZERO,
            rotation(atan2(draught.x, draught.z) * DVec3::Y),
            WOOD,
            finishes.white,
        )],
        wires: Vec::new(),
        markers: vec![("WindowMiddle", WINDOW.y * DVec3::Y)],
    }
}

/// The mobile of three strips on two branches, balanced.
fn mobile(finishes: &Finishes) -> Mobile {
    let large = strip(["LargeStrip", "LargeHook", "LargeStem"], [30.0 * MM, 130.0 * MM], 40.0 * MM, finishes.blue);
    let middle = strip(["MiddleStrip", "MiddleHook", "MiddleStem"], [24.0 * MM, 100.0 * MM], 36.0 * MM, finishes.red);
    let small = strip(["SmallStrip", "SmallHook", "SmallStem"], [20.0 * MM, 80.0 * MM], 44.0 * MM, finishes.white);
    let wires = CascadeBranches {
        radius: [0.5 * MM, 0.4 * MM],
        eye: [2.2 * MM, 1.8 * MM],
        chord: [120.0 * MM, 92.0 * MM],
        droop: [8.0 * MM, 5.0 * MM],
        lower_yaw: LOWER_YAW,
    };
    cascade(HOOK, &wires, [large, middle, small], bent_rod_stand(HOOK, DVec2::new(HOOK.x, -0.10), finishes.black))
}

/// Draws, balances and writes the model.
pub fn glb() -> (Mobile, Vec<u8>) {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let mobile = mobile(&finishes);
    let floor = |point: DVec3| DVec3::new(point.x, 0.0, point.z);
    let standing = [
        (&mobile.stand, DVec3::ZERO),
        (&post(&finishes), floor(PINWHEEL)),
        (&pinwheel(&finishes), PINWHEEL),
        (&vent(&finishes), floor(PINWHEEL) - VENT * DVec3::Z),
        (&window(&finishes), floor(WINDOW)),
    ];
    for (piece, position) in standing {
        piece.write(&mut scene, Pose { rotation: DQuat::IDENTITY, position });
    }
    for (piece, pose) in &mobile.pieces {
        piece.write(&mut scene, *pose);
    }
    let (eye, target) = (DVec3::new(0.03, 0.32, 1.0), DVec3::new(0.02, 0.20, 0.0));
    scene.camera("CamFront", eye, target, 27.0 * PI / 180.0, 16.0 / 9.0);
    let copyright = "Original work of the Soffio project; MIT OR Apache-2.0";
    (mobile, scene.into_glb("Windy corner", copyright))
}

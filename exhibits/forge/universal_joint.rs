//! Two shafts at an angle: a rotor in the breath drives a dial through a universal joint.

use soffio_math::{DQuat, DVec2, DVec3, PI, Pose, rotation};

use soffio_authoring::glb::Scene;
use soffio_authoring::piece::Piece;
use soffio_authoring::solid::revolve;
use soffio_authoring::stock_parts::{
    BRASS, MM, ROUND, STEEL, VanePlacement, WOOD, finishes, part, ring, rod, slab, vane, y_to_z,
};

/// Height of both shafts above the floor, m.
const SHAFT: f64 = 200.0 * MM;
/// Angle between the shafts, rad: 35°, at which the dial's speed varies by ±20 %.
pub(crate) const BEND: f64 = 0.61;
/// Distance from the joint to the rotor, m.
const ROTOR: f64 = 90.0 * MM;
/// Distance from the joint to the dial, m.
const DIAL: f64 = 140.0 * MM;

/// The model: each shaft is the z axis of its node, the dial's rotated by the angle.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let (none, along) = (DVec3::ZERO, DQuat::IDENTITY);
    let mut parts = vec![
        part("InShaft", rod(2.5 * MM, 8.0 * MM, ROTOR), none, y_to_z(), STEEL, finishes.steel),
        part("InFork", slab(5.0 * MM, 22.0 * MM, 4.0 * MM), 9.0 * MM * DVec3::Z, along, STEEL, finishes.steel),
        part("InPinUp", rod(2.0 * MM, -12.0 * MM, 12.0 * MM), none, along, BRASS, finishes.brass),
        part("Hub", rod(8.0 * MM, ROTOR - 6.0 * MM, ROTOR + 8.0 * MM), none, y_to_z(), BRASS, finishes.brass),
    ];
    for (k, name) in ["Vane1", "Vane2", "Vane3", "Vane4"].into_iter().enumerate() {
        let size = [74.0 * MM, 34.0 * MM, 1.0 * MM];
        let mut blade = vane(
            name,
            size,
            VanePlacement { radius: 46.0 * MM, angle: 0.5 * PI * k as f64, pitch: 0.6 },
            WOOD,
            finishes.blue,
        );
        blade.place.position.z += ROTOR;
        parts.push(blade);
    }
    let rotor = Piece { name: "Rotor", parts, wires: Vec::new(), markers: Vec::new() };
    let face = [(0.0, -1.5), (52.0, -1.5), (54.0, 0.0), (52.0, 1.5), (0.0, 1.5)];
    let face = revolve(&face.map(|(r, y)| DVec2::new(r, y) * MM), 2 * ROUND);
    let lay = rotation(0.5 * PI * DVec3::Z);
    // As long on either side of the shaft: nothing pulls it round.
    let pointer = |name, side: f64, color| {
        let at = DVec3::new(side * 24.0 * MM, 0.0, 2.5 * MM - DIAL);
        part(name, slab(48.0 * MM, 5.0 * MM, 1.5 * MM), at, along, WOOD, color)
    };
    let dial = Piece {
        name: "Dial",
        parts: vec![
            part("OutShaft", rod(2.5 * MM, -DIAL - 12.0 * MM, -8.0 * MM), none, y_to_z(), STEEL, finishes.steel),
            part("OutFork", slab(22.0 * MM, 5.0 * MM, 4.0 * MM), -9.0 * MM * DVec3::Z, along, STEEL, finishes.steel),
            part("OutPin", rod(2.0 * MM, -12.0 * MM, 12.0 * MM), none, lay, BRASS, finishes.brass),
            part("DialFace", face, -DIAL * DVec3::Z, y_to_z(), WOOD, finishes.white),
            pointer("Pointer", 1.0, finishes.red),
            pointer("PointerTail", -1.0, finishes.wood),
        ],
        wires: Vec::new(),
        markers: vec![("DialEnd", (-DIAL - 12.0 * MM) * DVec3::Z)],
    };
    let top = SHAFT * DVec3::Y;
    let turn = rotation(-BEND * DVec3::Y);
    let bearing = |z: f64| ring(2.7 * MM, 6.0 * MM, 8.0 * MM).translated(z * DVec3::Y);
    let end = top + turn * ((-DIAL - 12.0 * MM) * DVec3::Z);
    let stand = Piece {
        name: "Stand",
        parts: vec![
            part(
                "Base",
                slab(0.34, 0.30, 12.0 * MM),
                DVec3::new(0.03, 6.0 * MM, -0.03),
                rotation(0.5 * PI * DVec3::X),
                WOOD,
                finishes.black,
            ),
            part("InBearing", bearing(50.0 * MM), top, y_to_z(), BRASS, finishes.brass),
            part("OutBearing", bearing(-DIAL - 12.0 * MM), top, turn * y_to_z(), BRASS, finishes.brass),
            part(
                "InPost",
                rod(5.0 * MM, 8.0 * MM, SHAFT - 5.0 * MM),
                DVec3::new(0.0, 0.0, 50.0 * MM),
                along,
                WOOD,
                finishes.black,
            ),
            part("OutPost", rod(5.0 * MM, 8.0 * MM, SHAFT - 5.0 * MM), end.with_y(0.0), along, WOOD, finishes.black),
        ],
        wires: Vec::new(),
        markers: vec![("OutEnd", end)],
    };
    let pose = |rotation, position| Pose { rotation, position };
    stand.write(&mut scene, pose(along, none));
    rotor.write(&mut scene, pose(along, top));
    dial.write(&mut scene, pose(turn, top));
    let target = DVec3::new(0.045, 0.165, -0.03);
    let eye = target + 0.92 * DVec3::new(0.42, 0.32, 1.0).normalize();
    scene.camera("CamFront", eye, target, 27.0 * PI / 180.0, 16.0 / 9.0);
    scene.into_glb("Round the corner", "Original work of the Soffio project; MIT OR Apache-2.0")
}

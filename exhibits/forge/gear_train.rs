//! Four meshing wheels in a row, driven by a weight on the first wheel's drum and braked by a fan on the last.

use soffio_math::{DQuat, DVec2, DVec3, PI, cos, rotation, sin};

use soffio_authoring::glb::Scene;
use soffio_authoring::outline::ellipse;
use soffio_authoring::piece::{Part, Piece};
use soffio_authoring::stock_parts::{
    BRASS, Finishes, LEAD, MM, VanePlacement, WOOD, finishes, meshing_phase, part, rod, slab, spur_gear, vane, write,
    y_to_z,
};

/// Module: pitch diameter over number of teeth, m.
pub const MODULE: f64 = 2.0 * MM;
/// Name and teeth of each wheel, and the direction of the next one, rad.
pub const WHEELS: [(&str, usize, f64); 4] =
    [("Wheel1", 60, 0.35), ("Wheel2", 20, -0.6), ("Wheel3", 36, 0.75), ("Wheel4", 12, 0.0)];
/// Position of the first wheel's axle, m.
const FIRST: DVec3 = DVec3::new(-0.085, 0.25, 0.0);
/// Radius of the drum to the middle of the cord, m.
pub const DRUM: f64 = 6.0 * MM;
/// Thickness of a wheel, m.
const THICKNESS: f64 = 5.0 * MM;

/// The wheels at their positions, and the pins on which they rotate.
fn wheels(finishes: &Finishes) -> (Vec<(Piece, DVec3)>, Vec<Part>) {
    let colors = [finishes.wood, finishes.brass, finishes.wood, finishes.brass];
    let mut pieces: Vec<(Piece, DVec3)> = Vec::new();
    let mut pins = Vec::new();
    let (mut center, mut phase) = (FIRST, 0.0);
    for (i, (name, teeth, toward)) in WHEELS.into_iter().enumerate() {
        let radius = 0.5 * MODULE * teeth as f64;
        // Wheels with spokes where there is space.
        let holes: Vec<_> = (0..if teeth > 30 { 5 } else { 0 })
            .map(|k| {
                let angle = phase + 0.4 * PI * f64::from(k);
                ellipse(0.58 * radius * DVec2::new(cos(angle), sin(angle)), DVec2::splat(0.24 * radius), 0.0, 24)
            })
            .collect();
        let wheel = spur_gear(teeth, MODULE, THICKNESS, phase, &holes);
        let density = if i % 2 == 0 { WOOD } else { BRASS };
        pieces.push((
            Piece {
                name,
                parts: vec![part(name, wheel, DVec3::ZERO, DQuat::IDENTITY, density, colors[i])],
                wires: Vec::new(),
                markers: Vec::new(),
            },
            center,
        ));
        let pin = rod(2.0 * MM, -16.0 * MM, 12.0 * MM);
        pins.push(part(["Pin1", "Pin2", "Pin3", "Pin4"][i], pin, center, y_to_z(), BRASS, finishes.steel));
        if let Some((_, next, _)) = WHEELS.get(i + 1) {
            let apart = 0.5 * MODULE * (teeth + next) as f64;
            phase = meshing_phase(*next, teeth, phase, toward);
            center += apart * DVec3::new(cos(toward), sin(toward), 0.0);
        }
    }
    (pieces, pins)
}

/// Position of the weight: under the left side of the drum.
fn line() -> DVec3 {
    FIRST + DVec3::new(-DRUM, 0.0, 12.0 * MM)
}

/// Plate, foot, legs, the rod on which the weight slides, and the wheels' pins.
fn stand(finishes: &Finishes, pins: Vec<Part>) -> Piece {
    let (along, line) = (DQuat::IDENTITY, line());
    let guide = rod(1.2 * MM, 8.0 * MM, line.y - 2.0 * MM);
    let mut parts = vec![
        part(
            "Plate",
            slab(300.0 * MM, 170.0 * MM, 6.0 * MM),
            DVec3::new(-0.005, 0.262, -0.016),
            along,
            WOOD,
            finishes.black,
        ),
        part(
            "Foot",
            slab(300.0 * MM, 90.0 * MM, 10.0 * MM),
            DVec3::new(-0.005, 0.005, 0.0),
            rotation(0.5 * PI * DVec3::X),
            WOOD,
            finishes.black,
        ),
        part(
            "LegLeft",
            rod(5.0 * MM, 8.0 * MM, 180.0 * MM),
            DVec3::new(-0.14, 0.0, -0.016),
            along,
            WOOD,
            finishes.black,
        ),
        part(
            "LegRight",
            rod(5.0 * MM, 8.0 * MM, 180.0 * MM),
            DVec3::new(0.13, 0.0, -0.016),
            along,
            WOOD,
            finishes.black,
        ),
        part("Guide", guide, DVec3::new(line.x, 0.0, line.z), along, WOOD, finishes.steel),
    ];
    parts.extend(pins);
    Piece { name: "Stand", parts, wires: Vec::new(), markers: Vec::new() }
}

/// The model; all axles are parallel to z.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let (none, along) = (DVec3::ZERO, DQuat::IDENTITY);
    let (mut pieces, pins) = wheels(&finishes);
    let drum = part("Drum", rod(DRUM, 4.0 * MM, 20.0 * MM), none, y_to_z(), WOOD, finishes.wood);
    pieces[0].0.parts.push(drum);
    for (k, name) in ["Fan1", "Fan2", "Fan3", "Fan4"].into_iter().enumerate() {
        let size = [46.0 * MM, 18.0 * MM, 0.8 * MM];
        let mut blade = vane(
            name,
            size,
            VanePlacement { radius: 28.0 * MM, angle: 0.5 * PI * k as f64, pitch: 0.7 },
            WOOD,
            finishes.red,
        );
        blade.place.position.z += 22.0 * MM;
        pieces[3].0.parts.push(blade);
    }
    pieces[3].0.parts.push(part("Arbor", rod(3.0 * MM, 3.0 * MM, 26.0 * MM), none, y_to_z(), WOOD, finishes.wood));
    let weight = Piece {
        name: "Weight",
        parts: vec![part("Weight", rod(9.0 * MM, -14.0 * MM, 14.0 * MM), none, along, LEAD, finishes.lead)],
        wires: Vec::new(),
        markers: Vec::new(),
    };
    pieces.push((weight, line() - 45.0 * MM * DVec3::Y));
    pieces.insert(0, (stand(&finishes, pins), none));
    let (eye, target) = (DVec3::new(0.22, 0.30, 0.90), DVec3::new(0.0, 0.19, 0.0));
    write(scene, "Gear train", &pieces, eye, target)
}

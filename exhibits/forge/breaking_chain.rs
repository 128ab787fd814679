//! A chain of steel links with a disc at its end; one of its joints is weak.

use soffio_math::{DQuat, DVec2, DVec3, PI, rotation};

use soffio_authoring::glb::Scene;
use soffio_authoring::hanging::{SheetStock, disc};
use soffio_authoring::mobile::EYE_STEPS;
use soffio_authoring::outline::ring;
use soffio_authoring::piece::{BentWire, Piece};
use soffio_authoring::stock_parts::{ALUMINIUM, MM, STEEL, bent_rod_stand, finishes, part, rod, slab, write};

/// Length of a link from eye to eye, m.
const PITCH: f64 = 44.0 * MM;
/// Height of the chain's hook above the floor, m.
const HOOK: f64 = 470.0 * MM;
/// Names of the links, the uppermost first.
const LINKS: [&str; 6] = ["Link1", "Link2", "Link3", "Link4", "Link5", "Link6"];
/// Names of the points at the links' upper ends.
const EYES: [&str; 6] = ["Eye1", "Eye2", "Eye3", "Eye4", "Eye5", "Eye6"];
/// Names of the points at the links' lower ends.
const ENDS: [&str; 6] = ["End1", "End2", "End3", "End4", "End5", "End6"];

/// The wire of a link: an eye around its hook, one around its end, perpendicular to each other, and the core between.
fn eyes(name: &'static str) -> BentWire {
    let (wire, eye) = (0.6 * MM, 2.6 * MM);
    let top = ring((wire - eye) * DVec3::Y, eye, DVec3::NEG_Y, DVec3::X, EYE_STEPS);
    let bottom = ring((eye - wire - PITCH) * DVec3::Y, eye, DVec3::Y, DVec3::Z, EYE_STEPS);
    BentWire { name, points: top.into_iter().chain(bottom).collect(), radius: wire, density: STEEL }
}

/// The model: each link hangs at its origin, and its end has a marker.
pub fn glb() -> Vec<u8> {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let along = DQuat::IDENTITY;
    let hook = HOOK * DVec3::Y;
    let mut stand = bent_rod_stand(hook, DVec2::new(0.0, -90.0 * MM), finishes.black);
    let flat = rotation(0.5 * PI * DVec3::X);
    // Landing area of falling parts after a hard breath: mostly forwards and to the left, where the chain swings back.
    let tray = slab(520.0 * MM, 400.0 * MM, 6.0 * MM);
    stand.parts.push(part("Tray", tray, DVec3::new(-40.0 * MM, 15.0 * MM, 20.0 * MM), flat, STEEL, finishes.black));
    let mut pieces = vec![(stand, DVec3::ZERO)];
    for (i, name) in LINKS.into_iter().enumerate() {
        // The weak joint is the one under the third link: the part below it is red.
        let finish = if i < 3 { finishes.steel } else { finishes.red };
        let bar = rod(2.2 * MM, -PITCH + 5.0 * MM, -5.0 * MM);
        let link = Piece {
            name,
            parts: vec![part(name, bar, DVec3::ZERO, along, STEEL, finish)],
            wires: vec![eyes(EYES[i])],
            markers: vec![(ENDS[i], -PITCH * DVec3::Y)],
        };
        pieces.push((link, hook - PITCH * i as f64 * DVec3::Y));
    }
    let plate = disc(
        ["Disc", "DiscHook", "DiscStem"],
        80.0 * MM,
        12.0 * MM,
        SheetStock { thickness: 0.8 * MM, density: ALUMINIUM, finish: finishes.white },
    );
    pieces.push((plate, hook - PITCH * LINKS.len() as f64 * DVec3::Y));
    let (eye, target) = (DVec3::new(0.35, 0.36, 1.10), DVec3::new(0.0, 0.25, 0.0));
    write(scene, "Breaking chain", &pieces, eye, target)
}

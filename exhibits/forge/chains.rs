//! A light and a heavy chain of equal length on a carriage that moves to and fro: side by side, or each alone.
//!
//! The rotation of a link depends on its lever arm and its inertia: a rod of length l about its centre has I/m = l²/12,
//! a plate of width w has I/m = (l² + w²)/12. The heavy links are broad, so their I/m is greater too.

use soffio_math::{DQuat, DVec3, PI, Pose, sincos};

use soffio_authoring::glb::{Key, Scene};
use soffio_authoring::hanging::{SheetStock, disc};
use soffio_authoring::mobile::EYE_STEPS;
use soffio_authoring::outline::ring;
use soffio_authoring::piece::{BentWire, Piece};
use soffio_authoring::stock_parts::{Finishes, MM, STEEL, WOOD, finishes, part, rod, slab, write};

/// Length of a link from eye to eye, m.
const PITCH: f64 = 44.0 * MM;
/// Name of the carriage.
const CARRIAGE: &str = "Carriage";
/// Height of the hooks above the floor, m.
const HOOK: f64 = 500.0 * MM;
/// Distance of the hooks from the carriage's centre, m.
const ASIDE: f64 = 110.0 * MM;
/// Start position of the carriage along x, m.
const START: f64 = -130.0 * MM;
/// Time in which the carriage goes to and fro, s.
const PERIOD: f64 = 4.0;
/// Keys of a period in the animation: its cubic splines follow the sine to 0.2 mm.
const KEYS: usize = 8;
/// Width of a heavy link, m.
const BROAD: f64 = 46.0 * MM;
/// Thickness of a heavy link, m.
const THICK: f64 = 4.0 * MM;

/// Names of a chain: links, their eyes, their ends.
struct Names([[&'static str; 8]; 3]);

/// Names of the light chain's links and points.
const LIGHT: Names = Names([
    ["Light1", "Light2", "Light3", "Light4", "Light5", "Light6", "Light7", "Light8"],
    ["LightEye1", "LightEye2", "LightEye3", "LightEye4", "LightEye5", "LightEye6", "LightEye7", "LightEye8"],
    ["LightEnd1", "LightEnd2", "LightEnd3", "LightEnd4", "LightEnd5", "LightEnd6", "LightEnd7", "LightEnd8"],
]);
/// Names of the heavy chain's links and points.
const HEAVY: Names = Names([
    ["Heavy1", "Heavy2", "Heavy3", "Heavy4", "Heavy5", "Heavy6", "Heavy7", "Heavy8"],
    ["HeavyEye1", "HeavyEye2", "HeavyEye3", "HeavyEye4", "HeavyEye5", "HeavyEye6", "HeavyEye7", "HeavyEye8"],
    ["HeavyEnd1", "HeavyEnd2", "HeavyEnd3", "HeavyEnd4", "HeavyEnd5", "HeavyEnd6", "HeavyEnd7", "HeavyEnd8"],
]);

/// The wire of a link of this radius: an eye around its hook, one around its end, perpendicular to each other.
fn eyes(name: &'static str, wire: f64) -> BentWire {
    let eye = 2.6 * MM;
    let top = ring((wire - eye) * DVec3::Y, eye, DVec3::NEG_Y, DVec3::X, EYE_STEPS);
    let bottom = ring((eye - wire - PITCH) * DVec3::Y, eye, DVec3::Y, DVec3::Z, EYE_STEPS);
    BentWire { name, points: top.into_iter().chain(bottom).collect(), radius: wire, density: STEEL }
}

fn light(names: [&'static str; 3], finishes: &Finishes) -> Piece {
    let [name, eye, end] = names;
    let stick = rod(2.5 * MM, -PITCH + 5.0 * MM, -5.0 * MM);
    Piece {
        name,
        parts: vec![part(name, stick, DVec3::ZERO, DQuat::IDENTITY, WOOD, finishes.wood)],
        wires: vec![eyes(eye, 0.4 * MM)],
        markers: vec![(end, -PITCH * DVec3::Y)],
    }
}

fn heavy(names: [&'static str; 3], finishes: &Finishes) -> Piece {
    let [name, eye, end] = names;
    let plate = slab(BROAD, PITCH - 10.0 * MM, THICK).translated(-0.5 * PITCH * DVec3::Y);
    Piece {
        name,
        parts: vec![part(name, plate, DVec3::ZERO, DQuat::IDENTITY, STEEL, finishes.steel)],
        wires: vec![eyes(eye, 0.8 * MM)],
        markers: vec![(end, -PITCH * DVec3::Y)],
    }
}

/// A chain: its names, one link, its position on the carriage, its peg, hook and disc.
struct Chain {
    names: &'static Names,
    link: fn([&'static str; 3], &Finishes) -> Piece,
    aside: f64,
    peg: &'static str,
    hook: &'static str,
    disc: Piece,
}

fn light_chain(aside: f64, finishes: &Finishes) -> Chain {
    let names = ["LightDisc", "LightDiscHook", "LightDiscStem"];
    let disc =
        disc(names, 64.0 * MM, 12.0 * MM, SheetStock { thickness: 1.5 * MM, density: WOOD, finish: finishes.white });
    Chain { names: &LIGHT, link: light, aside, peg: "LightPeg", hook: "LightHook", disc }
}

fn heavy_chain(aside: f64, finishes: &Finishes) -> Chain {
    let names = ["HeavyDisc", "HeavyDiscHook", "HeavyDiscStem"];
    let disc =
        disc(names, 64.0 * MM, 12.0 * MM, SheetStock { thickness: 3.0 * MM, density: STEEL, finish: finishes.blue });
    Chain { names: &HEAVY, link: heavy, aside, peg: "HeavyPeg", hook: "HeavyHook", disc }
}

/// The carriage, its origin between its hooks.
fn carriage(chains: &[Chain], finishes: &Finishes) -> Piece {
    let along = DQuat::IDENTITY;
    let peg =
        |name, aside: f64| part(name, rod(2.0 * MM, 0.0, 12.0 * MM), aside * DVec3::X, along, STEEL, finishes.steel);
    let reach = chains.iter().fold(15.0 * MM, |reach: f64, chain| reach.max(chain.aside.abs()));
    let bar = slab(2.0 * reach + 30.0 * MM, 12.0 * MM, 12.0 * MM);
    let mut parts = vec![part("CarriageBar", bar, 17.0 * MM * DVec3::Y, along, STEEL, finishes.red)];
    parts.extend(chains.iter().map(|chain| peg(chain.peg, chain.aside)));
    let markers = chains.iter().map(|chain| (chain.hook, chain.aside * DVec3::X)).collect();
    Piece { name: CARRIAGE, parts, wires: Vec::new(), markers }
}

/// The frame with the rail of the carriage.
fn frame(finishes: &Finishes) -> Piece {
    let along = DQuat::IDENTITY;
    let half = 330.0 * MM;
    let rail = rod(4.0 * MM, -half, half).y_to_x();
    let top = HOOK + 17.0 * MM;
    let post =
        |name, x: f64| part(name, rod(5.0 * MM, 0.0, top), DVec3::new(x, 0.0, 0.0), along, STEEL, finishes.black);
    let foot = |name, x: f64| {
        let solid = rod(45.0 * MM, 0.0, 10.0 * MM);
        part(name, solid, DVec3::new(x, 0.0, 0.0), along, STEEL, finishes.black)
    };
    Piece {
        name: "Frame",
        parts: vec![
            part("Rail", rail, top * DVec3::Y, along, STEEL, finishes.steel),
            post("LeftPost", -half),
            post("RightPost", half),
            foot("LeftFoot", -half),
            foot("RightFoot", half),
        ],
        wires: Vec::new(),
        markers: Vec::new(),
    }
}

/// Both chains side by side.
pub fn glb() -> Vec<u8> {
    let (scene, pieces) = drawn(|finishes| vec![light_chain(-ASIDE, finishes), heavy_chain(ASIDE, finishes)]);
    model(scene, "A light and a heavy chain", &pieces)
}

/// The light chain alone. The model's own animation moves its carriage, as one from a modelling program would.
pub fn light_glb() -> Vec<u8> {
    let (mut scene, pieces) = drawn(|finishes| vec![light_chain(0.0, finishes)]);
    let rate = 2.0 * PI / PERIOD;
    let key = |k: usize| {
        let time = PERIOD * k as f64 / KEYS as f64;
        let (s, c) = sincos(rate * time);
        Key { time, place: DVec3::new(START * c, HOOK, 0.0), velocity: DVec3::new(-START * rate * s, 0.0, 0.0) }
    };
    let keys: Vec<Key> = (0..=KEYS).map(key).collect();
    for (piece, position) in &pieces {
        let node = piece.write(&mut scene, Pose { rotation: DQuat::IDENTITY, position: *position });
        if piece.name == CARRIAGE {
            scene.animate("To and fro", node, &keys);
        }
    }
    model(scene, "A light chain", &[])
}

/// The heavy chain alone.
pub fn heavy_glb() -> Vec<u8> {
    let (scene, pieces) = drawn(|finishes| vec![heavy_chain(0.0, finishes)]);
    model(scene, "A heavy chain", &pieces)
}

/// Some chains on their carriage: each link hangs at its origin, and its end has a marker.
fn drawn(chains: fn(&Finishes) -> Vec<Chain>) -> (Scene, Vec<(Piece, DVec3)>) {
    let mut scene = Scene::default();
    let finishes = finishes(&mut scene);
    let middle = DVec3::new(START, HOOK, 0.0);
    let chains = chains(&finishes);
    let mut pieces = vec![(frame(&finishes), DVec3::ZERO), (carriage(&chains, &finishes), middle)];
    for Chain { names: Names(names), link, aside, disc, .. } in chains {
        let hook = middle + aside * DVec3::X;
        for k in 0..names[0].len() {
            let own = [names[0][k], names[1][k], names[2][k]];
            pieces.push((link(own, &finishes), hook - PITCH * k as f64 * DVec3::Y));
        }
        pieces.push((disc, hook - PITCH * names[0].len() as f64 * DVec3::Y));
    }
    (scene, pieces)
}

/// The file of a scene, with pieces that are not in it yet, and its camera.
fn model(scene: Scene, title: &str, pieces: &[(Piece, DVec3)]) -> Vec<u8> {
    let target = DVec3::new(0.0, 0.275, 0.0);
    let away = DVec3::new(0.12 * PI, 0.16, 1.0).normalize();
    write(scene, title, pieces, target + 1.45 * away, target)
}

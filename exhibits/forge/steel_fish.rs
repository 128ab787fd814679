//! A standing mobile after the idea of Alexander Calder's *Steel Fish* (1934): an original drawing at the size of a
//! maquette, about 1:6.
//!
//! ```text
//!                      cup on needle
//!      fish ══════════════╦══════●═══════════════════ tip      ● lead: its length solves the balance
//!                         ║                    ┌──────┴───┐    B2
//!                         ║                 ┌──┴──┐      red   B4
//!                         ║               orange white
//!                       ══╩══
//! ```
//!
//! Frames: every piece has x along its rod, y up, z towards the visitor, and its origin at its hook.
//!
//! Balance: the branches by [`branch`]; for the boom the unknown is the length of the lead weight. It is stable because
//! the centre of mass of all loads is below the point, h = 30 mm: it tilts with the period 2π √(I/(M g h)).

use soffio_math::{DQuat, DVec2, DVec3, PI, Pose};

use soffio_authoring::glb::{Finish, Scene};
use soffio_authoring::hanging::{self, HOLE_RADIUS, PlateSolid, SheetMass, SheetStock, hanging_plate, to_mass};
use soffio_authoring::mobile::{Branch, EYE_STEPS, Mobile, STEEL, branch};
use soffio_authoring::outline::{
    Knot::Corner, Knot::Smooth, area_and_centroid, closed_spline, ellipse, open_spline, ring,
};
use soffio_authoring::piece::{BentWire, Part, Piece, load, yaw};
use soffio_authoring::solid::{Solid, revolve, revolve_ring};

/// A millimetre, m.
const MM: f64 = 1e-3;
/// A gram, kg.
const GRAM: f64 = 1e-3;
/// Segments of a circle.
const ROUND: usize = 64;

/// Density of aluminium, kg/m³, as the sidecar's material.
const ALUMINIUM: f64 = 2700.0;
/// Density of lead, kg/m³, as the sidecar's material.
const LEAD: f64 = 11_300.0;
/// Density of brass, kg/m³, as the sidecar's material.
const BRASS: f64 = 8500.0;

/// Thickness of all plates, m.
const SHEET: f64 = 0.5 * MM;

/// Height of the needle's point above the floor, m.
const POINT_HEIGHT: f64 = 430.0 * MM;
/// Radius of the boom, a steel rod, m.
const BOOM_RADIUS: f64 = 1.0 * MM;
/// Distance of the fish's centre from the point along the boom, m.
const FISH_ARM: f64 = -175.0 * MM;
/// Mass of the fish plate, kg.
const FISH_MASS: f64 = 27.3 * GRAM;
/// Mass of the red plate, kg.
const RED_MASS: f64 = 6.0 * GRAM;
/// Distance of the lead weight's centre from the point along the boom, m.
const LEAD_ARM: f64 = 92.0 * MM;
/// Distance of the hook of B2 from the point along the boom, m.
const TIP_ARM: f64 = 317.0 * MM;

/// Direction of B2 at rest, rad. Directions are free to choose, as hooks rotate freely. Seen from the front, the white
/// disc hangs a finger's breadth in front of the long end of the red plate.
const B2_YAW: f64 = -0.10;
/// Direction of the red plate at rest, rad.
const RED_YAW: f64 = -0.10;
/// Direction of B4 at rest, rad.
const B4_YAW: f64 = -0.52;
/// Direction of the orange disc at rest, rad.
const ORANGE_YAW: f64 = -0.45;
/// Direction of the white disc at rest, rad.
const WHITE_YAW: f64 = -0.05;

/// Finishes of the meshes; paint is dielectric. The sidecar has the finishes of the wires.
struct Finishes {
    black: usize,
    red: usize,
    orange: usize,
    white: usize,
    lead: usize,
    steel: usize,
    brass: usize,
}

fn finishes(scene: &mut Scene) -> Finishes {
    let mut add =
        |name, color, metallic, roughness, finish| scene.finish(&Finish { name, color, metallic, roughness, finish });
    Finishes {
        black: add("Black paint", [0.012, 0.012, 0.013], 0.0, 0.45, Some("paint")),
        red: add("Red paint", [0.55, 0.018, 0.012], 0.0, 0.40, Some("paint")),
        orange: add("Orange paint", [0.80, 0.17, 0.012], 0.0, 0.40, Some("paint")),
        white: add("White paint", [0.80, 0.78, 0.72], 0.0, 0.45, Some("paint")),
        lead: add("Lead", [0.30, 0.31, 0.33], 1.0, 0.55, Some("lead")),
        steel: add("Brushed steel", [0.45, 0.45, 0.46], 1.0, 0.38, Some("steel-brushed")),
        brass: add("Brass", [0.80, 0.57, 0.25], 1.0, 0.30, Some("brass-polished")),
    }
}

/// Designs, balances and writes the model.
pub fn glb() -> (Mobile, Vec<u8>) {
    let mut scene = Scene::default();
    let fish = draw(&finishes(&mut scene));
    fish.stand.write(&mut scene, Pose::IDENTITY);
    for (piece, pose) in &fish.pieces {
        piece.write(&mut scene, *pose);
    }
    // A normal lens slightly left of the mobile and above it, with margins on all sides.
    let target = DVec3::new(0.058, 0.236, 0.0);
    let away = DVec3::new(-0.24, 0.13, 1.0).normalize();
    scene.camera("CamFront", target + 1.20 * away, target, 27.0 * PI / 180.0, 16.0 / 9.0);
    let copyright = "Original composition of the Soffio project; MIT OR Apache-2.0";
    (fish, scene.into_glb("Standing mobile after Steel Fish", copyright))
}

fn draw(finishes: &Finishes) -> Mobile {
    let stock = |finish| SheetStock { thickness: SHEET, density: ALUMINIUM, finish };
    let disc = |names, diameter, length, finish| hanging::disc(names, diameter, length, stock(finish));
    let orange = disc(["OrangeDisc", "OrangeHook", "OrangeStem"], 35.4 * MM, 67.0 * MM, finishes.orange);
    let white = disc(["WhiteDisc", "WhiteHook", "WhiteStem"], 25.8 * MM, 76.0 * MM, finishes.white);
    let b4 = branch(&Branch {
        names: ["B4", "B4Loop", "B4Wire", "B4White", "B4Orange"],
        radius: 0.5 * MM,
        eye: 1.7 * MM,
        chord: 45.0 * MM,
        droop: [6.0 * MM; 2],
        steps: 6,
        loads: [white.mass().mass, orange.mass().mass],
        tips: [None, None],
    });
    let below_b4 = orange.mass().mass + white.mass().mass;
    let red = red_plate(finishes.red);
    let b2 = branch(&Branch {
        names: ["B2", "B2Loop", "B2Wire", "B2Red", "B2Branch"],
        radius: 0.6 * MM,
        eye: 2.0 * MM,
        // The long end of the red plate reaches 15 mm behind the white disc: in most strong breaths they clash.
        chord: 77.0 * MM,
        droop: [8.0 * MM; 2],
        steps: 6,
        loads: [red.mass().mass, b4.mass().mass + below_b4],
        tips: [None, None],
    });
    let tip_load = b2.mass().mass + red.mass().mass + b4.mass().mass + below_b4;
    let boom = boom(finishes, tip_load);

    let boom_pose = Pose { rotation: DQuat::IDENTITY, position: DVec3::new(0.0, POINT_HEIGHT, 0.0) };
    let hanging = |pose: Pose, piece: &Piece, marker, turn| Pose {
        rotation: yaw(turn),
        position: pose.point(piece.marker(marker)),
    };
    let b2_pose = hanging(boom_pose, &boom, "BoomTip", B2_YAW);
    let red_pose = hanging(b2_pose, &b2, "B2Red", RED_YAW);
    let b4_pose = hanging(b2_pose, &b2, "B2Branch", B4_YAW);
    let white_pose = hanging(b4_pose, &b4, "B4White", WHITE_YAW);
    let orange_pose = hanging(b4_pose, &b4, "B4Orange", ORANGE_YAW);
    Mobile {
        pieces: vec![
            (boom, boom_pose),
            (b2, b2_pose),
            (red, red_pose),
            (b4, b4_pose),
            (orange, orange_pose),
            (white, white_pose),
        ],
        stand: stand(finishes),
    }
}

/// Base of turned steel, a slender post with three stays, and the needle under the cup.
fn stand(finishes: &Finishes) -> Piece {
    let mm = |r: f64, y: f64| DVec2::new(r, y) * MM;
    let top = POINT_HEIGHT / MM;
    #[rustfmt::skip] // rows of a drawing
    let footing = [
        mm(0.0, 0.0), mm(72.0, 0.0), mm(73.5, 1.5), mm(73.5, 6.5), mm(72.0, 8.0), mm(14.0, 11.0),
        mm(13.0, 11.6), mm(0.0, 11.6),
    ];
    #[rustfmt::skip] // rows of a drawing
    let post = [
        mm(0.0, 11.6), mm(6.0, 11.6), mm(6.0, 20.0), mm(3.4, 24.0), mm(2.6, 120.0), mm(2.0, top - 24.0),
        mm(3.0, top - 22.0), mm(3.0, top - 17.0), mm(2.0, top - 15.0), mm(1.6, top - 8.0), mm(0.0, top),
    ];
    let (footing, post) = (revolve(&footing, 2 * ROUND), revolve(&post, ROUND / 2));
    let part = |name, solid, finish| Part { name, solid, place: Pose::IDENTITY, density: STEEL, finish };
    let stays = ["StayA", "StayB", "StayC"].into_iter().enumerate().map(|(i, name)| {
        let turn = yaw(2.0 * PI * (i as f64 / 3.0 + 0.08));
        #[rustfmt::skip] // rows of a drawing
        let knots = [
            DVec3::new(58.0, 8.0, 0.0), DVec3::new(30.0, 45.0, 0.0), DVec3::new(9.0, 110.0, 0.0),
            DVec3::new(3.2, 185.0, 0.0),
        ];
        BentWire { name, points: open_spline(&knots.map(|k| turn * (k * MM)), 6), radius: 0.9 * MM, density: STEEL }
    });
    Piece {
        name: "Stand",
        parts: vec![part("Footing", footing, finishes.black), part("Post", post, finishes.steel)],
        wires: stays.collect(),
        markers: vec![("PostPoint", DVec3::new(0.0, POINT_HEIGHT, 0.0))],
    }
}

/// The rod from the fish over the cup to the tip: it runs behind the fish's body, passes through a slot before the
/// tail, rises over the needle, and ends in an eye.
fn boom_rod() -> (Vec<DVec3>, DVec3) {
    #[rustfmt::skip] // rows of a drawing
    let knots = [
        (-232.0, -26.4, -1.3), (-205.0, -28.3, -1.3), (-166.0, -30.3, -1.3), (-150.0, -30.8, 1.3),
        (-108.0, -32.8, 1.3), (-72.0, -34.8, 1.0), (-50.0, -32.8, 0.0), (-33.0, -24.0, 0.0),
        (-15.0, -4.0, 0.0), (0.0, 4.0, 0.0), (15.0, -4.0, 0.0), (33.0, -24.0, 0.0), (50.0, -33.8, 0.0),
        (72.0, -36.3, 0.0), (112.0, -35.3, 0.0), (165.0, -31.3, 0.0), (220.0, -26.3, 0.0),
        (270.0, -23.3, 0.0), (304.0, -24.3, 0.0), (314.5, -26.8, 0.0),
    ];
    let mut points = open_spline(&knots.map(|(x, y, z)| DVec3::new(x, y, z) * MM), 3);
    let eye = 3.0 * MM;
    let center = DVec3::new(TIP_ARM, -27.1 * MM - eye, 0.0);
    points.extend(ring(center, eye, DVec3::Y, DVec3::Z, EYE_STEPS));
    // The loop below rests on the upper side of the lowest wire.
    (points, center - (eye - BOOM_RADIUS) * DVec3::Y)
}

fn boom(finishes: &Finishes, tip_load: f64) -> Piece {
    let (rod, tip) = boom_rod();
    let mm = |r: f64, y: f64| DVec2::new(r, y) * MM;
    // An inverted cup. Its hollow has a half-angle of 23.5°, the needle one of 11.3°: it can tilt by the 12° that
    // the sidecar states before the rim meets the needle.
    let cup = revolve(
        &[mm(0.0, 0.0), mm(2.3, -5.3), mm(3.1, -5.3), mm(3.1, -4.4), mm(2.0, 2.4), mm(1.4, 3.1), mm(0.0, 3.1)],
        ROUND / 2,
    );
    let fish = fish_plate();
    let (fish_center, rod_there) = (fish.mass(STEEL).center, -31.5 * MM);
    let fish_place = Pose { rotation: DQuat::IDENTITY, position: DVec3::new(FISH_ARM, rod_there, 0.0) - fish_center };

    let (lead_point, lead_turn) = threaded(&rod, LEAD_ARM);
    let mut boom = Piece {
        name: "Boom",
        parts: vec![
            Part { name: "FishPlate", solid: fish, place: fish_place, density: STEEL, finish: finishes.black },
            Part { name: "Cup", solid: cup, place: Pose::IDENTITY, density: BRASS, finish: finishes.brass },
        ],
        wires: vec![BentWire { name: "BoomRod", points: rod, radius: BOOM_RADIUS, density: STEEL }],
        markers: vec![("BoomPivot", DVec3::ZERO), ("BoomTip", tip)],
    };
    // Moment of the lead for Σ m x = 0, and its position across the rod for Σ m z = 0.
    let others = boom.mass().combine(&load(tip_load, tip));
    let mass = -others.mass * others.center.x / lead_point.x;
    let across = -others.mass * others.center.z / mass;
    boom.parts.push(Part {
        name: "Counterweight",
        solid: lead_weight(mass),
        place: Pose { rotation: lead_turn, position: DVec3::new(lead_point.x, lead_point.y, across) },
        density: LEAD,
        finish: finishes.lead,
    });
    boom
}

/// Position of a part threaded on `rod` at x = `along`, and its rotation along the rod.
fn threaded(rod: &[DVec3], along: f64) -> (DVec3, DQuat) {
    let i = rod.windows(2).position(|w| w[0].x <= along && along < w[1].x).unwrap_or(0);
    let step = rod[i + 1] - rod[i];
    (rod[i] + step * ((along - rod[i].x) / step.x), DQuat::from_rotation_arc(DVec3::X, step.normalize()))
}

/// A bored barrel of lead with exactly this mass, along x. Its volume grows linearly with its length.
fn lead_weight(mass: f64) -> Solid {
    let barrel = |length: f64| {
        let (bore, radius, edge, half) = (BOOM_RADIUS, 4.6 * MM, 1.0 * MM, 0.5 * length);
        let profile = [
            DVec2::new(bore, -half),
            DVec2::new(radius - edge, -half),
            DVec2::new(radius - 0.3 * edge, -half + 0.3 * edge),
            DVec2::new(radius, -half + edge),
            DVec2::new(radius, half - edge),
            DVec2::new(radius - 0.3 * edge, half - 0.3 * edge),
            DVec2::new(radius - edge, half),
            DVec2::new(bore, half),
        ];
        revolve_ring(&profile, ROUND / 2).y_to_x()
    };
    let (short, long) = (10.0 * MM, 20.0 * MM);
    let (light, heavy) = (barrel(short).mass(LEAD).mass, barrel(long).mass(LEAD).mass);
    barrel(short + (mass - light) / (heavy - light) * (long - short))
}

/// The fish: a leaf with an open mouth, fins and a forked tail, with holes for an eye, a gill and three ribs.
fn fish_plate() -> Solid {
    #[rustfmt::skip] // rows of a drawing
    let knots = [
        Corner(-94.0, 7.0), Corner(-77.0, 0.0), Corner(-88.0, -9.0), Smooth(-70.0, -20.0),
        Smooth(-38.0, -29.0), Smooth(-8.0, -30.5), Corner(12.0, -45.0), Corner(17.0, -27.0),
        Smooth(42.0, -17.0), Smooth(64.0, -8.0), Corner(97.0, -31.0), Smooth(82.0, 3.0), Corner(92.0, 38.0),
        Smooth(62.0, 11.0), Smooth(40.0, 18.0), Corner(22.0, 24.0), Corner(14.0, 50.0), Smooth(-16.0, 33.0),
        Smooth(-48.0, 29.0), Smooth(-76.0, 18.5),
    ];
    let gill = [Corner(-42.0, 18.0), Smooth(-50.0, 0.0), Corner(-43.0, -17.0), Smooth(-46.5, 0.0)];
    let hole = |x: f64, y: f64, a: f64, b: f64, turn: f64| ellipse(DVec2::new(x, y), DVec2::new(a, b), turn, ROUND / 2);
    let outline = closed_spline(&knots, 8);
    let holes = [
        closed_spline(&gill, 8),
        hole(-68.0, 12.0, 4.6, 4.6, 0.0),
        hole(-20.0, -14.0, 8.5, 2.6, 1.25),
        hole(-2.0, -14.5, 7.5, 2.3, 1.15),
        hole(-12.0, 17.0, 10.0, 3.4, 0.15),
        hole(17.0, 1.2, 9.0, 2.4, -0.03),
    ];
    to_mass(outline, holes.to_vec(), SheetMass { thickness: SHEET, density: STEEL, mass: FISH_MASS })
}

/// The red plate: a wing, its long end towards the discs. The hole is above the centre of mass, so it hangs level.
fn red_plate(finish: usize) -> Piece {
    #[rustfmt::skip] // rows of a drawing
    let knots = [
        Corner(-66.0, -6.0), Smooth(-40.0, -13.0), Smooth(-8.0, -15.5), Smooth(22.0, -12.0),
        Smooth(42.0, -1.0), Smooth(47.0, 9.0), Smooth(38.0, 12.0), Smooth(18.0, 9.5), Smooth(-8.0, 8.5),
        Smooth(-38.0, 3.5),
    ];
    let outline = closed_spline(&knots, 8);
    let (_, center) = area_and_centroid(&outline);
    // Drawn about the hole, as far above the centre of mass as the sheet allows.
    let from_hole = outline.iter().map(|p| *p - center - DVec2::new(0.0, 9.0)).collect();
    let hole = ellipse(DVec2::ZERO, DVec2::splat(HOLE_RADIUS), 0.0, ROUND / 4);
    let mut solid = to_mass(from_hole, vec![hole], SheetMass { thickness: SHEET, density: STEEL, mass: RED_MASS });
    // The hole itself moves the centre by some micrometres; correct for them.
    solid = {
        let x = solid.mass(STEEL).center.x;
        solid.translated(DVec3::new(-x, 0.0, 0.0))
    };
    hanging_plate(["RedPlate", "RedHook", "RedStem"], PlateSolid { solid, density: STEEL, finish }, 84.0 * MM)
}

//! Stock that several works are made of: rods, slabs, rings, toothed wheels, a gallows to hang things on, finishes.
//!
//! Lengths in metres; shapes lie about the origin, rods and rings along y, slabs and wheels in the plane z = 0.

use soffio_math::{DQuat, DVec2, DVec3, PI, Pose, cos, rotation, sin};

use super::glb::{Finish, Scene};
use super::outline::{Polygon, open_spline};
use super::piece::{BentWire, Part, Piece};
use super::solid::{Solid, extrude, revolve, revolve_ring};

/// m.
pub const MM: f64 = 1e-3;
/// Corners of a round part.
pub const ROUND: usize = 48;
/// Densities, kg/m³; the sidecars' materials say the same.
pub const STEEL: f64 = 7850.0;
/// kg/m³.
pub const ALUMINIUM: f64 = 2700.0;
/// kg/m³.
pub const BRASS: f64 = 8500.0;
/// kg/m³.
pub const LEAD: f64 = 11_300.0;
/// kg/m³.
pub const COPPER: f64 = 8900.0;
/// Of parts that stand still or whose weight the loader alone needs.
pub const WOOD: f64 = 720.0;

/// Finishes that all works share.
pub struct Finishes {
    /// Index in the scene.
    pub black: usize,
    /// Index in the scene.
    pub red: usize,
    /// Index in the scene.
    pub white: usize,
    /// Index in the scene.
    pub blue: usize,
    /// Index in the scene.
    pub wood: usize,
    /// Index in the scene.
    pub steel: usize,
    /// Index in the scene.
    pub brass: usize,
    /// Index in the scene.
    pub lead: usize,
}

/// Adds the finishes to a scene.
pub fn finishes(scene: &mut Scene) -> Finishes {
    let mut add = |name, color, metallic, roughness| scene.finish(&Finish { name, color, metallic, roughness });
    Finishes {
        black: add("Black paint", [0.012, 0.012, 0.013], 0.0, 0.45),
        red: add("Red paint", [0.55, 0.018, 0.012], 0.0, 0.40),
        white: add("White paint", [0.80, 0.78, 0.72], 0.0, 0.45),
        blue: add("Blue paint", [0.02, 0.08, 0.35], 0.0, 0.40),
        wood: add("Oiled beech", [0.52, 0.33, 0.17], 0.0, 0.55),
        steel: add("Brushed steel", [0.45, 0.45, 0.46], 1.0, 0.38),
        brass: add("Brass", [0.80, 0.57, 0.25], 1.0, 0.30),
        lead: add("Lead", [0.30, 0.31, 0.33], 1.0, 0.55),
    }
}

/// A round rod about y, from `low` to `high`.
pub fn rod(radius: f64, low: f64, high: f64) -> Solid {
    let edge = 0.15 * radius.min(0.5 * (high - low));
    let profile =
        [(0.0, low), (radius - edge, low), (radius, low + edge), (radius, high - edge), (radius - edge, high)];
    let profile: Vec<DVec2> = profile.iter().map(|&(r, y)| DVec2::new(r, y)).chain([DVec2::new(0.0, high)]).collect();
    revolve(&profile, ROUND)
}

/// A flat ring about y, `thickness` high.
pub fn ring(inner: f64, outer: f64, thickness: f64) -> Solid {
    let half = 0.5 * thickness;
    let corners = [(inner, -half), (outer, -half), (outer, half), (inner, half)];
    revolve_ring(&corners.map(|(r, y)| DVec2::new(r, y)), 2 * ROUND)
}

/// A thin board with its long side along x.
pub fn slab(length: f64, width: f64, thickness: f64) -> Solid {
    let (x, y) = (0.5 * length, 0.5 * width);
    let outline: Polygon = [(-x, -y), (x, -y), (x, y), (-x, y)].map(|(x, y)| DVec2::new(x, y)).into();
    extrude(&outline, &[], thickness, 0.15 * thickness)
}

/// A spur wheel with straight-sided teeth: `module` is twice the pitch radius over the number of teeth. A tooth's middle
/// lies at the angle `phase`.
pub fn spur_gear(teeth: usize, module: f64, thickness: f64, phase: f64, holes: &[Polygon]) -> Solid {
    let pitch = 0.5 * module * teeth as f64;
    let (tip, root) = (pitch + module, pitch - 1.25 * module);
    let step = 2.0 * PI / teeth as f64;
    // Half a tooth on the pitch circle, less some play; narrower at the tip, wider at the root.
    let corners = [(root, -0.36), (tip, -0.13), (tip, 0.13), (root, 0.36)];
    let outline: Polygon = (0..teeth)
        .flat_map(|k| corners.map(|(r, share)| (r, phase + step * (k as f64 + share))))
        .map(|(r, angle)| DVec2::new(r * cos(angle), r * sin(angle)))
        .collect();
    extrude(&outline, holes, thickness, 0.3 * MM)
}

/// Where the middle of a tooth must lie on a wheel that meshes with another along the direction `toward` (rad, from the
/// other's centre), so that a tooth of one meets a gap of the other.
pub fn meshing_phase(teeth: usize, other_teeth: usize, other_phase: f64, toward: f64) -> f64 {
    let turn = 2.0 * PI;
    let share = 0.5 - (toward - other_phase) * other_teeth as f64 / turn;
    toward + PI - share * turn / teeth as f64
}

/// Turns what lies along y to lie along z.
pub fn y_to_z() -> DQuat {
    rotation(0.5 * PI * DVec3::X)
}

/// A part with its frame at `position`, turned.
pub fn part(name: &'static str, solid: Solid, position: DVec3, rotation: DQuat, density: f64, finish: usize) -> Part {
    Part { name, solid, place: Pose { rotation, position }, density, finish }
}

/// A board of a fan: its long side leads outwards at `angle` about z, its face leans by `pitch` from facing z.
pub fn vane(name: &'static str, size: [f64; 3], radius: f64, angle: f64, pitch: f64, stuff: (f64, usize)) -> Part {
    let turn = rotation(angle * DVec3::Z);
    let lean = rotation(pitch * DVec3::X);
    part(name, slab(size[0], size[1], size[2]), turn * (radius * DVec3::X), turn * lean, stuff.0, stuff.1)
}

/// A foot with a bent rod that ends at `top`: the rod stands at `post` (x, z) and bows over. The sidecar draws the rod
/// through `StandRod.*`, 3 mm in radius.
pub fn bent_rod_stand(top: DVec3, post: DVec2, finish: usize) -> Piece {
    let foot = [(0.0, 0.0), (58.0, 0.0), (60.0, 2.0), (60.0, 7.0), (57.0, 9.0), (8.0, 12.0), (0.0, 12.0)];
    let foot = revolve(&foot.map(|(r, y)| DVec2::new(r, y) * MM), 2 * ROUND);
    let at = |height: f64, share: f64| {
        DVec3::new(post.x, 0.0, post.y) * (1.0 - share) + DVec3::new(top.x * share, height, top.z * share)
    };
    // The spline asks for knots about equally far apart: only the crook is one.
    let crook = [at(top.y - 36.0 * MM, 0.0), at(top.y - 12.0 * MM, 0.0), at(top.y + 12.0 * MM, 0.35), top];
    let rod = std::iter::once(at(8.0 * MM, 0.0)).chain(open_spline(&crook, 8)).collect();
    Piece {
        name: "Stand",
        parts: vec![part("Foot", foot, DVec3::new(post.x, 0.0, post.y), DQuat::IDENTITY, STEEL, finish)],
        wires: vec![BentWire { name: "StandRod", points: rod, radius: 3.0 * MM, density: STEEL }],
        markers: vec![("StandHook", top)],
    }
}

/// A rod from the ceiling whose hook's foot is at the origin. The sidecar draws the hook through `CeilingHook.*`, 1.5 mm in
/// radius.
pub fn ceiling(finish: usize) -> Piece {
    let rose =
        [(0.0, 0.8), (30.0, 0.8), (30.0, 0.806), (26.0, 0.812), (0.0, 0.812)].map(|(r, y)| DVec2::new(r * MM, y));
    let hook = (0..=10).map(|k| {
        let angle = 1.5 * PI * f64::from(k) / 10.0;
        DVec3::new(-6.0 * MM * sin(angle), 6.0 * MM * (1.0 - cos(angle)), 0.0)
    });
    Piece {
        name: "Ceiling",
        parts: vec![
            part("Rose", revolve(&rose, ROUND), DVec3::ZERO, DQuat::IDENTITY, STEEL, finish),
            part("Rod", rod(1.5 * MM, 12.0 * MM, 0.8), DVec3::ZERO, DQuat::IDENTITY, STEEL, finish),
        ],
        wires: vec![BentWire { name: "CeilingHook", points: hook.collect(), radius: 1.5 * MM, density: STEEL }],
        markers: vec![("CeilingPoint", DVec3::ZERO)],
    }
}

/// Writes pieces and a camera that looks from `eye` at `target`.
pub fn write(mut scene: Scene, name: &str, pieces: &[(Piece, DVec3)], eye: DVec3, target: DVec3) -> Vec<u8> {
    for (piece, position) in pieces {
        piece.write(&mut scene, Pose { rotation: DQuat::IDENTITY, position: *position });
    }
    scene.camera("CamFront", eye, target, 27.0 * PI / 180.0, 16.0 / 9.0);
    scene.into_glb(name, "Original work of the Soffio project; MIT OR Apache-2.0")
}

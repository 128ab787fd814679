//! Standard parts of several exhibits: rods, slabs, rings, gear wheels, a stand, a ceiling hook, finishes.
//!
//! Lengths in metres. Shapes are centred at the origin: rods and rings along y, slabs and wheels in the plane z = 0.

use soffio_math::{DQuat, DVec2, DVec3, PI, Pose, cos, rotation, sin};

use super::glb::{Finish, Scene};
use super::outline::{Polygon, open_spline};
use super::piece::{BentWire, Part, Piece};
use super::solid::{Solid, extrude, revolve, revolve_ring};

/// A millimetre, m.
pub const MM: f64 = 1e-3;
/// Segments of a circle.
pub const ROUND: usize = 48;
/// Density of steel, kg/m³, as in the built-in materials.
pub const STEEL: f64 = 7850.0;
/// Density of aluminium, kg/m³.
pub const ALUMINIUM: f64 = 2700.0;
/// Density of brass, kg/m³.
pub const BRASS: f64 = 8500.0;
/// Density of lead, kg/m³.
pub const LEAD: f64 = 11_300.0;
/// Density of copper, kg/m³.
pub const COPPER: f64 = 8900.0;
/// Density of wood, kg/m³, for fixed parts and parts whose mass only the loader needs.
pub const WOOD: f64 = 720.0;

/// Indices of the finishes that all exhibits share.
pub struct Finishes {
    /// Black paint.
    pub black: usize,
    /// Red paint.
    pub red: usize,
    /// White paint.
    pub white: usize,
    /// Blue paint.
    pub blue: usize,
    /// Oiled beech.
    pub wood: usize,
    /// Brushed steel.
    pub steel: usize,
    /// Brass.
    pub brass: usize,
    /// Lead.
    pub lead: usize,
}

/// Adds the finishes to a scene.
pub fn finishes(scene: &mut Scene) -> Finishes {
    let mut add =
        |name, color, metallic, roughness, finish| scene.finish(&Finish { name, color, metallic, roughness, finish });
    Finishes {
        black: add("Black paint", [0.012, 0.012, 0.013], 0.0, 0.45, Some("paint")),
        red: add("Red paint", [0.55, 0.018, 0.012], 0.0, 0.40, Some("paint")),
        white: add("White paint", [0.80, 0.78, 0.72], 0.0, 0.45, Some("paint")),
        blue: add("Blue paint", [0.02, 0.08, 0.35], 0.0, 0.40, Some("paint")),
        wood: add("Oiled beech", [0.52, 0.33, 0.17], 0.0, 0.55, Some("beech")),
        steel: add("Brushed steel", [0.45, 0.45, 0.46], 1.0, 0.38, Some("steel-brushed")),
        brass: add("Brass", [0.80, 0.57, 0.25], 1.0, 0.30, Some("brass-polished")),
        lead: add("Lead", [0.30, 0.31, 0.33], 1.0, 0.55, Some("lead")),
    }
}

/// A round rod of this radius about y, from `low` to `high`, m, with bevelled edges.
pub fn rod(radius: f64, low: f64, high: f64) -> Solid {
    let edge = 0.15 * radius.min(0.5 * (high - low));
    let profile =
        [(0.0, low), (radius - edge, low), (radius, low + edge), (radius, high - edge), (radius - edge, high)];
    let profile: Vec<DVec2> = profile.iter().map(|&(r, y)| DVec2::new(r, y)).chain([DVec2::new(0.0, high)]).collect();
    revolve(&profile, ROUND)
}

/// A flat ring about y between two radii, `thickness` high, m.
pub fn ring(inner: f64, outer: f64, thickness: f64) -> Solid {
    let half = 0.5 * thickness;
    let corners = [(inner, -half), (outer, -half), (outer, half), (inner, half)];
    revolve_ring(&corners.map(|(r, y)| DVec2::new(r, y)), 2 * ROUND)
}

/// A thin board in the xy plane, its length along x and its width along y, m.
pub fn slab(length: f64, width: f64, thickness: f64) -> Solid {
    let (x, y) = (0.5 * length, 0.5 * width);
    let outline: Polygon = [(-x, -y), (x, -y), (x, y), (-x, y)].map(|(x, y)| DVec2::new(x, y)).into();
    extrude(&outline, &[], thickness, 0.15 * thickness)
}

/// A spur gear with straight-sided teeth about z: `module` is twice the pitch radius over the number of teeth, m. The middle
/// of a tooth is at the angle `phase`, rad. `thickness` in m; `holes` are cut out of its disc, m.
pub fn spur_gear(teeth: usize, module: f64, thickness: f64, phase: f64, holes: &[Polygon]) -> Solid {
    let pitch = 0.5 * module * teeth as f64;
    let (tip, root) = (pitch + module, pitch - 1.25 * module);
    let step = 2.0 * PI / teeth as f64;
    // Half a tooth on the pitch circle, minus some backlash; narrower at the tip, wider at the root.
    let corners = [(root, -0.36), (tip, -0.13), (tip, 0.13), (root, 0.36)];
    let outline: Polygon = (0..teeth)
        .flat_map(|k| corners.map(|(r, share)| (r, phase + step * (k as f64 + share))))
        .map(|(r, angle)| DVec2::new(r * cos(angle), r * sin(angle)))
        .collect();
    extrude(&outline, holes, thickness, 0.3 * MM)
}

/// Phase of a wheel that meshes with another in the direction `toward` (rad, from the other's centre), so that its
/// teeth meet the gaps of the other.
pub fn meshing_phase(teeth: usize, other_teeth: usize, other_phase: f64, toward: f64) -> f64 {
    let turn = 2.0 * PI;
    let share = 0.5 - (toward - other_phase) * other_teeth as f64 / turn;
    toward + PI - share * turn / teeth as f64
}

/// Rotation from the y axis to the z axis.
pub fn y_to_z() -> DQuat {
    rotation(0.5 * PI * DVec3::X)
}

/// A part with its frame at `position`, m, and `rotation`; `density` in kg/m³, `finish` the index of its material in the
/// model.
pub fn part(name: &'static str, solid: Solid, position: DVec3, rotation: DQuat, density: f64, finish: usize) -> Part {
    Part { name, solid, place: Pose { rotation, position }, density, finish }
}

/// Where a vane of a fan sits.
#[derive(Clone, Copy, Debug)]
pub struct VanePlacement {
    /// Distance of its centre from the z axis, m.
    pub radius: f64,
    /// Direction of its long side, rad about z.
    pub angle: f64,
    /// Angle between the normal of its face and the z axis, rad.
    pub pitch: f64,
}

/// A vane of a fan, a thin board whose long side points outwards: `size` is its length, width and thickness, m, `density` in
/// kg/m³, `finish` the index of its material in the model.
pub fn vane(name: &'static str, size: [f64; 3], at: VanePlacement, density: f64, finish: usize) -> Part {
    let VanePlacement { radius, angle, pitch } = at;
    let turn = rotation(angle * DVec3::Z);
    let lean = rotation(pitch * DVec3::X);
    part(name, slab(size[0], size[1], size[2]), turn * (radius * DVec3::X), turn * lean, density, finish)
}

/// A foot with a bent rod that ends at `top`; the rod rises at `post` (x, z). The sidecar draws the rod through
/// `StandRod.*`, 3 mm in radius.
pub fn bent_rod_stand(top: DVec3, post: DVec2, finish: usize) -> Piece {
    let foot = [(0.0, 0.0), (58.0, 0.0), (60.0, 2.0), (60.0, 7.0), (57.0, 9.0), (8.0, 12.0), (0.0, 12.0)];
    let foot = revolve(&foot.map(|(r, y)| DVec2::new(r, y) * MM), 2 * ROUND);
    let at = |height: f64, share: f64| {
        DVec3::new(post.x, 0.0, post.y) * (1.0 - share) + DVec3::new(top.x * share, height, top.z * share)
    };
    // The spline needs knots about equally far apart: only the bend is one.
    let crook = [at(top.y - 36.0 * MM, 0.0), at(top.y - 12.0 * MM, 0.0), at(top.y + 12.0 * MM, 0.35), top];
    let rod = std::iter::once(at(8.0 * MM, 0.0)).chain(open_spline(&crook, 8)).collect();
    Piece {
        name: "Stand",
        parts: vec![part("Foot", foot, DVec3::new(post.x, 0.0, post.y), DQuat::IDENTITY, STEEL, finish)],
        wires: vec![BentWire { name: "StandRod", points: rod, radius: 3.0 * MM, density: STEEL }],
        markers: vec![("StandHook", top)],
    }
}

/// A rod from the ceiling with a hook whose lowest point is the origin. The sidecar draws the hook through
/// `CeilingHook.*`, 1.5 mm in radius.
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

/// The GLB file of some pieces, with a camera at `eye` that looks at `target`.
pub fn write(mut scene: Scene, name: &str, pieces: &[(Piece, DVec3)], eye: DVec3, target: DVec3) -> Vec<u8> {
    for (piece, position) in pieces {
        piece.write(&mut scene, Pose { rotation: DQuat::IDENTITY, position: *position });
    }
    scene.camera("CamFront", eye, target, 27.0 * PI / 180.0, 16.0 / 9.0);
    scene.into_glb(name, "Original work of the Soffio project; MIT OR Apache-2.0")
}

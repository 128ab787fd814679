//! Patches: the small pieces of a surface at which the wind is felt.
//!
//! A mesh is split into points of equal area, spread over its triangles by a low-discrepancy sequence (R₂ of
//! M. Roberts, 2018, seeded by an offset), each with the outward normal of its triangle. A wire is split into short
//! lengths, each feeling the flow across it.

use super::{Surface, SurfaceShape};
use crate::geometry::TriangleMesh;
use crate::math::DVec3;
use crate::noise::Random;

/// One piece of surface in the node frame of its body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// Middle, m.
    pub point: DVec3,
    /// How the wind takes hold of it.
    pub face: Face,
    /// m²: of the face, or length times diameter of a wire.
    pub area: f64,
}

/// How the wind takes hold of a patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Face {
    /// One side of a surface, with its outward unit normal.
    Side(DVec3),
    /// A sheet without thickness: flow from either side takes hold of it. Unit normal.
    Sheet(DVec3),
    /// A wire, with its unit direction.
    Wire(DVec3),
}

/// Length of wire per patch over its diameter; and never fewer than this many per segment.
const WIRE_PIECE: f64 = 0.02;

/// The patches of a surface.
pub fn split(surface: &Surface) -> Vec<Patch> {
    match &surface.shape {
        SurfaceShape::Mesh { mesh, per_area, count, sheet, seed } => {
            let face = if *sheet { Face::Sheet } else { Face::Side };
            sample_mesh(mesh, *per_area, *count, *seed, face)
        }
        SurfaceShape::Wire { points, radius } => points
            .windows(2)
            .flat_map(|ends| {
                let way = ends[1] - ends[0];
                let pieces = (way.length() / WIRE_PIECE).ceil().max(1.0);
                let direction = way.normalize_or(DVec3::X);
                let area = way.length() / pieces * 2.0 * radius;
                let start = ends[0];
                (0..pieces as usize).map(move |i| Patch {
                    point: start + way * ((i as f64 + 0.5) / pieces),
                    face: Face::Wire(direction),
                    area,
                })
            })
            .collect(),
    }
}

fn sample_mesh(
    mesh: &TriangleMesh,
    per_area: f64,
    (least, most): (usize, usize),
    seed: u64,
    face: impl Fn(DVec3) -> Face,
) -> Vec<Patch> {
    // Running sum of triangle areas, to place points by their share of the whole.
    let mut sums = Vec::with_capacity(mesh.triangles.len());
    let mut total = 0.0;
    let corners = |t: &[u32; 3]| t.map(|i| mesh.positions[i as usize]);
    for triangle in &mesh.triangles {
        let [a, b, c] = corners(triangle);
        total += 0.5 * (b - a).cross(c - a).length();
        sums.push(total);
    }
    if total <= 0.0 {
        return Vec::new();
    }
    let count = ((total * per_area).ceil() as usize).clamp(least.max(1), most.max(1));
    // The plastic number's powers: the R₂ sequence.
    const R2: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053];
    let mut random = Random::new(seed);
    let offset = [random.unit(), random.unit()];
    (0..count)
        .map(|i| {
            let share = (i as f64 + 0.5) / count as f64 * total;
            let triangle = sums.partition_point(|&s| s < share).min(mesh.triangles.len() - 1);
            let [a, b, c] = corners(&mesh.triangles[triangle]);
            let mut u = (offset[0] + R2[0] * i as f64).fract();
            let mut v = (offset[1] + R2[1] * i as f64).fract();
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let normal = (b - a).cross(c - a).normalize_or(DVec3::Y);
            Patch { point: a + u * (b - a) + v * (c - a), face: face(normal), area: total / count as f64 }
        })
        .collect()
}

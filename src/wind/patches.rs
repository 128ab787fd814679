//! Patches: the small pieces of a surface at which the wind is felt.
//!
//! A mesh is split into points spread over its triangles by a low-discrepancy sequence (R₂ of M. Roberts, 2018, seeded
//! by an offset), as many a triangle as its share of the area asks for, each with the triangle's outward normal. The
//! triangle's area is divided among its points; triangles too small for a point give theirs to the nearest point that
//! looks the same way. So the areas that face any one way add up, to rounding, to those of the surface wherever each
//! flat face has a point. A wire is split into short lengths, each feeling the flow across and along it.

use super::{Surface, SurfaceShape};
use soffio_geometry::TriangleMesh;
use soffio_math::DVec3;
use soffio_math::noise::Random;

/// One piece of surface in the node frame of its body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// Triangle of the surface's mesh that it lies on, or piece of the wire.
    pub element: usize,
    /// Middle, m.
    pub point: DVec3,
    /// Outward unit normal, or the wire's unit direction.
    pub axis: DVec3,
    /// How the wind takes hold of it.
    pub face: Face,
    /// m²: of the face, or length times diameter of a wire.
    pub area: f64,
}

/// How the wind takes hold of a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Face {
    /// One side of a surface.
    Side,
    /// A sheet without thickness: flow from either side takes hold of it.
    Sheet,
    /// A round wire.
    Wire,
}

/// Longest piece of wire that is one patch, m.
const WIRE_PIECE: f64 = 0.02;
/// What a normal that points another way counts as, against distance over the surface's size.
const LOOKS_AWAY: f64 = 4.0;

/// The patches of a surface.
pub fn split(surface: &Surface) -> Vec<Patch> {
    match &surface.shape {
        SurfaceShape::Mesh { mesh, per_area, count, sheet, seed } => {
            sample_mesh(mesh, *per_area, *count, *seed, if *sheet { Face::Sheet } else { Face::Side })
        }
        SurfaceShape::Wire { points, radius } => {
            let mut out = Vec::new();
            for ends in points.windows(2) {
                let way = ends[1] - ends[0];
                let pieces = (way.length() / WIRE_PIECE).ceil().max(1.0);
                for i in 0..pieces as usize {
                    out.push(Patch {
                        element: out.len(),
                        point: ends[0] + way * ((i as f64 + 0.5) / pieces),
                        axis: way.normalize_or(DVec3::X),
                        face: Face::Wire,
                        area: way.length() / pieces * 2.0 * radius,
                    });
                }
            }
            out
        }
    }
}

fn sample_mesh(mesh: &TriangleMesh, per_area: f64, (least, most): (usize, usize), seed: u64, face: Face) -> Vec<Patch> {
    let areas: Vec<f64> = mesh.corners().map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).collect();
    let total: f64 = areas.iter().sum();
    if total <= 0.0 {
        return Vec::new();
    }
    let count = ((total * per_area).ceil() as usize).clamp(least.max(1), most.max(1));
    // The plastic number's powers: the R₂ sequence.
    const R2: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053];
    let mut random = Random::new(seed);
    let offset = [random.unit(), random.unit()];
    let mut patches = Vec::with_capacity(count);
    let mut left_over = Vec::new();
    let mut sum = 0.0;
    for (triangle, [a, b, c]) in mesh.corners().enumerate() {
        let area = areas[triangle];
        // Where the running sum of areas passes the middles of `count` equal shares.
        let passed = |sum: f64| (sum / total * count as f64 + 0.5).floor().min(count as f64) as usize;
        let range = passed(sum)..passed(sum + area);
        sum += area;
        let axis = (b - a).cross(c - a).normalize_or(DVec3::Y);
        if range.is_empty() {
            left_over.push(((a + b + c) / 3.0, axis, area));
            continue;
        }
        let share = area / range.len() as f64;
        for i in range {
            let mut u = (offset[0] + R2[0] * i as f64).fract();
            let mut v = (offset[1] + R2[1] * i as f64).fract();
            if u + v > 1.0 {
                (u, v) = (1.0 - u, 1.0 - v);
            }
            let point = a + u * (b - a) + v * (c - a);
            patches.push(Patch { element: triangle, point, axis, face, area: share });
        }
    }
    give_away(&mut patches, &left_over, total);
    patches
}

/// Gives the areas of triangles without a point (middle, normal, area) to the nearest patches that look the same way.
fn give_away(patches: &mut [Patch], left_over: &[(DVec3, DVec3, f64)], total: f64) {
    let places: Vec<(DVec3, DVec3)> = patches.iter().map(|patch| (patch.point, patch.axis)).collect();
    for &(middle, normal, area) in left_over {
        let far = |&(point, axis): &(DVec3, DVec3)| {
            let facing = if patches.first().is_some_and(|p| p.face == Face::Sheet) {
                axis.dot(normal).abs()
            } else {
                axis.dot(normal)
            };
            point.distance_squared(middle) / total + LOOKS_AWAY * (1.0 - facing)
        };
        let nearest = (0..places.len()).min_by(|&i, &j| far(&places[i]).total_cmp(&far(&places[j])));
        if let Some(nearest) = nearest {
            patches[nearest].area += area;
        }
    }
}

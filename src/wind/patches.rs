//! Panel discretisation of surfaces: patches at which the wind is sampled.
//!
//! A mesh is sampled by a low-discrepancy sequence (R₂ of M. Roberts, 2018, seeded by an offset). Each triangle gets points
//! in proportion to its area, with its outward normal, and its area is divided among them. The area of a triangle too small
//! for a point goes to the nearest point with a similar normal. So the areas of each orientation add up, to rounding, to
//! those of the surface wherever each flat face has a point. A wire is split into short pieces.

use std::ops::RangeInclusive;

use super::{Surface, SurfaceShape};
use soffio_geometry::TriangleMesh;
use soffio_math::DVec3;
use soffio_math::noise::Random;

/// One piece of a surface, in the node frame of its body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// Index of its triangle in the surface's mesh, or of the piece of wire.
    pub element: usize,
    /// Middle, m.
    pub point: DVec3,
    /// Outward unit normal, or the wire's unit direction.
    pub axis: DVec3,
    /// Which sides the wind acts on.
    pub kind: PatchKind,
    /// m²: of the face, or length times diameter of a wire.
    pub area: f64,
}

/// Which sides of a patch the wind acts on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PatchKind {
    /// The outward side only: a part of a closed surface.
    OneSided,
    /// Both sides: a sheet without thickness.
    TwoSided,
    /// All around: a round wire.
    Wire,
}

/// Longest piece of wire, m: below the width of the jet at arm's length.
const WIRE_LENGTH: f64 = 0.02;
/// Weight of the difference between normals against the squared distance over the surface's area: a point on the same
/// side wins over a nearer one around the edge.
const NORMAL_WEIGHT: f64 = 4.0;

/// Splits a surface into patches.
pub fn sample_surface(surface: &Surface) -> Vec<Patch> {
    match &surface.shape {
        SurfaceShape::Mesh { mesh, per_area, count, sheet, seed } => {
            let kind = if *sheet { PatchKind::TwoSided } else { PatchKind::OneSided };
            sample_mesh(mesh, &Sampling { per_area: *per_area, count: count.clone(), seed: *seed }, kind)
        }
        SurfaceShape::Wire { points, radius } => {
            let mut out = Vec::new();
            for ends in points.windows(2) {
                let edge = ends[1] - ends[0];
                let pieces = (edge.length() / WIRE_LENGTH).ceil().max(1.0);
                for i in 0..pieces as usize {
                    out.push(Patch {
                        element: out.len(),
                        point: ends[0] + edge * ((i as f64 + 0.5) / pieces),
                        axis: edge.normalize_or(DVec3::X),
                        kind: PatchKind::Wire,
                        area: edge.length() / pieces * 2.0 * radius,
                    });
                }
            }
            out
        }
    }
}

/// How densely a mesh is sampled.
struct Sampling {
    /// Patches per m².
    per_area: f64,
    /// Allowed number of patches.
    count: RangeInclusive<usize>,
    seed: u64,
}

/// Area of a triangle that has no patch.
struct LeftoverArea {
    /// Centroid, m.
    center: DVec3,
    normal: DVec3,
    /// m².
    area: f64,
}

fn sample_mesh(mesh: &TriangleMesh, sampling: &Sampling, kind: PatchKind) -> Vec<Patch> {
    let areas: Vec<f64> = mesh.corners().map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).collect();
    let total: f64 = areas.iter().sum();
    if total <= 0.0 {
        return Vec::new();
    }
    let (fewest, most) = (*sampling.count.start(), *sampling.count.end());
    let count = ((total * sampling.per_area).ceil() as usize).clamp(fewest.max(1), most.max(1));
    // R₂ sequence: the powers −1 and −2 of the plastic number.
    /// R₂ sequence (M. Roberts, 2018): the powers −1 and −2 of the plastic number.
    const R2: [f64; 2] = [0.754_877_666_246_693, 0.569_840_290_998_053];
    let mut random = Random::new(sampling.seed);
    let offset = [random.unit(), random.unit()];
    let mut patches = Vec::with_capacity(count);
    let mut leftover = Vec::new();
    let mut sum = 0.0;
    for (triangle, [a, b, c]) in mesh.corners().enumerate() {
        let area = areas[triangle];
        // How many midpoints of `count` equal shares the running sum of areas has passed.
        let passed = |sum: f64| (sum / total * count as f64 + 0.5).floor().min(count as f64) as usize;
        let range = passed(sum)..passed(sum + area);
        sum += area;
        let axis = (b - a).cross(c - a).normalize_or(DVec3::Y);
        if range.is_empty() {
            leftover.push(LeftoverArea { center: (a + b + c) / 3.0, normal: axis, area });
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
            patches.push(Patch { element: triangle, point, axis, kind, area: share });
        }
    }
    assign_leftover_area(&mut patches, &leftover, total);
    patches
}

/// Adds the areas of triangles without a patch to the nearest patches with a similar normal.
fn assign_leftover_area(patches: &mut [Patch], leftover: &[LeftoverArea], total: f64) {
    let places: Vec<(DVec3, DVec3)> = patches.iter().map(|patch| (patch.point, patch.axis)).collect();
    for &LeftoverArea { center, normal, area } in leftover {
        let dissimilarity = |&(point, axis): &(DVec3, DVec3)| {
            let facing = if patches.first().is_some_and(|p| p.kind == PatchKind::TwoSided) {
                axis.dot(normal).abs()
            } else {
                axis.dot(normal)
            };
            point.distance_squared(center) / total + NORMAL_WEIGHT * (1.0 - facing)
        };
        let nearest =
            (0..places.len()).min_by(|&i, &j| dissimilarity(&places[i]).total_cmp(&dissimilarity(&places[j])));
        if let Some(nearest) = nearest {
            patches[nearest].area += area;
        }
    }
}

//! Closed triangle meshes: extruded sheet and solids of revolution, with their mass.
//!
//! Invariant: every solid is closed and its triangles are counter-clockwise seen from outside. So its volume by the
//! divergence theorem is positive, and the loader computes the same mass from the file.

use soffio_geometry::bodies::MassProperties;
use soffio_math::{DMat3, DVec2, DVec3, PI, cos, outer, sin};

use super::outline::{Polygon, reversed};

/// A mesh with a normal per vertex.
#[derive(Clone, Debug, Default)]
pub struct Solid {
    /// Vertices, m.
    pub positions: Vec<DVec3>,
    /// Vertex normals, unit, outwards.
    pub normals: Vec<DVec3>,
    /// Vertex indices, three for each triangle.
    pub triangles: Vec<[u32; 3]>,
}

/// Extrudes `outline` (counter-clockwise) minus `holes` (also counter-clockwise) to sheet of `thickness` m in the plane
/// z = 0, with edges bevelled by `bevel` m.
///
/// The bevel's normals blend from the face to the edge, so that the edge catches the light like a filed one.
pub fn extrude(outline: &Polygon, holes: &[Polygon], thickness: f64, bevel: f64) -> Solid {
    let loops: Vec<Polygon> =
        std::iter::once(outline.clone()).chain(holes.iter().map(|hole| reversed(hole.clone()))).collect();
    let half = 0.5 * thickness;
    let mut solid = Solid::default();

    // Four loops of vertices in the same order: front face, front edge, back edge, back face.
    let count: usize = loops.iter().map(Vec::len).sum();
    let layers: [(f64, f64, f64); 4] =
        [(bevel, half, 1.0), (0.0, half - bevel, 0.0), (0.0, bevel - half, 0.0), (bevel, -half, -1.0)];
    for (inset, z, y_to_z) in layers {
        for polygon in &loops {
            for i in 0..polygon.len() {
                let (outwards, reach) = corner_normal(polygon, i);
                solid.positions.push((polygon[i] - inset * reach * outwards).extend(z));
                solid.normals.push((outwards * (1.0 - y_to_z.abs())).extend(y_to_z));
            }
        }
    }

    // Faces: earcut takes flat coordinates and the index at which each hole begins.
    let face: Vec<[f64; 2]> = solid.positions[..count].iter().map(|p| [p.x, p.y]).collect();
    let mut starts = Vec::new();
    let mut next = 0;
    for polygon in &loops[..loops.len() - 1] {
        next += polygon.len();
        starts.push(next as u32);
    }
    let mut indices: Vec<u32> = Vec::new();
    earcut::Earcut::new().earcut(face.iter().copied(), &starts, &mut indices);
    let back = 3 * count as u32;
    for corner in indices.chunks_exact(3) {
        let [a, b, c] = [corner[0], corner[1], corner[2]];
        let turn = (DVec2::from(face[b as usize]) - DVec2::from(face[a as usize]))
            .perp_dot(DVec2::from(face[c as usize]) - DVec2::from(face[a as usize]));
        let [a, b, c] = if turn > 0.0 { [a, b, c] } else { [a, c, b] };
        solid.triangles.push([a, b, c]);
        solid.triangles.push([back + a, back + c, back + b]);
    }

    // Bevel, edge, bevel: strips between neighbouring rings.
    for layer in 0..3 {
        let mut first = layer * count as u32;
        for polygon in &loops {
            let n = polygon.len() as u32;
            for i in 0..n {
                let (a, b) = (first + i, first + (i + 1) % n);
                let (c, d) = (a + count as u32, b + count as u32);
                solid.triangles.push([a, c, b]);
                solid.triangles.push([b, c, d]);
            }
            first += n;
        }
    }
    solid
}

/// Outward normal of a polygon corner, and the mitre factor of an inset along it, at most two.
fn corner_normal(polygon: &[DVec2], i: usize) -> (DVec2, f64) {
    let n = polygon.len();
    let before = (polygon[i] - polygon[(i + n - 1) % n]).normalize();
    let after = (polygon[(i + 1) % n] - polygon[i]).normalize();
    let right = |d: DVec2| DVec2::new(d.y, -d.x);
    let normal = (right(before) + right(after)).normalize();
    (normal, (1.0 / normal.dot(right(before))).min(2.0))
}

/// A solid of revolution about the y axis. `profile` lists (radius, y) with the material on its left, from the axis at the
/// bottom, along the outside, to the axis at the top. Edges sharper than about 37° stay sharp.
pub fn revolve(profile: &[DVec2], segments: usize) -> Solid {
    revolution(profile, false, segments)
}

/// A ring: the solid of revolution of a closed profile that does not touch the axis, else as [`revolve`].
pub fn revolve_ring(profile: &[DVec2], segments: usize) -> Solid {
    revolution(profile, true, segments)
}

fn revolution(profile: &[DVec2], ring: bool, segments: usize) -> Solid {
    /// Facets that meet at a larger cosine are shaded smoothly.
    const SHARP: f64 = 0.8;
    let spans = if ring { profile.len() } else { profile.len() - 1 };
    let outwards = |span: usize| {
        let d = (profile[(span + 1) % profile.len()] - profile[span]).normalize();
        DVec2::new(d.y, -d.x)
    };
    let neighbour = |span: usize, step: isize| {
        let other = span as isize + step;
        if ring { Some(other.rem_euclid(spans as isize) as usize) } else { usize::try_from(other).ok() }
            .filter(|&o| o < spans)
    };
    let shaded = |span: usize, step: isize| match neighbour(span, step) {
        Some(other) if outwards(span).dot(outwards(other)) > SHARP => (outwards(span) + outwards(other)).normalize(),
        _ => outwards(span),
    };

    let mut solid = Solid::default();
    for span in 0..spans {
        let ends = [(profile[span], shaded(span, -1)), (profile[(span + 1) % profile.len()], shaded(span, 1))];
        let base = solid.positions.len() as u32;
        for (p, normal) in ends {
            for k in 0..segments {
                let angle = 2.0 * PI * k as f64 / segments as f64;
                let (s, c) = (sin(angle), cos(angle));
                solid.positions.push(DVec3::new(p.x * c, p.y, -p.x * s));
                solid.normals.push(DVec3::new(normal.x * c, normal.y, -normal.x * s));
            }
        }
        let n = segments as u32;
        for k in 0..n {
            let (a, b) = (base + k, base + (k + 1) % n);
            let (c, d) = (a + n, b + n);
            // On the axis one side of the quad has no length.
            if ends[0].0.x > 0.0 {
                solid.triangles.push([a, b, d]);
            }
            if ends[1].0.x > 0.0 {
                solid.triangles.push([a, d, c]);
            }
        }
    }
    solid
}

impl Solid {
    /// The solid rotated so that its y axis lies along x.
    pub fn y_to_x(mut self) -> Self {
        let lay = |v: DVec3| DVec3::new(v.y, -v.x, v.z);
        self.positions.iter_mut().for_each(|p| *p = lay(*p));
        self.normals.iter_mut().for_each(|n| *n = lay(*n));
        self
    }

    /// The solid translated by `by`, m.
    pub fn translated(mut self, by: DVec3) -> Self {
        self.positions.iter_mut().for_each(|p| *p += by);
        self
    }

    /// Mass, centre and inertia at `density` kg/m³.
    ///
    /// The solid is the signed sum of tetrahedra (0, a, b, c), each of volume V = a·(b×c)/6, centre (a+b+c)/4 and
    /// second moments ∫ x xᵀ dV = V/20 (a aᵀ + b bᵀ + c cᵀ + s sᵀ) with s = a+b+c.
    pub fn mass(&self, density: f64) -> MassProperties {
        let mut volume = 0.0;
        let mut moment = DVec3::ZERO;
        let mut second = DMat3::ZERO;
        for t in &self.triangles {
            let [a, b, c] = t.map(|i| self.positions[i as usize]);
            let v = a.dot(b.cross(c)) / 6.0;
            let s = a + b + c;
            volume += v;
            moment += v / 4.0 * s;
            second += v / 20.0 * (outer(a, a) + outer(b, b) + outer(c, c) + outer(s, s));
        }
        let center = moment / volume;
        second -= volume * outer(center, center);
        let trace = second.x_axis.x + second.y_axis.y + second.z_axis.z;
        let inertia = density * (DMat3::from_diagonal(DVec3::splat(trace)) - second);
        MassProperties { mass: density * volume, center, inertia }
    }
}

/// Mass, centre and inertia of a round wire of `radius` m along `points`: thin rods end to end.
pub fn wire_mass(points: &[DVec3], radius: f64, density: f64) -> MassProperties {
    let line_density = density * PI * radius * radius;
    points
        .windows(2)
        .map(|ends| {
            let along = ends[1] - ends[0];
            let mass = line_density * along.length();
            let inertia =
                mass / 12.0 * (DMat3::from_diagonal(DVec3::splat(along.length_squared())) - outer(along, along));
            MassProperties { mass, center: 0.5 * (ends[0] + ends[1]), inertia }
        })
        .reduce(|whole, rod| whole.combine(&rod))
        .unwrap_or(MassProperties { mass: 0.0, center: DVec3::ZERO, inertia: DMat3::ZERO })
}

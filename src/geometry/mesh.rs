//! Triangle meshes in a body's node frame: what they enclose, how large they are, whether they are closed.

use std::collections::BTreeMap;

use super::mass::{Moments, principal_axes};
use soffio_math::{DMat3, DVec3};

/// Triangles in the node frame of a body, metres, counter-clockwise seen from outside.
#[derive(Clone, Debug, Default)]
pub struct TriangleMesh {
    /// Corner positions, m.
    pub positions: Vec<DVec3>,
    /// Three indices into `positions` per triangle.
    pub triangles: Vec<[u32; 3]>,
}

/// An oriented box around a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extents {
    /// Centre, m.
    pub center: DVec3,
    /// Unit axes as columns, the longest half extent first; right-handed.
    pub axes: DMat3,
    /// Half extents along the axes, m, descending.
    pub half: DVec3,
}

impl TriangleMesh {
    /// The three corners of each triangle.
    pub fn corners(&self) -> impl Iterator<Item = [DVec3; 3]> + '_ {
        self.triangles.iter().map(|t| t.map(|i| self.positions[i as usize]))
    }

    /// Appends another mesh of the same frame.
    pub fn append(&mut self, other: &Self) {
        let base = self.positions.len() as u32;
        self.positions.extend_from_slice(&other.positions);
        self.triangles.extend(other.triangles.iter().map(|t| t.map(|i| i + base)));
    }

    /// The same surface with corners at equal positions made one, and triangles without area dropped. Files split
    /// corners where normals or texture coordinates differ; the surface is closed all the same.
    pub fn welded(&self) -> Self {
        let mut seen = BTreeMap::new();
        let mut welded = Self::default();
        let index: Vec<u32> = self
            .positions
            .iter()
            .map(|p| {
                // Adding zero turns −0 into 0: the two are one place.
                let key = (*p + DVec3::ZERO).to_array().map(f64::to_bits);
                *seen.entry(key).or_insert_with(|| {
                    welded.positions.push(*p);
                    welded.positions.len() as u32 - 1
                })
            })
            .collect();
        let merged = self.triangles.iter().map(|t| t.map(|i| index[i as usize]));
        welded.triangles = merged.filter(|[a, b, c]| a != b && b != c && c != a).collect();
        welded
    }

    /// Edges of the welded mesh that no neighbour runs through in the other direction: none where the surface is
    /// closed and consistently wound. Solids that touch along an edge count as closed.
    pub fn open_edges(&self) -> usize {
        let welded = self.welded();
        let mut balance: BTreeMap<(u32, u32), i64> = BTreeMap::new();
        for [a, b, c] in &welded.triangles {
            for (i, j) in [(a, b), (b, c), (c, a)] {
                let step = if i < j { 1 } else { -1 };
                *balance.entry((*i.min(j), *i.max(j))).or_default() += step;
            }
        }
        balance.values().map(|count| count.unsigned_abs() as usize).sum()
    }

    /// Does the mesh enclose a volume?
    pub fn is_closed(&self) -> bool {
        !self.triangles.is_empty() && self.open_edges() == 0
    }

    /// Enclosed volume of a closed mesh, m³; negative where the faces point inwards.
    pub fn volume(&self) -> f64 {
        self.solid_moments(1.0).mass
    }

    /// Area of all triangles, m².
    pub fn area(&self) -> f64 {
        self.corners().map(|[a, b, c]| 0.5 * (b - a).cross(c - a).length()).sum()
    }

    /// Moments of the closed mesh filled with `density` kg/m³.
    pub fn solid_moments(&self, density: f64) -> Moments {
        let mut moments = Moments::default();
        moments.add_solid(self.corners(), density);
        moments
    }

    /// Moments of a sheet of `thickness` m and `density` kg/m³ whose mid-surface is the mesh.
    pub fn sheet_moments(&self, thickness: f64, density: f64) -> Moments {
        let mut moments = Moments::default();
        moments.add_sheet(self.corners(), thickness, density);
        moments
    }

    /// Least and greatest corner of the axis-aligned box; `None` where the mesh is empty.
    pub fn bounds(&self) -> Option<(DVec3, DVec3)> {
        let first = *self.positions.first()?;
        Some(self.positions.iter().fold((first, first), |(lo, hi), &p| (lo.min(p), hi.max(p))))
    }

    /// A ball around the mesh: the middle of its bounding box and the farthest corner, m.
    pub fn ball(&self) -> (DVec3, f64) {
        let (low, high) = self.bounds().unwrap_or_default();
        let center = 0.5 * (low + high);
        (center, self.positions.iter().fold(0.0, |r: f64, p| r.max(p.distance(center))))
    }

    /// How the surface faces: the mean of n nᵀ over its area, the orientation tensor, of trace 1. A mesh without area
    /// faces every way alike.
    pub fn orientation(&self) -> DMat3 {
        let (mut sum, mut area) = (DMat3::ZERO, 0.0);
        for [a, b, c] in self.corners() {
            let normal = (b - a).cross(c - a);
            let twice = normal.length();
            if twice > 0.0 {
                sum += DMat3::from_cols(normal * normal.x, normal * normal.y, normal * normal.z) * (1.0 / twice);
                area += twice;
            }
        }
        if area > 0.0 { sum * (1.0 / area) } else { DMat3::from_diagonal(DVec3::splat(1.0 / 3.0)) }
    }

    /// The box along the principal axes of the surface; `None` where the mesh has no area.
    pub fn extents(&self) -> Option<Extents> {
        // Unit mass per area, no depth: the principal axes of the skin.
        let mut skin = Moments::default();
        for [a, b, c] in self.corners() {
            skin.add_simplex([a, b, c], 0.5 * (b - a).cross(c - a).length());
        }
        if skin.mass <= 0.0 {
            return None;
        }
        // The least moment of inertia belongs to the longest axis, so ascending moments are descending lengths.
        let (_, axes) = principal_axes(skin.inertia());
        let local = self.corners().flatten().map(|p| axes.transpose() * p);
        let (lo, hi) = local.fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(lo, hi), p| (lo.min(p), hi.max(p)));
        let half = 0.5 * (hi - lo);
        let columns = [axes.x_axis, axes.y_axis, axes.z_axis];
        let lengths = half.to_array();
        let mut order = [0, 1, 2];
        order.sort_by(|&i, &j| lengths[j].total_cmp(&lengths[i]));
        let (x, y) = (columns[order[0]], columns[order[1]]);
        Some(Extents {
            center: axes * (0.5 * (lo + hi)),
            axes: DMat3::from_cols(x, y, x.cross(y)),
            half: DVec3::new(lengths[order[0]], lengths[order[1]], lengths[order[2]]),
        })
    }
}

//! The exhibit at the poses of one frame: triangles and wires in one bounding volume hierarchy.
//!
//! Triangles are tested by Möller and Trumbore's method (1997). A ray that leaves a surface begins at a small distance
//! from it, relative to the coordinates' rounding.

use std::time::Duration;

use glam::{Vec3, Vec3A, Vec4};
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2;
use obvhs::ray::{Ray, RayHit};
use obvhs::{Boundable, BvhBuildParams};

use super::super::scene::{Scene, SurfaceKind};
use super::super::vertex::Vertex;
use super::material::{Materials, Point, Surface};
use super::rod::Rod;

/// What a triangle is made of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Matter {
    /// Index of the material.
    pub material: usize,
    /// How the surface lets light through.
    pub kind: SurfaceKind,
    /// Does the camera see both sides?
    pub double_sided: bool,
    /// Has it an alpha threshold?
    holes: bool,
}

/// A triangle for ray tests: a corner and two edges.
#[derive(Clone, Copy)]
struct Facet {
    corner: Vec3A,
    edges: [Vec3A; 2],
    corners: [u32; 3],
    /// Index into the list of matter.
    matter: u32,
}

/// What the hierarchy holds.
#[derive(Clone, Copy)]
enum Solid {
    Facet(Facet),
    Rod(Rod),
}

impl Boundable for Solid {
    fn aabb(&self) -> Aabb {
        match self {
            Self::Facet(f) => Aabb::from_points(&[f.corner, f.corner + f.edges[0], f.corner + f.edges[1]]),
            Self::Rod(rod) => rod.aabb(),
        }
    }
}

/// Nearest point of the exhibit on a ray.
pub(super) struct Hit {
    /// m.
    pub distance: f32,
    /// Optical properties, for a viewer at the ray's origin.
    pub surface: Surface,
    /// How the surface lets light through.
    pub kind: SurfaceKind,
}

/// The exhibit's geometry in the world.
pub(super) struct World<'a> {
    materials: &'a Materials<'a>,
    vertices: Vec<Vertex>,
    matter: Vec<Matter>,
    /// In the order of the hierarchy.
    solids: Vec<Solid>,
    bvh: Bvh2,
}

impl<'a> World<'a> {
    /// Triangles of a scene with its vertices in the world, and wires.
    pub fn new(scene: &Scene, vertices: Vec<Vertex>, rods: &[Rod], materials: &'a Materials<'a>) -> Self {
        let mut matter = Vec::new();
        let mut solids: Vec<Solid> = rods.iter().copied().map(Solid::Rod).collect();
        for batch in &scene.batches {
            let (kind, double_sided) = (batch.pipeline.kind, batch.pipeline.double_sided);
            let holes = kind != SurfaceKind::Blend && materials.has_holes(batch.material);
            matter.push(Matter { material: batch.material, kind, double_sided, holes });
            let indices = &scene.indices[batch.indices.start as usize..batch.indices.end as usize];
            solids.extend(indices.chunks_exact(3).map(|t| {
                let [a, b, c] = [t[0], t[1], t[2]].map(|i| Vec3A::from(vertices[i as usize].position));
                let matter = matter.len() as u32 - 1;
                Solid::Facet(Facet { corner: a, edges: [b - a, c - a], corners: [t[0], t[1], t[2]], matter })
            }));
        }
        let bvh = build_bvh2(&solids, BvhBuildParams::medium_build(), &mut Duration::default());
        let solids = bvh.primitive_indices.iter().map(|&i| solids[i as usize]).collect();
        Self { materials, vertices, matter, solids, bvh }
    }

    /// The nearest surface on a ray. The camera does not see the backs of one-sided materials.
    pub fn nearest(&self, origin: Vec3, direction: Vec3, by_camera: bool) -> Option<Hit> {
        let mut found = (f32::INFINITY, usize::MAX, [0.0; 2], Vec3::ZERO);
        let ray = Ray::new(origin.into(), direction.into(), 0.0, f32::INFINITY);
        self.bvh.ray_traverse(ray, &mut RayHit::none(), |ray, id| match &self.solids[id] {
            Solid::Facet(facet) => {
                let Some((t, at, back)) = facet.hit(ray) else { return f32::INFINITY };
                let matter = &self.matter[facet.matter as usize];
                let hidden = by_camera && back && !matter.double_sided && matter.kind != SurfaceKind::Glass;
                if hidden || (matter.holes && self.is_hole(facet, matter, at)) {
                    return f32::INFINITY;
                }
                if t < found.0 {
                    found = (t, id, at, Vec3::ZERO);
                }
                t
            }
            Solid::Rod(rod) => match rod.hit(origin, direction, 0.0, ray.tmax) {
                Some((t, normal)) => {
                    if t < found.0 {
                        found = (t, id, [0.0; 2], normal);
                    }
                    t
                }
                None => f32::INFINITY,
            },
        });
        let (distance, id, at, normal) = found;
        match self.solids.get(id)? {
            Solid::Facet(facet) => {
                let matter = &self.matter[facet.matter as usize];
                let surface = self.materials.surface(matter.material, &self.point(facet, at, direction));
                Some(Hit { distance, surface, kind: matter.kind })
            }
            Solid::Rod(rod) => {
                let facing = if normal.dot(direction) > 0.0 { -normal } else { normal };
                Some(Hit { distance, surface: rod.surface(facing), kind: SurfaceKind::Opaque })
            }
        }
    }

    /// Fraction of the light that the exhibit lets through along a ray up to a distance, per channel.
    pub fn transmittance(&self, origin: Vec3, direction: Vec3, far: f32) -> Vec3 {
        let mut through = Vec3::ONE;
        let ray = Ray::new(origin.into(), direction.into(), 0.0, far);
        let is_open = self.bvh.ray_traverse_miss(ray, |ray, id| match &self.solids[id] {
            Solid::Facet(facet) => {
                let Some((t, at, _)) = facet.hit(ray).filter(|hit| hit.0 < far) else { return f32::INFINITY };
                let matter = &self.matter[facet.matter as usize];
                if matter.holes && self.is_hole(facet, matter, at) {
                    return f32::INFINITY;
                }
                if matter.kind == SurfaceKind::Opaque {
                    return t;
                }
                let surface = self.materials.surface(matter.material, &self.point(facet, at, direction));
                through *= match matter.kind {
                    SurfaceKind::Glass => surface.transmittance(-direction),
                    _ => Vec3::splat(1.0 - surface.alpha.clamp(0.0, 1.0)),
                };
                f32::INFINITY
            }
            Solid::Rod(rod) => rod.hit(origin, direction, 0.0, far).map_or(f32::INFINITY, |(t, _)| t),
        });
        if is_open { through } else { Vec3::ZERO }
    }

    fn is_hole(&self, facet: &Facet, matter: &Matter, at: [f32; 2]) -> bool {
        let (uv, color) = self.coordinates(facet, at);
        self.materials.is_hole(matter.material, uv, color)
    }

    /// Texture coordinates and colour at a point of a triangle.
    fn coordinates(&self, facet: &Facet, at: [f32; 2]) -> ([f32; 4], Vec4) {
        let [a, b, c] = facet.corners.map(|i| &self.vertices[i as usize]);
        let mean = |of: fn(&Vertex) -> [f32; 4]| {
            let [a, b, c] = [of(a), of(b), of(c)].map(Vec4::from_array);
            a + (b - a) * at[0] + (c - a) * at[1]
        };
        (mean(|v| v.uv).to_array(), mean(|v| v.color))
    }

    /// A point of a triangle, seen along `direction`.
    fn point(&self, facet: &Facet, at: [f32; 2], direction: Vec3) -> Point {
        let [a, b, c] = facet.corners.map(|i| &self.vertices[i as usize]);
        let [e1, e2] = facet.edges.map(Vec3::from);
        let normal = e1.cross(e2).normalize_or(-direction);
        let mean = |of: fn(&Vertex) -> Vec3| {
            let [a, b, c] = [of(a), of(b), of(c)];
            a + (b - a) * at[0] + (c - a) * at[1]
        };
        let along = |v: &Vertex| std::array::from_fn(|k| v.uv[k] - a.uv[k]);
        let (uv, color) = self.coordinates(facet, at);
        Point {
            normal: mean(|v| v.normal).normalize_or(normal),
            facing: if normal.dot(direction) > 0.0 { -normal } else { normal },
            tangent: mean(|v| Vec3::from_slice(&v.tangent)).normalize_or_zero().extend(a.tangent[3]),
            uv,
            color,
            edges: [(e1, along(b)), (e2, along(c))],
        }
    }
}

impl Facet {
    /// Distance within the ray's range, the shares of the second and third corner, and whether the ray meets the back.
    fn hit(&self, ray: &Ray) -> Option<(f32, [f32; 2], bool)> {
        let p = ray.direction.cross(self.edges[1]);
        let det = self.edges[0].dot(p);
        let inverse = 1.0 / det;
        let from = ray.origin - self.corner;
        let u = from.dot(p) * inverse;
        let q = from.cross(self.edges[0]);
        let v = ray.direction.dot(q) * inverse;
        let t = self.edges[1].dot(q) * inverse;
        (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > ray.tmin && t < ray.tmax).then_some((t, [u, v], det < 0.0))
    }
}

impl Rod {
    /// Paint or metal, as in `wires.wgsl`.
    fn surface(&self, normal: Vec3) -> Surface {
        /// Smallest perceptual roughness of a wire.
        const SMOOTHEST: f32 = 0.15;
        Surface::plain(normal, self.color, self.metallic, self.roughness.max(SMOOTHEST))
    }
}

/// Origin of a ray that leaves a surface into the direction `d`, moved off it by its rounding. `normal` is that of the
/// geometry, on either side; `scale` the largest coordinate that occurs, m.
pub(super) fn leave(point: Vec3, normal: Vec3, d: Vec3, scale: f32) -> Vec3 {
    /// Distance from the surface, relative to the coordinates: a hundred times their rounding.
    const CLEAR: f32 = 6e-6;
    let side = if normal.dot(d) < 0.0 { -1.0 } else { 1.0 };
    point + normal * (side * CLEAR * scale)
}

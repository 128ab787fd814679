//! Rays against moving rigid meshes: is anything in the way?
//!
//! Two levels. Each part has a bounding volume hierarchy of its triangles, built once in its own frame: a rigid part
//! never deforms it. Over the parts stands a second hierarchy of their boxes in the world, refitted whenever they have
//! moved. A ray goes through the upper one in the world and is carried into the frames of the few parts whose boxes it
//! meets, instead of carrying triangles into the world.
//!
//! Whoever asks again keeps a [`Hint`] of what stood in the way: as a rule it still does, and no hierarchy is asked.
//!
//! Hierarchies are single precision (obvhs); boxes of parts are rounded outwards. A shadow's edge is off by less than
//! a micrometre a metre from the origin.

use std::cell::Cell;
use std::time::Duration;

use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::{build_bvh2, build_bvh2_from_tris};
use obvhs::ray::{Ray, RayHit};
use obvhs::triangle::Triangle;

use super::TriangleMesh;
use soffio_math::{DMat3, DVec3, Pose};

/// Boxes are widened by this part of their distance from the origin and size: more than single precision rounds.
const OUTWARDS: f32 = 4.0 * f32::EPSILON;

/// Rigid parts that may stand in a ray's way.
#[derive(Clone)]
pub struct Occluders {
    parts: Vec<Part>,
    /// Over the parts' boxes; one part a leaf.
    top: Bvh2,
}

/// What last stood in somebody's way.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Hint(Option<(u32, u32)>);

/// One rigid part.
#[derive(Clone)]
struct Part {
    /// The body that carries it; `None` stands still.
    body: Option<usize>,
    triangles: Vec<Triangle>,
    bvh: Bvh2,
    /// Its box in its own frame: centre and half extents, m.
    center: DVec3,
    half: DVec3,
    /// Part axes to world axes and back, and the frame's origin, m.
    axes: DMat3,
    inverse: DMat3,
    origin: DVec3,
}

#[inline]
fn single(v: DVec3) -> Vec3A {
    v.as_vec3a()
}

impl Part {
    fn new(body: Option<usize>, mesh: &TriangleMesh) -> Option<Self> {
        let (low, high) = mesh.bounds().filter(|_| !mesh.triangles.is_empty())?;
        let corner = |i: u32| single(mesh.positions[i as usize]);
        let triangles: Vec<Triangle> =
            mesh.triangles.iter().map(|t| Triangle { v0: corner(t[0]), v1: corner(t[1]), v2: corner(t[2]) }).collect();
        let bvh = build_bvh2_from_tris(&triangles, BvhBuildParams::medium_build(), &mut Duration::default());
        let (center, half) = (0.5 * (low + high), 0.5 * (high - low));
        Some(Self {
            body,
            triangles,
            bvh,
            center,
            half,
            axes: DMat3::IDENTITY,
            inverse: DMat3::IDENTITY,
            origin: DVec3::ZERO,
        })
    }

    /// The box in the world, rounded outwards.
    #[inline]
    fn aabb(&self) -> Aabb {
        let center = single(self.axes * self.center + self.origin);
        let absolute = DMat3::from_cols(self.axes.x_axis.abs(), self.axes.y_axis.abs(), self.axes.z_axis.abs());
        let half = single(absolute * self.half);
        let half = half + OUTWARDS * (half + center.abs());
        Aabb::new(center - half, center + half)
    }

    /// A world ray in the part's frame.
    #[inline]
    fn local(&self, origin: DVec3, direction: DVec3, far: f32) -> Ray {
        Ray::new(single(self.inverse * (origin - self.origin)), single(self.inverse * direction), 0.0, far)
    }
}

impl Occluders {
    /// Meshes in the frames of the bodies that carry them (`None`: the world's), m. Meshes without triangles are left
    /// out.
    pub fn new<'a>(meshes: impl IntoIterator<Item = (Option<usize>, &'a TriangleMesh)>) -> Self {
        let parts: Vec<Part> = meshes.into_iter().filter_map(|(body, mesh)| Part::new(body, mesh)).collect();
        let boxes: Vec<Aabb> = parts.iter().map(Part::aabb).collect();
        let mut top = if boxes.is_empty() {
            Bvh2::default()
        } else {
            let one_a_leaf = BvhBuildParams { max_prims_per_leaf: 1, ..BvhBuildParams::medium_build() };
            build_bvh2(&boxes, one_a_leaf, &mut Duration::default())
        };
        // In this order a refit is one sweep, and asks for no memory.
        top.reorder_in_stack_traversal_order();
        top.update_primitives_to_nodes();
        Self { parts, top }
    }

    /// Moves the parts to where `pose` says that their bodies are.
    pub fn refit(&mut self, pose: impl Fn(usize) -> Pose) {
        for (index, part) in self.parts.iter_mut().enumerate() {
            if let Some(body) = part.body {
                let Pose { rotation, position } = pose(body);
                (part.axes, part.origin) = (DMat3::from_quat(rotation), position);
                part.inverse = part.axes.transpose();
                self.top.nodes[self.top.primitives_to_nodes[index] as usize].set_aabb(part.aabb());
            }
        }
        self.top.refit_all();
    }

    /// Is there a triangle between `origin` and the point `far` metres away along `direction` (unit, world)? The one
    /// that `hint` names is asked first, and the hint is set to the one that was found.
    pub fn block(&self, origin: DVec3, direction: DVec3, far: f64, hint: &Cell<Hint>) -> bool {
        let far = far as f32;
        if let Hint(Some((part, triangle))) = hint.get()
            && let Some(part) = self.parts.get(part as usize)
            && let Some(triangle) = part.triangles.get(triangle as usize)
            && triangle.intersect(&part.local(origin, direction, far)) < far
        {
            return true;
        }
        let through = Ray::new(single(origin), single(direction), 0.0, far);
        !self.top.ray_traverse_miss(through, |_, id| {
            let index = self.top.primitive_indices[id];
            let part = &self.parts[index as usize];
            let clear = part.bvh.ray_traverse_miss(part.local(origin, direction, far), |ray, id| {
                let triangle = part.bvh.primitive_indices[id];
                let t = part.triangles[triangle as usize].intersect(ray);
                if t < far {
                    hint.set(Hint(Some((index, triangle))));
                }
                t
            });
            if clear { f32::INFINITY } else { 0.0 }
        })
    }

    /// The first triangle along a world ray (unit direction): the body that carries it (`None` stands still) and its
    /// distance, m.
    pub fn first(&self, origin: DVec3, direction: DVec3) -> Option<(Option<usize>, f64)> {
        let mut first: Option<(Option<usize>, f32)> = None;
        let through = Ray::new(single(origin), single(direction), 0.0, f32::INFINITY);
        self.top.ray_traverse(through, &mut RayHit::none(), |ray, id| {
            let part = &self.parts[self.top.primitive_indices[id] as usize];
            let mut nearest = f32::INFINITY;
            part.bvh.ray_traverse(part.local(origin, direction, ray.tmax), &mut RayHit::none(), |ray, id| {
                let t = part.triangles[part.bvh.primitive_indices[id] as usize].intersect(ray);
                nearest = nearest.min(t);
                t
            });
            if nearest < ray.tmax {
                first = Some((part.body, nearest));
            }
            nearest
        });
        first.map(|(body, distance)| (body, f64::from(distance)))
    }

    /// The same by asking every triangle: what the hierarchies are measured against.
    pub fn first_by_each(&self, origin: DVec3, direction: DVec3) -> Option<(Option<usize>, f64)> {
        let each = self.parts.iter().flat_map(|part| {
            let ray = part.local(origin, direction, f32::INFINITY);
            part.triangles.iter().map(move |triangle| (part.body, triangle.intersect(&ray)))
        });
        let nearest = each.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, t)| t.is_finite());
        nearest.map(|(body, t)| (body, f64::from(t)))
    }

    /// [`Self::block`] by asking every triangle.
    pub fn block_by_each(&self, origin: DVec3, direction: DVec3, far: f64) -> bool {
        self.parts.iter().any(|part| {
            let ray = part.local(origin, direction, far as f32);
            part.triangles.iter().any(|triangle| triangle.intersect(&ray) < ray.tmax)
        })
    }

    /// Triangles of all parts.
    pub fn triangles(&self) -> usize {
        self.parts.iter().map(|part| part.triangles.len()).sum()
    }
}

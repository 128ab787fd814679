//! Rays against moving rigid meshes: one bounding volume hierarchy per body, built once in its node frame.
//!
//! A ray is carried into each body's frame instead of carrying the triangles into the world, so nothing is rebuilt
//! when bodies move. Hierarchies are single precision (obvhs); boxes are a few parts in 10⁷ off, which moves the edge
//! of a wind shadow by less than a micrometre.

use glam::Vec3A;
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::ray::{Ray, RayHit};
use obvhs::triangle::Triangle;
use std::time::Duration;

use super::TriangleMesh;
use crate::math::{DVec3, Pose};

/// The triangles of one rigid body and their hierarchy.
pub struct RayMesh {
    bvh: Bvh2,
    triangles: Vec<Triangle>,
}

fn single(v: DVec3) -> Vec3A {
    v.as_vec3a()
}

impl RayMesh {
    /// The hierarchy of a mesh; `None` where it has no triangles.
    pub fn new(mesh: &TriangleMesh) -> Option<Self> {
        if mesh.triangles.is_empty() {
            return None;
        }
        let corner = |i: u32| single(mesh.positions[i as usize]);
        let triangles: Vec<Triangle> =
            mesh.triangles.iter().map(|t| Triangle { v0: corner(t[0]), v1: corner(t[1]), v2: corner(t[2]) }).collect();
        let mut elapsed = Duration::ZERO;
        let bvh = build_bvh2_from_tris(&triangles, BvhBuildParams::medium_build(), &mut elapsed);
        Some(Self { bvh, triangles })
    }

    /// Distance along the ray (m) to the nearest triangle between `near` and `far`, with the body at `pose`.
    pub fn hit(&self, pose: &Pose, origin: DVec3, direction: DVec3, near: f64, far: f64) -> Option<f64> {
        let origin = single(pose.inverse_point(origin));
        let direction = single(pose.inverse_vector(direction));
        let ray = Ray::new(origin, direction, near as f32, far as f32);
        let mut hit = RayHit::none();
        let found = self.bvh.ray_traverse(ray, &mut hit, |ray, id| {
            self.triangles[self.bvh.primitive_indices[id] as usize].intersect(ray)
        });
        (found && f64::from(hit.t) < far).then_some(f64::from(hit.t))
    }
}

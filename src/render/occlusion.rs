//! Ray casting at load: against all opaque triangles in their start poses, and the ambient occlusion of wall and floor by
//! static parts.
//!
//! The estimate is a mean over the same cosine-weighted directions everywhere (Hammersley points in each surface's
//! tangent frame), so its noise does not flicker. It is v = 1 − (1/N) Σ max(0, 1 − d/r), with d the distance to the hit
//! and r the occlusion radius. These parts also send light to wall and floor: b = (1/N) Σ max(0, 1 − d/r) B, B the radiosity where
//! the ray ends.

use std::time::Duration;

use glam::{Vec2, Vec3, Vec3A, Vec4};
use obvhs::BvhBuildParams;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::ray::{Ray, RayHit};
use obvhs::triangle::Triangle;

use super::scene::Scene;
use super::shadows::ReceivingPlane;
use soffio_exhibit::Exhibit;

/// Rays of each texel of a plane: more than of a vertex, since a plane is smooth and noise shows.
const TEXEL_RAYS: u32 = 32;
/// Steps of the normals of vertices that share their rays, at first and at most: by 3° nothing changes; by more than 30° other parts are met.
const FINEST_TURN: f32 = 0.05;
const COARSEST_TURN: f32 = 0.5;
/// Texels along each side of a plane's map. Occlusion of a plane has no sharper edges; chosen by eye.
pub(super) const PLANE_MAP: u32 = 80;
/// Ray queries on the scene's opaque triangles, by a bounding volume hierarchy.
pub(super) struct RayCaster {
    triangles: Vec<Triangle>,
    /// First vertex of each triangle, as an index into the scene's vertices.
    corners: Vec<u32>,
    bvh: Bvh2,
}

impl RayCaster {
    /// Rays against all opaque triangles of the scene; `None` where there are none.
    pub fn of_opaque(scene: &Scene, positions: &[Vec3]) -> Option<Self> {
        Self::of_frames(scene, positions, |_| true)
    }

    /// Rays against the opaque triangles that never move; `None` where there are none.
    pub fn of_static(scene: &Scene, positions: &[Vec3]) -> Option<Self> {
        Self::of_frames(scene, positions, |frame| frame == 0)
    }

    /// Rays against the opaque triangles whose moving frame passes `included`.
    fn of_frames(scene: &Scene, positions: &[Vec3], included: impl Fn(usize) -> bool) -> Option<Self> {
        let opaque = scene.indices[..scene.opaque_end as usize].chunks_exact(3);
        let opaque = opaque.filter(|t| included(scene.vertices[t[0] as usize].frame()));
        let corners = opaque.clone().map(|t| t[0]).collect();
        let triangles: Vec<Triangle> = opaque
            .map(|t| {
                let [v0, v1, v2] = [t[0], t[1], t[2]].map(|i| Vec3A::from(positions[i as usize]));
                Triangle { v0, v1, v2 }
            })
            .collect();
        if triangles.is_empty() {
            return None;
        }
        let bvh = build_bvh2_from_tris(&triangles, BvhBuildParams::fast_build(), &mut Duration::default());
        Some(Self { triangles, corners, bvh })
    }

    /// Index of the nearest triangle that a ray hits.
    pub fn nearest_hit(&self, from: Vec3, direction: Vec3) -> Option<u32> {
        let (mut nearest, mut hit) = (f32::INFINITY, None);
        let ray = Ray::new(from.into(), direction.into(), 0.0, f32::INFINITY);
        self.bvh.ray_traverse(ray, &mut RayHit::none(), |ray, id| {
            let index = self.bvh.primitive_indices[id];
            let t = self.triangles[index as usize].intersect(ray);
            if t < nearest {
                (nearest, hit) = (t, Some(index));
            }
            t
        });
        hit
    }

    /// Is a triangle between two points?
    pub fn is_occluded(&self, from: Vec3, to: Vec3) -> bool {
        let mut hidden = false;
        self.for_each_hit(from, to, |_| hidden = true);
        hidden
    }

    /// Calls `hit` with the first vertex of each triangle between two points.
    pub fn for_each_hit(&self, from: Vec3, to: Vec3, mut hit: impl FnMut(u32)) {
        let direction = to - from;
        let ray = Ray::new(from.into(), direction.into(), 1e-4, 1.0);
        self.bvh.ray_traverse(ray, &mut RayHit::none(), |ray, id| {
            let index = self.bvh.primitive_indices[id] as usize;
            if self.triangles[index].intersect(ray) < 1.0 {
                hit(self.corners[index]);
            }
            f32::INFINITY
        });
    }

    /// Irradiance b from what covers the hemisphere over `point`, and the visible fraction v, 0…1. `radiosity` is that of each vertex of
    /// the scene.
    fn hemisphere(&self, point: Vec3, normal: Vec3, reach: f32, directions: &[Vec3], radiosity: &[Vec3]) -> Vec4 {
        let (t, b) = normal.any_orthonormal_pair();
        let origin = Vec3A::from(point + normal * (1e-3 * reach));
        let mut hidden = Vec4::ZERO;
        for d in directions {
            let direction = Vec3A::from(t * d.x + b * d.y + normal * d.z);
            let (mut nearest, mut corner) = (reach, 0);
            self.bvh.ray_traverse(Ray::new(origin, direction, 0.0, reach), &mut RayHit::none(), |ray, id| {
                let index = self.bvh.primitive_indices[id] as usize;
                let t = self.triangles[index].intersect(ray);
                if t < nearest {
                    (nearest, corner) = (t, self.corners[index]);
                }
                t
            });
            hidden += (1.0 - nearest / reach) * radiosity[corner as usize].extend(-1.0);
        }
        Vec4::W + hidden / directions.len() as f32
    }
}

/// Groups of vertices with nearly the same position and normal, which share their rays; at most `most` of them. At first these are the
/// same to a ten-thousandth of the radius, as where the triangles of one vertex have colours of their own. While there are too many groups, both
/// steps grow: the light of a tooth is that of its wheel's neighbouring teeth.
pub(super) fn groups(positions: &[Vec3], normals: &[Vec3], radius: f32, most: usize) -> Vec<Vec<u32>> {
    let (mut place, mut turn) = (1e-4 * radius, FINEST_TURN);
    loop {
        let key = |i: u32| {
            let whole = |v: Vec3, step: f32| [v.x, v.y, v.z].map(|c| (c / step).round() as i32);
            (whole(positions[i as usize], place), whole(normals[i as usize], turn))
        };
        let mut order: Vec<u32> = (0..positions.len() as u32).collect();
        order.sort_by_cached_key(|&i| key(i));
        let groups: Vec<Vec<u32>> = order.chunk_by(|&a, &b| key(a) == key(b)).map(<[u32]>::to_vec).collect();
        if groups.len() <= most || place > radius {
            return groups;
        }
        (place, turn) = (2.0 * place, (1.5 * turn).min(COARSEST_TURN));
    }
}

/// What static parts do to the light of both planes: row by row, the irradiance that they send, and the visible fraction of the rest.
/// `radiosity` is that of each vertex.
pub(super) fn planes(
    scene: &Scene,
    exhibit: &Exhibit,
    planes: &[ReceivingPlane; 2],
    radius: f32,
    radiosity: &[Vec3],
) -> Vec<Vec4> {
    let count = (PLANE_MAP * PLANE_MAP) as usize;
    let (positions, _) = start_geometry(scene, exhibit);
    let Some(caster) = RayCaster::of_static(scene, &positions) else { return vec![Vec4::W; 2 * count] };
    let directions = cosine_directions(TEXEL_RAYS);
    let texels: Vec<(usize, Vec2)> = (0..2 * count)
        .map(|i| {
            let at = Vec2::new((i as u32 % PLANE_MAP) as f32, ((i % count) as u32 / PLANE_MAP) as f32);
            (i / count, (at + 0.5) / PLANE_MAP as f32)
        })
        .collect();
    in_parallel(&texels, |&(plane, at)| {
        let plane = &planes[plane];
        let point = plane.origin + plane.u * (at.x * plane.size.x) + plane.v * (at.y * plane.size.y);
        // Under a foot that stands on the floor the visibility is 0; the origin is moved out of its underside.
        caster.hemisphere(point, plane.normal, radius, &directions, radiosity)
    })
}

/// World positions and normals of all vertices, with the bodies in their start poses.
pub(super) fn start_geometry(scene: &Scene, exhibit: &Exhibit) -> (Vec<Vec3>, Vec<Vec3>) {
    let frames: Vec<_> = exhibit.bodies.iter().map(|body| body.pose.matrix().as_mat4()).collect();
    let place = |v: &super::vertex::Vertex| match v.frame() {
        0 => (v.position, v.normal),
        body => (frames[body - 1].transform_point3(v.position), frames[body - 1].transform_vector3(v.normal)),
    };
    scene.vertices.iter().map(place).unzip()
}

/// N directions about +Z with density cos/π.
pub(super) fn cosine_directions(count: u32) -> Vec<Vec3> {
    (0..count)
        .map(|i| {
            let r2 = (i as f32 + 0.5) / count as f32;
            let phi = i.reverse_bits() as f32 / 4_294_967_296.0 * std::f32::consts::TAU;
            let r = r2.sqrt();
            Vec3::new(r * phi.cos(), r * phi.sin(), (1.0 - r2).sqrt())
        })
        .collect()
}

/// Maps a list on all processors; the result does not depend on their number.
pub(super) fn in_parallel<T: Sync, R: Send>(list: &[T], f: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let threads = std::thread::available_parallelism().map_or(1, |n| n.get()).min(8);
    let chunk = list.len().div_ceil(threads).max(1);
    std::thread::scope(|scope| {
        let f = &f;
        let workers: Vec<_> =
            list.chunks(chunk).map(|part| scope.spawn(move || part.iter().map(f).collect::<Vec<R>>())).collect();
        workers.into_iter().flat_map(|worker| worker.join().unwrap_or_default()).collect()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_wall_hides_half_the_sky_of_the_corner_at_its_foot() {
        // A wall much higher than the radius hides half the directions of a point at its foot, each with weight 1 − d/r
        // for d = 0.
        const SAMPLING: f32 = 0.06;
        let corner = |x: f32, y: f32, z: f32| Vec3A::new(x, y, z);
        let wall = |a, b, c| Triangle { v0: a, v1: b, v2: c };
        let (a, b, c, d) =
            (corner(0.0, -9.0, -9.0), corner(0.0, 9.0, -9.0), corner(0.0, 9.0, 9.0), corner(0.0, -9.0, 9.0));
        let triangles = vec![wall(a, b, c), wall(a, c, d)];
        let bvh = build_bvh2_from_tris(&triangles, BvhBuildParams::fast_build(), &mut Duration::default());
        let caster = RayCaster { triangles, corners: vec![0, 0], bvh };
        let directions = cosine_directions(256);
        let red = [Vec3::new(3.0, 0.0, 0.0)];
        let at = |x: f32| caster.hemisphere(Vec3::new(x, 0.0, 0.0), Vec3::Z, 1.0, &directions, &red);
        let foot = at(1e-4);
        assert!((foot.w - 0.5).abs() < SAMPLING, "{foot}");
        assert!(at(0.5).w > at(0.2).w && at(2.0) == Vec4::W, "{} {} {}", at(0.2), at(0.5), at(2.0));
        // What is hidden is replaced by the wall's own light.
        assert!((foot.x - 3.0 * (1.0 - foot.w)).abs() < 1e-5 && foot.y == 0.0, "{foot}");
    }
}

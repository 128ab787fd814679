//! Baked indirect light: radiosity by ray casting from vertices, with all bodies where they start.
//!
//! While nothing moves a ray from a vertex always ends at the same triangle. With N cosine-weighted rays of a vertex, ρ
//! the reflectance of the triangle that a ray hits, E the irradiance there, and D that of the lights themselves:
//!
//! ```text
//! v = Σ_open L / Σ_all L          what part of the light from all around arrives, L the radiance of the environment
//! R = (π/N) Σ_open G − v E_env(n) what the walls nearby send beyond that, G the radiance of the gallery where the ray ends
//! B = (1/N) Σ_hits ρ E            what comes back from surfaces
//! E = D + v E_env(n) + R + B      solved by Jacobi iteration, once for each reflection (Goral et al. 1984)
//! ```
//!
//! The environment is the gallery as the centre of the exhibit meets it. A part near the floor meets the floor elsewhere; R is that
//! difference. Where it is negative, v is smaller instead.
//!
//! The rays are the same at every vertex, in its tangent frame, so there is no noise. Triangles are refined first,
//! since baked light is interpolated linearly between vertices.
//!
//! The light moves with its vertices. That is exact for the parts that stand, and for wheels and tubes that move within a
//! case or a row nearly so: what surrounds them stays where it is. A plate that swings far away keeps the little that its
//! neighbours sent it at the start.

use std::f32::consts::PI;

use glam::{Quat, Vec3};

use super::AreaLight;
use super::environment::Environment;
use super::gallery::{Gallery, Lamp};
use super::occlusion::{RayCaster, cosine_directions, groups, in_parallel, start_geometry};
use super::radiosity::polygon_factor;
use super::scene::Scene;
use super::textures::to_linear;
use soffio_exhibit::Exhibit;
use soffio_exhibit::model::{Appearance, Model};

/// Longest edge after refinement, in radii of the scene: chosen by eye, so that no shadow edge shows the triangles.
const MAX_EDGE: f32 = 1.0 / 28.0;
/// Number of added vertices beyond which no edge is halved: bounds the time of a load.
const MAX_ADDED: usize = 8_000;
/// Most groups of vertices that share their rays: 50 rays for each. Meshes of more vertices have groups of neighbours.
const MAX_GROUPS: usize = 12_000;
/// Most rays of each vertex: more make no visible difference.
const MAX_RAYS: usize = 320;
/// Most rays of all vertices together: bounds the time of a load.
const RAY_BUDGET: usize = 600_000;
/// Number of reflections. At a reflectance of 0.3 they leave out 0.3⁵, a quarter of a per cent (see the test below).
const REFLECTIONS: u32 = 5;
/// Points along each side of an area light that a vertex is tested against: 16 steps of penumbra, chosen by eye.
const LIGHT_GRID: u32 = 4;
/// Points of a lamp's disc that a vertex is tested against: as many steps of penumbra, which interpolation smooths.
const LAMP_POINTS: u32 = 4;
/// Angle between successive points of Vogel's spiral, rad: π (3 − √5).
const GOLDEN_ANGLE: f32 = 2.399_963_2;
/// Mip level of the environment cube that rays read: as coarse as the rays are sparse.
const RAY_MIP_LEVEL: usize = 2;
/// Offset of ray origins towards the centre of the vertex's triangles, as a fraction. In the exact edge between a wall
/// and a floor rays would slip through.
const ORIGIN_INSET: f32 = 0.02;
/// Rotation of the rays, rad: none runs along the edges of refined triangles, where rounding would let it through.
const RAY_ROTATION: f32 = 0.37;

/// Light that falls on a static scene.
pub(super) struct BakedLight<'a> {
    /// Light from the environment map.
    pub environment: &'a Environment,
    /// Factor on the radiance of the environment map.
    pub env_intensity: f32,
    /// Area light, if the scene has one.
    pub area: Option<AreaLight>,
    /// The gallery; none in a scenario, whose environment is infinitely far.
    pub gallery: Option<&'a Gallery>,
}

/// What reaches a vertex from outside the exhibit.
struct Gathered {
    /// Fraction v of the light from all around that arrives.
    visibility: f32,
    /// Direct light of the lamps, and light from all around: D + v E_env + R.
    outer: Vec3,
    /// What the walls nearby send beyond the environment's light: R.
    walls: Vec3,
    /// Triangles that the rays meet.
    met: Vec<u32>,
    /// Visible fraction of the fill lamp.
    fill: f32,
}

/// Bakes the visibility, the reflected light and the fill lamp's visible fraction of each vertex. Returns the radiosity of a triangle at
/// each vertex, π times its radiance; 0 where none is opaque.
pub(super) fn corners(scene: &mut Scene, exhibit: &Exhibit, radius: f32, light: &BakedLight) -> Vec<Vec3> {
    scene.refine(MAX_EDGE * radius, MAX_ADDED);
    let (positions, normals) = start_geometry(scene, exhibit);
    let order = groups(&positions, &normals, radius, MAX_GROUPS);
    let rays = (RAY_BUDGET / order.len().max(1)).min(MAX_RAYS);
    let mut radiosity = vec![Vec3::ZERO; positions.len()];
    let Some(caster) = RayCaster::of_opaque(scene, &positions) else { return radiosity };
    let mut group_of = vec![0; positions.len()];
    for (index, group) in order.iter().enumerate() {
        group.iter().for_each(|&i| group_of[i as usize] = index);
    }
    let directions = cosine_directions(rays as u32).into_iter().map(|d| Quat::from_rotation_z(RAY_ROTATION) * d);
    let directions: Vec<Vec3> = directions.collect();
    let inward = inward(scene, &positions);
    let clear = 2e-4 * radius;
    let gathered = in_parallel(&order, |group| {
        let i = group[0] as usize;
        let mean = group.iter().map(|&i| inward[i as usize]).sum::<Vec3>() / group.len() as f32;
        let (place, normal) = (positions[i] + clear * normals[i] + ORIGIN_INSET * mean, normals[i]);
        let (t, b) = normal.any_orthonormal_pair();
        let (mut open, mut all, mut arriving) = (0.0, 0.0, Vec3::ZERO);
        let mut met = Vec::new();
        for d in &directions {
            let direction = t * d.x + b * d.y + normal * d.z;
            let brightness = light.environment.radiance(direction, RAY_MIP_LEVEL).element_sum();
            all += brightness;
            match caster.nearest_hit(place, direction) {
                Some(triangle) => met.push(triangle),
                None => {
                    open += brightness;
                    arriving += light.gallery.map_or(Vec3::ZERO, |gallery| gallery.radiance_at(place, direction));
                }
            }
        }
        let visibility = if all > 0.0 { open / all } else { 1.0 };
        let around = light.env_intensity * light.environment.irradiance_at(normal);
        let (visibility, walls) = match light.gallery {
            Some(_) => split(visibility, around, light.env_intensity * PI * arriving / rays as f32),
            None => (visibility, Vec3::ZERO),
        };
        let mut direct = light.area.as_ref().map_or(Vec3::ZERO, |area| from_area(&caster, place, normal, area));
        let mut fill = 1.0;
        for lamp in light.gallery.map_or(&[][..], |gallery| &gallery.lamps) {
            let beam = lamp.irradiance(place, normal);
            // Behind the surface no ray decides: a body that turns has its other side there.
            fill = if beam == Vec3::ZERO { 1.0 } else { lamp_visibility(&caster, place, lamp) };
            direct += beam * fill;
        }
        Gathered { visibility, outer: direct + visibility * around + walls, walls, met, fill }
    });
    let reflectance = reflectances(scene, &exhibit.model);
    let mut sent = vec![Vec3::ZERO; order.len()];
    let opaque = &scene.indices[..scene.opaque_end as usize];
    for _ in 0..REFLECTIONS {
        // Radiosity of each triangle, π times its radiance: the mean over its vertices.
        let of_triangle: Vec<Vec3> = opaque
            .chunks_exact(3)
            .zip(&reflectance)
            .map(|(t, (rho, glow))| {
                let falls = |i: u32| gathered[group_of[i as usize]].outer + sent[group_of[i as usize]];
                *rho * (falls(t[0]) + falls(t[1]) + falls(t[2])) / 3.0 + PI * *glow
            })
            .collect();
        sent = in_parallel(&gathered, |at| {
            at.met.iter().map(|&triangle| of_triangle[triangle as usize]).sum::<Vec3>() / rays as f32
        });
        opaque.chunks_exact(3).zip(&of_triangle).for_each(|(t, b)| radiosity[t[0] as usize] = *b);
    }
    for (i, vertex) in scene.vertices.iter_mut().enumerate() {
        let at = &gathered[group_of[i]];
        vertex.set_visibility(at.visibility);
        vertex.bounce = sent[group_of[i]] + at.walls;
        vertex.fill = at.fill;
    }
    radiosity
}

/// Splits what arrives from the walls into a fraction of the environment's irradiance, at most `visibility`, and the rest.
fn split(visibility: f32, environment: Vec3, arriving: Vec3) -> (f32, Vec3) {
    let fraction = (arriving / environment.max(Vec3::splat(f32::MIN_POSITIVE))).min_element().clamp(0.0, visibility);
    (fraction, arriving - fraction * environment)
}

/// From each vertex to the centre of its triangles.
fn inward(scene: &Scene, positions: &[Vec3]) -> Vec<Vec3> {
    let mut sums = vec![(Vec3::ZERO, 0.0); positions.len()];
    for t in scene.indices.chunks_exact(3) {
        let corners = [t[0], t[1], t[2]].map(|i| i as usize);
        let middle = corners.iter().map(|&i| positions[i]).sum::<Vec3>() / 3.0;
        for i in corners {
            sums[i] = (sums[i].0 + middle - positions[i], sums[i].1 + 1.0);
        }
    }
    sums.into_iter().map(|(sum, count)| sum / f32::max(count, 1.0)).collect()
}

/// Visible fraction of a lamp's disc.
fn lamp_visibility(caster: &RayCaster, place: Vec3, lamp: &Lamp) -> f32 {
    let (x, y) = lamp.axis.any_orthonormal_pair();
    let seen = (0..LAMP_POINTS).filter(|&i| {
        // Vogel's spiral, as in `common.wgsl`.
        let (sine, cosine) = (i as f32 * GOLDEN_ANGLE).sin_cos();
        let r = lamp.radius * ((i as f32 + 0.5) / LAMP_POINTS as f32).sqrt();
        !caster.is_occluded(place, lamp.position + (x * cosine + y * sine) * r)
    });
    seen.count() as f32 / LAMP_POINTS as f32
}

/// Irradiance from an area light, as far as it is visible.
fn from_area(caster: &RayCaster, place: Vec3, normal: Vec3, area: &AreaLight) -> Vec3 {
    let AreaLight { center, half_width: x, half_height: y, .. } = *area;
    if (place - center).dot(x.cross(y)) <= 0.0 {
        return Vec3::ZERO;
    }
    let factor = polygon_factor(&[center - x - y, center + x - y, center + x + y, center - x + y], place, normal);
    if factor == 0.0 {
        return Vec3::ZERO;
    }
    let at = |k: u32| (k as f32 + 0.5) * 2.0 / LIGHT_GRID as f32 - 1.0;
    let points = (0..LIGHT_GRID * LIGHT_GRID).map(|k| center + x * at(k % LIGHT_GRID) + y * at(k / LIGHT_GRID));
    let seen = points.filter(|&point| !caster.is_occluded(place, point)).count();
    area.radiance * (PI * factor * seen as f32 / (LIGHT_GRID * LIGHT_GRID) as f32)
}

/// Reflectance and emission of each opaque triangle.
fn reflectances(scene: &Scene, model: &Model) -> Vec<(Vec3, Vec3)> {
    let plain = Appearance { metallic: 0.0, ..Appearance::default() };
    let of_material: Vec<(Vec3, Vec3)> = model
        .materials
        .iter()
        .chain([&plain])
        .map(|appearance| (mean_color(appearance, model), appearance.emissive.into()))
        .collect();
    let mut list = Vec::with_capacity(scene.opaque_end as usize / 3);
    for batch in scene.batches.iter().filter(|batch| batch.indices.end <= scene.opaque_end) {
        let (rho, glow) = of_material[batch.material.min(of_material.len() - 1)];
        for t in scene.indices[batch.indices.start as usize..batch.indices.end as usize].chunks_exact(3) {
            let tint = |i: u32| Vec3::from_slice(&scene.vertices[i as usize].color);
            list.push((rho * (tint(t[0]) + tint(t[1]) + tint(t[2])) / 3.0, glow));
        }
    }
    list
}

/// Mean base colour of a material, linear.
fn mean_color(appearance: &Appearance, model: &Model) -> Vec3 {
    let base = Vec3::from_slice(&appearance.base_color);
    let Some(image) = appearance.base_color_texture.as_ref().and_then(|t| model.images.get(t.image)) else {
        return base;
    };
    // A few thousand pixels are enough for an image's mean.
    let pixels = image.rgba.chunks_exact(4).step_by((image.rgba.len() / 4 / 4096).max(1));
    let (sum, count) = pixels.fold((Vec3::ZERO, 0.0), |(sum, count), p| {
        (sum + Vec3::new(p[0].into(), p[1].into(), p[2].into()).map(|c| to_linear(c / 255.0)), count + 1.0)
    });
    base * sum / f32::max(count, 1.0)
}

#[cfg(test)]
pub(super) mod tests {
    use super::super::scene::tests::of_primitive;
    use super::*;
    use soffio_exhibit::model::Primitive;

    /// A cube of two metres seen from inside: each face with corners and a normal of its own.
    pub fn hollow_cube() -> Primitive {
        let mut cube = Primitive { material: Some(0), ..Default::default() };
        for axis in 0..3 {
            for side in [-1.0, 1.0] {
                let normal = Vec3::AXES[axis] * -side;
                let (u, v) = (Vec3::AXES[(axis + 1) % 3], Vec3::AXES[(axis + 2) % 3]);
                let first = cube.positions.len() as u32;
                let corners = [-u - v, u - v, u + v, v - u];
                cube.positions.extend(corners.map(|c| (c - normal).to_array()));
                cube.normals.extend([normal.to_array(); 4]);
                cube.indices.extend([0, 1, 2, 0, 2, 3].map(|i| first + i));
            }
        }
        cube
    }

    #[test]
    fn a_hollow_cube_that_glows_is_an_integrating_sphere() {
        // E = π e + ρ E on every wall; REFLECTIONS of them leave ρ⁵ of it out.
        const LEFT_OUT: f32 = 0.3 * 0.3 * 0.3 * 0.3 * 0.3;
        // Rays of corners in edges start a little inside the next wall or not, and single precision.
        const ROUNDING: f32 = 2e-3;
        let glowing =
            Appearance { base_color: [0.3, 0.3, 0.3, 1.0], emissive: [0.5; 3], metallic: 0.0, ..Default::default() };
        let (exhibit, mut scene) = of_primitive(hollow_cube(), vec![glowing]);
        let environment = Environment::new(|_| Vec3::ONE);
        corners(
            &mut scene,
            &exhibit,
            1.0,
            &BakedLight { environment: &environment, env_intensity: 1.0, area: None, gallery: None },
        );
        let exact = PI * 0.5 / 0.7;
        let inner =
            scene.vertices.iter().filter(|v| v.position.abs().to_array().iter().filter(|c| **c > 0.95).count() == 1);
        let mut seen = 0;
        for vertex in inner {
            let share = vertex.bounce.x / exact;
            assert!((share - 1.0 + LEFT_OUT).abs() < ROUNDING, "{} at {}", share, vertex.position);
            assert_eq!(vertex.tag >> 16 & 0xff, 0, "no sky in a closed cube");
            seen += 1;
        }
        assert!(seen > 1000, "only {seen} corners");
    }

    #[test]
    fn a_rectangle_of_light_gives_what_its_form_factor_says_where_nothing_hides_it() {
        // Rounding of the catalogue's digits.
        const TOLERANCE: f32 = 1e-4;
        // A lone floor 1 m below a square of 2 m, radiance 1: Howell's B-4 four times, E = π F.
        let floor = Primitive {
            positions: vec![[-0.1, 0.0, -0.1], [-0.1, 0.0, 0.1], [0.1, 0.0, 0.1], [0.1, 0.0, -0.1]],
            normals: vec![[0.0, 1.0, 0.0]; 4],
            indices: vec![0, 1, 2, 0, 2, 3],
            ..Default::default()
        };
        let (exhibit, scene) = of_primitive(floor, Vec::new());
        let caster = RayCaster::of_opaque(&scene, &start_geometry(&scene, &exhibit).0).expect("a triangle");
        let area = |up: f32| AreaLight {
            center: Vec3::Y,
            half_width: Vec3::X,
            half_height: up * Vec3::Z,
            radiance: Vec3::ONE,
        };
        let lit = from_area(&caster, 1e-4 * Vec3::Y, Vec3::Y, &area(1.0));
        assert!((lit.x / PI - 4.0 * 0.138_532).abs() < TOLERANCE, "{lit}");
        assert_eq!(from_area(&caster, 1e-4 * Vec3::Y, Vec3::Y, &area(-1.0)), Vec3::ZERO, "it shines to one side");
        assert_eq!(
            from_area(&caster, Vec3::new(0.013, -1e-3, 0.027), Vec3::Y, &area(1.0)),
            Vec3::ZERO,
            "the floor hides it"
        );
    }
}

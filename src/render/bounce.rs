//! The light that surfaces of a still scene send one another, baked into their corners.
//!
//! Where nothing moves, a ray from a corner ends at the same triangle for ever. With N cosine-weighted rays of a corner,
//! ρ the reflectance of the triangle that a ray meets, E the irradiance there, and D that of the lights themselves:
//!
//! ```text
//! v = Σ_open L / Σ_all L          what part of the light from all around arrives, L the radiance of the environment
//! B = (1/N) Σ_hits ρ E            what comes back from surfaces
//! E = D + v E_env(n) + B          solved by Jacobi iteration, once for each reflection (Goral et al. 1984)
//! ```
//!
//! The rays are the same at every corner, turned into its frame, so there is no noise. Triangles are made finer first: what
//! is baked into corners is linear between them.

use std::f32::consts::PI;

use glam::{Quat, Vec3};

use super::AreaLight;
use super::environment::Environment;
use super::occlusion::{Solid, at_rest, cosine_directions, groups, in_parallel};
use super::radiosity::polygon_factor;
use super::scene::Scene;
use super::textures::to_linear;
use soffio_exhibit::Exhibit;
use soffio_exhibit::model::{Appearance, Model};

/// Longest edge, in radii of the scene, and corners from which on no edge is halved.
const LONGEST: f32 = 1.0 / 28.0;
const MOST_CORNERS: usize = 30_000;
/// Rays of each corner, as many as all corners can have together; with fewer than the first they say nothing.
const RAYS: (usize, usize) = (12, 320);
const ALL_RAYS: usize = 6_000_000;
/// Reflections that are followed.
const REFLECTIONS: u32 = 5;
/// Points of a rectangle of light, along each side, that a corner looks at.
const LIGHT_GRID: u32 = 4;
/// Level of the environment's cube that rays see: as rough as the rays are sparse.
const ROUGH: usize = 2;
/// Rays start this share of the way to the middle of the corner's triangles: in the very edge between a wall and a floor
/// they would slip through.
const ASIDE: f32 = 0.02;
/// Turn of the rays, rad: none runs along the edges that halving leaves, where rounding lets it through.
const ASKEW: f32 = 0.37;

/// Light that falls on a still scene.
pub(super) struct Light<'a> {
    pub environment: &'a Environment,
    pub env_intensity: f32,
    pub area: Option<AreaLight>,
}

/// Gives each corner of a still scene its visibility and what surfaces send to it.
pub(super) fn corners(scene: &mut Scene, exhibit: &Exhibit, radius: f32, light: &Light) {
    scene.refine(LONGEST * radius, MOST_CORNERS);
    let (places, normals) = at_rest(scene, exhibit);
    let order = groups(&places, &normals, radius);
    let rays = (ALL_RAYS / order.len().max(1)).min(RAYS.1);
    let Some(solid) = (rays >= RAYS.0).then(|| Solid::new(scene, &places, false)).flatten() else { return };
    let mut group_of = vec![0; places.len()];
    for (index, group) in order.iter().enumerate() {
        group.iter().for_each(|&i| group_of[i as usize] = index);
    }
    let directions = cosine_directions(rays as u32).into_iter().map(|d| Quat::from_rotation_z(ASKEW) * d);
    let directions: Vec<Vec3> = directions.collect();
    let inward = inward(scene, &places);
    let clear = 2e-4 * radius;
    let gathered = in_parallel(&order, |group| {
        let i = group[0] as usize;
        let mean = group.iter().map(|&i| inward[i as usize]).sum::<Vec3>() / group.len() as f32;
        let (place, normal) = (places[i] + clear * normals[i] + ASIDE * mean, normals[i]);
        let (t, b) = normal.any_orthonormal_pair();
        let (mut open, mut all) = (0.0, 0.0);
        let mut met = Vec::new();
        for d in &directions {
            let way = t * d.x + b * d.y + normal * d.z;
            let brightness = light.environment.radiance(way, ROUGH).element_sum();
            all += brightness;
            match solid.nearest(place, way) {
                Some(triangle) => met.push(triangle),
                None => open += brightness,
            }
        }
        let visibility = if all > 0.0 { open / all } else { 1.0 };
        let around = light.env_intensity * visibility * light.environment.irradiance_at(normal);
        let direct = light.area.as_ref().map_or(Vec3::ZERO, |area| from_area(&solid, place, normal, area));
        (visibility, direct + around, met)
    });
    let reflectance = reflectances(scene, &exhibit.model);
    let mut sent = vec![Vec3::ZERO; order.len()];
    for _ in 0..REFLECTIONS {
        // What each triangle sends out, π times its radiance: the mean over its corners.
        let of_triangle: Vec<Vec3> = scene.indices[..scene.opaque as usize]
            .chunks_exact(3)
            .zip(&reflectance)
            .map(|(t, (rho, glow))| {
                let falls = |i: u32| gathered[group_of[i as usize]].1 + sent[group_of[i as usize]];
                *rho * (falls(t[0]) + falls(t[1]) + falls(t[2])) / 3.0 + PI * *glow
            })
            .collect();
        sent = in_parallel(&gathered, |(.., met)| {
            met.iter().map(|&triangle| of_triangle[triangle as usize]).sum::<Vec3>() / rays as f32
        });
    }
    for (i, vertex) in scene.vertices.iter_mut().enumerate() {
        vertex.set_visibility(gathered[group_of[i]].0);
        vertex.bounce = sent[group_of[i]];
    }
}

/// From each corner to the middle of its triangles: towards the surface where the corner is at its rim.
fn inward(scene: &Scene, places: &[Vec3]) -> Vec<Vec3> {
    let mut sums = vec![(Vec3::ZERO, 0.0); places.len()];
    for t in scene.indices.chunks_exact(3) {
        let corners = [t[0], t[1], t[2]].map(|i| i as usize);
        let middle = corners.iter().map(|&i| places[i]).sum::<Vec3>() / 3.0;
        for i in corners {
            sums[i] = (sums[i].0 + middle - places[i], sums[i].1 + 1.0);
        }
    }
    sums.into_iter().map(|(sum, count)| sum / f32::max(count, 1.0)).collect()
}

/// Irradiance from a rectangle of light, as much of it as is seen.
fn from_area(solid: &Solid, place: Vec3, normal: Vec3, area: &AreaLight) -> Vec3 {
    let (center, (x, y)) = (area.center, area.half);
    if (place - center).dot(x.cross(y)) <= 0.0 {
        return Vec3::ZERO;
    }
    let factor = polygon_factor(&[center - x - y, center + x - y, center + x + y, center - x + y], place, normal);
    if factor == 0.0 {
        return Vec3::ZERO;
    }
    let at = |k: u32| (k as f32 + 0.5) * 2.0 / LIGHT_GRID as f32 - 1.0;
    let points = (0..LIGHT_GRID * LIGHT_GRID).map(|k| center + x * at(k % LIGHT_GRID) + y * at(k / LIGHT_GRID));
    let seen = points.filter(|&point| !solid.hides(place, point)).count();
    area.radiance * (PI * factor * seen as f32 / (LIGHT_GRID * LIGHT_GRID) as f32)
}

/// Reflectance and glow of each opaque triangle.
fn reflectances(scene: &Scene, model: &Model) -> Vec<(Vec3, Vec3)> {
    let plain = Appearance { metallic: 0.0, ..Appearance::default() };
    let of_material: Vec<(Vec3, Vec3)> =
        model.materials.iter().chain([&plain]).map(|look| (mean_color(look, model), look.emissive.into())).collect();
    let mut list = Vec::with_capacity(scene.opaque as usize / 3);
    for part in scene.parts.iter().filter(|part| part.indices.end <= scene.opaque) {
        let (rho, glow) = of_material[part.material.min(of_material.len() - 1)];
        for t in scene.indices[part.indices.start as usize..part.indices.end as usize].chunks_exact(3) {
            let tint = |i: u32| Vec3::from_slice(&scene.vertices[i as usize].color);
            list.push((rho * (tint(t[0]) + tint(t[1]) + tint(t[2])) / 3.0, glow));
        }
    }
    list
}

/// Mean base colour of a material, linear.
fn mean_color(look: &Appearance, model: &Model) -> Vec3 {
    let base = Vec3::from_slice(&look.base_color);
    let Some(image) = look.base_color_texture.as_ref().and_then(|t| model.images.get(t.image)) else { return base };
    // A few thousand pixels say what an image's mean is.
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
        corners(&mut scene, &exhibit, 1.0, &Light { environment: &environment, env_intensity: 1.0, area: None });
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
        let solid = Solid::new(&scene, &at_rest(&scene, &exhibit).0, false).expect("a triangle");
        let area = |up: f32| AreaLight { center: Vec3::Y, half: (Vec3::X, up * Vec3::Z), radiance: Vec3::ONE };
        let lit = from_area(&solid, 1e-4 * Vec3::Y, Vec3::Y, &area(1.0));
        assert!((lit.x / PI - 4.0 * 0.138_532).abs() < TOLERANCE, "{lit}");
        assert_eq!(from_area(&solid, 1e-4 * Vec3::Y, Vec3::Y, &area(-1.0)), Vec3::ZERO, "it shines to one side");
        assert_eq!(
            from_area(&solid, Vec3::new(0.013, -1e-3, 0.027), Vec3::Y, &area(1.0)),
            Vec3::ZERO,
            "the floor hides it"
        );
    }
}

//! Tests of whole pictures and paths against closed forms and the live picture.

use std::f32::consts::PI;
use std::path::Path;

use glam::{Vec3, Vec4};

use super::super::bounce::tests::hollow_cube;
use super::super::gallery::Lamp;
use super::super::radiosity::polygon_factor;
use super::super::scene::tests::of_primitive;
use super::super::{AreaLight, FrameInput, ImageRenderer, Lighting, flip};
use super::gloss::AlbedoTable;
use super::lights::{Light, Rectangle, Sky};
use super::material::Materials;
use super::path::Stage;
use super::sequence::Sobol;
use super::world::World;
use super::{Environment, Reference, Settings};
use soffio_exhibit::Exhibit;
use soffio_exhibit::model::{Appearance, Primitive};

/// Paint without gloss.
fn matte(grey: f32) -> Appearance {
    Appearance {
        base_color: [grey, grey, grey, 1.0],
        metallic: 0.0,
        specular: 0.0,
        double_sided: true,
        ..Appearance::default()
    }
}

/// A horizontal square of two metres at y = 0.
fn floor() -> Primitive {
    Primitive {
        positions: vec![[-1.0, 0.0, -1.0], [-1.0, 0.0, 1.0], [1.0, 0.0, 1.0], [1.0, 0.0, -1.0]],
        normals: vec![[0.0, 1.0, 0.0]; 4],
        indices: vec![0, 1, 2, 0, 2, 3],
        material: Some(0),
        ..Primitive::default()
    }
}

/// Mean radiance of `paths` paths along a ray, in an exhibit of one primitive under these lights.
fn mean(primitive: Primitive, look: Appearance, lights: &[Light], ray: (Vec3, Vec3), paths: u32) -> Vec3 {
    let (exhibit, scene) = of_primitive(primitive, vec![look]);
    let materials = Materials::new(&exhibit.model);
    let world = World::new(&scene, scene.vertices.clone(), &[], &materials);
    let table = AlbedoTable::new();
    let sky = lights.iter().position(|light| matches!(light, Light::Sky(_)));
    let stage = Stage {
        world: &world,
        gallery: None,
        lights,
        wide: lights.iter().filter(|light| matches!(light, Light::Sky(_) | Light::Rectangle(_))).count(),
        sky,
        background: Vec3::ONE,
        table: &table,
        varnish: true,
        scale: 1.0,
    };
    let sobol = Sobol::new(paths);
    let one = |i| stage.radiance(ray.0, ray.1.normalize(), &mut sobol.sequence((11, 17), i));
    (0..paths).map(one).sum::<Vec3>() / paths as f32
}

fn white_sky() -> Light {
    Light::Sky(Sky::new(Environment::new(|_| Vec3::ONE).into(), 1.0))
}

#[test]
fn a_floor_under_a_disc_lamp_has_its_irradiance_in_closed_form() {
    // Noise of 4096 stratified points.
    const NOISE: f32 = 1e-3;
    let (d, r) = (0.8, 0.3_f32);
    let lamp = Lamp {
        position: Vec3::new(0.0, d, 0.0),
        axis: Vec3::NEG_Y,
        radius: r,
        intensity: Vec3::new(2.0, 1.0, 0.5),
        cos_inner: 0.5,
        cos_outer: 0.3,
    };
    // Each point of the disc is a lamp: E = (I / A) ∫ d / (d² + ρ²)^(3/2) dA = 2 I / R² (1 − d / √(d² + R²)).
    let irradiance = lamp.intensity * (2.0 / (r * r) * (1.0 - d / d.hypot(r)));
    let ray = (Vec3::new(0.5, 0.5, 0.0), Vec3::new(-1.0, -1.0, 0.0));
    let seen = mean(floor(), matte(0.6), &[Light::Lamp(lamp)], ray, 4096);
    let exact = irradiance * (0.6 / PI);
    assert!(((seen - exact) / exact).abs().max_element() < NOISE, "{seen} instead of {exact}");
}

#[test]
fn a_rectangle_lights_a_floor_by_its_form_factor() {
    // Noise of 4096 stratified points of a rectangle that is nearly as close as it is wide.
    const NOISE: f32 = 5e-3;
    let area = AreaLight {
        center: Vec3::new(0.4, 0.5, 0.1),
        half_width: Vec3::new(0.3, 0.1, 0.0),
        half_height: Vec3::new(0.0, 0.0, 0.4),
        radiance: Vec3::new(1.0, 2.0, 3.0),
    };
    // It shines downwards, along half width × half height.
    assert!(area.half_width.cross(area.half_height).y < 0.0);
    let AreaLight { center: c, half_width: x, half_height: y, .. } = area;
    let factor = polygon_factor(&[c - x - y, c + x - y, c + x + y, c - x + y], Vec3::ZERO, Vec3::Y);
    let ray = (Vec3::new(-0.5, 0.5, 0.0), Vec3::new(1.0, -1.0, 0.0));
    let seen = mean(floor(), matte(0.6), &[Light::Rectangle(Rectangle::new(area))], ray, 4096);
    let exact = area.radiance * (0.6 * factor);
    assert!(((seen - exact) / exact).abs().max_element() < NOISE, "{seen} instead of {exact}");
}

#[test]
fn a_closed_box_that_glows_is_an_integrating_sphere() {
    // L = e / (1 − ρ). Noise of 4096 paths that end by roulette.
    const NOISE: f32 = 0.01;
    for (grey, glow) in [(0.5, 0.3), (0.8, 0.1)] {
        let look = Appearance { emissive: [glow; 3], ..matte(grey) };
        let seen = mean(hollow_cube(), look, &[], (Vec3::ZERO, Vec3::new(0.3, -0.5, 0.8)), 4096).x;
        let exact = glow / (1.0 - grey);
        assert!((seen / exact - 1.0).abs() < NOISE, "{seen} instead of {exact}");
    }
}

#[test]
fn white_things_vanish_in_front_of_a_white_sky() {
    // The energy of several scatterings is compensated by a table that is up to 3 % too bright for rough metal.
    const TABLE_NOISE: f32 = 0.045;
    let ray = (Vec3::new(3.0, 1.2, 2.0), Vec3::new(-3.0, -1.0, -2.1));
    for metallic in [0.0, 1.0] {
        for roughness in [0.1, 0.5, 1.0] {
            let look = Appearance { metallic, roughness, specular: 1.0, ..matte(1.0) };
            let seen = mean(hollow_cube(), look, &[white_sky()], ray, 2048);
            assert!((seen - 1.0).abs().max_element() < TABLE_NOISE, "{metallic} {roughness}: {seen}");
        }
    }
}

#[test]
fn glass_lets_through_what_the_live_picture_lets_through() {
    // A pane of one wall on a black sky: the background's white times one crossing, and no gloss of the sky.
    const NOISE: f32 = 0.02;
    let glass = Appearance {
        base_color: [0.81, 0.64, 0.49, 1.0],
        transmission: 1.0,
        metallic: 0.0,
        roughness: 0.1,
        ..Appearance::default()
    };
    let seen = mean(floor(), glass, &[], (Vec3::Y, Vec3::NEG_Y), 1 << 14);
    // Half of a pane's colour, √c times the path 1, less Fresnel's 0.04.
    let exact = 0.96 * Vec3::new(0.9, 0.8, 0.7);
    assert!(((seen - exact) / exact).abs().max_element() < NOISE, "{seen} instead of {exact}");
}

#[test]
fn a_small_sun_in_the_sky_is_found_and_lights_as_its_texels_say() {
    // Noise of 8192 paths, most of which sample the sun.
    const NOISE: f32 = 0.01;
    let sun = Vec3::new(0.3, 0.8, 0.2).normalize();
    let environment = Environment::new(|d| Vec3::splat(if d.dot(sun) > 0.995 { 100.0 } else { 0.2 }));
    let sky = Sky::new(environment.into(), 0.5);
    // Midpoint rule over the upper hemisphere.
    let (rows, columns) = (1024, 2048);
    let mut irradiance = Vec3::ZERO;
    for i in 0..rows * columns {
        let height = ((i / columns) as f32 + 0.5) / rows as f32;
        let phi = 2.0 * PI * ((i % columns) as f32 + 0.5) / columns as f32;
        let r = (1.0 - height * height).sqrt();
        irradiance += sky.radiance(Vec3::new(r * phi.cos(), height, r * phi.sin())) * height;
    }
    let exact = irradiance * (2.0 * PI / (rows * columns) as f32) * (0.6 / PI);
    let seen = mean(floor(), matte(0.6), &[Light::Sky(sky)], (Vec3::Y, Vec3::NEG_Y), 8192);
    assert!(((seen - exact) / exact).abs().max_element() < NOISE, "{seen} instead of {exact}");
}

/// A frame of an exhibit at the start.
fn frame(exhibit: &Exhibit, size: (u32, u32)) -> FrameInput<'static> {
    let view = exhibit.view(f64::from(size.0) / f64::from(size.1));
    FrameInput { poses: &[], dust: &[], curves: &[], view, size, exposure: 1.0, time: 0.0 }
}

#[test]
fn a_picture_has_the_same_bits_for_any_number_of_threads() {
    let exhibit = shipped("pendulum");
    let picture = |threads| {
        let mut reference = Reference::new(&exhibit, &Lighting::default()).expect("few bodies");
        let settings = Settings { samples: 4, threads: Some(threads) };
        reference.radiance(&frame(&exhibit, (32, 18)), settings, &|_| ()).expect("a small picture")
    };
    let (one, two) = (picture(1), picture(2));
    assert!(one.iter().zip(&two).all(|(a, b)| a.to_array().map(f32::to_bits) == b.to_array().map(f32::to_bits)));
    assert!(one.iter().all(|c| c.is_finite()) && one.iter().any(|c| *c != one[0]));
}

fn shipped(id: &str) -> Exhibit {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../exhibits").join(id);
    soffio_exhibit::load(&folder).expect("a shipped exhibit")
}

#[test]
fn the_live_picture_of_the_pendulum_resembles_its_reference() {
    // Measured 0.16: the six patches of the radiosity miss a tenth of the light, and 64 paths leave noise.
    const BAR: f32 = 0.18;
    let exhibit = shipped("pendulum");
    let frame = frame(&exhibit, (192, 108));
    let mut live = ImageRenderer::new(&exhibit, |_| {}).expect("a Vulkan driver").with_supersampling(2);
    let live = live.draw(&frame).expect("a picture");
    let mut reference = Reference::new(&exhibit, &Lighting::default()).expect("few bodies");
    let settings = Settings { samples: 64, ..Settings::default() };
    let reference = reference.picture(&frame, settings, &|_| ()).expect("a small picture");
    let difference = flip::mean(&reference, &live, flip::PIXELS_PER_DEGREE).expect("one size");
    assert!(difference < BAR, "mean of FLIP {difference}");
}

#[test]
fn a_blended_pane_hides_what_its_alpha_says() {
    // The pane is white without light: alpha of black in front of the white background, Noise of 2^14 decisions.
    const NOISE: f32 = 0.01;
    let pane =
        Appearance { base_color: [1.0, 1.0, 1.0, 0.25], alpha: soffio_exhibit::model::AlphaMode::Blend, ..matte(1.0) };
    let seen = mean(floor(), pane, &[], (Vec3::Y, Vec3::NEG_Y), 1 << 14);
    assert!((seen.x - 0.75).abs() < NOISE, "{seen}");
}

#[test]
fn a_normal_map_without_tangents_bends_the_normal_along_its_coordinates() {
    use super::super::textures::ColorSpace;
    use super::texture::Map;
    use soffio_exhibit::model::TextureUse;
    // A wall seen from the front: u to the right, v down, so +x of the map is right and +y is up.
    let point = super::material::Point {
        normal: Vec3::Z,
        facing: Vec3::Z,
        tangent: Vec4::ZERO,
        uv: [0.0; 4],
        color: Vec4::ONE,
        edges: [(Vec3::new(2.0, 0.0, 0.0), [1.0, 0.0, 1.0, 0.0]), (Vec3::new(0.0, -2.0, 0.0), [0.0, 1.0, 0.0, 1.0])],
    };
    let map = Map::new(TextureUse::of(0), ColorSpace::Linear);
    let bent = super::material::bent(&point, Vec3::Z, &map, Vec3::new(0.6, 0.0, 0.8), 1.0);
    assert!(bent.distance(Vec3::new(0.6, 0.0, 0.8)) < 1e-6, "{bent}");
    let bent = super::material::bent(&point, Vec3::Z, &map, Vec3::new(0.0, 0.6, 0.8), 1.0);
    assert!(bent.distance(Vec3::new(0.0, 0.6, 0.8)) < 1e-6, "{bent}");
}

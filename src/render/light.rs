//! Bind group of the light on one exhibit: textures and samplers.

use glam::Vec4;

use super::Gpu;
use super::environment::{CUBE_MIPS, CUBE_SIZE, Environment};
use super::gallery::Gallery;
use super::occlusion::PLANE_MAP;
use super::radiosity::LIGHTMAP_SIZE;
use super::resources::{SquareSize, half4, light_texture};
use super::shared::SharedResources;

/// Sources of the light on one exhibit.
pub(super) struct LightResources<'a> {
    /// Environment map, with its levels of roughness.
    pub environment: &'a Environment,
    /// Gallery, whose faces have a light map.
    pub gallery: &'a Gallery,
    /// Shadows on wall and floor.
    pub planes: &'a [wgpu::TextureView; 2],
    /// Irradiance that static parts send to both, and the visible fraction of the rest.
    pub ambient: &'a [Vec4],
    /// Silhouettes of plates.
    pub contours: &'a wgpu::TextureView,
}

/// The bind group of the light.
pub(super) fn light_group(gpu: &Gpu, shared: &SharedResources, light: LightResources) -> wgpu::BindGroup {
    // Face after face, each with all its levels: the order `create_texture_with_data` calls layer-major.
    let mut cube = Vec::new();
    for face in 0..6 {
        for level in &light.environment.levels {
            let texels = level.len() / 6;
            cube.extend(level[face * texels..(face + 1) * texels].iter().map(|c| half4([c.x, c.y, c.z, 1.0])));
        }
    }
    // One layer more than faces: GL would make a cube of six square ones.
    let mut lightmap: Vec<_> = light.gallery.lightmap().into_iter().map(half4).collect();
    lightmap.resize(lightmap.len() / 6 * 7, [0; 4]);
    use wgpu::TextureViewDimension::{Cube, D2Array};
    let environment =
        light_texture(gpu, "environment", SquareSize { side: CUBE_SIZE, layers: 6, levels: CUBE_MIPS }, &cube, Cube);
    let lightmap =
        light_texture(gpu, "light map", SquareSize { side: LIGHTMAP_SIZE, layers: 7, levels: 1 }, &lightmap, D2Array);
    let ambient: Vec<_> = light.ambient.iter().map(|texel| half4(texel.to_array())).collect();
    let ambient =
        light_texture(gpu, "ambient", SquareSize { side: PLANE_MAP, layers: 2, levels: 1 }, &ambient, D2Array);
    use wgpu::BindingResource::{Sampler, TextureView};
    let resources = [
        TextureView(&environment),
        TextureView(&shared.table),
        Sampler(&shared.smooth),
        TextureView(&shared.map_views[1]),
        TextureView(&light.planes[0]),
        TextureView(&light.planes[1]),
        TextureView(&lightmap),
        TextureView(&ambient),
        TextureView(light.contours),
    ];
    let entries: Vec<_> =
        (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
    let layout = &shared.layouts.light;
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("light"), layout, entries: &entries })
}

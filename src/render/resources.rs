//! Textures to draw into, and the textures and samplers of the light.

use wgpu::util::DeviceExt;

use super::Gpu;
use super::environment::{CUBE_MIPS, CUBE_SIZE, Environment};
use super::fixtures::Fixtures;
use super::gallery::Room;
use super::occlusion::PLANE_MAP;
use super::passes::Attachment;
use super::radiosity::LIGHTMAP_SIZE;

/// A texture to draw into.
pub(super) fn attachment(device: &wgpu::Device, of: Attachment, usage: wgpu::TextureUsages) -> wgpu::TextureView {
    let descriptor = wgpu::TextureDescriptor {
        label: Some(of.label),
        size: wgpu::Extent3d { width: of.size.0, height: of.size.1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: of.samples,
        dimension: wgpu::TextureDimension::D2,
        format: of.format,
        usage: usage | wgpu::TextureUsages::RENDER_ATTACHMENT,
        view_formats: &[],
    };
    device.create_texture(&descriptor).create_view(&Default::default())
}

/// Four numbers as 16-bit floats.
pub(super) fn half4(v: [f32; 4]) -> [u16; 4] {
    v.map(|x| half::f16::from_f32(x).to_bits())
}

/// A sampler between texels and levels.
pub(super) fn sampler(device: &wgpu::Device) -> wgpu::Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor {
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..Default::default()
    })
}

/// A square texture (texels along a side, layers, levels) of 16-bit floats, layer after layer, each with all its levels.
pub(super) fn light_texture(
    gpu: &Gpu,
    label: &str,
    (side, layers, levels): (u32, u32, u32),
    texels: &[[u16; 4]],
    dimension: wgpu::TextureViewDimension,
) -> wgpu::TextureView {
    let format = wgpu::TextureFormat::Rgba16Float;
    let texture = filled(gpu, label, (side, layers, levels), format, bytemuck::cast_slice(texels));
    texture.create_view(&wgpu::TextureViewDescriptor { dimension: Some(dimension), ..Default::default() })
}

fn filled(
    gpu: &Gpu,
    label: &str,
    (side, layers, levels): (u32, u32, u32),
    format: wgpu::TextureFormat,
    bytes: &[u8],
) -> wgpu::Texture {
    let descriptor = wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: layers },
        mip_level_count: levels,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    };
    gpu.device.create_texture_with_data(&gpu.queue, &descriptor, wgpu::util::TextureDataOrder::LayerMajor, bytes)
}

/// What lights one work.
pub(super) struct Light<'a> {
    pub environment: &'a Environment,
    pub room: &'a Room,
    /// Shadows on wall and floor.
    pub planes: &'a [wgpu::TextureView; 2],
    /// What static parts leave of the sky over both.
    pub ambient: &'a [u8],
    /// Silhouettes.
    pub contours: &'a wgpu::TextureView,
}

/// A texture of four numbers a texel, to be filled in each frame.
pub(super) fn numbers(device: &wgpu::Device, label: &str, (width, height): (u32, u32)) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    })
}

/// A texture alone.
pub(super) fn single(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    texture: &wgpu::Texture,
) -> wgpu::BindGroup {
    let view = texture.create_view(&Default::default());
    let entries = [wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) }];
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
}

/// Textures and samplers of the light.
pub(super) fn light_group(gpu: &Gpu, fixtures: &Fixtures, light: Light) -> wgpu::BindGroup {
    // Face after face, each with all its levels: the order `create_texture_with_data` calls layer-major.
    let mut cube = Vec::new();
    for face in 0..6 {
        for level in &light.environment.levels {
            let texels = level.len() / 6;
            cube.extend(level[face * texels..(face + 1) * texels].iter().map(|c| half4([c.x, c.y, c.z, 1.0])));
        }
    }
    // One layer more than faces: of six square ones GL would make a cube.
    let mut lightmap: Vec<_> = light.room.lightmap().into_iter().map(half4).collect();
    lightmap.resize(lightmap.len() / 6 * 7, [0; 4]);
    use wgpu::TextureViewDimension::{Cube, D2Array};
    let environment = light_texture(gpu, "environment", (CUBE_SIZE, 6, CUBE_MIPS), &cube, Cube);
    let lightmap = light_texture(gpu, "light map", (LIGHTMAP_SIZE, 7, 1), &lightmap, D2Array);
    let ambient = filled(gpu, "ambient", (PLANE_MAP, 2, 1), wgpu::TextureFormat::R8Unorm, light.ambient);
    let ambient = ambient.create_view(&wgpu::TextureViewDescriptor { dimension: Some(D2Array), ..Default::default() });
    use wgpu::BindingResource::{Sampler, TextureView};
    let resources = [
        TextureView(&environment),
        TextureView(&fixtures.table),
        Sampler(&fixtures.smooth),
        TextureView(&fixtures.map_views[1]),
        TextureView(&light.planes[0]),
        TextureView(&light.planes[1]),
        TextureView(&lightmap),
        TextureView(&ambient),
        TextureView(light.contours),
    ];
    let entries: Vec<_> =
        (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
    let layout = &fixtures.layouts.light;
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("light"), layout, entries: &entries })
}

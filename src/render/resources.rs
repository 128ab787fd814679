//! Textures to draw into, and the textures and samplers of the light.

use wgpu::util::DeviceExt;

use super::Gpu;
use super::environment::{CUBE_MIPS, CUBE_SIZE, Environment, TABLE_SIZE, split_sum_table};
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

/// Textures and samplers of the light.
pub(super) fn light_group(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    environment: &Environment,
    room: &Room,
    plane_views: &[wgpu::TextureView; 2],
    map_views: &[wgpu::TextureView; 2],
    ambient: &[u8],
) -> wgpu::BindGroup {
    let half4 = |v: [f32; 4]| v.map(|x| half::f16::from_f32(x).to_bits());
    // Face after face, each with all its levels: the order `create_texture_with_data` calls layer-major.
    let mut cube = Vec::new();
    for face in 0..6 {
        for level in &environment.levels {
            let texels = level.len() / 6;
            cube.extend(level[face * texels..(face + 1) * texels].iter().map(|c| half4([c.x, c.y, c.z, 1.0])));
        }
    }
    let table: Vec<_> = split_sum_table().iter().map(|&[a, b, c]| half4([a, b, c, 1.0])).collect();
    // One layer more than faces: of six square ones GL would make a cube.
    let mut lightmap: Vec<_> = room.lightmap().into_iter().map(half4).collect();
    lightmap.resize(lightmap.len() / 6 * 7, [0; 4]);
    let upload = |label, size: u32, layers, mips, texels: &[[u16; 4]]| {
        gpu.device.create_texture_with_data(
            &gpu.queue,
            &wgpu::TextureDescriptor {
                label: Some(label),
                size: wgpu::Extent3d { width: size, height: size, depth_or_array_layers: layers },
                mip_level_count: mips,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::Rgba16Float,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            },
            wgpu::util::TextureDataOrder::LayerMajor,
            bytemuck::cast_slice(texels),
        )
    };
    let view = |texture: wgpu::Texture, dimension| {
        texture.create_view(&wgpu::TextureViewDescriptor { dimension: Some(dimension), ..Default::default() })
    };
    let environment_view =
        view(upload("environment", CUBE_SIZE, 6, CUBE_MIPS, &cube), wgpu::TextureViewDimension::Cube);
    let table_view = view(upload("split sum", TABLE_SIZE, 1, 1, &table), wgpu::TextureViewDimension::D2);
    let lightmap_view = view(upload("light map", LIGHTMAP_SIZE, 7, 1, &lightmap), wgpu::TextureViewDimension::D2Array);
    let size = wgpu::Extent3d { width: PLANE_MAP, height: PLANE_MAP, depth_or_array_layers: 2 };
    let ambient = gpu.device.create_texture_with_data(
        &gpu.queue,
        &wgpu::TextureDescriptor {
            label: Some("ambient"),
            size,
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::R8Unorm,
            usage: wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        },
        wgpu::util::TextureDataOrder::LayerMajor,
        ambient,
    );
    let ambient_view = view(ambient, wgpu::TextureViewDimension::D2Array);
    let sampler = |compare| {
        gpu.device.create_sampler(&wgpu::SamplerDescriptor {
            mag_filter: wgpu::FilterMode::Linear,
            min_filter: wgpu::FilterMode::Linear,
            mipmap_filter: wgpu::MipmapFilterMode::Linear,
            compare,
            ..Default::default()
        })
    };
    let (smooth, shadow) = (sampler(None), sampler(Some(wgpu::CompareFunction::GreaterEqual)));
    use wgpu::BindingResource::{Sampler, TextureView};
    let resources = [
        TextureView(&environment_view),
        TextureView(&table_view),
        Sampler(&smooth),
        TextureView(&map_views[0]),
        Sampler(&shadow),
        TextureView(&plane_views[0]),
        TextureView(&plane_views[1]),
        TextureView(&lightmap_view),
        TextureView(&ambient_view),
        TextureView(&map_views[1]),
    ];
    let entries: Vec<_> =
        (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("light"), layout, entries: &entries })
}

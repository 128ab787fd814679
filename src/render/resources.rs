//! Creation of render targets and data textures.

use wgpu::util::DeviceExt;

use super::Gpu;
use super::passes::Attachment;

/// A render target.
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

/// A linear sampler, also between mip levels.
pub(super) fn sampler(device: &wgpu::Device) -> wgpu::Sampler {
    device.create_sampler(&wgpu::SamplerDescriptor {
        mag_filter: wgpu::FilterMode::Linear,
        min_filter: wgpu::FilterMode::Linear,
        mipmap_filter: wgpu::MipmapFilterMode::Linear,
        ..Default::default()
    })
}

/// Size of a square texture.
#[derive(Clone, Copy)]
pub(super) struct SquareSize {
    /// Texels along a side.
    pub side: u32,
    /// Number of layers.
    pub layers: u32,
    /// Number of mip levels.
    pub levels: u32,
}

/// A square texture of 16-bit floats, layer by layer, each with all its levels.
pub(super) fn light_texture(
    gpu: &Gpu,
    label: &str,
    size: SquareSize,
    texels: &[[u16; 4]],
    dimension: wgpu::TextureViewDimension,
) -> wgpu::TextureView {
    let format = wgpu::TextureFormat::Rgba16Float;
    let texture = filled(gpu, label, size, format, bytemuck::cast_slice(texels));
    texture.create_view(&wgpu::TextureViewDescriptor { dimension: Some(dimension), ..Default::default() })
}

/// A square texture of `bytes`.
pub(super) fn filled(
    gpu: &Gpu,
    label: &str,
    size: SquareSize,
    format: wgpu::TextureFormat,
    bytes: &[u8],
) -> wgpu::Texture {
    let SquareSize { side, layers, levels } = size;
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

/// A texture of four floats a texel, filled in each frame.
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

/// A bind group of one texture.
pub(super) fn single(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    texture: &wgpu::Texture,
) -> wgpu::BindGroup {
    let view = texture.create_view(&Default::default());
    let entries = [wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) }];
    device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
}

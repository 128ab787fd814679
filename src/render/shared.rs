//! Device resources that all exhibits share: layouts, pipelines, samplers, lookup tables, and the buffers and textures
//! whose size does not depend on an exhibit.
//!
//! Invariant: once the pipelines of an exhibit exist, showing it again creates nothing here.

use std::collections::BTreeMap;

use super::environment::{TABLE_SIZE, split_sum_table};
use super::frames::MAX_FRAMES;
use super::globals::Globals;
use super::passes::PassPlan;
use super::pipelines::{Layouts, Pipelines};
use super::resources::{SquareSize, attachment, half4, light_texture, sampler};
use super::shadows::ShadowMapCamera;
use super::textures;
use super::{Gpu, Options, details};
use soffio_exhibit::model::Sampler;

/// Most dust particles drawn: 64 KiB of vertices, a bound on the work of a frame.
pub(super) const MAX_DUST: usize = 4096;

/// Resources that all exhibits share on one device.
pub(super) struct SharedResources {
    /// Layouts of all bind groups.
    pub layouts: Layouts,
    /// Pipelines of all passes.
    pub pipelines: Pipelines,
    /// Uniforms of a frame.
    pub globals_buffer: wgpu::Buffer,
    /// Matrices of all frames that carry meshes.
    pub frames_buffer: wgpu::Buffer,
    /// Dust particles, one instance each.
    pub dust_buffer: wgpu::Buffer,
    /// Bind group of the uniforms and the matrices.
    pub frame_group: wgpu::BindGroup,
    /// Split-sum table.
    pub table: wgpu::TextureView,
    /// Sampler of all textures of the light.
    pub smooth: wgpu::Sampler,
    /// Shadow map: depth target, and the same depths for reading.
    pub map_views: [wgpu::TextureView; 2],
    /// White texture in place of a missing one.
    pub white: wgpu::TextureView,
    /// White texture arrays in place of missing extension textures: colours, and data.
    pub no_details: [wgpu::TextureView; 2],
    /// Samplers of the materials.
    pub samplers: BTreeMap<Sampler, wgpu::Sampler>,
}

impl SharedResources {
    /// Creates them on a device.
    pub fn new(gpu: &Gpu, options: &Options) -> Self {
        let device = &gpu.device;
        let layouts = Layouts::new(device);
        let buffer = |label, size: usize, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: size as u64,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let globals_buffer = buffer("globals", size_of::<Globals>(), wgpu::BufferUsages::UNIFORM);
        let frames_buffer = buffer("frames", MAX_FRAMES * 48, wgpu::BufferUsages::UNIFORM);
        let frame_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout: &layouts.frame,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: globals_buffer.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: frames_buffer.as_entire_binding() },
            ],
        });
        let table: Vec<_> = split_sum_table().iter().map(|&[a, b, c]| half4([a, b, c, 1.0])).collect();
        let map = PassPlan::shadow_map(ShadowMapCamera::size(options.shadow_quality));
        Self {
            pipelines: Pipelines::new(gpu, &layouts, options),
            layouts,
            globals_buffer,
            frames_buffer,
            dust_buffer: buffer("dust", MAX_DUST * 16, wgpu::BufferUsages::VERTEX),
            frame_group,
            table: light_texture(
                gpu,
                "split sum",
                SquareSize { side: TABLE_SIZE, layers: 1, levels: 1 },
                &table,
                wgpu::TextureViewDimension::D2,
            ),
            smooth: sampler(device),
            map_views: map.map(|of| attachment(device, of, wgpu::TextureUsages::TEXTURE_BINDING)),
            white: textures::white(gpu),
            no_details: details::none(gpu),
            samplers: BTreeMap::new(),
        }
    }
}

//! What a device keeps while works come and go: layouts, pipelines, samplers, the tables that are the same for every
//! work, and the buffers and textures whose size no work decides.
//!
//! Invariant: once the states of a work have been covered, showing it again makes nothing here.

use std::collections::BTreeMap;

use super::environment::{TABLE_SIZE, split_sum_table};
use super::frames::MAX_FRAMES;
use super::globals::Globals;
use super::passes::Plan;
use super::pipelines::{Layouts, Pipelines};
use super::resources::{attachment, half4, light_texture, sampler};
use super::shadows::MapCamera;
use super::textures;
use super::{Gpu, Options, details};
use soffio_exhibit::model::Sampler;

/// Most motes drawn.
pub(super) const MAX_MOTES: usize = 4096;

/// What all works share on one device.
pub(super) struct Fixtures {
    pub layouts: Layouts,
    pub pipelines: Pipelines,
    pub globals_buffer: wgpu::Buffer,
    pub frames_buffer: wgpu::Buffer,
    pub motes_buffer: wgpu::Buffer,
    pub frame_group: wgpu::BindGroup,
    /// Split-sum table.
    pub table: wgpu::TextureView,
    /// For all textures of the light.
    pub smooth: wgpu::Sampler,
    /// Shadow map: the order of what is drawn, and the same depths to be read.
    pub map_views: [wgpu::TextureView; 2],
    /// Texture of what has none.
    pub white: wgpu::TextureView,
    /// The same for the textures of extensions: colours, and data.
    pub no_details: [wgpu::TextureView; 2],
    /// Of the materials.
    pub samplers: BTreeMap<Sampler, wgpu::Sampler>,
}

impl Fixtures {
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
        let map = Plan::shadow_map(MapCamera::size(options.quality));
        Self {
            pipelines: Pipelines::new(gpu, &layouts, options),
            layouts,
            globals_buffer,
            frames_buffer,
            motes_buffer: buffer("motes", MAX_MOTES * 16, wgpu::BufferUsages::VERTEX),
            frame_group,
            table: light_texture(gpu, "split sum", (TABLE_SIZE, 1, 1), &table, wgpu::TextureViewDimension::D2),
            smooth: sampler(device),
            map_views: map.map(|of| attachment(device, of, wgpu::TextureUsages::TEXTURE_BINDING)),
            white: textures::white(gpu),
            no_details: details::none(gpu),
            samplers: BTreeMap::new(),
        }
    }
}

//! Forward renderer: the order of the passes over the shared resources and the current exhibit.

use std::sync::Arc;

use glam::{Vec3, Vec4};

use super::baked::Baked;
use super::gpu_exhibit::GpuExhibit;
use super::passes::{Pass, PassPlan};
use super::pipelines::Pipelines;
use super::resources::attachment;
use super::scene::{Batch, SurfaceKind};
use super::shadows::ShadowMapCamera;
use super::shared::{MAX_DUST, SharedResources};
use super::vertex::Vertex;
use super::{FrameInput, Gpu, Options, RenderError, Sampling, Shaders};
use soffio_exhibit::Exhibit;

/// Draws one exhibit at a time into targets of one format. Created once for each device.
pub struct Renderer {
    options: Options,
    shared: SharedResources,
    current: GpuExhibit,
    targets: Option<Targets>,
    dust: Vec<Vec4>,
    /// Pixels drawn along a side for each of the target's.
    scale: f32,
    /// Pipelines of the sample count that is not in use.
    other_sampling: Option<(u32, Pipelines)>,
}

/// Targets that depend on the size of the picture.
struct Targets {
    /// Size of the picture, pixels.
    size: (u32, u32),
    /// The picture before upscaling, and its bind group.
    scaled: Option<(wgpu::TextureView, wgpu::BindGroup)>,
    depth: wgpu::TextureView,
    /// The multisampled picture, and its bind group.
    samples: Option<(wgpu::TextureView, Option<wgpu::BindGroup>)>,
}

impl Renderer {
    /// Creates a renderer with an exhibit to show.
    ///
    /// # Errors
    /// Where the exhibit has too many bodies.
    pub fn new(gpu: &Gpu, exhibit: &Exhibit, options: Options) -> Result<Self, RenderError> {
        let mut shared = SharedResources::new(gpu, &options);
        let baked = Baked::new(exhibit, &options.lighting)?;
        let current = GpuExhibit::new(gpu, &mut shared, &options, exhibit, baked);
        Ok(Self {
            options,
            shared,
            current,
            targets: None,
            dust: Vec::with_capacity(MAX_DUST),
            scale: 1.0,
            other_sampling: None,
        })
    }

    /// Prepares another exhibit, baked under this renderer's lighting, while the present one stays visible: meshes and
    /// textures. Pipelines are created only for material properties that no earlier exhibit had.
    pub fn prepare(&mut self, gpu: &Gpu, exhibit: &Exhibit, baked: Baked) -> GpuExhibit {
        GpuExhibit::new(gpu, &mut self.shared, &self.options, exhibit, baked)
    }

    /// Shows an exhibit from [`Self::prepare`], from the next frame on.
    pub fn show(&mut self, current: GpuExhibit) {
        self.current = current;
    }

    /// Number of pipelines created so far.
    pub fn pipelines(&self) -> usize {
        self.shared.pipelines.count()
    }

    /// Draws a frame into `target`, a view with the format of the options and the size of the frame, and submits it.
    pub fn draw(&mut self, gpu: &Gpu, target: &wgpu::TextureView, frame: &FrameInput) {
        self.place(frame);
        self.upload(gpu);
        self.resize_targets(gpu, frame.size);
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("frame") });
        if !self.current.shadows_are_current() {
            self.shadow_passes(&mut encoder);
        }
        self.picture_pass(&mut encoder, target);
        gpu.queue.submit([encoder.finish()]);
    }

    /// The CPU part of [`Self::draw`]: updates all data for the frame, in memory that is already allocated.
    pub fn place(&mut self, frame: &FrameInput) {
        self.current.place(&FrameInput { size: self.scaled(frame.size), ..*frame });
        self.dust.clear();
        let shown = frame.dust.iter().filter(|particle| particle.brightness > 0.0).take(MAX_DUST);
        self.dust.extend(shown.map(|particle| Vec3::from_array(particle.position).extend(particle.brightness)));
    }

    /// Sets resolution and sample count from the next frame on. The pipelines of both sample counts are kept.
    pub fn set_sampling(&mut self, gpu: &Gpu, sampling: Sampling) {
        self.targets = None;
        self.scale = sampling.scale.clamp(0.1, 1.0);
        if sampling.msaa == self.options.msaa {
            return;
        }
        let before = std::mem::replace(&mut self.options.msaa, sampling.msaa);
        let mut pipelines = match self.other_sampling.take() {
            Some((samples, pipelines)) if samples == sampling.msaa => pipelines,
            _ => Pipelines::new(gpu, &self.shared.layouts, &self.options),
        };
        pipelines.ensure(gpu, &self.options, self.shared.pipelines.states().into_iter());
        self.other_sampling = Some((before, std::mem::replace(&mut self.shared.pipelines, pipelines)));
    }

    fn scaled(&self, size: (u32, u32)) -> (u32, u32) {
        let side = |pixels: u32| ((pixels as f32 * self.scale).round() as u32).max(1);
        (side(size.0), side(size.1))
    }

    /// Sets the shaders from the next frame on.
    pub fn set_shaders(&mut self, gpu: &Gpu, shaders: Arc<Shaders>) {
        self.options.shaders = shaders;
        let states = self.shared.pipelines.states();
        let mut pipelines = Pipelines::new(gpu, &self.shared.layouts, &self.options);
        pipelines.ensure(gpu, &self.options, states.into_iter());
        (self.shared.pipelines, self.other_sampling) = (pipelines, None);
        self.current.invalidate_shadows();
    }

    /// The passes of a frame of this size in which something moves.
    pub fn passes(&self, size: (u32, u32)) -> Vec<Pass> {
        self.plan(size).passes()
    }

    fn plan(&self, size: (u32, u32)) -> PassPlan {
        let draws = |batch: &Batch| self.shared.pipelines.forward(&batch.pipeline).len() as u32;
        PassPlan {
            size: self.scaled(size),
            target: size,
            samples: self.options.msaa,
            format: self.options.format,
            planes: self.options.lighting.background.is_none().then_some(self.current.planes.texels),
            plane_draws: [self.current.plane_draws(); 2],
            map: ShadowMapCamera::size(self.options.shadow_quality),
            mesh_draws: self.current.batches.iter().map(draws).sum::<u32>() + self.current.outlines.max_draws(),
        }
    }

    /// Uploads poses, wires, dust and camera.
    fn upload(&self, gpu: &Gpu) {
        let write = |buffer, bytes: &[u8]| gpu.queue.write_buffer(buffer, 0, bytes);
        write(&self.shared.globals_buffer, bytemuck::bytes_of(&self.current.globals));
        write(&self.shared.frames_buffer, bytemuck::cast_slice(&self.current.frames));
        write(&self.current.buffers.segments, bytemuck::cast_slice(&self.current.segments));
        write(&self.current.buffers.ribbons, bytemuck::cast_slice(&self.current.outlines.ribbons));
        write(&self.current.buffers.shadow_instances, bytemuck::cast_slice(&self.current.plate_shadows.instances));
        let write_rows = |texture: &wgpu::Texture, rows: &[Vec4]| {
            let width = texture.width();
            let size = wgpu::Extent3d { width, height: rows.len() as u32 / width, depth_or_array_layers: 1 };
            let layout =
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(16 * width), rows_per_image: None };
            gpu.queue.write_texture(texture.as_image_copy(), bytemuck::cast_slice(rows), layout, size);
        };
        write_rows(&self.current.bindings.contours, &self.current.outlines.contours);
        write_rows(&self.current.bindings.rims, &self.current.plate_shadows.points);
        if self.current.has_changed() {
            for skin in &self.current.skins {
                let place = u64::from(skin.first) * size_of::<Vertex>() as u64;
                gpu.queue.write_buffer(&self.current.buffers.vertices, place, bytemuck::cast_slice(&skin.vertices));
            }
        }
        write(&self.shared.dust_buffer, bytemuck::cast_slice(&self.dust));
    }

    /// Replaces the targets where the size has changed.
    fn resize_targets(&mut self, gpu: &Gpu, size: (u32, u32)) {
        let plan = self.plan((size.0.max(1), size.1.max(1)));
        if self.targets.as_ref().is_some_and(|targets| targets.size == plan.size) {
            return;
        }
        let group = |layout, resources: &[wgpu::BindingResource]| {
            let entries: Vec<_> = (0..)
                .zip(resources)
                .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource: resource.clone() })
                .collect();
            gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
        };
        use wgpu::BindingResource::{Sampler, TextureView};
        let layouts = &self.shared.layouts;
        let [samples, depth] = plan.picture();
        let depth = attachment(&gpu.device, depth, wgpu::TextureUsages::RENDER_ATTACHMENT);
        let samples = (plan.samples > 1).then(|| {
            // GL cannot draw into a multisampled texture that a shader may read.
            let by_shader = self.options.shader_resolve;
            let read = if by_shader { wgpu::TextureUsages::TEXTURE_BINDING } else { wgpu::TextureUsages::empty() };
            let view = attachment(&gpu.device, samples, read);
            let group = by_shader.then(|| group(&layouts.resolve, &[TextureView(&view)]));
            (view, group)
        });
        let scaled = (plan.size != plan.target).then(|| {
            let view = attachment(&gpu.device, plan.scaled_target(), wgpu::TextureUsages::TEXTURE_BINDING);
            let group = group(&layouts.upscale, &[TextureView(&view), Sampler(&self.shared.smooth)]);
            (view, group)
        });
        self.targets = Some(Targets { size: plan.size, scaled, depth, samples });
    }

    /// Draws the shadows on wall and floor, and the shadow map.
    fn shadow_passes(&self, encoder: &mut wgpu::CommandEncoder) {
        for plane in 0..2 {
            // Without a gallery there is no wall and no floor.
            if self.options.lighting.background.is_some() {
                break;
            }
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("plane shadow"),
                color_attachments: &[Some(color(&self.current.planes.views[plane], None, wgpu::Color::TRANSPARENT))],
                depth_stencil_attachment: Some(depth(&self.current.planes.orders[plane], 1.0, wgpu::StoreOp::Discard)),
                ..Default::default()
            });
            pass.set_bind_group(0, &self.shared.frame_group, &[]);
            if !self.current.casters.is_empty() {
                pass.set_pipeline(&self.shared.pipelines.plane_meshes[plane]);
                pass.set_vertex_buffer(0, self.current.buffers.vertices.slice(..));
                pass.set_index_buffer(self.current.buffers.indices.slice(..), wgpu::IndexFormat::Uint32);
                pass.draw_indexed(self.current.casters.clone(), 0, 0..2 * self.current.lamp_samples);
            }
            pass.set_pipeline(&self.shared.pipelines.plane_wires[plane]);
            pass.set_vertex_buffer(0, self.current.buffers.segments.slice(..));
            pass.draw(0..12, 0..self.current.segments.len() as u32);
            let shades = self.current.plate_shadows.instances_on(plane);
            if !shades.is_empty() {
                pass.set_pipeline(&self.shared.pipelines.plane_plates[plane]);
                pass.set_bind_group(1, &self.current.bindings.rims_bind_group, &[]);
                pass.set_vertex_buffer(0, self.current.buffers.shadow_instances.slice(..));
                pass.draw(0..6, shades);
            }
        }
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow map"),
            color_attachments: &[Some(color(&self.shared.map_views[1], None, wgpu::Color::TRANSPARENT))],
            depth_stencil_attachment: Some(depth(&self.shared.map_views[0], 0.0, wgpu::StoreOp::Store)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.shared.frame_group, &[]);
        pass.set_pipeline(&self.shared.pipelines.shadow_map);
        pass.set_vertex_buffer(0, self.current.buffers.vertices.slice(..));
        pass.set_index_buffer(self.current.buffers.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.current.opaque_end, 0, 0..1);
    }

    /// Draws the picture, and resolves its samples into `target`.
    fn picture_pass(&self, encoder: &mut wgpu::CommandEncoder, target: &wgpu::TextureView) {
        let Some(targets) = &self.targets else { return };
        let (target, upscaled) = match &targets.scaled {
            Some((scaled, group)) => (scaled, Some((group, target))),
            None => (target, None),
        };
        let by_shader = self.options.shader_resolve;
        let attachment = match &targets.samples {
            Some((view, _)) => color(view, (!by_shader).then_some(target), wgpu::Color::BLACK),
            None => color(target, None, wgpu::Color::BLACK),
        };
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("picture"),
            color_attachments: &[Some(attachment)],
            depth_stencil_attachment: Some(depth(&targets.depth, 0.0, wgpu::StoreOp::Discard)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.shared.frame_group, &[]);
        pass.set_bind_group(1, &self.current.bindings.light_group, &[]);
        pass.set_vertex_buffer(0, self.current.buffers.vertices.slice(..));
        pass.set_index_buffer(self.current.buffers.indices.slice(..), wgpu::IndexFormat::Uint32);
        self.draw_batches(&mut pass, SurfaceKind::Opaque);
        if self.options.lighting.background.is_some() {
            pass.set_pipeline(&self.shared.pipelines.backdrop);
            pass.draw(0..3, 0..1);
        } else {
            pass.set_pipeline(&self.shared.pipelines.gallery);
            pass.draw(0..36, 0..1);
        }
        pass.set_vertex_buffer(0, self.current.buffers.ribbons.slice(..));
        for (batch, ribbons) in &self.current.outlines.draws {
            let batch = &self.current.batches[*batch];
            let Some(pipeline) = self.shared.pipelines.ribbons(&batch.pipeline) else { continue };
            pass.set_pipeline(pipeline);
            pass.set_bind_group(2, &self.current.bindings.materials[batch.material], &[]);
            pass.draw(0..6, ribbons.clone());
        }
        pass.set_vertex_buffer(0, self.current.buffers.vertices.slice(..));
        self.draw_batches(&mut pass, SurfaceKind::Glass);
        pass.set_pipeline(&self.shared.pipelines.wires);
        pass.set_vertex_buffer(0, self.current.buffers.segments.slice(..));
        pass.draw(0..6, 0..self.current.segments.len() as u32);
        pass.set_vertex_buffer(0, self.current.buffers.vertices.slice(..));
        for &(_, index) in &self.current.blended {
            self.draw_batch(&mut pass, &self.current.batches[index]);
        }
        pass.set_pipeline(&self.shared.pipelines.dust);
        pass.set_vertex_buffer(0, self.shared.dust_buffer.slice(..));
        pass.draw(0..6, 0..self.dust.len() as u32);
        drop(pass);
        if let Some((_, Some(group))) = &targets.samples {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("resolve"),
                color_attachments: &[Some(color(target, None, wgpu::Color::BLACK))],
                ..Default::default()
            });
            pass.set_pipeline(&self.shared.pipelines.resolve);
            pass.set_bind_group(0, group, &[]);
            pass.draw(0..3, 0..1);
        }
        if let Some((group, target)) = upscaled {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("upscale"),
                color_attachments: &[Some(color(target, None, wgpu::Color::BLACK))],
                ..Default::default()
            });
            pass.set_pipeline(&self.shared.pipelines.upscale);
            pass.set_bind_group(0, group, &[]);
            pass.draw(0..3, 0..1);
        }
    }

    fn draw_batches(&self, pass: &mut wgpu::RenderPass, surface: SurfaceKind) {
        for batch in self.current.batches.iter().filter(|batch| batch.pipeline.kind == surface) {
            self.draw_batch(pass, batch);
        }
    }

    fn draw_batch(&self, pass: &mut wgpu::RenderPass, batch: &Batch) {
        for pipeline in self.shared.pipelines.forward(&batch.pipeline) {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(2, &self.current.bindings.materials[batch.material], &[]);
            pass.draw_indexed(batch.indices.clone(), 0, 0..1);
        }
    }
}

/// A colour attachment that is cleared first.
fn color<'a>(
    view: &'a wgpu::TextureView,
    resolve_target: Option<&'a wgpu::TextureView>,
    clear: wgpu::Color,
) -> wgpu::RenderPassColorAttachment<'a> {
    // Resolved by the fixed function, the samples themselves are not needed again.
    let store = if resolve_target.is_some() { wgpu::StoreOp::Discard } else { wgpu::StoreOp::Store };
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store };
    wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target, ops }
}

/// A depth attachment that is cleared first.
fn depth(view: &wgpu::TextureView, clear: f32, store: wgpu::StoreOp) -> wgpu::RenderPassDepthStencilAttachment<'_> {
    let depth_ops = Some(wgpu::Operations { load: wgpu::LoadOp::Clear(clear), store });
    wgpu::RenderPassDepthStencilAttachment { view, depth_ops, stencil_ops: None }
}

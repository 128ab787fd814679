//! The renderer: the order of the passes, over what the device keeps and the work on show.

use std::sync::Arc;

use glam::{Vec3, Vec4};

use super::fixtures::{Fixtures, MAX_MOTES};
use super::passes::{Pass, Plan};
use super::pipelines::Pipelines;
use super::resources::attachment;
use super::scene::{Part, Surface};
use super::shadows::MapCamera;
use super::vertex::Vertex;
use super::work::Work;
use super::{Finish, Frame, Gpu, Options, RenderError, Shaders};
use soffio_exhibit::Exhibit;

/// Draws one exhibit at a time into targets of one format. Built once a device.
pub struct Renderer {
    options: Options,
    fixtures: Fixtures,
    work: Work,
    targets: Option<Targets>,
    motes: Vec<Vec4>,
    /// Pixels along a side for each of the target's.
    scale: f32,
    /// Pipelines for so many samples as are not drawn now.
    spare: Option<(u32, Pipelines)>,
}

/// What depends on the size of the picture.
struct Targets {
    /// Of the picture.
    size: (u32, u32),
    /// The picture before it is stretched, and what the shader reads it by.
    smaller: Option<(wgpu::TextureView, wgpu::BindGroup)>,
    depth: wgpu::TextureView,
    /// The samples, and what a shader reads them by.
    samples: Option<(wgpu::TextureView, Option<wgpu::BindGroup>)>,
}

impl Renderer {
    /// Prepares a device, and an exhibit to show first.
    pub fn new(gpu: &Gpu, exhibit: &Exhibit, options: Options) -> Result<Self, RenderError> {
        let mut fixtures = Fixtures::new(gpu, &options);
        let work = Work::new(gpu, &mut fixtures, &options, exhibit)?;
        Ok(Self {
            options,
            fixtures,
            work,
            targets: None,
            motes: Vec::with_capacity(MAX_MOTES),
            scale: 1.0,
            spare: None,
        })
    }

    /// Makes another exhibit ready, while the present one stays on show: its meshes, textures and light. A pipeline is made
    /// only for a kind of surface that no exhibit before had.
    pub fn prepare(&mut self, gpu: &Gpu, exhibit: &Exhibit) -> Result<Work, RenderError> {
        Work::new(gpu, &mut self.fixtures, &self.options, exhibit)
    }

    /// Shows what [`Self::prepare`] made, from the next frame on.
    pub fn show(&mut self, work: Work) {
        self.work = work;
    }

    /// Pipelines made so far.
    pub fn pipelines(&self) -> usize {
        self.fixtures.pipelines.count()
    }

    /// Draws a frame into `target`, a view of the format of the options and of the frame's size, and submits it.
    pub fn draw(&mut self, gpu: &Gpu, target: &wgpu::TextureView, frame: &Frame) {
        self.place(frame);
        self.upload(gpu);
        self.fit(gpu, frame.size);
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("frame") });
        if !self.work.rests() {
            self.shadow_passes(&mut encoder);
        }
        self.picture_pass(&mut encoder, target);
        gpu.queue.submit([encoder.finish()]);
    }

    /// What [`Self::draw`] does before it turns to the device: everything is put where the frame has it, in memory that
    /// is there already.
    pub fn place(&mut self, frame: &Frame) {
        self.work.place(&Frame { size: self.scaled(frame.size), ..*frame });
        self.motes.clear();
        let shown = frame.motes.iter().filter(|mote| mote.brightness > 0.0).take(MAX_MOTES);
        self.motes.extend(shown.map(|mote| Vec3::from_array(mote.position).extend(mote.brightness)));
    }

    /// Draws so many pixels and samples from the next frame on. The pipelines of both numbers of samples are kept.
    pub fn set_finish(&mut self, gpu: &Gpu, finish: Finish) {
        self.targets = None;
        self.scale = finish.scale.clamp(0.1, 1.0);
        if finish.msaa == self.options.msaa {
            return;
        }
        let before = std::mem::replace(&mut self.options.msaa, finish.msaa);
        let mut pipelines = match self.spare.take() {
            Some((samples, pipelines)) if samples == finish.msaa => pipelines,
            _ => Pipelines::new(gpu, &self.fixtures.layouts, &self.options),
        };
        pipelines.cover(gpu, &self.options, self.fixtures.pipelines.states().into_iter());
        self.spare = Some((before, std::mem::replace(&mut self.fixtures.pipelines, pipelines)));
    }

    fn scaled(&self, size: (u32, u32)) -> (u32, u32) {
        let side = |pixels: u32| ((pixels as f32 * self.scale).round() as u32).max(1);
        (side(size.0), side(size.1))
    }

    /// Draws with other shaders from the next frame on.
    pub fn set_shaders(&mut self, gpu: &Gpu, shaders: Arc<Shaders>) {
        self.options.shaders = shaders;
        let states = self.fixtures.pipelines.states();
        let mut pipelines = Pipelines::new(gpu, &self.fixtures.layouts, &self.options);
        pipelines.cover(gpu, &self.options, states.into_iter());
        (self.fixtures.pipelines, self.spare) = (pipelines, None);
        self.work.forget();
    }

    /// The passes of a frame of this size in which something moves.
    pub fn passes(&self, size: (u32, u32)) -> Vec<Pass> {
        self.plan(size).passes()
    }

    fn plan(&self, size: (u32, u32)) -> Plan {
        let draws = |part: &Part| self.fixtures.pipelines.forward(&part.state).len() as u32;
        Plan {
            size: self.scaled(size),
            target: size,
            samples: self.options.msaa,
            format: self.options.format,
            planes: self.options.look.background.is_none().then_some(self.work.planes.texels),
            plane_draws: [self.work.plane_draws(); 2],
            map: MapCamera::size(self.options.quality),
            mesh_draws: self.work.parts.iter().map(draws).sum::<u32>() + self.work.outlines.most_draws(),
        }
    }

    /// Brings poses, wires, motes and camera to the device.
    fn upload(&self, gpu: &Gpu) {
        let write = |buffer, bytes: &[u8]| gpu.queue.write_buffer(buffer, 0, bytes);
        write(&self.fixtures.globals_buffer, bytemuck::bytes_of(&self.work.globals));
        write(&self.fixtures.frames_buffer, bytemuck::cast_slice(&self.work.frames));
        write(&self.work.buffers.segments, bytemuck::cast_slice(&self.work.segments));
        write(&self.work.buffers.ribbons, bytemuck::cast_slice(&self.work.outlines.ribbons));
        write(&self.work.buffers.shades, bytemuck::cast_slice(&self.work.sheets.shades));
        let write_rows = |texture: &wgpu::Texture, rows: &[Vec4]| {
            let width = texture.width();
            let size = wgpu::Extent3d { width, height: rows.len() as u32 / width, depth_or_array_layers: 1 };
            let layout =
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(16 * width), rows_per_image: None };
            gpu.queue.write_texture(texture.as_image_copy(), bytemuck::cast_slice(rows), layout, size);
        };
        write_rows(&self.work.bindings.contours, &self.work.outlines.contours);
        write_rows(&self.work.bindings.rims, &self.work.sheets.points);
        if self.work.moves() {
            for skin in &self.work.skins {
                let place = u64::from(skin.first) * size_of::<Vertex>() as u64;
                gpu.queue.write_buffer(&self.work.buffers.vertices, place, bytemuck::cast_slice(&skin.vertices));
            }
        }
        write(&self.fixtures.motes_buffer, bytemuck::cast_slice(&self.motes));
    }

    /// Makes the targets anew where the size has changed.
    fn fit(&mut self, gpu: &Gpu, size: (u32, u32)) {
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
        let layouts = &self.fixtures.layouts;
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
        let smaller = (plan.size != plan.target).then(|| {
            let view = attachment(&gpu.device, plan.smaller(), wgpu::TextureUsages::TEXTURE_BINDING);
            let group = group(&layouts.stretch, &[TextureView(&view), Sampler(&self.fixtures.smooth)]);
            (view, group)
        });
        self.targets = Some(Targets { size: plan.size, smaller, depth, samples });
    }

    /// Shadows on wall and floor, and the shadow map.
    fn shadow_passes(&self, encoder: &mut wgpu::CommandEncoder) {
        for plane in 0..2 {
            // Without a room nothing receives these.
            if self.options.look.background.is_some() {
                break;
            }
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("plane shadow"),
                color_attachments: &[Some(color(&self.work.planes.views[plane], None, wgpu::Color::TRANSPARENT))],
                depth_stencil_attachment: Some(depth(&self.work.planes.orders[plane], 1.0, wgpu::StoreOp::Discard)),
                ..Default::default()
            });
            pass.set_bind_group(0, &self.fixtures.frame_group, &[]);
            if !self.work.casters.is_empty() {
                pass.set_pipeline(&self.fixtures.pipelines.plane_meshes[plane]);
                pass.set_vertex_buffer(0, self.work.buffers.vertices.slice(..));
                pass.set_index_buffer(self.work.buffers.indices.slice(..), wgpu::IndexFormat::Uint32);
                pass.draw_indexed(self.work.casters.clone(), 0, 0..2 * self.work.lamp_samples);
            }
            pass.set_pipeline(&self.fixtures.pipelines.plane_wires[plane]);
            pass.set_vertex_buffer(0, self.work.buffers.segments.slice(..));
            pass.draw(0..12, 0..self.work.segments.len() as u32);
            let shades = self.work.sheets.on(plane);
            if !shades.is_empty() {
                pass.set_pipeline(&self.fixtures.pipelines.plane_sheets[plane]);
                pass.set_bind_group(1, &self.work.bindings.rims_group, &[]);
                pass.set_vertex_buffer(0, self.work.buffers.shades.slice(..));
                pass.draw(0..6, shades);
            }
        }
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow map"),
            color_attachments: &[Some(color(&self.fixtures.map_views[1], None, wgpu::Color::TRANSPARENT))],
            depth_stencil_attachment: Some(depth(&self.fixtures.map_views[0], 0.0, wgpu::StoreOp::Store)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.fixtures.frame_group, &[]);
        pass.set_pipeline(&self.fixtures.pipelines.shadow_map);
        pass.set_vertex_buffer(0, self.work.buffers.vertices.slice(..));
        pass.set_index_buffer(self.work.buffers.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.work.opaque, 0, 0..1);
    }

    /// The picture, and its samples averaged into `target`.
    fn picture_pass(&self, encoder: &mut wgpu::CommandEncoder, target: &wgpu::TextureView) {
        let Some(targets) = &self.targets else { return };
        let (target, stretched) = match &targets.smaller {
            Some((smaller, group)) => (smaller, Some((group, target))),
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
        pass.set_bind_group(0, &self.fixtures.frame_group, &[]);
        pass.set_bind_group(1, &self.work.bindings.light_group, &[]);
        pass.set_vertex_buffer(0, self.work.buffers.vertices.slice(..));
        pass.set_index_buffer(self.work.buffers.indices.slice(..), wgpu::IndexFormat::Uint32);
        self.draw_parts(&mut pass, Surface::Opaque);
        if self.options.look.background.is_some() {
            pass.set_pipeline(&self.fixtures.pipelines.backdrop);
            pass.draw(0..3, 0..1);
        } else {
            pass.set_pipeline(&self.fixtures.pipelines.room);
            pass.draw(0..36, 0..1);
        }
        pass.set_vertex_buffer(0, self.work.buffers.ribbons.slice(..));
        for (part, ribbons) in &self.work.outlines.draws {
            let part = &self.work.parts[*part];
            let Some(pipeline) = self.fixtures.pipelines.ribbons(&part.state) else { continue };
            pass.set_pipeline(pipeline);
            pass.set_bind_group(2, &self.work.bindings.materials[part.material], &[]);
            pass.draw(0..6, ribbons.clone());
        }
        pass.set_vertex_buffer(0, self.work.buffers.vertices.slice(..));
        self.draw_parts(&mut pass, Surface::Glass);
        pass.set_pipeline(&self.fixtures.pipelines.wires);
        pass.set_vertex_buffer(0, self.work.buffers.segments.slice(..));
        pass.draw(0..6, 0..self.work.segments.len() as u32);
        pass.set_vertex_buffer(0, self.work.buffers.vertices.slice(..));
        for &(_, index) in &self.work.blended {
            self.draw_part(&mut pass, &self.work.parts[index]);
        }
        pass.set_pipeline(&self.fixtures.pipelines.motes);
        pass.set_vertex_buffer(0, self.fixtures.motes_buffer.slice(..));
        pass.draw(0..6, 0..self.motes.len() as u32);
        drop(pass);
        if let Some((_, Some(group))) = &targets.samples {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("resolve"),
                color_attachments: &[Some(color(target, None, wgpu::Color::BLACK))],
                ..Default::default()
            });
            pass.set_pipeline(&self.fixtures.pipelines.resolve);
            pass.set_bind_group(0, group, &[]);
            pass.draw(0..3, 0..1);
        }
        if let Some((group, target)) = stretched {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("stretch"),
                color_attachments: &[Some(color(target, None, wgpu::Color::BLACK))],
                ..Default::default()
            });
            pass.set_pipeline(&self.fixtures.pipelines.stretch);
            pass.set_bind_group(0, group, &[]);
            pass.draw(0..3, 0..1);
        }
    }

    fn draw_parts(&self, pass: &mut wgpu::RenderPass, surface: Surface) {
        for part in self.work.parts.iter().filter(|part| part.state.surface == surface) {
            self.draw_part(pass, part);
        }
    }

    fn draw_part(&self, pass: &mut wgpu::RenderPass, part: &Part) {
        for pipeline in self.fixtures.pipelines.forward(&part.state) {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(2, &self.work.bindings.materials[part.material], &[]);
            pass.draw_indexed(part.indices.clone(), 0, 0..1);
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

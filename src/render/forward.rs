//! The renderer: resources of an exhibit and the order of the passes.

use std::sync::Arc;

use glam::{Mat4, Vec3, Vec4};
use wgpu::util::DeviceExt;

use super::bounce::{self, Light};
use super::casters::casters;
use super::environment::Environment;
use super::gallery::Room;
use super::globals::Globals;
use super::passes::{Pass, Plan};
use super::pipelines::{Layouts, Pipelines};
use super::resources::{attachment, light_group};
use super::scene::{MAX_FRAMES, Part, Scene, Surface, rows};
use super::shadows::{MapCamera, ReceivingPlane};
use super::wires::{self, Segment};
use super::{Frame, Gpu, Options, Quality, RenderError, Shaders, occlusion, textures};
use crate::exhibit::Exhibit;
use crate::math::Pose;

/// Most motes drawn.
const MAX_MOTES: usize = 4096;
/// Points of each lamp's disc that shadows of meshes are cast from.
const LAMP_SAMPLES: [u32; 2] = [28, 56];

/// Draws one exhibit. Built once; draws any number of frames.
pub struct Renderer {
    exhibit: Arc<Exhibit>,
    options: Options,
    radius: f32,
    scene: Scene,
    pipelines: Pipelines,
    layouts: Layouts,
    globals: Globals,
    globals_buffer: wgpu::Buffer,
    frames_buffer: wgpu::Buffer,
    vertices: wgpu::Buffer,
    indices: wgpu::Buffer,
    segments_buffer: wgpu::Buffer,
    motes_buffer: wgpu::Buffer,
    frame_group: wgpu::BindGroup,
    light_group: wgpu::BindGroup,
    materials: Vec<wgpu::BindGroup>,
    plane_views: [wgpu::TextureView; 2],
    order_views: [wgpu::TextureView; 2],
    map_views: [wgpu::TextureView; 2],
    plan: Plan,
    lamp_samples: u32,
    targets: Option<Targets>,
    // Scratch, kept so that a frame allocates nothing.
    frames: Vec<[Vec4; 3]>,
    drawn_frames: Vec<[Vec4; 3]>,
    segments: Vec<Segment>,
    motes: Vec<Vec4>,
    blended: Vec<(f32, usize)>,
}

/// What depends on the size of the picture.
struct Targets {
    size: (u32, u32),
    depth: wgpu::TextureView,
    /// The samples, and what a shader reads them by.
    samples: Option<(wgpu::TextureView, Option<wgpu::BindGroup>)>,
}

impl Renderer {
    /// Prepares an exhibit: its meshes, materials, light and pipelines.
    pub fn new(gpu: &Gpu, exhibit: &Exhibit, options: Options) -> Result<Self, RenderError> {
        let device = &gpu.device;
        let mut scene = Scene::new(exhibit)?;
        let room = Room::around(exhibit);
        let look = &options.look;
        let environment = match &look.environment {
            Some(environment) => environment.clone(),
            None => Arc::new(Environment::new(|direction| room.radiance(direction))),
        };
        // What moves takes its corners along, and the light on them would be wrong.
        let still = exhibit.bodies.is_empty() && look.background.is_some();
        if still {
            let light = Light { environment: &environment, env_intensity: look.env_intensity, area: look.area_light };
            bounce::corners(&mut scene, exhibit, room.radius, &light);
        } else {
            occlusion::corners(&mut scene, exhibit, room.radius);
        }
        let lamp_samples = LAMP_SAMPLES[(options.quality == Quality::Full) as usize];
        let planes = ReceivingPlane::of_room(&room, exhibit, options.quality);
        let map = MapCamera::new(&room, look, options.quality, |eye| {
            if !still || look.area_light.is_none() {
                return Vec::new();
            }
            casters(&scene, &occlusion::at_rest(&scene, exhibit).0, room.radius, eye)
        });
        let globals =
            Globals::new(look, &room, &environment.irradiance, &map, &planes, (options.quality, lamp_samples));
        let layouts = Layouts::new(device);
        let pipelines = Pipelines::new(gpu, &layouts, &options, &scene);

        let buffer = |label, size: usize, usage| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: size as u64,
                usage: usage | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let filled = |label, contents: &[u8], usage| {
            // An exhibit of wires alone has no vertices; an empty buffer could not be bound.
            let contents = if contents.is_empty() { &[0; 16] } else { contents };
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage })
        };
        let globals_buffer = buffer("globals", size_of::<Globals>(), wgpu::BufferUsages::UNIFORM);
        let frames_buffer = buffer("frames", MAX_FRAMES * 48, wgpu::BufferUsages::UNIFORM);
        let segment_count = wires::count(exhibit);
        let mesh_draws: usize = scene.parts.iter().map(|part| pipelines.forward[&part.state].len()).sum();
        let plan = Plan {
            size: (1, 1),
            samples: options.msaa,
            format: options.format,
            planes: look.background.is_none().then(|| planes.map(|plane| plane.texels)),
            map: map.size,
            mesh_draws: mesh_draws as u32,
        };
        let sampled = |of| attachment(device, of, wgpu::TextureUsages::TEXTURE_BINDING);
        let [plane_views, order_views] = [0, 1].map(|which| planes.map(|p| sampled(plan.plane(p.texels)[which])));
        let map_views = plan.shadow_map().map(sampled);
        let ambient = occlusion::planes(&scene, exhibit, &planes, room.radius);
        let frame_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout: &layouts.frame,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: globals_buffer.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: frames_buffer.as_entire_binding() },
            ],
        });
        let light_group = light_group(gpu, &layouts.light, &environment, &room, &plane_views, &map_views, &ambient);
        Ok(Self {
            exhibit: Arc::new(exhibit.clone()),
            radius: room.radius,
            vertices: filled("vertices", bytemuck::cast_slice(&scene.vertices), wgpu::BufferUsages::VERTEX),
            indices: filled("indices", bytemuck::cast_slice(&scene.indices), wgpu::BufferUsages::INDEX),
            segments_buffer: buffer(
                "segments",
                segment_count.max(1) * size_of::<Segment>(),
                wgpu::BufferUsages::VERTEX,
            ),
            motes_buffer: buffer("motes", MAX_MOTES * 16, wgpu::BufferUsages::VERTEX),
            materials: textures::materials(gpu, &exhibit.model, &layouts.material),
            layouts,
            scene,
            pipelines,
            globals,
            globals_buffer,
            frames_buffer,
            frame_group,
            light_group,
            plane_views,
            order_views,
            map_views,
            plan,
            lamp_samples,
            targets: None,
            frames: Vec::with_capacity(exhibit.bodies.len() + 1),
            drawn_frames: Vec::new(),
            segments: Vec::with_capacity(segment_count),
            motes: Vec::with_capacity(MAX_MOTES),
            blended: Vec::new(),
            options,
        })
    }

    /// Draws a frame into `target`, a view of the format of the options and of the frame's size, and submits it.
    pub fn draw(&mut self, gpu: &Gpu, target: &wgpu::TextureView, frame: &Frame) {
        self.upload(gpu, frame);
        self.fit(gpu, frame.size);
        let mut encoder = gpu.device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("frame") });
        if self.frames != self.drawn_frames {
            self.shadow_passes(&mut encoder);
            self.drawn_frames.clone_from(&self.frames);
        }
        self.picture_pass(&mut encoder, target);
        gpu.queue.submit([encoder.finish()]);
    }

    /// Draws with other shaders from the next frame on.
    pub fn set_shaders(&mut self, gpu: &Gpu, shaders: Arc<Shaders>) {
        self.options.shaders = shaders;
        self.pipelines = Pipelines::new(gpu, &self.layouts, &self.options, &self.scene);
        self.drawn_frames.clear();
    }

    /// The passes of a frame of this size in which something moves.
    pub fn passes(&self, size: (u32, u32)) -> Vec<Pass> {
        Plan { size, ..self.plan }.passes()
    }

    /// Brings poses, wires, motes and camera to the device.
    fn upload(&mut self, gpu: &Gpu, frame: &Frame) {
        self.frames.clear();
        self.frames.push(rows(&Pose::IDENTITY));
        for (index, body) in self.exhibit.bodies.iter().enumerate() {
            self.frames.push(rows(frame.poses.get(index).unwrap_or(&body.pose)));
        }
        self.globals.set_frame(frame, self.radius);
        let frames = &self.frames;
        self.globals.set_lights(&self.scene.lights, |i| {
            Mat4::from_cols(frames[i][0], frames[i][1], frames[i][2], Vec4::W).transpose()
        });
        wires::fill(&self.exhibit, frame.poses, self.globals.eye, &mut self.segments);
        self.motes.clear();
        let shown = frame.motes.iter().filter(|mote| mote.brightness > 0.0).take(MAX_MOTES);
        self.motes.extend(shown.map(|mote| Vec3::from_array(mote.position).extend(mote.brightness)));
        let write = |buffer, bytes: &[u8]| gpu.queue.write_buffer(buffer, 0, bytes);
        write(&self.globals_buffer, bytemuck::bytes_of(&self.globals));
        write(&self.frames_buffer, bytemuck::cast_slice(&self.frames));
        write(&self.segments_buffer, bytemuck::cast_slice(&self.segments));
        write(&self.motes_buffer, bytemuck::cast_slice(&self.motes));
    }

    /// Makes the targets anew where the size has changed.
    fn fit(&mut self, gpu: &Gpu, size: (u32, u32)) {
        let size = (size.0.max(1), size.1.max(1));
        if self.targets.as_ref().is_some_and(|targets| targets.size == size) {
            return;
        }
        self.plan.size = size;
        let [samples, depth] = self.plan.picture();
        let depth = attachment(&gpu.device, depth, wgpu::TextureUsages::RENDER_ATTACHMENT);
        let samples = (self.options.msaa > 1).then(|| {
            // GL cannot draw into a multisampled texture that a shader may read.
            let by_shader = self.options.shader_resolve;
            let read = if by_shader { wgpu::TextureUsages::TEXTURE_BINDING } else { wgpu::TextureUsages::empty() };
            let view = attachment(&gpu.device, samples, read);
            let group = by_shader.then(|| {
                let resource = wgpu::BindingResource::TextureView(&view);
                gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                    label: Some("resolve"),
                    layout: &self.layouts.resolve,
                    entries: &[wgpu::BindGroupEntry { binding: 0, resource }],
                })
            });
            (view, group)
        });
        self.targets = Some(Targets { size, depth, samples });
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
                color_attachments: &[Some(color(&self.plane_views[plane], None, wgpu::Color::TRANSPARENT))],
                depth_stencil_attachment: Some(depth(&self.order_views[plane], 1.0, wgpu::StoreOp::Discard)),
                ..Default::default()
            });
            pass.set_bind_group(0, &self.frame_group, &[]);
            pass.set_pipeline(&self.pipelines.plane_meshes[plane]);
            pass.set_vertex_buffer(0, self.vertices.slice(..));
            pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
            pass.draw_indexed(0..self.scene.casters, 0, 0..2 * self.lamp_samples);
            pass.set_pipeline(&self.pipelines.plane_wires[plane]);
            pass.set_vertex_buffer(0, self.segments_buffer.slice(..));
            pass.draw(0..12, 0..self.segments.len() as u32);
        }
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow map"),
            color_attachments: &[Some(color(&self.map_views[1], None, wgpu::Color::TRANSPARENT))],
            depth_stencil_attachment: Some(depth(&self.map_views[0], 0.0, wgpu::StoreOp::Store)),
            ..Default::default()
        });
        pass.set_bind_group(0, &self.frame_group, &[]);
        pass.set_pipeline(&self.pipelines.shadow_map);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        pass.draw_indexed(0..self.scene.opaque, 0, 0..1);
    }

    /// The picture, and its samples averaged into `target`.
    fn picture_pass(&mut self, encoder: &mut wgpu::CommandEncoder, target: &wgpu::TextureView) {
        self.sort_blended();
        let Some(targets) = &self.targets else { return };
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
        pass.set_bind_group(0, &self.frame_group, &[]);
        pass.set_bind_group(1, &self.light_group, &[]);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        pass.set_index_buffer(self.indices.slice(..), wgpu::IndexFormat::Uint32);
        self.draw_parts(&mut pass, Surface::Opaque);
        if self.options.look.background.is_some() {
            pass.set_pipeline(&self.pipelines.backdrop);
            pass.draw(0..3, 0..1);
        } else {
            for (pipeline, corners) in self.pipelines.room.iter().zip([0..6, 6..12, 12..36]) {
                pass.set_pipeline(pipeline);
                pass.draw(corners, 0..1);
            }
        }
        self.draw_parts(&mut pass, Surface::Glass);
        pass.set_pipeline(&self.pipelines.wires);
        pass.set_vertex_buffer(0, self.segments_buffer.slice(..));
        pass.draw(0..6, 0..self.segments.len() as u32);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        for &(_, index) in &self.blended {
            self.draw_part(&mut pass, &self.scene.parts[index]);
        }
        pass.set_pipeline(&self.pipelines.motes);
        pass.set_vertex_buffer(0, self.motes_buffer.slice(..));
        pass.draw(0..6, 0..self.motes.len() as u32);
        drop(pass);
        if let Some((_, Some(group))) = &targets.samples {
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("resolve"),
                color_attachments: &[Some(color(target, None, wgpu::Color::BLACK))],
                ..Default::default()
            });
            pass.set_pipeline(&self.pipelines.resolve);
            pass.set_bind_group(0, group, &[]);
            pass.draw(0..3, 0..1);
        }
    }

    fn draw_parts(&self, pass: &mut wgpu::RenderPass, surface: Surface) {
        for part in self.scene.parts.iter().filter(|part| part.state.surface == surface) {
            self.draw_part(pass, part);
        }
    }

    fn draw_part(&self, pass: &mut wgpu::RenderPass, part: &Part) {
        for pipeline in &self.pipelines.forward[&part.state] {
            pass.set_pipeline(pipeline);
            pass.set_bind_group(2, &self.materials[part.material], &[]);
            pass.draw_indexed(part.indices.clone(), 0, 0..1);
        }
    }

    /// Blended parts, the farthest first.
    fn sort_blended(&mut self) {
        self.blended.clear();
        for (index, part) in
            self.scene.parts.iter().enumerate().filter(|(_, part)| part.state.surface == Surface::Blend)
        {
            let center = part.center.extend(1.0);
            let world = Vec3::from_array(self.frames[part.frame].map(|row| row.dot(center)));
            self.blended.push((world.distance_squared(self.globals.eye), index));
        }
        self.blended.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
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

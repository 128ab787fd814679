//! The renderer: resources of an exhibit and the order of the passes.

use std::sync::Arc;

use glam::{Mat4, Vec3, Vec4};
use wgpu::util::DeviceExt;

use super::environment::{CUBE_MIPS, CUBE_SIZE, Environment, TABLE_SIZE, split_sum_table};
use super::gallery::{LIGHTMAP_SIZE, Room};
use super::globals::Globals;
use super::pipelines::{DEPTH_FORMAT, Layouts, ORDER_FORMAT, Pipelines};
use super::scene::{MAX_FRAMES, Scene, rows};
use super::shadows::{MapCamera, PLANE_FORMAT, ReceivingPlane};
use super::wires::{self, Segment};
use super::{Frame, Gpu, Options, Quality, RenderError, textures};
use crate::exhibit::Exhibit;
use crate::math::Pose;

/// Most motes drawn.
const MAX_MOTES: usize = 4096;
/// Points of each lamp's disc that shadows of meshes are cast from.
const LAMP_SAMPLES: [u32; 2] = [20, 48];

/// Draws one exhibit. Built once; draws any number of frames.
pub struct Renderer {
    exhibit: Arc<Exhibit>,
    options: Options,
    radius: f32,
    scene: Scene,
    pipelines: Pipelines,
    resolve_layout: wgpu::BindGroupLayout,
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
    map_view: wgpu::TextureView,
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
    samples: Option<(wgpu::TextureView, wgpu::BindGroup)>,
}

impl Renderer {
    /// Prepares an exhibit: its meshes, materials, light and pipelines.
    pub fn new(gpu: &Gpu, exhibit: &Exhibit, options: Options) -> Result<Self, RenderError> {
        let device = &gpu.device;
        let scene = Scene::new(exhibit)?;
        let room = Room::around(exhibit);
        let look = &options.look;
        let environment = match &look.environment {
            Some(environment) => environment.clone(),
            None => Arc::new(Environment::new(|direction| room.radiance(direction))),
        };
        let lamp_samples = LAMP_SAMPLES[(options.quality == Quality::Full) as usize];
        let planes = ReceivingPlane::of_room(&room, exhibit, options.quality);
        let map = MapCamera::new(&room, look, options.quality);
        let globals = Globals::new(look, &room, &environment.irradiance, &map, &planes, lamp_samples);
        let layouts = Layouts::new(device);
        let pipelines = Pipelines::new(gpu, &layouts, &options);

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
        let attachment = |label, (width, height): (u32, u32), format| {
            let usage = wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::TEXTURE_BINDING;
            texture_2d(device, label, (width, height), 1, format, usage)
        };
        let plane_views = planes.map(|plane| attachment("plane shadow", plane.texels, PLANE_FORMAT));
        let order_views = planes.map(|plane| attachment("plane order", plane.texels, ORDER_FORMAT));
        let map_view = attachment("shadow map", (map.size, map.size), DEPTH_FORMAT);
        let frame_group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("frame"),
            layout: &layouts.frame,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: globals_buffer.as_entire_binding() },
                wgpu::BindGroupEntry { binding: 1, resource: frames_buffer.as_entire_binding() },
            ],
        });
        let light_group = light_group(gpu, &layouts.light, &environment, &room, &plane_views, &map_view);
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
            resolve_layout: layouts.resolve,
            scene,
            pipelines,
            globals,
            globals_buffer,
            frames_buffer,
            frame_group,
            light_group,
            plane_views,
            order_views,
            map_view,
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
        let msaa = self.options.msaa;
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let depth = texture_2d(&gpu.device, "depth", size, msaa, DEPTH_FORMAT, attachment);
        let samples = (msaa > 1).then(|| {
            let usage = attachment | wgpu::TextureUsages::TEXTURE_BINDING;
            let view = texture_2d(&gpu.device, "samples", size, msaa, self.options.format, usage);
            let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("resolve"),
                layout: &self.resolve_layout,
                entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) }],
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
            pass.draw_indexed(0..self.scene.opaque, 0, 0..2 * self.lamp_samples);
            pass.set_pipeline(&self.pipelines.plane_wires[plane]);
            pass.set_vertex_buffer(0, self.segments_buffer.slice(..));
            pass.draw(0..12, 0..self.segments.len() as u32);
        }
        let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("shadow map"),
            depth_stencil_attachment: Some(depth(&self.map_view, 0.0, wgpu::StoreOp::Store)),
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
        for part in self.scene.parts.iter().filter(|part| !part.blend) {
            pass.set_pipeline(&self.pipelines.forward[0][part.double_sided as usize]);
            pass.set_bind_group(2, &self.materials[part.material], &[]);
            pass.draw_indexed(part.indices.clone(), 0, 0..1);
        }
        if self.options.look.background.is_some() {
            pass.set_pipeline(&self.pipelines.backdrop);
            pass.draw(0..3, 0..1);
        } else {
            for (pipeline, corners) in self.pipelines.room.iter().zip([0..6, 6..12, 12..36]) {
                pass.set_pipeline(pipeline);
                pass.draw(corners, 0..1);
            }
        }
        pass.set_pipeline(&self.pipelines.wires);
        pass.set_vertex_buffer(0, self.segments_buffer.slice(..));
        pass.draw(0..6, 0..self.segments.len() as u32);
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        for &(_, index) in &self.blended {
            let part = &self.scene.parts[index];
            pass.set_pipeline(&self.pipelines.forward[1][part.double_sided as usize]);
            pass.set_bind_group(2, &self.materials[part.material], &[]);
            pass.draw_indexed(part.indices.clone(), 0, 0..1);
        }
        pass.set_pipeline(&self.pipelines.motes);
        pass.set_vertex_buffer(0, self.motes_buffer.slice(..));
        pass.draw(0..6, 0..self.motes.len() as u32);
        drop(pass);
        if let (Some((_, group)), true) = (&targets.samples, by_shader) {
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

    /// Blended parts, the farthest first.
    fn sort_blended(&mut self) {
        self.blended.clear();
        for (index, part) in self.scene.parts.iter().enumerate().filter(|(_, part)| part.blend) {
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

fn texture_2d(
    device: &wgpu::Device,
    label: &str,
    (width, height): (u32, u32),
    sample_count: u32,
    format: wgpu::TextureFormat,
    usage: wgpu::TextureUsages,
) -> wgpu::TextureView {
    let descriptor = wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage,
        view_formats: &[],
    };
    device.create_texture(&descriptor).create_view(&Default::default())
}

/// Textures and samplers of the light.
fn light_group(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    environment: &Environment,
    room: &Room,
    plane_views: &[wgpu::TextureView; 2],
    map_view: &wgpu::TextureView,
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
    let table: Vec<_> = split_sum_table().iter().map(|&[a, b]| half4([a, b, 0.0, 1.0])).collect();
    let lightmap: Vec<_> = room.lightmap().into_iter().map(half4).collect();
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
    let lightmap_view = view(upload("light map", LIGHTMAP_SIZE, 6, 1, &lightmap), wgpu::TextureViewDimension::D2Array);
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
        TextureView(map_view),
        Sampler(&shadow),
        TextureView(&plane_views[0]),
        TextureView(&plane_views[1]),
        TextureView(&lightmap_view),
    ];
    let entries: Vec<_> =
        (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some("light"), layout, entries: &entries })
}

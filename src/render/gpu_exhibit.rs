//! GPU resources of one exhibit: meshes, materials, wires, the gallery's light for it, and the memory in which its
//! frames are prepared.

use glam::{Mat4, Vec3, Vec4};
use wgpu::util::DeviceExt;

use super::baked::Baked;
use super::frames::rows;
use super::globals::Globals;
use super::light::{LightResources, light_group};
use super::outlines::{CONTOUR_ROW, Outlines, Ribbon};
use super::passes::PassPlan;
use super::plate_shadows::{PlateShadows, RIM_ROW, ShadowInstance};
use super::punctual::Punctual;
use super::resources::{attachment, numbers, single};
use super::scene::{Batch, Scene, SurfaceKind};
use super::shadows::{ReceivingPlane, ShadowMapCamera};
use super::shared::SharedResources;
use super::skins::Skinned;
use super::wires::{Lines, Segment};
use super::{FrameInput, Gpu, Options, ShadowQuality, materials};
use soffio_exhibit::Exhibit;
use soffio_math::Pose;

/// Points on each lamp's disc from which mesh shadows are cast, by shadow quality: as many steps of penumbra. Chosen by
/// eye against the time of a frame.
const LAMP_SAMPLES: [u32; 2] = [28, 56];

/// An exhibit prepared for drawing by the [`super::Renderer`] that created it.
pub struct GpuExhibit {
    pub(super) batches: Vec<Batch>,
    pub(super) globals: Globals,
    pub(super) buffers: Buffers,
    pub(super) bindings: Bindings,
    pub(super) planes: PlaneTargets,
    /// Number of opaque indices, from the first.
    pub(super) opaque_end: u32,
    /// Indices that cast shadows on the planes as triangles.
    pub(super) casters: std::ops::Range<u32>,
    pub(super) lamp_samples: u32,
    radius: f32,
    /// Poses of bodies that a frame leaves out.
    start_poses: Vec<Pose>,
    lines: Lines,
    lights: Vec<Punctual>,
    // Scratch memory, kept so that a frame allocates nothing.
    pub(super) frames: Vec<[Vec4; 3]>,
    pub(super) segments: Vec<Segment>,
    pub(super) outlines: Outlines,
    pub(super) plate_shadows: PlateShadows,
    pub(super) skins: Vec<Skinned>,
    /// Squared distance and index of each blended batch, the farthest first.
    pub(super) blended: Vec<(f32, usize)>,
    last_drawn: LastDrawn,
}

/// Vertex, index and instance buffers.
pub(super) struct Buffers {
    /// Vertices of all meshes.
    pub vertices: wgpu::Buffer,
    /// Triangles of all batches.
    pub indices: wgpu::Buffer,
    /// Segments of the wires, one instance each.
    pub segments: wgpu::Buffer,
    /// Edges of plate silhouettes, one instance each.
    pub ribbons: wgpu::Buffer,
    /// Analytic plate shadows, one instance each.
    pub shadow_instances: wgpu::Buffer,
}

/// Textures that each frame fills, and bind groups.
pub(super) struct Bindings {
    /// Silhouettes of plates, as [`Outlines`] lists them.
    pub contours: wgpu::Texture,
    /// Rims of the plates that cast analytic shadows.
    pub rims: wgpu::Texture,
    /// Bind group of `rims`.
    pub rims_bind_group: wgpu::BindGroup,
    /// Bind group of the light: environment, light map, shadows.
    pub light_group: wgpu::BindGroup,
    /// Bind group of each material, and last of the default one.
    pub materials: Vec<wgpu::BindGroup>,
}

/// Targets of the shadows on wall and floor.
pub(super) struct PlaneTargets {
    /// Shadows on wall and floor.
    pub views: [wgpu::TextureView; 2],
    /// Depth targets that separate the lamp samples, for wall and floor.
    pub orders: [wgpu::TextureView; 2],
    /// Size of each, texels.
    pub texels: [(u32, u32); 2],
}

/// State of the last frame whose shadows were drawn, to find out whether they are still valid.
struct LastDrawn {
    frames: Vec<[Vec4; 3]>,
    /// Time of that frame, s.
    time: f64,
    /// Do key frames change shapes? Then the time of the present frame, s, counts too.
    keyed: bool,
    shown: f64,
}

impl Buffers {
    /// Vertices and indices as they are; capacity for all wire segments, ribbons and shadow instances.
    fn new(
        device: &wgpu::Device,
        scene: &Scene,
        segments: usize,
        outlines: &Outlines,
        shadow_plates: &PlateShadows,
    ) -> Self {
        let filled = |label, contents: &[u8], usage| {
            // An exhibit of wires alone has no vertices; an empty buffer could not be bound.
            let contents = if contents.is_empty() { &[0; 16] } else { contents };
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some(label), contents, usage })
        };
        let filled_later = |label, size: usize| {
            device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: size as u64,
                usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            })
        };
        let vertex_usage = wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST;
        Self {
            vertices: filled("vertices", bytemuck::cast_slice(&scene.vertices), vertex_usage),
            indices: filled("indices", bytemuck::cast_slice(&scene.indices), wgpu::BufferUsages::INDEX),
            segments: filled_later("segments", segments.max(1) * size_of::<Segment>()),
            ribbons: filled_later("ribbons", outlines.max_ribbons().max(1) * size_of::<Ribbon>()),
            shadow_instances: filled_later(
                "shades",
                shadow_plates.max_instances().max(1) * size_of::<ShadowInstance>(),
            ),
        }
    }
}

impl GpuExhibit {
    /// Prepares an exhibit: everything that `shared` does not contain already.
    pub(super) fn new(
        gpu: &Gpu,
        shared: &mut SharedResources,
        options: &Options,
        exhibit: &Exhibit,
        Baked { mut scene, gallery, environment, ambient, casters }: Baked,
    ) -> Self {
        let device = &gpu.device;
        shared.pipelines.ensure(gpu, options, scene.batches.iter().map(|batch| batch.pipeline));
        let lighting = &options.lighting;
        let lamp_samples = LAMP_SAMPLES[(options.shadow_quality == ShadowQuality::Full) as usize];
        let planes = ReceivingPlane::of_gallery(&gallery, exhibit, options.shadow_quality);
        let map = ShadowMapCamera::new(&gallery, lighting, options.shadow_quality, &casters);
        let globals = Globals::new(
            lighting,
            &gallery,
            &environment.irradiance,
            &map,
            &planes,
            (options.shadow_quality, lamp_samples),
        );
        let sampled = |of| attachment(device, of, wgpu::TextureUsages::TEXTURE_BINDING);
        let [plane_views, order_views] = [0, 1].map(|which| planes.map(|p| sampled(PassPlan::plane(p.texels)[which])));
        let shadow_plates = PlateShadows::new(std::mem::take(&mut scene.shadow_plates), gallery.lamps, planes);
        let rims = numbers(device, "rims", (RIM_ROW, shadow_plates.rows()));
        let mut skins = std::mem::take(&mut scene.skins);
        skins.iter_mut().for_each(|skin| skin.fill(&scene.vertices));
        let outlines = Outlines::new(std::mem::take(&mut scene.plates), &scene.vertices);
        let contours = numbers(device, "contours", (CONTOUR_ROW, outlines.rows()));
        let light = LightResources {
            environment: &environment,
            gallery: &gallery,
            planes: &plane_views,
            ambient: &ambient,
            contours: &contours.create_view(&Default::default()),
        };
        let light_group = light_group(gpu, shared, light);
        let blended = scene.batches.iter().filter(|batch| batch.pipeline.kind == SurfaceKind::Blend).count();
        let lines = Lines::new(exhibit);
        let (frame_count, segment_count) = (exhibit.bodies.len() + 1, lines.count());
        Self {
            buffers: Buffers::new(device, &scene, segment_count, &outlines, &shadow_plates),
            bindings: Bindings {
                contours,
                rims_bind_group: single(device, &shared.layouts.rims, &rims),
                rims,
                materials: materials::materials(gpu, &exhibit.model, shared),
                light_group,
            },
            planes: PlaneTargets { views: plane_views, orders: order_views, texels: planes.map(|plane| plane.texels) },
            globals,
            opaque_end: scene.opaque_end,
            casters: scene.plate_casters_end..scene.casters_end,
            lamp_samples,
            radius: gallery.radius,
            start_poses: exhibit.bodies.iter().map(|body| body.pose).collect(),
            lines,
            batches: scene.batches,
            lights: scene.lights,
            frames: Vec::with_capacity(frame_count),
            segments: Vec::with_capacity(segment_count),
            outlines,
            plate_shadows: shadow_plates,
            last_drawn: LastDrawn {
                frames: Vec::with_capacity(frame_count),
                time: f64::NEG_INFINITY,
                keyed: skins.iter().any(Skinned::is_keyed),
                shown: 0.0,
            },
            skins,
            blended: Vec::with_capacity(blended),
        }
    }

    /// Updates all CPU-side data for a frame.
    pub(super) fn place(&mut self, frame: &FrameInput) {
        self.frames.clear();
        self.frames.push(rows(&Pose::IDENTITY));
        for (index, start) in self.start_poses.iter().enumerate() {
            self.frames.push(rows(frame.poses.get(index).unwrap_or(start)));
        }
        self.last_drawn.shown = frame.time;
        self.globals.set_frame(frame, self.radius);
        let frames = &self.frames;
        self.globals.set_lights(&self.lights, |i| {
            Mat4::from_cols(frames[i][0], frames[i][1], frames[i][2], Vec4::W).transpose()
        });
        self.lines.fill(&self.start_poses, frame.poses, frame.curves, self.globals.eye, &mut self.segments);
        self.outlines.update(&self.frames, &self.globals, frame.size);
        self.plate_shadows.update(&self.frames);
        if self.has_changed() {
            self.skins.iter_mut().for_each(|skin| skin.place(&self.frames, frame.time));
        }
        self.sort_blended();
    }

    /// Has anything moved since the last frame was drawn?
    pub(super) fn has_changed(&self) -> bool {
        self.frames != self.last_drawn.frames
            || (self.last_drawn.keyed && self.last_drawn.shown != self.last_drawn.time)
    }

    /// Are the shadows of the last frame still valid? Records the present frame; after [`Self::invalidate_shadows`]
    /// they are not.
    pub(super) fn shadows_are_current(&mut self) -> bool {
        let current = !self.has_changed();
        self.last_drawn.frames.clone_from(&self.frames);
        self.last_drawn.time = self.last_drawn.shown;
        current
    }

    /// Most draw calls on the wall or the floor.
    pub(super) fn plane_draws(&self) -> u32 {
        1 + u32::from(!self.casters.is_empty()) + u32::from(!self.plate_shadows.is_empty())
    }

    /// Has the shadows drawn again with the next frame.
    pub(super) fn invalidate_shadows(&mut self) {
        self.last_drawn.frames.clear();
    }

    /// Sorts blended batches, the farthest first.
    fn sort_blended(&mut self) {
        self.blended.clear();
        for (index, batch) in
            self.batches.iter().enumerate().filter(|(_, batch)| batch.pipeline.kind == SurfaceKind::Blend)
        {
            let center = batch.center.extend(1.0);
            let world = Vec3::from_array(self.frames[batch.frame].map(|row| row.dot(center)));
            self.blended.push((world.distance_squared(self.globals.eye), index));
        }
        self.blended.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
    }
}

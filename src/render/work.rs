//! What is drawn of one exhibit: its meshes, materials and wires, the light of the room that is measured to it, and the
//! memory in which its frames are prepared.

use glam::{Mat4, Vec3, Vec4};
use wgpu::util::DeviceExt;

use super::bounce;
use super::casters::casters;
use super::environment::Environment;
use super::fixtures::Fixtures;
use super::frames::rows;
use super::gallery::Room;
use super::globals::Globals;
use super::light::{Light, light_group};
use super::outlines::{CONTOUR_ROW, Outlines, Ribbon};
use super::passes::Plan;
use super::punctual::Punctual;
use super::resources::{attachment, numbers, single};
use super::scene::{Part, Scene, Surface};
use super::shadows::{MapCamera, ReceivingPlane};
use super::sheets::{RIM_ROW, Shade, Sheets};
use super::skins::Skinned;
use super::wires::{self, Segment};
use super::{Frame, Gpu, Look, Options, Quality, RenderError, materials, occlusion};
use soffio_exhibit::{Exhibit, Wire};
use soffio_math::Pose;

/// Points of each lamp's disc that shadows of meshes are cast from.
const LAMP_SAMPLES: [u32; 2] = [28, 56];

/// An exhibit made ready to be drawn by the [`super::Renderer`] that prepared it.
pub struct Work {
    pub(super) parts: Vec<Part>,
    pub(super) globals: Globals,
    pub(super) buffers: Buffers,
    pub(super) bindings: Bindings,
    pub(super) planes: PlaneTargets,
    /// So many indices, from the first, are opaque.
    pub(super) opaque: u32,
    /// Those that throw shadows on the planes as triangles.
    pub(super) casters: std::ops::Range<u32>,
    pub(super) lamp_samples: u32,
    radius: f32,
    /// Poses of bodies that a frame leaves out.
    rest: Vec<Pose>,
    wires: Vec<Wire>,
    lights: Vec<Punctual>,
    // Scratch, kept so that a frame allocates nothing.
    pub(super) frames: Vec<[Vec4; 3]>,
    pub(super) segments: Vec<Segment>,
    pub(super) outlines: Outlines,
    pub(super) sheets: Sheets,
    pub(super) skins: Vec<Skinned>,
    /// Squared distance and index of each blended part, the farthest first.
    pub(super) blended: Vec<(f32, usize)>,
    drawn: Drawn,
}

/// Its meshes, wires, silhouettes and shadows on the device.
pub(super) struct Buffers {
    pub vertices: wgpu::Buffer,
    pub indices: wgpu::Buffer,
    pub segments: wgpu::Buffer,
    pub ribbons: wgpu::Buffer,
    pub shades: wgpu::Buffer,
}

/// Textures that each frame fills, and what its draws are bound to.
pub(super) struct Bindings {
    pub contours: wgpu::Texture,
    pub rims: wgpu::Texture,
    pub rims_group: wgpu::BindGroup,
    pub light_group: wgpu::BindGroup,
    pub materials: Vec<wgpu::BindGroup>,
}

/// What the shadows on wall and floor are drawn into.
pub(super) struct PlaneTargets {
    pub views: [wgpu::TextureView; 2],
    pub orders: [wgpu::TextureView; 2],
    /// Texels of either.
    pub texels: [(u32, u32); 2],
}

/// What the last frame with shadows of its own showed, to know when they still hold.
struct Drawn {
    frames: Vec<[Vec4; 3]>,
    /// s.
    time: f64,
    /// Do key frames change shapes? Then the time shown, s, counts too.
    keyed: bool,
    shown: f64,
}

impl Buffers {
    /// Vertices and indices as they are; memory for so many wire segments and for the most of the others.
    fn new(device: &wgpu::Device, scene: &Scene, segments: usize, outlines: &Outlines, sheets: &Sheets) -> Self {
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
            ribbons: filled_later("ribbons", outlines.most().max(1) * size_of::<Ribbon>()),
            shades: filled_later("shades", sheets.most().max(1) * size_of::<Shade>()),
        }
    }
}

/// Measures the light that the corners of a scene get from each other, or else what they see of the sky.
fn light_corners(
    scene: &mut Scene,
    exhibit: &Exhibit,
    radius: f32,
    (look, environment): (&Look, &Environment),
    still: bool,
) {
    if still {
        let light = bounce::Light { environment, env_intensity: look.env_intensity, area: look.area_light };
        bounce::corners(scene, exhibit, radius, &light);
    } else {
        occlusion::corners(scene, exhibit, radius);
    }
}

impl Work {
    /// Prepares an exhibit: everything that `fixtures` does not hold already.
    pub(super) fn new(
        gpu: &Gpu,
        fixtures: &mut Fixtures,
        options: &Options,
        exhibit: &Exhibit,
    ) -> Result<Self, RenderError> {
        let device = &gpu.device;
        let mut scene = Scene::new(exhibit)?;
        fixtures.pipelines.cover(gpu, options, scene.parts.iter().map(|part| part.state));
        let room = Room::around(exhibit);
        let look = &options.look;
        let environment = match &look.environment {
            Some(environment) => environment.clone(),
            None => Environment::new(|direction| room.radiance(direction)).into(),
        };
        // What moves takes its corners along, and the light on them would be wrong.
        let still = exhibit.bodies.is_empty() && exhibit.shapes.is_empty() && look.background.is_some();
        light_corners(&mut scene, exhibit, room.radius, (look, &environment), still);
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
        let sampled = |of| attachment(device, of, wgpu::TextureUsages::TEXTURE_BINDING);
        let [plane_views, order_views] = [0, 1].map(|which| planes.map(|p| sampled(Plan::plane(p.texels)[which])));
        let ambient = occlusion::planes(&scene, exhibit, &planes, room.radius);
        let sheets = Sheets::new(std::mem::take(&mut scene.sheets), room.lamps, planes);
        let rims = numbers(device, "rims", (RIM_ROW, sheets.rows()));
        let mut skins = std::mem::take(&mut scene.skins);
        skins.iter_mut().for_each(|skin| skin.dress(&scene.vertices));
        let outlines = Outlines::new(std::mem::take(&mut scene.plates), &scene.vertices);
        let contours = numbers(device, "contours", (CONTOUR_ROW, outlines.rows()));
        let light = Light {
            environment: &environment,
            room: &room,
            planes: &plane_views,
            ambient: &ambient,
            contours: &contours.create_view(&Default::default()),
        };
        let light_group = light_group(gpu, fixtures, light);
        let blended = scene.parts.iter().filter(|part| part.state.surface == Surface::Blend).count();
        let (frame_count, segment_count) = (exhibit.bodies.len() + 1, wires::count(&exhibit.wires));
        Ok(Self {
            buffers: Buffers::new(device, &scene, segment_count, &outlines, &sheets),
            bindings: Bindings {
                contours,
                rims_group: single(device, &fixtures.layouts.rims, &rims),
                rims,
                materials: materials::materials(gpu, &exhibit.model, fixtures),
                light_group,
            },
            planes: PlaneTargets { views: plane_views, orders: order_views, texels: planes.map(|plane| plane.texels) },
            globals,
            opaque: scene.opaque,
            casters: scene.flat..scene.casters,
            lamp_samples,
            radius: room.radius,
            rest: exhibit.bodies.iter().map(|body| body.pose).collect(),
            wires: exhibit.wires.clone(),
            parts: scene.parts,
            lights: scene.lights,
            frames: Vec::with_capacity(frame_count),
            segments: Vec::with_capacity(segment_count),
            outlines,
            sheets,
            drawn: Drawn {
                frames: Vec::with_capacity(frame_count),
                time: f64::NEG_INFINITY,
                keyed: skins.iter().any(Skinned::is_keyed),
                shown: 0.0,
            },
            skins,
            blended: Vec::with_capacity(blended),
        })
    }

    /// Puts everything where a frame has it, in memory alone.
    pub(super) fn place(&mut self, frame: &Frame) {
        self.frames.clear();
        self.frames.push(rows(&Pose::IDENTITY));
        for (index, rest) in self.rest.iter().enumerate() {
            self.frames.push(rows(frame.poses.get(index).unwrap_or(rest)));
        }
        self.drawn.shown = frame.time;
        self.globals.set_frame(frame, self.radius);
        let frames = &self.frames;
        self.globals.set_lights(&self.lights, |i| {
            Mat4::from_cols(frames[i][0], frames[i][1], frames[i][2], Vec4::W).transpose()
        });
        wires::fill(&self.wires, &self.rest, frame.poses, self.globals.eye, &mut self.segments);
        self.outlines.find(&self.frames, &self.globals, frame.size);
        self.sheets.find(&self.frames);
        if self.moves() {
            self.skins.iter_mut().for_each(|skin| skin.place(&self.frames, frame.time));
        }
        self.sort_blended();
    }

    /// Has something moved since the last frame was drawn?
    pub(super) fn moves(&self) -> bool {
        self.frames != self.drawn.frames || (self.drawn.keyed && self.drawn.shown != self.drawn.time)
    }

    /// Has nothing moved since this was last asked, so that the shadows still hold? After [`Self::forget`] they do not.
    pub(super) fn rests(&mut self) -> bool {
        let rests = !self.moves();
        self.drawn.frames.clone_from(&self.frames);
        self.drawn.time = self.drawn.shown;
        rests
    }

    /// Draw calls on the wall or the floor, at most.
    pub(super) fn plane_draws(&self) -> u32 {
        1 + u32::from(!self.casters.is_empty()) + u32::from(!self.sheets.is_empty())
    }

    /// Has the shadows drawn with the next frame.
    pub(super) fn forget(&mut self) {
        self.drawn.frames.clear();
    }

    /// Blended parts, the farthest first.
    fn sort_blended(&mut self) {
        self.blended.clear();
        for (index, part) in self.parts.iter().enumerate().filter(|(_, part)| part.state.surface == Surface::Blend) {
            let center = part.center.extend(1.0);
            let world = Vec3::from_array(self.frames[part.frame].map(|row| row.dot(center)));
            self.blended.push((world.distance_squared(self.globals.eye), index));
        }
        self.blended.sort_unstable_by(|a, b| b.0.total_cmp(&a.0));
    }
}

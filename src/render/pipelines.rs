//! Shader modules, bind group layouts and render pipelines of all passes.

use std::collections::BTreeMap;

use super::outlines::Ribbon;
use super::plate_shadows::ShadowInstance;
use super::scene::{PipelineKey, SurfaceKind};
use super::shadows::{BLOCKER_FORMAT, MAP_FORMAT, PLANE_FORMAT};
use super::vertex::Vertex;
use super::wires::Segment;
use super::{Gpu, Options, Tonemap};

/// Depth of the picture, floating point because it is reversed.
pub(super) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Order of the lamp samples in the plane shadows; 16 bits distinguish 65 thousand.
pub(super) const ORDER_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth16Unorm;
/// Entry point of the fragment shader of plate edges.
const RIBBON_ENTRY: &str = "ribbon_fragment";
/// Depth is reversed: nearer is greater.
const DEPTH_COMPARE: wgpu::CompareFunction = wgpu::CompareFunction::Greater;

/// Bind group layouts.
pub(super) struct Layouts {
    /// Group 0: uniforms and buffers of a frame.
    pub frame: wgpu::BindGroupLayout,
    /// Group 1: light on the exhibit.
    pub light: wgpu::BindGroupLayout,
    /// Group 2: uniforms and textures of a material.
    pub material: wgpu::BindGroupLayout,
    /// Rims of the plates that cast analytic shadows.
    pub rims: wgpu::BindGroupLayout,
    /// Multisampled picture, for the resolve pass.
    pub resolve: wgpu::BindGroupLayout,
    /// Resolved picture, for the upscale pass.
    pub upscale: wgpu::BindGroupLayout,
}

/// Pipelines of all passes. Those of the meshes are created when an exhibit first needs them, and kept.
pub(super) struct Pipelines {
    /// Pipelines of each key, drawn one after the other: one, or three for glass.
    forward: BTreeMap<PipelineKey, Vec<wgpu::RenderPipeline>>,
    /// Pipelines of the plate edges of outlined keys.
    ribbons: BTreeMap<PipelineKey, wgpu::RenderPipeline>,
    /// Shader module and layout of the mesh pipelines.
    module: wgpu::ShaderModule,
    layout: wgpu::PipelineLayout,
    /// The six faces of the gallery.
    pub gallery: wgpu::RenderPipeline,
    /// Backdrop of a picture without a gallery.
    pub backdrop: wgpu::RenderPipeline,
    /// Wires in the picture.
    pub wires: wgpu::RenderPipeline,
    /// Dust particles.
    pub dust: wgpu::RenderPipeline,
    /// Shadows of meshes on wall and floor.
    pub plane_meshes: [wgpu::RenderPipeline; 2],
    /// Shadows of wires on wall and floor.
    pub plane_wires: [wgpu::RenderPipeline; 2],
    /// Analytic shadows of plates on wall and floor.
    pub plane_plates: [wgpu::RenderPipeline; 2],
    /// Shadow map of the light that shades the exhibit itself.
    pub shadow_map: wgpu::RenderPipeline,
    /// Averages the samples of each pixel.
    pub resolve: wgpu::RenderPipeline,
    /// Enlarges the picture to the size of the target.
    pub upscale: wgpu::RenderPipeline,
}

/// Layout of a mesh vertex, as [`Vertex`].
const VERTEX: wgpu::VertexBufferLayout = wgpu::VertexBufferLayout {
    array_stride: size_of::<Vertex>() as u64,
    step_mode: wgpu::VertexStepMode::Vertex,
    attributes: &wgpu::vertex_attr_array![
        0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x4, 4 => Float32x4, 5 => Uint32, 6 => Float32x4,
        7 => Uint32
    ],
};
/// Layout of a piece of wire, as [`Segment`].
const SEGMENT: wgpu::VertexBufferLayout = wgpu::VertexBufferLayout {
    array_stride: size_of::<Segment>() as u64,
    step_mode: wgpu::VertexStepMode::Instance,
    attributes: &wgpu::vertex_attr_array![
        0 => Float32x4, 1 => Float32x4, 2 => Float32x4, 3 => Float32x4, 4 => Float32x4
    ],
};
/// Layout of a piece of a plate's edge, as [`Ribbon`].
const RIBBON: wgpu::VertexBufferLayout = wgpu::VertexBufferLayout {
    array_stride: size_of::<Ribbon>() as u64,
    step_mode: wgpu::VertexStepMode::Instance,
    attributes: &wgpu::vertex_attr_array![
        0 => Float32x3, 1 => Float32x3, 2 => Float32x3, 3 => Float32x4, 4 => Float32x4, 5 => Float32x4,
        6 => Uint32, 7 => Uint32, 8 => Float32x4
    ],
};
/// Layout of an instance of a shadow, as [`ShadowInstance`].
const SHADOW_INSTANCE_VERTEX: wgpu::VertexBufferLayout = wgpu::VertexBufferLayout {
    array_stride: size_of::<ShadowInstance>() as u64,
    step_mode: wgpu::VertexStepMode::Instance,
    attributes: &wgpu::vertex_attr_array![0 => Float32x4, 1 => Uint32x4],
};
/// Layout of a dust particle: four floats, position and brightness.
const DUST_VERTEX: wgpu::VertexBufferLayout = wgpu::VertexBufferLayout {
    array_stride: 16,
    step_mode: wgpu::VertexStepMode::Instance,
    attributes: &wgpu::vertex_attr_array![0 => Float32x4],
};

impl Layouts {
    /// Creates all layouts.
    pub fn new(device: &wgpu::Device) -> Self {
        use wgpu::{
            BindingType, BufferBindingType, SamplerBindingType, ShaderStages, TextureSampleType, TextureViewDimension,
        };
        let group = |label, types: &[(ShaderStages, BindingType)]| {
            let entries: Vec<_> = (0..)
                .zip(types)
                .map(|(binding, &(visibility, ty))| wgpu::BindGroupLayoutEntry { binding, visibility, ty, count: None })
                .collect();
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(label), entries: &entries })
        };
        let uniform =
            BindingType::Buffer { ty: BufferBindingType::Uniform, has_dynamic_offset: false, min_binding_size: None };
        let texture = |sample_type, view_dimension, multisampled| BindingType::Texture {
            sample_type,
            view_dimension,
            multisampled,
        };
        let smooth = TextureSampleType::Float { filterable: true };
        let numbers = TextureSampleType::Float { filterable: false };
        let image = (ShaderStages::FRAGMENT, texture(smooth, TextureViewDimension::D2, false));
        let images = (ShaderStages::FRAGMENT, texture(smooth, TextureViewDimension::D2Array, false));
        let fragment = ShaderStages::FRAGMENT;
        let sampler = (fragment, BindingType::Sampler(SamplerBindingType::Filtering));
        Self {
            frame: group("frame", &[(ShaderStages::VERTEX_FRAGMENT, uniform), (ShaderStages::VERTEX, uniform)]),
            light: group(
                "light",
                &[
                    (fragment, texture(smooth, TextureViewDimension::Cube, false)),
                    image,
                    (fragment, BindingType::Sampler(SamplerBindingType::Filtering)),
                    image,
                    image,
                    image,
                    images,
                    images,
                    (fragment, texture(numbers, TextureViewDimension::D2, false)),
                ],
            ),
            material: group(
                "material",
                &[
                    (fragment, uniform),
                    image,
                    image,
                    image,
                    image,
                    image,
                    sampler,
                    sampler,
                    sampler,
                    sampler,
                    sampler,
                    // With these two a fragment shader reads 15 textures; 16 is what every device has.
                    images,
                    images,
                    sampler,
                ],
            ),
            upscale: group("upscale", &[image, sampler]),
            rims: group("rims", &[(fragment, texture(numbers, TextureViewDimension::D2, false))]),
            resolve: group("resolve", &[(fragment, texture(numbers, TextureViewDimension::D2, true))]),
        }
    }
}

/// The state in which pipelines differ.
struct PipelineState<'a> {
    label: &'a str,
    module: &'a wgpu::ShaderModule,
    layout: &'a wgpu::PipelineLayout,
    entries: (&'a str, Option<&'a str>),
    buffer: Option<wgpu::VertexBufferLayout<'a>>,
    constants: &'a [(&'a str, f64)],
    cull: Option<wgpu::Face>,
    depth: Option<(wgpu::TextureFormat, bool, wgpu::CompareFunction)>,
    color: Option<(wgpu::TextureFormat, Option<wgpu::BlendState>)>,
    samples: u32,
}

fn pipeline(device: &wgpu::Device, key: PipelineState) -> wgpu::RenderPipeline {
    let compilation = wgpu::PipelineCompilationOptions { constants: key.constants, ..Default::default() };
    let target = key.color.map(|(format, blend)| wgpu::ColorTargetState {
        format,
        blend,
        // Alpha stays as cleared: the picture is opaque.
        write_mask: wgpu::ColorWrites::COLOR,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(key.label),
        layout: Some(key.layout),
        vertex: wgpu::VertexState {
            module: key.module,
            entry_point: Some(key.entries.0),
            compilation_options: compilation.clone(),
            buffers: &[key.buffer],
        },
        primitive: wgpu::PrimitiveState { cull_mode: key.cull, ..Default::default() },
        depth_stencil: key.depth.map(|(format, write, compare)| wgpu::DepthStencilState {
            format,
            depth_write_enabled: Some(write),
            depth_compare: Some(compare),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: wgpu::MultisampleState { count: key.samples, ..Default::default() },
        fragment: key.entries.1.map(|entry| wgpu::FragmentState {
            module: key.module,
            entry_point: Some(entry),
            compilation_options: compilation,
            targets: std::slice::from_ref(&target),
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Blending with one factor for source and destination each.
fn blend(src_factor: wgpu::BlendFactor, dst_factor: wgpu::BlendFactor) -> Option<wgpu::BlendState> {
    let component = wgpu::BlendComponent { src_factor, dst_factor, operation: wgpu::BlendOperation::Add };
    Some(wgpu::BlendState { color: component, alpha: component })
}

/// Shader constants that follow from the options.
fn constants(options: &Options) -> [(&'static str, f64); 3] {
    let tonemap = match options.lighting.tonemap {
        Tonemap::Neutral => 0.0,
        Tonemap::Aces => 1.0,
        Tonemap::Agx => 2.0,
        Tonemap::Clamp => 3.0,
    };
    let area_light = if options.lighting.area_light.is_some() { 1.0 } else { 0.0 };
    let gallery = options.lighting.environment.is_none() && options.lighting.background.is_none();
    [("TONEMAP", tonemap), ("AREA_LIGHT", area_light), ("GALLERY", if gallery { 1.0 } else { 0.0 })]
}

/// A pipeline layout with these bind groups.
fn pipeline_layout(device: &wgpu::Device, label: &str, groups: &[&wgpu::BindGroupLayout]) -> wgpu::PipelineLayout {
    let groups: Vec<_> = groups.iter().map(|&group| Some(group)).collect();
    device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: &groups,
        immediate_size: 0,
    })
}

/// Pipelines of the shadows of meshes, wires and plates, each on the wall and on the floor.
fn plane_pipelines(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    layout: &wgpu::PipelineLayout,
    layouts: &Layouts,
) -> [[wgpu::RenderPipeline; 2]; 3] {
    let plate_shadow_layout = pipeline_layout(device, "plate shadows", &[&layouts.frame, &layouts.rims]);
    let plane = |label, entries, buffer: wgpu::VertexBufferLayout<'static>, layout, pass: (_, bool), blend| {
        [0.0, 1.0].map(|plane| {
            pipeline(
                device,
                PipelineState {
                    label,
                    module,
                    layout,
                    entries,
                    buffer: Some(buffer.clone()),
                    constants: &[("PLANE", plane)],
                    cull: None,
                    depth: Some((ORDER_FORMAT, pass.1, pass.0)),
                    color: Some((PLANE_FORMAT, blend)),
                    samples: 1,
                },
            )
        })
    };
    let (once, always) = ((wgpu::CompareFunction::Less, true), (wgpu::CompareFunction::Always, false));
    let adding = blend(wgpu::BlendFactor::One, wgpu::BlendFactor::One);
    let covering = blend(wgpu::BlendFactor::OneMinusDst, wgpu::BlendFactor::One);
    let mesh = ("mesh_vertex", Some("mesh_fragment"));
    let wire = ("wire_vertex", Some("wire_fragment"));
    let shadow_plate = ("plate_shadow_vertex", Some("plate_shadow_fragment"));
    [
        plane("plane meshes", mesh, VERTEX, layout, once, adding),
        plane("plane wires", wire, SEGMENT, layout, always, adding),
        plane("plane plates", shadow_plate, SHADOW_INSTANCE_VERTEX, &plate_shadow_layout, always, covering),
    ]
}

impl Pipelines {
    /// All pipelines except those of the meshes.
    pub fn new(gpu: &Gpu, layouts: &Layouts, options: &Options) -> Self {
        let device = &gpu.device;
        let module = |label: &str| {
            let source = wgpu::ShaderSource::Wgsl(options.shaders.source(label));
            device.create_shader_module(wgpu::ShaderModuleDescriptor { label: Some(label), source })
        };
        let layout = |label, groups: &[_]| pipeline_layout(device, label, groups);
        let shadow_layout = layout("shadow", &[&layouts.frame]);
        let light_layout = layout("light", &[&layouts.frame, &layouts.light]);
        let resolve_layout = layout("resolve", &[&layouts.resolve]);
        let upscale_layout = layout("upscale", &[&layouts.upscale]);
        let (gallery, shadows, wires) = (module("gallery"), module("shadows"), module("wires"));
        let (dust, resolve, upscale) = (module("dust"), module("resolve"), module("upscale"));
        let adding = blend(wgpu::BlendFactor::One, wgpu::BlendFactor::One);
        let constants = constants(options);
        // A pass into the picture.
        let base = || PipelineState {
            label: "gallery",
            module: &gallery,
            layout: &light_layout,
            entries: ("vertex", Some("fragment")),
            buffer: None,
            constants: &constants,
            cull: None,
            depth: Some((DEPTH_FORMAT, true, DEPTH_COMPARE)),
            color: Some((options.format, None)),
            samples: options.msaa,
        };
        let overlay = |label, module, buffer, constants, blend| {
            let depth = Some((DEPTH_FORMAT, false, DEPTH_COMPARE));
            let color = Some((options.format, blend));
            pipeline(device, PipelineState { label, module, buffer: Some(buffer), constants, depth, color, ..base() })
        };
        let [plane_meshes, plane_wires, plane_plates] = plane_pipelines(device, &shadows, &shadow_layout, layouts);
        // A pass over the whole target.
        let whole = |label, module, layout| {
            pipeline(device, PipelineState { label, module, layout, constants: &[], depth: None, samples: 1, ..base() })
        };
        Self {
            forward: BTreeMap::new(),
            ribbons: BTreeMap::new(),
            module: module("forward"),
            layout: layout("material", &[&layouts.frame, &layouts.light, &layouts.material]),
            gallery: pipeline(device, base()),
            backdrop: pipeline(
                device,
                PipelineState {
                    label: "backdrop",
                    entries: ("backdrop_vertex", Some("backdrop_fragment")),
                    depth: Some((DEPTH_FORMAT, false, wgpu::CompareFunction::GreaterEqual)),
                    ..base()
                },
            ),
            wires: overlay("wires", &wires, SEGMENT, &constants, Some(wgpu::BlendState::ALPHA_BLENDING)),
            dust: overlay("dust", &dust, DUST_VERTEX, &[], adding),
            plane_meshes,
            plane_wires,
            plane_plates,
            shadow_map: pipeline(
                device,
                PipelineState {
                    label: "shadow map",
                    module: &shadows,
                    layout: &shadow_layout,
                    entries: ("map_vertex", Some("map_fragment")),
                    buffer: Some(VERTEX),
                    constants: &[],
                    depth: Some((MAP_FORMAT, true, DEPTH_COMPARE)),
                    color: Some((BLOCKER_FORMAT, None)),
                    samples: 1,
                    ..base()
                },
            ),
            resolve: whole("resolve", &resolve, &resolve_layout),
            upscale: whole("upscale", &upscale, &upscale_layout),
        }
    }

    /// Creates the missing pipelines for these keys.
    pub fn ensure(&mut self, gpu: &Gpu, options: &Options, states: impl Iterator<Item = PipelineKey>) {
        for key in states {
            if !self.forward.contains_key(&key) {
                let made = self.meshes(&gpu.device, options, key);
                self.forward.insert(key, made);
                if key.outlined {
                    let blend = Some(wgpu::BlendState::ALPHA_BLENDING);
                    let pass = MeshPass { entry: RIBBON_ENTRY, cull: None, write: false, blend };
                    let made = self.mesh(&gpu.device, options, key, pass);
                    self.ribbons.insert(key, made);
                }
            }
        }
    }

    /// The mesh pipelines of a key that [`Self::ensure`] has seen.
    pub fn forward(&self, key: &PipelineKey) -> &[wgpu::RenderPipeline] {
        self.forward.get(key).map_or(&[], Vec::as_slice)
    }

    /// The pipeline of the plate edges of an outlined key.
    pub fn ribbons(&self, key: &PipelineKey) -> Option<&wgpu::RenderPipeline> {
        self.ribbons.get(key)
    }

    /// The keys that have pipelines.
    pub fn states(&self) -> Vec<PipelineKey> {
        self.forward.keys().copied().collect()
    }

    /// Number of pipelines.
    pub fn count(&self) -> usize {
        let fixed = self.plane_meshes.len() + self.plane_wires.len() + self.plane_plates.len() + 7;
        fixed + self.ribbons.len() + self.forward.values().map(Vec::len).sum::<usize>()
    }

    fn meshes(&self, device: &wgpu::Device, options: &Options, key: PipelineKey) -> Vec<wgpu::RenderPipeline> {
        use wgpu::BlendFactor::{Dst, One, Zero};
        let mesh = |entry, cull, write, blend| self.mesh(device, options, key, MeshPass { entry, cull, write, blend });
        let cull = (!key.double_sided).then_some(wgpu::Face::Back);
        match key.kind {
            SurfaceKind::Opaque => vec![mesh("fragment", cull, true, None)],
            SurfaceKind::Blend => vec![mesh("fragment", cull, false, Some(wgpu::BlendState::ALPHA_BLENDING))],
            // Gloss of the far wall, transmission of both walls, gloss of the near wall.
            SurfaceKind::Glass => vec![
                mesh("gloss_fragment", Some(wgpu::Face::Front), false, blend(One, One)),
                mesh("tint_fragment", None, false, blend(Dst, Zero)),
                mesh("gloss_fragment", Some(wgpu::Face::Back), false, blend(One, One)),
            ],
        }
    }

    /// The mesh pipeline of a key in one pass.
    fn mesh(&self, device: &wgpu::Device, options: &Options, key: PipelineKey, pass: MeshPass) -> wgpu::RenderPipeline {
        let [a, b, c] = constants(options);
        let flag = |set| if set { 1.0 } else { 0.0 };
        let ribbon = pass.entry == RIBBON_ENTRY;
        let (layers, details) = (("LAYERS", flag(key.layers)), ("DETAILS", flag(key.details)));
        let constants = [a, b, c, layers, details, ("OUTLINED", flag(key.outlined)), ("RIBBON", flag(ribbon))];
        pipeline(
            device,
            PipelineState {
                label: "forward",
                module: &self.module,
                layout: &self.layout,
                entries: (if ribbon { "ribbon_vertex" } else { "vertex" }, Some(pass.entry)),
                buffer: Some(if ribbon { RIBBON } else { VERTEX }),
                constants: &constants,
                cull: pass.cull,
                depth: Some((DEPTH_FORMAT, pass.write, DEPTH_COMPARE)),
                color: Some((options.format, pass.blend)),
                samples: options.msaa,
            },
        )
    }
}

/// A pass over meshes: entry point, culled side, depth write, and blending.
struct MeshPass {
    entry: &'static str,
    cull: Option<wgpu::Face>,
    write: bool,
    blend: Option<wgpu::BlendState>,
}

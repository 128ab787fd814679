//! Shaders, bind group layouts and pipelines: the fixed state of every pass.

use std::collections::BTreeMap;

use super::outlines::Ribbon;
use super::scene::{State, Surface};
use super::shadows::{BLOCKER_FORMAT, MAP_FORMAT, PLANE_FORMAT};
use super::sheets::Shade;
use super::vertex::Vertex;
use super::wires::Segment;
use super::{Gpu, Options, Tonemap};

/// Depth of the picture: reversed, so floating.
pub(super) const DEPTH_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Order of the lamp samples in the plane shadows; 16 bits tell 65 thousand apart.
pub(super) const ORDER_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Depth16Unorm;
/// Where the shader of the edges of plates begins.
const RIBBON_ENTRY: &str = "ribbon_fragment";
/// Depth is reversed.
const NEARER: wgpu::CompareFunction = wgpu::CompareFunction::Greater;

/// Layouts of the bind groups.
pub(super) struct Layouts {
    pub frame: wgpu::BindGroupLayout,
    pub light: wgpu::BindGroupLayout,
    pub material: wgpu::BindGroupLayout,
    pub rims: wgpu::BindGroupLayout,
    pub resolve: wgpu::BindGroupLayout,
    pub stretch: wgpu::BindGroupLayout,
}

/// Pipelines of all passes. Those of the meshes are made when a work first asks for their state, and kept for the next.
pub(super) struct Pipelines {
    /// For each state of a scene's parts what is drawn, one after the other: one pipeline, three of glass.
    forward: BTreeMap<State, Vec<wgpu::RenderPipeline>>,
    /// Edges of the outlined ones.
    ribbons: BTreeMap<State, wgpu::RenderPipeline>,
    /// What those are made of.
    module: wgpu::ShaderModule,
    layout: wgpu::PipelineLayout,
    /// All six faces.
    pub room: wgpu::RenderPipeline,
    pub backdrop: wgpu::RenderPipeline,
    pub wires: wgpu::RenderPipeline,
    pub motes: wgpu::RenderPipeline,
    /// For the wall and the floor.
    pub plane_meshes: [wgpu::RenderPipeline; 2],
    pub plane_wires: [wgpu::RenderPipeline; 2],
    pub plane_sheets: [wgpu::RenderPipeline; 2],
    pub shadow_map: wgpu::RenderPipeline,
    pub resolve: wgpu::RenderPipeline,
    pub stretch: wgpu::RenderPipeline,
}

const VERTEX: wgpu::VertexBufferLayout = wgpu::VertexBufferLayout {
    array_stride: size_of::<Vertex>() as u64,
    step_mode: wgpu::VertexStepMode::Vertex,
    attributes: &wgpu::vertex_attr_array![
        0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x4, 4 => Float32x4, 5 => Uint32, 6 => Float32x3,
        7 => Uint32
    ],
};
const SEGMENT: wgpu::VertexBufferLayout = wgpu::VertexBufferLayout {
    array_stride: size_of::<Segment>() as u64,
    step_mode: wgpu::VertexStepMode::Instance,
    attributes: &wgpu::vertex_attr_array![
        0 => Float32x4, 1 => Float32x4, 2 => Float32x4, 3 => Float32x4, 4 => Float32x4
    ],
};
const RIBBON: wgpu::VertexBufferLayout = wgpu::VertexBufferLayout {
    array_stride: size_of::<Ribbon>() as u64,
    step_mode: wgpu::VertexStepMode::Instance,
    attributes: &wgpu::vertex_attr_array![
        0 => Float32x3, 1 => Float32x3, 2 => Float32x3, 3 => Float32x4, 4 => Float32x4, 5 => Float32x4,
        6 => Uint32, 7 => Uint32
    ],
};
const SHADE: wgpu::VertexBufferLayout = wgpu::VertexBufferLayout {
    array_stride: size_of::<Shade>() as u64,
    step_mode: wgpu::VertexStepMode::Instance,
    attributes: &wgpu::vertex_attr_array![0 => Float32x4, 1 => Uint32x4],
};
const MOTE: wgpu::VertexBufferLayout = wgpu::VertexBufferLayout {
    array_stride: 16,
    step_mode: wgpu::VertexStepMode::Instance,
    attributes: &wgpu::vertex_attr_array![0 => Float32x4],
};

impl Layouts {
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
                    // With these two a fragment reads 15 textures; 16 is what every device has.
                    images,
                    images,
                    sampler,
                ],
            ),
            stretch: group("stretch", &[image, sampler]),
            rims: group("rims", &[(fragment, texture(numbers, TextureViewDimension::D2, false))]),
            resolve: group("resolve", &[(fragment, texture(numbers, TextureViewDimension::D2, true))]),
        }
    }
}

/// What differs between the pipelines.
struct Fixed<'a> {
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

fn pipeline(device: &wgpu::Device, state: Fixed) -> wgpu::RenderPipeline {
    let compilation = wgpu::PipelineCompilationOptions { constants: state.constants, ..Default::default() };
    let target = state.color.map(|(format, blend)| wgpu::ColorTargetState {
        format,
        blend,
        // Alpha stays as cleared: the picture is opaque whatever was blended into it.
        write_mask: wgpu::ColorWrites::COLOR,
    });
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(state.label),
        layout: Some(state.layout),
        vertex: wgpu::VertexState {
            module: state.module,
            entry_point: Some(state.entries.0),
            compilation_options: compilation.clone(),
            buffers: &[state.buffer],
        },
        primitive: wgpu::PrimitiveState { cull_mode: state.cull, ..Default::default() },
        depth_stencil: state.depth.map(|(format, write, compare)| wgpu::DepthStencilState {
            format,
            depth_write_enabled: Some(write),
            depth_compare: Some(compare),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: wgpu::MultisampleState { count: state.samples, ..Default::default() },
        fragment: state.entries.1.map(|entry| wgpu::FragmentState {
            module: state.module,
            entry_point: Some(entry),
            compilation_options: compilation,
            targets: std::slice::from_ref(&target),
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Blending by one factor each.
fn blend(src_factor: wgpu::BlendFactor, dst_factor: wgpu::BlendFactor) -> Option<wgpu::BlendState> {
    let component = wgpu::BlendComponent { src_factor, dst_factor, operation: wgpu::BlendOperation::Add };
    Some(wgpu::BlendState { color: component, alpha: component })
}

/// What the options decide in the shaders of the picture.
fn constants(options: &Options) -> [(&'static str, f64); 3] {
    let tonemap = match options.look.tonemap {
        Tonemap::Neutral => 0.0,
        Tonemap::Aces => 1.0,
        Tonemap::Agx => 2.0,
        Tonemap::Clamp => 3.0,
    };
    let area_light = if options.look.area_light.is_some() { 1.0 } else { 0.0 };
    let gallery = options.look.environment.is_none() && options.look.background.is_none();
    [("TONEMAP", tonemap), ("AREA_LIGHT", area_light), ("GALLERY", if gallery { 1.0 } else { 0.0 })]
}

/// The layout of a pipeline that binds these groups.
fn pipeline_layout(device: &wgpu::Device, label: &str, groups: &[&wgpu::BindGroupLayout]) -> wgpu::PipelineLayout {
    let groups: Vec<_> = groups.iter().map(|&group| Some(group)).collect();
    device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(label),
        bind_group_layouts: &groups,
        immediate_size: 0,
    })
}

/// Shadows of meshes, wires and sheets, each on the wall and on the floor.
fn plane_pipelines(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    layout: &wgpu::PipelineLayout,
    layouts: &Layouts,
) -> [[wgpu::RenderPipeline; 2]; 3] {
    let sheet_layout = pipeline_layout(device, "sheets", &[&layouts.frame, &layouts.rims]);
    let plane = |label, entries, buffer: wgpu::VertexBufferLayout<'static>, layout, how: (_, bool), blend| {
        [0.0, 1.0].map(|plane| {
            pipeline(
                device,
                Fixed {
                    label,
                    module,
                    layout,
                    entries,
                    buffer: Some(buffer.clone()),
                    constants: &[("PLANE", plane)],
                    cull: None,
                    depth: Some((ORDER_FORMAT, how.1, how.0)),
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
    let sheet = ("sheet_vertex", Some("sheet_fragment"));
    [
        plane("plane meshes", mesh, VERTEX, layout, once, adding),
        plane("plane wires", wire, SEGMENT, layout, always, adding),
        plane("plane sheets", sheet, SHADE, &sheet_layout, always, covering),
    ]
}

impl Pipelines {
    /// All but those of the meshes.
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
        let stretch_layout = layout("stretch", &[&layouts.stretch]);
        let (room, shadows, wires) = (module("room"), module("shadows"), module("wires"));
        let (motes, resolve, stretch) = (module("motes"), module("resolve"), module("stretch"));
        let adding = blend(wgpu::BlendFactor::One, wgpu::BlendFactor::One);
        let constants = constants(options);
        // A pass into the picture itself.
        let base = || Fixed {
            label: "room",
            module: &room,
            layout: &light_layout,
            entries: ("vertex", Some("fragment")),
            buffer: None,
            constants: &constants,
            cull: None,
            depth: Some((DEPTH_FORMAT, true, NEARER)),
            color: Some((options.format, None)),
            samples: options.msaa,
        };
        let overlay = |label, module, buffer, constants, blend| {
            let depth = Some((DEPTH_FORMAT, false, NEARER));
            let color = Some((options.format, blend));
            pipeline(device, Fixed { label, module, buffer: Some(buffer), constants, depth, color, ..base() })
        };
        let [plane_meshes, plane_wires, plane_sheets] = plane_pipelines(device, &shadows, &shadow_layout, layouts);
        // A pass over the whole target.
        let whole = |label, module, layout| {
            pipeline(device, Fixed { label, module, layout, constants: &[], depth: None, samples: 1, ..base() })
        };
        Self {
            forward: BTreeMap::new(),
            ribbons: BTreeMap::new(),
            module: module("forward"),
            layout: layout("material", &[&layouts.frame, &layouts.light, &layouts.material]),
            room: pipeline(device, base()),
            backdrop: pipeline(
                device,
                Fixed {
                    label: "backdrop",
                    entries: ("backdrop_vertex", Some("backdrop_fragment")),
                    depth: Some((DEPTH_FORMAT, false, wgpu::CompareFunction::GreaterEqual)),
                    ..base()
                },
            ),
            wires: overlay("wires", &wires, SEGMENT, &constants, Some(wgpu::BlendState::ALPHA_BLENDING)),
            motes: overlay("motes", &motes, MOTE, &[], adding),
            plane_meshes,
            plane_wires,
            plane_sheets,
            shadow_map: pipeline(
                device,
                Fixed {
                    label: "shadow map",
                    module: &shadows,
                    layout: &shadow_layout,
                    entries: ("map_vertex", Some("map_fragment")),
                    buffer: Some(VERTEX),
                    constants: &[],
                    depth: Some((MAP_FORMAT, true, NEARER)),
                    color: Some((BLOCKER_FORMAT, None)),
                    samples: 1,
                    ..base()
                },
            ),
            resolve: whole("resolve", &resolve, &resolve_layout),
            stretch: whole("stretch", &stretch, &stretch_layout),
        }
    }

    /// Makes what `states` need and no work needed before.
    pub fn cover(&mut self, gpu: &Gpu, options: &Options, states: impl Iterator<Item = State>) {
        for state in states {
            if !self.forward.contains_key(&state) {
                let made = self.meshes(&gpu.device, options, state);
                self.forward.insert(state, made);
                if state.outlined {
                    let blend = Some(wgpu::BlendState::ALPHA_BLENDING);
                    let how = How { entry: RIBBON_ENTRY, cull: None, write: false, blend };
                    let made = self.mesh(&gpu.device, options, state, how);
                    self.ribbons.insert(state, made);
                }
            }
        }
    }

    /// What draws the parts of a state that a work asked for.
    pub fn forward(&self, state: &State) -> &[wgpu::RenderPipeline] {
        self.forward.get(state).map_or(&[], Vec::as_slice)
    }

    /// What draws the edges of the parts of an outlined state.
    pub fn ribbons(&self, state: &State) -> Option<&wgpu::RenderPipeline> {
        self.ribbons.get(state)
    }

    /// The states that are covered.
    pub fn states(&self) -> Vec<State> {
        self.forward.keys().copied().collect()
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        let fixed = self.plane_meshes.len() + self.plane_wires.len() + self.plane_sheets.len() + 7;
        fixed + self.ribbons.len() + self.forward.values().map(Vec::len).sum::<usize>()
    }

    fn meshes(&self, device: &wgpu::Device, options: &Options, state: State) -> Vec<wgpu::RenderPipeline> {
        use wgpu::BlendFactor::{Dst, One, Zero};
        let mesh = |entry, cull, write, blend| self.mesh(device, options, state, How { entry, cull, write, blend });
        let cull = (!state.double_sided).then_some(wgpu::Face::Back);
        match state.surface {
            Surface::Opaque => vec![mesh("fragment", cull, true, None)],
            Surface::Blend => vec![mesh("fragment", cull, false, Some(wgpu::BlendState::ALPHA_BLENDING))],
            // The far wall's gloss, what both walls let through, the near wall's gloss.
            Surface::Glass => vec![
                mesh("gloss_fragment", Some(wgpu::Face::Front), false, blend(One, One)),
                mesh("tint_fragment", None, false, blend(Dst, Zero)),
                mesh("gloss_fragment", Some(wgpu::Face::Back), false, blend(One, One)),
            ],
        }
    }

    /// One pipeline of meshes of a state.
    fn mesh(&self, device: &wgpu::Device, options: &Options, state: State, how: How) -> wgpu::RenderPipeline {
        let [a, b, c] = constants(options);
        let flag = |set| if set { 1.0 } else { 0.0 };
        let ribbon = how.entry == RIBBON_ENTRY;
        let (layers, details) = (("LAYERS", flag(state.layers)), ("DETAILS", flag(state.details)));
        let constants = [a, b, c, layers, details, ("OUTLINED", flag(state.outlined)), ("RIBBON", flag(ribbon))];
        pipeline(
            device,
            Fixed {
                label: "forward",
                module: &self.module,
                layout: &self.layout,
                entries: (if ribbon { "ribbon_vertex" } else { "vertex" }, Some(how.entry)),
                buffer: Some(if ribbon { RIBBON } else { VERTEX }),
                constants: &constants,
                cull: how.cull,
                depth: Some((DEPTH_FORMAT, how.write, NEARER)),
                color: Some((options.format, how.blend)),
                samples: options.msaa,
            },
        )
    }
}

/// How triangles of a mesh are drawn: the entry of the shader, the side left out, whether depth is written, the blending.
struct How {
    entry: &'static str,
    cull: Option<wgpu::Face>,
    write: bool,
    blend: Option<wgpu::BlendState>,
}
